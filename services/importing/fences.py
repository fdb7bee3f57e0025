"""Geofences of ICAROUS: XML (`<Geofence><fence id><type>KEEPIN...`), and the same in YAML."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.bridge.lmcp.xml_text import parse
from cratous.services.importing.imported_content import Fence, Parts, latitude, longitude, number
from cratous.services.loading.document import Document
from cratous.spec.errors import BadInput

ROOT = "Geofence"
TYPES = {
    "KEEPIN": False,
    "KEEP_IN": False,
    "0": False,
    "KEEPOUT": True,
    "KEEP_OUT": True,
    "1": True,
}
"""Words, and numbers in older files; the value tells whether it is a keep-out."""
MOST = 1000
"""Maximum number of corners of a fence."""
HIGH_M = 200_000.0
"""Floors and roofs beyond this mean none [m]; the mission schema limits those of a zone."""


def read_fence_xml(text: bytes, file: str) -> Parts:
    """The fences of a file, in order. Raises BadInput with line and item."""
    root = parse(text, file)
    if root.tag != ROOT:
        raise BadInput(
            "not a geofence file", where=f"{file}:{root.sourceline}", expected=f"<{ROOT}>",
            got=f"<{root.tag}>",
        )  # fmt: skip
    return Parts(fences=tuple(_fence(element, file) for element in root))


def _fence(element: Any, file: str) -> Fence:
    where = f"{file}:{element.sourceline}"
    if element.tag != "fence":
        raise BadInput("unknown element", where=where, expected="<fence>", got=f"<{element.tag}>")
    name = f"fence {element.get('id', '')}".strip()
    corners = list[tuple[float, float]]()
    for vertex in element.findall("vertex"):
        place = f"{file}:{vertex.sourceline}"
        item = f"{name}: vertex {vertex.get('id', len(corners))}"
        lat, lon = (_text(vertex, tag, place, item) for tag in ("lat", "lon"))
        corners.append((latitude(lat, place, item), longitude(lon, place, item)))
    told = {tag: _text(element, tag, where, name) for tag in ("type", "floor", "roof")}
    count = element.findtext("num_vertices")
    return _made(name, told, count, corners, where)


def _text(element: Any, tag: str, where: str, item: str) -> str:
    text = element.findtext(tag)
    if text is None or not text.strip():
        raise BadInput(f"no <{tag}>", where=where, item=item, expected=f"<{tag}>...</{tag}>")
    return str(text).strip()


def _made(
    name: str, told: dict[str, Any], count: Any, corners: list[tuple[float, float]], where: str
) -> Fence:
    kind = TYPES.get(str(told["type"]).strip().upper())
    if kind is None:
        raise BadInput(
            "a type of fence that is not known", where=where, item=name,
            expected="KEEPIN or KEEPOUT (older files: 0 or 1)", got=str(told["type"])[:40],
        )  # fmt: skip
    said = len(corners) if count is None else number(count, where, f"{name}: vertices", 0, MOST)
    if said != len(corners) or len(corners) < 3:
        raise BadInput(
            "corners are missing, or too many", where=where, item=name,
            expected=f"{max(3, int(said))} vertices", got=str(len(corners)),
        )  # fmt: skip
    floor_m, roof_m = (
        number(told[tag], where, f"{name}: {tag}", -HIGH_M, HIGH_M) for tag in ("floor", "roof")
    )
    if corners[0] == corners[-1]:
        corners = corners[:-1]
    return Fence(name, kind, tuple(corners), floor_m, roof_m, True, where)


def is_fence_yaml(data: Any) -> bool:
    """Whether the data of a YAML file is a list of fences."""
    return isinstance(data, list) and bool(data) and all(
        isinstance(one, dict) and "vertices" in one for one in data
    )  # fmt: skip


def read_fence_yaml(document: Document) -> Parts:
    """The fences of a list of mappings: id, type, floor, roof, vertices (latitude, longitude)."""
    return Parts(fences=tuple(_of_yaml(document)))


def _of_yaml(document: Document) -> Iterator[Fence]:
    for k, one in enumerate(document.data):
        where, name = document.where((k,)), f"fence {one.get('id', k)}"
        for tag in ("type", "floor", "roof"):
            if tag not in one:
                raise BadInput(
                    "missing", where=where, item=f"{name}: {tag}", expected=f"{tag}: ..."
                )
        corners = []
        for j, vertex in enumerate(one["vertices"] if isinstance(one["vertices"], list) else ()):
            item = f"{name}: vertex {j}"
            if not isinstance(vertex, list) or len(vertex) != 2:
                raise BadInput(
                    "not a corner", where=where, item=item, expected="[latitude, longitude]",
                    got=str(vertex)[:60],
                )  # fmt: skip
            lat, lon = vertex
            corners.append((latitude(lat, where, item), longitude(lon, where, item)))
        yield _made(name, one, one.get("numV"), corners, where)
