"""The runtime: bus, planning, flight, monitor, certification and the command line."""

if __name__ != "cratous.services":
    raise ImportError(
        f"import this package as 'cratous.services', not as {__name__!r}: "
        "a second copy would have a second kernel registry"
    )
