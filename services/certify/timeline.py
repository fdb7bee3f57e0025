"""What happened, read from the message log alone: tracks, authority, phases, takeovers, events.

Every fact in the report's flight part comes from here, so that a second program can derive it again
from the same log.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from cratous.services.certify.alerts import TOPIC, AlertReader
from cratous.services.certify.modes import note
from cratous.services.logs.entry import Entry
from cratous.services.logs.log import Row
from cratous.spec.errors import BadInput

TRACK_PERIOD_MS = 1000
STATUS, REFUSED_PEER = "afrl.cmasi.ServiceStatus", "refused "
"""Topic and prefix of the message about a refused peer."""
FOOTPRINT_PERIOD_MS = 2000
FEW = 80
PHASES = ("Planned", "Transit", "Waiting", "Active", "Suspended", "Complete", "Failed")
OWNERS = ("UxAS", "ICAROUS")
AUTHORITY, TASK, PLAN, END, OTHER = "authority", "task", "plan", "end", "other"
_WHOLE = "(0|[1-9][0-9]{0,17})"
_DECIMAL = r"(-?(?:0|[1-9][0-9]*)\.[0-9]+(?:e[+-]?[0-9]+)?)"
TRUTH = re.compile(
    rf'\{{"\$type":"CRATOUS/TruthState","VehicleID":{_WHOLE},"Time":{_WHOLE},"North":{_DECIMAL},'
    rf'"East":{_DECIMAL},"Altitude":{_DECIMAL},"VelocityNorth":{_DECIMAL},"VelocityEast":{_DECIMAL},'
    rf'"VelocityDown":{_DECIMAL},"Heading":{_DECIMAL},"Cooperative":(?:true|false)\}}'
)
"""A whole TruthState in the usual spelling; any other spelling is parsed as general JSON."""


@dataclass
class Flight:
    """The flight as read so far; times in ms after mission start, positions in the mission frame."""

    tracks: dict[int, list[list[float]]] = field(default_factory=dict)
    authority: list[dict[str, Any]] = field(default_factory=list)
    phases: list[dict[str, Any]] = field(default_factory=list)
    in_phase: list[dict[str, Any]] = field(default_factory=list)
    """Further reports on a task that did not change its phase."""
    takeovers: list[dict[str, Any]] = field(default_factory=list)
    modes: list[dict[str, Any]] = field(default_factory=list)
    """Changes of the decision logic, for `services.certify.modes.spans`."""
    alerts: list[dict[str, Any]] = field(default_factory=list)
    """Detect-and-avoid alerts: ownship, intruder, time span, highest level, least time to violation."""
    events: list[dict[str, Any]] = field(default_factory=list)
    event_kinds: list[str] = field(default_factory=list)
    """Kind of each event: AUTHORITY, TASK, PLAN or END, which other lists contain too, or OTHER."""
    changes: list[dict[str, Any]] = field(default_factory=list)
    footprints: dict[int, list[dict[str, Any]]] = field(default_factory=dict)
    """By task: time, vehicle and corners (latitude, longitude) of some footprints, FEW at most."""
    served: dict[int, dict[str, Any]] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    end_ms: int = 0
    outcome: str = "the log has no end of mission"
    plan_hash: str = ""
    accepted: tuple[int, ...] = ()
    """The tasks of the last plan that was flown, and those done before it."""


def _footprints(flight: Flight, time_ms: int, body: dict[str, Any]) -> None:
    """Keep footprints of the active tasks; of many only every second, fourth, ... one."""
    for payload in body["PayloadStateList"]:
        corners = [(c["Latitude"], c["Longitude"]) for c in payload.get("Footprint") or ()]
        for task in body["AssociatedTasks"] if len(corners) >= 3 else ():
            kept = flight.footprints.setdefault(int(task), [])
            kept.append({"time_ms": time_ms, "vehicle": int(body["ID"]), "corners": corners})
            if len(kept) > 2 * FEW:
                del kept[1::2]


def _name(value: Any, names: tuple[str, ...]) -> str:
    return names[value] if isinstance(value, int) else str(value)


class FlightReader:
    """Reads the messages of a log one at a time; `flight` is the result so far.

    last: newest row of each aircraft, even if it is not in the track.
    """

    def __init__(self, vehicles: Iterable[int]) -> None:
        """vehicles: those of the mission; any other aircraft is traffic."""
        self.flight = Flight()
        self.last: dict[int, list[float]] = {}
        self._owners = dict.fromkeys(vehicles, "UxAS")
        self._open_takeover: dict[int, dict[str, Any]] = {}
        self._alerts = AlertReader()
        self.flight.alerts = self._alerts.found

    def add(self, row: Row | Entry, plain: Any = None) -> None:
        """Process the next message; BadInput if it lacks a field. plain: its decoded body, if it has been read."""
        try:
            self._add(row, plain)
        except KeyError as error:
            where = f"message {row.seq} ({row.topic})"
            raise BadInput("a field is missing", where=where, expected=str(error)) from None

    def _add(self, row: Row | Entry, plain: Any) -> None:
        flight = self.flight
        short = row.topic.rpartition(".")[2]
        flight.counts[row.topic] = flight.counts.get(row.topic, 0) + 1
        flight.end_ms = max(flight.end_ms, row.time_ms)
        due = short == "AirVehicleState" and row.time_ms % FOOTPRINT_PERIOD_MS == 0
        if due and (plain is None or plain.PayloadStateList):
            _footprints(flight, row.time_ms, json.loads(row.body))
        if row.topic == TOPIC:
            self._alerts.add(json.loads(row.body), row.time_ms)
        if row.topic == STATUS:
            _refused(flight, row.time_ms, json.loads(row.body))
        if not row.topic.startswith("cratous."):
            return
        if short == "TruthState":
            self._truth(str(row.body), plain)
            return
        body = json.loads(row.body)
        if short == "AuthorityChange":
            _authority(flight, body, self._owners, self.last, self._open_takeover)
        elif short == "TaskProgress":
            _progress(flight, body)
        elif short == "CognitionState":
            note(flight.modes, body)
        else:
            _event(flight, short, body)

    def _truth(self, text: str, plain: Any) -> None:
        said = None if plain is not None else TRUTH.fullmatch(text)
        if plain is not None:
            number, time_ms = plain.VehicleID, plain.Time
            place = [plain.North, plain.East, plain.Altitude]
        elif said is not None:  # most of a log; a JSON parser takes several times as long
            number, time_ms = int(said[1]), int(said[2])
            place = [float(said[3]), float(said[4]), float(said[5])]
        else:
            body = json.loads(text)
            number, time_ms = int(body["VehicleID"]), int(body["Time"])
            place = [body["North"], body["East"], body["Altitude"]]
        owner = OWNERS.index(self._owners.get(number, "UxAS"))
        point = [time_ms, round(place[0], 1), round(place[1], 1), round(place[2], 1), owner]
        track = self.flight.tracks.setdefault(number, [])
        # the same instants for every vehicle, so that distances can be computed from two tracks
        due = not track or time_ms // TRACK_PERIOD_MS != track[-1][0] // TRACK_PERIOD_MS
        if due or track[-1][4] != owner:
            track.append(point)
        self.last[number] = point

    def finish(self) -> Flight:
        """The flight, with the newest row of each aircraft appended to its track."""
        for number, point in self.last.items():
            track = self.flight.tracks[number]
            if track[-1] is not point:
                track.append(point)
        return self.flight


def read_flight(rows: Iterable[Row | Entry], vehicles: Iterable[int]) -> Flight:
    """The flight data of a log; `vehicles` are those of the mission, any other aircraft is traffic."""
    reader = FlightReader(vehicles)
    for row in rows:
        reader.add(row)
    return reader.finish()


def _authority(
    flight: Flight,
    body: dict[str, Any],
    owners: dict[int, str],
    last: dict[int, list[float]],
    opened: dict[int, dict[str, Any]],
) -> None:
    number, time_ms = int(body["VehicleID"]), int(body["Time"])
    owner = _name(body["Owner"], OWNERS)
    before = owners.get(number, "UxAS")
    intruder = int(body.get("IntruderID", 0))
    flight.authority.append(
        {
            "vehicle": number,
            "time_ms": time_ms,
            "owner": owner,
            "epoch": int(body["Epoch"]),
            "reason": body["Reason"],
            "intruder": intruder,
        }
    )
    owners[number] = owner
    if owner == "ICAROUS" and before != "ICAROUS":
        place = last.get(number, [0, 0.0, 0.0, 0.0, 0])
        opened[number] = {
            "vehicle": number,
            "intruder": intruder,
            "from_ms": time_ms,
            "to_ms": None,
            "north_m": place[1],
            "east_m": place[2],
            "alt_m": place[3],
            "reason": body["Reason"],
        }
        flight.takeovers.append(opened[number])
        against = f" because of {intruder}" if intruder > 0 else ""
        _note(flight, time_ms, number, f"ICAROUS takes over{against}: {body['Reason']}", AUTHORITY)
    elif owner == "UxAS" and before == "ICAROUS":
        if number in opened:
            opened.pop(number)["to_ms"] = time_ms
        _note(flight, time_ms, number, f"handed back to UxAS: {body['Reason']}", AUTHORITY)


def _progress(flight: Flight, body: dict[str, Any]) -> None:
    number, task, time_ms = int(body["VehicleID"]), int(body["TaskID"]), int(body["Time"])
    phase = _name(body["Phase"], PHASES)
    served = float(body["Served"])
    said = {
        "vehicle": number,
        "task": task,
        "phase": phase,
        "time_ms": time_ms,
        "served": served,
        "note": body["Note"],
    }
    for earlier in reversed(flight.phases):
        if earlier["vehicle"] == number:
            if earlier["task"] == task and earlier["phase"] == phase:
                flight.in_phase.append(said)
                if phase == "Failed" and task in flight.served:
                    # it had failed by then; the last reported reason applies
                    flight.served[task]["note"] = body["Note"]
                return
            break
    flight.phases.append(said)
    if phase in ("Complete", "Failed"):
        flight.served[task] = {
            "task": task,
            "vehicle": number,
            "served": served,
            "phase": phase,
            "time_ms": time_ms,
            "note": body["Note"],
        }
    note = f" ({body['Note']})" if body["Note"] else ""
    _note(flight, time_ms, number or None, f"task {task}: {phase.lower()}{note}", TASK)


def _event(flight: Flight, short: str, body: dict[str, Any]) -> None:
    time_ms = int(body.get("Time", 0))
    if short == "MissionEnd":
        flight.outcome, flight.end_ms = str(body["Outcome"]), time_ms
        _note(flight, time_ms, None, f"end of mission: {body['Outcome']}", END)
    elif short == "PlanAccepted":
        flight.plan_hash = str(body["PlanHash"])
        flight.accepted = tuple(body.get("Tasks") or ()) or flight.accepted
        _note(flight, time_ms, None, f"plan accepted, {body['Makespan'] / 1000:.1f} s long", PLAN)
    elif short == "MissionChange":
        _note(flight, time_ms, None, f"{body['What']}: {body['Consequence']}")
        flight.changes.append(
            {"time_ms": time_ms, "what": body["What"], "consequence": body["Consequence"]}
        )
    elif short == "BridgeStatus":
        state = "alive" if body["Alive"] else "silent"
        _note(flight, time_ms, int(body["VehicleID"]), f"bridge {state} {body['Note']}".strip())
    elif short == "LinkLossState":
        _note(flight, time_ms, int(body["VehicleID"]), f"without the link: {body['Reason']}")
    elif short == "FailureState":
        _note(flight, time_ms, int(body["VehicleID"]), f"declared failure: {body['Reason']}")
    elif short == "TakeOffState":
        _note(flight, time_ms, int(body["VehicleID"]), f"take-off: {body['Reason']}")
    elif short == "MergeState":
        _note(flight, time_ms, int(body["VehicleID"]), _merges(body))
    elif short == "CommandDropped":
        text = f"command dropped by the gate: {body['Reason']}"
        _note(flight, time_ms, int(body["VehicleID"]), text)
    elif short == "ModeRefused":
        text = f"mode of ICAROUS refused: {body['Reason']} ({body['Epoch']})"
        _note(flight, time_ms, int(body["VehicleID"]), text)


def _merges(body: dict[str, Any]) -> str:
    """A `MergeState` in words."""
    leader = f"led by {body['Leader']}" if body["Leader"] else "without a leader"
    slot = f", slot {body['Slot'] / 1000:.2f} s" if body["Slot"] >= 0 else ""
    return (
        f"merging: {body['Stage']}, term {body['Term']} {leader}, request {body['Request']}{slot}"
    )


def _refused(flight: Flight, time_ms: int, body: dict[str, Any]) -> None:
    """Record a bridge peer that UxAS's end has refused."""
    said = {pair["Key"]: pair["Value"] for pair in body["Info"]}
    if said.get("reason", "").startswith(REFUSED_PEER):
        _note(flight, time_ms, None, f"bridge: {said['reason']}")


def _note(flight: Flight, time_ms: int, vehicle: int | None, text: str, kind: str = OTHER) -> None:
    flight.event_kinds.append(kind)
    flight.events.append({"time_ms": time_ms, "vehicle": vehicle, "text": text})


BARS = {"Transit": "transit", "Waiting": "wait", "Active": "task", "Suspended": "return"}


def bars(flight: Flight) -> list[dict[str, Any]]:
    """The time line as bars: what each vehicle did, with start and end."""
    found: list[dict[str, Any]] = []
    for k, phase in enumerate(flight.phases):
        if (
            phase["phase"] not in BARS or not phase["vehicle"]
        ):  # an unassigned task is no bar of a vehicle
            continue
        later = (p["time_ms"] for p in flight.phases[k + 1 :] if p["vehicle"] == phase["vehicle"])
        found.append(
            {
                "vehicle": phase["vehicle"],
                "task": phase["task"],
                "what": BARS[phase["phase"]],
                "from_ms": phase["time_ms"],
                "to_ms": next(later, flight.end_ms),
            }
        )
    for takeover in flight.takeovers:
        found.append(
            {
                "vehicle": takeover["vehicle"],
                "task": None,
                "what": "icarous",
                "from_ms": takeover["from_ms"],
                "to_ms": takeover["to_ms"] or flight.end_ms,
            }
        )
    return sorted(found, key=lambda bar: (bar["vehicle"], bar["from_ms"], bar["what"]))
