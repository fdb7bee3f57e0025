"""`cratous campaign` on the command line: what is refused, and how."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from campaign_child import written
from campaign_tools import loss_found

from cratous.services.cli import main

ROOT = Path(__file__).resolve().parents[2]
CROSSING = ROOT / "examples" / "crossing" / "mission.yaml"


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["nowhere.yaml"], "no such file"),
        ([str(CROSSING), "--seeds", "5-1"], "1-50"),
        ([str(CROSSING), "--seeds", "0-3"], "1-50"),
        ([str(CROSSING), "--workers", "0"], "workers"),
        ([str(CROSSING), "--find", "G9"], "G9"),
        ([str(CROSSING), "--find", "worst", "G9"], "G9"),
        ([str(CROSSING), "--find", "worst"], "worst"),
        ([str(CROSSING), "--find", "G2", "G3"], "unexpected extra argument (G3)"),
        ([str(CROSSING), "G2"], "unexpected extra argument (G2)"),
        ([str(CROSSING.parent.parent / "relations" / "mission.yaml"), "--seeds", "1-2"], "no variants"),
    ],
)  # fmt: skip
def test_bad_input_is_named_and_nothing_is_written(
    arguments: list[str], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["campaign", *arguments]) == 2
    assert named in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "asked", ["FILE --find G2", "FILE --find worst G2", "--find worst G2 FILE", "--find G2 FILE"]
)
def test_a_search_without_a_space_is_refused(
    asked: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = written(tmp_path, {"plain": ""}, ""), tmp_path / "out"
    words = [str(file) if word == "FILE" else word for word in asked.split()]
    code = main(["campaign", *words, "--allow-unproved", "--json", "-o", str(out)])
    assert code == 2
    assert "nothing to search" in json.loads(capsys.readouterr().out)["error"]
    assert not out.exists()


@pytest.mark.slow
def test_found_is_a_mission_that_fails_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head_on = "generator: {kind: head_on}\nseeds: [1, 1]\noptions: [{name: bare, daa: false}]\n"
    out = loss_found(tmp_path, f"name: bare\n{head_on}")
    assert "G2 fails in bare-bare-seed1, after 1 runs" in capsys.readouterr().out
    case = str(out / "found-G2.yaml")
    flags = ["--no-daa", "--allow-unproved", "--json"]
    assert main(["run", case, *flags, "--out", str(tmp_path / "f")]) == 1
    found = json.loads(capsys.readouterr().out)
    stored = json.loads((out / "search.json").read_text())
    (row,) = [row for row in found["requirements"] if row["requirement"] == "G2"]
    assert row["verdict"] == "violated"
    assert row["margin"] == stored["points"][0]["margin"], (
        "nothing was made smaller with this budget"
    )
