"""Views over an area whose task leaves the view open.

A view tilted along the lanes, ahead in one direction and back in the other, covers a wider strip than one
straight down and costs nothing in the turns: all footprints have the same offset from the aircraft.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from cratous.core.tasks.sweep import Corner, strips_needed
from cratous.services.mission.sensor import elevation_rad, sample_distance_m
from cratous.services.planning.point_paths import STRAIGHT_DOWN_RAD
from cratous.spec.mission import AREAS, Camera, Pattern, Task, View

TILTS_DEG = (-75.0, -60.0, -55.0, -50.0, -45.0, -40.0, -35.0, -30.0)
"""Tilts tried besides straight down, steepest first [deg]; the limit set by the sample distance is added."""
SHALLOWEST_DEG = -45.0
"""Shallowest tilt if the task requires no ground sample distance [deg]: the image centre is then seen from
1.4 times the distance straight down.
"""


def open_view(task: Task) -> bool:
    """Whether the planner may choose the view of an area, since the task requires none."""
    lanes = task.pattern in (None, Pattern.SWEEP)
    return task.kind in AREAS and lanes and task.view is None and not task.views


def brought_view(task: Task, elevation_rad: float | None, azimuth_rad: float) -> View | None:
    """The view that the planner chose for an option, from its angles; None if the task requires one."""
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
    """The steepest view along lanes of a heading that needs the fewest lanes; None: straight down.

    width_of: strip width of a pass with a view [m], 0 for none. Only views that meet the task's ground sample
    distance at the image centre are considered, and only for a camera that can look back.
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
    """Tilts within the gimbal's range and the required sample distance [rad], steepest first."""
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
