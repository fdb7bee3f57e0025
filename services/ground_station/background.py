"""Background of the map: shapes of user files and tiles of a tile server, requested by pages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any
from urllib.parse import parse_qs

from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.ground_station.overlays import Shape, in_frame
from cratous.services.ground_station.tiles import Tiles, View, seen
from cratous.spec.mission import Frame

ORIGIN = ("latitude", "longitude")
VIEW = ("north", "east", "height", "width", "pixels_per_m")
LARGEST = 1e12
"""Well beyond the centre of any view a page shows (1e9 m), as tiles at its edge are requested too."""


class Beneath:
    """images: origin from which the page may load images, besides its own server."""

    def __init__(self, shapes: Sequence[Shape] = (), tiles: Tiles | None = None) -> None:
        self._shapes, self._tiles = shapes, tiles
        self.images = "" if tiles is None else tiles.origin

    def answer(self, path: str, query: str) -> dict[str, Any] | None:
        """The answer as JSON data; None for an unknown path. Raises NotObeyed and BadInput."""
        if path == "/overlays.json":
            attribution = None if self._tiles is None else self._tiles.attribution
            return {"shapes": in_frame(self._shapes, _origin(query)), "tiles": attribution}
        if path == "/tiles.json" and self._tiles is not None:
            frame, numbers = _origin(query), _numbers(query, VIEW)
            if numbers is None or min(numbers[2:]) <= 0:
                raise NotObeyed(400, "expected north, east, height, width [m] and pixels_per_m")
            return {"tiles": seen(self._tiles, frame, View(*numbers))}
        return None


def _origin(query: str) -> Frame:
    found = _numbers(query, ORIGIN)
    if found is None or not (abs(found[0]) <= 90 and abs(found[1]) <= 180):
        raise NotObeyed(400, "expected latitude=DEG&longitude=DEG, the origin of a frame")
    return Frame(*found)


def _numbers(query: str, names: Sequence[str]) -> list[float] | None:
    given = parse_qs(query)
    try:
        found = [float(given[name][0]) for name in names]
    except (LookupError, ValueError):
        return None
    return found if all(math.isfinite(one) and abs(one) <= LARGEST for one in found) else None
