"""The results folder of a run: which files belong to CRATOUS, and its atomic replacement."""
