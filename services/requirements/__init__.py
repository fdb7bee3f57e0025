"""Requirements over time: formulas, their evaluation sample by sample, and the import of others' languages.

Nothing here imports the planner or the prover; verdicts are decided by the kernels of `core.requirements`.
"""
