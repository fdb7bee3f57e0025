"""The assumption that a vehicle under UxAS stays closer to its commanded legs than these are to a
zone.

Flight between two samples is straight. It is compared with one leg: the lateral and vertical
distance of both ends from it gives the margin with which the leg has to keep every active zone.
Decided by the kernels `edge_against` and those of `leg_keeps`.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import Any, NamedTuple

from cratous.core.authority.gate import UXAS, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.geofence.distance import FARTHER, comes_within, edge_against
from cratous.core.geofence.planar import keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.routing.polylines import Track
from cratous.services.assumptions.authority import UNTOUCHED, has_it, reported, sender_of
from cratous.services.assumptions.observations import ANY_LATER, Message, Record, gone_ms
from cratous.services.mission.frames import Projection
from cratous.services.mission.moving_zones import Now
from cratous.services.mission.zone_times import judged_zones
from cratous.services.mission.zones import exact_leg_keeps
from cratous.spec.mission import Mission, MovingZone, Position, Zone

MARGINS_M = (1.0, 2.0, 5.0, 10.0, 20.0)
"""Candidate margins: the smallest sufficient one is used; the last is the routes' clearance from
zones where there is room [m].
"""
KERNELS = (
    comes_within, edge_against, gate_accepts, in_time, keep_in_leg_ok, keep_out_leg_ok, locate,
)  # fmt: skip
Leg = tuple[Position, Position]
Asked = dict[tuple[Position, Leg, float], bool]
"""Cached results: whether a position is within a margin of a leg."""
Levels = dict[tuple[float, float, float, float], bool]
"""Cached results: whether an altitude is within a margin of those of a leg's ends."""
LEVELS_MOST = 1000
"""Maximum number of cached altitudes: level flight repeats the same question."""
ROUNDING_M = 1e-3
"""Maximum rounding error of an approximate distance [m]."""


class Path(NamedTuple):
    """The last command of UxAS and its time; s_m: distance flown along it [m]."""

    since_ms: int
    track: Track
    s_m: float = 0.0

    def legs(self, first_m: float, last_m: float) -> list[Leg]:
        """The legs between two distances along the path [m], and one more at either end."""
        points = self.track.points
        if len(points) == 1:
            return [(points[0], points[0])]
        first, last = (bisect_right(self.track.s_m, s_m) - 1 for s_m in (first_m, last_m))
        low, high = min(max(0, first - 1), len(points) - 2), min(len(points) - 2, last + 1)
        return [(points[k], points[k + 1]) for k in range(low, high + 1)]


class NearLegsWatch:
    """Watches each mission vehicle from every UxAS command on, while UxAS is in command."""

    kinds = ("GateState", "GatedCommand", "TruthState")

    def __init__(self, mission: Mission) -> None:
        self._mission, self._projection = mission, Projection(mission.frame)
        self._gates = {v.id: UNTOUCHED for v in mission.vehicles if v.protected}
        self._paths: dict[int, Path] = {}
        self._ended: dict[int, tuple[int, Path]] = {}
        self._free_ms = dict.fromkeys(self._gates, 0)
        self._before: dict[int, tuple[int, Position]] = {}
        self._kept: dict[tuple[Leg, Zone, float], bool] = {}
        self._near: dict[int, Asked] = {}
        self._level: Levels = {}
        zones = mission.zones or any(change.zone for change in mission.changes)
        none = "" if zones and self._gates else "no zone for a vehicle that is protected"
        waits = "no flight on a path that UxAS commanded was seen"
        self._record = Record("m", MARGINS_M[-1], KERNELS, none, waits=waits)

    def message(self, message: Message) -> None:
        """Process a gate state, a command, or the true state of an aircraft."""
        kind, now_ms, _, body = message
        if self._record.unseen or kind not in self.kinds:
            return
        number = body.VehicleID
        if number not in self._gates:
            return
        if kind == "GateState":
            had, self._gates[number] = has_it(self._gates[number]), reported(body)
            if has_it(self._gates[number]):
                self._end_path(number, now_ms)
            elif had:
                self._free_ms[number] = now_ms
        elif kind == "GatedCommand":
            self._command(number, now_ms, body)
        else:
            self._sample(number, now_ms, Position(body.North, body.East, body.Altitude))

    def _command(self, number: int, now_ms: int, body: Any) -> None:
        """Start a commanded path; the last command that the gate accepts at an instant is flown."""
        sender = sender_of(body)
        if not gate_accepts(self._gates[number], sender, body.Epoch):
            return
        self._end_path(number, now_ms)
        if sender != UXAS:
            return
        points = getattr(body.Command, "WaypointList", None)
        if not points:
            self._gap(f"vehicle {number} was commanded something else than a path by UxAS")
            return
        norths, easts = self._projection.to_local_many(
            [p.Latitude for p in points], [p.Longitude for p in points]
        )
        places = zip(norths, easts, (p.Altitude for p in points), strict=True)
        track = Track(tuple(Position(float(n), float(e), float(alt)) for n, e, alt in places))
        self._paths[number] = Path(now_ms, track)

    def _end_path(self, number: int, now_ms: int) -> None:
        """End the path: flight up to now was on it; of paths ending at this instant the first counts."""
        path, ended = self._paths.pop(number, None), self._ended.get(number)
        if path is not None and (ended is None or not in_time(ended[0], now_ms, 0)):
            self._ended[number] = now_ms, path

    def _flown(self, number: int, since_ms: int, now_ms: int) -> Path | None:
        """The path on which the vehicle flew throughout, from since_ms to now_ms; None if there is
        no single one.
        """
        ended = self._ended.get(number)
        just = ended[1] if ended is not None and in_time(ended[0], now_ms, 0) else None
        for path in (self._paths.get(number), just):
            if path is not None and in_time(path.since_ms, since_ms, ANY_LATER):
                return path
        return None

    def _gap(self, text: str) -> None:
        if not self._record.gaps:
            self._record.gaps.append(text)

    def _seen_between(self, number: int, last_ms: int, now_ms: int) -> None:
        if not self._record.unseen:
            step_ms = self._mission.simulation.step_ms
            self._record.unseen_between(f"vehicle {number}", last_ms, now_ms, step_ms)

    def _sample(self, number: int, now_ms: int, here: Position) -> None:
        before, self._before[number] = self._before.get(number), (now_ms, here)
        if before is None:
            return
        path = self._flown(number, before[0], now_ms)
        if path is None:
            self._without_path(number, before, here)
            return
        self._seen_between(number, before[0], now_ms)
        self._hold(number, path, before, here)

    def _without_path(self, number: int, before: tuple[int, Position], here: Position) -> None:
        """Note flight under UxAS without one path commanded throughout: closeness to a leg is not observed."""
        since_ms = before[0]
        if has_it(self._gates[number]) or not in_time(self._free_ms[number], since_ms, ANY_LATER):
            return
        if here != before[1]:
            self._gap(f"vehicle {number} flew on no one path of UxAS from {since_ms / 1000:.2f} s")

    def _hold(self, number: int, path: Path, before: tuple[int, Position], here: Position) -> None:
        """Compare the flight since the last sample with the nearest leg that keeps the zones."""
        track, window = path.track, 2 * math.dist(before[1], here) + MARGINS_M[-1]
        first, last = (track.nearest(p, path.s_m, window).s_m for p in (before[1], here))
        if not all(map(math.isfinite, (first, last))):
            first = last = path.s_m
        if self._paths.get(number) is path:
            self._paths[number] = path._replace(s_m=max(path.s_m, min(last, track.length_m)))
        ends = (before[1], here)
        times_ms, step_ms = before[0], self._mission.simulation.step_ms
        zones = [
            Now(b.zone, times_ms, step_ms) if isinstance(b.zone, MovingZone) else b.zone
            for b in judged_zones(self._mission, before[0] + 1)
            if b.binds(before[0])
        ]
        asked = self._near.get(number, {})
        near, why = self._beside(ends, path.legs(min(first, last), max(first, last)), zones, asked)
        if why and self._record.broken is None:
            # a lap commanded anew begins ahead: the vehicle is on its last legs
            near, why = self._beside(ends, path.legs(0.0, track.length_m), zones, asked)
        # the current position is the previous one at the next sample
        self._near[number] = {key: is_near for key, is_near in asked.items() if key[0] == here}
        if why:
            text = f"vehicle {number} is {near:.4g} m off the leg that UxAS commanded at {path.since_ms / 1000:.2f} s"
            self._record.check(False, before[0], number, f"{text}, {why}")
        self._record.see(near)

    def _beside(
        self, ends: Leg, legs: list[Leg], zones: list[Zone | Now], asked: Asked
    ) -> tuple[float, str]:
        """Distance of the nearest leg that keeps the zones [m]; otherwise of the nearest, and why
        none qualifies.
        """
        found = sorted(((_off_m(ends, leg), leg) for leg in legs), key=lambda one: one[0])
        why = ""
        for off_m, leg in found:
            # a margin smaller than the distance cannot suffice and is not tried
            margins = (m for m in MARGINS_M if m >= off_m - ROUNDING_M)
            margin = next((m for m in margins if self._are_near(ends, leg, m, asked)), None)
            if margin is None:
                if off_m > 2 * MARGINS_M[-1]:
                    break  # the larger margins fail too
                continue
            bad = [zone.id for zone in zones if not self._keeps(leg, ends, zone, margin)]
            if not bad:
                return off_m, ""
            why = why or f"which keeps zone {bad[0]} by less than {margin:g} m"
        return found[0][0], why or "more than any margin of a leg"

    def _are_near(self, ends: Leg, leg: Leg, margin_m: float, asked: Asked) -> bool:
        """Whether both ends of the flown segment are within the margin of the leg; each is checked once."""
        for p in ends:
            key = (p, leg, margin_m)
            if key not in asked:
                asked[key] = self._is_near(p, leg, margin_m)
            if not asked[key]:
                return False
        return True

    def _is_near(self, p: Position, leg: Leg, margin_m: float) -> bool:
        """Whether a position is within the margin of a leg, laterally and vertically; exact on the
        given numbers.
        """
        if not all(map(math.isfinite, p)):
            return False
        key = (p.alt_m, leg[0].alt_m, leg[1].alt_m, margin_m)
        if key not in self._level:
            if len(self._level) >= LEVELS_MOST:
                self._level.clear()
            self._level[key] = _is_level(*key)
        return self._level[key] and _is_beside(p, leg, margin_m)

    def _keeps(self, leg: Leg, flown: Leg, zone: Zone | Now, margin_m: float) -> bool:
        """Whether a leg keeps a zone by a margin; cached but for a moving zone."""
        if isinstance(zone, Now):
            return zone.kept_by(leg, flown, margin_m)
        key = (leg, zone, margin_m)
        if key not in self._kept:
            self._kept[key] = exact_leg_keeps(*leg, zone, margin_m)
        return self._kept[key]

    def end(self, at_ms: int) -> None:
        """Check that vehicles on a path were observed until at_ms [ms], or until they were lost."""
        gone = gone_ms(self._mission)
        for number, path in self._paths.items():
            last_ms = self._before[number][0] if number in self._before else path.since_ms
            until_ms = max(last_ms, min(at_ms, gone.get(number, at_ms)))
            self._seen_between(number, last_ms, until_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"near its legs": self._record}


def _off_m(ends: Leg, leg: Leg) -> float:
    """Approximate distance of a flown segment's ends from a leg, lateral or vertical [m]; for
    selection and display.
    """
    low, high = sorted((leg[0].alt_m, leg[1].alt_m))
    return max(max(_aside_m(p, leg), low - p.alt_m, p.alt_m - high) for p in ends)


def _aside_m(p: Position, leg: Leg) -> float:
    a, b = leg
    north, east = b.north_m - a.north_m, b.east_m - a.east_m
    square = north * north + east * east
    along = (p.north_m - a.north_m) * north + (p.east_m - a.east_m) * east
    share = min(max(along / square, 0.0), 1.0) if square else 0.0
    return math.hypot(p.north_m - a.north_m - share * north, p.east_m - a.east_m - share * east)


def _is_beside(p: Position, leg: Leg, margin_m: float) -> bool:
    """Whether a position is horizontally within the margin of a leg."""
    a, b = (Vec2(end.north_m, end.east_m) for end in leg)
    place = exact(edge_against, Vec2(p.north_m, p.east_m), a, b, margin_m)
    return bool(place != FARTHER)


def _is_level(alt_m: float, begins_m: float, ends_m: float, margin_m: float) -> bool:
    """Whether an altitude is within the margin of the altitudes between the ends of a leg."""
    low, high = Vec2(begins_m, 0.0), Vec2(ends_m, 0.0)
    place = exact(edge_against, Vec2(alt_m, 0.0), low, high, margin_m)
    return bool(place != FARTHER)
