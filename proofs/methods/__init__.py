"""Ways of proving that several theorems share: induction over chains, crossings, rounding."""
