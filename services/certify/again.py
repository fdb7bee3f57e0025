"""Judge a finished flight again: from its log alone, then against its report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cratous.services.certify.proofs import inventory
from cratous.services.certify.report import (
    build_report,
    differences,
    read_report,
    write_report,
)
from cratous.services.certify.verdicts import constraint_rows
from cratous.services.log import read_envelopes, read_meta
from cratous.services.records import from_data
from cratous.services.results.names import CERTIFICATE_NAME, LOG_NAME
from cratous.services.wind import known_at
from cratous.spec.errors import BadInput
from cratous.spec.guarantees import Verdict
from cratous.spec.mission import Mission
from cratous.spec.plan import Plan


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
        return from_data(Mission, meta["mission"]), from_data(Plan, meta["plan"])
    except BadInput as error:
        error.where = error.where or f"{log}, meta"
        raise


def watch(log: Path) -> list[Verdict]:
    """The verdicts of a fresh monitor that sees the messages of a log."""
    from cratous.services.monitor import Monitor

    monitor = Monitor(*subject(log))
    for envelope in read_envelopes(log):
        monitor.tap(envelope)
    return monitor.verdicts()


def certify_again(folder: Path) -> tuple[dict[str, Any], list[str]]:
    """The written report, and where it differs from what its log says (nothing: confirmed).

    If it is confirmed, report.html and map.svg are written again from report.json. The proof inventory is
    compared if the ledger is still the one of the flight; what it did not vouch for then stands
    in the log.
    """
    from cratous.core import ledger
    from cratous.services.plan_check import check_plan

    written = read_report(folder)
    log = folder / LOG_NAME
    mission, plan = subject(log)
    rows = constraint_rows(check_plan(known_at(mission, 0), plan), "plan")
    rows += constraint_rows(watch(log), "flight")
    standing = ledger.require(allow_unproved=bool(written["proofs"]["problems"]))
    proofs, flown = inventory(standing), read_meta(log).get("proofs", {})
    if proofs["seal"] != flown.get("seal"):
        proofs = {**written["proofs"], "seal": flown.get("seal")}
    proofs["problems"] = flown.get("problems", [])
    again = build_report(
        mission,
        plan,
        rows,
        log,
        command=written["command"],
        daa=written["avoidance"],
        proofs=proofs,
    )
    found = differences(
        {**written, "proofs": _stable(written["proofs"])}, {**again, "proofs": _stable(proofs)}
    )
    found += _certificate(plan, folder)
    if not found:
        write_report(written, folder)
    return written, found


def _certificate(plan: Plan, folder: Path) -> list[str]:
    """What is wrong with the certificate that the plan names."""
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


def _stable(proofs: dict[str, Any]) -> dict[str, Any]:
    """The inventory without the line that also counts what is vouched for today."""
    return {key: value for key, value in proofs.items() if key != "line"}
