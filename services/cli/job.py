"""Runs one mission: proof gate, plan, check, flight, monitor, certificate."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from cratous.services.cli.plan_lines import left_out_lines, plan_line
from cratous.services.loading.fitness import warnings_of
from cratous.services.mission.availability import absent
from cratous.services.mission.wind import known_at
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Change, Mission
from cratous.spec.mission.guarantees import Outcome, Verdict
from cratous.spec.mission.plan import Plan
from cratous.spec.mission.sensing import EXACT_STATES, words

if TYPE_CHECKING:
    from cratous.bridge.port import Address
    from cratous.services.certify.report import Flown
    from cratous.services.logs.log import LogWriter
    from cratous.services.monitor import Monitor
    from cratous.services.requirements.requirement_files import OwnFile
    from cratous.services.startup.gate_process import Gate, Here

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Settings:
    """How a mission is run; `command` reproduces it, `again` does so if vehicles were commanded in
    flight; own: user requirements.
    """

    daa: bool = True
    allow_unproved: bool = False
    command: str = ""
    own: tuple[OwnFile, ...] = ()
    again: str = ""


class InProcesses(NamedTuple):
    """How a mission is flown in processes. rate: multiple of real time; original: ICAROUS is behind
    its original clients, started by the user; amase: address of an AMASE used as the simulator;
    direct: multicast group of the direct links.
    """

    rate: float = 1.0
    original: bool = False
    amase: Address | None = None
    direct: Address | None = None


class Onlooker(Protocol):
    """Observes a run without changing it, except for its pacing and for operator commands."""

    def joined(self, bus: Any) -> None:
        """Called with the bus before it carries any message."""

    def planned(self, checks: list[Verdict], monitor: Any) -> None:
        """Called when the plan has been checked and is flown, with the monitor."""

    def directed(self, now_ms: int) -> tuple[Change, ...]:
        """Operator commands for vehicles at a step."""

    def commanded(self) -> Mission | None:
        """The mission with all operator commands; None if there were none."""


def silent(_text: str) -> None:
    """Ignore progress messages."""


def new_bus() -> Any:
    """A bus for LMCP bodies."""
    from cratous.bridge import lmcp
    from cratous.services.bus import Bus

    return Bus(lmcp.full_names)


def plan_and_check(mission: Mission, bus: Any) -> tuple[Plan, list[Verdict]]:
    """The plan, and the kernels' verdicts on it. NoPlan with reasons if there is none."""
    from cratous.services.monitor.plan_check import check_plan
    from cratous.services.pipeline.plan import make_plan

    known = known_at(mission, 0)
    plan = make_plan(known, bus, absent=absent(mission, 0))
    return plan, check_plan(known, plan)


OPTIONS, ASKED, ANSWERED, COSTS = TOLD = (
    "TaskPlanOptions", "RoutePlanRequest", "RoutePlanResponse", "AssignmentCostMatrix",
)  # fmt: skip


def planning_told(at: Callable[[str, int, int], None], tasks: int) -> Callable[[Any], None]:
    """A bus tap that reports planning progress; tasks: number of requested tasks."""
    seen = dict.fromkeys(TOLD, 0)
    at("planning the options of the tasks", 0, tasks)

    def tap(message: Any) -> None:
        name = message.topic.rpartition(".")[2]
        if name not in seen or (name in (ASKED, ANSWERED) and seen[OPTIONS] < tasks):
            return  # a task requests its own routes while it computes its options
        seen[name] += 1
        if seen[COSTS]:
            at("searching for the best assignment", 0, 0)
        elif seen[OPTIONS] < tasks:
            at("planning the options of the tasks", seen[OPTIONS], tasks)
        else:
            at("planning the ways between the tasks", seen[ANSWERED], seen[ASKED])

    return tap


def absent_lines(mission: Mission) -> list[str]:
    """A line for each vehicle that is absent at the start."""
    away = absent(mission, 0).items()
    return [f"vehicle {vehicle} takes no part at the start: {why}" for vehicle, why in away]


def write_certificate(bus: Any, file: Path) -> None:
    """Write the certificate of the plan made on a bus to `file`; NoPlan if there is no plan."""
    from cratous.services.pipeline.plan import certificate_of
    from cratous.services.planning.assign_certificate import write

    certificate = certificate_of(bus)
    if certificate is None:
        raise NoPlan(("nothing was assigned, so there is no certificate",))
    write(file, certificate)


def folder_name(mission: Mission) -> str:
    """Name of the output folder: the mission's, with the variant number."""
    return f"{mission.name}-seed{mission.seed}" if mission.seed else mission.name


PLANNED_WITH = (
    "certify.evidence", "certify.proofs", "certify.verdicts", "monitor.plan_check",
    "pipeline.plan", "logs.records",
)  # fmt: skip
"""Services with which a mission is planned."""
FLOWN_WITH = (
    *PLANNED_WITH, "flight.loop", "flight.landing_reach", "flight.take_off",
    "assumptions.observation_texts", "certify.blame_texts", "daa.intervals",
    "icarous.band_choices", "logs.log", "certify.user_requirements", "certify.report_schema",
    "certify.html",
)  # fmt: skip
"""Services with which a mission is flown and reported."""


def imported(services: tuple[str, ...]) -> None:
    """Import services, and the library for positions on the Earth, before they are needed."""
    for name in services:
        importlib.import_module(f"cratous.services.{name}")
    importlib.import_module("pyproj")


def _flight_prepared() -> None:
    """Import what a mission is flown with, and identify this code."""
    from cratous.services.certify.report import environment

    imported(FLOWN_WITH)
    environment()


def run_mission(
    mission: Mission,
    folder: Path,
    settings: Settings,
    tell: Tell = silent,
    onlooker: Onlooker | None = None,
    gate: Gate | Here | None = None,
) -> dict[str, Any]:
    """Fly one mission and write log and report into `folder`; returns the report as data.

    gate: begun already; None: it runs here.
    """
    from cratous.services.certify.report import write_report
    from cratous.services.startup.gate_process import Here

    gate = gate or Here(settings.allow_unproved)
    standing = gate.standing(_flight_prepared)
    tell(f"proofs: {standing.line}")
    report = fly_mission(mission, folder, settings, standing, tell, onlooker)
    write_report(report, folder)
    return report


def fly_mission(
    mission: Mission,
    folder: Path,
    settings: Settings,
    standing: Any,
    tell: Tell = silent,
    onlooker: Onlooker | None = None,
) -> dict[str, Any]:
    """Fly one mission and write its log into `folder`; returns the report as data.

    standing: of `core.ledger.require`, taken before anything is flown in this process.
    """
    from cratous.services.certify.evidence import counted
    from cratous.services.certify.proofs import inventory, summary
    from cratous.services.certify.report import Flown, Judged, build_report, environment
    from cratous.services.certify.verdicts import constraint_rows, plan_rows
    from cratous.services.flight.landing_reach import require_reachable
    from cratous.services.flight.loop import fly
    from cratous.services.flight.take_off import require_take_offs
    from cratous.services.logs.log import LogWriter
    from cratous.services.results.names import LOG_NAME

    if not settings.daa:
        mission = replace(mission, instances=())
    require_reachable(mission)
    require_take_offs(mission)
    bus = new_bus()
    log = folder / LOG_NAME
    proofs = inventory(standing, None)
    flown = Flown(settings.command, settings.daa, proofs, environment(), settings.own)
    with LogWriter(log, **log_meta(mission, flown)) as writer:
        bus.tap(writer.tap)
        if onlooker is not None:
            onlooker.joined(bus)
        bus.tap(planning_told(_passing(tell), len(mission.tasks)))
        with counted() as calls:
            plan, checks = plan_and_check(mission, bus)
            tell_plan(mission, plan, checks, tell)
            accept_plan(plan, checks, bus, folder, writer)
            monitor = watching(mission, plan, tell)
            bus.tap(monitor.tap)
            if onlooker is not None:
                onlooker.planned(checks, monitor)
            directed = None if onlooker is None else onlooker.directed
            fly(
                mission, plan, bus, daa=settings.daa, progress=_progress(tell), directed=directed
            )  # fmt: skip
            verdicts, assumptions = monitor.verdicts(), monitor.assumptions()
        commanded = None if onlooker is None else onlooker.commanded()
        if commanded is not None:
            mission, flown = as_flown(commanded, settings, flown, writer)
        flown = noted(writer, flown, standing, calls.data(), assumptions)
    tell(f"evidence: {summary(flown.proofs)}")
    rows = plan_rows(checks) + constraint_rows(verdicts, "flight")
    return build_report(mission, plan, Judged(rows, assumptions, monitor.commands()), log, flown)


def log_meta(mission: Mission, flown: Flown, on_board: bool = True) -> dict[str, Any]:
    """The meta data of a log before the flight. on_board: as for `Monitor`."""
    from cratous import __version__
    from cratous.services.certify.report import mission_hash
    from cratous.services.logs.records import to_data
    from cratous.services.results.names import HEARD

    return {
        HEARD: on_board,
        "mission": to_data(mission),
        "version": __version__,
        "seed": mission.seed,
        "mission_hash": mission_hash(mission),
        **flown.meta(),
    }


def as_flown(
    commanded: Mission, settings: Settings, flown: Flown, writer: LogWriter
) -> tuple[Mission, Flown]:
    """The mission with the operator's commands, and its flight data, both stored in the log."""
    mission = commanded if settings.daa else replace(commanded, instances=())
    flown = replace(flown, command=settings.again)
    for key, value in log_meta(mission, flown).items():
        writer.note(key, value)
    return mission, flown


def tell_plan(mission: Mission, plan: Plan, checks: list[Verdict], tell: Tell) -> None:
    """Report unsuitable parameters, the plan, what it leaves out, and vehicles absent at the start."""
    from cratous.services.monitor.moving_plan import meeting_lines

    for line in (
        *(f"note: {text}" for text in warnings_of(mission)),
        plan_line(mission, plan, checks),
        *left_out_lines(plan),
        *absent_lines(mission),
        *meeting_lines(mission, plan),
        *states_lines(mission),
    ):
        tell(line)


def states_lines(mission: Mission) -> list[str]:
    """A line on the traffic states that ICAROUS receives, if any vehicle has an ICAROUS."""
    if not mission.instances:
        return []
    return [EXACT_STATES if mission.sensing is None else words(mission.sensing)]


def accept_plan(
    plan: Plan, checks: list[Verdict], bus: Any, folder: Path, writer: LogWriter
) -> None:
    """Store a plan that passes its check in the log, and its certificate in `folder`; NoPlan if it fails."""
    from cratous.services.logs.records import to_data
    from cratous.services.results.names import CERTIFICATE_NAME

    refuse_bad_plan(checks)
    if plan.certificate:
        write_certificate(bus, folder / CERTIFICATE_NAME)
    writer.note("plan", to_data(plan))


def watching(
    mission: Mission, plan: Plan, tell: Tell, says_beats: bool = True, on_board: bool = True
) -> Monitor:
    """A monitor of the flight that reports violations and broken assumptions as they occur.

    says_beats, on_board: as for `Monitor`.
    """
    from cratous.services.assumptions.observation_texts import sentence as assumed
    from cratous.services.certify.blame import blame_rows
    from cratous.services.certify.blame_texts import sentence as blamed
    from cratous.services.certify.verdicts import constraint_rows
    from cratous.services.monitor import Monitor

    def violated(verdict: Verdict) -> None:
        rows = constraint_rows([verdict], "flight")
        (one,) = blame_rows(rows, monitor.commands(), monitor.assumptions(), monitor.end_ms)
        who = blamed(one, over=False)
        tell(f"VIOLATION {sentence(verdict)}" + (f"; {who}" if who else ""))

    monitor = Monitor(
        mission,
        plan,
        violated,
        lambda row: tell(f"ASSUMPTION {assumed(row)}"),
        says_beats,
        on_board,
    )
    return monitor


def noted(
    writer: LogWriter, flown: Flown, standing: Any, counts: dict[str, Any], assumptions: Any
) -> Flown:
    """The flight data after its end, stored in the log too.

    standing: of the ledger; counts: the calls of each kernel; assumptions: the monitor's findings.
    """
    from cratous.services.certify.proofs import inventory
    from cratous.services.certify.verdicts import broken_of
    from cratous.services.results.names import ASSUMPTIONS

    flown = replace(flown, proofs=inventory(standing, counts))
    writer.note("calls", counts)
    writer.note(ASSUMPTIONS, broken_of(assumptions))
    writer.note("proofs", flown.meta()["proofs"])
    return flown


def refuse_bad_plan(checks: list[Verdict]) -> None:
    """Raise NoPlan if a plan fails its check; a partial plan may fail only in being partial."""
    from cratous.services.monitor.plan_check import PART, WHOLE

    bad = [check for check in checks if check.outcome is Outcome.VIOLATED]
    if any(check.item == PART for check in checks):
        bad = [check for check in bad if check.item != WHOLE]
    if bad:
        raise NoPlan(tuple(f"the best plan found fails its check: {sentence(c)}" for c in bad[:5]))


def _passing(tell: Tell) -> Callable[[str, int, int], None]:
    """Reports the current activity as a line that the next one may overwrite."""
    return lambda what, done, of: tell(f"\r{what}" + (f": {done} of {of}" if of else ""))


def _progress(tell: Tell) -> Callable[[int, str], None]:
    """A progress callback for the flight; its line may be overwritten by the next one."""

    def show(now_ms: int, text: str) -> None:
        tell(f"\r{now_ms / 1000:7.1f} s of flight: {text}")

    return show


def sentence(verdict: Verdict) -> str:
    """A verdict in one line: requirement, what, time, vehicles, margin."""
    text = f"{verdict.requirement} {verdict.item}".strip()
    if verdict.time_ms is not None:
        text += f" at {verdict.time_ms / 1000:.2f} s"
    if verdict.vehicles:
        text += f", vehicles {', '.join(map(str, verdict.vehicles))}"
    if verdict.margin is not None:
        text += f", margin {verdict.margin:.4g} {verdict.unit}"
    return f"{text}: {verdict.note}"
