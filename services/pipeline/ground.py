"""Who plans for vehicles that drive: the OsmPlannerService, along roads, and nobody else."""

from __future__ import annotations

from cratous.services.loading.ground import CONFIGURATION
from cratous.services.pipeline.source import Known

ROADS = "OsmPlannerService"


def is_ground(world: Known, vehicle: int) -> bool:
    """Whether a vehicle is known as one that drives."""
    return type(world.get("configuration", vehicle)).__name__ == CONFIGURATION
