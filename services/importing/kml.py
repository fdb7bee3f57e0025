"""Zones and routes of KML 2.2: polygons are zones, line strings are routes; anything else is named
and skipped.

A polygon's kind is its datum `kind` (`<ExtendedData>`), as `cratous export` writes it.
`altitudeMode` of a route: absolute, or relativeToGround; a route clamped to the ground has no
usable altitude. A zone with an unsupported geometry is refused, since omitting it would change the
mission.
"""

from __future__ import annotations

from typing import Any

from cratous.bridge.lmcp.xml_text import parse
from cratous.services.importing import imported_content
from cratous.services.importing.geojson import MOST, WAYS, kind_of, no_ring, no_zone, open_ring
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import at_most

ABSOLUTE, RELATIVE = "absolute", "relativeToGround"


def read_kml(text: bytes, file: str, how: imported_content.Reading) -> imported_content.Parts:
    """The zones and routes of all placemarks. Raises BadInput with line and name."""
    root = parse(text, file)
    if _tag(root) != "kml":
        raise BadInput(
            "not KML", where=f"{file}:{root.sourceline}", expected="<kml>", got=f"<{_tag(root)}>"
        )
    marks = [element for element in root.iter() if _tag(element) == "Placemark"]
    at_most(len(marks), MOST, "too many placemarks", file, "of them")
    ways, fences, left = (
        list[imported_content.Way](),
        list[imported_content.Fence](),
        dict[str, int](),
    )
    for mark in marks:
        where = f"{file}:{mark.sourceline}"
        said = _said(mark)
        name, told = said.get("label") or _text(mark, "name") or "placemark", said.get("kind", "")
        form = next((c for c in mark if _tag(c) in ("Polygon", "LineString", "Point")), None)
        kind = "" if form is None else _tag(form)
        if form is not None and kind == "Polygon" and "search" not in told:
            fences.append(_fence(form, said, name, where, how))
        elif form is not None and kind == "LineString" and told in WAYS:
            ways.append(_way(form, said, name, where, how))
        else:
            several = form is None and any(_tag(e) == "Polygon" for e in mark.iter())
            no_zone(told, kind or "another geometry", (where, name), several)
            what = f"{told or 'no kind'} ({kind or 'another geometry'})"
            left[what] = left.get(what, 0) + 1
    notes = tuple(f"{file}: not taken over: {count} x {what}" for what, count in left.items())
    return imported_content.Parts(ways=tuple(ways), fences=tuple(fences), notes=notes)


def _tag(element: Any) -> str:
    """An element's tag without namespace."""
    return str(element.tag).rpartition("}")[2]


def _text(element: Any, name: str) -> str:
    found = next((e for e in element.iter() if _tag(e) == name), None)
    return "" if found is None or found.text is None else str(found.text).strip()


def _said(mark: Any) -> dict[str, str]:
    data = [element for element in mark.iter() if _tag(element) == "Data"]
    return {element.get("name", ""): _text(element, "value") for element in data}


def _rows(element: Any, where: str, item: str) -> list[list[str]]:
    rows = [part.split(",") for part in _text(element, "coordinates").split()]
    at_most(len(rows), MOST, "too many places", where, "of them")
    if not rows or not all(2 <= len(row) <= 3 for row in rows):
        raise BadInput(
            "not a list of places",
            where=where,
            item=item,
            expected="longitude,latitude[,altitude] ...",
        )
    return rows


def _fence(
    form: Any, said: dict[str, str], name: str, where: str, how: imported_content.Reading
) -> imported_content.Fence:
    keep_out = kind_of(said.get("kind"), how, where, name)
    rings = [element for element in form.iter() if _tag(element) == "LinearRing"]
    if len(rings) != 1:
        raise no_ring(len(rings), where, name)
    corners = [
        (
            imported_content.latitude(r[1], where, name),
            imported_content.longitude(r[0], where, name),
        )
        for r in _rows(rings[0], where, name)
    ]
    if len(corners) < 4 or corners[0] != corners[-1]:
        raise open_ring(where, name)
    floor, ceiling = (
        imported_content.number(said[key], where, f"{name}: {key}", -1000, 100_000)
        if key in said
        else None
        for key in ("floor_msl_m", "ceiling_msl_m")
    )
    return imported_content.Fence(name, keep_out, tuple(corners[:-1]), floor, ceiling, False, where)


def _way(
    form: Any, said: dict[str, str], name: str, where: str, how: imported_content.Reading
) -> imported_content.Way:
    mode = _text(form, "altitudeMode")
    places = []
    for row in _rows(form, where, name):
        own = len(row) == 3 and mode in (ABSOLUTE, RELATIVE)
        alt: Any = row[2] if own else how.alt_m
        if alt is None:
            raise BadInput(
                "a way without altitudes", where=where, item=name,
                expected=f"altitudes and the mode {ABSOLUTE} or {RELATIVE}, or --altitude M",
                got=mode or "clampToGround",
            )  # fmt: skip
        lat, lon = (
            imported_content.latitude(row[1], where, name),
            imported_content.longitude(row[0], where, name),
        )
        places.append(
            imported_content.Place(
                lat, lon, imported_content.altitude(alt, where, name), own and mode == RELATIVE
            )
        )
    if len(places) < 2:
        raise BadInput("a way that leads nowhere", where=where, item=name, expected="two places")
    told = said.get("speed_m_s")
    speed = (
        None
        if told is None
        else imported_content.number(told, where, f"{name}: speed_m_s", 0.01, 350)
    )
    return imported_content.Way(name, tuple(places), speed, where)
