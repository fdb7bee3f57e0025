"""After a handback ICAROUS takes over because of the same intruder only if its way is not permitted any more."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from flight_tools import flown, of_type
from hypothesis import given
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.core.permit.encounter import (
    Encounter,
    encounter_looked,
    encounter_resumed,
    encounter_watched,
)
from cratous.services.campaign.generators import mission_of
from cratous.services.icarous import permits
from cratous.services.icarous.foresight import predicted, scene_of
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Sensed, Wish
from cratous.services.icarous.state import Config, Met, State
from cratous.services.icarous.traffic_monitor import Threat
from cratous.services.loading import load
from cratous.spec.mission import Daa, Position, Velocity, Zone, ZoneKind

CONFIG = Config(1, Daa(VOLUME, buffer=1.25), PROJECTION, 500)
WAY = tuple(Position(1000.0 * k, 0.0, 300.0) for k in range(-1, 6))
BEYOND = Intruder(9, Position(3000.0, 900.0, 300.0), Velocity(0.0, 10.0, 0.0))
"""It flies east, away from the way north."""
TAKEN = Encounter(1, 0, 0, True, False, 0)


def sensed(other: Intruder, now_ms: int) -> Sensed:
    north = NORTH._replace(position=Position(22.0 * now_ms / 1000, 0.0, 300.0))
    return Sensed(now_ms, north, ABILITY, (other,), Gate(0, 0, False))


def handed_back(other: Intruder = BEYOND, in_turn: tuple[int, ...] = ()) -> State:
    state = State(told=Told(waypoints=WAY, next_index=2), met=(Met(9, TAKEN),))
    return permits.resumed(CONFIG, state, sensed(other, 0), frozenset(in_turn))


def looked(state: State, other: Intruder, now_ms: int) -> Met:
    seen = sensed(other, now_ms)
    ahead = predicted(CONFIG, state, seen, scene_of(CONFIG, state, seen))
    (met,) = permits.looked(CONFIG, state, seen, ahead).met
    return met


def test_the_way_is_permitted_to_its_end() -> None:
    (met,) = handed_back().met
    assert met.encounter == Encounter(1, 0, 0, False, True, 227272)  # 5000 m at 22 m/s
    assert (met.predicted, met.made_ms, met.why) == (BEYOND, 0, "")


@pytest.mark.parametrize(
    ("other", "in_turn"),
    [
        (BEYOND, (9,)),
        (BEYOND._replace(position=Position(3000.0, 0.0, 300.0), velocity=Velocity(0, 0, 0)), ()),
        (BEYOND._replace(id=8), ()),  # the one that was avoided is not seen
    ],
)
def test_what_is_not_permitted_at_the_handback_is_a_surprise(
    other: Intruder, in_turn: tuple[int, ...]
) -> None:
    (met,) = handed_back(other, in_turn).met
    assert met.encounter == Encounter(1, 1, 0, False, False, 0)
    assert met.why == permits.NOT_FREE


def later(off_m: float, velocity: Velocity) -> Intruder:
    return Intruder(9, Position(3000.0 + off_m, 910.0, 300.0), velocity)


@pytest.mark.parametrize(
    ("other", "permitted", "why", "predicted_anew"),
    [
        (later(0.0, Velocity(0, 10, 0)), True, "", False),
        (later(18.7, Velocity(0, 10, 0)), True, "", False),
        (later(18.8, Velocity(0, 10, 0)), True, "", True),
        (later(18.8, Velocity(0, -6.7, 0)), False, permits.OFF_LINE, True),
        (later(0.0, Velocity(-44.2, -20.2, 0)), False, permits.UNFORESEEN, False),
    ],
)
def test_a_line_that_is_left_is_looked_at_anew(
    other: Intruder, permitted: bool, why: str, predicted_anew: bool
) -> None:
    """It is left where the intruder is farther off it than half of what the buffer leaves, 18.75 m."""
    met = looked(handed_back(), other, 1000)
    assert (met.encounter.permitted, met.why) == (permitted, why)
    assert (met.predicted == other) is predicted_anew
    assert met.encounter.surprises == (0 if permitted else 1)


def test_the_hold_at_the_end_of_the_way_is_looked_at() -> None:
    """One hovers beside the end: the way is clear of it, no circle that ends it is, and a zone bars the way straight on."""
    hovers = Intruder(9, Position(5000.0, 195.0, 300.0), Velocity(0.0, 0.0, 0.0))
    sides = ((5120.0, -500.0), (5210.0, -500.0), (5210.0, 500.0), (5120.0, 500.0))
    behind = Zone(1, ZoneKind.KEEP_OUT, sides, 0.0, 1000.0)
    state = handed_back(hovers)
    state = replace(state, told=replace(state.told, zones=(behind,)))
    assert looked(state, hovers, 1000).encounter.permitted
    state = replace(state, told=replace(state.told, next_index=6))
    met = looked(state, hovers, 200_000)  # 27 s before the end
    assert (met.encounter.permitted, met.why) == (False, permits.UNFORESEEN)


@pytest.mark.parametrize(("east_m", "permitted"), [(0.0, True), (400.0, False)])
def test_another_way_that_is_told_is_looked_at_anew(east_m: float, permitted: bool) -> None:
    """It leads past where the other hovers, or through it."""
    hovers = Intruder(9, Position(3500.0, 400.0, 300.0), Velocity(0.0, 0.0, 0.0))
    state = handed_back(hovers)
    other = (*WAY[:4], *(place._replace(east_m=east_m) for place in WAY[4:]), WAY[-1])
    met = looked(replace(state, told=replace(state.told, waypoints=other)), hovers, 1000)
    assert (met.encounter.permitted, met.way) == (permitted, other)
    assert met.why == ("" if permitted else permits.OTHER_WAY)


def test_a_permit_ends_with_the_way() -> None:
    gone = BEYOND._replace(position=Position(3000.0, 900.0 + 2272.72, 300.0))
    met = looked(handed_back(), gone, 227_272)
    assert (met.encounter.permitted, met.encounter.ended, met.why) == (False, 1, permits.ENDED)


def test_who_is_permitted_is_not_acted_on_and_others_are() -> None:
    found = tuple(Threat(number, 20.0, 0, number != 7) for number in (7, 8, 9))
    state = handed_back()
    assert [threat.intruder_id for threat in permits.acting(state, found)] == [8]
    (met,) = handed_back(in_turn=(9,)).met
    again = replace(state, met=(met,))
    assert [threat.intruder_id for threat in permits.acting(again, found)] == [8, 9]
    taken = permits.taken_over(permits.taken_over(again, 8), 9)
    assert [(one.intruder_id, one.encounter.takeovers) for one in taken.met] == [(8, 1), (9, 2)]
    assert permits.told_why(again, 9) == f"; again, since {permits.NOT_FREE}"
    assert permits.told_why(again, 8) == ""


@pytest.mark.parametrize("permitted", [True, False])
def test_the_buffer_alone_takes_no_permitted_way_again(permitted: bool) -> None:
    """Before a corner the vehicle heads for one that hovers 430 m behind it: inside of the buffered thresholds of
    time, outside of the mission's own."""
    hovers = Intruder(9, Position(1430.0, 0.0, 300.0), Velocity(0.0, 0.0, 0.0))
    way = (*WAY[:3], Position(1000.0, -8000.0, 300.0))
    told = Told(waypoints=way, next_index=2)
    state = State(told=told, threats=(Threat(9, 30.0, 0, True),))
    if permitted:
        state = permits.resumed(
            CONFIG, replace(state, met=(Met(9, TAKEN),)), sensed(hovers, 0), frozenset()
        )
    state, said = Instance(CONFIG).handle(state, sensed(hovers, 20_000))
    assert [threat.intruder_id for threat in state.threats] == [9]
    assert [wish.intruder_id for wish in said if isinstance(wish, Wish)] == [9] * (not permitted)


STEPS = st.lists(
    st.tuples(st.sampled_from(["look", "watch", "resume"]), st.booleans(), st.integers(0, 20)),
    max_size=40,
)


@given(STEPS)
def test_takeovers_are_counted_by_what_did_not_last(steps: list[tuple[str, bool, int]]) -> None:
    """Of any sequence of steps, counted by hand."""
    one, taken, over = permits.NONE, 0, 0
    for now, (step, says, number) in enumerate(steps, 1):
        had = one.permitted or one.avoiding
        if step == "look":
            one = encounter_looked(one, says, now)
        elif step == "watch":
            watched = encounter_watched(one, says)
            one, taken = watched.encounter, taken + watched.acts
        else:
            one = encounter_resumed(one, says, now + number)
        over += step != "watch" and had and not (one.permitted or one.avoiding)
        assert one.takeovers == taken
        assert one.surprises + one.ended == over
        assert taken <= 1 + over


def test_vehicles_that_avoid_each_other_do_so_once(tmp_path: Path) -> None:
    """Four that meet turn as they avoid each other, and know each other's ways: each of the three that give way does so once."""
    data, _ = mission_of({"kind": "aimed", "intruders": 3, "cooperative": True}, "all", 9)
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(data))
    result, log = flown(load(file))
    assert result.outcome == "complete"
    pairs = list[tuple[int, int]]()
    for taken in of_type(log, "AuthorityChange"):
        if taken.Owner.name == "ICAROUS":
            assert "again" not in taken.Reason
            pairs.append((taken.VehicleID, taken.IntruderID))
    assert sorted(vehicle for vehicle, _ in pairs) == [2, 3, 4]
