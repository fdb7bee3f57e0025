"""Tiles of terrain for tests: written by the formats' own descriptions, apart from the reader."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np

Ground = Callable[[float, float], int]
"""Height [m] by latitude and longitude [deg]; None-like -32767 for a void of DTED."""


def dted(folder: Path, south: int, west: int, ground: Ground, rows: int = 121) -> Path:
    """A DTED tile, of level 0 as a rule."""
    spacing = 36_000 // (rows - 1)
    corner = (
        f"{abs(west):03}0000{'W' if west < 0 else 'E'}"
        f"{abs(south):03}0000{'S' if south < 0 else 'N'}"
    )
    head = f"UHL1{corner}{spacing:04}{spacing:04}0020U  ".ljust(47) + f"{rows:04}{rows:04}0"
    data = bytearray(head.ljust(80).encode() + b" " * (648 + 2700))
    for column in range(rows):
        posts = (ground(south + k / (rows - 1), west + column / (rows - 1)) for k in range(rows))
        words = [-h | 0x8000 if h < 0 else h for h in posts]
        record = b"\xaa" + column.to_bytes(3, "big") + struct.pack(">HH", column, 0)
        record += struct.pack(f">{rows}H", *words)
        data += record + sum(record).to_bytes(4, "big")
    level = {121: 0, 1201: 1}[rows]
    path = folder / f"{'s' if south < 0 else 'n'}{abs(south):02}.dt{level}"
    path.write_bytes(data)
    return path


def srtm(folder: Path, name: str, heights: np.ndarray) -> Path:
    """An SRTM tile of 1201 posts, heights from the south."""
    path = folder / name
    path.write_bytes(heights[::-1].astype(">i2").tobytes())
    return path
