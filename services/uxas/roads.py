"""The OsmPlannerService of a configuration, with the map that it names."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from cratous.services.loading.uxas_settings import Entry
from cratous.services.pipeline.contexts import Contexts
from cratous.services.roads.network import Network
from cratous.services.roads.osm import read_map
from cratous.services.roads.service import OsmPlannerService
from cratous.services.uxas.frame import Host


def made(host: Host, entry: Entry, contexts: Contexts, name: str | None) -> Any:
    """The service; BadInput for a map that is none, and, where the configuration is read strictly, for no map.

    name: of the map's file, relative as those of messages are: to the present folder, else to that of the
    configuration or its `rundir`.
    """
    declared, beside = name or "", host.config.parent
    bases = (Path(), beside, beside / "rundir", beside / "inputs")
    paths = [Path(os.path.normpath(base / declared)) for base in bases] if declared else []
    path = next((one for one in paths if one.is_file()), None)
    if path is None:
        what = f"its map {declared} is missing" if declared else "it names no map (OsmFile)"
        expected = " or ".join(dict.fromkeys(map(str, paths))) or "a map of OpenStreetMap in XML"
        if host.root.get("strict"):
            raise entry.refusal(what, "OsmFile", expected, declared or "none")
        host.log("WARN", f"{entry.where}: {entry.type}: {what}: no road is known ({expected})")
        return OsmPlannerService(contexts, None, f"{entry.type}: {what}")
    if path != paths[0]:
        host.log("INFO", f"{entry.where}: {declared} is read from {path}")
    found = read_map(path)
    for note in found.notes:
        host.log("WARN", note)
    network = Network(found, str(path))
    host.log(
        "INFO",
        f"{path}: {len(found.roads)} roads, {len(network.nodes)} nodes, {len(network.legs)} legs",
    )
    return OsmPlannerService(contexts, network)
