"""Requirements over time: formulas and their language, C2PO, FRET, samples of traces, evaluation, lint.

Nothing here imports the planner or the prover; verdicts are decided by the kernels of `core.requirements`.
"""
