"""Detects the format of a file by its content, and reads its parts."""

from __future__ import annotations

from pathlib import Path

from cratous.bridge.lmcp.xml_text import parse
from cratous.services.importing import fences, traffic
from cratous.services.importing.geojson import read_geojson
from cratous.services.importing.imported_content import Parts, Reading
from cratous.services.importing.kml import read_kml
from cratous.services.importing.qgc import HEAD, read_qgc
from cratous.services.importing.tables import read_daa, read_eutl
from cratous.services.loading.document import parse_document
from cratous.services.parameters.parameter_file import parse as parse_parameters
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES, MISSION_BYTES
from cratous.spec.files.text_file import bytes_of, text_of

KNOWN = (
    f"a flight plan ({HEAD} 110, .eutl, .daa), a geofence (XML or YAML), traffic (YAML), zones and ways "
    "(GeoJSON, KML) or a parameter file of ICAROUS"
)


class NoKind(BadInput):
    """A file in no supported format; skipped if it is in a folder."""


def read_part(path: Path, how: Reading) -> Parts:
    """The parts of one file. Raises NoKind, or BadInput with line and item."""
    kind, file = path.suffix.lower(), str(path)
    if kind in (".xml", ".kml"):
        data = bytes_of(path, MISSION_BYTES)
        tag = str(parse(data, file).tag).rpartition("}")[2]
        if tag == fences.ROOT:
            return fences.read_fence_xml(data, file)
        if tag == "kml":
            return read_kml(data, file, how)
        raise NoKind("XML of another kind", where=file, expected=KNOWN, got=f"<{tag}>")
    if kind in (".json", ".geojson"):
        return read_geojson(text_of(path, MISSION_BYTES), file, how)
    if kind in (".yaml", ".yml"):
        document = parse_document(text_of(path, MISSION_BYTES), file)
        if traffic.is_traffic(document.data):
            return traffic.read_traffic(document)
        if fences.is_fence_yaml(document.data):
            return fences.read_fence_yaml(document)
        raise NoKind("YAML of another kind", where=file, expected=KNOWN)
    if kind == ".eutl":
        return read_eutl(text_of(path, MISSION_BYTES), file, how)
    if kind == ".daa":
        return read_daa(text_of(path, MISSION_BYTES), file, how)
    return _text(path, file)


def _text(path: Path, file: str) -> Parts:
    text = text_of(path, CONFIG_BYTES, KNOWN)
    lines = [line.strip() for line in text.splitlines()]
    first = next((line for line in lines if line and not line.startswith("#")), "")
    if first.startswith(HEAD):
        return read_qgc(text, file, path.stem)
    if "=" in first:
        return Parts(parameters=parse_parameters(text, file))
    raise NoKind("a file of another kind", where=file, expected=KNOWN, got=first[:60] or "nothing")
