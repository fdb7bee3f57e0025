"""Compares two runs: both recordings, and the rows in which they differ, as plain data.

A row names what only one run has, or what differs, with its instants [ms after mission start].
Repeated items, such as takeovers of a vehicle, are paired in order: the third with the third.
Nothing is judged. Times, texts, verdicts and margins are compared exactly. Positions are compared
as displayed, to 0.1 m: those of aircraft once a second and at changes of command, those of
waypoints as north and east. Smaller differences, and those in between, give no row.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.certify.timeline import OTHER, PLAN
from cratous.services.ground_station.recording import recording
from cratous.services.logs.records import from_data, to_data
from cratous.services.logs.source import open_log
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission

FORMAT = "cratous-comparison/1"
SETTINGS = ("avoidance", "seed")
"""Settings of a run that are compared besides the mission."""
OTHERWISE = "otherwise than A"


class Said(NamedTuple):
    """An item of one run; value: everything by which it is compared; time_ms: None without an instant."""

    item: str
    text: str
    time_ms: int | None
    value: Any


def check_comparable(run: Path, other: Path) -> None:
    """Raises BadInput unless both are runs of missions in the same frame."""
    frames = [(path, _meta(path)[0].frame) for path in (run, other)]
    (_, first), (path, second) = frames
    if first != second:
        raise BadInput(
            "the missions of the two runs have other frames: one map cannot show both",
            where=str(path), item="mission.frame", expected=f"that of {run}: {to_data(first)}",
            got=str(to_data(second)),
        )  # fmt: skip


def comparison(run: Path, other: Path) -> dict[str, Any]:
    """The data displayed for two runs. Raises BadInput as `recording` and `check_comparable` do."""
    check_comparable(run, other)
    a, b = ({**recording(path), "run": str(path)} for path in (run, other))
    for one in (a, b):
        one["verdicts"].pop("proofs", None)  # shown for single runs only
    unknown = [
        f"{name}: {one['verdicts']['why_none']}"
        for name, one in (("A", a), ("B", b))
        if "why_none" in one["verdicts"]
    ]
    rows = _settings(_meta(run), _meta(other))
    for kind, said in KINDS.items():
        if not (unknown and kind in JUDGED):  # an unknown verdict is not the absence of one
            rows += _rows(kind, said(a), said(b))
    rows += _parting(a["tracks"], b["tracks"])
    return {"format": FORMAT, "a": a, "b": b, "differences": rows, "verdicts_why_none": unknown}


def _meta(path: Path) -> tuple[Mission, dict[str, Any]]:
    """The mission of a run, and the remaining meta data of its log."""
    with open_log(path) as source:
        meta = source.meta()
    if "mission" not in meta:
        raise BadInput(
            "two runs are shown in the frame of their missions, and this log names none",
            where=str(path), item="meta.mission", expected="a run of `cratous run`",
            got=f"a log of kind {source.kind}",
        )  # fmt: skip
    try:
        return from_data(Mission, meta["mission"], "meta.mission"), meta
    except BadInput as error:
        error.where = error.where or str(path)
        raise


def _settings(
    a: tuple[Mission, dict[str, Any]], b: tuple[Mission, dict[str, Any]]
) -> list[dict[str, Any]]:
    """Settings and parts of the mission that differ, or that only one of the logs has."""
    found = []
    for name in SETTINGS:
        sides = [
            [Said(name, str(meta[name]).lower(), None, meta[name])] if name in meta else []
            for _, meta in (a, b)
        ]
        found += _rows("setting", *sides)
    plain = [(to_data(mission), meta["mission"]) for mission, meta in (a, b)]
    for name in plain[0][0]:
        sides = [
            [Said(f"mission: {name}", _short(read[name]), None, read[name])] if name in told else []
            for read, told in plain
        ]
        found += _rows("setting", *sides)
    return found


def _short(value: Any) -> str:
    if isinstance(value, list | dict) and len(str(value)) > 40:
        return f"{len(value)} entries"
    return str(value)


def _numbered(said: Iterable[Said]) -> dict[tuple[str, int], Said]:
    """Items by name and occurrence number in log order."""
    count: Counter[str] = Counter()
    found = {}
    for one in said:
        count[one.item] += 1
        found[one.item, count[one.item]] = one
    return found


def _rows(kind: str, a: Iterable[Said], b: Iterable[Said]) -> list[dict[str, Any]]:
    """The differing rows of one kind, in time order."""
    one, two = _numbered(a), _numbered(b)
    found = []
    for key in {**one, **two}:
        left, right = one.get(key), two.get(key)
        if left is not None and right is not None and left.value == right.value:
            continue
        side = "only A" if right is None else "only B" if left is None else "different"
        item = key[0] if key[1] == 1 else f"{key[0]}, number {key[1]}"
        times = [said.time_ms for said in (left, right) if said and said.time_ms is not None]
        row = {"kind": kind, "item": item, "side": side, "a": _cell(left), "b": _cell(right)}
        if row["a"] == row["b"]:  # the items differ in more than the displayed text
            row["b"] = _cell(right, f", {OTHERWISE}")
        found.append((min(times, default=-1), row))
    return [row for _, row in sorted(found, key=lambda one: one[0])]


def _cell(said: Said | None, more: str = "") -> dict[str, Any] | None:
    return None if said is None else {"text": said.text + more, "time_ms": said.time_ms}


def _parting(
    a: dict[str, list[list[float]]], b: dict[str, list[list[float]]]
) -> list[dict[str, Any]]:
    """For each aircraft with differing tracks, the first instant at which they differ."""
    found = []
    for number in {**a, **b}:
        one, two = ([row[:4] for row in tracks.get(number, ())] for tracks in (a, b))
        if one == two:
            continue
        k = next((k for k, (x, y) in enumerate(zip(one, two, strict=False)) if x != y), None)
        k = min(len(one), len(two)) if k is None else k
        sides = [
            [Said(f"track of {number}", *_from(rows, k), rows)] if rows else []
            for rows in (one, two)
        ]  # fmt: skip
        found += _rows("track", *sides)
    return found


def _from(rows: list[list[float]], k: int) -> tuple[str, int]:
    """The text and time for a track whose row k is missing from the other track."""
    if k < len(rows):
        time_ms, north_m, east_m, alt_m = rows[k]
        return f"north {north_m:.1f} m, east {east_m:.1f} m, altitude {alt_m:.1f} m", int(time_ms)
    return "its last place", int(rows[-1][0])


def _requirements(run: dict[str, Any]) -> list[Said]:
    return [
        _verdict(f"{row['requirement']} {row['title']}".strip(), row)
        for row in run["verdicts"].get("requirements", ())
    ]


def _parts(run: dict[str, Any]) -> list[Said]:
    return [
        _verdict(f"{row['requirement']} {row['item']}", row)
        for row in run["verdicts"].get("details", ())
    ]


def _verdict(item: str, row: dict[str, Any]) -> Said:
    margin = row["margin"]
    text = row["verdict"] if margin is None else f"{row['verdict']}, {margin:.4g} {row['unit']}"
    told = margin is not None or row["verdict"] != "holds"
    return Said(item, text.strip(), row["time_ms"] if told else None, (row["verdict"], margin))


def _authority(run: dict[str, Any]) -> list[Said]:
    found = []
    for change in run["authority"] or ():
        away = change["owner"] == "ICAROUS"
        what = "takeover" if away else "handback"
        of = f" because of {change['intruder']}" if away and change["intruder"] else ""
        value = (change["time_ms"], change["reason"], change["intruder"])
        text = f"{change['reason']}{of}"
        found.append(Said(f"{what} of vehicle {change['vehicle']}", text, change["time_ms"], value))
    return found


def _said_at(time_ms: int, item: str, text: str, *value: Any) -> Said:
    """An entry at an instant; the instant is part of the compared value."""
    return Said(item, text, time_ms, (time_ms, *value))


def _plans(run: dict[str, Any]) -> list[Said]:
    return [_told(event, "plan") for event in _events(run, PLAN)]


def _routes(run: dict[str, Any]) -> list[Said]:
    return [
        _said_at(
            route["time_ms"],
            f"route of vehicle {route['vehicle']}",
            f"{route['sender'] or 'plan'}, {len(route['points'])} waypoints",
            route["sender"],
            route["points"],
        )
        for route in run["routes"]
    ]


def _phases(run: dict[str, Any]) -> list[Said]:
    """Reports on tasks: changes of phase, and repeated reports without a change."""
    return [
        _said_at(
            one["time_ms"],
            f"task {one['task']} {one['phase'].lower()}{again}",
            f"{_who(one)}, {100 * one['served']:.4g} % served{': ' * bool(one['note'])}{one['note']}",
            *(one[part] for part in ("vehicle", "served", "note")),
        )
        for name, again in (("phases", ""), ("in_phase", ", told again"))
        for one in run[name]
    ]


def _who(phase: dict[str, Any]) -> str:
    return f"vehicle {phase['vehicle']}" if phase["vehicle"] else "no vehicle"


def _others(run: dict[str, Any]) -> list[Said]:
    """Events that no other kind covers."""
    return [
        _told(event, event["text"] if event["vehicle"] is None else f"vehicle {event['vehicle']}")
        for event in _events(run, OTHER)
    ]


def _told(event: dict[str, Any], item: str) -> Said:
    return _said_at(event["time_ms"], item, event["text"], event["text"])


def _events(run: dict[str, Any], kind: str) -> list[dict[str, Any]]:
    kinds = run["event_kinds"]
    return [event for event, its in zip(run["events"], kinds, strict=True) if its == kind]


def _end(run: dict[str, Any]) -> list[Said]:
    value = (run["end_ms"], run["outcome"])
    return [Said("end of mission", str(run["outcome"]), run["end_ms"], value)]


KINDS: dict[str, Callable[[dict[str, Any]], list[Said]]] = {
    "verdict": _requirements,
    "authority": _authority,
    "task": _phases,
    "plan": _plans,
    "route": _routes,
    "event": _others,
    "end": _end,
    "verdict in detail": _parts,
}
"""The compared kinds, in page order."""
JUDGED = ("verdict", "verdict in detail")
"""Kinds that only the report of a run has."""
