"""Ground height from one-degree tiles: bilinear between the four surrounding posts.

Header and size of files are checked at construction; data are read on first use, and a few tiles are kept.
Outside all tiles the ground is at mean sea level.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from math import degrees, floor, radians
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from cratous.services.simulator.earth import EQUATOR_M
from cratous.services.simulator.tiles import SUFFIXES, VOID, TileFile, heights_of, tile_file
from cratous.spec.errors import BadInput

KEPT = 16
"""Most tiles in memory: 26 MB each for the finest."""
MOST_FILES = 100_000
EDGE_DEG = 1e-9
"""Within this distance of an edge, a place is in the tiles on both sides [deg]."""
Cell = tuple[int, int]
Heights = np.ndarray[Any, np.dtype[np.int16]]
Numbers = np.ndarray[Any, np.dtype[np.float64]]


class Terrain:
    """See the module. said: warnings, each once; step_m: half of the finest post spacing [m]."""

    def __init__(self, paths: Iterable[Path]) -> None:
        self.said: list[str] = []
        self._files: dict[Cell, TileFile] = {}
        self._kept: dict[Cell, Heights] = {}
        self._last: tuple[Cell, Heights] | None = None
        self._told: set[Cell] = set()
        self._outside = self._empty = False
        for path in paths:
            for file in _files(path):
                tile = tile_file(file)
                known = self._files.setdefault((tile.south, tile.west), tile)
                # of two tiles for the same degree the finer one counts
                if tile.rows * tile.columns > known.rows * known.columns:
                    self._files[tile.south, tile.west] = tile
        finest = max((t.rows for t in self._files.values()), default=2)
        self.step_m = radians(1) * EQUATOR_M / (finest - 1) / 2

    def __len__(self) -> int:
        return len(self._files)

    def elevation(self, lat_rad: float, lon_rad: float) -> float:
        """Ground height at a place [m MSL]; BadInput if its tile turns out to be corrupt."""
        lat, lon = degrees(lat_rad), (degrees(lon_rad) + 180) % 360 - 180
        south, west = floor(lat), floor(lon)
        found = self._last
        if found is None or found[0] != (south, west):
            found = self._at(lat, lon, south, west)
        if found is None:
            return 0.0
        self._last = cell, heights = found
        rows, columns = heights.shape
        y = min(1.0, max(0.0, lat - cell[0])) * (rows - 1)
        x = min(1.0, max(0.0, (lon - cell[1]) % 360)) * (columns - 1)
        row, column = min(int(y), rows - 2), min(int(x), columns - 2)
        y, x = y - row, x - column
        corners = (
            (heights.item(row, column), (1 - y) * (1 - x)),
            (heights.item(row, column + 1), (1 - y) * x),
            (heights.item(row + 1, column), y * (1 - x)),
            (heights.item(row + 1, column + 1), y * x),
        )
        (a, p), (b, q), (c, r), (d, s) = corners
        if VOID not in (a, b, c, d):
            return float(a * p + b * q + c * r + d * s)
        there = [(height, weight) for height, weight in corners if height != VOID]
        share = sum(weight for _, weight in there)
        if share > 0:
            return float(sum(height * weight for height, weight in there) / share)
        self._say_empty(lat, lon)
        return 0.0

    def elevations(self, lat_rad: Numbers, lon_rad: Numbers) -> Numbers:
        """Ground heights at places [m MSL], like `elevation` for each except on an outer edge of all tiles."""
        lats, lons = np.degrees(lat_rad), (np.degrees(lon_rad) + 180) % 360 - 180
        souths, wests = np.floor(lats), np.floor(lons)
        found = np.zeros(len(lats))
        todo = np.ones(len(lats), bool)
        while todo.any():
            first = int(todo.argmax())
            south, west = int(souths[first]), int(wests[first])
            mine = (souths == south) & (wests == west)
            todo &= ~mine
            heights = self._tile((south, west))
            if heights is None:
                self._say_outside(float(lats[first]), float(lons[first]))
                continue
            found[mine] = self._between(heights, lats[mine], lons[mine], south, west)
        return found

    def _between(
        self, heights: Heights, lats: Numbers, lons: Numbers, south: int, west: int
    ) -> Numbers:
        rows, columns = heights.shape
        y, x = (lats - south) * (rows - 1), (lons - west) * (columns - 1)
        row = np.minimum(y.astype(int), rows - 2)
        column = np.minimum(x.astype(int), columns - 2)
        y, x = y - row, x - column
        corners = (
            (heights[row, column], (1 - y) * (1 - x)),
            (heights[row, column + 1], (1 - y) * x),
            (heights[row + 1, column], y * (1 - x)),
            (heights[row + 1, column + 1], y * x),
        )
        total, share = np.zeros(len(lats)), np.zeros(len(lats))
        for height, weight in corners:
            weight = weight * (height != VOID)
            total += height * weight
            share += weight
        empty = share <= 0
        if empty.any():
            first = int(empty.argmax())
            self._say_empty(float(lats[first]), float(lons[first]))
        # without voids the weights sum to 1 up to rounding
        parts = np.where(np.abs(share - 1) < 1e-12, 1.0, share)
        return np.asarray(np.divide(total, parts, out=np.zeros(len(lats)), where=~empty))

    def _at(self, lat: float, lon: float, south: int, west: int) -> tuple[Cell, Heights] | None:
        """The tile of a place, or one with the place on its edge."""
        souths = (south, south - 1) if lat - south < EDGE_DEG else (south,)
        wests = (west, (west + 179) % 360 - 180) if lon - west < EDGE_DEG else (west,)
        if south + 1 - lat < EDGE_DEG:
            souths = (*souths, south + 1)
        if west + 1 - lon < EDGE_DEG:
            wests = (*wests, (west + 181) % 360 - 180)
        for cell in ((one, two) for one in souths for two in wests):
            heights = self._tile(cell)
            if heights is not None:
                return cell, heights
        self._say_outside(lat, lon)
        return None

    def _tile(self, cell: Cell) -> Heights | None:
        """The heights of a tile, read if necessary; the least recently used tile is dropped."""
        heights = self._kept.pop(cell, None)
        if heights is None:
            file = self._files.get(cell)
            if file is None:
                return None
            heights = heights_of(file)
            voids = int(np.count_nonzero(heights == VOID))
            if voids and cell not in self._told:
                self._told.add(cell)
                of = f"{voids} of {heights.size} posts are void, and are left out"
                self.said.append(f"{file.path}: {of}")
            while len(self._kept) >= KEPT:
                del self._kept[next(iter(self._kept))]
        self._kept[cell] = heights
        return heights

    def _say_outside(self, lat: float, lon: float) -> None:
        if not self._outside:
            self._outside = True
            self.said.append(
                f"the terrain has no tile for {lat:.5f}, {lon:.5f}: there, and where else it has none, "
                "the ground is at mean sea level"
            )

    def _say_empty(self, lat: float, lon: float) -> None:
        if not self._empty:
            self._empty = True
            self.said.append(
                f"all posts about {lat:.5f}, {lon:.5f} are void: there, and where else it is so, "
                "the ground is at mean sea level"
            )


def _files(path: Path) -> Iterator[Path]:
    """A file, or the tiles in a folder and its subfolders, by name; BadInput if there are none."""
    if not path.is_dir():
        if path.suffix.lower() not in SUFFIXES:
            expected = f"one of {', '.join(SUFFIXES)}, or a folder of them"
            raise BadInput("not a tile of terrain", where=str(path), expected=expected)
        yield path
        return
    count = 0
    for folder, folders, names in os.walk(path, onerror=_cannot_list):
        folders.sort()
        for name in sorted(names):
            if Path(name).suffix.lower() in SUFFIXES:
                count += 1
                if count > MOST_FILES:
                    raise BadInput(
                        "too many tiles of terrain", where=str(path), expected=f"{MOST_FILES}"
                    )
                yield Path(folder, name)
    if not count:
        raise BadInput("a folder without tiles of terrain", where=str(path),
                       expected=f"files with {', '.join(SUFFIXES)}")  # fmt: skip


def _cannot_list(error: OSError) -> NoReturn:
    raise BadInput("cannot read", where=str(error.filename), got=str(error.strerror)) from error
