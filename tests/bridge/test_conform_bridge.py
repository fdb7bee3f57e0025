"""`cratous conform bridge`: the published lines and sessions, and what must not pass."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cratous.services.cli import main
from cratous.services.conform import bridge
from cratous.spec.errors import BadInput

VECTORS = Path(__file__).resolve().parents[3] / "shared" / "vectors" / "cratous"
GOOD = {"n": 1, "direction": "ICAROUS->UxAS", "line": "GOTOWP,id3,\n", "strict": "accept"}


def test_a_case_with_another_verdict_or_another_form_fails() -> None:
    assert bridge.judge({**GOOD, "kind": "valid"}).status == "passed"
    assert bridge.judge({**GOOD, "strict": "reject"}).label == "another verdict"
    assert bridge.judge({**GOOD, "line": "GOTOWP,idx,\n"}).label == "another verdict"
    spaced = {**GOOD, "line": "SETVEL,north1,east2.0,down3.0,\n".replace("1,", "1.0,")}
    assert bridge.judge({**spaced, "kind": "valid"}).label == "written otherwise"
    assert bridge.judge({"ev": "send", "who": "ICS", "data": "POSTN,\n"}).status == "failed"
    assert bridge.judge({"ev": "publish"}).status == "not covered"
    hello = {"n": 2, "direction": "UxAS->ICAROUS", "strict": "reject", "kind": "handshake"}
    assert bridge.judge({**hello, "line": "ok "}).status == "passed"
    assert bridge.judge({**hello, "line": "okay"}).status == "not covered"


def test_a_distance_from_a_leg_is_neither_more_nor_less_than_it_is() -> None:
    leg = {"lat1": 45.3, "lon1": -121, "lat2": 45.3, "lon2": -120.9, "lat": 45.3045, "lon": -120.95}
    true_m = 499.22876227907034  # of the published file
    assert bridge.judge({**leg, "true_m": true_m}).status == "passed"
    assert bridge.judge({**leg, "true_m": true_m * (1 - 2e-6)}).label == "taken for farther"
    assert bridge.judge({**leg, "true_m": true_m * (1 + 2e-6)}).label == "taken for nearer"
    with pytest.raises(BadInput, match="lat2"):
        bridge.judge({"true_m": 1.0, "lat1": 0.0, "lon1": 0.0})


def test_the_ellipsoid_that_is_flown_on_is_asked_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quarter of a percent between the sphere and the ellipsoid is there, and no more is let pass than can be."""
    leg = {"lat1": 45.3, "lon1": -121, "lat2": 45.3, "lon2": -120.9, "lat": 45.3045, "lon": -120.95}
    monkeypatch.setattr(bridge, "ELLIPSOID", 1e-4)
    case = {**leg, "true_m": 499.22876227907034}
    assert bridge.judge(case).status == "failed"
    assert "within 0.0001 of it" in bridge.judge(case).text


@pytest.mark.parametrize("wrong", [{"strict": "maybe"}, {"line": 5}, {"direction": "sideways"}])
def test_what_is_no_case_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(BadInput):
        bridge.judge({**GOOD, **wrong})


@pytest.mark.skipif(not VECTORS.is_dir(), reason="no ../shared/vectors/cratous")
def test_the_published_lines_and_sessions(capsys: pytest.CaptureFixture[str]) -> None:
    names = ("examples.jsonl", "deviation_formula.jsonl", "sessions")
    files = [str(VECTORS / name) for name in names]
    assert main(["conform", "bridge", *files, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["failed"], report["passed"]) == (0, 67 + 200 + 155)
    assert report["knife_edges"] == 8
