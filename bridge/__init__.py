"""The wire formats and connections: LMCP and the CRATOUS text protocol."""

if __name__ != "cratous.bridge":
    raise ImportError(
        f"import this package as 'cratous.bridge', not as {__name__!r}: "
        "a second copy would have a second kernel registry"
    )
