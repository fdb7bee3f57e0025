"""`cratous monitor` on logs that are not what their writer left: refused, or unknown at best."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.cli import main

CUT = "DELETE FROM messages WHERE topic LIKE '%VehicleState' AND seq % 7 = 0"


@pytest.mark.parametrize("more", [[], ["--model"]])
@pytest.mark.parametrize(
    ("edits", "code", "says"),
    [
        ([], 0, ""),
        ([CUT], 2, "the messages are not those that were logged"),
        (["DELETE FROM closing"], 3, "unknown at best: the log has no end"),
        (
            ["INSERT INTO meta VALUES ('selected', 'true')"],
            3,
            "unknown at best: messages of the log were selected",
        ),
        (["DELETE FROM closing", CUT], 3, "unknown at best: messages of the log are missing"),
    ],
)
def test_a_log_that_is_not_whole_holds_nothing(
    fly_once: Callable[[Path], Path], root: Path, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], edits: list[str], code: int, says: str, more: list[str],
) -> None:  # fmt: skip
    log = tmp_path / "log.sqlite"
    shutil.copy(fly_once(root / "examples" / "crossing" / "mission.yaml") / "log.sqlite", log)
    with sqlite3.connect(log) as base:
        for edit in edits:
            base.execute(edit)
    base.close()
    found = main(["monitor", str(log), "--allow-unproved", *more])
    assert found in ((code,) if edits else (0, 3))
    said = capsys.readouterr()
    assert says in said.out + said.err
    if not edits:
        assert "unknown at best" not in said.out + said.err
