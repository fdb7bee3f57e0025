"""What is said of the assumptions: on their page, in a run's report, by `cratous monitor` and `cratous certify`."""

from __future__ import annotations

import copy
import json
import re
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.assumptions.listing import LISTING
from cratous.services.assumptions.observation_texts import lines
from cratous.services.certify.rejudge import certify_again
from cratous.services.cli import main


def rows_of_the_page(root: Path) -> list[list[str]]:
    text = (root / "docs/proofs/assumptions.md").read_text(encoding="utf-8")
    table = text.partition("| assumption |")[2].partition("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_the_page_has_each_assumption_and_how_it_is_watched(root: Path) -> None:
    wanted = [
        [
            f"**{one.name}**: {one.text}",
            ", ".join(f"`{name}`" for name in one.theorems),
            ", ".join(one.guarantees),
            one.watch,
        ]
        for one in LISTING
    ]
    assert [row[:4] for row in rows_of_the_page(root)] == wanted


def test_the_theorems_are_there(root: Path) -> None:
    for one in LISTING:
        assert one.theorems
        assert set(one.guarantees) <= {"G1", "G2", "G3", "G4", "G5"}
        for name in one.theorems:
            files = [
                root / "proofs/theorems" / part / f"{name}.py" for part in ("system", "permit")
            ]
            assert any(file.exists() for file in files), name


def test_every_theorem_of_the_system_is_named(root: Path) -> None:
    there = {file.stem for file in (root / "proofs/theorems/system").glob("a*.py")}
    assert there <= {name for one in LISTING for name in one.theorems}


@pytest.fixture(scope="module")
def turning(root: Path, fly_once: Callable[[Path], Path]) -> Path:
    return fly_once(root / "tests" / "missions" / "turning_intruder.yaml")


def test_an_intruder_that_turns_leaves_its_tube_and_violates_nothing(turning: Path) -> None:
    report = json.loads((turning / "report.json").read_text(encoding="utf-8"))
    assert report["verdict"] in (
        "holds",
        "unknown",
    )  # unknown: flown with kernels that have no proof
    broken = [row for row in report["assumptions"] if row["state"] == "broken"]
    assert [row["name"] for row in broken] == ["intruder in its tube"]
    (row,) = broken
    assert (row["guarantees"], row["vehicle"]) == (["G2"], 1)
    (g2,) = [one for one in report["requirements"] if one["requirement"] == "G2"]
    assert g2["verdict"] == "holds"
    (takeover,) = report["flight"]["takeovers"]
    assert takeover["from_ms"] < row["since_ms"] < takeover["to_ms"]
    page = (turning / "report.html").read_text(encoding="utf-8")
    assert f"assumption broken</a> since {row['since_ms'] / 1000:.1f} s" in page
    assert "Without ground since then: that what ICAROUS flies is clear" in page
    assert re.search(r"<tr>\s*<td>an intruder that a takeover avoids", page)
    assert '<tr class="screen"><td>the clock of one end' in page
    # what did not fit when the mission was read stays in its report
    (note,) = [n for n in report["mission"]["notes"] if n.startswith("parameter does not fit: ")]
    assert "daa.buffer is 1.1, expected at least 1.12" in note
    assert f"<li>{note}</li>" in page


def test_certify_refuses_what_the_log_does_not_say(turning: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(turning, tmp_path / "edited"))
    assert certify_again(folder).found == []
    text = (folder / "report.json").read_text(encoding="utf-8")
    report = json.loads(text)
    k = [row["name"] for row in report["assumptions"]].index("intruder in its tube")
    for key, value in (("state", "held"), ("since_ms", 1), ("observed", 1.0), ("lost", "")):
        edited = copy.deepcopy(report)
        edited["assumptions"][k][key] = value
        (folder / "report.json").write_text(json.dumps(edited), encoding="utf-8")
        found = certify_again(folder).found
        assert any(line.startswith(f"assumptions[{k}].{key}: written") for line in found), found
    del edited["assumptions"]
    (folder / "report.json").write_text(json.dumps(edited), encoding="utf-8")
    assert any(
        line.startswith("assumptions: written nothing") for line in certify_again(folder).found
    )
    (folder / "report.json").write_text(text, encoding="utf-8")
    database = sqlite3.connect(folder / "log.sqlite")
    with database:
        database.execute("UPDATE meta SET value = '[]' WHERE key = 'assumptions'")
    database.close()
    found = certify_again(folder).found
    assert found[0] == "log.sqlite: meta.assumptions: written 0 entries, found 1"


def test_monitor_says_them_in_words_and_as_data(
    turning: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["monitor", str(turning), "--allow-unproved"])
    printed = capsys.readouterr().out
    report = json.loads((turning / "report.json").read_text(encoding="utf-8"))
    for line in lines(report["assumptions"]):
        assert line in printed
    assert "assumption intruder in its tube: broken at" in printed
    assert "assumption delivery to ICAROUS: held" in printed
    main(["monitor", str(turning), "--allow-unproved", "--json"])
    assert json.loads(capsys.readouterr().out)["assumptions"] == report["assumptions"]


def test_monitor_loads_no_planner_and_no_pilot(turning: Path) -> None:
    code = (
        "import sys\n"
        "from cratous.services.cli import main\n"
        f"main(['monitor', {str(turning)!r}, '--allow-unproved'])\n"
        "print(*sorted(m for m in sys.modules if m.startswith('cratous.services.') or '.' not in m))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=900
    )
    loaded = set(done.stdout.splitlines()[-1].split())
    assert "cratous.services.monitor" in loaded
    assert not loaded & {
        f"cratous.services.{part}" for part in ("planning", "pipeline", "flight", "icarous")
    }
    assert not loaded & {"z3", "numba", "matplotlib"}


def test_monitor_as_data_says_on_stderr_why_its_exit_code_is_no_0(
    tmp_path: Path, turning: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = Path(shutil.copy(turning / "log.sqlite", tmp_path))
    database = sqlite3.connect(log)
    with database:
        database.execute("DELETE FROM messages WHERE topic = 'cratous.MissionEnd'")
        database.execute("DELETE FROM closing")
    database.close()
    assert main(["monitor", str(log), "--allow-unproved", "--json"]) == 3
    words = capsys.readouterr()
    assert json.loads(words.out)["exit_code"] == 3
    assert "G3 Completion: unknown" in words.err
