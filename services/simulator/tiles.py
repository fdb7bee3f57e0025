"""Terrain tiles: DTED (.dt0, .dt1, .dt2; MIL-PRF-89020B) and SRTM (.hgt), one degree by one degree each.

Both are grids of posts with integer heights in metres, including the edges of the degree. A file is checked
as it is read: name or header, size, and for DTED the sentinel, position and checksum of each record.
"""

from __future__ import annotations

import re
from pathlib import Path
from stat import S_ISREG
from typing import Any, NamedTuple

import numpy as np

from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import bytes_of

SUFFIXES = (".dt0", ".dt1", ".dt2", ".hgt")
VOID = -32768
"""A post without a height."""
LOWEST_M, HIGHEST_M = -12_000, 9_000
"""Heights permitted in DTED [m]."""
MOST_POSTS = 3601
HEADERS_BYTES = 80 + 648 + 2700
LARGEST = HEADERS_BYTES + MOST_POSTS * (12 + 2 * MOST_POSTS)
"""Size limit of a tile [bytes]."""
SENTINEL = 0xAA


class TileFile(NamedTuple):
    """A tile: file, south-west corner [deg], and number of posts to the north and to the east."""

    path: Path
    south: int
    west: int
    rows: int
    columns: int


def tile_file(path: Path) -> TileFile:
    """A tile, from its name or header and its size; BadInput for an invalid file."""
    try:
        found = path.stat()
        if not S_ISREG(found.st_mode):  # reading a pipe might block forever
            raise BadInput("not a file", where=str(path), expected="a tile of terrain")
        with path.open("rb") as file:
            head = file.read(80)
    except OSError as error:
        raise BadInput("cannot read", where=str(path), got=error.strerror or str(error)) from error
    return (_srtm if path.suffix.lower() == ".hgt" else _dted)(path, head, found.st_size)


def _srtm(path: Path, _head: bytes, size: int) -> TileFile:
    name = re.fullmatch(r"([NS])(\d\d)([EW])(\d\d\d)\.hgt", path.name, re.IGNORECASE | re.ASCII)
    if name is None:
        raise BadInput("not the name of an SRTM tile", where=str(path), expected="as N45W121.hgt")
    posts = {2 * n * n: n for n in (1201, 3601)}.get(size)
    if posts is None:
        raise BadInput(
            "an SRTM tile of a wrong size, or cut", where=str(path),
            expected=f"{2 * 1201**2} or {2 * 3601**2} bytes", got=str(size),
        )  # fmt: skip
    south = int(name[2]) * (-1 if name[1] in "Ss" else 1)
    west = int(name[4]) * (-1 if name[3] in "Ww" else 1)
    return _in_bounds(TileFile(path, south, west, posts, posts))


def _dted(path: Path, head: bytes, size: int) -> TileFile:
    where = str(path)
    # degrees, minutes, seconds and hemisphere of the corner; spacing [0.1 arc s]; lines of longitude, posts in one
    found = re.match(
        rb"UHL1(\d{3})0000([EW])(\d{3})0000([NS])(\d{4})(\d{4}).{19}(\d{4})(\d{4})", head, re.DOTALL
    )
    if found is None:
        raise BadInput("not a DTED tile: no such header", where=where,
                       expected="UHL1 with a corner at whole degrees")  # fmt: skip
    west, south, east_by, north_by, columns, rows = (int(found[k]) for k in (1, 3, 5, 6, 7, 8))
    for posts, spacing, what in ((rows, north_by, "latitude"), (columns, east_by, "longitude")):
        if not 2 <= posts <= MOST_POSTS or (posts - 1) * spacing != 36_000:
            raise BadInput(
                f"a DTED tile with wrong posts of {what}", where=where,
                expected=f"at most {MOST_POSTS}, with their spacing one degree in all",
                got=f"{posts}, spacing {spacing / 10} arc s",
            )  # fmt: skip
    whole = HEADERS_BYTES + columns * (12 + 2 * rows)
    if size != whole:
        raise BadInput("a DTED tile of a wrong size, or cut", where=where,
                       expected=f"{whole} bytes", got=str(size))  # fmt: skip
    west, south = west * (-1 if found[2] == b"W" else 1), south * (-1 if found[4] == b"S" else 1)
    return _in_bounds(TileFile(path, south, west, rows, columns))


def _in_bounds(tile: TileFile) -> TileFile:
    if not (-90 <= tile.south < 90 and -180 <= tile.west < 180):
        raise BadInput("a tile that is not on the earth", where=str(tile.path),
                       got=f"corner {tile.south}, {tile.west} deg")  # fmt: skip
    return tile


def heights_of(tile: TileFile) -> np.ndarray[Any, np.dtype[np.int16]]:
    """Heights of the posts [m MSL], VOID where missing: rows from the south, columns from the west.

    BadInput with the place for a file that has changed since, or is corrupt.
    """
    data = bytes_of(tile.path, LARGEST, "a tile of terrain")
    again = tile_file(tile.path)
    if again != tile or len(data) != tile.path.stat().st_size:
        raise BadInput("a tile that has changed since the start", where=str(tile.path))
    if tile.path.suffix.lower() == ".hgt":
        grid = np.frombuffer(data, ">i2").reshape(tile.rows, tile.columns)[::-1]
        return _heights(np.ascontiguousarray(grid, np.int16), tile)
    form = [("mark", "u1"), ("count", "u1", 3), ("line", ">u2"), ("row", ">u2"),
            ("posts", ">u2", tile.rows), ("sum", ">u4")]  # fmt: skip
    records = np.frombuffer(data, form, offset=HEADERS_BYTES)
    plain = np.frombuffer(data, np.uint8, offset=HEADERS_BYTES).reshape(tile.columns, -1)
    sums = plain[:, :-4].sum(axis=1, dtype=np.uint64)
    wrong = (
        (records["mark"] != SENTINEL)
        | (records["line"] != np.arange(tile.columns))
        | (records["row"] != 0)
        | (records["sum"] != sums)
    )
    if wrong.any():
        raise BadInput(
            "a corrupt DTED tile: sentinel, place or checksum of a record is wrong",
            where=str(tile.path), item=f"record {int(wrong.argmax())} of {tile.columns}",
        )  # fmt: skip
    posts = records["posts"].astype(np.int32)
    # sign and magnitude; all bits set is void
    signed = np.where(posts & 0x8000, -(posts & 0x7FFF), posts)
    signed[posts == 0xFFFF] = VOID
    return _heights(np.ascontiguousarray(signed.T, np.int16), tile)


def _heights(
    heights: np.ndarray[Any, np.dtype[np.int16]], tile: TileFile
) -> np.ndarray[Any, np.dtype[np.int16]]:
    wrong = ((heights < LOWEST_M) | (heights > HIGHEST_M)) & (heights != VOID)
    if wrong.any():
        row, column = (int(k) for k in np.unravel_index(wrong.argmax(), wrong.shape))
        raise BadInput(
            "a corrupt tile: a height that no place has", where=str(tile.path),
            item=f"post {row} from the south, {column} from the west",
            expected=f"from {LOWEST_M} to {HIGHEST_M} m", got=str(int(heights[row, column])),
        )  # fmt: skip
    return heights
