"""The command line: help for a newcomer, exit codes, one message for bad input, nothing left."""

from __future__ import annotations

import json
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from cratous import __version__
from cratous.services.cli import COMMANDS, main

ROOT = Path(__file__).resolve().parents[2]
CROSSING = ROOT / "examples" / "crossing" / "mission.yaml"
RELATIONS = ROOT / "examples" / "relations" / "mission.yaml"
WATERWAY = ROOT.parent / "shared" / "examples" / "openuxas" / "waterway"
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def flown(fly_once: Callable[[Path], Path]) -> Path:
    """The folder of a flown crossing; whether the ledger vouches is another test's business."""
    done = fly_once(CROSSING)
    assert report_of(done)["exit_code"] in (0, 3)
    return done


def report_of(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "report.json").read_text(encoding="utf-8")))


def test_version(run: Run) -> None:
    assert run("version") == (0, f"cratous {__version__} (Python {sys.version.split()[0]})\n", "")
    assert json.loads(run("version", "--json")[1])["cratous"] == __version__
    assert run("--version") == (0, f"cratous {__version__}\n", "")


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_explains_itself(run: Run, command: str) -> None:
    code, out, err = run(command, "--help")
    assert (code, err) == (0, "")
    assert "Usage: cratous " + command in out
    if command != "algebra":
        assert f"cratous {command}" in out.split("Example", 1)[1], "an example that can be typed"


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from cratous.services.cli import main; main(['--help']); "
        "heavy = {'numpy', 'numba', 'z3', 'shapely', 'rich', 'lxml', 'jinja2', 'yaml', 'starlette', 'uvicorn'}; "
        "print('HEAVY', sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "HEAVY []" in done.stdout


def test_unknown_commands_and_options(run: Run) -> None:
    assert run("fly")[0] == 2
    assert run("run")[0] == 2
    code, _, err = run("run", CROSSING, "--fast")
    assert (code, "--fast" in err) == (2, True)
    assert run("run", CROSSING, "--seeds", "9-1")[0] == 2
    assert run("run", CROSSING, "--seed", "1", "--seeds", "1-2")[0] == 2


def bad(folder: Path, old: str, new: str) -> Path:
    text = CROSSING.read_text(encoding="utf-8")
    assert old in text
    path = folder / "bad.yaml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


ZONES = 'relations: "|(p1 p2)"'
CASES = {
    "self-crossing zone": (
        ZONES,
        ZONES + "\nzones: [{id: 7, kind: keep_out, vertices: [[900, 900], [950, 950], "
        "[950, 900], [900, 950]]}]",
        ("zone 7", "edge 1", "edge 3", "zones[0].vertices"),
    ),
    "unknown task": (ZONES, 'relations: "|(p1 p5)"', ("unknown task p5", "^", "p1 p2")),
    "eligible vehicle": ("eligible: [2]", "eligible: [8]", ("does not exist", "1, 2", "got 8")),
    "start in a keep-out": (
        ZONES,
        ZONES + "\nzones: [{id: 7, kind: keep_out, vertices: [[-2300, -9], [-2300, 9], "
        "[-2100, 9], [-2100, -9]]}]",
        ("vehicle 1 starts inside keep-out zone 7", "expected", "got -2200 m north"),
    ),
    "instances": (
        ZONES,
        ZONES + "\nbridge: {instances: 3}",
        ("more ICAROUS instances than vehicles", "at most 2", "got 3"),
    ),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("command", ["run", "plan"])
def test_bad_input(run: Run, tmp_path: Path, case: str, command: str) -> None:
    old, new, words = CASES[case]
    path = bad(tmp_path, old, new)
    more = ["--out", tmp_path / "out"] if command == "run" else []
    code, out, err = run(command, path, *more)
    assert code == 2
    assert out == ""
    assert f"{path}:" in err, "the message names the file"
    for word in words:
        assert word in err
    assert err.count("cratous: ") == 1, "one message"
    assert "Traceback" not in err
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["bad.yaml"]


def test_a_missing_file(run: Run, tmp_path: Path) -> None:
    code, out, err = run("run", tmp_path / "absent.yaml", "--out", tmp_path / "out")
    assert (code, out) == (2, "")
    assert "absent.yaml" in err
    assert "no such file" in err
    assert list(tmp_path.iterdir()) == []


def test_no_plan_exists(run: Run, tmp_path: Path) -> None:
    path = bad(tmp_path, ZONES, 'relations: "|(p1 p2)_[0-1000]"')
    code, out, err = run("run", path, "--out", tmp_path / "out", "--allow-unproved", "--quiet")
    assert (code, out) == (1, "")
    assert "no plan exists, because " in err
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["bad.yaml"]


def test_errors_as_json(run: Run, tmp_path: Path) -> None:
    code, out, err = run("run", tmp_path / "absent.yaml", "--json")
    assert (code, err) == (2, "")
    data = json.loads(out)
    assert data["exit_code"] == 2
    assert data["where"].endswith("absent.yaml")
    path = bad(tmp_path, ZONES, 'relations: "|(p1 p2)_[0-1000]"')
    code, out, _ = run("plan", path, "--json")
    assert code == 1
    assert json.loads(out)["reasons"]


def test_several_problems_in_one_message(run: Run, tmp_path: Path) -> None:
    path = bad(tmp_path, "heading_deg: 0", "heading_deg: 999\n    wings: 2")
    _, _, err = run("plan", path)
    assert "out of range" in err
    assert "also: " in err
    assert "unknown entry" in err


def test_an_internal_error_is_one_line(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    library: dict[str, Any] = {}
    # a checkout may lie in a folder of the product's name, with the libraries below it
    text = "def deep():\n    raise RuntimeError('a defect')\n"
    exec(compile(text, "/x/cratous/.venv/lib/deep.py", "exec"), library)

    def fail(*_arguments: object) -> None:
        library["deep"]()

    monkeypatch.setattr("cratous.services.loading.load", fail)
    code, _, err = run("plan", CROSSING)
    assert code == 70
    assert "internal error (RuntimeError: a defect) at services/" in err
    assert "Traceback" not in err
    with pytest.raises(RuntimeError):
        main(["plan", str(CROSSING), "--debug"])


def test_plan(run: Run) -> None:
    code, out, _ = run("plan", CROSSING)
    assert code == 0
    assert "vehicle 1: p1; vehicle 2: p2" in out
    data = json.loads(run("plan", CROSSING, "--json")[1])
    assert {row["verdict"] for row in data["constraints"]} == {"holds"}


def test_plan_tells_the_notes_of_a_mission(run: Run, tmp_path: Path) -> None:
    zone = """zones:
  - id: 7
    kind: keep_out
    padding_m: 10
    vertices: [[9000, 9000], [9500, 9000], [9500, 9500]]
"""
    file = tmp_path / "m.yaml"
    file.write_text(CROSSING.read_text(encoding="utf-8") + zone)
    code, out, _ = run("plan", file)
    assert code == 0
    assert "note: zone 7 is widened by its padding of 10 m" in out
    data = json.loads(run("plan", file, "--json")[1])
    assert data["notes"] == ["zone 7 is widened by its padding of 10 m"]


def test_the_ledger_is_a_gate(
    run: Run, flown: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cratous.core import ledger

    empty: dict[str, Any] = {"kernels": {}, "theorems": {}, "seal": "", "solver": ""}
    monkeypatch.setattr(ledger, "read", lambda *_path: empty)
    code, out, err = run("run", CROSSING, "--out", tmp_path / "out", "--quiet")
    assert (code, out) == (2, "")
    assert "ledger does not vouch" in err
    assert list(tmp_path.iterdir()) == []
    words = ("run", CROSSING, "--seed", 3, "--out", tmp_path, "--quiet", "--allow-unproved")
    done = run(*words)
    assert done[0] == 3, done[2]
    folder = tmp_path / "crossing-seed3"
    assert report_of(folder)["log"]["digest"] != report_of(flown)["log"]["digest"]
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "Flown with --allow-unproved" in page


def test_a_run_leaves_one_whole_folder(flown: Path) -> None:
    assert [entry.name for entry in flown.parent.iterdir()] == ["crossing"]
    names = sorted(entry.name for entry in flown.iterdir())
    assert names == [
        "certificate.json", "log.sqlite", "manifest.json", "map.svg", "report.html", "report.json",
    ]  # fmt: skip


def test_the_map_is_a_picture_of_its_own(flown: Path) -> None:
    text = (flown / "map.svg").read_text(encoding="utf-8")
    picture = ElementTree.fromstring(text)
    assert picture.tag == "{http://www.w3.org/2000/svg}svg"
    classes = {element.get("class", "").split(" ")[0] for element in picture.iter()}
    assert {"planned", "track", "taskline", "takeover", "start"} <= classes
    assert ".track" in picture[0].text
    assert "{%" not in text
    assert "http" not in text.replace("http://www.w3.org/2000/svg", ""), "nothing is loaded"


def test_crossing_is_avoided(flown: Path) -> None:
    report = report_of(flown)
    assert {row["verdict"] for row in report["requirements"]} == {"holds"}
    assert report["exit_code"] == (3 if report["proofs"]["problems"] else 0)
    assert report["flight"]["takeovers"]
    assert all(takeover["to_ms"] for takeover in report["flight"]["takeovers"])


def test_without_avoidance_well_clear_is_lost(run: Run, tmp_path: Path) -> None:
    code, out, err = run("run", CROSSING, "--out", tmp_path, "--no-daa", "--allow-unproved")
    assert code == 1
    line = next(line for line in out.splitlines() if line.startswith("G2"))
    assert "violated" in line
    (told,) = (line for line in err.splitlines() if line.startswith("VIOLATION G2"))
    assert told.endswith("UxAS had vehicle 1 since 0.00 s; UxAS had vehicle 2 since 0.00 s")
    assert "not observed: ICAROUS at each heartbeat" in out, "which is known at the end alone"


def test_variants_write_only_a_table(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, _ = run("run", CROSSING, "--seeds", "1-1", "--allow-unproved", "--quiet")
    assert code in (0, 3)
    runs = [line for line in out.splitlines() if line.startswith("crossing-as-written-seed")]
    assert len(runs) == 1
    assert out.splitlines()[-1].startswith("1 run")
    assert list(tmp_path.iterdir()) == []


def test_certify_confirms(run: Run, flown: Path) -> None:
    code, out, err = run("certify", flown)
    assert code == report_of(flown)["exit_code"], err
    assert "confirmed" in out


def test_certify_names_what_was_changed(run: Run, flown: Path, tmp_path: Path) -> None:
    for name, change in (("log", spoil_log), ("report", spoil_report), ("plan", spoil_plan)):
        folder = tmp_path / name
        shutil.copytree(flown, folder)
        word = change(folder)
        before = (folder / "report.html").read_bytes()
        code, _, err = run("certify", folder)
        assert code == 1, name
        assert word in err
        assert (folder / "report.html").read_bytes() == before


def spoil_log(folder: Path) -> str:
    database = sqlite3.connect(folder / "log.sqlite")
    with database:
        database.execute("UPDATE messages SET time_ms = time_ms + 1 WHERE seq = 100")
    database.close()
    return "log.digest"


def spoil_report(folder: Path) -> str:
    report = report_of(folder)
    row = next(row for row in report["constraints"] if row["margin"] is not None)
    row["margin"] += 1000
    (folder / "report.json").write_text(json.dumps(report), encoding="utf-8")
    return "constraints"


def spoil_plan(folder: Path) -> str:
    database = sqlite3.connect(folder / "log.sqlite")
    with database:
        (text,) = database.execute("SELECT value FROM meta WHERE key = 'plan'").fetchone()
        plan = json.loads(text)
        plan["items"][0]["end_ms"] -= 60_000
        database.execute("UPDATE meta SET value = ? WHERE key = 'plan'", (json.dumps(plan),))
    database.close()
    return "plan"


def test_monitor_replays_a_log(run: Run, flown: Path) -> None:
    code, out, _ = run("monitor", flown / "log.sqlite")
    assert code == 0
    assert all(f"G{k}" in out for k in range(1, 6))
    data = json.loads(run("monitor", flown, "--json")[1])
    assert {row["verdict"] for row in data["requirements"]} == {"holds"}


@pytest.mark.parametrize("command", ["monitor", "certify"])
def test_nothing_to_judge(run: Run, tmp_path: Path, command: str) -> None:
    code, out, err = run(command, tmp_path / "absent")
    assert (code, out) == (2, "")
    assert "no such file" in err


@pytest.mark.slow
def test_relations_wait_for_the_real_end(fly_once: Callable[[Path], Path]) -> None:
    report = report_of(fly_once(RELATIONS))
    assert {row["verdict"] for row in report["requirements"]} == {"holds"}
    planned = {item["task_id"]: item for item in report["plan"]["items"]}
    assert planned[2]["wait_ms"] > 0, "the plan waits"
    assert len(planned) == 5, "one of p3 and p4"
    flown = {row["task"]: row["time_ms"] for row in report["flight"]["served"]}
    assert flown[1] > planned[1]["end_ms"] + 5000, "traffic delays the survey"
    waits = [bar for bar in report["flight"]["bars"] if bar["what"] == "wait"]
    assert waits[0]["vehicle"] == 2
    assert waits[0]["to_ms"] >= flown[1], "vehicle 2 waits for the real end"


@pytest.mark.slow
@pytest.mark.skipif(not WATERWAY.is_dir(), reason="the OpenUxAS examples are not there")
def test_waterway(run: Run, tmp_path: Path) -> None:
    run("run", WATERWAY, "--out", tmp_path, "--allow-unproved", "--quiet")
    report = report_of(tmp_path / "waterway")
    assert {row["verdict"] for row in report["requirements"]} == {"holds"}
    assert [item["vehicle_id"] for item in report["plan"]["items"]] == [400]
    assert report["plan"]["makespan_ms"] <= 729_820, "at least as good as the recorded plan"


@pytest.mark.slow
@pytest.mark.parametrize("last", [2, pytest.param(50, marks=pytest.mark.long)])
def test_every_variant_of_the_crossing_is_avoided(run: Run, tmp_path: Path, last: int) -> None:
    words = ("run", CROSSING, "--allow-unproved", "--json")
    code, out, _ = run(*words, "--seeds", f"1-{last}")
    found = json.loads(out)
    assert len({run["result"]["log"] for run in found["runs"]}) == last
    # the same seed in this process: the same flight
    alone = json.loads(run(*words, "--seed", 1, "--out", tmp_path)[1])
    assert alone["digest"] == found["runs"][0]["result"]["log"]
    assert found["disagreements"] == 0
    assert code in (0, 3)
    for run in found["runs"]:
        assert run["result"]["takeovers"] >= 1
        assert {r["verdict"] for r in run["result"]["requirements"].values()} == {"holds"}
