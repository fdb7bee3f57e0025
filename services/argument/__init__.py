"""The assurance argument of one run: from G1 to G5 down to theorems, assumptions and residual trust (GSN)."""
