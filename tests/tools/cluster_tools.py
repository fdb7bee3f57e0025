"""A scheduler and workers of dask.distributed as processes of their own, on loopback."""

from __future__ import annotations

import contextlib
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def process(
    *arguments: str, folder: Path | None = None, environment: dict[str, str] | None = None
) -> Iterator[subprocess.Popen[str]]:
    """A process of dask in a folder, ended at the end; environment: all of it, by default this process's."""
    command = [sys.executable, "-m", "dask", *arguments]
    one = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, cwd=folder, env=environment
    )  # fmt: skip
    try:
        yield one
    finally:
        one.kill()
        one.wait()


@contextlib.contextmanager
def cluster(
    workers: int,
    folder: Path | None = None,
    environment: dict[str, str] | None = None,
    port: int = 0,
) -> Iterator[tuple[str, list[subprocess.Popen[str]]]]:
    """The address of a scheduler; it and its workers, which run in a folder and are all there."""
    with contextlib.ExitStack() as stack:
        head = stack.enter_context(
            process("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
        )
        assert head.stderr is not None
        said = (re.search(r"(tcp://127\.0\.0\.1:\d+)", line) for line in head.stderr)
        address = next(match[1] for match in said if match)
        worker = ("worker", address, "--host", "127.0.0.1", "--nthreads", "1", "--no-nanny",
                  "--no-dashboard")  # fmt: skip
        hands = [
            stack.enter_context(process(*worker, folder=folder, environment=environment))
            for _ in range(workers)
        ]
        for hand in hands:  # who comes late may find nothing left to do
            assert hand.stderr is not None
            assert any("Registered to:" in line for line in hand.stderr)
        yield address, [head, *hands]
