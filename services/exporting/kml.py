"""A mission as KML 2.2 (OGC 07-147r2): one document, a folder for vehicles, traffic, tasks, zones, routes."""

from __future__ import annotations

import json
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from cratous.services.exporting.shapes import AREA, LINE, Place, Shape, shapes
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import Plan

FOLDERS = {
    "vehicle": "Vehicles",
    "traffic": "Traffic",
    "keep_in": "Zones",
    "keep_out": "Zones",
    "route": "Routes",
}
TASKS = "Tasks"
COLOURS = {"keep_in": "5050b000", "keep_out": "501400d0", "route": "ffff9000"}
"""Colours in KML order: opacity, blue, green, red."""


def kml_text(mission: Mission, plan: Plan | None = None) -> str:
    """The XML; altitudes are above mean sea level, and areas are clamped to the ground."""
    folders: dict[str, list[str]] = {}
    for shape in shapes(mission, plan):
        name = FOLDERS.get(shape.properties["kind"], TASKS)
        folders.setdefault(name, []).append(_placemark(shape))
    styles = "".join(
        f'<Style id="{name}"><LineStyle><color>ff{colour[2:]}</color><width>2</width></LineStyle>'
        f"<PolyStyle><color>{colour}</color></PolyStyle></Style>\n"
        for name, colour in COLOURS.items()
    )
    inside = "".join(
        f"<Folder><name>{name}</name>\n{''.join(marks)}</Folder>\n"
        for name, marks in folders.items()
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<kml xmlns="http://www.opengis.net/kml/2.2">\n<Document>\n'
        f"<name>{escape(mission.name)}</name>\n{styles}{inside}</Document>\n</kml>\n"
    )


def _placemark(shape: Shape) -> str:
    said, kind = shape.properties, shape.properties["kind"]
    name = said.get("label") or f"{kind} {said['id']}"
    style = f"<styleUrl>#{kind}</styleUrl>" if kind in COLOURS else ""
    data = "".join(
        f"<Data name={quoteattr(key)}><value>{escape(_value(value))}</value></Data>"
        for key, value in said.items()
    )
    return (
        f'<Placemark id="{kind}-{said["id"]}"><name>{escape(name)}</name>{style}\n'
        f"<ExtendedData>{data}</ExtendedData>\n{_geometry(shape)}</Placemark>\n"
    )


def _geometry(shape: Shape) -> str:
    if shape.form == AREA:
        ring = _coordinates(shape.places, with_altitude=False)
        return (
            "<Polygon><outerBoundaryIs><LinearRing>"
            f"{ring}</LinearRing></outerBoundaryIs></Polygon>\n"
        )
    name = "LineString" if shape.form == LINE else "Point"
    places = _coordinates(shape.places, with_altitude=True)
    return f"<{name}><altitudeMode>absolute</altitudeMode>{places}</{name}>\n"


def _coordinates(places: tuple[Place, ...], *, with_altitude: bool) -> str:
    # 1e-9 degrees are 0.1 mm
    texts = [
        f"{lon:.9f},{lat:.9f}" + (f",{altitude:.3f}" if with_altitude else "")
        for lon, lat, altitude in places
    ]
    return f"<coordinates>{' '.join(texts)}</coordinates>"


def _value(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
