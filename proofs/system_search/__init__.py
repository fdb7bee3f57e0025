"""Bounded search for faults in the composition of the running steps. Not a proof."""
