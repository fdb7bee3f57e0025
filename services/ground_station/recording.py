"""Display data of a run or a message log, as plain data, created once when opened.

Times are ms after mission start; in a log without a mission, after its first message. Positions are
north, east [m] in the mission frame, or in a frame about the log's first position. Nothing is
judged here: verdicts are those of the run's report.json, and without one there are none.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from cratous.services.ground_station.bands import Bands
from cratous.services.ground_station.flight_display import STATE, FlownRecording
from cratous.services.ground_station.positions import Positions
from cratous.services.ground_station.shapes import Shapes
from cratous.services.ground_station.verdicts import verdicts_of
from cratous.services.logs.entry import Entry, any_data
from cratous.services.logs.records import from_data, to_data
from cratous.services.logs.source import Source, open_log
from cratous.services.mission.frames import Projection
from cratous.services.results.names import REPORT_NAME
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame, Mission

FORMAT = "cratous-recording/1"
CLOCKS = {"afrl.cmasi.SessionStatus": "ScenarioTime", STATE: "Time"}
"""Message fields with the time [ms], for captures without times."""
TIMELESS = ("frames", "lmcp")
TOLD = ("Request", "Response", "Command", "Action", "Complete", "Status", "Zone", "Task")
"""Messages of foreign logs with these type suffixes are listed as events."""


def recording(path: Path) -> dict[str, Any]:
    """The display data of a results folder or a message log.

    Raises BadInput, with file and position, if the log, or report.json beside it, is damaged.
    """
    folder = path if path.is_dir() else None
    with open_log(path) as source:
        try:
            # verdicts are shown only for the log from which they were derived
            judged = folder is not None and (folder / REPORT_NAME).exists()
            entries = source.verified_entries() if judged else source.entries()
            mission = _mission(source)
            found = _flown(entries, mission) if mission is not None else _told(source, entries)
            found["log"] = _log(source)
        except BadInput as error:
            error.where = f"{source.path}, {error.where}" if error.where else str(source.path)
            raise
    closing = found["log"]["digest"]
    return {"format": FORMAT, **found, "verdicts": verdicts_of(folder, closing)}


def _mission(source: Source) -> Mission | None:
    """The mission for which the log was made; None if it has none."""
    meta = source.meta()
    return from_data(Mission, meta["mission"], "meta.mission") if "mission" in meta else None


def _log(source: Source) -> dict[str, Any]:
    closing = source.closing()
    return {
        "file": source.path.name,
        "kind": source.kind,
        "end": source.end(),
        "digest": None if closing is None else closing.digest,
        "missing": source.holes() + sum(gap.missing for gap in source.gaps()),
    }


def _flown(entries: Iterator[Entry], mission: Mission) -> dict[str, Any]:
    """A CRATOUS flight, from its mission and its messages."""
    flown = FlownRecording(mission)
    try:
        for entry in entries:
            flown.add(entry)
    except (LookupError, TypeError, ValueError) as error:
        raise BadInput(
            "a message lacks what its type has", where=flown.place, expected="a message of a flight",
            got=f"{type(error).__name__}: {error}"[:120],
        ) from None  # fmt: skip
    return flown.whole()


def _told(source: Source, entries: Iterator[Entry]) -> dict[str, Any]:
    """A foreign log: states, routes and zones from its messages."""
    positions, bands, end_ms = Positions(), Bands(), 0
    shapes: Shapes | None = None
    waiting: list[tuple[Entry, int]] = []
    events: list[dict[str, Any]] = []
    for entry, time_ms in _timed(source, entries):
        end_ms = max(end_ms, time_ms)
        positions.add(entry, time_ms)
        bands.add(entry, time_ms)
        waiting.append((entry, time_ms))
        if shapes is None and positions.frame is not None:
            shapes = Shapes(Projection(positions.frame).to_local)
        if shapes is not None:
            for before in waiting:
                shapes.add(*before)
            waiting.clear()
        if is_told(entry):
            events.append({"time_ms": time_ms, "vehicle": None, "text": told_text(entry)})
    frame = positions.frame or Frame(0.0, 0.0)
    return {
        "name": source.path.name,
        "source": "messages",
        "frame": to_data(frame),
        "located": positions.frame is not None,
        "end_ms": end_ms,
        "outcome": "the log names no mission",
        "vehicles": positions.vehicles(),
        "volume": None,
        "tasks": shapes.tasks if shapes else [],
        "zones": shapes.zones if shapes else [],
        "absences": [],
        "routes": shapes.routes if shapes else [],
        "tracks": positions.tracks(),
        "footprints": [],
        "authority": None,
        "takeovers": [],
        "phases": [],
        "links": None,
        "bands": bands.found,
        "events": events,
        "unread": positions.unread + bands.unread + (shapes.unread if shapes else 0),
    }


def is_told(entry: Entry) -> bool:
    """Whether a message of a foreign log is listed as an event."""
    return entry.topic.rpartition(".")[2].endswith(TOLD) and entry.topic not in CLOCKS


def told_text(entry: Entry) -> str:
    """A message's type and sender, as shown in lists."""
    short = entry.topic.rpartition(".")[2]
    return f"{short} from {entry.source}" if entry.source else short


def _timed(source: Source, entries: Iterator[Entry]) -> Iterator[tuple[Entry, int]]:
    """The messages with their times after the first one [ms]; times never decrease."""
    begin_ms: int | None = None
    now_ms = 0
    for entry in entries:
        told: Any = entry.time_ms
        if source.kind in TIMELESS:
            body, _ = any_data(entry) if entry.topic in CLOCKS else ({}, None)
            told = body.get(CLOCKS.get(entry.topic)) if isinstance(body, dict) else None
        if isinstance(told, int):
            begin_ms = told if begin_ms is None else begin_ms
            now_ms = max(now_ms, told - begin_ms)
        yield entry, now_ms
