"""A log is readable after `kill -9` at any moment: real processes, killed at random moments."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

BATCH = 50  # of log_crash_child.py


def kill_writers(folder: Path, rounds: int, seed: str) -> list[dict[str, object]]:
    child = Path(__file__).parents[1] / "children" / "log_crash_child.py"
    done = subprocess.run(
        [sys.executable, str(child), str(folder), str(rounds), seed],
        capture_output=True,
        text=True,
        timeout=900,
        env=os.environ,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return [json.loads(line) for line in done.stdout.splitlines()]


def check(results: list[dict[str, object]]) -> None:
    for result in results:
        assert result["killed"] or result["closing"], result
        if not result["there"]:  # killed before the file had its name
            assert result["committed"] == 0, result
            continue
        assert result["good"], result
        assert result["closing"] or not result["closed"], result
        assert result["killed"] or result["closed"], result
        read, accepted = int(str(result["read"])), int(str(result["accepted"]))
        assert int(str(result["committed"])) <= read <= accepted, result
        assert accepted - read <= BATCH, result
        copy = result["copy"]
        assert isinstance(copy, dict)
        assert copy["good"], result
        assert copy["read"] == read, result


def test_killed_writers_leave_readable_logs(tmp_path: Path) -> None:
    results = kill_writers(tmp_path, 24, "1")
    check(results)
    assert len(results) == 24
    assert sum(int(str(r.get("read", 0))) > 0 for r in results) >= 5


@pytest.mark.long
def test_many_killed_writers_leave_readable_logs(tmp_path: Path) -> None:
    check(kill_writers(tmp_path, 100, "2"))
