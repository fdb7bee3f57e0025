"""Definitions of requirements over time."""
