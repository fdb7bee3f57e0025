"""From where the camera may look over an area whose task leaves that open.

A view that is tilted along the lanes, ahead on the way there and back on the way back, sees a wider strip
than one straight down and costs nothing in the turns: all footprints lie off the aircraft by the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from cratous.core.tasks.sweep import Corner, strips_needed
from cratous.services.mission.sensor import elevation_rad, sample_distance_m
from cratous.services.planning.point_ways import STRAIGHT_DOWN_RAD
from cratous.spec.mission import AREAS, Camera, Pattern, Task, View

TILTS_DEG = (-75.0, -60.0, -55.0, -50.0, -45.0, -40.0, -35.0, -30.0)
"""Tilts that are tried beside straight down, steepest first, and the one that the sample distance allows."""
SHALLOWEST_DEG = -45.0
"""No view is shallower than this where the task names no ground sample distance: what is in the middle of
the image is then seen from 1.4 times as far as straight down."""


def open_view(task: Task) -> bool:
    """Whether the planner chooses from where an area is seen: no view is asked for."""
    lanes = task.pattern in (None, Pattern.SWEEP)
    return task.kind in AREAS and lanes and task.view is None and not task.views


def brought_view(task: Task, elevation_rad: float | None, azimuth_rad: float) -> View | None:
    """The view that an option has brought itself, by its angles; None where the task asks for one."""
    if not open_view(task) or elevation_rad is None:
        return None
    return View(azimuth_rad, elevation_rad, True)


def best_view(
    task: Task,
    camera: Camera,
    height_m: float,
    heading_rad: float,
    width_of: Callable[[View], float],
    vertices: Sequence[Corner],
) -> View | None:
    """The steepest view along lanes of a heading that needs as few of them as any; None: straight down.

    width_of: how wide a strip a pass with a view covers [m], 0: none. Only views that keep the task's ground
    sample distance in the middle of the image count, and a camera that can look back.
    """
    needed: dict[View | None, int] = {}
    if camera.min_elevation_rad <= STRAIGHT_DOWN_RAD:
        down = View(heading_rad, -math.pi / 2, True)
        needed[None] = strips_needed(vertices, heading_rad, width_of(down))
    around = camera.max_azimuth_rad - camera.min_azimuth_rad >= 2 * math.pi - 1e-6
    for tilt_rad in _tilts(task, camera, height_m) if around else ():
        view = View(heading_rad, tilt_rad, True)
        needed[view] = strips_needed(vertices, heading_rad, width_of(view))
    return min(needed, key=lambda view: needed[view] or math.inf, default=None)


def _tilts(task: Task, camera: Camera, height_m: float) -> list[float]:
    """What the gimbal reaches and the wanted sample distance allows [rad], steepest first."""
    shallowest = math.radians(SHALLOWEST_DEG)
    tilts = [math.radians(degrees) for degrees in TILTS_DEG]
    if camera.min_elevation_rad > STRAIGHT_DOWN_RAD:
        tilts = sorted((*tilts, camera.min_elevation_rad))
    if task.gsd_m > 0 and camera.pixels:
        straight_m = sample_distance_m(camera, None, height_m)
        lowest_m = straight_m * math.sin(-elevation_rad(camera, None))
        shallowest = min(-math.asin(min(1.0, lowest_m / task.gsd_m)), tilts[-1])
        tilts = sorted((*tilts, shallowest))
    low, high = camera.min_elevation_rad, min(camera.max_elevation_rad, shallowest)
    return [tilt for tilt in tilts if low <= tilt <= high]
