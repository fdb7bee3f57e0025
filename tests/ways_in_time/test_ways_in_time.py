"""Ways past zones and moving traffic: three answers, and what each of them stands for."""

from __future__ import annotations

import itertools
import math

import pytest

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder, Piece, Spread, after, later, straight
from cratous.core.ways_in_time.scene import Scene
from cratous.services.ways_in_time.asking import CHECKS_PER_S, STATES, Asked, Outcome, way_in_time
from cratous.spec.mission import Position, Velocity, WellClear, Zone, ZoneKind

ABILITY = Ability(0.16, 15.0, 35.0, 5.0, 2.0, 50.0)
NOW = Motion(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
GOAL = Position(3000.0, 0.0, 300.0)
VOLUME = WellClear(150.0, 50.0, 0.0, 0.0)


def box(number, south, west, north, east, kind=ZoneKind.KEEP_OUT):
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(number, kind, corners, 0.0, 5000.0)


def corridor(half_m, opens=0.0, closes=0.0):
    """Two walls along the way, with a gap from one northing to another in both."""
    if opens == closes:
        return box(1, -500, -1000, 3500, -half_m), box(2, -500, half_m, 3500, 1000)
    return (
        box(1, -500, -1000, opens, -half_m), box(2, -500, half_m, opens, 1000),
        box(3, closes, -1000, 3500, -half_m), box(4, closes, half_m, 3500, 1000),
    )  # fmt: skip


def nearest_m(pieces, other, step_s=0.1):
    """Least horizontal distance from an intruder while it is within the height of the volume, by sampling."""
    least = math.inf
    for piece in pieces:
        count = math.ceil(piece.duration_s / step_s)
        for k in range(count + 1):
            t = k * piece.duration_s / count
            p, q = after(piece, t), later(other, piece.start_s + t).position
            if abs(p.alt_m - q.alt_m) <= VOLUME.zthr_m:
                least = min(least, math.dist(p[:2], q[:2]))
    return least


def test_without_anything_in_the_way_it_is_the_straight_line_at_the_present_speed():
    found = way_in_time(Asked(NOW, GOAL, ABILITY), Scene())
    assert found.outcome is Outcome.PATH
    length = sum(p.duration_s * math.hypot(*p.velocity[:2]) for p in found.pieces)
    assert length == pytest.approx(3000.0, rel=1e-6)
    assert {round(math.hypot(*p.velocity[:2]), 6) for p in found.pieces} == {22.0}


@pytest.mark.parametrize("speeds", [(22.0,), (22.0, 15.0, 35.0)])
def test_it_waits_or_passes_where_one_crosses_a_corridor_through_a_gap(speeds):
    """At the gap as the vehicle comes by: it is there earlier or later, by speed or by a lap."""
    crosses = Intruder(9, Position(1500.0, 1500.0, 300.0), Velocity(0.0, -22.0, 0.0))
    scene = Scene(corridor(120.0, 1200.0, 1800.0), 20.0, (crosses,), VOLUME)
    straight_on = (straight(NOW.position, Velocity(22.0, 0.0, 0.0), 0.0, 3000 / 22),)
    assert nearest_m(straight_on, crosses) < VOLUME.dthr_m
    found = way_in_time(Asked(NOW, GOAL, ABILITY, speeds_m_s=speeds), scene)
    assert found.outcome is Outcome.PATH
    assert nearest_m(found.pieces, crosses) > VOLUME.dthr_m


def test_head_on_in_a_corridor_there_is_none_and_it_says_of_what():
    meets = Intruder(9, Position(3500.0, 0.0, 300.0), Velocity(-22.0, 0.0, 0.0))
    scene = Scene(corridor(120.0), 20.0, (meets,), VOLUME)
    asked = Asked(NOW, GOAL, ABILITY)
    whole = way_in_time(asked, scene, 20.0)
    assert (whole.outcome, whole.pieces) == (Outcome.NO_PATH, ())
    assert whole.reason.startswith("no path on this grid of legs (")
    assert whole.reason.endswith("elsewhere was not searched")
    short = way_in_time(asked, scene, whole.checks / CHECKS_PER_S / 2)
    assert short.outcome is Outcome.NONE_IN_TIME
    assert "the budget is" in short.reason
    # above or below it there is one
    over = way_in_time(asked._replace(layers_m=(420.0,)), scene)
    assert over.outcome is Outcome.PATH
    assert max(p.position.alt_m for p in over.pieces) > 350
    assert all(abs(p.velocity.down_m_s) <= ABILITY.max_climb_m_s + 1e-9 for p in over.pieces)


@pytest.mark.parametrize("turned", [False, True])
def test_what_excludes_every_path_is_told_as_that(turned):
    goal_in = box(1, 2900, -100, 3100, 100)
    walls = (
        box(1, 800, -1500, 900, 1500), box(2, 3200, -1500, 3300, 1500),
        box(3, 800, -1500, 3300, -1400), box(4, 800, 1400, 3300, 1500),
    )  # fmt: skip
    if turned:  # clockwise or not
        goal_in, *walls = (
            Zone(z.id, z.kind, z.vertices[::-1], z.floor_m, z.ceiling_m) for z in (goal_in, *walls)
        )
    inside = way_in_time(Asked(NOW, GOAL, ABILITY), Scene((goal_in,)))
    assert inside[:2] == (
        Outcome.NO_PATH, "its end breaks keep-out zone 1"
    )  # fmt: skip
    apart = way_in_time(Asked(NOW, GOAL, ABILITY), Scene(tuple(walls)))
    assert apart.outcome is Outcome.NO_PATH
    assert "zones 1, 2, 3, 4 together separate start and end" in apart.reason
    close = Intruder(7, Position(100.0, 0.0, 310.0), Velocity(0.0, 0.0, 0.0))
    met = way_in_time(Asked(NOW, GOAL, ABILITY), Scene((), 0.0, (close,), VOLUME))
    assert met[:2] == (
        Outcome.NO_PATH, "its start is within the volume of intruder 7"
    )  # fmt: skip


def test_a_way_can_be_flown():
    """No gap in place or time, headings change by arcs, speeds by the acceleration."""
    crosses = Intruder(9, Position(1500.0, 1500.0, 300.0), Velocity(0.0, -22.0, 0.0))
    zones = (box(1, 900, -400, 1300, 300), box(2, 1900, -200, 2300, 500))
    found = way_in_time(Asked(NOW, GOAL, ABILITY), Scene(zones, 20.0, (crosses,), VOLUME))
    assert found.outcome is Outcome.PATH
    first, last = found.pieces[0], found.pieces[-1]
    assert first.position == NOW.position
    assert math.dist(after(last, last.duration_s), GOAL) < 1e-6
    for p, q in itertools.pairwise(found.pieces):
        assert math.dist(after(p, p.duration_s), q.position) < 1.0
        assert q.start_s == pytest.approx(p.start_s + p.duration_s, abs=1e-6)
        turn = math.atan2(*reversed(q.velocity[:2])) - math.atan2(*reversed(p.velocity[:2]))
        assert abs(math.remainder(turn, 2 * math.pi)) < math.radians(15.1)


def test_uncertain_and_told_ways_of_others_are_kept_clear_of():
    """An intruder that turns as it has told, and one of which the place is known within a growing spread."""
    turns = (
        Piece(0.0, 40.0, Position(1400.0, 900.0, 300.0), Velocity(0.0, -22.0, 0.0)),
        Piece(40.0, 20.0, Position(1400.0, 20.0, 300.0), Velocity(22.0, 0.0, 0.0)),
    )
    told = Intruder(5, turns[0].position, turns[0].velocity, True, turns, 200.0)
    vague = Intruder(
        6, Position(2500.0, -1500.0, 300.0), Velocity(0.0, 12.0, 0.0), spread=Spread(20.0, 0.5)
    )
    found = way_in_time(Asked(NOW, GOAL, ABILITY), Scene((), 0.0, (told, vague), VOLUME))
    assert found.outcome is Outcome.PATH
    assert nearest_m(found.pieces, told) > VOLUME.dthr_m
    for piece in found.pieces:
        wide_m = vague.spread.after(piece.start_s).wide_m
        assert nearest_m((piece,), vague) > VOLUME.dthr_m + wide_m


def test_the_answer_depends_on_no_clock_and_is_bounded():
    """The same twice; ended by a clock it says so; states and checks stay within the budget."""
    meets = Intruder(9, Position(3500.0, 0.0, 300.0), Velocity(-22.0, 0.0, 0.0))
    scene = Scene(corridor(300.0), 20.0, (meets,), VOLUME)
    asked = Asked(NOW, GOAL, ABILITY)
    assert way_in_time(asked, scene) == way_in_time(asked, scene)
    ended = way_in_time(asked, scene, overdue=lambda: True)
    assert ended.outcome is Outcome.NONE_IN_TIME
    assert ended.reason.startswith("ended by the clock")
    assert ended.states <= STATES
    none = way_in_time(asked, scene, 0.0)
    assert (none.outcome, none.pieces) == (Outcome.NONE_IN_TIME, ())
    with pytest.raises(ValueError, match="speed that is not positive"):
        way_in_time(Asked(NOW._replace(speed_m_s=0.0), GOAL, ABILITY), scene)
