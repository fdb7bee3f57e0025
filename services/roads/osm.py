"""Roads from an OpenStreetMap map (XML, 0.6): every way with a tag `highway`, whatever its value.

As in OpenUxAS: both directions of each, and two roads meet where they share a node. A way over nodes that the
map does not contain, as in extracts, is cut there, and that is noted.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge.lmcp.xml_text import parse
from cratous.services.loading.uxas_parts import is_place
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of
from cratous.spec.files.text_file import bytes_of

NODES_MOST, LEGS_MOST = 200_000, 200_000
"""Limits of a map: road nodes, and straight legs between two of them."""
_ID_MOST = 2**63

Degrees = tuple[float, float]
"""Latitude and longitude [deg]."""


class RoadMap(NamedTuple):
    """nodes: places of the road nodes by id; roads: sequences of two or more of these ids."""

    nodes: Mapping[int, Degrees]
    roads: tuple[tuple[int, ...], ...]
    notes: tuple[str, ...] = ()


def read_map(path: Path) -> RoadMap:
    """The roads of a map; BadInput with file and line for an invalid map, or one that is too large."""
    return map_of(bytes_of(path, expected="a map of OpenStreetMap in XML"), str(path))


def map_of(data: bytes | str, where: str) -> RoadMap:
    """The roads of a map's data. where: its name in errors."""
    root = parse(data, where)
    if root.tag != "osm":
        raise BadInput("not a map", where=where, expected="<osm>", got=f"<{root.tag}>")
    ways = [_refs(way, where) for way in root.iterfind("way") if _is_road(way)]
    wanted = {ref for way in ways for ref in way}
    nodes = _nodes(root, wanted, where)
    pieces, cut = [], 0
    for way in ways:
        found = list(_runs(way, nodes))
        cut += found != [tuple(way)]
        pieces += [run for run in found if len(run) > 1]
    if not pieces:
        raise BadInput(
            "a map without a road", where=where, item="way",
            expected="a way with a tag highway, over two nodes of the map", got="none",
        )  # fmt: skip
    legs = sum(len(run) - 1 for run in pieces)
    if legs > LEGS_MOST:
        raise BadInput(
            "too many roads", where=where, expected=f"at most {LEGS_MOST} legs", got=str(legs)
        )
    note = f"{where}: {cut} roads lead over nodes that the map does not have, and are cut there"
    used = {ref for run in pieces for ref in run}
    kept = {ref: place for ref, place in nodes.items() if ref in used}
    return RoadMap(kept, tuple(pieces), (note,) if cut else ())


def _is_road(way: Any) -> bool:
    return any(tag.get("k") == "highway" for tag in way.iterfind("tag"))


def _refs(way: Any, where: str) -> list[int]:
    """The nodes of a way, without consecutive duplicates."""
    refs: list[int] = []
    for node in way.iterfind("nd"):
        ref = _id(node, "ref", where)
        if not refs or refs[-1] != ref:
            refs.append(ref)
    return refs


def _nodes(root: Any, wanted: set[int], where: str) -> dict[int, Degrees]:
    if len(wanted) > NODES_MOST:
        raise BadInput(
            "too many roads", where=where, expected=f"at most {NODES_MOST} nodes",
            got=str(len(wanted)),
        )  # fmt: skip
    found: dict[int, Degrees] = {}
    for node in root.iterfind("node"):
        number = _id(node, "id", where)
        if number not in wanted:
            continue
        place = _number(node, "lat"), _number(node, "lon")
        if not is_place(*place):
            raise BadInput(
                f"node {number} is at no place", where=_line(node, where), item="lat, lon",
                expected="a latitude within ±89 and a longitude within ±180 degrees",
                got=f"{node.get('lat')}, {node.get('lon')}"[:80],
            )  # fmt: skip
        if found.setdefault(number, place) != place:
            raise BadInput(
                f"node {number} is at two places", where=_line(node, where), item="lat, lon",
                expected=f"{found[number][0]}, {found[number][1]}", got=f"{place[0]}, {place[1]}",
            )  # fmt: skip
    return found


def _runs(way: list[int], nodes: Mapping[int, Degrees]) -> Iterator[tuple[int, ...]]:
    """The pieces of a way between unknown nodes."""
    run: list[int] = []
    for ref in way:
        if ref in nodes:
            run.append(ref)
        elif run:
            yield tuple(run)
            run = []
    if run:
        yield tuple(run)


def _id(element: Any, name: str, where: str) -> int:
    text = element.get(name, "")
    number = integer_of(text, -_ID_MOST, _ID_MOST - 1)
    if number is None:
        raise BadInput(
            f"a <{element.tag}> without a number", where=_line(element, where), item=name,
            expected="a whole number", got=text[:40] or "none",
        )  # fmt: skip
    return number


def _number(element: Any, name: str) -> float:
    """A number of degrees; NaN for invalid text."""
    text = element.get(name, "")
    try:
        return float(text) if text.isascii() and len(text) < 40 and "_" not in text else math.nan
    except ValueError:
        return math.nan


def _line(element: Any, where: str) -> str:
    return f"{where}:{element.sourceline or 1}"
