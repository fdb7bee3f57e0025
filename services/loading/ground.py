"""Ground vehicles: GroundVehicleConfiguration and GroundVehicleState as a vehicle of a mission.

Only `cratous uxas` plans them, along roads. Everything that concerns aircraft ignores them.
"""

from __future__ import annotations

from math import isfinite, radians

from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import heading, no_vehicle, point, vehicle
from cratous.spec.errors import BadInput
from cratous.spec.mission import Vehicle

CONFIGURATION, STATE = "GroundVehicleConfiguration", "GroundVehicleState"
TURNS_RAD = radians(80.0)
"""Equivalent bank angle [rad] that gives a ground vehicle a nearly zero turn radius."""


class GroundVehicle(Vehicle):
    """A ground vehicle on roads, at the altitude of the terrain."""


def drives(one: Vehicle) -> bool:
    """Whether a vehicle is a ground vehicle."""
    return isinstance(one, GroundVehicle)


def vehicle_of(configuration: Sent, state: Sent, places: Places, notes: list[str]) -> Vehicle:
    """The aircraft or ground vehicle of a matching configuration and state; BadInput if they are invalid."""
    ground = type(configuration.body).__name__ == CONFIGURATION
    if (type(state.body).__name__ == STATE) != ground:
        raise BadInput(
            f"the state of vehicle {state.body.ID} is of another kind of vehicle",
            where=state.where,
            item=f"entity {state.body.ID}",
            expected=STATE if ground else "AirVehicleState",
            got=type(state.body).__name__,
        )
    if ground:
        return _ground_vehicle(configuration, state, places)
    return vehicle(configuration, state, places, notes)


def _ground_vehicle(configuration: Sent, state: Sent, places: Places) -> GroundVehicle:
    body = configuration.body
    speed = float(body.NominalSpeed)
    if not isfinite(speed) or speed <= 0:
        what, expected = "does not drive", "more than 0 m/s"
        raise no_vehicle(configuration, "NominalSpeed", what, expected, f"{speed:g}")
    position = point(state.body.Location, places, state, "Location")
    return GroundVehicle(
        id=body.ID,
        label=body.Label or f"vehicle {body.ID}",
        position=position._replace(alt_m=places.terrain_m),
        heading_rad=heading(state.body.Heading, state.where, "Heading"),
        speed_m_s=speed,
        min_speed_m_s=float(body.MinimumSpeed),
        max_speed_m_s=float(body.MaximumSpeed),
        max_bank_rad=TURNS_RAD,
        max_climb_m_s=0.0,
        protected=False,
    )
