"""Explains lines of the text protocol: one English sentence per message, and the packet around it in v2."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

from cratous.bridge.text_protocol import messages as m
from cratous.bridge.text_protocol.authenticated_lines import crc_of
from cratous.bridge.text_protocol.dialects import Dialect, has_label_after_tag
from cratous.bridge.text_protocol.handshake import ACCEPT, HELLO, SECRET_LENGTH, is_secret
from cratous.bridge.text_protocol.layouts import WIDE_LIMITS
from cratous.bridge.text_protocol.messages import Direction, Message
from cratous.bridge.text_protocol.parser import StreamParser, WireError


def _place(line: Any, stem: str = "") -> str:
    lat, long = getattr(line, f"{stem}lat_deg"), getattr(line, f"{stem}long_deg")
    return f"{abs(lat):.6f} {'SN'[lat >= 0]}, {abs(long):.6f} {'WE'[long >= 0]}"


def _velocity(line: Any) -> str:
    north, east, down = line.north_mps, line.east_mps, line.down_mps
    text = f"{math.hypot(north, east):.1f} m/s"
    if north or east:
        text += f" on {math.degrees(math.atan2(east, north)) % 360:.0f} deg"
    return text + (f", climbing {-down:.1f} m/s" if down else "")


def _mode(line: m.SetMode) -> str:
    what = "takes the vehicle" if line.mode == "ACTIVE" else "offers the vehicle back"
    epoch = "" if line.epoch is None else f", epoch {line.epoch}"
    onto = "" if line.request is None else f", onto UxAS's answer to request {line.request}"
    return f"ICAROUS {what}{epoch}{onto}"


def _reset(line: m.SoftReset) -> str:
    if line.lat_deg is None:
        return "forget the waypoints: a plan follows"
    return f"the path is resumed at {_place(line)}, {line.alt_m:.0f} m"


def _steer(line: m.SetVelocity) -> str:
    if not (line.north_mps or line.east_mps):
        return "ICAROUS steers: stay here"
    return f"ICAROUS steers: {_velocity(line)}"


def _another(line: m.WayOfAnother) -> str:
    if not line.total:
        return f"vehicle {line.vehicle_id} flies no way that is known"
    number = f"waypoint {line.index} (from 0) of {line.total}"
    return f"vehicle {line.vehicle_id} flies by {number}, {_place(line)}, {line.alt_m:.0f} m"


def _asks(line: m.RouteRequest) -> str:
    number = "" if line.request is None else f" (request {line.request})"
    ends = f"from {_place(line, 'start_')} to {_place(line, 'end_')}"
    return f"a way is wanted, planner {line.planner}, {ends}{number}"


def _again(line: m.LinesMissing) -> str:
    which = "the plan" if line.what == "WAYPT" else f"zone {line.number}"
    return f"lines {line.first} to {line.last} of {which} have not come: again, please"


def _own(line: m.OwnPosition) -> str:
    who = f"vehicle {line.vehicle_id}" if line.vehicle_id else "the vehicle"
    at = f"{_place(line)}, {line.alt_abs_m:.0f} m"
    return f"at {line.time_s:.3f} s {who} is at {at}, flying {_velocity(line)}"


def _vertex(line: m.FenceVertex) -> str:
    kind = "stay inside" if line.fence == "KEEPIN" else "stay outside"
    heights = f"{line.floor_m:.0f} to {line.ceiling_m:.0f} m"
    return f"zone {line.zone} ({kind}, {heights}): vertex {line.vertex} of {line.total}, {_place(line)}"


_SAYS: dict[type[Message], Callable[[Any], str]] = {
    m.Waypoint: lambda x: (
        f"waypoint {x.index} (from 0) of {x.total}: {_place(x)}, {x.alt_m:.0f} m, {x.speed_mps:.1f} m/s"
    ),
    m.FenceVertex: _vertex,
    m.FenceDone: lambda x: f"zone{'' if x.zone is None else f' {x.zone}'} is complete",
    m.StartMission: lambda _: "the plan is complete: it is flown",
    m.SoftReset: _reset,
    m.HardReset: lambda _: "forget plan and zones",
    m.ForgetFences: lambda _: "forget all zones",
    m.ForgetWaypoints: lambda _: "forget the plan",
    m.StopMission: lambda _: "the mission is over",
    m.UxasPlans: lambda _: "UxAS plans live: ICAROUS may ask it for ways",
    m.IcarousPlans: lambda _: "ICAROUS plans live itself",
    m.OwnPosition: _own,
    m.Attitude: lambda x: f"roll {x.roll_deg:.1f} deg, pitch {x.pitch_deg:.1f} deg",
    m.Traffic: lambda x: (
        f"{x.what.lower()} {x.index} is at {_place(x)}, {x.alt_m:.0f} m, flying {_velocity(x)}"
    ),
    m.WaypointReached: lambda x: f"waypoint {x.index} (from 0) is reached",
    m.WayOfAnother: _another,
    m.VelocityOfAnother: lambda x: f"vehicle {x.vehicle_id} is steered to {_velocity(x)}",
    m.RouteRequest: _asks,
    m.EpochTold: lambda x: f"epoch {x.epoch} was given, {x.owner} has the vehicle",
    m.SetMode: _mode,
    m.SetVelocity: _steer,
    m.SetPosition: lambda x: f"ICAROUS steers: go to {_place(x)}, {x.alt_m:.0f} m, and stay",
    m.GoToWaypoint: lambda x: f"ICAROUS steers: go on with waypoint {x.index} (from 0)",
    m.RouteStart: lambda _: "a way follows",
    m.RoutePoint: lambda x: f"a point of the way: {_place(x)}, {x.alt_m:.0f} m",
    m.RouteEnd: lambda _: "the way is complete",
    m.Heartbeat: lambda x: f"ICAROUS is alive: heartbeat {x.sequence} at {x.time_s:.3f} s",
    m.Hello: lambda x: f"ICAROUS speaks for vehicle {x.vehicle_id}",
    m.LinesMissing: _again,
    m.NotKnown: lambda x: f"ICAROUS does not know the command {x.kind}",
}


def sentence(line: Message) -> str:
    """One message as an English sentence, with units."""
    return _SAYS[type(line)](line)


_PACKET = re.compile(rb"(\d{1,18}),(\d{1,18}),(\d{1,18}),(\d{1,18}),([0-9a-f]{8}),[0-9a-f]{64},")
_DATAGRAM = re.compile(
    rb"(CRATOUS-2D,[0-9a-f]{16},(\d{1,18}),(\d{1,18}),(\d{1,18}),[-+0-9a-f]+),([0-9a-f]{8}),[0-9a-f]{64},"
)
_OPENING = {
    HELLO: "UxAS opens the connection",
    ACCEPT: "UxAS accepts",
    b"CRATOUS-2,": "opening of v2: a nonce, and from ICAROUS its proof that it has the key",
    b"ok,": "UxAS proves that it has the key: both are authenticated",
    b"error": "the connection is refused",
}


def told(text: bytes) -> tuple[bool, str]:
    """(valid, explanation) of a captured line without its newline; secrets are not shown."""
    text = text.removesuffix(b"\r")
    if len(text) == SECRET_LENGTH and is_secret(text.decode("ascii", "replace")):
        return True, "ICAROUS says the secret of the handshake"  # which is not shown
    for begins, words in _OPENING.items():
        if text.startswith(begins):
            more = text.removeprefix(b"error,").decode("ascii", "replace")
            return True, f"{words}: {more[:80]}" if begins == b"error" else words
    packet, datagram = _PACKET.match(text), _DATAGRAM.match(text)
    if packet is not None:
        number, time_ms, vehicle, ack = map(int, packet.groups()[:4])
        head, crc, body = b",".join(packet.groups()[:4]), packet[5], text[packet.end() :]
        what = f"packet {number} of vehicle {vehicle} at {time_ms} ms, after {ack} of the other end"
    elif datagram is not None:
        number, time_ms, vehicle = map(int, datagram.groups()[1:4])
        head, crc, body = datagram[1], datagram[5], text[datagram.end() :]
        what = f"datagram {number} of vehicle {vehicle} at {time_ms} ms"
    else:
        return _line(text)
    if b"%08x" % crc_of(head, body) != crc:
        return False, f"DAMAGED ({what}): its checksum is another one"
    right, words = _line(body)
    return right, f"{words}  [{what}]"


def _line(text: bytes) -> tuple[bool, str]:
    """Explained in the dialect and direction in which the line is valid."""
    wrong = ""
    thesis = has_label_after_tag(text.decode("ascii", "replace"))
    dialect = Dialect.THESIS if thesis else Dialect.CRATOUS
    for direction in Direction:
        parser = StreamParser(direction, limits=WIDE_LIMITS, dialect=dialect, original_peer=True)
        for record in parser.feed(text + b"\n"):
            if isinstance(record, Message):
                return True, f"{record.tag:<6} {sentence(record)}"
            if isinstance(record, WireError):
                wrong = str(record).partition(", ")[2]  # each line is line 1 of its own parser
    return False, f"WRONG: {wrong or 'not a line of the protocol: ' + ascii(text[:60])[1:]}"
