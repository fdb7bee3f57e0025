"""Definitions of detect and avoid, its parameters, and its file formats."""
