"""Views over an area whose task leaves the view open.

A view tilted in one direction over ground, on the way there and on the way back, covers a wider strip than one
straight down and costs nothing in the turns: all footprints have the same offset from the aircraft. Aslant to the
lanes the strip is wider still, since it is as wide as the footprint's diagonal.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from cratous.core.kernel import Vec2
from cratous.core.tasks.stations import in_ring
from cratous.core.tasks.sweep import Swath
from cratous.services.mission.sensor import sample_distance_m, zoomed
from cratous.services.planning.point_paths import STRAIGHT_DOWN_RAD
from cratous.spec.mission import AREAS, Camera, Pattern, Task, View

TILTS_DEG = (-75.0, -60.0, -55.0, -50.0, -45.0, -40.0, -35.0, -30.0, -25.0, -20.0)
"""Tilts tried besides straight down [deg]; the limits set by the sample distance are added, one for each field of view."""
SHALLOWEST_SHARP_DEG = -20.0
"""Shallowest tilt if the task requires a ground sample distance, which the image centre then meets [deg]."""
SHALLOWEST_DEG = -45.0
"""Shallowest tilt if the task requires no ground sample distance [deg]: the image centre is then seen from
1.4 times the distance straight down.
"""

ASIDE_DEG = (0.0, 30.0, 45.0, 60.0)
"""Angles tried between the view and the lanes [deg]."""
ALIKE = 1.005
"""Ways that differ by less than this factor count as equally long."""

WITHIN = 1 - 1e-8
"""Factor on the sample distance for which the shallowest tilt is calculated, so that rounding leaves it within."""


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
    swath_of: Callable[[View], Swath | None],
    length_of: Callable[[Swath], float],
) -> View | None:
    """The view that needs the shortest way along lanes of a heading; None: straight down.

    swath_of: what a pass along the heading sees with a view; length_of: the length of the lanes that a swath needs
    [m], infinite for none. Of views that need nearly the same the steepest is taken, and then the one that looks
    most nearly along the lanes. Only views that meet the task's ground sample distance at the image centre are
    considered, and only for a camera that can look back.
    """
    views: list[View | None] = []
    if camera.min_elevation_rad <= STRAIGHT_DOWN_RAD:
        views.append(None)
    if camera.max_azimuth_rad - camera.min_azimuth_rad >= 2 * math.pi - 1e-6:
        views += [
            View((heading_rad + math.radians(aside)) % (2 * math.pi), tilt_rad, True)
            for tilt_rad in _tilts(task, camera, height_m)
            for aside in ASIDE_DEG
        ]
    down = View(heading_rad, -math.pi / 2, True)
    seen = [swath_of(down if view is None else view) for view in views]
    lengths = [math.inf if one is None else length_of(one) for one in seen]
    enough = ALIKE * min(lengths, default=math.inf)
    return next((view for view, m in zip(views, lengths, strict=True) if m <= enough), None)


def _tilts(task: Task, camera: Camera, height_m: float) -> list[float]:
    """Tilts within the gimbal's range and the required sample distance [rad], steepest first."""
    shallowest = math.radians(SHALLOWEST_DEG)
    tilts = [math.radians(degrees) for degrees in TILTS_DEG]
    if camera.min_elevation_rad > STRAIGHT_DOWN_RAD:
        tilts.append(camera.min_elevation_rad)
    if task.gsd_m > 0 and camera.pixels:
        shallowest = math.radians(SHALLOWEST_SHARP_DEG)
        for field in (camera.hfov_rad, *camera.zoom_rad):  # as shallow as each is sharp enough
            level_m = 2 * height_m * math.tan(field / 2) / camera.pixels
            tilts.append(-math.asin(min(1.0, level_m / (task.gsd_m * WITHIN))))
        # some field of view of the camera has to be sharp enough
        tilts = [tilt for tilt in tilts if _sharp(task, camera, height_m, tilt)]
    low, high = camera.min_elevation_rad, min(camera.max_elevation_rad, shallowest)
    return [tilt for tilt in sorted(set(tilts)) if low <= tilt <= high]


def _sharp(task: Task, camera: Camera, height_m: float, tilt_rad: float) -> bool:
    """Whether the camera, zoomed in as for a tilt, meets the task's ground sample distance."""
    view = View(0.0, tilt_rad, True)
    near = zoomed(camera, task, height_m, view)
    gsd_m = sample_distance_m(near, view, height_m)
    return in_ring(Vec2(gsd_m, 0.0), Vec2(0.0, 0.0), 0.0, task.gsd_m * (1 + 1e-9))
