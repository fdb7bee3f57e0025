"""Lints of code outside of kernels."""
