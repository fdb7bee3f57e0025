"""The complete judgement of one log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from cratous.judge import (
    authority,
    compare,
    due,
    failures,
    heartbeat,
    log,
    lost_link,
    merging,
    mission_file,
    relations,
    safe_state,
    separation,
    service,
    take_off,
    zones,
)
from cratous.judge.answers import Answer, answers_to
from cratous.judge.compare import DISAGREE, Difference
from cratous.judge.mission import Mission, from_log
from cratous.judge.task_presence import Flight
from cratous.judge.tracks import tracks
from cratous.judge.verdict import GUARANTEES, HOLDS, UNKNOWN, VIOLATED, Row, doubted, worst


@dataclass(frozen=True)
class Judgement:
    """Rows, and differences from the flight's report. report: whether there is one.

    answers: on each flight row of the report, and rows that it should have and lacks; meta: the
    log's meta data, unchanged.
    """

    rows: tuple[Row, ...]
    differences: tuple[Difference, ...]
    report: bool
    not_covered: tuple[int, ...]
    digest: str
    answers: tuple[Answer, ...] = ()
    meta: Mapping[str, Any] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """The worst verdict of all rows."""
        return worst([self.of(guarantee) for guarantee in GUARANTEES])

    def of(self, guarantee: str) -> str:
        """The verdict on one of G1 to G5; unknown without a row."""
        return worst([row.verdict for row in self.rows if row.guarantee == guarantee])

    @property
    def disagreements(self) -> list[Difference]:
        """Differences in which one of the two must be wrong."""
        return [d for d in self.differences if d.kind == DISAGREE]

    @property
    def exit_code(self) -> int:
        """0 holds, 1 violated or in disagreement with the monitor, 3 unknown."""
        if self.disagreements or self.verdict == VIOLATED:
            return 1
        return 0 if self.verdict == HOLDS else 3

    def data(self) -> dict[str, Any]:
        """The judgement as plain data."""
        return {
            "verdict": self.verdict,
            "exit_code": self.exit_code,
            "disagreements": len(self.disagreements),
            "guarantees": {name: self.of(name) for name in GUARANTEES},
            "not_covered": list(self.not_covered),
            "log_digest": self.digest,
            "compared": self.report,
            "differences": [asdict(d) for d in self.differences],
            "rows": [_row_data(row) for row in self.rows],
        }


def _row_data(row: Row) -> dict[str, Any]:
    data = {**asdict(row), "subject": list(row.subject)}
    del data["parts"]  # the row states the same in its own words
    return data


def judge(path: Path, mission: Path | None = None) -> Judgement:
    """Judge a log, or the folder that contains it, against its mission or that of a file.

    Raises only BadInput (`cratous.spec.errors`), for input that cannot be judged.
    """
    found = log.read(log.place_of(path))
    asked = mission_file.read(mission) if mission else from_log(log.mission_node(found))
    rows = tuple(judged(asked, found))
    report = compare.report_of(path)
    said: list[Difference] = []
    answers: list[Answer] = []
    if report:
        read = compare.read(report)
        said = compare.differences(list(rows), read, found.digest)
        answers = answers_to(list(rows), read)
    uncovered = tuple(sorted(v.id for v in asked.vehicles.values() if not v.protected))
    compared = report is not None
    return Judgement(
        rows, tuple(said), compared, uncovered, found.digest, tuple(answers), found.meta
    )


def judged(mission: Mission, found: log.Log) -> list[Row]:
    """All rows that the mission requires, and those that the log adds."""
    flown = tracks(mission, found)
    done = relations.deeds(mission, found)
    flight = Flight(mission, found, flown, done)
    served = service.served(flight)
    good = {task for task, (verdict, *_) in served.items() if verdict == HOLDS}
    merged = list(merging.rows(mission, flown))
    safe = [*zones.rows(mission, flown), *separation.rows(mission, flown)]
    rows = [
        *safe,
        *merged,
        *relations.rows(mission, found, done, good),
        *service.rows(flight, served),
    ]
    rows += authority.rows(mission, found, flown)
    rows += take_off.rows(mission, found, flown)
    rows += lost_link.rows(mission, found, flown)
    rows += failures.rows(mission, found, flown)
    rows += due.rows(mission, found)
    rows += safe_state.rows(mission, found, flown)
    rows += heartbeat.rows(mission, found, _unsafe(safe))
    doubts = list(found.doubts)
    if found.end_ms is None:
        doubts.append("the log stops before the mission ends")
    rows = [doubted(_not_missed(row, found.lossy), doubts[0] if doubts else "") for row in rows]
    return sorted(rows, key=_place)


def _not_missed(row: Row, lossy: str) -> Row:
    """A violation by the absence of a message becomes unknown if messages are missing."""
    by_presence = row.guarantee == "G2" or row.subject[0] in ("zone", "eligible", "merge")
    if not lossy or by_presence or row.verdict != VIOLATED:
        return row
    return replace(row, verdict=UNKNOWN, note=f"{lossy}; else: {row.note}")


def _place(row: Row) -> tuple[str, bool]:
    return row.guarantee, row.subject[0] == "end"


def _unsafe(rows: list[Row]) -> dict[int, list[int]]:
    """Times at which each vehicle violated a zone or lost well clear, by vehicle."""
    found: dict[int, list[int]] = {}
    for row in rows:
        if row.verdict == VIOLATED and row.at_ms is not None:
            who = row.subject[2:] if row.subject[0] == "zone" else row.subject[1:]
            for vehicle in who:
                found.setdefault(int(vehicle), []).append(row.at_ms)
    return found
