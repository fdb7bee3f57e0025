"""A log as the bytes of an MCAP file, reproducible for the same log and versions of `mcap` and `zstandard`."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from cratous.services.logs.export import export
from cratous.services.logs.source import open_log


def needed() -> None:
    """Raise ModuleNotFoundError if mcap or zstandard is not installed."""
    import mcap.writer  # noqa: F401
    import zstandard  # noqa: F401


def as_mcap(log: Path) -> bytes:
    """All messages of a log with views for Foxglove; BadInput for a damaged log."""
    needed()
    with TemporaryDirectory() as folder, open_log(log) as source:
        target = Path(folder) / "run.mcap"
        export(source, target, "mcap")
        return target.read_bytes()
