"""Take-off parameters for a vehicle's ICAROUS, and the check before flight that each vehicle can take off."""

from __future__ import annotations

from functools import partial

from cratous.core.avoidance.drift import NONE
from cratous.core.avoidance.prediction import buffered
from cratous.core.avoidance.resolution import Scene
from cratous.services.flight.dynamics import first_state
from cratous.services.flight.landing_reach import at_start
from cratous.services.icarous.take_off import NO_WAY, first_way_up, why_forbidden
from cratous.services.loading.polygons import hard_zones
from cratous.services.mission.take_off import TakeOff, grounded, silence_ms
from cratous.spec.errors import BadInput
from cratous.spec.mission import GroundedVehicle, Mission


def take_off(mission: Mission, vehicle_id: int) -> TakeOff | None:
    """The take-off parameters of one vehicle, None if it starts in the air."""
    waiting = [one.id for one in grounded(mission)]
    if vehicle_id not in waiting:
        return None
    alt_m = mission.vehicle(vehicle_id).position.alt_m
    return TakeOff(alt_m, silence_ms(mission), waiting.index(vehicle_id), len(waiting))


def require_take_offs(mission: Mission) -> None:
    """BadInput where a vehicle on the ground could not take off, given the zones known then and no other
    traffic.
    """
    for vehicle in grounded(mission):
        if vehicle.id in mission.instances and (why := _why_not(mission, vehicle)):
            k = mission.vehicles.index(vehicle)
            raise BadInput(
                f"vehicle {vehicle.id} cannot take off",
                where=mission.source,
                item=f"vehicles[{k}].start",
                expected="a way up from where it stands, in the direction of heading_deg, clear of the zones",
                got=why,
            )


def _why_not(mission: Mission, vehicle: GroundedVehicle) -> str:
    """Why no climb-out is permitted; "" if one is."""
    plan, daa, zones = take_off(mission, vehicle.id), mission.daa, hard_zones(mission.zones)
    sensed = at_start(mission, vehicle, first_state(vehicle))._replace(on_ground=True)
    volume = buffered(daa.well_clear, daa.buffer)
    scene = Scene((), zones, volume, daa.lookahead_s, NONE.here, daa.looks_first)
    beat_s = mission.simulation.heartbeat_ms / 1000
    by = partial(why_forbidden, sensed=sensed, scene=scene, daa=daa, beat_s=beat_s)
    return NO_WAY if plan is None else first_way_up(plan, sensed, by)[1]
