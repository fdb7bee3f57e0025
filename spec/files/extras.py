"""Libraries that only optional parts of the product need, and the extra that brings each."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cratous.spec.errors import NotInstalled

EXTRAS = {
    "matplotlib": ("matplotlib", "plots"),
    "zmq": ("pyzmq", "wires"),
    "serial": ("pyserial", "wires"),
    "mcap": ("mcap", "wires"),
    "lz4": ("lz4", "wires"),
    "zstandard": ("zstandard", "wires"),
    "cvc5": ("cvc5", "prove"),
    "cryptography": ("cryptography", "sign"),
    "reportlab": ("reportlab", "pdf"),
    "dask": ("dask", "campaign"),
    "distributed": ("distributed", "campaign"),
    "pyarrow": ("pyarrow", "parquet"),
}
"""By import name: the library, and the extra of `pyproject.toml` that installs it."""


@contextmanager
def told() -> Iterator[None]:
    """Context in which importing a library of an extra that is not installed raises NotInstalled."""
    try:
        yield
    except ModuleNotFoundError as error:
        found = EXTRAS.get((error.name or "").partition(".")[0])
        if found is None:
            raise
        raise NotInstalled(*found) from error
