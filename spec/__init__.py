"""What must hold: definitions, grammar and plain data types. Imports no other package of this project."""

if __name__ != "cratous.spec":
    raise ImportError(
        f"import this package as 'cratous.spec', not as {__name__!r}: "
        "a second copy would have a second kernel registry"
    )
