"""Message logs made by hand, and logs of flights that are edited, for tests of the judge.

Nothing here uses the log writer or the message models: what stands in docs/reference/logs.md, written once more.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from cratous.judge import Judgement, judge

TABLES = """
CREATE TABLE messages(seq INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, source TEXT NOT NULL,
                      topic TEXT NOT NULL, body NOT NULL, address TEXT, sender_group TEXT,
                      entity_id TEXT, service_id TEXT, content_type TEXT);
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE gaps(before_seq INTEGER NOT NULL, missing INTEGER NOT NULL, first_ms INTEGER NOT NULL,
                  last_ms INTEGER NOT NULL, reason TEXT NOT NULL);
CREATE TABLE closing(messages INTEGER NOT NULL, digest TEXT NOT NULL);
"""


class Message(NamedTuple):
    """One message; `kind` is the last part of the topic."""

    time_ms: int
    topic: str
    body: dict[str, Any]

    @property
    def kind(self) -> str:
        return self.topic.rpartition(".")[2]


def plain(data: Any) -> str:
    return json.dumps(data, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def write(path: Path, meta: dict[str, Any], messages: Iterable[Message], seal: bool = True) -> Path:
    """A whole log."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    database = sqlite3.connect(path)
    database.executescript(TABLES)
    for key, value in meta.items():
        database.execute("INSERT INTO meta VALUES(?, ?)", (key, plain(value)))
    digest, count = hashlib.sha256(), 0
    for seq, message in enumerate(messages):
        head = [seq, message.time_ms, "test", message.topic]
        body = json.dumps(message.body, separators=(",", ":"), ensure_ascii=False)
        digest.update(plain(head).encode() + b"\n" + body.encode() + b"\n")
        nothing = (None,) * 5
        database.execute(
            "INSERT INTO messages VALUES(?,?,?,?,?,?,?,?,?,?)", (*head, body, *nothing)
        )
        count += 1
    if seal:
        database.execute("INSERT INTO closing VALUES(?, ?)", (count, digest.hexdigest()))
    database.commit()
    database.close()
    return path


def read(path: Path) -> tuple[dict[str, Any], list[Message]]:
    """Meta data and messages of a log."""
    database = sqlite3.connect(path)
    meta = {k: json.loads(v) for k, v in database.execute("SELECT key, value FROM meta")}
    rows = database.execute("SELECT time_ms, topic, body FROM messages ORDER BY seq").fetchall()
    database.close()
    return meta, [Message(time_ms, topic, json.loads(body)) for time_ms, topic, body in rows]


Edit = Callable[[list[Message]], list[Message]]


def edited(source: Path, target: Path, edit: Edit) -> Path:
    """A log with other messages, sealed anew."""
    meta, messages = read(source)
    return write(target, meta, edit(messages))


def with_monitor(log: Path) -> Path:
    """The folder of a log, with what the flight's monitor says of it as its report."""
    from cratous.services.certify.rejudge import watch
    from cratous.services.certify.verdicts import constraint_rows

    return with_report(log, constraint_rows(watch(log).verdicts, "flight"))


def with_report(log: Path, rows: list[dict[str, Any]]) -> Path:
    database = sqlite3.connect(log)
    ((digest,),) = database.execute("SELECT digest FROM closing").fetchall()
    database.close()
    report = {"format": "cratous-report/2", "constraints": rows, "log": {"digest": digest}}
    (log.parent / "report.json").write_text(json.dumps(report))
    return log.parent


def verdicts(found: Judgement) -> dict[str, str]:
    """By item."""
    return {row.item: row.verdict for row in found.rows}


# ---- a mission by hand ------------------------------------------------------------------------


def vehicle(number: int, **more: Any) -> dict[str, Any]:
    camera = {"payload_id": 1, "wavelength": "AllAny", "pixels": 0}
    return {
        "id": number, "protected": True, "speed_m_s": 20.0, "max_bank_rad": 0.5,
        "cameras": [camera], **more,
    }  # fmt: skip


def task(number: int, kind: str, *points: tuple[float, float], **more: Any) -> dict[str, Any]:
    return {
        "id": number, "kind": kind, "eligible": [], "duration_ms": 0, "radius_m": 0.0,
        "standoff_m": 0.0, "gsd_m": 0.0, "wavelength": "AllAny", "loiter": None, "pattern": None,
        "extent_m": 0.0,
        "points": [{"north_m": n, "east_m": e, "alt_m": 0.0} for n, e in points], **more,
    }  # fmt: skip


def zone(number: int, kind: str, *vertices: tuple[float, float], **more: Any) -> dict[str, Any]:
    return {
        "id": number, "kind": kind, "vertices": [list(v) for v in vertices], "floor_m": -1000.0,
        "ceiling_m": 100_000.0, "padding_m": 0.0, **more,
    }  # fmt: skip


def mission(**more: Any) -> dict[str, Any]:
    return {
        "name": "made", "seed": 0, "relations": "", "instances": [], "zones": [], "changes": [],
        "traffic": [], "tasks": [], "vehicles": [vehicle(1)],
        "frame": {"latitude_deg": 45.0, "longitude_deg": 7.0, "terrain_m": 0.0},
        "daa": {"well_clear": {"dthr_m": 150.0, "zthr_m": 30.0, "tthr_s": 15.0, "tcoa_s": 0.0}},
        "simulation": {"step_ms": 1000, "heartbeat_ms": 500, "limit_ms": 1_000_000},
        **more,
    }  # fmt: skip


class Scene:
    """A log in the making: straight flights, and what is said of tasks, gates, heartbeats."""

    def __init__(self, end_ms: int = 10_000, **more: Any) -> None:
        self.mission, self.end_ms = mission(**more), end_ms
        self.messages: list[Message] = []
        self.meta: dict[str, Any] = {"mission": self.mission}

    def say(self, time_ms: int, kind: str, **body: Any) -> Scene:
        self.messages.append(
            Message(time_ms, f"cratous.{kind}", {"$type": f"CRATOUS/{kind}", **body})
        )
        return self

    def flies(
        self, number: int, way: list[tuple[float, float, float]], step_ms: int = 1000
    ) -> Scene:
        """Positions north, east, up at each step; the velocity of each leg is that to the next."""
        for k, here in enumerate(way):
            there = way[min(k + 1, len(way) - 1)]
            v = [(b - a) * 1000 / step_ms for a, b in zip(here, there, strict=True)]
            self.say(
                k * step_ms, "TruthState", VehicleID=number, Time=k * step_ms, North=here[0],
                East=here[1], Altitude=here[2], VelocityNorth=v[0], VelocityEast=v[1],
                VelocityDown=-v[2], Heading=0.0, Cooperative=True,
            )  # fmt: skip
        return self

    def straight(
        self, number: int, start: tuple[float, float, float], v: tuple[float, ...]
    ) -> Scene:
        """Straight flight from the start to the end of the mission."""
        way = [
            (start[0] + v[0] * k, start[1] + v[1] * k, start[2] + v[2] * k)
            for k in range(self.end_ms // 1000 + 1)
        ]
        return self.flies(number, way)

    def does(self, number: int, by: int, start: int, end: int | None) -> Scene:
        phases = [("Active", start), ("Complete", end)]
        for phase, at in phases:
            if at is not None:
                self.say(at, "TaskProgress", TaskID=number, VehicleID=by, Time=at, Phase=phase)
        return self

    def commands(self, number: int, *rows: tuple[Any, ...]) -> Scene:
        """(time, "command"|"drop"|"state"|"change", side, epoch[, offered])."""
        names = {
            "command": ("GatedCommand", "Sender"), "drop": ("CommandDropped", "Sender"),
            "state": ("GateState", "Owner"), "change": ("AuthorityChange", "Owner"),
        }  # fmt: skip
        for time_ms, what, side, epoch, *offered in rows:
            kind, field = names[what]
            body = {"VehicleID": number, field: side, "Epoch": epoch}
            if what == "state":
                body["Offered"] = bool(offered and offered[0])
            self.say(time_ms, kind, **body)
        return self

    def beats(self, number: int, skip: Iterable[int] = ()) -> Scene:
        left_out = set(skip)
        for way in ("Down", "Up"):
            for k in range(self.end_ms // 500 + 1):
                if k not in left_out:
                    at = 500 * k
                    self.say(
                        at, "Heartbeat", VehicleID=number, Time=at, Direction=way, Sequence=k + 1
                    )
        return self

    def write(self, path: Path, end: str = "complete", seal: bool = True) -> Path:
        messages = sorted(self.messages, key=lambda m: m.time_ms)
        if end:
            body = {"$type": "CRATOUS/MissionEnd", "Time": self.end_ms, "Outcome": end}
            messages.append(Message(self.end_ms, "cratous.MissionEnd", body))
        return write(path, self.meta, messages, seal)

    def judged(self, folder: Path, end: str = "complete", seal: bool = True) -> Judgement:
        return judge(self.write(folder / "log.sqlite", end, seal))


def changed(at_ms: int, kind: str, task_id: int) -> dict:
    return {"at_ms": at_ms, "kind": kind, "vehicle": 0, "task": task_id, "zone": None}


TAKEN = [
    (0, "command", "UxAS", 0), (2000, "state", "ICAROUS", 1), (2000, "change", "ICAROUS", 1),
    (2000, "command", "ICAROUS", 1), (3000, "command", "UxAS", 0), (3000, "drop", "UxAS", 0),
    (5000, "state", "ICAROUS", 2, True), (5000, "command", "ICAROUS", 2),
    (5500, "command", "UxAS", 2), (5500, "state", "UxAS", 2), (5500, "change", "UxAS", 2),
    (6000, "command", "UxAS", 2),
]  # fmt: skip
"""The messages of a takeover that is handed back."""


def row(requirement: str, item: str, verdict: str) -> dict[str, str]:
    return {"requirement": requirement, "item": item, "verdict": verdict, "source": "flight"}


def full(folder: Path, *, lost: bool = False) -> tuple[Path, list[dict[str, str]]]:
    """A log, and a monitor's rows that say what the judge says."""
    scene = Scene(vehicles=[vehicle(1), vehicle(2)], tasks=[task(1, "must_fly", (100, 0))])
    scene.straight(1, (0, 0, 300), (20.0, 0.0, 0.0)).straight(
        2, (0, 100.0 if lost else 900.0, 300), (20.0, 0.0, 0.0)
    )
    scene.does(1, 1, 4000, 6000).commands(1, TAKEN[0]).commands(2, TAKEN[0])
    log = scene.write(folder / "log.sqlite")
    return log, [
        row(r.guarantee, r.item, r.verdict) for r in judge(log).rows if r.subject[0] != "relations"
    ]
