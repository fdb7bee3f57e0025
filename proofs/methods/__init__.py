"""Methods of proof shared by several theorems: induction over chains, crossings, rounding."""
