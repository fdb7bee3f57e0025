"""Searches: coverage by logged footprints of suitable cameras."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from cratous.judge.coverage import area_m2, area_seen, footprints, line_seen, outlines, point_seen
from cratous.judge.earth import ACCURACY_M, to_local
from cratous.judge.log import Look
from cratous.judge.mission import Point, Task
from cratous.judge.shares import forbidden_note
from cratous.judge.task_presence import Flight, nearest_m
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED
from cratous.judge.views import as_asked

SHARE = 0.99
SPACING_M = 10.0
"""Sampling distance of the monitor on lines [m]: half of it, seen or unseen, is not decided."""
COARSER = 1.01
"""A footprint counts up to this multiple of the required ground sample distance."""


def searched(flight: Flight, task: Task) -> tuple[str, str]:
    """Verdict and note for a search."""
    judge = {"line_search": _line, "point_search": _point}.get(task.kind, _area)
    verdict, note = judge(flight, task)
    if verdict == VIOLATED:
        note += forbidden_note(flight, task)
    if verdict != VIOLATED and task.gsd_m and not _resolves(flight, task):
        return UNKNOWN, f"{note}; how many pixels the camera has is not known"
    return verdict, note


def _looks(flight: Flight, task: Task) -> list[tuple[Look, list[Point]]]:
    """The footprints that count for a task, in the mission frame."""
    found = []
    spans = flight.spans(task.id)
    mission = flight.mission
    for look in flight.log.looks:
        if not any(v == look.vehicle and a <= look.time_ms <= b for v, a, b in spans):
            continue
        if len(look.corners) < 3 or not _suits(flight, task, look):
            continue
        local = [to_local(mission.latitude_deg, mission.longitude_deg, *c) for c in look.corners]
        corners = [c for c in local if c is not None]
        if len(corners) == len(local) and _shows(flight, task, look, corners):
            found.append((look, corners))
    return found


def _shows(flight: Flight, task: Task, look: Look, corners: list[Point]) -> bool:
    """Whether the image shows the ground as required, from the vehicle's true position."""
    here = _place(flight, look)
    ground_m = flight.mission.terrain_m if look.centre is None else look.centre[2]
    # if the position is unknown, the gap in the track already prevents `holds`
    return here is None or as_asked(here, ground_m, corners, task.views_deg)


def _place(flight: Flight, look: Look) -> tuple[float, float, float] | None:
    """Position of the vehicle at a footprint, on a known leg; None if there is none."""
    track = flight.tracks.get(look.vehicle)
    index = track.from_index(look.time_ms) if track else 0
    if track is None or index >= len(track.states):
        return None
    after = track.states[index]
    if after.time_ms == look.time_ms:
        return after.north_m, after.east_m, after.alt_m
    before = track.states[index - 1] if index else after
    if before.time_ms >= look.time_ms or before.time_ms in track.unknown:
        return None
    part = (look.time_ms - before.time_ms) / (after.time_ms - before.time_ms)
    north, east, alt = (b + part * (a - b) for b, a in zip(before[1:4], after[1:4], strict=True))
    return north, east, alt


def _suits(flight: Flight, task: Task, look: Look) -> bool:
    """Whether the camera sees the wavelength with sufficient resolution, as far as known."""
    vehicle = flight.mission.vehicles.get(look.vehicle)
    camera = (
        next((c for c in vehicle.cameras if c.payload == look.payload), None) if vehicle else None
    )
    if camera is None:
        return False
    if (
        "AllAny" not in (task.wavelength, camera.wavelength)
        and task.wavelength != camera.wavelength
    ):
        return False
    if not task.gsd_m or not camera.pixels:
        return True
    slant = _slant_m(flight, look)
    if slant is None:
        return False
    pixel = 2 * slant * math.tan(math.radians(look.hfov_deg) / 2) / camera.pixels
    return pixel <= task.gsd_m * COARSER


def _slant_m(flight: Flight, look: Look) -> float | None:
    """Distance from the aircraft to the ground point at the centre of its view [m]."""
    here = _place(flight, look)
    if here is None or look.centre is None:
        return None
    mission = flight.mission
    centre = to_local(mission.latitude_deg, mission.longitude_deg, *look.centre[:2])
    return None if centre is None else math.dist(here, (*centre, look.centre[2]))


def _resolves(flight: Flight, task: Task) -> bool:
    """Whether the pixels of all cameras that may have looked are known."""
    for vehicle, *_ in flight.spans(task.id):
        flyer = flight.mission.vehicles.get(vehicle)
        if flyer is None or any(not c.pixels for c in flyer.cameras):
            return False
    return True


def _by_share(sure: float, may: float, what: str) -> tuple[str, str]:
    sure, may = max(0.0, sure), min(1.0, may)
    note = f"footprints covered {100 * sure:.3f} % of its {what}"
    if sure >= SHARE:
        return HOLDS, note
    if may < SHARE:
        return VIOLATED, note
    return UNKNOWN, f"{note} for sure and {100 * may:.3f} % perhaps"


def _line(flight: Flight, task: Task) -> tuple[str, str]:
    prints = footprints([corners for _, corners in _looks(flight, task)])
    sure, may, whole = line_seen(prints, task.points)
    if whole == 0:
        return UNKNOWN, "the line has no length"
    # gaps of a millimetre at each end of a footprint do not count
    close = 4 * ACCURACY_M * (len(task.points) + 1)
    if whole - sure <= close:
        sure = whole
    half = SPACING_M / 2 if sure < whole else 0.0
    return _by_share((sure - half) / whole, (may + half) / whole, "line")


def _area(flight: Flight, task: Task) -> tuple[str, str]:
    prints = footprints([corners for _, corners in _looks(flight, task)])
    inner, outer = outlines(task)
    seen = area_seen(prints, outer)
    whole, least = area_m2(outer), area_m2(inner)
    if least == 0:
        return UNKNOWN, "the area is empty"
    sure, unseen = seen.seen, max(0.0, seen.unseen - (whole - least))
    verdict, note = _by_share(1 - (whole - sure) / least, 1 - unseen / whole, "area")
    return verdict, f"{note} (squares of {seen.finest_m:g} m)"


def _point(flight: Flight, task: Task) -> tuple[str, str]:
    point = task.points[0]
    looks = _looks(flight, task)
    sure, may = point_seen(footprints([corners for _, corners in looks]), point)
    times = sorted({look.time_ms for (look, _), s in zip(looks, sure, strict=True) if s})
    perhaps = sorted({look.time_ms for (look, _), s in zip(looks, may, strict=True) if s})
    note = f"seen in {len(times)} footprints"
    if not np.any(may):
        return VIOLATED, note
    verdict = HOLDS if times else UNKNOWN
    if task.duration_ms:
        seen, most = (_stayed_ms(flight, x) for x in (times, perhaps))
        note += f", for {seen / 1000:g} of {task.duration_ms / 1000:g} s"
        # footprints are a heartbeat apart: one period at each end of the dwell is undecided
        room = 2 * flight.mission.heartbeat_ms
        if most + room < task.duration_ms:
            return VIOLATED, note
        if seen + room < task.duration_ms:
            verdict = UNKNOWN
    if task.standoff_m:
        nearest = nearest_m(flight, task, point)
        note += f"; came within {nearest:.1f} m, allowed {task.standoff_m:g} m"
        if nearest < task.standoff_m - ACCURACY_M:
            return VIOLATED, note
        if nearest < task.standoff_m + ACCURACY_M:
            verdict = UNKNOWN
    return verdict, note


def _stayed_ms(flight: Flight, times: list[int]) -> int:
    """Total time during which it was seen, without a missing footprint in between [ms]."""
    period = flight.mission.heartbeat_ms
    return sum(b - a for a, b in pairwise(times) if b - a <= period)
