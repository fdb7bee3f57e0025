"""`report.json`: everything that is claimed about one flight, with its evidence.

It is derived from the mission, the plan, the checks and the message log, and from nothing else; the
HTML is a view of it. The same log and mission give the same report; `environment` is taken from the
log's meta.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous import __version__
from cratous.core.files.whole_file import write_atomically
from cratous.services.certify.blame import Commands, blame_rows
from cratous.services.certify.limits import LIMITS, of_states
from cratous.services.certify.modes import spans
from cratous.services.certify.running_code import running_code
from cratous.services.certify.timeline import Flight, FlightReader, bars, read_flight
from cratous.services.certify.verdicts import requirement_rows, with_promised, without_ground
from cratous.services.logs.log import Heard, Reading, body_of
from cratous.services.logs.records import fingerprint, to_data
from cratous.services.monitor.required_rows import watched
from cratous.services.results.names import (
    BLAME,
    FORMAT,
    HTML_NAME,
    LOG_NAME,
    MAP_NAME,
    OWN,
    REPORT_NAME,
)
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Outcome, exit_code, worst
from cratous.spec.mission.plan import Plan

if TYPE_CHECKING:
    from cratous.services.requirements.requirement_files import OwnFile

PROOFS_KEPT = ("line", "problems", "seal", "solver")


@dataclass(frozen=True)
class Flown:
    """How a mission was flown, as far as the messages do not show it; kept in the log's meta.

    proofs: of `proofs.inventory`; environment: of `environment`; own: user requirement files that
    are also evaluated on the log.
    """

    command: str
    avoidance: bool
    proofs: dict[str, Any]
    environment: dict[str, Any]
    own: tuple[OwnFile, ...] = ()

    def meta(self) -> dict[str, Any]:
        """The part stored in the log, so that a report can be compared with it."""
        kept = {key: self.proofs[key] for key in PROOFS_KEPT}
        return {
            "command": self.command,
            "avoidance": self.avoidance,
            "environment": self.environment,
            "proofs": {**kept, "sha256": fingerprint(self.proofs)},
            **({OWN: [file.named for file in self.own]} if self.own else {}),
        }


@dataclass(frozen=True)
class Judged:
    """The findings. rows: of `verdicts.constraint_rows`; assumptions, commands: of `Monitor`; told:
    data of the log, if it has been read already.
    """

    rows: Iterable[dict[str, Any]]
    assumptions: list[dict[str, Any]]
    commands: Commands
    told: Told | None = None


class Told(NamedTuple):
    """A log's flight data, and the digest of its messages."""

    flight: Flight
    digest: str


class Telling:
    """Reads a log's flight data while passing its messages on to another consumer."""

    def __init__(self, log: Path, mission: Mission) -> None:
        self._reading = Reading(log)
        self._reader = FlightReader(vehicle.id for vehicle in mission.vehicles)

    def heard(self) -> Iterator[Heard]:
        """The messages; each has been processed here when the next one is requested."""
        for entry in self._reading:
            body = body_of(entry)
            # as Heard(...), in a third of the time
            yield tuple.__new__(Heard, (entry.time_ms, entry.source, entry.topic, body))
            self._reader.add(entry, body)

    def told(self) -> Told:
        """The flight data, once all messages have been read."""
        return Told(self._reader.finish(), self._reading.digest)


def told_by(log: Path, mission: Mission) -> Told:
    """A log's flight data, from a pass of its own over the log."""
    reading = Reading(log)
    flight = read_flight(reading, (vehicle.id for vehicle in mission.vehicles))
    return Told(flight, reading.digest)


def mission_hash(mission: Mission) -> str:
    """Fingerprint of what was flown: the mission without the path it was read from."""
    return fingerprint(to_data(replace(mission, source="")))


def plan_hash(plan: Plan) -> str:
    """The fingerprint that identifies a plan."""
    return fingerprint(to_data(plan))


def ends_of(flight: Flight, asked: Mission) -> list[dict[str, Any]]:
    """Outcome of each task still requested at the end: a withdrawn task has not failed."""
    wanted = {task.id for task in asked.tasks}
    return [end for task, end in sorted(flight.served.items()) if task in wanted]


def build_report(
    mission: Mission,
    plan: Plan,
    judged: Judged,
    log: Path,
    flown: Flown,
) -> dict[str, Any]:
    """The whole report as plain data.

    log: the message log; flown: how it was flown. A row that a requirement promises and `judged`
    lacks is unknown: not observed. A flight with kernels that the ledger does not vouch for is at
    best unknown, and so is one in processes in which an assumption is broken.
    """
    flight, digest = judged.told or told_by(log, mission)
    done = {task for task, end in flight.served.items() if end["phase"] == "Complete"}
    seen = watched(mission, flight.end_ms, done, set(flight.accepted or plan.chosen))
    found = with_promised(list(judged.rows), seen)
    found.sort(key=lambda row: (row["requirement"], row["source"], row["item"]))
    requirements = requirement_rows(found)
    own = _own(flown, judged, log)
    outcomes = [Outcome(row["verdict"]) for row in (*requirements, *own.get("requirements", ()))]
    if flown.proofs["problems"] or without_ground(flown.command, judged.assumptions):
        outcomes.append(Outcome.UNKNOWN)
    return {
        "format": FORMAT,
        "product": {"name": "CRATOUS", "version": __version__},
        "verdict": str(worst(outcomes)),
        "exit_code": exit_code(outcomes),
        "counts": _counts(found),
        "mission": {**to_data(mission), "source": _shown(mission.source)},
        "mission_hash": mission_hash(mission),
        "command": flown.command,
        "avoidance": flown.avoidance,
        "not_covered": [v.id for v in mission.vehicles if not v.protected],
        "requirements": requirements,
        "constraints": found,
        **({OWN: own} if own else {}),
        "assumptions": judged.assumptions,
        BLAME: blame_rows(found, judged.commands, judged.assumptions, flight.end_ms),
        "plan": {**to_data(plan), "hash": plan_hash(plan)},
        "flight": {
            "outcome": flight.outcome,
            "end_ms": flight.end_ms,
            "tracks": {str(number): track for number, track in sorted(flight.tracks.items())},
            "track_columns": ["time_ms", "north_m", "east_m", "alt_m", "owner (0 UxAS, 1 ICAROUS)"],
            "bars": bars(flight),
            "takeovers": flight.takeovers,
            **({"alerts": flight.alerts} if flight.alerts else {}),
            **({"modes": spans(flight.modes, flight.end_ms)} if flight.modes else {}),
            "authority": flight.authority,
            "events": flight.events,
            "changes": flight.changes,
            "footprints": _seen(flight.footprints, mission),
            "served": ends_of(flight, seen.asked),
            "unserved": [task for task in sorted(seen.tasks) if task not in flight.served],
        },
        "log": {
            "file": LOG_NAME,
            "digest": digest,
            "messages": sum(flight.counts.values()),
            "by_topic": dict(sorted(flight.counts.items())),
        },
        "proofs": flown.proofs,
        "limits": [*LIMITS, *of_states(mission), _scale(mission)],
        "environment": flown.environment,
    }


def _own(flown: Flown, judged: Judged, log: Path) -> dict[str, Any]:
    """User requirements evaluated over the log; empty if there are none."""
    from cratous.services.certify.blame import told_of
    from cratous.services.certify.user_requirements import own_section
    from cratous.services.requirements.lint import lint

    if not flown.own:
        return {}
    return own_section(flown.own, log, told_of(judged.commands, judged.assumptions), lint)


def _seen(footprints: dict[int, list[dict[str, Any]]], mission: Mission) -> list[dict[str, Any]]:
    """Some of the footprints of each search that was flown, in the mission frame [m]."""
    from cratous.services.mission.frames import Projection

    local = Projection(mission.frame).to_local
    return [
        {
            "task": task,
            "vehicle": one["vehicle"],
            "time_ms": one["time_ms"],
            "corners": [[round(x, 1) for x in local(*corner)] for corner in one["corners"]],
        }
        for task, found in sorted(footprints.items())
        for one in found
    ]


def _counts(rows: list[dict[str, Any]]) -> dict[str, int]:
    return {str(outcome): sum(row["verdict"] == outcome for row in rows) for outcome in Outcome}


def _shown(source: str) -> str:
    """A path in a form that can be used again: relative, never absolute on one machine."""
    return source if not os.path.isabs(source) else Path(source).name


def _scale(mission: Mission) -> str:
    from math import hypot

    from cratous.services.mission.frames import scale_error

    places = [vehicle.position[:2] for vehicle in mission.vehicles]
    places += [point[:2] for task in mission.tasks for point in task.points]
    zones = [*mission.zones, *(c.zone for c in mission.changes if c.zone is not None)]
    places += [vertex for zone in zones for vertex in zone.vertices]
    reach = max(hypot(*place) for place in places)
    return (
        f"Within {reach / 1000:.1f} km of the frame's origin, where everything of this mission "
        f"lies, local distances are off by at most {scale_error(reach):.1e} of themselves."
    )


def environment() -> dict[str, Any]:
    """Python, system, versions of deciding libraries, code of services and bridge: part of no other digest."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    packages = {}
    for name in ("numpy", "numba", "z3-solver", "shapely", "pyproj", "lark", "lxml"):
        try:
            packages[name] = version(name)
        except PackageNotFoundError:
            packages[name] = "not installed"
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "packages": packages,
        "code": running_code(),
    }


def report_text(report: dict[str, Any]) -> str:
    """The text of report.json."""
    text = json.dumps(report, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False)
    return text + "\n"


def pages(report: dict[str, Any]) -> dict[str, str]:
    """The files that derive from report.json alone, by name."""
    return _pages(json.loads(report_text(report)))


def _pages(written: Any) -> dict[str, str]:
    from cratous.services.certify.html import map_svg, render

    return {HTML_NAME: render(written), MAP_NAME: map_svg(written)}


def write_report(report: dict[str, Any], folder: Path) -> None:
    """Write `report.json` and the files derived from it into a folder; each whole or not at all.

    Raises RuntimeError, and writes nothing, if the report violates the published schema: this is a
    program error.
    """
    from cratous.services.certify.report_schema import departures

    text = report_text(report)
    written = json.loads(text)
    wrong = departures(written)
    if wrong:
        raise RuntimeError(f"the report is not as its schema says: {wrong[0]}")
    for name, content in {REPORT_NAME: text, **_pages(written)}.items():
        write_atomically(folder / name, content, "the report")
