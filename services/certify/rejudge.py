"""Judges a finished flight again: first from its log alone, then against the files of its results."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.services.certify.blame import Commands, told_of
from cratous.services.certify.command import with_original_clients
from cratous.services.certify.differences import differences
from cratous.services.certify.flight_record import flown_of
from cratous.services.certify.report import (
    Judged,
    Telling,
    Told,
    build_report,
    mission_hash,
    plan_hash,
    report_text,
)
from cratous.services.certify.report_input import read_report
from cratous.services.certify.report_schema import departures
from cratous.services.certify.requirements_judged_again import files_in, together, with_own
from cratous.services.certify.result_files import Files
from cratous.services.certify.verdicts import (
    broken_of,
    constraint_rows,
    plan_rows,
)
from cratous.services.logs.log import Heard, read_heard, read_log, read_meta
from cratous.services.logs.records import from_data
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.mission.wind import known_at
from cratous.services.requirements.requirement_files import OwnFile
from cratous.services.results.names import (
    ASSUMPTIONS,
    BLAME,
    CERTIFICATE_NAME,
    COMMANDED_NAME,
    FORMER,
    HEARD,
    LOG_NAME,
    REPORT_NAME,
)
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Verdict
from cratous.spec.mission.plan import Plan

ACCEPTED = "cratous.PlanAccepted"


def subject(log: Path) -> tuple[Mission, Plan]:
    """The mission and the plan that a log was made for."""
    meta = read_meta(log)
    for key in ("mission", "plan"):
        if key not in meta:
            raise BadInput(
                "the log does not say what was flown",
                where=str(log),
                item=f"meta.{key}",
                expected=f"the {key}",
                got="nothing",
            )
    try:
        mission = from_data(Mission, meta["mission"])
        times = asdict(mission.bridge_times)
        if not all(lasted(0, time_ms, 1) for time_ms in times.values()):
            item, expected = "Mission.bridge", "times of more than 0 ms"
            raise BadInput("does not fit", item=item, expected=expected, got=str(times))
        return mission, from_data(Plan, meta["plan"])
    except BadInput as error:
        error.where = error.where or f"{log}, meta"
        raise


class Watched(NamedTuple):
    """What a monitor has found: its verdicts, a row for each assumption of the system theorems, and
    the commanders over time (`Monitor.commands`).
    """

    verdicts: list[Verdict]
    assumptions: list[dict[str, Any]]
    commands: Commands
    end_ms: int


def watch(log: Path, messages: Iterable[Heard] | None = None) -> Watched:
    """The findings of a fresh monitor on the messages of a log. messages: the log's, if already being read."""
    from cratous.services.monitor import Monitor

    meta = read_meta(log)
    command = meta.get("command")
    original = isinstance(command, str) and with_original_clients(command)
    monitor = Monitor(*subject(log), says_beats=not original, on_board=meta.get(HEARD) is True)
    for heard in read_heard(log) if messages is None else messages:
        monitor.tap(heard)
    return Watched(monitor.verdicts(), monitor.assumptions(), monitor.commands(), monitor.end_ms)


def watched_and_told(log: Path, mission: Mission) -> tuple[Watched, Told]:
    """Monitor findings and flight data from a single pass over a log."""
    telling = Telling(log, mission)
    return watch(log, telling.heard()), telling.told()


@dataclass(frozen=True)
class Judgement:
    """Result of certifying. report: derived from the log; found: discrepancies (empty: confirmed).

    unchecked: what neither the log nor this program can vouch for, with the reason; rewritten:
    files regenerated because the user asked for it.
    """

    report: dict[str, Any]
    found: list[str]
    unchecked: list[str] = field(default_factory=list)
    rewritten: list[str] = field(default_factory=list)


def certify_again(folder: Path, *, rewrite: bool = False, own: Sequence[OwnFile] = ()) -> Judgement:
    """Judge the flight in a folder again and compare every file with the result.

    rewrite: regenerate differing files that derive from report.json, if all else is confirmed; own:
    requirement files with which a confirmed report is rebuilt. Without these two nothing is
    written.
    """
    written = read_report(folder)
    log = folder / LOG_NAME
    wrong = log_faults(log, written)
    if wrong:
        return Judgement({}, wrong, ["all else: the log is not the one of the report"])
    report, silent, found = rebuilt(log, written)
    left = {key: value for key, value in silent.items() if "." not in key}
    former = written["format"] == FORMER
    found += differences(_compared(written, left, former), _compared(report, left, former))
    if not former:  # the schema covers the current format only
        whole = {**written, **{key: report[key] for key in left if key not in written}}
        found += [f"{REPORT_NAME}, by its schema: {line}" for line in departures(whole)]
    mission, plan = subject(log)
    meta = read_meta(log)
    files = Files(folder, report, meta, same=not found)
    found += _certificate(plan, folder) + files.wrong
    if files.commanded:
        found += _commanded(mission, folder / COMMANDED_NAME)
    unchecked = [f"{key}: {why}" for key, why in sorted(silent.items())] + files.unchecked
    if own and not found and (rewrite or not files.differing):
        kept, _ = files_in(report, meta)
        told = told_of(watch(log).commands, report["assumptions"])
        report = with_own(report, together(kept, meta, own), log, told)
        anew = Files(folder, report, meta, same=True)
        return Judgement(report, anew.wrong, unchecked, anew.rewrite() if anew.differing else [])
    if rewrite and files.differing and not found:
        return Judgement(report, [], unchecked, files.rewrite())
    return Judgement(report, found + files.differing, unchecked)


def _commanded(mission: Mission, file: Path) -> list[str]:
    """Evidence that the mission with the operator's commands differs from the one in the log."""
    from cratous.services.loading import load

    try:
        stated = load(file, mission.seed)
    except CratousError as error:
        return [f"{COMMANDED_NAME}: {error}"]
    if not mission.instances:  # flown without avoidance, as the report's command says
        stated = replace(stated, instances=())
    if mission_hash(replace(stated, notes=())) == mission_hash(replace(mission, notes=())):
        return []
    return [f"{COMMANDED_NAME}: it is not the mission that was flown"]


def _compared(report: dict[str, Any], left: Container[str], former: bool) -> dict[str, Any]:
    """The entries of a report that are compared: without those left out, in the former format without kernels."""
    found = {key: value for key, value in report.items() if key not in left}
    rows = found.get("constraints")
    if former and isinstance(rows, list):
        found["constraints"] = [
            {key: value for key, value in row.items() if key != "kernels"}
            if isinstance(row, dict)
            else row
            for row in rows
        ]
    return found


def log_faults(log: Path, written: dict[str, Any]) -> list[str]:
    """Evidence that the log was altered, or belongs to another report."""
    subject(log)
    with SqliteLog(log) as source:
        digest, closing = source.digest(), source.closing()
        ended = source.old or closing is not None
    found = []
    if not ended:
        found.append(f"{LOG_NAME}: its writer never said that it is whole")
    if closing is not None and closing.digest != digest:
        found.append(f"{LOG_NAME}: digest at its end {closing.digest}, of its messages {digest}")
    of_report = written.get("log")
    stated = of_report.get("digest") if isinstance(of_report, dict) else None
    found += differences(stated, digest, "log.digest")
    # once an alteration is found, further checks mean nothing
    return found or not_as_flown(log)


def not_as_flown(log: Path) -> list[str]:
    """Evidence that the mission or plan in the log's meta is not the one of its messages."""
    meta = read_meta(log)
    mission, plan = subject(log)
    found = []
    if "mission_hash" in meta and meta["mission_hash"] != mission_hash(mission):
        return [f"{LOG_NAME}: meta.mission is not the mission that was flown"]
    accepted = next((row for row in read_log(log) if row.topic == ACCEPTED), None)
    if accepted is not None and _plan_hash(accepted.body) != plan_hash(plan):
        found.append(f"{LOG_NAME}: meta.plan is not the plan that was accepted")
    return found


def _plan_hash(body: str) -> Any:
    """Hash of the plan that a message reports as accepted; None if it cannot be read."""
    try:
        return json.loads(body)["PlanHash"]
    except (ValueError, TypeError, LookupError, RecursionError):
        return None


def rebuilt(log: Path, written: dict[str, Any]) -> tuple[dict[str, Any], dict[str, str], list[str]]:
    """The report derived from the log, the entries that could not be checked, and the faults.

    The proof inventory is rebuilt if the ledger is still that of the flight, otherwise compared
    with the digest in the log.
    """
    from cratous.services.monitor.plan_check import check_plan

    mission, plan = subject(log)
    flown, silent, wrong, lacking = flown_of(read_meta(log), written, str(log))
    rows = plan_rows(check_plan(known_at(mission, 0), plan))
    watched, told = watched_and_told(log, mission)
    rows += constraint_rows(watched.verdicts, "flight")
    judged = Judged(rows, watched.assumptions, watched.commands, told)
    report = json.loads(report_text(build_report(mission, plan, judged, log, flown)))
    if wrong:  # one sentence states it; detailed differences add nothing
        report["proofs"] = written.get("proofs")
    wrong += lacking
    recorded = read_meta(log).get(ASSUMPTIONS)
    if recorded is not None:
        broken = broken_of(report["assumptions"])
        wrong += differences(recorded, broken, f"{LOG_NAME}: meta.{ASSUMPTIONS}")
    elif "assumptions" not in written:
        silent["assumptions"] = "the report was made before they were watched"
    if BLAME not in written:
        silent[BLAME] = "the report was made before it was told"
    return report, silent, wrong


def _certificate(plan: Plan, folder: Path) -> list[str]:
    """Faults of the certificate that the plan names."""
    from cratous.services.planning.assign_certificate import read, verify

    if not plan.certificate:
        return []
    try:
        body = read(folder / CERTIFICATE_NAME)
    except BadInput as error:
        return [f"{CERTIFICATE_NAME}: {error}"]
    if body.get("sha256") != plan.certificate:
        return [f"{CERTIFICATE_NAME}: it is not the one that the plan names"]
    verdict = verify(body)
    if verdict.wrong:
        return [f"{CERTIFICATE_NAME}: {verdict.wrong}"]
    if (verdict.status, verdict.bound) != (plan.status, plan.bound):
        return [f"{CERTIFICATE_NAME}: the plan claims something else than it"]
    return []
