"""Sensor-based knowledge of aircraft: the own state by GPS, others by ADS-B and radar.

The sensors are those of missions (`services.sensing`), with errors, latency and drop-outs. A measurement of
another aircraft is published as an EntityPerception when it arrives: with the other's id by ADS-B, without
one (0) by radar, without payloads, and with the standard deviations of its errors. With a GPS an aircraft's
state reports its estimated position. It steers by its true state.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, degrees, hypot
from typing import Any

from cratous.bridge import lmcp
from cratous.services.mission.frames import Projection
from cratous.services.sensing import vehicle_sensors
from cratous.services.sensing.filter import Flown
from cratous.services.sensing.sensors import Detection
from cratous.services.sensing.vehicle_sensors import Carried, Sensors
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.perception import MOST_ID
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame, Position, Velocity
from cratous.spec.mission.sensing import Sensing

LEAST_PERIOD_MS = 40
"""The simulator's longest step, on ticks of 10 ms."""
FARTHEST_M = 2_000_000.0
"""Largest distance from where the first aircraft began [m]: there a range in its frame is too long by up to 2
%.
"""


class Sensed:
    """The sensors of all aircraft of a world."""

    def __init__(self, sensing: Sensing) -> None:
        self.sensing = sensing
        self._carried: dict[int, Carried] = {}
        self._projection: Projection | None = None
        self._now_ms: int | None = None

    def step(self, now_ms: int, aircraft: Mapping[int, Motion]) -> list[Any]:
        """Measure at a step, and process what has arrived by now. Returns the EntityPerceptions.

        BadInput for an aircraft too far from the first one for a common frame.
        """
        flown = {key: self._flown(key, motion) for key, motion in aircraft.items()}
        last_ms = now_ms - LEAST_PERIOD_MS if self._now_ms is None else self._now_ms
        step_ms, self._now_ms = now_ms - last_ms, now_ms
        self._carried = {key: self._carried.get(key, Carried()) for key in flown}
        told: list[Any] = []
        for key, before in self._carried.items():
            sensors = Sensors(key, self.sensing, 0, step_ms)
            after = vehicle_sensors.stepped(sensors, before, now_ms, flown)
            self._carried[key], others = vehicle_sensors.came(key, after, now_ms)
            if 0 < key <= MOST_ID:
                told += [self._perception(key, one) for one in others]
        return told

    def own(self, body: Any) -> Any:
        """An AirVehicleState as the aircraft knows itself; unchanged without a GPS."""
        known = self._carried.get(body.ID, Carried()).own
        if known is None:
            return body
        (north, east, alt_m), v = known.estimate.position, known.estimate.velocity
        return body.copy(
            Location=self._location(north, east, alt_m),
            Groundspeed=hypot(v.north_m_s, v.east_m_s),
            Course=degrees(atan2(v.east_m_s, v.north_m_s)),
            VerticalSpeed=-v.down_m_s,
        )

    def _flown(self, key: int, m: Motion) -> Flown:
        lat_deg, lon_deg = degrees(m.lat_rad), degrees(m.lon_rad)
        if self._projection is None:
            self._projection = Projection(Frame(lat_deg, lon_deg))
        north, east = self._projection.to_local(lat_deg, lon_deg)
        if not hypot(north, east) <= FARTHEST_M:
            first = self._projection.frame
            raise BadInput(
                "an aircraft too far from the first one for sensors",
                item=f"AirVehicleState {key}",
                expected=f"within {FARTHEST_M / 1000:g} km of {first.latitude_deg:.5f}, "
                f"{first.longitude_deg:.5f}",
                got=f"{lat_deg:.5f}, {lon_deg:.5f}",
            )
        return Flown(
            Position(north, east, m.alt_m), Velocity(m.north_m_s, m.east_m_s, -m.climb_m_s)
        )

    def _location(self, north_m: float, east_m: float, alt_m: float) -> Any:
        assert self._projection is not None
        lat, lon = self._projection.to_geodetic(north_m, east_m)
        return lmcp.new(
            "Location3D", Latitude=lat, Longitude=lon, Altitude=alt_m, AltitudeType="MSL"
        )

    def _perception(self, perceiver: int, one: Detection) -> Any:
        sensor, v = self.sensing.sensors[one.sensor], one.seen.velocity
        wide, high, fast = sensor.horizontal_m, sensor.vertical_m, sensor.velocity_m_s
        return lmcp.new(
            "EntityPerception",
            PerceivedEntityID=one.name if 0 < one.name <= MOST_ID else 0,
            PerceiverID=perceiver,
            Velocity=list(v),
            VelocityError=[fast, fast, fast],
            VelocityValid=True,
            Location=self._location(*one.seen.position),
            LocationError=[wide, wide, high],
            TimeLastSeen=one.seen.at_ms,
        )
