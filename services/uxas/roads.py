"""The OsmPlannerService of a configuration, with the map that it names."""

from __future__ import annotations

from typing import Any

from cratous.services.loading.uxas_settings import Entry
from cratous.services.pipeline.contexts import Contexts
from cratous.services.roads.network import Network
from cratous.services.roads.osm import read_map
from cratous.services.roads.service import OsmPlannerService
from cratous.services.uxas.basic_services import looked_for
from cratous.services.uxas.frame import Host


def made(host: Host, entry: Entry, contexts: Contexts, name: str | None) -> Any:
    """The service; BadInput for a map that is none, and, where the configuration is read strictly, for no map.

    name: of the map's file, relative as those of messages are.
    """
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
    found = read_map(path)
    for note in found.notes:
        host.log("WARN", note)
    network = Network(found, str(path))
    host.log(
        "INFO",
        f"{path}: {len(found.roads)} roads, {len(network.nodes)} nodes, {len(network.legs)} legs",
    )
    return OsmPlannerService(contexts, network)
