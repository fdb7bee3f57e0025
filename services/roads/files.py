"""The CSV files that an OsmPlannerService writes of its map and of each route.

Places in degrees, lengths in metres, times in seconds. Files are written atomically; beyond FILES_MOST routes
or ROWS_MOST rows nothing more is written.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import dist
from pathlib import Path
from typing import NamedTuple

from cratous.core.files.whole_file import write_atomically
from cratous.core.kernel import Vec2
from cratous.services.roads.network import Network, length_m

FILES_MOST, ROWS_MOST = 1_000, 10_000
LEGS = ("latitude_01", "longitude_01", "latitude_02", "longitude_02", "length_m")
METRICS = ("map_nodes", "map_legs", "map_time_s", "way_nodes", "way_length_m", "search_time_s")


class Names(NamedTuple):
    """File names, "" for none: all legs of the map; each route, numbered; a row of metrics per route."""

    edges: str = ""
    way: str = ""
    metrics: str = ""


class RoadFiles:
    """Writes the files into one folder."""

    def __init__(self, folder: Path, names: Names, map_s: float = 0.0) -> None:
        """map_s: time taken to read the map [s]."""
        self._folder, self._names, self._map_s = folder, names, map_s
        self._ways = 0
        self._rows: list[str] = []

    def map(self, roads: Network) -> None:
        """Write all legs of a map."""
        if self._names.edges:
            pairs = [(roads.nodes[a], roads.nodes[b]) for a, b in roads.legs]
            self._write(self._names.edges, LEGS, _legs(roads, pairs))

    def way(self, roads: Network, points: tuple[Vec2, ...], search_s: float) -> None:
        """Write a route, and the time taken to find it [s]."""
        if self._names.way and self._ways < FILES_MOST:
            self._ways += 1
            name = Path(self._names.way)
            numbered = f"{name.stem}_{self._ways:04d}{name.suffix}"
            self._write(numbered, LEGS, _legs(roads, pairwise(points)))
        if self._names.metrics and len(self._rows) < ROWS_MOST:
            parts = (
                f"{len(roads.nodes)},{len(roads.legs)},{self._map_s:.3f}",
                f"{len(points)},{length_m(points):.1f},{search_s:.6f}",
            )
            self._rows.append(",".join(parts))
            self._write(self._names.metrics, METRICS, self._rows)

    def _write(self, name: str, head: Sequence[str], rows: Iterable[str]) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        write_atomically(self._folder / name, "\n".join((",".join(head), *rows)) + "\n")


def _legs(roads: Network, pairs: Iterable[tuple[Vec2, Vec2]]) -> list[str]:
    rows = []
    for p, q in pairs:
        places = [f"{part:.7f}" for at in (p, q) for part in roads.projection.to_geodetic(*at)]
        rows.append(",".join((*places, f"{dist(p, q):.1f}")))
    return rows
