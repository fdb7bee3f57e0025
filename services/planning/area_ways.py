"""Paths over an area: lanes as wide as the footprint, spirals, squares and sectors.

Candidates are compared by their length without zones; those much longer than the shortest, and all beyond a
small number, are dropped with that reason. The rest get turns around the zones.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.visibility import Roadmap, name_of
from cratous.core.tasks.coverage import (
    area_m2,
    disc,
    look,
    share_covered,
)
from cratous.core.tasks.sweep import (
    LANES_MOST,
    Piece,
    Strip,
    SwathOf,
    along,
    edge_headings,
    joined,
    sector,
    spiral,
    square_spiral,
    strips,
    sweep,
)
from cratous.services.mission.sensor import elevation_rad, footprints, looks_over, sample_line
from cratous.services.planning.area_site import (
    Candidate,
    Site,
    camera_with,
    candidate_of,
    lane_lengths,
    lane_width_m,
    site_of,
    swaths_aside,
    swaths_of,
    tilt_label,
)
from cratous.services.planning.area_views import best_view, open_view
from cratous.services.planning.cut_paths import cut
from cratous.services.planning.performance_classes import (
    HEADING_STEP_DEG,
    Flyer,
    Way,
    flight_ms,
    no_way,
)
from cratous.services.planning.smoothing import MARGIN
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Camera, Pattern, Position, Task, View, Zone
from cratous.spec.mission.plan import Pose

OPTIONS_MOST = 4
"""Most paths offered over an area."""
REFUSED_MOST = 8
"""Number of paths rejected because of zones after which no more are tried."""
DEARER = 1.5
"""A path longer than the shortest by more than this factor is not offered."""
LEADS = (0.8, 0.0)
"""Distance for settling before a lane, in turn radii; the second value is used where zones leave less room."""
VIEWS_MOST = 4
MEASURED_MOST = 8_000
"""Coverage is computed in planning for paths with at most this many footprints."""
FEW, FEWER = 2_000, 8
"""With more footprints than FEW, every FEWER-th is checked first."""
TURN_RESERVE = 1.15
"""Radius of a spiral's innermost turn, in turn radii."""


Maker = Callable[..., list[Candidate] | str]
"""Returns the candidates of a site with a settling distance `lead_m` [m], or why there are none."""


def area_ways(
    task: Task, flyer: Flyer, camera: Camera, zones: Sequence[Zone], terrain_m: float
) -> Iterator[Way]:
    """A few paths over the area for each wanted view, shortest first, and those not offered."""
    site = site_of(task, flyer, camera, terrain_m)
    maps = roadmaps(zones, flyer.radius_m)
    views = (task.view, *task.views)
    if open_view(task) and any(one.view for one in _along_lanes(site, 0.0)):
        found = list(_offered(site, _along_lanes, zones, maps))
        yield from found
        # lanes seen straight down lie over the area itself, which may be clear of zones where its
        # surroundings are not
        if any(not way.reason for way in found):
            return
    for view in views[:VIEWS_MOST]:
        yield from _offered(site, functools.partial(_candidates, view=view), zones, maps)
    if len(views) > VIEWS_MOST:
        yield no_way("", f"only the first {VIEWS_MOST} directions of view are offered")


def _offered(
    site: Site, make: Maker, zones: Sequence[Zone], maps: Sequence[Roadmap]
) -> Iterator[Way]:
    """The shortest candidates as paths, and those not offered."""
    made = make(site, lead_m=LEADS[0] * site.flyer.radius_m)
    if isinstance(made, str):
        yield no_way("", made)
        return
    found = sorted(made, key=lambda c: c.length_m)
    best_m, offered, refused = found[0].length_m, 0, 0
    for candidate in found:
        if candidate.length_m > DEARER * best_m:
            times = candidate.length_m / best_m
            yield no_way(candidate.label, f"it is {times:.2f} times as long as the shortest")
        elif offered >= OPTIONS_MOST:
            yield no_way(candidate.label, f"{OPTIONS_MOST} that are no longer are offered")
        elif refused >= REFUSED_MOST:
            yield no_way(candidate.label, f"{REFUSED_MOST} that are no longer are not possible")
        else:
            way = _way(site, candidate, zones, maps)
            if way.reason:
                # a shorter settling distance may suffice where zones are near
                way = _tighter(site, make, way, zones, maps)
            refused += bool(way.reason)
            offered += not way.reason
            yield way


def area_parts(
    task: Task, flyer: Flyer, camera: Camera, maps: Sequence[Roadmap], terrain_m: float
) -> Iterator[Way]:
    """For each wanted view the shortest paths over an area, without the parts that zones forbid."""
    site = site_of(task, flyer, camera, terrain_m)
    for view in (task.view, *task.views)[:VIEWS_MOST]:
        made = _candidates(site, LEADS[1] * flyer.radius_m, view)
        if isinstance(made, str):
            yield no_way("", made)
            continue
        for candidate in sorted(made, key=lambda c: c.length_m)[:OPTIONS_MOST]:
            paths = [piece.points for piece in candidate.pieces]
            left = cut(paths, flyer.radius_m, maps, in_order=False)
            label = f"{candidate.label}, in part"
            if not left.points:
                yield no_way(label, "no part of it outside of the zones has room to turn")
                continue
            yield Way(
                label,
                left.start,
                left.end,
                left.points,
                flight_ms(polyline_length_m(left.points), flyer.speed_m_s),
                _share(site, view, left.points, None),
                "",
                elevation_rad(camera, view),
                view.azimuth_rad if view is not None else 0.0,
                left.zones,
            )


def _tighter(
    site: Site, make: Maker, way: Way, zones: Sequence[Zone], maps: Sequence[Roadmap]
) -> Way:
    """The candidate of the same name with a shorter settling distance, if that is possible; else the rejected
    path.
    """
    made = make(site, lead_m=LEADS[1] * site.flyer.radius_m)
    same = [c for c in made if isinstance(c, Candidate) and c.label == way.label]
    tight = _way(site, same[0], zones, maps) if same else way
    return way if tight.reason else tight


def _way(site: Site, candidate: Candidate, zones: Sequence[Zone], maps: Sequence[Roadmap]) -> Way:
    """A candidate with turns and coverage, or the reason why zones forbid it."""
    bad = _broken_lane(candidate, zones)
    if bad:
        return no_way(candidate.label, bad)
    path = joined(candidate.pieces, site.flyer.radius_m, maps)
    if not path.points:
        return no_way(candidate.label, path.reason)
    view = candidate.view
    return Way(
        candidate.label,
        candidate.pieces[0].start,
        candidate.pieces[-1].end,
        path.points,
        flight_ms(path.length_m, site.flyer.speed_m_s),
        _share(site, view, path.points),
        "",
        elevation_rad(site.camera, view),
        view.azimuth_rad if view is not None else 0.0,
    )


def _broken_lane(candidate: Candidate, zones: Sequence[Zone]) -> str:
    for number, piece in enumerate(candidate.pieces, 1):
        bad = first_bad_leg(piece.points, zones)
        if bad is not None:
            return f"lane {number} breaks {name_of(bad[1])}"
    return ""


def _share(
    site: Site,
    view: View | None,
    points: tuple[Position, ...],
    most: int | None = MEASURED_MOST,
) -> float | None:
    """The fraction of the area covered by a flight along the points, with a margin for tracking errors.

    None where the computation would take more than `most` footprints: lanes are built to cover, and the
    flight is checked.
    """
    import numpy as np

    places = sample_line(points, max(10.0, site.flyer.speed_m_s / 2))
    if most is not None and len(places) > most:
        return None
    looks = looks_over(places, view, site.height_m)
    centres = site.squares()
    seen = np.zeros(len(centres), np.bool_)
    quads = footprints(looks, site.height_m, camera_with(site, view), (1 + MARGIN) / 2)
    for some in (quads[::FEWER], quads) if len(quads) > FEW else (quads,):
        # if some of them cover everything, so do all
        if not seen.all():
            look(centres, site.side_m, some, seen)
    return share_covered(int((~seen).sum()), site.side_m, area_m2(site.vertices))


def _along_lanes(site: Site, lead_m: float) -> list[Candidate]:
    """Lanes, each with the view that needs the shortest way."""
    found, seen = [], swaths_aside(site)
    for heading in _headings(site):
        view = best_view(
            site.task,
            site.camera,
            site.height_m,
            heading,
            functools.partial(seen, heading),
            lane_lengths(site, heading, lead_m),
        )
        swath_of = swaths_of(site, view)
        if lane_width_m(swath_of, heading) > 0:
            found += _lanes_along(site, heading, swath_of, lead_m, view)
    return [_from_start(site, one) for one in found]


def _candidates(site: Site, lead_m: float, view: View | None) -> list[Candidate] | str:
    """The candidates without turns, or why there are none."""
    swath_of = swaths_of(site, view)
    width = math.inf
    for degrees in range(0, 360, HEADING_STEP_DEG // 2):
        seen = swath_of(math.radians(degrees))
        if seen is None or seen.width_m <= 0:
            return (
                f"its camera's footprint from {site.height_m:g} m above the ground leaves no lane "
                f"that covers squares of {site.side_m:.0f} m"
            )
        width = min(width, seen.width_m)
    ways: dict[Pattern | None, Callable[[Site, SwathOf, float, float], list[Candidate]]] = {
        None: _lanes,
        Pattern.SWEEP: _lanes,
        Pattern.SQUARE: _Figure("square", square_spiral, 90),
        Pattern.SECTOR: _Figure("sectors", sector, 60),
        Pattern.SPIRAL: _spiral,
    }
    made = ways[site.task.pattern](site, swath_of, width, lead_m)
    if not made:
        return f"more than {LANES_MOST} lanes of {width:.0f} m would be needed"
    return [_from_start(site, candidate._replace(view=view)) for candidate in made]


def _from_start(site: Site, candidate: Candidate) -> Candidate:
    """The candidate preceded by the required start point of the search, if the task has one."""
    point, first = site.task.start_point, candidate.pieces[0].start
    if point is None:
        return candidate
    bearing = math.atan2(first.east_m - point.east_m, first.north_m - point.north_m)
    at = Pose(point.north_m, point.east_m, site.flyer.alt_m, bearing)
    piece = Piece(at, at, (Position(*at[:3]),))
    return candidate_of(site, candidate.label, (piece, *candidate.pieces), candidate.view)


def _over(
    site: Site, parts: Sequence[Strip], heading: float, swath_of: SwathOf, lead_m: float
) -> Iterator[tuple[str, list[Piece]]]:
    """Lanes over strips, starting from either side."""
    for from_right in (False, True):
        side = "right" if from_right else "left"
        label = f"lanes along {round(math.degrees(heading)) % 360} deg from the {side}"
        yield (
            label,
            sweep(
                parts,
                heading,
                swath_of,
                site.flyer.radius_m,
                site.flyer.alt_m,
                lead_m,
                from_right,
            ),
        )


def _headings(site: Site) -> list[float]:
    """Directions of the lanes, each with its reverse."""
    swept, step = site.task.sweep_rad, math.radians(HEADING_STEP_DEG)
    ones = edge_headings(site.vertices, step) if swept is None else [swept]
    return [heading for one in ones for heading in (one, one + math.pi)]


def _lanes(site: Site, swath_of: SwathOf, width: float, lead_m: float) -> list[Candidate]:
    found = []
    for heading in _headings(site):
        found += _lanes_along(site, heading, swath_of, lead_m, None)
    return found


def _lanes_along(
    site: Site, heading: float, swath_of: SwathOf, lead_m: float, view: View | None
) -> list[Candidate]:
    parts = strips(site.vertices, heading, lane_width_m(swath_of, heading))
    tilt = tilt_label(site, view)
    return [
        candidate_of(site, label + tilt, pieces, view)
        for label, pieces in (_over(site, parts, heading, swath_of, lead_m) if parts else ())
    ]


@dataclass(frozen=True)
class _Figure:
    """A pattern flown from several headings: its name, its legs, and the heading step [deg]."""

    name: str
    legs: Callable[..., list[Any]]
    apart_deg: int

    def __call__(
        self, site: Site, swath_of: SwathOf, width: float, lead_m: float
    ) -> list[Candidate]:
        centre, found = site.task.points[0][:2], []
        for degrees in range(0, 360, self.apart_deg):
            parts = self.legs(centre, site.task.extent_m, width, math.radians(degrees))
            if parts:
                pieces = along(parts, swath_of, site.flyer.alt_m, lead_m)
                found.append(candidate_of(site, f"{self.name} from heading {degrees} deg", pieces))
        return found


def _spiral(site: Site, swath_of: SwathOf, width: float, lead_m: float) -> list[Candidate]:
    """Lanes over the centre, where circles would be too tight, then laps outwards."""
    centre, alt_m = site.task.points[0][:2], site.flyer.alt_m
    sides = [swath_of(math.radians(degrees)) for degrees in range(0, 360, 90)]
    half = min(min(-s.left_m, s.right_m) for s in sides if s is not None)
    first = TURN_RESERVE * site.flyer.radius_m
    reach = max(math.dist(centre, corner) for corner in site.vertices)
    last = max(first, reach - half)
    laps = math.ceil((last - first) / (2 * half)) if half > 0 else LANES_MOST + 1
    if laps > LANES_MOST:
        return []
    hole, found = first - half, []
    for degrees in range(0, 360, 90):
        heading = math.radians(degrees)
        inner: list[Piece] = []
        if hole > 0:
            parts = strips(disc(centre, hole), heading, width)
            _, inner = next(_over(site, parts, heading, swath_of, lead_m))
        for clockwise in (True, False):
            turn = "right" if clockwise else "left"
            out = spiral(centre, first, last, 1.9 * half, heading, clockwise, alt_m)
            label = f"spiral to the {turn} from {degrees} deg"
            found.append(candidate_of(site, label, (*inner, out)))
    return found
