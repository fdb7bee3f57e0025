"""The parameters of a landing without the link, for a vehicle that may land."""

from __future__ import annotations

from collections.abc import Iterator

from cratous.core.avoidance.drift import NONE
from cratous.services.icarous.landing import EVEN
from cratous.services.mission.ground import floor_of
from cratous.services.mission.landing import (
    BRAKING_M_S2,
    STEEP,
    own_bounds,
    sites_of,
    touches_off_m,
)
from cratous.services.parameters.parameter import DERIVED, Parameter
from cratous.spec.mission import Mission, Vehicle


def landing_rows(mission: Mission, vehicle: Vehicle) -> Iterator[Parameter]:
    """The parameters of a vehicle's landing; none without a landing site."""
    if not sites_of(mission):
        return
    speed, climb = vehicle.min_speed_m_s, vehicle.max_climb_m_s
    gate_m, sensed = floor_of(mission), own_bounds(mission) != NONE.here
    off = " + what the bounds of the own position move it" if sensed else ""
    roll_m = speed * speed / (2 * BRAKING_M_S2)
    for name, value, unit, how in (
        ("landing speed", speed, "m/s", "min_speed_m_s: on the way there too"),
        ("landing roll", roll_m, "m", f"landing speed^2 / (2 x {BRAKING_M_S2:g} m/s^2)"),
        ("least site", roll_m / 2 + touches_off_m(mission, vehicle), "m",
         f"landing roll / 2 + landing speed x heartbeat_ms{off}: the least radius_m"),
        ("landing gate", gate_m, "m", "floor: there the last descent begins, where the ground is lower"),
        ("last descent", STEEP * climb, "m/s", f"{STEEP:g} x max_climb_m_s"),
        ("way down", EVEN * climb, "m/s", f"{EVEN:g} x max_climb_m_s at most"),
    ):  # fmt: skip
        yield Parameter(name, vehicle.id, value, unit, None, None, None, DERIVED, how)
