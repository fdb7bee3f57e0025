"""Kernels in machine code: over arrays, and functions with loops as they are written."""
