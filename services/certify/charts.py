"""Plots of a report over time, as shapes in drawing units: altitudes, and distances of pairs.

Everything comes from report.json, whose tracks have one row per second; nothing is decided here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import combinations
from math import ceil, floor, hypot
from typing import Any, NamedTuple

from cratous.services.certify.picture import nice_step

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 480.0, 176.0, 62.0, 12.0, 12.0, 26.0
TICK = 34.0
"""Maximum extent of a tick label to the right of its middle, at the font size of a narrow screen."""
FEW = 6
"""Number of pairs that are drawn, the closest ones; a table of all would hide them."""


class Near(NamedTuple):
    """Two aircraft: the closest horizontal approach, and their distance over time."""

    least_m: float
    one: int
    other: int
    time_ms: float
    above_m: float
    curve: list[tuple[float, float]]


def altitude_view(report: dict[str, Any]) -> dict[str, Any] | None:
    """Altitude of each mission vehicle over time [m above mean sea level]; None without tracks."""
    vehicles = report["mission"]["vehicles"]
    tracks = report["flight"]["tracks"]
    curves = [
        (k, vehicle, [(row[0], row[3]) for row in tracks[str(vehicle["id"])]])
        for k, vehicle in enumerate(vehicles)
        if tracks.get(str(vehicle["id"]))
    ]
    if not curves:
        return None
    levels = [level for _, _, curve in curves for _, level in curve]
    step = nice_step(max(max(levels) - min(levels), 40.0) / 3)
    # margin below and above, so that no line coincides with the frame
    low, high = (ceil(min(levels) / step) - 1) * step, (floor(max(levels) / step) + 1) * step
    xy = _scale(report, low, high)
    return {
        **_axes(report, low, high, step),
        "curves": [
            {
                "label": vehicle["label"],
                "color": k % 6,
                "points": _points(curve, xy),
                "low_m": round(min(level for _, level in curve), 1),
                "high_m": round(max(level for _, level in curve), 1),
            }
            for k, vehicle, curve in curves
        ],
    }


def separation_view(report: dict[str, Any]) -> dict[str, Any] | None:
    """Horizontal distances over time, closest pairs first; None without a pair.

    A pair is two mission vehicles, or one of them and a traffic aircraft.
    """
    pairs = sorted(_pairs(report))
    if not pairs:
        return None
    dthr_m = report["mission"]["daa"]["well_clear"]["dthr_m"]
    # small distances matter, so large ones are cut off
    top_m = max(1500.0, 6 * dthr_m, ceil(pairs[0].least_m / 500 + 1) * 500)
    step = nice_step(top_m / 3)
    top_m = ceil(top_m / step) * step
    xy = _scale(report, 0.0, top_m)
    return {
        **_axes(report, 0.0, top_m, step),
        "dthr_m": dthr_m,
        "dthr_y": xy(0.0, dthr_m)[1],
        "pairs": len(pairs),
        "curves": [
            {
                "pair": f"{near.one} and {near.other}",
                "color": k,
                "points": _points(((t, min(d, top_m)) for t, d in near.curve), xy),
                "least_m": round(near.least_m, 1),
                "time_ms": near.time_ms,
                "above_m": round(near.above_m, 1),
                "at": xy(near.time_ms, min(near.least_m, top_m)),
            }
            for k, near in enumerate(pairs[:FEW])
        ],
    }


def _pairs(report: dict[str, Any]) -> Iterable[Near]:
    ours = {vehicle["id"] for vehicle in report["mission"]["vehicles"]}
    tracks = {int(name): track for name, track in report["flight"]["tracks"].items() if track}
    for one, other in combinations(sorted(tracks, key=lambda n: (n not in ours, n)), 2):
        if one not in ours:
            continue
        there = {row[0]: row for row in tracks[other]}
        both = [(row, there[row[0]]) for row in tracks[one] if row[0] in there]
        if not both:
            continue
        curve = [(a[0], hypot(a[1] - b[1], a[2] - b[2])) for a, b in both]
        k = min(range(len(curve)), key=lambda i: curve[i][1])
        above_m = abs(both[k][0][3] - both[k][1][3])
        yield Near(curve[k][1], one, other, curve[k][0], above_m, curve)


Scale = Callable[[float, float], tuple[float, float]]


def _scale(report: dict[str, Any], low: float, high: float) -> Scale:
    end_ms = max(report["flight"]["end_ms"], 1000)

    def xy(time_ms: float, value: float) -> tuple[float, float]:
        x = LEFT + (WIDTH - LEFT - RIGHT) * time_ms / end_ms
        y = HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (value - low) / (high - low)
        return round(x, 1), round(y, 1)

    return xy


def _points(curve: Iterable[tuple[float, float]], xy: Scale) -> str:
    return " ".join("{},{}".format(*xy(*point)) for point in curve)


def _axes(report: dict[str, Any], low: float, high: float, step: float) -> dict[str, Any]:
    """The frame of a plot: its size, and the ticks of both axes."""
    xy = _scale(report, low, high)
    end_s = max(report["flight"]["end_ms"] / 1000, 1.0)
    every = nice_step(end_s / 4)
    return {
        "width": WIDTH, "height": HEIGHT, "left": LEFT, "right": WIDTH - RIGHT,
        "top": TOP, "bottom": HEIGHT - BOTTOM,
        "levels": [
            {"y": xy(0.0, low + k * step)[1], "text": f"{low + k * step:g} m"}
            for k in range(round((high - low) / step) + 1)
        ],
        "times": [
            {"x": x, "text_x": min(x, WIDTH - TICK), "text": f"{k * every:g} s"}
            for k in range(floor(end_s / every) + 1)
            for x, _ in [xy(1000 * k * every, low)]
        ],
    }  # fmt: skip
