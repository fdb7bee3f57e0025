"""Planning for ground vehicles: by the OsmPlannerService only, along roads."""

from __future__ import annotations

from cratous.services.loading.ground import CONFIGURATION
from cratous.services.pipeline.source import Known

ROADS = "OsmPlannerService"


def is_ground(world: Known, vehicle: int) -> bool:
    """Whether a vehicle is known to be a ground vehicle."""
    return type(world.get("configuration", vehicle)).__name__ == CONFIGURATION
