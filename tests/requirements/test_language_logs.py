"""The language of requirements over message logs: signals, words, lists, what a log lacks."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from cratous.bridge.lmcp.messages import cmasi
from cratous.services.cli import main
from cratous.services.logs.log import LogWriter
from cratous.services.requirements.language import read
from cratous.services.requirements.watch import watch
from cratous.spec.errors import BadInput


def _log(folder: Path) -> Path:
    with LogWriter(folder / "log.sqlite") as log:
        for n in range(8):
            state = cmasi.AirVehicleState(ID=1 + n % 2, Groundspeed=20.0 + n)
            state.Location = cmasi.Location3D(Altitude=100.0 * (1 + n % 2))
            log.tap(_envelope(n, 500 * (n // 2), state))
    return folder / "log.sqlite"


def _envelope(seq, time_ms, body):
    from cratous.services.bus import Envelope

    return Envelope(seq, time_ms, "sim", "afrl.cmasi.AirVehicleState", body)


FROM = "AirVehicleState[ID={}].{}"


def test_signals_of_a_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = _log(tmp_path)
    file = tmp_path / "r.req"
    file.write_text(
        "trace every 500 ms gap 600 ms\n"
        f"signal one: m from {FROM.format(1, 'Location.Altitude')} hold 1 s\n"
        f"signal two: m from {FROM.format(2, 'Location.Altitude')} hold 1 s\n"
        f"signal fast: m/s from {FROM.format(2, 'Groundspeed')}\n"
        'requirement HIGHER "two above one" source "plan 3": two > one\n'
        "requirement SLOW: fast <= 26 m/s\n"
    )
    assert main(["monitor", str(log), "--requirements", str(file), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    higher, slow = data["requirements"]
    assert (higher["verdict"], higher["holds"]) == ("holds", 4)
    assert higher["margins"][0]["least"] == -100
    assert (slow["verdict"], slow["first_violated_s"], slow["decided_at_s"]) == (
        "violated",
        1.5,
        1.5,
    )
    assert data["findings"] == []
    assert main(["monitor", str(log), "--requirements", str(file), "--verdicts"]) == 1
    out = capsys.readouterr().out
    assert "SLOW:1.5,F" in out
    assert "HIGHER (two above one): holds" in out
    assert "fast - 26 m/s: least -5 m/s at 0 s, greatest 1 m/s at 1.5 s" in out


def test_a_message_that_never_comes_leaves_its_requirements_unknown(tmp_path: Path) -> None:
    text = (
        f"signal high: m from {FROM.format(1, 'Location.Altitude')}\n"
        "signal alive: bool from BridgeStatus[VehicleID=1].Alive\n"
        "requirement HIGH: high >= 100 m\nrequirement LINK: alive\n"
    )
    found = watch(read(text), _log(tmp_path))
    assert [one.verdict for one in found.outcomes] == ["holds", "unknown"]
    assert [f.text for f in found.findings] == ["alive: no value ever came"]


@pytest.mark.parametrize("name", ["requirements", "guarantees"])
def test_the_examples_hold_on_the_flight_that_they_are_of(name, root, fly_once) -> None:
    folder = root / "examples" / "crossing"
    log = fly_once(folder / "mission.yaml") / "log.sqlite"
    found = watch(read((folder / f"{name}.req").read_text(), files=folder), log)
    wanted = {"holds"} if name == "guarantees" else {"holds", "undecided"}
    assert {one.verdict for one in found.outcomes} == wanted
    assert found.findings == ()


def test_a_word_of_a_field_is_a_truth_value(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log.sqlite") as log:
        for n, mode in enumerate(("Waypoint", "Waypoint", "Loiter")):
            log.tap(_envelope(n, 500 * n, cmasi.AirVehicleState(ID=1, Mode=mode)))
    text = "signal on_way: bool from AirVehicleState[ID=1].Mode is Waypoint\nrequirement R: on_way"
    (one,) = watch(read(text), tmp_path / "log.sqlite").outcomes
    assert (one.holds, one.violated, one.first_violated) == (2, 1, 10**9)


def test_a_field_in_a_list_is_that_of_its_place(tmp_path: Path) -> None:
    """A list that is shorter, or has something without the field there, brings no value."""
    from cratous.bridge import lmcp

    def told(actions: list[object]) -> object:
        body = lmcp.new("VehicleActionCommand", VehicleID=1, VehicleActionList=actions)
        return lmcp.new("GatedCommand", VehicleID=1, Command=body)

    fast = cmasi.FlightDirectorAction(Speed=30.0)
    bodies = [told([fast]), told([]), told([cmasi.GoToWaypointAction()]), told([fast])]
    with LogWriter(tmp_path / "log.sqlite") as log:
        for n, body in enumerate(bodies):
            log.tap(replace(_envelope(n, 500 * n, body), topic="cratous.GatedCommand"))
    path = "GatedCommand[VehicleID=1].Command.VehicleActionList.0.Speed"
    text = f"signal speed: m/s from {path}\nrequirement R: speed >= 30 m/s"
    (one,) = watch(read(text), tmp_path / "log.sqlite").outcomes
    assert (one.holds, one.unknown) == (2, 2)


def test_of_a_log_that_is_not_whole_nothing_holds(tmp_path: Path) -> None:
    import sqlite3

    spec = read(
        f"signal one: m from {FROM.format(1, 'Location.Altitude')} hold 1 s\nrequirement R: one > 0 m"
    )
    log = _log(tmp_path)
    assert watch(spec, log).outcomes[0].verdict == "holds"
    with sqlite3.connect(log) as base:
        base.execute("DELETE FROM closing")
    found = watch(spec, log)
    assert (found.outcomes[0].verdict, [f.kind for f in found.findings]) == ("unknown", ["open"])
    with sqlite3.connect(log) as base:
        base.execute("DELETE FROM messages WHERE seq = 3")
    found = watch(spec, log)
    assert (found.outcomes[0].verdict, [f.kind for f in found.findings]) == (
        "unknown",
        ["open", "lost"],
    )
    until = found.outcomes[0].until / 1e9
    said = f"violated at no sample until {until:g} s, but samples or messages are missing, so nothing holds"
    assert found.outcomes[0].so_far == said


def test_a_log_that_was_changed_is_refused(tmp_path: Path) -> None:
    import sqlite3

    log = _log(tmp_path)
    with sqlite3.connect(log) as base:
        base.execute("UPDATE messages SET body = replace(body, '100.0', '900.0')")
    spec = read(
        f"signal one: m from {FROM.format(1, 'Location.Altitude')} hold 1 s\nrequirement R: one > 0 m"
    )
    with pytest.raises(BadInput):
        watch(spec, log)


@pytest.mark.parametrize(
    ("signal", "what"),
    [
        ("ft from AirVehicleState[ID=1].Location.Altitude", "the field has another unit"),
        ("bool from AirVehicleState[ID=1].Groundspeed", "the field is no bool"),
        ("m from AirVehicleState[ID=1].Nothing", "the message type has no such field"),
        ("m from AirVehicleState[Nobody=1].Location.Altitude", "the message has no such field"),
        ("1 from AirVehicleState[ID=1].Location", "the field is of another kind"),
        ("m from Sent[].x", "the log has no message of this type"),
        ("m", "nothing says where a log has this signal"),
        ("bool from AirVehicleState[ID=1].Mode is Wayponit", "the field is never this word"),
        ("bool from AirVehicleState[ID=1].Groundspeed is Waypoint", "the field is never this word"),
    ],
)  # fmt: skip
def test_what_a_log_does_not_have(tmp_path: Path, signal: str, what: str) -> None:
    atom = "q" if signal.startswith("bool") else f"q >= 0 {signal.split()[0]}"
    with pytest.raises(BadInput) as told:
        watch(read(f"signal q: {signal}\nrequirement R: {atom}"), _log(tmp_path))
    assert told.value.what == what


def test_what_nothing_tested_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    trace, file = tmp_path / "t.csv", tmp_path / "r.req"
    trace.write_text("time_s,x\n0,1\n1,3\n")
    file.write_text(
        "trace every 1 s\nsignal x: m\nrequirement NEVER: x > 5 m implies x > 9 m\n"
        "requirement ONCE: x > 2 m implies once within 1 s x > 0 m\nrequirement PLAIN: x > 0 m\n"
    )
    assert main(["monitor", str(trace), "--requirements", str(file), "--verdicts"]) in (0, 3)
    lines = capsys.readouterr().out.splitlines()
    said = [line for line in lines if "nothing tested it" in line]
    assert [line.partition(":")[0] for line in said] == ["NEVER"]
    assert sum(line.endswith(",T") for line in lines) == 6
    assert main(["monitor", str(trace), "--requirements", str(file), "--json"]) in (0, 3)
    found = json.loads(capsys.readouterr().out)
    assert found["untested"] == ["NEVER"]
    (note,) = found["notes"]
    assert note.startswith("no gap is stated")
    assert f"note: {note}" in lines
    assert main(["check", str(file)]) == 0
    assert f"{file}: {note}" in capsys.readouterr().out
    file.write_text(file.read_text().replace("every 1 s", "every 1 s gap 1 s"))
    assert main(["monitor", str(trace), "--requirements", str(file), "--json"]) in (0, 3)
    assert json.loads(capsys.readouterr().out)["notes"] == []
