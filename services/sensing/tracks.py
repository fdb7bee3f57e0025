"""Tracks: association of measurements with aircraft, and the estimated state of each.

A measurement with an id belongs to the track of that id; one without to the nearest track whose gate contains
it, one per scan. A track is confirmed after enough updates of its sensor, and ends after some time without
any. Measurements may arrive late and out of order: each track keeps those of the recent past, and processes
them in order of their times. A measurement of its own outside the gate means a manoeuvre: the track is
restarted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.kernel import Vec2
from cratous.core.permit.association import in_gate
from cratous.services.sensing.filter import Estimate, Measured, begun, folded, later
from cratous.services.sensing.sensors import Detection
from cratous.spec.mission.sensing import Sensing


class Track(NamedTuple):
    """One aircraft. number: its id, or -1, -2, ... if no sensor reports one; base: estimate without `recent`,
    the measurements of the recent past in order of time; hits: times of those that count for confirmation
    [ms]; shown: whether it is confirmed; source: true target of the last measurement, unknown to the
    vehicle.
    """

    number: int
    base: Estimate
    recent: tuple[Measured, ...] = ()
    hits: tuple[int, ...] = ()
    shown: bool = False
    last_ms: int = 0
    source: int = 0


class Tracks(NamedTuple):
    """All tracks of a vehicle, and how many had no id."""

    tracks: tuple[Track, ...] = ()
    unnamed: int = 0


def estimate(track: Track, at_ms: int, manoeuvre_m_s2: float) -> Estimate:
    """The estimate of a track at an instant not before its base, from the measurements up to then."""
    seen = [one for one in track.recent if lasted(one.at_ms, at_ms, 0)]
    return later(folded(track.base, seen, manoeuvre_m_s2), at_ms, manoeuvre_m_s2)


def tracked(before: Tracks, came: Sequence[Detection], sensing: Sensing, now_ms: int) -> Tracks:
    """The tracks after new measurements, without those that have ended."""
    after = before
    scans = sorted(came, key=lambda one: (one.seen.at_ms, one.sensor, one.name, one.seen))
    for _, scan in groupby(scans, key=lambda one: (one.seen.at_ms, one.sensor)):
        after = _scanned(after, tuple(scan), sensing, now_ms)
    kept = (t for t in after.tracks if not lasted(t.last_ms, now_ms, sensing.coast_ms))
    return after._replace(tracks=tuple(_settled(t, sensing, now_ms) for t in kept))


def _scanned(before: Tracks, scan: Sequence[Detection], sensing: Sensing, now_ms: int) -> Tracks:
    """Process all measurements of one sensor at one instant: each track gets at most one."""
    tracks = {track.number: track for track in before.tracks}
    unnamed = before.unnamed
    left, free = list[Detection](), set(tracks)
    for one in scan:
        if one.name in tracks and one.name:
            tracks[one.name] = _with(tracks[one.name], one, sensing, now_ms)
            free.discard(one.name)
        else:
            left.append(one)
    for number, one in _nearest(left, [t for t in before.tracks if t.number in free], sensing):
        left.remove(one)
        track = tracks.pop(number)
        number = one.name or number
        tracks[number] = _with(track._replace(number=number), one, sensing, now_ms)
    for one in left:
        unnamed += not one.name
        number = one.name or -unnamed
        tracks[number] = _with(Track(number, begun(one.seen)), one, sensing, now_ms)
    return Tracks(tuple(tracks[number] for number in sorted(tracks)), unnamed)


def _nearest(
    left: Sequence[Detection], tracks: Sequence[Track], sensing: Sensing
) -> list[tuple[int, Detection]]:
    """Pairs of a track and a measurement in its gate, nearest first, each used once. left: measurements of
    one instant.
    """
    if not left:
        return []
    pairs, at_ms = [], left[0].seen.at_ms
    for track in tracks:
        known = estimate(track, max(at_ms, track.base.at_ms), sensing.manoeuvre_m_s2)
        for k, one in enumerate(left):
            # a track with an id does not match another id
            if one.name and track.number in range(1, 2**31):
                continue
            if _fits(known, one.seen, sensing.sigmas):
                pairs.append((_apart_m(known, one.seen), k, track.number))
    taken, used = dict[int, int](), set[int]()
    for _, k, number in sorted(pairs):
        if k not in taken and number not in used:
            taken[k] = number
            used.add(number)
    return [(number, left[k]) for k, number in taken.items()]


def _fits(known: Estimate, seen: Measured, sigmas: float) -> bool:
    """Whether the measured position is in the gate."""
    p, q = known.position, seen.position
    off = Vec2(q.north_m - p.north_m, q.east_m - p.east_m)
    wide, high = known.wide.place + seen.wide.place, known.high.place + seen.high.place
    return bool(in_gate(off, q.alt_m - p.alt_m, wide, high, sigmas))


def _steady(known: Estimate, seen: Measured, sigmas: float) -> bool:
    """Whether the measured velocity is in the gate."""
    v, w = known.velocity, seen.velocity
    off = Vec2(w.north_m_s - v.north_m_s, w.east_m_s - v.east_m_s)
    wide = known.wide.velocity + seen.wide.velocity
    high = known.high.velocity + seen.high.velocity
    return bool(in_gate(off, w.down_m_s - v.down_m_s, wide, high, sigmas))


def _apart_m(known: Estimate, seen: Measured) -> float:
    p, q = known.position, seen.position
    return math.hypot(q.north_m - p.north_m, q.east_m - p.east_m, q.alt_m - p.alt_m)


def _with(track: Track, one: Detection, sensing: Sensing, now_ms: int) -> Track:
    """The track after a measurement of its own."""
    seen, first = one.seen, not track.hits
    window_ms = sensing.confirm_of * sensing.sensors[one.sensor].period_ms
    hits = tuple(
        at for at in (*track.hits, seen.at_ms) if in_time(at, max(at, seen.at_ms), window_ms - 1)
    )
    counts = len(hits) >= sensing.confirm_hits
    after = track._replace(
        hits=hits, shown=track.shown or counts, last_ms=now_ms, source=one.source
    )
    if first or not lasted(track.base.at_ms, seen.at_ms, 0):
        return after  # too late to be of use
    known = estimate(track, seen.at_ms, sensing.manoeuvre_m_s2)
    if not (_fits(known, seen, sensing.sigmas) and _steady(known, seen, sensing.sigmas)):
        newer = tuple(m for m in track.recent if not lasted(m.at_ms, seen.at_ms, 0))
        return after._replace(base=begun(seen), recent=newer)
    return after._replace(recent=tuple(sorted((*track.recent, seen))))


def _settled(track: Track, sensing: Sensing, now_ms: int) -> Track:
    """The track with measurements merged into the base before which none can arrive any more."""
    latest_ms = max(one.latency_ms for one in sensing.of_traffic)
    old = [m for m in track.recent if not lasted(now_ms - latest_ms, m.at_ms, 0)]
    base = folded(track.base, old, sensing.manoeuvre_m_s2)
    return track._replace(base=base, recent=track.recent[len(old) :])
