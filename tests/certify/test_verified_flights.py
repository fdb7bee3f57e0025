"""`certify --verify` of honest flights that do not hold, and of the same flights told better than they were."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")

import signing
from signing import KEY, retell, verify, write_keys

from cratous.services.cli import main

Report = dict[str, Any]
Edit = Callable[[Report], None]
MISSIONS = ROOT / "tests" / "missions"


def turned(item: str, verdict: str) -> Edit:
    def edit(report: Report) -> None:
        next(row for row in report["constraints"] if row["item"] == item)["verdict"] = verdict

    return edit


def signed_flight(mission: Path, folder: Path) -> Path:
    """Results and views of a flight, signed, with whatever verdict."""
    write_keys(folder, "own", KEY)
    main(["run", str(mission), "--allow-unproved", "--quiet", "--out", str(folder / "flown")])
    (flown,) = (folder / "flown").iterdir()
    shutil.move(flown, folder / "run")
    words = [
        "certify",
        folder / "run",
        "-o",
        folder / "views",
        "--sign",
        "--key",
        folder / "own.pem",
    ]
    assert main([str(word) for word in words]) == read(folder / "run")["exit_code"]
    return folder


def test_an_honest_flight_that_violates_g5_is_verified_as_violated(
    run: Run, tmp_path: Path
) -> None:
    home = signed_flight(MISSIONS / "bridge_cut.yaml", tmp_path)
    bad = [r["item"] for r in read(home / "run")["constraints"] if r["verdict"] == "violated"]
    assert len(bad) == 2
    assert all("heartbeat" in item for item in bad)
    run()  # what was printed up to here
    code, out, err = verify(run, home)
    assert (code, err) == (1, "")
    assert "the report says VIOLATED; verified: VIOLATED; exit code 1" in out
    assert "not decided: G5 heartbeat to the ICAROUS instance of 1: violated, the judge says unk" in out  # fmt: skip
    # the same flight, told better than it was
    retell(home, lambda report: [turned(item, "holds")(report) for item in bad] and None)
    code, out, _ = verify(run, home)
    assert read(home / "run")["exit_code"] == 0
    assert (code, "the report says HOLDS; verified: UNKNOWN; exit code 3" in out) == (3, True)
    # and excused, which only a loss of well clear can be
    retell(home, lambda report: [turned(item, "excused")(report) for item in bad] and None)
    code, _, err = verify(run, home)
    assert (code, err.count("only a loss of well clear can be excused")) == (1, 2)


def loss_of(report: Report) -> dict[str, Any]:
    row = next(row for row in report["constraints"] if row["verdict"] == "excused")
    return dict(row["evidence"]["losses"][0])


def with_loss(**entries: Any) -> Edit:
    def edit(report: Report) -> None:
        row = next(row for row in report["constraints"] if row["verdict"] == "excused")
        row["evidence"] = {"losses": [{**loss_of(report), **entries}]}

    return edit


def no_evidence(report: Report) -> None:
    del next(r for r in report["constraints"] if r["verdict"] == "excused")["evidence"]


def a_way_out_at_one_instant(report: Report) -> None:
    instants = [list(one) for one in loss_of(report)["instants"]]
    instants[3][2] -= 1
    with_loss(instants=instants)(report)


def a_way_out_by_the_check(report: Report) -> None:
    instants = [list(one) for one in loss_of(report)["instants"]]
    instants[3][4] -= 1
    with_loss(instants=instants)(report)


EXCUSES: dict[str, tuple[Edit, str]] = {
    "no evidence": (no_evidence, "the report has no evidence on the loss at 11250 ms"),
    "another loss": (with_loss(lost_ms=11500), "no evidence on the loss at 11250 ms"),
    "another pair": (with_loss(other=8), "is not that of every protected one of the pair"),
    "from the other side": (with_loss(own=9, other=1), "is not that of every protected one"),
    "a way out": (with_loss(answer="a way out"), "there was a way out, or it is not known"),
    "undecided": (with_loss(answer="undecided"), "there was a way out, or it is not known"),
    "nothing was tried": (
        with_loss(instants=[[0, 0, 0, 0, 0]]),
        "there was a way out, or it is not known",
    ),
    "nothing was tried by the bands": (
        with_loss(instants=[[0, 0, 0, 5, 5]]),
        "there was a way out, or it is not known",
    ),
    "nothing was tried by the check": (
        with_loss(instants=[[0, 5, 5, 0, 0]]),
        "there was a way out, or it is not known",
    ),
    "looked at from nowhere": (with_loss(instants=[]), "there was a way out, or it is not known"),
    "one was free": (a_way_out_at_one_instant, "there was a way out, or it is not known"),
    "one was free by the check": (a_way_out_by_the_check, "there was a way out, or it is not"),
}


@pytest.mark.long
def test_an_excuse_is_verified_by_its_evidence_and_never_a_pass(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = signed_flight(MISSIONS / "no_way_out.yaml", tmp_path)
    run()
    code, out, err = verify(run, home)
    assert (code, err) == (3, "")
    assert "the report says EXCUSED; verified: UNKNOWN; exit code 3" in out
    item = "G2 well clear of 1 and 9"
    assert f"not decided: {item}: excused, the judge says violated; it does not judge" in out
    monkeypatch.setattr(signing, "pages", lambda _report: {})  # those of the flight serve as well
    for name, (edit, said) in EXCUSES.items():
        again = Path(shutil.copytree(home, tmp_path / "again", dirs_exist_ok=True))
        retell(again, edit)
        code, _, err = verify(run, again)
        assert (code, f"refused: {item}: excused" in err, said in err) == (1, True, True), (
            name,
            err,
        )
    retell(home, turned("well clear of 1 and 9", "holds"))
    code, _, err = verify(run, home)
    assert (code, f"{item}: judge violated, monitor holds" in err) == (1, True), err
