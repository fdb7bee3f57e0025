"""Both ends of the bridge with a wire that loses lines: what got lost is asked for again, and no more than so
often; in force is the whole plan and the whole zone, or what was in force before."""

from __future__ import annotations

from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import PROJECTION, VOLUME

from cratous.bridge import text_protocol as tp
from cratous.services.flight import link_end, link_peers
from cratous.services.flight.dynamics import AirState, Limits
from cratous.services.flight.link_lines import MOST_AGAIN
from cratous.services.flight.messages import (
    Beat,
    Connected,
    Down,
    Flown,
    Heard,
    Route,
    Say,
    ZonesKnown,
)
from cratous.services.icarous.state import Config
from cratous.services.icarous_program.step import Craft, IcarousEnd, Note, State, Tell
from cratous.spec.mission import Daa, Position, Zone, ZoneKind

PLAN = tuple(Position(1000.0 * k, 0.0, 300.0) for k in range(6))
# the plan is well inside of all four and of the first three: nothing has to be flown around
CORNERS = ((-9e3, -9e3), (-9e3, 9e3), (18e3, 0.0), (6e3, -9e3))
ZONES = tuple(Zone(k, ZoneKind.KEEP_IN, CORNERS[: 5 - k], 0.0, 500.0 * k) for k in (1, 2))


class Wire:
    """UxAS's end, ICAROUS's end, and between them what loses the lines whose numbers are in `lost`."""

    def __init__(self, lost: Any, original: bool = False) -> None:
        limits = Limits(15.0, 33.0, 0.52, 5.0)
        config = Config(1, Daa(VOLUME), PROJECTION, 500, original)
        dialect = tp.Dialect.ORIGINAL if original else tp.Dialect.CRATOUS
        self.icarous = IcarousEnd(Craft(config, limits, 60.0, dialect=dialect))
        self.uxas = link_end.UxasEnd(PROJECTION)
        self.up, self.down = link_peers.State(), State()
        self.lost, self.count, self.now_ms = lost, 0, 0
        self.said: list[Any] = []
        self.answers: list[Any] = []

    def tell(self, message: Any) -> None:
        self.up, out = self.uxas.handle(self.up, message)
        self.said += [one.body for one in out if isinstance(one, Say)]
        for one in out:
            for line in one.lines if isinstance(one, Down) else ():
                self.count += 1
                if self.count not in self.lost:
                    self.hear(line)

    def hear(self, line: tp.Message) -> None:
        self.down, answers = self.icarous.handle(self.down, line)
        self.answers += answers
        for one in answers:
            if isinstance(one, Tell):
                self.tell(Heard(1, self.now_ms, one.line))

    def fly(self, beats: int) -> None:
        for _ in range(beats):
            self.now_ms += 500
            north = 22.0 * self.now_ms / 1000 - 500.0
            state = AirState(Position(north, 0.0, 300.0), 0.0, 22.0, 0.0)
            self.tell(Beat(self.now_ms, ((1, state),)))

    def mission(self) -> None:
        self.tell(Connected(0, (1,)))
        self.tell(ZonesKnown(ZONES))
        self.tell(Route(1, PLAN, 22.0, 0.0))

    @property
    def told(self) -> Any:
        return self.down.instance.told

    @property
    def asked(self) -> list[tp.LinesMissing]:
        lines = [one.line for one in self.answers if isinstance(one, Tell)]
        return [line for line in lines if isinstance(line, tp.LinesMissing)]

    def errors(self) -> list[str]:
        bodies = [b for b in self.said if type(b).__name__ == "ServiceStatus"]
        return [pair.Value for body in bodies for pair in body.Info if pair.Key == "reason"]

    def in_force(self) -> bool:
        """The whole plan and both zones, as they were told."""
        ways = [(round(p.north_m), round(p.east_m), p.alt_m) for p in self.told.waypoints]
        zones = sorted((z.id, len(z.vertices), z.ceiling_m) for z in self.told.zones)
        return (
            ways == [(p.north_m, p.east_m, p.alt_m) for p in PLAN]
            and zones == [(1, 4, 500.0), (2, 3, 1000.0)]
        )  # fmt: skip


def lines_of_mission() -> int:
    wire = Wire(())
    wire.mission()
    assert wire.in_force()
    wire.fly(8)
    assert wire.asked == []
    return 5 + 4 + 1 + len(PLAN) + 1


LINES = lines_of_mission()


@settings(max_examples=300, deadline=None)
@given(st.sets(st.integers(1, LINES), max_size=4))
def test_what_is_lost_once_is_sent_again(lost: set[int]) -> None:
    whole_second = set(range(6, 10)) <= lost  # of that ICAROUS has heard nothing
    wire = Wire(lost)
    wire.mission()
    wire.fly(8)
    assert wire.in_force() or whole_second, (wire.told, wire.answers)
    assert wire.errors() == []
    assert not wire.down.lost


@settings(max_examples=25, deadline=None)
@given(st.sets(st.integers(1, 400), max_size=150), st.integers(0, 3))
def test_with_any_losses_it_is_in_force_whole_or_not_at_all(lost: set[int], passed: int) -> None:
    wire = Wire(lost)
    wire.mission()
    wire.tell(Flown(1, 1000.0 * passed))
    wire.fly(40)
    assert wire.told.waypoints == () or [round(p.north_m) for p in wire.told.waypoints] == [
        p.north_m for p in PLAN
    ]
    assert all(len(z.vertices) == 5 - z.id for z in wire.told.zones)
    # asked for no more than is answered, and once more
    assert len(wire.asked) <= 3 * 2 * (MOST_AGAIN + 1)
    assert not wire.down.lost


def test_only_the_missing_lines_are_named_and_sent() -> None:
    wire = Wire({LINES - 3, LINES - 4})  # waypoints 2 and 3 of 0 to 5
    wire.mission()
    assert wire.asked == [tp.LinesMissing("WAYPT", 0, 6, 2, 3)]
    assert wire.count == LINES + 3
    assert wire.in_force()
    notes = [b.Note for b in wire.said if type(b).__name__ == "BridgeStatus"]
    assert "lines 2 to 3 of plan of 6 are sent again" in notes


def test_a_line_that_never_comes_is_a_finding_on_both_ends_and_the_old_plan_stays() -> None:
    wire = Wire(())
    wire.mission()
    first = wire.told.waypoints
    heard = wire.hear
    setattr(  # noqa: B010
        wire, "hear",
        lambda line: None if isinstance(line, tp.Waypoint) and line.index == 3 else heard(line),
    )  # fmt: skip
    wire.tell(Route(1, tuple(Position(p.north_m, 50.0, 300.0) for p in PLAN), 22.0, 0.0))
    wire.fly(10)
    assert wire.told.waypoints is first
    assert len(wire.asked) == MOST_AGAIN + 1
    assert wire.errors() == [
        "vehicle 1: lines 3 to 3 of plan of 6 are missing after they were sent again 5 times: "
        "not in force"
    ]
    (error,) = [a for a in wire.answers if isinstance(a, Note) and a.severity == "ERROR"]
    assert error.text == "plan: 5 of 6 lines are there; asked 6 times: it is not in force"
    # a new plan is a new beginning
    setattr(wire, "hear", heard)  # noqa: B010
    wire.tell(Route(1, PLAN, 22.0, 0.0))
    assert wire.in_force()


def test_an_original_peer_is_asked_nothing() -> None:
    wire = Wire({LINES - 3}, original=True)
    wire.mission()
    wire.fly(8)
    assert wire.asked == []


def test_a_command_that_is_not_known_is_answered_and_said() -> None:
    (record,) = tp.StreamParser(tp.Direction.DOWN).feed(b"COMND,typeDIVE-NOW,\n")
    assert isinstance(record, tp.WireError)
    assert (record.what, record.kind) == ("unknown type", "DIVE_NOW")
    wire = Wire(())
    wire.mission()
    wire.tell(Heard(1, 0, tp.NotKnown(record.kind)))
    assert wire.said[-1].Note == "ICAROUS does not know the command DIVE_NOW"
