"""Definitions of assignment problems, their search steps and their lower bounds."""
