"""Bounds of ICAROUS's takeovers and flight time on one leg, after which its item is given up."""

MOST_TAKEOVERS = 12
"""Most takeovers on one leg: it is given up at the next one."""
LONGEST_LOOKAHEADS = 5
"""Longest flight under ICAROUS on one leg, in look-ahead times."""
