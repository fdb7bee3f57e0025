"""Creates the OsmPlannerService of a configuration with its map."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from cratous.services.loading.uxas_settings import Entry
from cratous.services.pipeline.contexts import Contexts
from cratous.services.roads.files import Names, RoadFiles
from cratous.services.roads.network import Network
from cratous.services.roads.osm import read_map
from cratous.services.roads.service import OsmPlannerService
from cratous.services.uxas.basic_services import data_of, looked_for
from cratous.services.uxas.frame import Host

WRITTEN = ("MapEdgesFile", "ShortestPathFile", "MetricsFile")


def made(host: Host, entry: Entry, contexts: Contexts, v: dict[str, Any]) -> Any:
    """The service; BadInput for an invalid map and, in strict mode, for a missing one.

    v: the attributes; OsmFile is resolved as message files are, output files go to the data folder.
    """
    name, names = v["OsmFile"], Names(*(_name(entry, one, v[one]) for one in WRITTEN))
    if name:
        what = f"its map {name} is missing"
        path, expected = looked_for(host, name, entry.where)
    else:
        what = "it names no map (OsmFile)"
        path, expected = None, "a map of OpenStreetMap in XML"
    if path is None:
        if host.root.get("strict"):
            raise entry.refusal(what, "OsmFile", expected, name or "none")
        host.log("WARN", f"{entry.where}: {entry.type}: {what}: no road is known ({expected})")
        return OsmPlannerService(contexts, None, f"{entry.type}: {what}")
    began_s = time.perf_counter()
    found = read_map(path)
    for note in found.notes:
        host.log("WARN", note)
    network = Network(found, str(path))
    host.log(
        "INFO",
        f"{path}: {len(found.roads)} roads, {len(network.nodes)} nodes, {len(network.legs)} legs",
    )
    if not any(names):
        return OsmPlannerService(contexts, network)
    folder = data_of(host, entry) / "OsmPlannerService"
    files = RoadFiles(folder, names, time.perf_counter() - began_s)
    files.map(network)
    return OsmPlannerService(contexts, network, files=files)


def _name(entry: Entry, attribute: str, text: str | None) -> str:
    if text and (Path(text).name != text or "\\" in text):
        raise entry.refusal("a file elsewhere", attribute, "the name of a file", text)
    return text or ""
