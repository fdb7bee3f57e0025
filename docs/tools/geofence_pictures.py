"""Draws the pictures of docs/guides/geofence.md: `python docs/tools/geofence_pictures.py`.

All results shown (places, buffers, spans and errors) are computed by `cratous.core.geofence`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("svg")
from matplotlib import pyplot as plt

from cratous.core import geofence
from cratous.core.files.whole_file import replacing
from cratous.core.geofence import Place

FOLDER = Path(__file__).resolve().parents[1] / "img"
COLOURS = {Place.INSIDE: "#2a7ab0", Place.BOUNDARY: "#d08a00", Place.OUTSIDE: "#9a9a9a"}
COMB = [(0, 0), (9, 0), (9, 6), (7, 6), (7, 2), (5, 2), (5, 6), (3, 6), (3, 2), (1, 2), (1, 6), (0, 6)]  # fmt: skip
STAR = [(0, 0), (4, 1), (8, 0), (6.5, 3.5), (8, 7), (4, 5.5), (0, 7), (1.5, 3.5)]
matplotlib.rcParams.update(
    {"svg.fonttype": "none", "svg.hashsalt": "geofence", "font.size": 9, "axes.axisbelow": True}
)


def _save(figure: Any, name: str) -> None:
    with replacing(FOLDER / name) as part:
        figure.savefig(part, metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)


def _outline(axis: Any, corners: Any, **more: Any) -> None:
    axis.fill(*zip(*corners, strict=True), facecolor="#eef3f7", edgecolor="#303030", lw=1, **more)
    axis.set_aspect("equal")
    axis.axis("off")


def faults() -> None:
    """Outlines that are refused, with the vertex or edges that the error names."""
    cases = [
        ("repeated", [(0, 0), (6, 0), (6, 5), (3, 2), (0, 5), (3, 2)]),
        ("spike", [(0, 0), (6, 0), (6, 5), (6, 2), (0, 4)]),
        ("crossing", [(0, 0), (6, 5), (6, 0), (0, 5)]),
        ("touching", [(0, 0), (6, 0), (6, 5), (3, 0), (0, 5)]),
    ]
    figure, axes = plt.subplots(1, 4, figsize=(9, 2.2))
    for axis, (title, corners) in zip(axes, cases, strict=True):
        fault = geofence.fault_of(corners)
        assert fault is not None
        _outline(axis, corners)
        for k in fault.edges:
            a, b = corners[k - 1], corners[k % len(corners)]
            axis.plot([a[0], b[0]], [a[1], b[1]], color="#c03020", lw=2.5)
        for k in fault.vertices:
            axis.plot(*corners[k - 1], "o", color="#c03020", ms=6)
        for k, (x, y) in enumerate(corners, 1):
            axis.annotate(str(k), (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7)
        numbers = fault.vertices if fault.kind == "repeated" else fault.edges or fault.vertices
        word = "vertices" if fault.kind == "repeated" else "edges"
        axis.set_title(f"{title}: {word} {' and '.join(map(str, numbers))}", fontsize=9)
    _save(figure, "geofence_faults.svg")


def on_the_edge() -> None:
    """Points one unit in the last place apart, around an edge: in doubles and by the exact reading."""
    corners = [(-3.0, -1.0), (3.0, 1.0), (0.0, 4.0)]
    shape = geofence.polygon(corners)
    n, step = 17, 2.0**-53
    base = np.array([0.9, 0.3])
    x = base[0] + step * 2 * np.arange(-n, n + 1)
    y = base[1] + step * np.arange(-n, n + 1)
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    exact = geofence.places(grid, shape)
    a, b = corners[:2]
    plain = np.sign((b[0] - a[0]) * (grid[..., 1] - a[1]) - (b[1] - a[1]) * (grid[..., 0] - a[0]))
    figure, axes = plt.subplots(1, 2, figsize=(6.4, 3.1))
    colours = matplotlib.colors.ListedColormap([COLOURS[Place(v)] for v in (-1, 0, 1)])
    for axis, values, title in zip(
        axes, (plain, exact), ("the turn in doubles", "exact verdicts"), strict=True
    ):
        axis.imshow(values, origin="lower", cmap=colours, vmin=-1, vmax=1, interpolation="nearest")
        axis.set(xticks=[], yticks=[], title=title)
    wrong = int((plain != exact).sum())
    figure.supxlabel(
        f"{grid.shape[0]} x {grid.shape[1]} neighbouring doubles at (0.9, 0.3): "
        f"plain doubles are wrong at {wrong}",
        fontsize=8,
    )
    _save(figure, "geofence_edge.svg")


def passage() -> None:
    """A leg through a comb-shaped zone, and one along its teeth, with the place of each point."""
    shape = geofence.polygon(COMB)
    figure, axis = plt.subplots(figsize=(6, 3.6))
    _outline(axis, COMB)
    for p, q in (((-1, 3), (10, 5)), ((-1, 6), (10, 6)), ((-1, 2), (10, 2))):
        for stretch in geofence.leg_places(p, q, shape):
            t = np.array([float(stretch.begin), float(stretch.end)])
            x, y = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])
            mark = "o" if stretch.begin == stretch.end else "-"
            axis.plot(x, y, mark, color=COLOURS[stretch.place], lw=2.5, ms=4)
    for place, colour in COLOURS.items():
        axis.plot([], [], color=colour, lw=2.5, label=place.name.lower())
    axis.legend(loc="upper center", ncol=3, fontsize=8, frameon=False, bbox_to_anchor=(0.5, 1.12))
    _save(figure, "geofence_passage.svg")


def buffers() -> None:
    """A star widened and narrowed by a buffer: where the places change."""
    shape = geofence.polygon(STAR)
    x, y = np.linspace(-2, 10, 241), np.linspace(-2, 9, 221)
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    figure, axis = plt.subplots(figsize=(4.2, 3.6))
    _outline(axis, STAR)
    for inwards, colour in ((False, "#c03020"), (True, "#2a7ab0")):
        found = geofence.buffered_places(grid, shape, 0.8, inwards=inwards)
        axis.contour(x, y, found, levels=[0], colors=colour, linewidths=1.2)
    for k in (0.0, math.pi):
        axis.plot([], [], color="#c03020" if k else "#2a7ab0", label="widened" if k else "narrowed")
    axis.legend(loc="center", fontsize=8, frameon=False)
    _save(figure, "geofence_buffers.svg")


def main() -> None:
    """Draw all pictures."""
    for draw in (faults, on_the_edge, passage, buffers):
        draw()


if __name__ == "__main__":
    main()
