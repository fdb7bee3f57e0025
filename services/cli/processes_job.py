"""The main job for one mission in processes: gate, plan, check, fly, monitor, certify."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from cratous.core import ledger
from cratous.services.certify.evidence import counted
from cratous.services.certify.proofs import inventory, summary
from cratous.services.certify.report import (
    Flown,
    Judged,
    build_report,
    environment,
    mission_hash,
    write_report,
)
from cratous.services.certify.verdicts import constraint_rows, plan_rows
from cratous.services.cli.job import (
    InProcesses,
    Settings,
    Tell,
    accept_plan,
    log_meta,
    new_bus,
    noted,
    plan_and_check,
    tell_plan,
    watching,
)
from cratous.services.logs.log import LogWriter
from cratous.services.processes.coverage import told_of
from cratous.services.processes.flight import Flying, fly
from cratous.services.processes.recorder import Recorder
from cratous.services.results.names import LOG_NAME
from cratous.spec.mission import Mission

STATES_MS = 550
"""The simulator tells states twice a second; so far apart [ms] are two of them at most."""

UNCERTIFIED = (
    "the bridge between processes has no message for certificates: a vehicle that ICAROUS has holds where it is, "
    "without anybody avoiding, while its ICAROUS is not heard"
)


def run_in_processes(
    mission: Mission, path: Path, folder: Path, settings: Settings, how: InProcesses, tell: Tell
) -> dict[str, Any]:
    """Fly one mission in processes, write log and report into `folder`; returns the report as data.

    path: of the mission, which the ICAROUS processes read.
    """
    digest = mission_hash(mission)
    mission = as_flown(mission if settings.daa else replace(mission, instances=()), how.original)
    told = told_of(mission, how.original)
    standing = ledger.require(allow_unproved=settings.allow_unproved)
    tell(f"proofs: {standing.line}")
    proofs = inventory(standing, None)
    flown = Flown(settings.command, settings.daa, proofs, environment(), settings.own)
    log = folder / LOG_NAME
    with LogWriter(log, **log_meta(mission, flown)) as writer:
        with counted() as calls:
            planning, bus = new_bus(), new_bus()
            plan, checks = plan_and_check(mission, planning)
            tell_plan(mission, plan, checks, tell)
            accept_plan(plan, checks, planning, folder, writer)
            monitor = watching(mission, plan, tell, says_beats=not how.original)
            bus.tap(writer.tap)
            bus.tap(monitor.tap)
            flying = Flying(
                path, digest, folder, how.rate, settings.allow_unproved, tell, how.original
            )
            ended = fly(mission, plan, told, Recorder(mission, bus), flying)
            writer.note("processes", {"pids": ended.pids, "ports": ended.ports})
            if ended.why:
                tell(f"NOT FLOWN TO ITS END: {ended.why}")
            verdicts, assumptions = monitor.verdicts(), monitor.assumptions()
        flown = noted(writer, flown, standing, calls.data(), assumptions)
    tell(f"evidence: {summary(flown.proofs)}")
    rows = plan_rows(checks) + constraint_rows(verdicts, "flight")
    report = build_report(mission, plan, Judged(rows, assumptions, monitor.commands()), log, flown)
    write_report(report, folder)
    return report


def as_flown(mission: Mission, original: bool = False) -> Mission:
    """The mission as it is flown in processes: how far apart its states are, and what has to be known of it.

    original: ICAROUS is behind clients of the original's.
    """
    count, known = len(mission.instances), ""
    who = f"flown in {2 + count} processes: the simulator, UxAS and {count} of ICAROUS, with a key for each vehicle"
    if original:
        who = f"flown in processes: the simulator, UxAS, and {count} clients of the original's"
        known = "which ICAROUS is behind them is not known here; "
    note = f"{who}; {known}between two states, up to {STATES_MS} ms apart, aircraft are taken to fly straight"
    simulation = replace(mission.simulation, step_ms=STATES_MS)
    return replace(mission, simulation=simulation, notes=(*mission.notes, note, UNCERTIFIED))
