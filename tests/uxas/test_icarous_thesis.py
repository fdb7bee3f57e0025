"""The thesis's dialect between UxAS's end and an ICAROUS of our own, over loopback: a flight, and refusals."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bridge_flight as flight
import pytest
from icarous_rig import Rig, state

from cratous.bridge import text_protocol as tp
from cratous.bridge.port import address
from cratous.bridge.text_port import TextPort
from cratous.services.cli import main
from cratous.services.cli.icarous import craft_of
from cratous.services.icarous_program.program import Program
from cratous.services.icarous_program.step import IcarousEnd

SERVICE = "IcarousCommunicationService"  # named here for the table of services

THESIS = tp.Dialect.THESIS


def aircraft() -> tuple[flight.Aircraft, flight.Aircraft]:
    """The vehicle of the mission, and one that meets it."""
    return flight.Aircraft(1, -300.0, 0.0, 0.0), flight.Aircraft(90, 2000.0, 2300.0, 270.0)


@pytest.mark.shows(SERVICE, "Dialect")
def test_what_the_thesis_s_peer_is_told(tmp_path: Path, opened: list[Any]) -> None:
    """A plan of 121 waypoints goes in one, counted from 1, with its total on each line; no epochs."""
    rig = Rig(tmp_path, 'NumberOfUAVs="1" Dialect="thesis"', opened)
    one = rig.fake(dialect=THESIS)
    rig.tell(state(1), flight.way(*((100.0 * k, 0.0) for k in range(1, 121))))
    rig.until(lambda: one.all(tp.OwnPosition) or rig.tell(state(1)))
    assert {w.total for w in one.all(tp.Waypoint)} == {121}
    assert [w.index for w in one.all(tp.Waypoint)] == list(range(121))
    assert b"WAYPTtotal121,index1,lat45," in one.raw
    assert b"COMNDtypeSTART_MISSION,\n" in one.raw
    assert not [r for r in one.got if isinstance(r, tp.WireError | tp.Skipped)]
    assert one.all(tp.SoftReset)[0].lat_deg is not None
    one.say(tp.SetMode("ACTIVE"))
    rig.until(lambda: rig.got("AuthorityChange"))
    one.say(tp.SetVelocity(10.0, 10.0, 0.0), tp.GoToWaypoint(3), tp.SetMode("PASSIVE"))
    rig.until(lambda: rig.got("MissionCommand"))
    actions = [c.VehicleActionList[0] for c in rig.got("VehicleActionCommand")]
    assert [type(a).__name__ for a in actions] == ["FlightDirectorAction", "GoToWaypointAction"]
    assert actions[1].WaypointNumber == 3  # index 0 is the vehicle's place, 1 the first of the plan
    assert [c.Owner.name for c in rig.got("AuthorityChange")] == ["ICAROUS", "UxAS"]


def test_takeover_avoidance_handback_and_the_mission_is_done(
    tmp_path: Path, opened: list[Any]
) -> None:
    more = 'NumberOfUAVs="1" Dialect="thesis" DeviationAllowed="40" DeviationOrigin="path"'
    rig = Rig(tmp_path, more, opened)
    notes: list[str] = []
    where = address(f"tcp://127.0.0.1:{rig.port}", ("tcp",))
    port = TextPort(where, server=False, dialect=THESIS)
    opened.append(port)
    end = IcarousEnd(craft_of(flight.mission_file(tmp_path), 1, THESIS))
    pilot = Program(end, port, lambda severity, text: notes.append(f"{severity} {text}"))
    own, other = aircraft()
    rig.tell(flight.way(*flight.WAY))
    own.told(flight.way(*flight.WAY))
    now_ms, nearest_m, read = 0, math.inf, 0

    def settled() -> bool:
        """ICAROUS has flown this heartbeat, and UxAS has heard what it said."""
        pilot.turn()
        heard = rig.service.port.counts.received == port.counts.sent
        return heard and pilot.state.now_ms == now_ms

    for _ in range(900):
        rig.tell(other.state(now_ms), own.state(now_ms))
        rig.until(settled)
        commands = [*rig.sent[read:]]
        read = len(rig.sent)
        for envelope in commands:
            kind = type(envelope.body).__name__
            if envelope.source == SERVICE and kind in ("MissionCommand", "VehicleActionCommand"):
                own.told(envelope.body)
        for _ in range(round(flight.BEAT_MS / 1000 / flight.STEP_S)):
            own.step()
            other.step()
            p, q = own.air.position, other.air.position
            nearest_m = min(nearest_m, math.hypot(p.north_m - q.north_m, p.east_m - q.east_m))
        now_ms += flight.BEAT_MS
        if 4 in own.passed:
            break
    assert {1, 2, 3, 4} <= set(own.passed), (own.passed, notes)
    assert nearest_m > 150.0
    assert [change.Owner.name for change in rig.got("AuthorityChange")] == ["ICAROUS", "UxAS"]
    assert len(rig.got("VehicleActionCommand")) > 3
    assert [p.TaskID for p in rig.got("TaskPause")] == [flight.TASK]
    assert [r.TaskID for r in rig.got("TaskResume")] == [flight.TASK]
    assert port.counts.refused == rig.service.port.counts.refused == {}
    assert not [text for text in notes if "refused" in text], notes
    assert not [line for line in rig.said if "refused" in line], list(rig.said)


@pytest.mark.slow
def test_the_command_speaks_it_and_another_dialect_is_refused_on_both_ends(
    tmp_path: Path, opened: list[Any]
) -> None:
    more = 'NumberOfUAVs="1" VehicleIDs="1" Dialect="thesis"'
    cfg, sim_port, ics_port = flight.configuration(tmp_path, more)
    with flight.command(tmp_path, "uxas", "-cfgPath", str(cfg)):
        flight.listening(tmp_path)
        with flight.icarous(tmp_path, ics_port, "--wait", "5", "--log", "wrong") as wrong:
            assert wrong.wait(120) == 3
        reason = "line of another dialect: thesis is spoken here"
        assert f"the other end refuses: {reason}" in flight.said(tmp_path)
        (told,) = tmp_path.glob("said_uxas_*")
        assert reason in told.read_text()
        with flight.icarous(tmp_path, ics_port, "--thesis") as pilot:
            own, other = aircraft()
            sim = flight.Simulator(sim_port, own, other)
            opened.append(sim)
            sim.client.send(flight.way(*flight.WAY), 1, 1)
            own.told(flight.way(*flight.WAY))
            for _ in range(150):  # ICAROUS says nothing until it takes over
                sim.beat(0.1)
                if own.steered:
                    break
            assert own.steered, flight.said(tmp_path)
            pilot.terminate()
            assert pilot.wait(120) == 0


@pytest.mark.parametrize("other", ["--original", "--v2", "--plain"])
def test_one_dialect_at_a_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], other: str
) -> None:
    words = ["--mission", str(flight.mission_file(tmp_path)), "--vehicle", "1", "--thesis", other]
    assert main(["icarous", "--connect", "127.0.0.1:9", *words]) == 2
    assert "one of --plain, --original, --thesis and --v2" in capsys.readouterr().err
