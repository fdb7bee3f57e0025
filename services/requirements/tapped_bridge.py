"""Messages reconstructed from bridge lines, by a tap on a CRATOUS bridge: positions, authority,
heartbeats, commands.

They equal those of a log, with the fields that the lines contain: missing fields are absent, never
zero. A SETMOD states who should have the vehicle; only the gate knows whether that is so. Times are
those at which a line passed, [ms] since the first connection.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import zmq

from cratous.bridge.passive_decoder import KeyOf, Overheard, Said
from cratous.bridge.port import Report, Tally, is_due
from cratous.bridge.relay import BARRED, CLOSED, FAR, LOST, NEAR, OPENED
from cratous.bridge.tap import Copied, Tap
from cratous.bridge.text_protocol import (
    Direction,
    Heartbeat,
    OwnPosition,
    SetMode,
    SetPosition,
    SetVelocity,
    Traffic,
    WireError,
)
from cratous.services.logs.entry import Entry
from cratous.services.mission.frames import compass
from cratous.services.requirements.sampling import UNAUTHENTICATED
from cratous.services.requirements.specification import Signal
from cratous.spec.errors import BadInput

POLL_S = 0.1
REST_S = 1.0
"""How long lines received before the end are still processed [s]."""
STATE = ("ID", "Time", "Groundspeed", "Course", "VerticalSpeed")
FIELDS: dict[str, tuple[str, ...]] = {
    "afrl.cmasi.AirVehicleState": (
        *STATE,
        *(f"Location.{one}" for one in ("Latitude", "Longitude", "Altitude")),
    ),
    "cratous.Heartbeat": ("VehicleID", "Time", "Direction", "Sequence"),
    "cratous.AuthorityChange": ("VehicleID", "Owner", "Epoch", "Reason"),
    "cratous.GatedCommand": (
        "VehicleID",
        "Epoch",
        "Sender",
        *(f"Command.VehicleActionList.0.{one}" for one in ("Speed", "Heading", "ClimbRate")),
        *(
            f"Command.VehicleActionList.0.Location.{one}"
            for one in ("Latitude", "Longitude", "Altitude")
        ),
    ),
    "cratous.BridgeStatus": ("VehicleID", "Alive", "Note"),
}
"""Fields that lines contain, by message type."""
Body = tuple[str, dict[str, Any]]


def refuse_untold(wanted: Mapping[str, Signal]) -> None:
    """BadInput for a signal that no line of the bridge contains."""
    for name, signal in wanted.items():
        mine = (t for t in FIELDS if t == signal.message or t.endswith(f".{signal.message}"))
        topic = next(mine, "")
        if not topic:
            types = ", ".join(one.rpartition(".")[2] for one in FIELDS)
            raise BadInput(
                "no line of the bridge gives this message", item=name, expected=types,
                got=signal.message,
            )  # fmt: skip
        for field in (signal.field, *(one for one, _ in signal.chosen)):
            if field not in FIELDS[topic]:
                raise BadInput(
                    "no line of the bridge tells this field", item=f"{name}: {signal.message}",
                    expected=", ".join(FIELDS[topic]), got=field,
                )  # fmt: skip


class Tapped:
    """The messages of a tap; `find(kind)` is called with what was missed or cannot be decoded."""

    def __init__(
        self, tap: Tap, key_of: KeyOf, report: Report, find: Callable[[str, int], None]
    ) -> None:
        self._tap, self._key_of, self._find, self._report = tap, key_of, find, report
        self._tally = Tally("tap", report)
        self._heard: dict[int, Overheard] = {}
        self._epochs: dict[int, int | None] = {}
        self._beats: dict[int, int] = {}
        self._own: set[int] = set()
        """Vehicles whose own positions were received: positions sent to others repeat them later."""
        self._told: set[int] = set()
        self._begun_ns: int | None = None
        self.seq = 0

    def left(self) -> list[str]:
        """What remains running after the watch, in words."""
        count, pid = len(self._heard), self._tap.process.pid
        if not (count and self._tap.stands):
            return []
        what = "1 connection goes" if count == 1 else f"{count} connections go"
        return [f"tap: {what} on through process {pid}, until the two ends end it"]

    def now_ms(self) -> int:
        """Time since the first connection [ms], 0 before."""
        return 0 if self._begun_ns is None else self._since(time.monotonic_ns())

    def _since(self, time_ns: int) -> int:
        return 0 if self._begun_ns is None else max(0, (time_ns - self._begun_ns) // 10**6)

    def messages(self, wait_s: float, until: Callable[[int], bool]) -> Iterator[Entry]:
        """The messages until `until(ms)` is true; BadInput if nobody connects within wait_s seconds."""
        given_up_s, stands = time.monotonic() + wait_s, True
        try:
            while not until(self.now_ms()):
                self._wait(stands)
                for one in self._tap.step():
                    yield from self._copied(one)
                if self._begun_ns is None and is_due(given_up_s, time.monotonic()):
                    raise BadInput(
                        "no program has connected to the tap", expected="ICAROUS, or UxAS"
                    )
                if stands and not self._tap.stands:
                    stands = False
                    self._find("cut", self.now_ms() * 10**6)
                    self._report("ERROR", "tap: the relay has ended, and all connections with it")
            yield from self._rest(time.monotonic_ns())
        finally:
            self._tap.close()

    def _wait(self, stands: bool) -> bool:
        """Wait briefly for the relay, if it is running; returns whether data are available."""
        poll = zmq.Poller()
        for handle, flags in self._tap.handles() if stands else ():
            poll.register(handle, flags)
        return bool(poll.poll(int(POLL_S * 1000)))

    def _rest(self, end_ns: int) -> Iterator[Entry]:
        """What has passed before the end; a fault is reported if it is too much to be processed."""
        given_up_s = time.monotonic() + REST_S
        while True:
            # the relay may lag slightly
            comes, records = self._wait(True), list(self._tap.step())
            if not records and not (comes and self._tap.stands):
                return
            for one in records:
                if one.time_ns > end_ns:
                    return
                if is_due(given_up_s, time.monotonic()):
                    self._find("left out", self._since(one.time_ns) * 10**6)
                    return
                yield from self._copied(one)

    def _copied(self, one: Copied) -> Iterator[Entry]:
        if one.kind == OPENED:
            self._begun_ns = one.time_ns if self._begun_ns is None else self._begun_ns
            self._heard[one.connection] = Overheard(self._key_of)
            return
        now_ms = self._since(one.time_ns)
        if one.kind == LOST:
            self._find("left out", now_ms * 10**6)
            self._tally.lose("bytes not looked at", f"{one.lost} bytes came too fast")
            if any(heard.authenticated for heard in self._heard.values()):
                self._find("unsealed", now_ms * 10**6)
            for heard in self._heard.values():
                heard.skip()
            return
        heard = self._heard.get(one.connection, Overheard())
        if one.kind == BARRED:
            self._find("refused", now_ms * 10**6)
            self._tally.refuse("what is not v2 does not pass beyond loopback")
        elif one.kind == CLOSED:
            self._heard.pop(one.connection, None)
            self._told.discard(one.connection)
            if heard.is_open:
                yield self._alive(heard, now_ms, False, "the connection has ended")
        elif one.kind in (NEAR, FAR):
            was_open = heard.is_open
            found = heard.feed(one.kind == NEAR, one.data)
            if heard.is_open and not was_open:
                self._opened(heard, now_ms)
            if heard.is_open and heard.vehicle_id and one.connection not in self._told:
                self._told.add(one.connection)
                yield self._alive(heard, now_ms, True, "connected")
            for said in found:
                yield from self._said(heard, said, now_ms)

    def _opened(self, heard: Overheard, now_ms: int) -> None:
        if not heard.authenticated:
            self._find("unsealed", now_ms * 10**6)
            who = f"vehicle {heard.vehicle_id}" if heard.vehicle_id else "a vehicle"
            why = "the key here is another one" if heard.other_key else "no key is known here"
            self._report("WARN", f"tap: the lines of {who} are not authenticated: {why}")

    def _said(self, heard: Overheard, said: Said, now_ms: int) -> Iterator[Entry]:
        if isinstance(said.record, WireError):
            self._find("refused", now_ms * 10**6)
            self._tally.refuse(said.record.what, str(said.record))
            return
        for topic, body in self._bodies(heard.vehicle_id, said):
            who = "UxAS" if said.direction is Direction.DOWN else "ICAROUS"
            yield self._entry(heard, now_ms, who, topic, body)

    def _bodies(self, vehicle: int, said: Said) -> Iterable[Body]:
        match said.record:
            case OwnPosition() as at:
                self._own.add(vehicle)
                self._beats[vehicle] = self._beats.get(vehicle, 0) + 1
                beat = _beat(vehicle, at.time_s, "Down", self._beats[vehicle])
                place = (at.lat_deg, at.long_deg, at.alt_abs_m)
                return [_state(vehicle, at, place, at.time_s), beat]
            case Traffic(what="TRAFFIC") as at if at.index not in self._own:
                return [_state(at.index, at, (at.lat_deg, at.long_deg, at.alt_m))]
            case Heartbeat(sequence, time_s):
                return [_beat(vehicle, time_s, "Up", sequence)]
            case SetMode(mode, epoch):
                self._epochs[vehicle] = epoch
                owner = "ICAROUS" if mode == "ACTIVE" else "UxAS"
                body = {"VehicleID": vehicle, "Owner": owner, "Epoch": epoch, "Reason": "SETMOD"}
                return [("cratous.AuthorityChange", body)]
            case SetVelocity(north, east, down):
                action = {"Speed": math.hypot(north, east), "ClimbRate": -down}
                if north or east:
                    action["Heading"] = compass(math.atan2(east, north))
                return [self._command(vehicle, action)]
            case SetPosition(lat, long, alt):
                return [self._command(vehicle, {"Location": _location((lat, long, alt))})]
        return []

    def _command(self, vehicle: int, action: dict[str, Any]) -> Body:
        body = {"VehicleActionList": [action]}
        epoch = self._epochs.get(vehicle)
        return "cratous.GatedCommand", {
            "VehicleID": vehicle, "Epoch": epoch, "Sender": "ICAROUS", "Command": body,
        }  # fmt: skip

    def _alive(self, heard: Overheard, now_ms: int, alive: bool, note: str) -> Entry:
        body = {"VehicleID": heard.vehicle_id, "Alive": alive, "Note": note}
        return self._entry(heard, now_ms, "tap", "cratous.BridgeStatus", body)

    def _entry(
        self, heard: Overheard, now_ms: int, who: str, topic: str, body: dict[str, Any]
    ) -> Entry:
        seq, self.seq = self.seq, self.seq + 1
        source = who if heard.authenticated else f"{who}, {UNAUTHENTICATED}"
        return Entry(seq, now_ms, source, topic, json.dumps(body, separators=(",", ":")))


def _location(place: tuple[float, float, float]) -> dict[str, float]:
    return dict(zip(("Latitude", "Longitude", "Altitude"), place, strict=True))


def _state(
    vehicle: int,
    at: OwnPosition | Traffic,
    place: tuple[float, float, float],
    time_s: float | None = None,
) -> Body:
    body: dict[str, Any] = {
        "ID": vehicle,
        "Location": _location(place),
        "Groundspeed": math.hypot(at.north_mps, at.east_mps),
        "Course": compass(math.atan2(at.east_mps, at.north_mps)),
        "VerticalSpeed": -at.down_mps,
        "Time": None if time_s is None else round(1000 * time_s),
    }
    return "afrl.cmasi.AirVehicleState", body


def _beat(vehicle: int, time_s: float, way: str, sequence: int) -> Body:
    time_ms = round(1000 * time_s)
    body = {"VehicleID": vehicle, "Time": time_ms, "Direction": way, "Sequence": sequence}
    return "cratous.Heartbeat", body
