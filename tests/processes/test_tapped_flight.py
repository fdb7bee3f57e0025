"""A flight in processes whose bridge goes through a tap: it flies as without one, and the watch judges what passes."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.cli import main
from cratous.services.processes.flight import _Flight

REQUIREMENTS = """trace every 500 ms gap 60 s begins with all
signal altitude_1: m from AirVehicleState[ID=1].Location.Altitude hold 60 s
signal altitude_2: m from AirVehicleState[ID=2].Location.Altitude hold 60 s
signal has: bool from AuthorityChange[VehicleID=2].Owner is ICAROUS hold 1 h
signal beat: 1 from Heartbeat[VehicleID=2, Direction=Up].Sequence hold 60 s
requirement FLOOR: altitude_1 >= 90 m and altitude_2 >= 90 m and beat >= 0
requirement NEVER "ICAROUS never has vehicle 2": not has
"""


@pytest.mark.long
def test_it_flies_through_a_tap_as_without_one(
    root: Path,
    tmp_path: Path,
    fly_once: Callable[[Path], Path],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    mission = root / "examples/crossing/mission.yaml"
    virtual = json.loads((fly_once(mission) / "report.json").read_text())
    file, log = tmp_path / "r.req", tmp_path / "watched.sqlite"
    file.write_text(REQUIREMENTS)
    watches: list[subprocess.Popen[str]] = []

    def doors(flight: _Flight, instances: list[int]) -> dict[int, int]:
        words = ["--attach", f"cratous://127.0.0.1:{flight.ports.icarous}"]
        words += ["--listen", "127.0.0.1:0", "--requirements", str(file), "--keep", str(log)]
        watch = subprocess.Popen(
            [sys.executable, "-m", "cratous", "monitor", *words, "--json"],
            stdout=(tmp_path / "live.txt").open("w"), stderr=subprocess.PIPE, text=True,
            env={**os.environ, **flight.keys.environment()},
        )  # fmt: skip
        watches.append(watch)
        assert watch.stderr is not None
        for line in watch.stderr:
            if found := re.search(r"clients connect to 127\.0\.0\.1:(\d+)", line):
                return dict.fromkeys(instances, int(found[1]))
        raise AssertionError("the tap does not listen")

    monkeypatch.setattr(_Flight, "_doors", doors)
    out = tmp_path / "out"
    words = ["run", str(mission), "--processes", "--rate", "4", "--out", str(out)]
    # G5 is about the machine's time: a loaded one may be late
    assert main([*words, "--allow-unproved"]) in (1, 3)
    (watch,) = watches
    watch.send_signal(signal.SIGINT)
    assert watch.wait(60) == 1
    flown = json.loads((out / "crossing" / "report.json").read_text())
    for key in ("task_id", "vehicle_id", "option_id", "start_ms", "end_ms"):
        assert [i[key] for i in flown["plan"]["items"]] == [
            i[key] for i in virtual["plan"]["items"]
        ]
    assert flown["flight"]["outcome"] == virtual["flight"]["outcome"] == "complete"
    taken = [{t["vehicle"] for t in r["flight"]["takeovers"]} for r in (flown, virtual)]
    assert taken == [{2}, {2}]
    live = (tmp_path / "live.txt").read_text()
    result = json.loads(live[live.index("\n{\n") :])
    assert [r["verdict"] for r in result["requirements"]] == ["holds", "violated"]
    assert "unsealed" not in {f["kind"] for f in result["findings"]}
    capsys.readouterr()
    assert main(["monitor", str(log), "--requirements", str(file), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["requirements"] == result["requirements"]
