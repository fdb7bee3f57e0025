"""Runs one mission in several processes: proof gate, plan, check, flight, monitor, certificate."""

from __future__ import annotations

from contextlib import ExitStack, closing
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
from cratous.services.exporting.messages import Told
from cratous.services.logs.log import LogWriter
from cratous.services.processes.amase import Amase
from cratous.services.processes.coverage import refuse_for_amase, told_of
from cratous.services.processes.direct_links import direct_links
from cratous.services.processes.flight import Flying, fly
from cratous.services.processes.recorder import Recorder
from cratous.services.results.names import LOG_NAME
from cratous.spec.mission import Mission

STATES_MS = 550
"""The simulator publishes states twice a second; maximum interval between two [ms]."""

UNCERTIFIED = (
    "the bridge between processes has no message for certificates: a vehicle that ICAROUS has holds where it is, "
    "without anybody avoiding, while its ICAROUS is not heard"
)

OTHERS = (
    "which was not started here: its states are all that is known of where they were, its law of motion is its own, "
    "and which program it is, and who else commanded there, is not known"
)
PUT_BACK = (
    "its aircraft were put where their last states had them, with the commands that held, and the time of the flight "
    "went on from there; what it flew after those states counts for nothing"
)


def run_in_processes(
    mission: Mission, path: Path, folder: Path, settings: Settings, how: InProcesses, tell: Tell
) -> dict[str, Any]:
    """Fly one mission in processes, write log and report into `folder`; returns the report as data.

    path: of the mission file, which the ICAROUS processes read.
    """
    digest = mission_hash(mission)
    mission = as_flown(mission if settings.daa else replace(mission, instances=()), how)
    told = told_of(mission, how.original)
    direct = None if how.direct is None else direct_links(how.direct, mission.instances)
    with ExitStack() as stack:
        amase = None
        if how.amase is not None:
            refuse_for_amase(mission)
            # check that AMASE answers before planning
            amase = stack.enter_context(closing(Amase(how.amase, tell)))
        flying = Flying(
            path,
            digest,
            folder,
            how.rate,
            settings.allow_unproved,
            tell,
            how.original,
            amase,
            direct,
        )
        return _run(mission, told, settings, flying)


def _run(mission: Mission, told: Told, settings: Settings, flying: Flying) -> dict[str, Any]:
    """Plan, check, fly and judge; log and report are in the folder of `flying`."""
    folder, tell = flying.folder, flying.tell
    standing = ledger.require(allow_unproved=settings.allow_unproved)
    tell(f"proofs: {standing.line}")
    proofs = inventory(standing, None)
    flown = Flown(settings.command, settings.daa, proofs, environment(), settings.own)
    log = folder / LOG_NAME
    with LogWriter(log, **log_meta(mission, flown, on_board=False)) as writer:
        with counted() as calls:
            planning, bus = new_bus(), new_bus()
            plan, checks = plan_and_check(mission, planning)
            tell_plan(mission, plan, checks, tell)
            accept_plan(plan, checks, planning, folder, writer)
            monitor = watching(mission, plan, tell, says_beats=not flying.original, on_board=False)
            bus.tap(writer.tap)
            bus.tap(monitor.tap)
            ended = fly(mission, plan, told, Recorder(mission, bus), flying)
            writer.note("processes", {"pids": ended.pids, "ports": ended.ports})
            if flying.amase is not None and flying.amase.met_again:
                mission = _met_again(mission, flying.amase)
                for key, value in log_meta(mission, flown, on_board=False).items():
                    writer.note(key, value)
            if ended.why:
                tell(f"NOT FLOWN TO ITS END: {ended.why}")
            verdicts, assumptions = monitor.verdicts(), monitor.assumptions()
        flown = noted(writer, flown, standing, calls.data(), assumptions)
    tell(f"evidence: {summary(flown.proofs)}")
    rows = plan_rows(checks) + constraint_rows(verdicts, "flight")
    report = build_report(mission, plan, Judged(rows, assumptions, monitor.commands()), log, flown)
    write_report(report, folder)
    return report


def _met_again(mission: Mission, amase: Amase) -> Mission:
    """The mission with a note of when AMASE was lost and reconnected."""
    note = f"AMASE was lost and met again {', '.join(amase.met_again)}: {PUT_BACK}"
    return replace(mission, notes=(*mission.notes, note))


def as_flown(mission: Mission, how: InProcesses) -> Mission:
    """The mission as flown in processes: interval of its states, and notes on this kind of flight."""
    count, known = len(mission.instances), ""
    ours = 2 if how.amase is None else 1
    simulator = "the simulator, " if how.amase is None else ""
    who = f"flown in {ours + count} processes: {simulator}UxAS and {count} of ICAROUS, with a key for each vehicle"
    if how.original:
        who = f"flown in processes: {simulator}UxAS, and {count} clients of the original's"
        known = "which ICAROUS is behind them is not known here; "
    if how.direct is not None:
        who += f"; their ICAROUS tell each other their states directly, at {how.direct.text}"
    note = f"{who}; {known}between two states, up to {STATES_MS} ms apart, aircraft are taken to fly straight"
    simulation = replace(mission.simulation, step_ms=STATES_MS)
    notes = (*mission.notes, note, UNCERTIFIED)
    if how.amase is not None:
        where = how.amase.text.removeprefix("tcp://")
        notes = (*notes, f"the aircraft flew in AMASE at {where}, {OTHERS}")
    return replace(mission, simulation=simulation, notes=notes)
