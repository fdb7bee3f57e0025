"""Reads a raw message log: SQLite and the JSON in it. Documented in docs/reference/logs.md.

Missing parts (gaps, holes, no end) are doubts that turn `holds` into unknown.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from cratous.judge.declared import Declared, Event, note_due, read_check, read_declared, read_hand
from cratous.judge.fields import Node
from cratous.spec.errors import BadInput

NAME = "log.sqlite"
OLD = ("seq", "time_ms", "source", "topic", "body")
NEW = (*OLD, "address", "sender_group", "entity_id", "service_id", "content_type")
KINDS = (
    "TruthState", "AirVehicleState", "TaskProgress", "MissionEnd", "GateState", "GatedCommand",
    "CommandDropped", "AuthorityChange", "Heartbeat", "BridgeStatus", "PlanAccepted", "LinkLossState",
    "TakeOffState", "FailureState", "HandState", "FailureCheck", "UxasHeard",
)  # fmt: skip
FLOWN = ("North", "East", "Altitude", "VelocityNorth", "VelocityEast", "VelocityDown")
PHASES = ("Planned", "Transit", "Waiting", "Active", "Suspended", "Complete", "Failed")
SIDES = ("UxAS", "ICAROUS")
MODES = ("Linked", "Finish", "Loiter", "Return", "Over", "Land", "Final", "Landed")
LEAVES = ("Standing", "Rolling", "Climbing", "Up")


class State(NamedTuple):
    """Position of an aircraft, and the velocity of its next leg: north, east, up."""

    time_ms: int
    north_m: float
    east_m: float
    alt_m: float
    north_m_s: float
    east_m_s: float
    up_m_s: float


class Look(NamedTuple):
    """A camera footprint at an instant: corners as latitude, longitude [deg]."""

    vehicle: int
    time_ms: int
    payload: int
    hfov_deg: float
    corners: tuple[tuple[float, float], ...]
    centre: tuple[float, float, float] | None = None


class Progress(NamedTuple):
    """A reported phase of a task. logged_ms: time of the report [ms]."""

    task: int
    vehicle: int
    time_ms: int
    phase: str
    logged_ms: int


class Gate(NamedTuple):
    """A message on authority. kind: state, command, drop or change; side: owner or sender."""

    kind: str
    vehicle: int
    time_ms: int
    side: str
    epoch: int
    offered: bool = False


class Beat(NamedTuple):
    """A heartbeat."""

    time_ms: int
    number: int
    logged_ms: int


class Bridge(NamedTuple):
    """Whether the bridge to a vehicle is reported alive. lost: its connection has ended."""

    time_ms: int
    alive: bool
    lost: bool = False


class Alone(NamedTuple):
    """A vehicle's report of what it flies without the link, of the choice made, and when it last heard UxAS."""

    time_ms: int
    mode: str
    chosen: str
    heard_ms: int


class Leaves(NamedTuple):
    """A vehicle's report on its take-off, and when it last heard UxAS."""

    time_ms: int
    mode: str
    heard_ms: int


@dataclass
class Log:
    """The judge's extract of a log. planned: tasks of the last plan; doubts: why nothing in it can be said to hold;
    lossy: why absence from it proves nothing."""

    path: Path
    meta: dict[str, Any] = field(default_factory=dict)
    states: dict[int, list[State]] = field(default_factory=dict)
    places: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)
    looks: list[Look] = field(default_factory=list)
    progress: list[Progress] = field(default_factory=list)
    gates: list[Gate] = field(default_factory=list)
    beats: dict[tuple[int, str], list[Beat]] = field(default_factory=dict)
    bridges: dict[int, list[Bridge]] = field(default_factory=dict)
    alone: dict[int, list[Alone]] = field(default_factory=dict)
    declared: dict[int, list[Declared]] = field(default_factory=dict)
    hands: dict[int, list[tuple[int, str]]] = field(default_factory=dict)
    due: dict[int, list[Event]] = field(default_factory=dict)
    unread: dict[int, str] = field(default_factory=dict)  # what lacks a field that `due` needs
    leaving: dict[int, list[Leaves]] = field(default_factory=dict)
    ends: list[tuple[int, str]] = field(default_factory=list)
    planned: frozenset[int] = frozenset()
    doubts: list[str] = field(default_factory=list)
    lossy: str = ""
    digest: str = ""

    @property
    def end_ms(self) -> int | None:
        """Time of the mission's end; None if the log does not contain it."""
        return self.ends[-1][0] if self.ends else None


def place_of(path: Path) -> Path:
    """The log in a folder, or the file itself."""
    return path / NAME if path.is_dir() else path


def read(path: Path) -> Log:
    """The log; BadInput, with the position, for an incomplete or invalid file."""
    log = Log(path)
    database = _open(path)
    try:
        _read(log, database)
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise BadInput(f"the log is damaged ({str(error)[:200]})", where=str(path)) from None
    finally:
        database.close()
    return log


def _open(path: Path) -> sqlite3.Connection:
    try:
        if not path.is_file():
            raise BadInput("there is no such file", where=str(path), expected="a message log")
        uri = f"{path.resolve().as_uri()}?mode=ro"
    except (OSError, ValueError) as error:
        raise BadInput(f"cannot be opened ({error})", where=str(path)) from None
    try:
        database = sqlite3.connect(uri, uri=True, timeout=10)
    except sqlite3.Error as error:
        raise BadInput(f"cannot be opened ({error})", where=str(path)) from None
    try:
        names = {str(row[0]) for row in database.execute("SELECT name FROM sqlite_master")}
    except (sqlite3.Error, UnicodeDecodeError) as error:
        database.close()
        raise BadInput(
            f"not a message log ({str(error)[:200]})", where=str(path), expected="SQLite 3"
        ) from None
    if not {"messages", "meta"} <= names:
        database.close()
        got = ", ".join(sorted(names)[:8]) or "none"
        raise BadInput(
            "not a message log", where=str(path), expected="tables messages and meta", got=got
        )
    return database


def _read(log: Log, database: sqlite3.Connection) -> None:
    where = str(log.path)
    columns = {row[1] for row in database.execute("PRAGMA table_info(messages)")}
    names = NEW if set(NEW) <= columns else OLD
    if not set(names) <= columns:
        raise BadInput("not a message log", where=where, expected=f"columns {', '.join(OLD)}")
    for key, value in database.execute("SELECT key, value FROM meta"):
        if type(key) is not str or type(value) is not str:
            raise BadInput("wrong values in meta", where=where, got=repr((key, value))[:80])
        log.meta[key] = _json(value, where, f"meta {key}")
    digest, count, before, last_ms = hashlib.sha256(), 0, None, None
    for row in database.execute(f"SELECT {', '.join(names)} FROM messages ORDER BY seq"):
        seq, time_ms, body = _typed(row, where)
        _feed(digest, row)
        count += 1
        if before is not None and seq != before + 1:
            _doubt(log, f"{seq - before - 1} messages are missing before message {seq}")
        if last_ms is not None and time_ms < last_ms:
            _doubt(log, f"message {seq} is older than the one before it")
        before, last_ms = seq, time_ms
        _message(log, row[3].rpartition(".")[2], seq, time_ms, body)
    log.digest = digest.hexdigest()
    _closing(log, database, count)


def _typed(row: tuple[Any, ...], where: str) -> tuple[int, int, Any]:
    seq, time_ms, source, topic, body = row[:5]
    right = type(seq) is type(time_ms) is int and type(source) is type(topic) is str
    if not right or type(body) not in (str, bytes):
        raise BadInput("wrong values in a message", where=where, got=repr(row)[:80])
    return seq, time_ms, body


def _feed(digest: Any, row: tuple[Any, ...]) -> None:
    """Add one message to the digest: its header as JSON, its body, each followed by a newline."""
    if row.count(None) < len(row) - len(OLD):
        text = json.dumps([*row[:4], *row[5:]], separators=(",", ":"), ensure_ascii=False)
    else:
        text = f"[{row[0]},{row[1]},{_quoted(row[2])},{_quoted(row[3])}]"
    digest.update(text.encode("utf-8", "surrogatepass") + b"\n")
    body = row[4]
    digest.update((body if isinstance(body, bytes) else body.encode()) + b"\n")


def _closing(log: Log, database: sqlite3.Connection, count: int) -> None:
    where = str(log.path)
    names = {row[0] for row in database.execute("SELECT name FROM sqlite_master")}
    if "gaps" in names:
        ((lost,),) = database.execute("SELECT count(*) FROM gaps").fetchall()
        if lost:
            _doubt(log, f"the writer gave up messages in {lost} places")
    rows = []
    if "closing" in names:
        rows = database.execute("SELECT messages, digest FROM closing").fetchall()
    if not rows:
        log.doubts.append("the log has no end: its writer was stopped, or still writes")
        return
    if rows[-1][0] != count:
        raise BadInput(
            "the log was cut, or grew, after it was closed", where=where,
            expected=f"{rows[-1][0]} messages", got=str(count),
        )  # fmt: skip
    if rows[-1][1] != log.digest:
        raise BadInput(
            "the messages are not those that were logged", where=where,
            expected=f"digest {rows[-1][1]}", got=log.digest,
        )  # fmt: skip


def _doubt(log: Log, text: str) -> None:
    log.lossy = log.lossy or text
    if len(log.doubts) < 20:
        log.doubts.append(text)


def _refuse(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")


_decode = json.JSONDecoder(parse_constant=_refuse).decode
_quoted = lru_cache(256)(json.JSONEncoder(ensure_ascii=False).encode)
"""A string as JSON, cached, since names of senders and types recur."""


def _json(text: str, where: str, item: str) -> Any:
    try:
        return _decode(text)
    except (ValueError, RecursionError) as error:
        raise BadInput(f"not JSON ({str(error)[:100]})", where=where, item=item) from None


def _message(log: Log, kind: str, seq: int, time_ms: int, body: Any) -> None:
    if kind not in KINDS:
        return
    item = f"message {seq} ({kind})"
    if isinstance(body, bytes):
        raise BadInput(
            "a body of LMCP bytes", where=str(log.path), item=item,
            expected="JSON (cratous log export to .jsonl and import make it so)",
        )  # fmt: skip
    node = Node(_json(body, str(log.path), item), str(log.path), item)
    _READERS[kind](log, node, time_ms)
    note_due(log, kind, node)


def _truth(log: Log, body: Node, _time_ms: int) -> None:
    values = body.reals(*FLOWN)
    values[-1] = -values[-1]
    state = State(body["Time"].whole, *values)
    log.states.setdefault(body["VehicleID"].whole, []).append(state)


def _looks(log: Log, body: Node, _time_ms: int) -> None:
    vehicle, time_ms = body["ID"].whole, body["Time"].whole
    for payload in body["PayloadStateList"]:
        if not payload.has("Footprint") or not payload["Footprint"].data:
            continue
        corners = tuple(_location(c) for c in payload["Footprint"])
        log.places[vehicle, time_ms] = _location(body["Location"])
        centre = None
        if payload.has("Centerpoint"):
            middle = payload["Centerpoint"]
            centre = (*_location(middle), middle["Altitude"].real)
        log.looks.append(
            Look(vehicle, time_ms, payload["PayloadID"].whole,
                 payload["HorizontalFieldOfView"].real, corners, centre)
        )  # fmt: skip


def _location(data: Node) -> tuple[float, float]:
    latitude, longitude = data["Latitude"].real, data["Longitude"].real
    if not (abs(latitude) <= 90 and abs(longitude) <= 360):
        raise data.wrong("degrees of latitude and longitude")
    return latitude, longitude


def _progress(log: Log, body: Node, time_ms: int) -> None:
    log.progress.append(
        Progress(body["TaskID"].whole, body["VehicleID"].whole, body["Time"].whole,
                 body["Phase"].one_of(*PHASES), time_ms)
    )  # fmt: skip


def _plan(log: Log, body: Node, _time_ms: int) -> None:
    log.planned = frozenset(task.whole for task in body["Tasks"])


def _end(log: Log, body: Node, _time_ms: int) -> None:
    log.ends.append((body["Time"].whole, body["Outcome"].text))


def _owner(kind: str, field_name: str) -> Any:
    def reader(log: Log, body: Node, time_ms: int) -> None:
        offered = body["Offered"].flag if kind == "state" else False
        side, epoch = body[field_name].one_of(*SIDES), body["Epoch"].whole
        log.gates.append(Gate(kind, body["VehicleID"].whole, time_ms, side, epoch, offered))

    return reader


def _beat(log: Log, body: Node, time_ms: int) -> None:
    key = body["VehicleID"].whole, body["Direction"].one_of("Down", "Up")
    log.beats.setdefault(key, []).append(Beat(body["Time"].whole, body["Sequence"].whole, time_ms))


def _bridge(log: Log, body: Node, _time_ms: int) -> None:
    lost = body.get("Note", "").text.startswith("link lost")
    status = Bridge(body["Time"].whole, body["Alive"].flag, lost)
    log.bridges.setdefault(body["VehicleID"].whole, []).append(status)


def _alone(log: Log, body: Node, _time_ms: int) -> None:
    mode, chosen = body["Mode"].one_of(*MODES), body["Chosen"].one_of(*MODES)
    said = Alone(body["Time"].whole, mode, chosen, body["Heard"].whole)
    log.alone.setdefault(body["VehicleID"].whole, []).append(said)


def _leaves(log: Log, body: Node, _time_ms: int) -> None:
    mode = body["Mode"].one_of(*LEAVES)
    said = Leaves(body["Time"].whole, mode, body["Heard"].whole)
    log.leaving.setdefault(body["VehicleID"].whole, []).append(said)


_READERS = {
    "TruthState": _truth,
    "AirVehicleState": _looks,
    "TaskProgress": _progress,
    "MissionEnd": _end,
    "PlanAccepted": _plan,
    "GateState": _owner("state", "Owner"),
    "GatedCommand": _owner("command", "Sender"),
    "CommandDropped": _owner("drop", "Sender"),
    "AuthorityChange": _owner("change", "Owner"),
    "Heartbeat": _beat,
    "BridgeStatus": _bridge,
    "LinkLossState": _alone,
    "TakeOffState": _leaves,
    "FailureState": read_declared,
    "HandState": read_hand,
    "FailureCheck": read_check,
    "UxasHeard": read_check,
}


def mission_node(log: Log) -> Node:
    """The mission in the meta data."""
    if "mission" not in log.meta:
        raise BadInput(
            "the log does not say which mission was flown", where=str(log.path),
            item="meta", expected="mission",
        )  # fmt: skip
    return Node(log.meta["mission"], f"{log.path}, meta", "mission")
