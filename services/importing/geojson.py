"""Zones and routes of GeoJSON (RFC 7946): polygons are zones, lines are routes; anything else is
named and skipped.

A polygon's kind is its property `kind` (or `type`): keep_in or keep_out, as `cratous export` writes
them. A line is a route unless its `kind` is that of a task. A zone with an unsupported geometry is
refused, since omitting it would change the mission.
"""

from __future__ import annotations

from typing import Any

from cratous.services.importing import imported_content
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import at_most, json_of

KINDS = {
    "keepin": "keep_in", "keepout": "keep_out", "inclusion": "keep_in", "exclusion": "keep_out",
}  # fmt: skip
WAYS = ("", "route", "way")
SEVERAL = ("MultiPolygon", "GeometryCollection")
"""Geometries that may contain areas."""
MOST = 2000
"""Maximum number of positions of a shape, and of shapes in a file."""


def kind_of(told: object, how: imported_content.Reading, where: str, item: str) -> bool:
    """Whether an area is a keep-out zone, from its kind, or from the user's option for areas
    without one. Raises BadInput.
    """
    kind = KINDS.get(_word(told or how.areas))
    if kind is None:
        raise BadInput(
            "an area of no kind" if not told else "an area of another kind", where=where, item=item,
            expected="keep_in or keep_out as its kind"
            + ("" if told else ", or --areas keep_in or keep_out for all that say none"),
            got=str(told or "none")[:40],
        )  # fmt: skip
    return kind == "keep_out"


def no_ring(count: int, where: str, item: str) -> BadInput:
    """The error for an area without exactly one outline."""
    what = "an area with holes, or of no outline"
    return BadInput(what, where=where, item=item, expected="one ring", got=f"{count} rings")


def open_ring(where: str, item: str) -> BadInput:
    """The error for an outline that is not closed."""
    what = "a ring that is not closed"
    return BadInput(what, where=where, item=item, expected="the first place again, last")


def _word(told: object) -> str:
    return str(told or "").lower().replace("_", "").replace("-", "").replace(" ", "")


def read_geojson(text: str, file: str, how: imported_content.Reading) -> imported_content.Parts:
    """The zones and routes in a text. Raises BadInput with the feature."""
    data = json_of(text, file)
    kind = data.get("type") if isinstance(data, dict) else None
    features = data.get("features") if kind == "FeatureCollection" else [data]
    if kind not in ("FeatureCollection", "Feature") or not isinstance(features, list):
        raise BadInput(
            "not GeoJSON with features", where=file, expected="a FeatureCollection or a Feature",
            got=str(kind)[:40],
        )  # fmt: skip
    at_most(len(features), MOST, "too many features", file, "of them")
    ways, fences, left = (
        list[imported_content.Way](),
        list[imported_content.Fence](),
        dict[str, int](),
    )
    for k, feature in enumerate(features):
        item = f"features[{k}]"
        form, coordinates, said = _parts(feature, file, item)
        name = str(said.get("label") or said.get("name") or item)
        told = said.get("kind", said.get("type"))
        if form == "Polygon" and (told is None or _is_zone(told)):
            fences.append(_fence(coordinates, said, name, (file, item), how))
        elif form == "LineString" and str(told or "") in WAYS:
            ways.append(_way(coordinates, said, name, (file, item), how))
        else:
            no_zone(told, form, (file, item), several=form in SEVERAL)
            what = f"{told or 'no kind'} ({form})"
            left[what] = left.get(what, 0) + 1
    notes = tuple(f"{file}: not taken over: {count} x {what}" for what, count in left.items())
    return imported_content.Parts(ways=tuple(ways), fences=tuple(fences), notes=notes)


def _is_zone(told: object) -> bool:
    """Whether an area is a zone: tasks can be areas too, with kinds of their own."""
    return "search" not in str(told)


def no_zone(told: object, form: str, place: tuple[str, str], several: bool) -> None:
    """Raises BadInput for a zone whose geometry is not supported; several: whether the geometry may
    contain areas.
    """
    word = _word(told)
    if word in KINDS or (several and (not word or _is_zone(told))):
        where, item = place
        raise BadInput(
            "an area that is not one polygon", where=where, item=item,
            expected="each area as a Polygon of its own", got=form,
        )  # fmt: skip


def _parts(feature: Any, file: str, item: str) -> tuple[str, Any, dict[str, Any]]:
    geometry = feature.get("geometry") if isinstance(feature, dict) else None
    if not isinstance(geometry, dict) or not isinstance(geometry.get("type"), str):
        raise BadInput("a feature without geometry", where=file, item=item, expected="a geometry")
    said = feature.get("properties")
    return geometry["type"], geometry.get("coordinates"), said if isinstance(said, dict) else {}


def _places(coordinates: Any, place: tuple[str, str]) -> list[list[Any]]:
    file, item = place
    if not isinstance(coordinates, list) or not all(
        isinstance(one, list) and 2 <= len(one) <= 3 for one in coordinates
    ):
        raise BadInput(
            "not a list of positions", where=file, item=item, expected="[longitude, latitude], ...",
            got=str(coordinates)[:60],
        )  # fmt: skip
    at_most(len(coordinates), MOST, "too many places", f"{file}: {item}", "of them")
    return coordinates


def _fence(
    coordinates: Any,
    said: dict[str, Any],
    name: str,
    place: tuple[str, str],
    how: imported_content.Reading,
) -> imported_content.Fence:
    file, item = place
    keep_out = kind_of(said.get("kind", said.get("type")), how, file, item)
    if not isinstance(coordinates, list) or len(coordinates) != 1:
        raise no_ring(len(coordinates) if isinstance(coordinates, list) else 0, file, item)
    ring = _places(coordinates[0], place)
    if len(ring) < 4 or ring[0] != ring[-1]:
        raise open_ring(file, item)
    corners = tuple(
        (imported_content.latitude(p[1], file, item), imported_content.longitude(p[0], file, item))
        for p in ring[:-1]
    )
    floor, ceiling = (
        None
        if said.get(key) is None
        else imported_content.number(said[key], file, f"{item}: {key}", -1000, 100_000)
        for key in ("floor_msl_m", "ceiling_msl_m")
    )
    return imported_content.Fence(name, keep_out, corners, floor, ceiling, False, file)


def _way(
    coordinates: Any,
    said: dict[str, Any],
    name: str,
    place: tuple[str, str],
    how: imported_content.Reading,
) -> imported_content.Way:
    file, item = place
    row = _places(coordinates, place)
    if len(row) < 2:
        raise BadInput("a way that leads nowhere", where=file, item=item, expected="two places")
    told = said.get("altitudes_msl_m")
    heights = told if isinstance(told, list) else [said.get("altitude_msl_m", how.alt_m)] * len(row)
    if len(heights) != len(row):
        raise BadInput(
            "altitudes that do not fit", where=file, item=f"{item}: altitudes_msl_m",
            expected=f"{len(row)} of them", got=str(len(heights)),
        )  # fmt: skip
    places = []
    for spot, height in zip(row, heights, strict=True):
        alt = spot[2] if len(spot) == 3 else height
        if alt is None:
            raise BadInput(
                "a way without altitudes", where=file, item=item,
                expected="a third number in each place, altitude_msl_m, or --altitude M",
            )  # fmt: skip
        lat, lon = (
            imported_content.latitude(spot[1], file, item),
            imported_content.longitude(spot[0], file, item),
        )
        places.append(
            imported_content.Place(lat, lon, imported_content.altitude(alt, file, item), False)
        )
    speed = said.get("speed_m_s")
    speed = (
        None
        if speed is None
        else imported_content.number(speed, file, f"{item}: speed_m_s", 0.01, 350)
    )
    return imported_content.Way(name, tuple(places), speed, file)
