"""Compares a report's verdicts on the flight with those of the judge.

The judge has no excuses. Where it finds a loss of well clear that the report excuses, the report's
evidence must concern that loss and be complete; the judge cannot confirm that there was no way out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.services.attestation.findings import Data
from cratous.services.results.names import REPORT_NAME
from cratous.spec.mission.guarantees import Outcome

OPPOSITE = {Outcome.HOLDS, Outcome.VIOLATED}
NO_WAY = "no way out"


class Held(NamedTuple):
    """Result. expected: number of rows that the judge expects; confirmed: those on which it agrees;
    verdict: `holds` only if both agree on it for every row, `violated` if the report states it and
    nothing refutes it, otherwise `unknown`.
    """

    refused: list[str]
    undecided: list[str]
    expected: int
    confirmed: int
    verdict: str


def held(report: Data, judgement: Any) -> Held:
    """Compare the report with a judgement (`cratous.judge.Judgement`) of its log."""
    refused = [f"{REPORT_NAME}: {one.line()}" for one in judgement.disagreements]
    if sorted(report["not_covered"]) != sorted(judgement.not_covered):
        refused.append(
            f"{REPORT_NAME}: not covered are {report['not_covered']}, by the log "
            f"{list(judgement.not_covered)}"
        )
    named = {one.item for one in judgement.disagreements}
    undecided: list[str] = []
    for one in judgement.answers:
        if one.confirmed or one.item in named:
            continue
        wrong, text = _unconfirmed(one, report, judgement)
        (refused if wrong else undecided).append(f"{one.guarantee} {one.item}: {text}")
    open_ = {line[:2] for line in undecided}
    undecided += [
        f"{row['requirement']}: the judge says {judgement.of(row['requirement'])}"
        for row in report["requirements"]
        if row["verdict"] == Outcome.HOLDS
        and judgement.of(row["requirement"]) != Outcome.HOLDS
        and row["requirement"] not in open_
    ]
    expected = [one for one in judgement.answers if one.judge]
    confirmed = sum(one.confirmed for one in expected)
    verdict = _shown(report, judgement, undecided)
    return Held(refused, undecided, len(expected), confirmed, verdict)


def _unconfirmed(one: Any, report: Data, judgement: Any) -> tuple[bool, str]:
    """Whether a row is refused, and the reason in words."""
    if one.foreign:
        return True, f"{one.monitor}, a row that is none on this mission, or there twice"
    if not one.judge:
        return False, f"{one.monitor}, the judge has no such row"
    if not one.monitor:
        return False, f"no row in the report, the judge says {one.judge}"
    text = f"{one.monitor}, the judge says {one.judge}"
    if one.monitor == Outcome.EXCUSED and one.guarantee != "G2":
        return True, f"{text}; only a loss of well clear can be excused"
    if (one.monitor, one.judge) == (Outcome.EXCUSED, Outcome.VIOLATED):
        wrong = _excuse_fault(one, report, judgement)
        return bool(wrong), f"{text}; {wrong or 'it does not judge excuses (cratous certify does)'}"
    return {one.monitor, one.judge} == OPPOSITE, text


def _excuse_fault(one: Any, report: Data, judgement: Any) -> str:
    """Why a row's evidence does not excuse the loss that the judge found; empty if it may."""
    row = next(
        r for r in report["constraints"]
        if (r["requirement"], r["source"], r["item"]) == ("G2", "flight", one.item)
    )  # fmt: skip
    pair = sorted(row["vehicles"])
    subject = ("pair", *map(str, pair))
    lost_ms = next((r.at_ms for r in judgement.rows if r.subject == subject), None)
    losses: dict[int, list[Data]] = {}
    for loss in row.get("evidence", {}).get("losses", []):
        losses.setdefault(loss["lost_ms"], []).append(loss)
    if lost_ms not in losses:
        return f"the report has no evidence on the loss at {lost_ms} ms"
    guarded = {v["id"] for v in report["mission"]["vehicles"] if v["protected"]} & set(pair)
    for at_ms, here in losses.items():
        about = all(sorted((loss["own"], loss["other"])) == pair for loss in here)
        if not about or {loss["own"] for loss in here} != guarded:
            return f"the evidence on the loss at {at_ms} ms is not that of every protected one of the pair"
        if not all(map(_no_way_out, here)):
            return (
                f"by the evidence on the loss at {at_ms} ms there was a way out, or it is not known"
            )
    return ""


def _no_way_out(loss: Data) -> bool:
    """Whether every manoeuvre tried at some instant was refused, by the bands and by the check."""
    counts = [instant[1:] for instant in loss["instants"]]
    refused = all(a == b > 0 and c == d > 0 for a, b, c, d in counts)
    return loss["answer"] == NO_WAY and bool(counts) and refused


def _shown(report: Data, judgement: Any, undecided: list[str]) -> str:
    """The verdict supported by both: violated if the report states it and nothing refutes it; holds
    only if both agree on it for every row; otherwise unknown.
    """
    if report["verdict"] == Outcome.VIOLATED:
        return str(Outcome.VIOLATED)
    sure = report["verdict"] == judgement.verdict == Outcome.HOLDS and not undecided
    return str(Outcome.HOLDS if sure else Outcome.UNKNOWN)
