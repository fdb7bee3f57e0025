"""Which reported footprints count for a search, whichever vehicle reports them.

The camera has to see the task's wavelength; no corner may lie near the horizon; the image centre
has to satisfy the required view angle and ground sample distance. The kernel `in_ring` decides all
of this from the vehicle's reported position and the corners: reported gimbal angles are not used.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import radians
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.tasks.stations import in_ring
from cratous.services.mission.frames import Projection
from cratous.services.mission.required_views import middle, reach_m, rings, sharp_within_m
from cratous.spec.mission import Camera, Task


class Look(NamedTuple):
    """A footprint (north, east) [m] of a camera at a position and height above it; hfov_rad: as reported."""

    camera: Camera
    here: Vec2
    height_m: float
    hfov_rad: float
    corners: tuple[tuple[float, float], ...]


def looks_of(body: Any, cameras: Sequence[Camera], projection: Projection) -> Iterator[Look]:
    """The footprints in a vehicle's state; payloads that are not among these cameras are skipped."""
    for payload in body.PayloadStateList:
        told = getattr(payload, "Footprint", None)
        camera = _camera(cameras, payload.PayloadID) if told and len(told) >= 3 else None
        if camera is None or not told:
            continue
        corners = tuple(projection.to_local(c.Latitude, c.Longitude) for c in told)
        height_m = body.Location.Altitude - sum(c.Altitude for c in told) / len(told)
        here = Vec2(*projection.to_local(body.Location.Latitude, body.Location.Longitude))
        hfov_rad = radians(payload.HorizontalFieldOfView)
        yield Look(camera, here, height_m, hfov_rad, corners)


def _camera(cameras: Sequence[Camera], number: int) -> Camera | None:
    """The camera of a payload: by its gimbal, as in CRATOUS logs, or by its own id."""
    by_id = (c for c in cameras if c.camera_id and c.camera_id == number)
    return next((c for c in cameras if c.payload_id == number), next(by_id, None))


def counts(one: Look, task: Task) -> bool:
    """Whether a footprint counts for a task."""
    centre = middle(one.corners)
    if not suits(one.camera, task) or centre is None:
        return False
    height_m = max(one.height_m, 0.0)  # on or below the ground nothing is within reach
    reach = reach_m(height_m)
    if not all(in_ring(one.here, Vec2(*corner), 0.0, reach) for corner in one.corners):
        return False
    sharp_m = sharp_within_m(task, one.camera, one.hfov_rad, height_m)
    allowed = ((r.least_m, min(r.most_m, sharp_m)) for r in rings(task, height_m))
    at = Vec2(*centre)
    return any(least <= most and in_ring(one.here, at, least, most) for least, most in allowed)


def suits(camera: Camera, task: Task) -> bool:
    """Whether a camera sees the wavelength of a task."""
    return "AllAny" in (task.wavelength, camera.wavelength) or task.wavelength == camera.wavelength
