"""Plots: bands over time, alerts over time, and the encounter from above."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from cratous.core.files.whole_file import replacing
from cratous.services.daa import Step
from cratous.spec.errors import BadInput
from cratous.spec.files.extras import told

COLOURS = {0: "#d9ead3", 1: "#fff2cc", 2: "#f6b26b", 3: "#cc0000", 4: "#38761d", -1: "#bbbbbb"}
LABELS = {0: "none", 1: "FAR", 2: "MID", 3: "NEAR", 4: "recovery", -1: "unknown"}
AXES = {
    "hdir": ("direction [deg]", 180 / math.pi), "hs": ("speed [m/s]", 1.0),
    "vs": ("climb [m/s]", 1.0), "alt": ("altitude [m]", 1.0),
}  # fmt: skip
LEVELS = ("#d9ead3", "#fff2cc", "#f6b26b", "#cc0000", "#7f0000")


def draw(instants: Iterable[Step], file: Path) -> None:
    """Draw all steps into an SVG or PNG file; raises BadInput for another kind of file.

    The file type is checked before the steps are computed.
    """
    if file.suffix not in (".svg", ".png"):
        raise BadInput(
            "a picture of an unknown kind",
            where=str(file),
            expected=".svg or .png",
            got=file.suffix,
        )
    with told():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.collections import PolyCollection
        from matplotlib.figure import Figure
        from matplotlib.patches import Patch

    steps = list(instants)
    if not steps:
        raise BadInput("there is nothing to draw", where=str(file), expected="at least one step")

    times = [s.instant.time_s for s in steps]
    width = times[1] - times[0] if len(times) > 1 else 1.0
    figure = Figure(figsize=(12, 13), layout="constrained")
    FigureCanvasAgg(figure)
    parts = figure.add_gridspec(4, 2, height_ratios=(1.3, 1.3, 0.7, 2.2))
    seen = set()
    for k, name in enumerate(AXES):
        axis = figure.add_subplot(parts[k // 2, k % 2])
        label, size = AXES[name]
        boxes, colours, own = [], [], []
        for n, step in enumerate(steps):
            g = next((g for g in step.instant.guidance if g.dimension == name), None)
            if g is None:
                continue
            t = times[n]
            end = (
                times[n + 1] if n + 1 < len(times) and times[n + 1] - t <= 3 * width else t + width
            )
            own.append((t, g.own * size))
            for b in g.bands:
                low, high = b.low * size, b.high * size
                boxes.append([(t, low), (end, low), (end, high), (t, high)])
                colours.append(COLOURS[b.region])
                seen.add(b.region)
        axis.add_collection(PolyCollection(boxes, facecolors=colours, edgecolors="none"))
        axis.plot([t for t, _ in own], [v for _, v in own], "k.", markersize=2)
        axis.set_xlim(times[0], times[-1] + width)
        axis.autoscale_view(scalex=False)
        if name == "alt":
            axis.set_ylim(*_near(steps, axis.get_ylim()))
            label += ", near the aircraft"
        axis.set_ylabel(label)
        axis.set_xlabel("time [s]")
    ids = list(dict.fromkeys(a.id for s in steps for a in s.instant.alerts))
    axis = figure.add_subplot(parts[2, :])
    for row, name in enumerate(ids):
        for n, step in enumerate(steps):
            for a in step.instant.alerts:
                if a.id == name:
                    axis.barh(row, width, left=times[n], color=LEVELS[min(a.level, 4)], height=0.8)
    axis.set_yticks(range(len(ids)), ids)
    axis.set_xlim(times[0], times[-1] + width)
    axis.set_xlabel("time [s]")
    axis.set_title("alert level (0 to 3: pale to red)", fontsize=9)
    _plan(figure.add_subplot(parts[3, :]), steps)
    figure.legend(
        handles=[Patch(color=COLOURS[r], label=LABELS[r]) for r in sorted(seen)],
        loc="outside upper center",
        ncols=6,
    )
    kind = file.suffix[1:]
    with replacing(file, "the picture") as part:
        figure.savefig(part, format=kind, metadata={"Date": None} if kind == "svg" else None)


NEAR_M = 1000.0
"""Altitudes farther than this from all aircraft are not drawn [m]: bands go up to 50,000 ft."""


def _near(steps: Sequence[Step], whole: tuple[float, float]) -> tuple[float, float]:
    """The altitude range to draw: that of all aircraft, with a margin, within the whole range."""
    seen = [a.alt_m for s in steps for a in (s.instant.own, *s.instant.seen.others)]
    low, high = min(seen) - NEAR_M, max(seen) + NEAR_M
    return max(whole[0], low), min(whole[1], high)


def _plan(axis: object, steps: Sequence[Step]) -> None:
    """The tracks from above, in the plane at the ownship's first position."""
    from cratous.core.daa.frame import project

    first = steps[0].rows[0].values
    tracks: dict[str, list[tuple[float, float]]] = {}
    for step in steps:
        for row in step.rows:
            v = row.values
            if row.geodetic:
                place = project(first["lat"], first["lon"], v["lat"], v["lon"], 0.0, 0.0)
                point = (place.east_m, place.north_m)
            else:
                point = (v["x"], v["y"])
            tracks.setdefault(row.id, []).append(point)
    for k, (name, points) in enumerate(tracks.items()):
        xs, ys = [x / 1000 for x, _ in points], [y / 1000 for _, y in points]
        axis.plot(xs, ys, "-" if k else "k-", label=name, linewidth=1.5)  # type: ignore[attr-defined]
        axis.plot(xs[:1], ys[:1], "o", color="k" if not k else "0.5", markersize=4)  # type: ignore[attr-defined]
        axis.plot(xs[-1:], ys[-1:], "^", color="k" if not k else "0.5", markersize=5)  # type: ignore[attr-defined]
    axis.set_title("from above; a dot where each begins, a triangle where it ends", fontsize=9)  # type: ignore[attr-defined]
    axis.set_aspect("equal", adjustable="datalim")  # type: ignore[attr-defined]
    axis.set_xlabel("east [km]")  # type: ignore[attr-defined]
    axis.set_ylabel("north [km]")  # type: ignore[attr-defined]
    axis.legend(fontsize=8)  # type: ignore[attr-defined]
