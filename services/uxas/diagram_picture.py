"""Draws a planned request as SVG: zones, tasks, vehicles and their waypoints; north is up."""

from __future__ import annotations

from html import escape
from typing import Any, NamedTuple

from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import corners_of, locations, point
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

WIDTH, HEIGHT, EDGE = 1000.0, 700.0, 50.0
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
_AREAS = ("Polygon", "Rectangle", "Circle")
_STYLE = """
 text { font: 13px sans-serif; fill: #222 } .in { fill: #e8f4e8; stroke: #2a7a2a }
 .out { fill: #f7dada; stroke: #b22222 } .task { fill: none; stroke: #555; stroke-width: 2 }
 .spot { fill: #555 } .way { fill: none; stroke-width: 1.5 } @media (prefers-color-scheme: dark) {
 svg { background: #fff } }"""


class Shape(NamedTuple):
    """closed: an area; otherwise a line, or a point if it has one corner. corners: north and east [m]."""

    closed: bool
    corners: list[tuple[float, float]]
    css: str
    label: str = ""
    color: str = ""


def picture(files: dict[str, Any], title: str) -> str:
    """The SVG text for a request's objects by file name (see `diagram.files`).

    Objects without a position on a map are omitted; they are in their files.
    """
    found = [place for body in files.values() for place in locations(body) if place != (0.0, 0.0)]
    usable = [p for p in found if abs(p[0]) <= 89 and abs(p[1]) <= 180]
    if not usable:
        return _svg([], title)
    places = Places(Frame(*(sum(part) / len(usable) for part in zip(*usable, strict=True))))
    shapes: list[Shape] = []
    for name, body in files.items():
        sort, _, number = name.removesuffix(".xml").partition("_Id_")
        if sort.startswith("Zone"):
            shapes += _parts(
                body, places, "in" if sort == "ZoneKeepIn" else "out", f"zone {number}"
            )
        elif sort == "UniqueAutomationResponse":
            shapes += _ways(body, places)
        elif sort.endswith("Entity") or sort == "EntityState":
            shapes += _parts(body.Location, places, "spot", f"vehicle {number}")
        else:
            shapes += _parts(body, places, "task", f"{type(body).__name__} {number}")
    return _svg(shapes, title)


def _parts(value: Any, places: Places, css: str, label: str) -> list[Shape]:
    """The areas, lines and points inside an object."""
    kind, sent = type(value).__name__, Sent(value, label, 0)
    try:
        if kind in _AREAS:
            return [
                Shape(
                    True,
                    [*corners_of(value, sent, kind, label, places, [], outside=False)],
                    css,
                    label,
                )
            ]
        if kind == "Location3D":
            spot = [point(value, places, sent, kind)[:2]]
            return [Shape(False, spot, "spot", label)] if value.Latitude or value.Longitude else []
        if isinstance(value, (list, tuple)) and value and type(value[0]).__name__ == "Location3D":
            return [Shape(False, [point(v, places, sent, kind)[:2] for v in value], css, label)]
    except BadInput:
        return []  # invalid position or impossible area: it is in its file
    names = getattr(value, "names", ())
    return [shape for name in names for shape in _parts(getattr(value, name), places, css, label)]


def _ways(response: Any, places: Places) -> list[Shape]:
    shapes = []
    for k, command in enumerate(response.OriginalResponse.MissionCommandList):
        ways = [
            w for w in command.WaypointList if abs(w.Latitude) <= 89 and abs(w.Longitude) <= 180
        ]
        corners = [places.local(w.Latitude, w.Longitude) for w in ways]
        shapes.append(Shape(False, corners, "way", "", COLORS[k % len(COLORS)]))
    return shapes


def _svg(shapes: list[Shape], title: str) -> str:
    norths = [corner[0] for shape in shapes for corner in shape.corners] or [0.0]
    easts = [corner[1] for shape in shapes for corner in shape.corners] or [0.0]
    span_n, span_e = (max(max(v) - min(v), 1.0) for v in (norths, easts))
    factor = min((WIDTH - 2 * EDGE) / span_e, (HEIGHT - 2 * EDGE) / span_n)
    middle_n, middle_e = ((max(v) + min(v)) / 2 for v in (norths, easts))

    def xy(corner: tuple[float, float]) -> tuple[float, float]:
        x = WIDTH / 2 + (corner[1] - middle_e) * factor
        return round(x, 1), round(HEIGHT / 2 - (corner[0] - middle_n) * factor, 1)

    rows = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {HEIGHT:g}">',
        f"<title>{escape(title)}</title><style>{_STYLE}</style>",
        *(_drawn(shape, [xy(corner) for corner in shape.corners]) for shape in shapes),
        "</svg>",
    ]
    return "\n".join(rows) + "\n"


def _drawn(shape: Shape, corners: list[tuple[float, float]]) -> str:
    if not corners:
        return ""
    x, y = corners[0]
    text = f'<text x="{x + 6}" y="{y - 6}">{escape(shape.label)}</text>' if shape.label else ""
    if len(corners) == 1:
        return f'<circle class="spot" cx="{x}" cy="{y}" r="4"/>{text}'
    points = " ".join(f"{x},{y}" for x, y in corners)
    color = f' stroke="{shape.color}"' if shape.color else ""
    tag = "polygon" if shape.closed else "polyline"
    return f'<{tag} class="{shape.css}"{color} points="{points}"/>{text}'
