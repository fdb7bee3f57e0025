"""Display data of a CRATOUS flight, from its mission and its messages, processed one at a time."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.timeliness import in_time
from cratous.services.certify.timeline import Flight, FlightReader
from cratous.services.ground_station.bands import Bands
from cratous.services.ground_station.shapes import Shapes
from cratous.services.logs.entry import Entry, any_data, to_text
from cratous.services.logs.log import Row
from cratous.services.logs.records import to_data
from cratous.services.mission.frames import Projection
from cratous.services.mission.ground import floor_of
from cratous.spec.mission import Mission
from cratous.spec.mission.changes import VEHICLE_LOST, without_vehicles

READ_BY_FLIGHT = "cratous."
"""Prefix of the message types of CRATOUS flights."""
HEARTBEAT, GATED = "cratous.Heartbeat", "cratous.GatedCommand"
LINK, STATE = "cratous.BridgeStatus", "afrl.cmasi.AirVehicleState"


class FlownRecording:
    """Processes the messages of a flight in order."""

    def __init__(self, mission: Mission) -> None:
        self._last: Entry | None = None
        self._mission, self._plain = mission, to_data(mission)
        self._to_local = Projection(mission.frame).to_local
        self.shapes, self.links, self.bands = Shapes(self._to_local), Links(), Bands()
        self.reader = FlightReader(vehicle.id for vehicle in mission.vehicles)

    def add(self, entry: Entry) -> None:
        """Process the next message. Raises LookupError, TypeError or ValueError if it lacks something."""
        self._last = entry
        topic = entry.topic
        if topic == HEARTBEAT:
            return
        if topic == LINK:
            self.links.add(entry)
        if (topic == GATED or not topic.startswith(READ_BY_FLIGHT)) and topic != STATE:
            self.shapes.add(entry, entry.time_ms)
            self.bands.add(entry, entry.time_ms)
            return
        body = entry.body if isinstance(entry.body, str) else to_text(entry)
        self.reader.add(Row(entry.seq, entry.time_ms, entry.source, topic, body))

    @property
    def place(self) -> str:
        """The last message, as named in errors."""
        return "" if self._last is None else self._last.place

    def first(self) -> dict[str, Any]:
        """The data from the mission, without the flight."""
        plain = self._plain
        zones = [{**zone, "from_ms": 0} for zone in plain["zones"]]
        zones += [
            {**c["zone"], "from_ms": c["at_ms"]} for c in plain.get("changes", ()) if c.get("zone")
        ]
        ends = {c["zone_id"]: c["at_ms"] for c in plain.get("changes", ()) if "zone_id" in c}
        zones = [{**zone, "to_ms": ends.get(zone["id"])} for zone in zones]
        return {
            "name": self._mission.name,
            "source": "mission",
            "frame": plain["frame"],
            "floor_m": floor_of(self._mission),
            "vehicles": [_ours(vehicle) for vehicle in plain["vehicles"]],
            "volume": plain["daa"]["well_clear"],
            "tasks": [_task(task) for task in plain["tasks"]],
            "zones": zones,
            "absences": _absences(self._mission),
        }

    def whole(self) -> dict[str, Any]:
        """The complete data, after the last message."""
        flight = self.reader.finish()
        return {
            **self.first(),
            "end_ms": flight.end_ms,
            "outcome": flight.outcome,
            "routes": self.shapes.routes,
            "tracks": {str(number): track for number, track in sorted(flight.tracks.items())},
            "footprints": self.footprints(),
            "authority": flight.authority,
            "takeovers": flight.takeovers,
            "phases": flight.phases,
            "in_phase": flight.in_phase,
            "links": self.links.found,
            "bands": self.bands.found,
            "events": flight.events,
            "event_kinds": flight.event_kinds,
            "unread": self.unread,
        }

    @property
    def unread(self) -> int:
        """Number of messages whose body could not be decoded, or is invalid."""
        return self.shapes.unread + self.bands.unread

    def footprints(self) -> list[dict[str, Any]]:
        """Sensor footprints so far, in the frame of the page."""
        return _footprints(self.reader.flight, self._to_local)


def _absences(mission: Mission) -> list[dict[str, Any]]:
    """The times [ms] between which a vehicle is absent, and whether it is lost or has not joined yet."""
    instants = sorted({0, *(change.at_ms for change in mission.changes)})
    found: list[dict[str, Any]] = []
    for begin_ms, end_ms in zip(instants, [*instants[1:], None], strict=True):
        for number, change in without_vehicles(mission, begin_ms).items():
            why = "lost" if change.kind == VEHICLE_LOST else "not joined"
            before = next((one for one in reversed(found) if one["vehicle"] == number), None)
            goes_on = before is not None and in_time(before["to_ms"], begin_ms, 0)
            if before is not None and goes_on and before["why"] == why:
                before["to_ms"] = end_ms
                continue
            found.append({"vehicle": number, "from_ms": begin_ms, "to_ms": end_ms, "why": why})
    return found


def _ours(vehicle: dict[str, Any]) -> dict[str, Any]:
    return {key: vehicle[key] for key in ("id", "label", "protected")}


def _task(task: dict[str, Any]) -> dict[str, Any]:
    places = [[place["north_m"], place["east_m"]] for place in task["points"]]
    reach_m = task["radius_m"] or task["extent_m"]
    return {
        "id": task["id"], "label": task["label"], "kind": task["kind"], "points": places,
        "radius_m": reach_m, "closed": task["kind"] == "area_search" and not reach_m,
    }  # fmt: skip


def _footprints(flight: Flight, to_local: Any) -> list[dict[str, Any]]:
    return [
        {
            "task": task,
            "vehicle": one["vehicle"],
            "time_ms": one["time_ms"],
            "corners": [[round(x, 1) for x in to_local(*corner)] for corner in one["corners"]],
        }
        for task, found in sorted(flight.footprints.items())
        for one in found
    ]


class Links:
    """The link events reported by the bridge."""

    def __init__(self) -> None:
        self.found: list[dict[str, Any]] = []

    def add(self, entry: Entry) -> None:
        body, _ = any_data(entry)
        if not isinstance(body, dict):
            return
        self.found.append(
            {
                "time_ms": entry.time_ms,
                "vehicle": body.get("VehicleID"),
                "alive": body.get("Alive") is True,
                "note": str(body.get("Note", "")),
            }
        )
