"""Mutation testing of kernels, definitions and premises: whether a theorem detects each small fault."""
