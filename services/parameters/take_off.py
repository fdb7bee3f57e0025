"""The parameters of a take-off, for a vehicle that starts on the ground."""

from __future__ import annotations

from collections.abc import Iterator

from cratous.services.mission.landing import BRAKING_M_S2, MAX_ACCELERATION_M_S2
from cratous.services.mission.take_off import USED, roll_m, silence_ms, take_off_ms
from cratous.services.parameters.parameter import DERIVED, Parameter
from cratous.spec.mission import GroundedVehicle, Mission, Vehicle


def take_off_rows(mission: Mission, vehicle: Vehicle) -> Iterator[Parameter]:
    """The parameters of a vehicle's take-off; none for a vehicle that starts in the air."""
    if not isinstance(vehicle, GroundedVehicle):
        return
    speed, faster = vehicle.min_speed_m_s, MAX_ACCELERATION_M_S2
    stop_m, beat_ms = speed * speed / (2 * BRAKING_M_S2), mission.simulation.heartbeat_ms
    whole_s = take_off_ms(vehicle, faster, beat_ms) / 1000
    for name, value, unit, how in (
        ("take-off speed", speed, "m/s", "min_speed_m_s: on the way up too"),
        ("take-off roll", roll_m(0.0, speed, faster), "m",
         f"take-off speed^2 / (2 x {faster:g} m/s^2)"),
        ("room to stop", stop_m, "m", f"take-off speed^2 / (2 x {BRAKING_M_S2:g} m/s^2), beyond it"),
        ("way up", USED * vehicle.max_climb_m_s, "m/s", f"{USED:g} x max_climb_m_s"),
        ("take-off", whole_s, "s", "roll and climb to its position, and four heartbeats"),
        ("silence on the ground", silence_ms(mission) / 1000, "s",
         "link_loss.after_s, else 2 s: after it nobody rolls"),
    ):  # fmt: skip
        yield Parameter(name, vehicle.id, value, unit, None, None, None, DERIVED, how)
