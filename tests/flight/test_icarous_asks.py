"""An instance whose own way back is not free asks UxAS for one; what it is told is a proposal, and no more."""

from __future__ import annotations

from typing import NamedTuple

import pytest
from icarous_tools import ABILITY, PROJECTION, VOLUME, head_on

from cratous.bridge import text_protocol as tp
from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.rejoining import Router
from cratous.services.icarous.instance import UXAS_WAY, Instance
from cratous.services.icarous.messages import Foresees, FromInstance, Line, Sensed, Up, Wish
from cratous.services.icarous.return_to_path import PERSIST_MS
from cratous.services.icarous.route_requests import (
    ANSWER_MS,
    MOST_POINTS,
    NO_WAY,
    NOT_ASKED,
    OVERDUE,
    PAUSE_MS,
)
from cratous.services.icarous.state import Config, State
from cratous.spec.mission import Daa, Position, Zone, ZoneKind
from cratous.spec.mission.plan import Pose

BEAT_MS = 500
BLOCK = ((700.0, -500.0), (700.0, 500.0), (1100.0, 500.0), (1100.0, -500.0))
HERE, GOAL = Position(0.0, 0.0, 300.0), Position(2500.0, 0.0, 300.0)
MOTION = Motion(HERE, 0.0, 22.0, 0.0)
OWNED = Gate(ICAROUS, 1, False)
ZONE = Zone(1, ZoneKind.KEEP_OUT, BLOCK, 0.0, 500.0)


def told() -> list[tp.Message]:
    """A way straight through a zone, on which the vehicle is."""
    lines: list[tp.Message] = [tp.UxasPlans()]
    for k, (north, east) in enumerate(BLOCK):
        place = PROJECTION.to_geodetic(north, east)
        lines.append(tp.FenceVertex("KEEPOUT", 4, k + 1, *place, 0.0, 500.0, 1))
    lines.append(tp.FenceDone(1))
    for k, north in enumerate((-1000.0, GOAL.north_m)):
        lines.append(tp.Waypoint(2, 22.0, *PROJECTION.to_geodetic(north, 0.0), 300.0, k))
    return [*lines, tp.StartMission(), tp.WaypointReached(0)]


class Flight:
    """One instance that has its vehicle, which is where it was."""

    def __init__(self) -> None:
        self.end = Instance(Config(2, Daa(VOLUME), PROJECTION, BEAT_MS))
        self.state, self.now_ms = State(), 0
        self.hear(*told())

    def hear(self, *lines: tp.Message) -> None:
        for line in lines:
            self.state, _ = self.end.handle(self.state, Line(self.now_ms, line))

    def beat(self, *others: Intruder) -> Said:
        """A heartbeat: UxAS is heard, the vehicle senses."""
        self.now_ms += BEAT_MS
        self.hear(tp.WaypointReached(0))
        sensed = Sensed(self.now_ms, MOTION, ABILITY, others, OWNED)
        self.state, out = self.end.handle(self.state, sensed)
        return Said.of(out)

    def asked(self) -> tp.RouteRequest:
        (line,) = self.beat().asked
        return line


class Said(NamedTuple):
    asked: list[tp.RouteRequest]
    texts: list[str]
    wishes: list[Wish]
    modes: list[tp.SetMode]

    @classmethod
    def of(cls, out: tuple[FromInstance, ...]) -> Said:
        lines = [one.line for one in out if isinstance(one, Up)]
        return cls(
            [line for line in lines if isinstance(line, tp.RouteRequest)],
            [one.resolution for one in out if isinstance(one, Foresees)],
            [one for one in out if isinstance(one, Wish)],
            [line for line in lines if isinstance(line, tp.SetMode)],
        )


def answer(number: int | None, way: tuple[Position, ...]) -> list[tp.Message]:
    points = (
        tp.RoutePoint(*PROJECTION.to_geodetic(p.north_m, p.east_m), p.alt_m, 22.0, number)
        for p in way
    )
    return [tp.RouteStart(number), *points, tp.RouteEnd(number)]


def around() -> tuple[Position, ...]:
    """What UxAS's planner answers."""
    way = Router((ZONE,)).way_to(AirState(HERE, 0.0, 22.0, 0.0), 100.0, Pose(*GOAL, 0.0))
    assert len(way) > 3
    return way


def test_the_answer_is_handed_back_onto_by_its_number_once_it_has_been_free_for_long_enough() -> (
    None
):
    flight = Flight()
    asked = flight.asked()
    assert PROJECTION.to_local(asked.end_lat_deg, asked.end_long_deg)[0] == pytest.approx(2500)
    assert (asked.request, asked.track_deg, asked.horizontal_mps) == (1, 0.0, 22.0)
    assert not flight.beat().asked, "one at a time"
    flight.hear(*answer(asked.request, around()))
    said = flight.beat()
    assert not said.wishes, "it has not been free for long enough"
    for _ in range(PERSIST_MS // BEAT_MS):
        assert not said.wishes
        said = flight.beat()
    (wish,) = said.wishes
    assert wish.reason == f"{UXAS_WAY} (request 1)"
    assert said.modes == [tp.SetMode("PASSIVE", 2, 1)]


def test_one_that_kernels_do_not_permit_is_not_flown() -> None:
    """Through the zone, and into an aircraft that comes along it."""
    for way, others in (
        ((HERE, GOAL), ()),
        ((HERE, Position(900.0, 550.0, 300.0), Position(1300.0, 0.0, 300.0), GOAL), ()),
        (around(), (head_on(900.0),)),
    ):
        flight = Flight()
        flight.hear(*answer(flight.asked().request, way))
        for _ in range(10):
            said = flight.beat(*others)
            assert not said.wishes
            assert all(mode.mode == "ACTIVE" for mode in said.modes)
            flight.hear(*answer(said.asked[0].request, way) if said.asked else ())


def test_no_answer_in_time_is_said_and_nothing_is_asked_for_a_while() -> None:
    flight = Flight()
    assert flight.asked().request == 1
    quiet = [flight.beat() for _ in range(ANSWER_MS // BEAT_MS)]
    assert [text for said in quiet for text in said.texts if text == OVERDUE] == [OVERDUE]
    flight.hear(*answer(1, around()))
    said = flight.beat()
    assert NOT_ASKED in said.texts, "it is too late"
    asked = [flight.beat().asked for _ in range(PAUSE_MS // BEAT_MS)]
    assert [line.request for lines in asked for line in lines] == [2]
    assert not any(asked[:15])


def test_what_is_no_answer(  # each ends in no handback
) -> None:
    flight = Flight()
    number = flight.asked().request
    wrong = answer(99, around())
    flight.hear(*wrong, tp.RoutePoint(37.0, -76.0, 300.0, 22.0, number), *answer(number, ()))
    texts = flight.beat().texts
    assert {NOT_ASKED, NO_WAY} <= set(texts)
    assert texts.count(NOT_ASKED) == 1
    (again,) = flight.beat().asked or flight.beat().asked
    flight.hear(*answer(again.request, (HERE,) * (MOST_POINTS + 1)))
    assert any("more than 256 places" in text for text in flight.beat().texts)
    assert not flight.state.asking.proposal


def test_nothing_is_asked_unless_uxas_plans_live_or_where_the_own_way_is_free() -> None:
    flight = Flight()
    flight.hear(tp.IcarousPlans())
    assert not any(flight.beat().asked for _ in range(6))
    flight.hear(tp.UxasPlans())
    assert flight.beat().asked
    free = Flight()
    free.state = State()
    free.hear(*(line for line in told() if not isinstance(line, tp.FenceVertex | tp.FenceDone)))
    assert not any(free.beat().asked for _ in range(6))
