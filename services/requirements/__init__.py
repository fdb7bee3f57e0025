"""Temporal requirements: formulas, their language, C2PO and FRET import, sampling of traces,
evaluation, lint.

Nothing here imports the planner or the prover; the kernels of `core.requirements` decide verdicts.
"""
