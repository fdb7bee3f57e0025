"""What the gate has found clean is remembered; nothing else is, and nothing changed passes by it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cratous.core import ledger
from cratous.core.authority import gate
from cratous.core.ledger import Problem, Standing
from cratous.services.startup import standing
from cratous.spec.errors import Refused

CLEAN = Standing(3, 2, 0, ())


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Standing]:
    """The whole gate's answers to come; it fails the test if it is asked once more."""
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path))
    # what other tests have registered is no part of the product
    monkeypatch.setattr(standing, "REGISTRY", ledger.load_all())
    answers: list[Standing] = []

    def check(path: Path | None = None) -> Standing:
        return answers.pop(0)

    monkeypatch.setattr(ledger, "check_everything", check)
    return answers


def test_a_clean_standing_is_asked_for_once(asked: list[Standing]) -> None:
    asked.append(CLEAN)
    assert standing.require() == CLEAN
    assert standing.require() == CLEAN
    assert asked == []


def test_a_problem_is_not_remembered_and_refused_each_time(asked: list[Standing]) -> None:
    asked += [Standing(3, 2, 0, (Problem("gate_admits", "changed"),))] * 3
    for _ in range(2):
        with pytest.raises(Refused, match="gate_admits"):
            standing.require()
    assert standing.require(allow_unproved=True).problems
    assert asked == []


@pytest.mark.parametrize("what", ["file", "ledger", "solver", "code", "record", "stranger"])
def test_whatever_changes_goes_through_the_whole_gate(
    asked: list[Standing], what: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked += [CLEAN, CLEAN]
    standing.require()
    if what == "file":  # one byte in one file of the product
        read = Path.read_bytes

        def other(path: Path) -> bytes:
            return read(path) + (b"#" if path.name == "gate.py" else b"")

        monkeypatch.setattr(Path, "read_bytes", other)
    elif what == "ledger":
        other_ledger = standing.ROOT / "core" / "no-ledger.json"
        monkeypatch.setattr(ledger, "LEDGER", other_ledger)
    elif what == "solver":
        monkeypatch.setattr(ledger, "solver_version", lambda: "another")
    elif what == "code":
        known = [entry.function for entry in ledger.load_all().values()]
        name, function = next((n, v) for n, v in vars(gate).items() if v in known)
        code = (lambda *_: True).__code__
        monkeypatch.setattr(function, "__code__", code)
        assert name
    elif what == "record":
        (file,) = (tmp_path / "cratous" / "standing").iterdir()
        file.write_text('{"kernels": "many"}', encoding="utf-8")
    else:
        strangers: dict[str, Any] = {**ledger.load_all(), "another": None}
        monkeypatch.setattr(standing, "REGISTRY", strangers)
    standing.require()
    assert asked == [], "the whole gate was asked again"
