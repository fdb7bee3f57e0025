"""G5 of a flight that ended in the declared safe state: did each vehicle in it circle for as long as that takes?

It is every vehicle that ICAROUS has at the end (where the mission sets what is flown without the link, also one that is
said to circle), on no ground and after no declared failure; if there is none, the end is not what it is said to be, for
any vehicle. Positions are held against the least circle that could contain them: two that are farther apart than its
diameter violate it, all within its radius of the middle of their extents hold.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from cratous.judge.ground import down, stands_at_start
from cratous.judge.log import Log, State
from cratous.judge.mission import Mission
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds
from cratous.judge.zones import Fence

SAFE_STATE, ICAROUS, CIRCLES = "safe state", "ICAROUS", ("Loiter", "Over")
WIDER, MARGIN_M, GRAVITY_M_S2 = 1.1, 20.0, 9.80665
"""A circle is that much wider than the tightest turn at the speed flown; a vehicle may be that far outside [m]."""
AXES = 8
"""Number of directions in which the extent of the path is measured."""


def rows(mission: Mission, log: Log, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each vehicle that is said to be in the safe state."""
    if not log.ends or log.ends[-1][1] != SAFE_STATE:
        return
    end_ms, there = log.ends[-1][0], sorted(mission.instances)
    away = [v for v in there if _away(mission, log, v, flown[v])]
    for vehicle in away or there:
        subject, item = ("circle", str(vehicle)), f"circle of vehicle {vehicle} at the end"
        track = flown[vehicle]
        since = _since_ms(log, vehicle)
        states = track.states[track.from_index(end_ms - mission.safe_state_after_ms) :]
        reach_m = _reach_m(mission, vehicle, states)
        fault = ""
        if not away:
            fault = "the flight ended in the safe state, and ICAROUS had no vehicle"
        elif since is None or end_ms - since < mission.safe_state_after_ms:
            fault = f"it was not said to circle for {mission.safe_state_after_ms / 1000:g} s when the flight ended"
        fault = fault or _apart(states, reach_m)
        fault = fault or _broken(mission, track, end_ms)
        if fault:
            yield Row("G5", subject, item, VIOLATED, fault, end_ms, len(states))
            continue
        far_m = _radius_m(states)
        note = f"within {far_m:.1f} m of one place; a circle of {reach_m:.1f} m is allowed"
        doubt = _doubt(track, end_ms - mission.safe_state_after_ms)
        verdict = UNKNOWN if doubt or far_m > reach_m else HOLDS
        yield Row("G5", subject, item, verdict, doubt or note, None, len(states))


def _away(mission: Mission, log: Log, vehicle: int, track: Track) -> bool:
    """Whether ICAROUS had a vehicle at the end, or it circled, in the air and without a declared failure."""
    owners = [one.side for one in log.gates if (one.vehicle, one.kind) == (vehicle, "state")]
    failed = mission.after_failure is not None and vehicle in log.declared
    place = down(mission, vehicle, track)
    rests = stands_at_start(mission, vehicle, track) or (place is not None and place.good)
    asked = mission.without_link is not None and _since_ms(log, vehicle) is not None
    alone = owners[-1:] == [ICAROUS] or asked
    return alone and not failed and not rests


def _since_ms(log: Log, vehicle: int) -> int | None:
    """Since when a vehicle is said to circle; None if it is not."""
    since = None
    for one in log.alone.get(vehicle, []):
        if one.mode not in CIRCLES:
            since = None
        elif since is None:
            since = one.time_ms
    return since


def _doubt(track: Track, from_ms: int) -> str:
    """Why the path from a time on is not known; empty if it is."""
    return next((flaw.why for flaw in track.flaws if flaw.last_ms > from_ms), "")


def _reach_m(mission: Mission, vehicle: int, states: list[State]) -> float:
    one = mission.vehicles[vehicle]
    flown = max((math.hypot(s.north_m_s, s.east_m_s) for s in states), default=0.0)
    speed, steep = min(flown, one.fastest_m_s), math.tan(one.bank_rad)
    # what cannot bank flies no circle
    return MARGIN_M + (WIDER * speed * speed / (GRAVITY_M_S2 * steep) if steep > 0 else 0.0)


def _apart(states: list[State], reach_m: float) -> str:
    """Two positions that are in no circle of this radius, in words; empty if none were found."""
    for k in range(AXES if states else 0):
        north, east = math.cos(k * math.pi / AXES), math.sin(k * math.pi / AXES)
        along = [(s.north_m * north + s.east_m * east, s.time_ms, s) for s in states]
        (_, first, a), (_, second, b) = min(along), max(along)
        apart_m = math.dist(a[1:3], b[1:3])
        if apart_m > 2 * reach_m:
            where = f"at {seconds(first)} and {seconds(second)}"
            return f"{where} it was {apart_m:.1f} m apart: in no circle of {reach_m:.1f} m"
    return ""


def _radius_m(states: list[State]) -> float:
    """The greatest distance from the middle of the extents [m]."""
    if not states:
        return 0.0
    north, east = ([s[k] for s in states] for k in (1, 2))
    middle = (min(north) + max(north)) / 2, (min(east) + max(east)) / 2
    return max(math.dist(s[1:3], middle) for s in states)


def _broken(mission: Mission, track: Track, end_ms: int) -> str:
    """The zone that the path breaks in that time, in words; empty if it keeps all."""
    for zone in mission.zones:
        fence, first = Fence(zone), max(zone.from_ms, end_ms - mission.safe_state_after_ms)
        if track.from_index(first) >= len(track.states) - (zone.from_ms > 0):
            continue
        for before, after in track.legs(track.from_index(first)):
            if not zone.over(before.time_ms) and fence.breaks(before, after):
                return f"it broke zone {zone.id} at {seconds(before.time_ms)}"
    return ""
