"""The results folder of a run: whose files are in it, and how it changes as a whole."""
