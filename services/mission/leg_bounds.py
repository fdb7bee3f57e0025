"""How often and how long ICAROUS may fly on one leg before its item is given up."""

MOST_TAKEOVERS = 12
"""On one leg ICAROUS may take over this often: it is given up at the takeover after that."""
LONGEST_LOOKAHEADS = 5
"""On one leg it flies for at most this many times its look-ahead."""
