"""Tiles of a tile server (web mercator) as background of the map, in the frame of the displayed
data.

The browser requests them from the tile server, for the visible part of the world. They are
displayed only: nothing is planned, flown or judged by them.
"""

from __future__ import annotations

import math
import re
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from cratous.core.kernel import Vec2
from cratous.services.ground_station.near_origin import is_near
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

ITEM = "--tiles"
EXPECTED = "https://HOST/PATH with {z}, {x} and {y} in its path or query, each once"
WRITTEN = re.compile(r"[A-Za-z0-9._~:/?\[\]@!$&()*+=%{}-]+")
"""Characters permitted in a URL: none that ends a source in a content security policy."""
HOST = re.compile(r"[A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\]")
NAMES = ("{z}", "{x}", "{y}")
MOST_ATTRIBUTION = 200
TILE_PX = 256
CLOSEST, FARTHEST = 19, 4
"""Maximum and minimum zoom; at smaller ones a tile is not nearly flat."""
MOST = 120
"""Maximum number of tiles of one view."""
MERCATOR_DEG = 85.0511
"""Maximum latitude of web mercator [deg]."""
EQUATOR_M = 2 * math.pi * 6_378_137.0


class Tiles(NamedTuple):
    """url: of a tile, with {z}, {x} and {y}; origin: of all tiles; attribution: shown on the map."""

    url: str
    origin: str
    attribution: str


class View(NamedTuple):
    """The visible area: centre and size [m] in the mission frame, and screen pixels per metre."""

    north_m: float
    east_m: float
    height_m: float
    width_m: float
    pixels_per_m: float


def tiles_of(url: str, attribution: str = "") -> Tiles:
    """The tiles given by `--tiles` and `--tiles-attribution`. Raises BadInput."""

    def refused(what: str) -> BadInput:
        return BadInput(what, item=ITEM, expected=EXPECTED, got=url[:100])

    if not WRITTEN.fullmatch(url):
        raise refused("not an address of tiles")
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError:
        raise refused("not an address of tiles") from None
    host = parts.netloc.removesuffix(f":{port}") if port is not None else parts.netloc
    if parts.scheme not in ("http", "https") or not HOST.fullmatch(host) or parts.fragment:
        raise refused("not an address of tiles")
    rest = f"{parts.path}?{parts.query}"
    if any(rest.count(name) != 1 for name in NAMES) or re.search(r"[{}]", _without(rest)):
        raise refused("it does not say which tile")
    if len(attribution) > MOST_ATTRIBUTION or not attribution.isprintable():
        raise BadInput(
            "not an attribution", item=f"{ITEM}-attribution",
            expected=f"a line of at most {MOST_ATTRIBUTION} characters", got=attribution[:40],
        )  # fmt: skip
    return Tiles(url, f"{parts.scheme}://{parts.netloc}", attribution)


def _without(text: str) -> str:
    for name in NAMES:
        text = text.replace(name, "")
    return text


def seen(tiles: Tiles, frame: Frame, view: View) -> list[dict[str, Any]]:
    """The tiles of a view: the URL of each, and its corners in the frame, [north, east] [m].

    corners: north-west, north-east, south-west. Raises BadInput for an origin outside web mercator.
    """
    if abs(frame.latitude_deg) > MERCATOR_DEG:
        raise BadInput(
            "there are no tiles there", item=ITEM,
            expected=f"an origin up to {MERCATOR_DEG} degrees of latitude",
            got=f"{frame.latitude_deg:g}",
        )  # fmt: skip
    plane = Projection(frame)
    wide = EQUATOR_M * math.cos(math.radians(frame.latitude_deg)) / TILE_PX
    zoom = min(round(math.log2(max(wide * view.pixels_per_m, 1.0))), CLOSEST)
    box = _degrees(plane, frame, view)
    if box is None:
        return []
    while zoom >= FARTHEST:
        found = _between(box, zoom)
        if len(found) <= MOST:
            return [_placed(tiles, plane, one, zoom) for one in found]
        zoom -= 1
    return []


def _degrees(plane: Projection, frame: Frame, view: View) -> tuple[float, ...] | None:
    """South, north, west, east [deg] of a view, west and east about the origin; None if too far for the plane."""
    reach_m = math.hypot(view.height_m, view.width_m) / 2
    if not is_near(Vec2(view.north_m, view.east_m), reach_m):
        return None
    steps = [
        plane.to_geodetic(view.north_m + n * view.height_m / 4, view.east_m + e * view.width_m / 4)
        for n in range(-2, 3)
        for e in range(-2, 3)
    ]
    south, north = min(one[0] for one in steps), max(one[0] for one in steps)
    turns = [(one[1] - frame.longitude_deg + 540) % 360 - 180 for one in steps]
    return south, north, frame.longitude_deg + min(turns), frame.longitude_deg + max(turns)


def _between(box: tuple[float, ...], zoom: int) -> list[tuple[int, int]]:
    """Columns and rows of the tiles; columns wrap around at the last one."""
    south, north, west, east = box
    count = 1 << zoom
    columns = range(
        math.floor((west + 180) / 360 * count), math.floor((east + 180) / 360 * count) + 1
    )
    first, last = (min(max(math.floor(_down(deg) * count), 0), count - 1) for deg in (north, south))
    if len(columns) * (last - first + 1) > MOST:
        return [(0, 0)] * (MOST + 1)
    return [(column, row) for row in range(first, last + 1) for column in columns]


def _down(latitude_deg: float) -> float:
    """Vertical position of a latitude in the world map, from 0 (top) to 1."""
    kept = math.radians(max(-MERCATOR_DEG, min(MERCATOR_DEG, latitude_deg)))
    return (1 - math.asinh(math.tan(kept)) / math.pi) / 2


def _placed(tiles: Tiles, plane: Projection, at: tuple[int, int], zoom: int) -> dict[str, Any]:
    (column, row), count = at, 1 << zoom
    corners = []
    for down, right in ((0, 0), (0, 1), (1, 0)):
        latitude = math.degrees(math.atan(math.sinh(math.pi * (1 - 2 * (row + down) / count))))
        corners.append(plane.to_local(latitude, (column + right) / count * 360 - 180))
    url = tiles.url
    for name, number in zip(NAMES, (zoom, column % count, row), strict=True):
        url = url.replace(name, str(number))
    return {"url": url, "corners": [[round(n, 2), round(e, 2)] for n, e in corners]}
