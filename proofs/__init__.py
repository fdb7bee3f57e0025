"""The proof engine and its theorems: lifts kernels to z3 terms and proves them against `spec`."""

if __name__ != "cratous.proofs":
    raise ImportError(
        f"import this package as 'cratous.proofs', not as {__name__!r}: "
        "a second copy would have a second kernel registry"
    )
