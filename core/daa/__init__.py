"""Detect and avoid: alerts, bands, recovery and coordination, from kernels."""
