"""G1, zones: every flown leg of every protected vehicle against every zone, exactly.

A keep-out forbids its polygon including the boundary, from floor to ceiling inclusive; a keep-in
permits only the interior of its polygon, strictly between floor and ceiling. A leg violates a zone
if one of its points does: the part at forbidden altitudes is checked against the polygon, on
rationals.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from cratous.judge.log import State
from cratous.judge.mission import Mission, Zone
from cratous.judge.plane import Pair, meet, squared_gap, winding
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, doubted, seconds

WIDER = 1 + 1e-9
NEVER = "the zone did not become known in flight"


class _Edge(NamedTuple):
    a: Pair
    b: Pair
    low_n: float
    high_n: float
    low_e: float
    high_e: float


class Fence:
    """A zone prepared for checks; `breaks(p, q)` checks one leg."""

    def __init__(self, zone: Zone) -> None:
        self.zone = zone
        self._pad = zone.padding_m * WIDER
        ring = zone.ring
        self._edges = []
        for k, a in enumerate(ring):
            b = ring[k - 1]
            self._edges.append(
                _Edge(a, b, min(a[0], b[0]) - self._pad, max(a[0], b[0]) + self._pad,
                      min(a[1], b[1]) - self._pad, max(a[1], b[1]) + self._pad)
            )  # fmt: skip
        self._low_n = min(e.low_n for e in self._edges)
        self._high_n = max(e.high_n for e in self._edges)
        self._low_e = min(e.low_e for e in self._edges)
        self._high_e = max(e.high_e for e in self._edges)
        self._inside_at: Pair | None = None

    def breaks(self, p: State, q: State) -> bool:
        """Whether some point of the straight leg is where the zone forbids it."""
        return self._leaves(p, q) if self.zone.keep_in else self._enters(p, q)

    def _leaves(self, p: State, q: State) -> bool:
        zone = self.zone
        low, high = sorted((p.alt_m, q.alt_m))
        if not (zone.floor_m < low and high < zone.ceiling_m):
            return True
        a, b = (p.north_m, p.east_m), (q.north_m, q.east_m)
        # inside at the end of the last leg means inside at the start of this one
        if self._inside_at != a and not winding(zone.ring, a):
            return True
        if self._near_boundary(a, b):
            return True
        self._inside_at = b
        return False

    def _enters(self, p: State, q: State) -> bool:
        low_n, high_n = min(p.north_m, q.north_m), max(p.north_m, q.north_m)
        low_e, high_e = min(p.east_m, q.east_m), max(p.east_m, q.east_m)
        if high_n < self._low_n or low_n > self._high_n:
            return False
        if high_e < self._low_e or low_e > self._high_e:
            return False
        part = self._at_altitude(p, q)
        if part is None:
            return False
        a, b = part
        return winding(self.zone.ring, a) != 0 or self._near_boundary(a, b)

    def _at_altitude(self, p: State, q: State) -> tuple[Pair, Pair] | None:
        """The part of a leg at the altitudes of a keep-out."""
        floor, ceiling = self.zone.floor_m, self.zone.ceiling_m
        a, b = (p.north_m, p.east_m), (q.north_m, q.east_m)
        if floor <= min(p.alt_m, q.alt_m) and max(p.alt_m, q.alt_m) <= ceiling:
            return a, b
        if max(p.alt_m, q.alt_m) < floor or min(p.alt_m, q.alt_m) > ceiling or floor > ceiling:
            return None
        climb = Fraction(q.alt_m) - Fraction(p.alt_m)
        at = sorted((Fraction(x) - Fraction(p.alt_m)) / climb for x in (floor, ceiling))
        first, last = max(at[0], Fraction(0)), min(at[1], Fraction(1))
        return _along(a, b, first), _along(a, b, last)

    def _near_boundary(self, a: Pair, b: Pair) -> bool:
        low_n, high_n = min(a[0], b[0]), max(a[0], b[0])
        low_e, high_e = min(a[1], b[1]), max(a[1], b[1])
        padding = Fraction(self.zone.padding_m) ** 2
        for edge in self._edges:
            if high_n < edge.low_n or low_n > edge.high_n:
                continue
            if high_e < edge.low_e or low_e > edge.high_e:
                continue
            if padding:
                if squared_gap(a, b, edge.a, edge.b) <= padding:
                    return True
            elif meet(a, b, edge.a, edge.b):
                return True
        return False


def _along(a: Pair, b: Pair, t: Fraction) -> Pair:
    n, e = Fraction(a[0]), Fraction(a[1])
    return n + t * (Fraction(b[0]) - n), e + t * (Fraction(b[1]) - e)


def beside(state: State, zone: Zone) -> State:
    """The position relative to where a moving zone is at that instant: it stands where its ring says."""
    gone = Fraction(state.time_ms - zone.from_ms, 1000)
    north, east = (Fraction(part) * gone for part in zone.velocity_m_s)
    place: Any = (Fraction(state.north_m) - north, Fraction(state.east_m) - east)
    return state._replace(north_m=place[0], east_m=place[1])


def rows(mission: Mission, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each protected vehicle and zone."""
    for vehicle in mission.protected:
        for zone in mission.zones:
            yield _row(vehicle, zone, flown[vehicle], mission.step_ms)


def _row(vehicle: int, zone: Zone, track: Track, step_ms: int) -> Row:
    kind = "keep_in" if zone.keep_in else "keep_out"
    subject = ("zone", str(zone.id), str(vehicle))
    item = f"zone: {kind} {zone.id}, flight of vehicle {vehicle}"
    moves = any(zone.velocity_m_s)
    # what becomes known between two states is known at the second; what moves is known before, and the first leg counts
    since_ms = zone.from_ms // step_ms * step_ms if moves else zone.from_ms
    first = track.from_index(since_ms)
    # no leg follows the last state: what becomes known with it applies to no path
    if first >= len(track.states) - (since_ms > 0):
        if track.states and not track.doubt:
            # the one check: the whole flight was before it
            note = "the zone was not in force in flight" if moves else NEVER
            return Row("G1", subject, item, HOLDS, note, checks=1)
        return Row("G1", subject, item, UNKNOWN, track.doubt or "no position was logged")
    fence, checks = Fence(zone), 0
    for before, after in track.legs(first):
        if zone.over(before.time_ms):
            break  # a leg that begins before the zone ends is checked as a whole
        checks += 1
        leg = (beside(before, zone), beside(after, zone)) if moves else (before, after)
        if fence.breaks(*leg):
            note = f"broken on the leg from {seconds(before.time_ms)}"
            return Row("G1", subject, item, VIOLATED, note, before.time_ms, checks)
    if not checks:
        note = track.doubt_before(zone.until_ms) or "no leg was flown while the zone was there"
        return Row("G1", subject, item, UNKNOWN, note)
    row = Row("G1", subject, item, HOLDS, f"{checks} flown legs", checks=checks)
    return doubted(row, track.doubt_before(zone.until_ms))
