"""Classes of vehicles with the same flight performance, and task paths before they are checked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.routing.dubins import pose_after, turn_radius_m
from cratous.core.routing.visibility import start_point
from cratous.spec.mission import Camera, Position, Task, Vehicle, Zone
from cratous.spec.mission.plan import Pose

BANK_RESERVE = 1.1
"""Planned turns are wider than the tightest ones by this factor, so that the autopilot can correct."""
HEADING_STEP_DEG = 20
MOMENT_MS = 1_000
"""Duration of a pass over a point if the task requires no dwell [ms]."""


class Flyer(NamedTuple):
    """A class of vehicles with the same flight performance and cameras."""

    speed_m_s: float
    radius_m: float
    alt_m: float
    max_climb_m_s: float
    cameras: tuple[Camera, ...]


class Way(NamedTuple):
    """A path of a task before it is checked, or none and the reason.

    coverage: fraction covered by the camera, None if coverage is not required. elevation_rad, azimuth_rad:
    camera direction; None: not specified. zones: those that cut parts from the path.
    """

    label: str
    start: Pose
    end: Pose
    points: tuple[Position, ...]
    duration_ms: int
    coverage: float | None = None
    reason: str = ""
    elevation_rad: float | None = None
    azimuth_rad: float = 0.0
    zones: tuple[Zone, ...] = ()


def no_way(label: str, reason: str) -> Way:
    """A path that is not flown, with the reason."""
    nowhere = Pose(0.0, 0.0, 0.0, 0.0)
    return Way(label, nowhere, nowhere, (), 0, None, reason)


def flyer_of(vehicle: Vehicle) -> Flyer:
    """The class of a vehicle; its altitude is `cruise_alt_m`."""
    radius = BANK_RESERVE * turn_radius_m(vehicle.speed_m_s, vehicle.max_bank_rad)
    alt = vehicle.cruise_alt_m
    return Flyer(vehicle.speed_m_s, radius, alt, vehicle.max_climb_m_s, vehicle.cameras)


def flight_ms(length_m: float, speed_m_s: float) -> int:
    """Time to fly a length [ms], rounded up."""
    return math.ceil(1000 * length_m / speed_m_s - 1e-6)


def camera_for(task: Task, cameras: Sequence[Camera]) -> Camera | None:
    """The widest camera for the required wavelength; None if there is none."""
    fit = [c for c in cameras if "AllAny" in (task.wavelength, c.wavelength)]
    fit += [c for c in cameras if c.wavelength == task.wavelength and c not in fit]
    return max(fit, key=lambda c: c.hfov_rad, default=None)


def straight(label: str, middle: Pose, duration_ms: int, speed_m_s: float) -> Way:
    """A straight pass centred on a pose."""
    half = speed_m_s * duration_ms / 2000
    start, end = pose_after(middle, 0, -half, 1.0), pose_after(middle, 0, half, 1.0)
    points = (start_point(start), start_point(middle), start_point(end))
    return Way(label, start, end, points, duration_ms)
