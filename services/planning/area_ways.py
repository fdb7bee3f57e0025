"""Ways over an area: lanes as wide as the footprint, spirals, squares and sectors.

Candidates are compared by their length without zones; those that cost much more than the shortest,
and all beyond a small number, are dropped with that reason. The rest get turns around the zones.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.visibility import Roadmap, name_of
from cratous.core.tasks.coverage import (
    area_m2,
    disc,
    look,
    outline,
    share_covered,
    square_array,
    square_side_m,
)
from cratous.core.tasks.sweep import (
    LANES_MOST,
    Piece,
    Strip,
    Swath,
    SwathOf,
    along,
    edge_headings,
    joined,
    sector,
    spiral,
    square_spiral,
    strips,
    swath,
    sweep,
    unjoined_m,
)
from cratous.services.mission.sensor import elevation_rad, footprints, looks_over, sample_line
from cratous.services.planning.cut_ways import cut
from cratous.services.planning.flyers import HEADING_STEP_DEG, Flyer, Way, flight_ms, no_way
from cratous.services.planning.smoothing import MARGIN
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Camera, Pattern, Position, Task, View, Zone
from cratous.spec.mission.plan import Pose

OPTIONS_MOST = 4
"""How many ways over an area are offered."""
DEARER = 1.5
"""A way that is longer than the shortest by more than this factor is not offered."""
LEADS = (0.8, 0.0)
"""Room to settle before a lane, in turn radii; less where the zones leave no more."""
GLANCE_S = 2.0
"""Each part of a swath stays in view for so long, so that nothing is missed between frames."""
VIEWS_MOST = 4
MEASURED_MOST = 8_000
"""Coverage is measured in planning for ways with no more footprints than this."""
TURN_RESERVE = 1.15
"""The innermost turn of a spiral, in turn radii."""


class Candidate(NamedTuple):
    """A way over an area without its turns, and how long it is."""

    label: str
    pieces: tuple[Piece, ...]
    length_m: float


class _Site(NamedTuple):
    """What is the same for all ways of one class of vehicles over one area."""

    task: Task
    flyer: Flyer
    camera: Camera
    height_m: float
    vertices: tuple[tuple[float, float], ...]
    side_m: float
    squares: Callable[[], Any]


def area_ways(
    task: Task, flyer: Flyer, camera: Camera, zones: Sequence[Zone], terrain_m: float
) -> Iterator[Way]:
    """A few ways over the area for each wanted view, shortest first, and those not offered."""
    site = _site(task, flyer, camera, terrain_m)
    maps = roadmaps(zones, flyer.radius_m)
    views = (task.view, *task.views)
    for view in views[:VIEWS_MOST]:
        made = _candidates(site, view, LEADS[0] * flyer.radius_m)
        if isinstance(made, str):
            yield no_way("", made)
            continue
        found = sorted(made, key=lambda c: c.length_m)
        best_m = found[0].length_m
        for rank, candidate in enumerate(found):
            if candidate.length_m > DEARER * best_m:
                times = candidate.length_m / best_m
                yield no_way(candidate.label, f"it is {times:.2f} times as long as the shortest")
            elif rank >= OPTIONS_MOST:
                yield no_way(candidate.label, f"{OPTIONS_MOST} that are no longer are offered")
            else:
                way = _way(site, view, candidate, zones, maps)
                if way.reason:
                    # less room before the lanes may do where the zones are near
                    way = _tighter(site, view, way, zones, maps)
                yield way
    if len(views) > VIEWS_MOST:
        yield no_way("", f"only the first {VIEWS_MOST} directions of view are offered")


def area_parts(
    task: Task, flyer: Flyer, camera: Camera, maps: Sequence[Roadmap], terrain_m: float
) -> Iterator[Way]:
    """For each wanted view the shortest ways over an area, without what the zones forbid of them."""
    site = _site(task, flyer, camera, terrain_m)
    for view in (task.view, *task.views)[:VIEWS_MOST]:
        made = _candidates(site, view, LEADS[1] * flyer.radius_m)
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


def _site(task: Task, flyer: Flyer, camera: Camera, terrain_m: float) -> _Site:
    vertices = outline(task)
    side_m = square_side_m(vertices)
    squares = functools.cache(functools.partial(square_array, vertices, side_m))
    return _Site(task, flyer, camera, flyer.alt_m - terrain_m, vertices, side_m, squares)


def _tighter(
    site: _Site, view: View | None, way: Way, zones: Sequence[Zone], maps: Sequence[Roadmap]
) -> Way:
    """The way of the same name with less room to settle, if that helps; else what was refused."""
    made = _candidates(site, view, LEADS[1] * site.flyer.radius_m)
    same = [c for c in made if isinstance(c, Candidate) and c.label == way.label]
    tight = _way(site, view, same[0], zones, maps) if same else way
    return way if tight.reason else tight


def _way(
    site: _Site,
    view: View | None,
    candidate: Candidate,
    zones: Sequence[Zone],
    maps: Sequence[Roadmap],
) -> Way:
    """A candidate with its turns and its coverage, or the reason why the zones forbid it."""
    bad = _broken_lane(candidate, zones)
    if bad:
        return no_way(candidate.label, bad)
    path = joined(candidate.pieces, site.flyer.radius_m, maps)
    if not path.points:
        return no_way(candidate.label, path.reason)
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
    site: _Site,
    view: View | None,
    points: tuple[Position, ...],
    most: int | None = MEASURED_MOST,
) -> float | None:
    """The share of the area that a flight along the points sees, with a margin for its wobble.

    None where measuring it would take more than so many footprints: the lanes are made to cover, the
    flight is measured.
    """
    import numpy as np

    places = sample_line(points, max(10.0, site.flyer.speed_m_s / 2))
    if most is not None and len(places) > most:
        return None
    looks = looks_over(places, view, site.height_m)
    centres = site.squares()
    seen = np.zeros(len(centres), np.bool_)
    quads = footprints(looks, site.height_m, site.camera, (1 + MARGIN) / 2)
    look(centres, site.side_m, quads, seen)
    return share_covered(int((~seen).sum()), site.side_m, area_m2(site.vertices))


def _corners(array: Any) -> list[tuple[float, float]]:
    return [(float(north), float(east)) for north, east in array]


def _swaths(site: _Site, view: View | None) -> SwathOf:
    """The swath by heading, narrowed by a square on each side so that seams are seen whole."""
    import numpy as np

    known: dict[float, Swath | None] = {}

    def of(heading_rad: float) -> Swath | None:
        if heading_rad not in known:
            step = np.array([[math.cos(heading_rad), math.sin(heading_rad)]])
            looks = looks_over(np.vstack([0 * step, step]), view, site.height_m)
            corners = footprints(looks, site.height_m, site.camera, MARGIN)[0]
            known[heading_rad] = None
            if not np.isnan(corners[0, 0]):
                least = GLANCE_S * site.flyer.speed_m_s + site.side_m
                found = swath(_corners(corners), heading_rad, least)
                if found is not None:
                    half = site.side_m / 2
                    known[heading_rad] = Swath(
                        found.left_m + half,
                        found.right_m - half,
                        found.near_m + site.side_m,
                        found.far_m - site.side_m,
                    )
        return known[heading_rad]

    return of


def _candidates(site: _Site, view: View | None, lead_m: float) -> list[Candidate] | str:
    """The ways without turns, or why there is none."""
    swath_of = _swaths(site, view)
    width = math.inf
    for degrees in range(0, 360, HEADING_STEP_DEG // 2):
        seen = swath_of(math.radians(degrees))
        if seen is None or seen.width_m <= 0:
            return (
                f"its camera's footprint from {site.height_m:g} m above the ground leaves no lane "
                f"that covers squares of {site.side_m:.0f} m"
            )
        width = min(width, seen.width_m)
    ways: dict[Pattern | None, Callable[[_Site, SwathOf, float, float], list[Candidate]]] = {
        None: _lanes,
        Pattern.SWEEP: _lanes,
        Pattern.SQUARE: _Figure("square", square_spiral, 90),
        Pattern.SECTOR: _Figure("sectors", sector, 60),
        Pattern.SPIRAL: _spiral,
    }
    made = ways[site.task.pattern](site, swath_of, width, lead_m)
    if not made:
        return f"more than {LANES_MOST} lanes of {width:.0f} m would be needed"
    return [_from_start(site, candidate) for candidate in made]


def _candidate(site: _Site, label: str, pieces: Sequence[Piece]) -> Candidate:
    return Candidate(label, tuple(pieces), unjoined_m(pieces, site.flyer.radius_m))


def _from_start(site: _Site, candidate: Candidate) -> Candidate:
    """The way with the point before it where the search has to begin, if the task names one."""
    point, first = site.task.start_point, candidate.pieces[0].start
    if point is None:
        return candidate
    bearing = math.atan2(first.east_m - point.east_m, first.north_m - point.north_m)
    at = Pose(point.north_m, point.east_m, site.flyer.alt_m, bearing)
    piece = Piece(at, at, (Position(*at[:3]),))
    return _candidate(site, candidate.label, (piece, *candidate.pieces))


def _over(
    site: _Site, parts: Sequence[Strip], heading: float, swath_of: SwathOf, lead_m: float
) -> Iterator[tuple[str, list[Piece]]]:
    """Lanes over strips from both sides."""
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


def _lanes(site: _Site, swath_of: SwathOf, width: float, lead_m: float) -> list[Candidate]:
    task = site.task
    headings = [task.sweep_rad] if task.sweep_rad is not None else []
    headings = headings or edge_headings(site.vertices, math.radians(HEADING_STEP_DEG))
    found = []
    for one in headings:
        for heading in (one, one + math.pi):
            seen = [swath_of(h) for h in (heading, heading + math.pi)]
            narrow = min(s.width_m for s in seen if s is not None)
            parts = strips(site.vertices, heading, narrow)
            if parts:
                ways = _over(site, parts, heading, swath_of, lead_m)
                found += [_candidate(site, *way) for way in ways]
    return found


@dataclass(frozen=True)
class _Figure:
    """A pattern that is flown from any of some headings: its name, its legs, and how far they are apart [deg]."""

    name: str
    legs: Callable[..., list[Any]]
    apart_deg: int

    def __call__(
        self, site: _Site, swath_of: SwathOf, width: float, lead_m: float
    ) -> list[Candidate]:
        centre, found = site.task.points[0][:2], []
        for degrees in range(0, 360, self.apart_deg):
            parts = self.legs(centre, site.task.extent_m, width, math.radians(degrees))
            if parts:
                pieces = along(parts, swath_of, site.flyer.alt_m, lead_m)
                found.append(_candidate(site, f"{self.name} from heading {degrees} deg", pieces))
        return found


def _spiral(site: _Site, swath_of: SwathOf, width: float, lead_m: float) -> list[Candidate]:
    """Lanes over the middle, which is too tight to circle, then rounds outwards."""
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
            found.append(_candidate(site, label, (*inner, out)))
    return found
