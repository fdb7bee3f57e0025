"""What the tests of roads share: maps, places, vehicles that drive."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pipeline_tools import PIPELINE, Rig

from cratous.bridge import lmcp

ROADS = "OsmPlannerService"
EXAMPLE = Path(__file__).parents[2] / "examples" / "cordon"
MIDDLE = (30.4508, -87.1894)
"""The place of the cordon of OpenUxAS's example, where two streets of the example's map meet."""


def map_text(nodes: Mapping[int, tuple[float, float]], *ways: Sequence[int]) -> str:
    """A map of nodes by id (latitude, longitude), each way a road."""
    said = [f'<node id="{n}" lat="{lat:.9f}" lon="{lon:.9f}"/>' for n, (lat, lon) in nodes.items()]
    for k, way in enumerate(ways):
        refs = "".join(f'<nd ref="{n}"/>' for n in way)
        said.append(f'<way id="{k}">{refs}<tag k="highway" v="track"/></way>')
    return f'<osm version="0.6">{"".join(said)}</osm>'


def at(latitude: float, longitude: float) -> Any:
    return lmcp.new("Location3D", Latitude=latitude, Longitude=longitude)


def car(number: int, latitude: float, longitude: float, speed: float = 8.0) -> list[Any]:
    """Configuration and state of a vehicle that drives."""
    configuration = lmcp.new(
        "GroundVehicleConfiguration", ID=number, NominalSpeed=speed, MaximumSpeed=12.0
    )
    state = lmcp.new("GroundVehicleState", ID=number, Location=at(latitude, longitude))
    return [configuration, state]


def driven(folder: Path, *services: str, roads: str | None = None) -> Rig:
    """A process with the roads of the example, or of a map's text."""
    path = EXAMPLE / "roads.osm"
    if roads is not None:
        path = folder / "roads.osm"
        path.write_text(roads)
    return Rig(folder, *(services or (ROADS, *PIPELINE)), OsmPlannerService=f'OsmFile="{path}"')
