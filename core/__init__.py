"""Kernels and drivers: pure, total, no I/O, no clock, no randomness. The ledger as data."""

if __name__ != "cratous.core":
    raise ImportError(
        f"import this package as 'cratous.core', not as {__name__!r}: "
        "a second copy would have a second kernel registry"
    )
