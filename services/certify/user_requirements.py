"""User requirements in a report: evaluated over the log of the flight, with their texts and blame.

The section contains all that is needed to evaluate it again, including the text of each file. The
verdicts are those of `cratous monitor --requirements` in the terms of a report: what is undecided
at the end of the log is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from cratous.core.kernel import qualified
from cratous.core.requirements import since, until, verdict
from cratous.services.certify.requirement_blame import Told, blame_rows_of
from cratous.services.certify.requirement_margins import least_margin, margins
from cratous.services.logs.source import open_log
from cratous.services.requirements.applicability import with_asked
from cratous.services.requirements.formula import Bounded, Formula, Join, Not, Reaches, parts
from cratous.services.requirements.outcome import SPARE, TOLD_BY, Outcome
from cratous.services.requirements.requirement_files import OwnFile, line_of
from cratous.services.requirements.specification import NotRead, Requirement, Specification
from cratous.services.requirements.traces import doubts, rows_of_messages, wanted_of
from cratous.services.requirements.watch import Watch, Watched
from cratous.spec.errors import BadInput

Data = dict[str, Any]
Lint = Callable[[Specification], Iterable[Any]]
MS = 10**6


def own_section(files: Sequence[OwnFile], log: Path, told: Told, lint: Lint | None) -> Data:
    """The report section on these files over a complete log.

    told: command and assumption look-ups of the flight, for blame; lint: of `requirements.lint`;
    None leaves its entries empty.
    """
    found: Data = {"files": [file.data() for file in files]}
    rows: list[Data] = []
    findings: list[Data] = []
    remarks: list[Data] = []
    for file in files:
        spec = file.specification()
        said = [vars(one) for one in lint(spec)] if lint is not None else []
        names = {one.name for one in spec.requirements}
        remarks += [{"file": file.name, **one} for one in said if one["name"] not in names]
        try:
            watched = _watched(spec, log)
        except BadInput as error:  # not evaluable: unknown, with the reason
            rows += [_unread(one, file, str(error)) for one in spec.requirements]
        else:
            rows += _rows(watched.outcomes, spec, file, told)
            findings += [
                {"file": file.name, "kind": f.kind, "signal": f.signal, "count": f.count,
                 "first_s": f.first_ns / 1e9 if f.first_ns >= 0 else None, "text": f.text}
                for f in watched.findings
            ]  # fmt: skip
        for row in rows:
            if row["file"] == file.name:
                mine = [one for one in said if one["name"] == row["requirement"]]
                row["lint"] = [{"kind": one["kind"], "text": one["text"]} for one in mine]
    return {**found, "requirements": rows, "findings": findings, "lint": remarks}


def _watched(spec: Specification, log: Path) -> Watched:
    """The outcomes of the requirements, then those of their conditions (`requirements.applicability`)."""
    watching = Watch(with_asked(spec))
    for doubt in doubts(log):
        watching.sampling.find(doubt)
    wanted = wanted_of(spec, watching.needed)
    with open_log(log) as source:
        watching.all(
            watching.sampling.samples(
                rows_of_messages(source.entries(), wanted, told_by=watching.sampling.told_by)
            )
        )
    return watching.result()


def _rows(
    outcomes: Sequence[Outcome], spec: Specification, file: OwnFile, told: Told
) -> list[Data]:
    own, rest = outcomes[: len(spec.requirements)], outcomes[len(spec.requirements) :]
    asked = {one.name: one.holds for one in rest}
    bad = [one for one in own if one.violated]
    blamed = {row["requirement"]: row for row in blame_rows_of(bad, spec, told)}
    return [_row(one, file, asked.get(one.name), blamed.get(one.name)) for one in own]


def _row(one: Outcome, file: OwnFile, asked: int | None, blame: Data | None) -> Data:
    first = one.first_violated if one.violated else one.first_unknown
    margin, unit = least_margin(one)
    decided = one.holds + one.violated
    word = "unknown" if one.verdict == "undecided" else one.verdict
    if blame is not None:
        kept = ("facts", "at_s", "known_s", "command", "command_known", "no_gate", "broken_first")
        blame = {key: blame[key] for key in (*kept, "not_observed")}
    return {
        **_told(one.requirement, file),
        "verdict": word,
        "note": _note(one, asked) + (f"; {TOLD_BY}" if one.unauthenticated else ""),
        "samples": {k: getattr(one, k) for k in ("holds", "violated", "unknown", "undecided")},
        "asked": asked,
        "checks": decided if asked is None else min(asked, decided),
        "horizon_s": one.horizon / 1e9,
        "time_ms": first // MS if first >= 0 else None,
        "known_ms": one.decided_at // MS if one.violated else None,
        **({} if one.whole or one.until < 0 else {"until_ms": one.until // MS}),
        "margin": margin,
        "unit": unit,
        "margins": margins(one),
        "blame": blame,
    }


def _unread(one: Requirement, file: OwnFile, why: str) -> Data:
    """The row of a requirement that cannot be evaluated on this log."""
    return {
        **_told(one, file),
        "verdict": "unknown",
        "note": f"not judged: {why}",
        "samples": dict.fromkeys(("holds", "violated", "unknown", "undecided"), 0),
        "asked": None,
        "checks": 0,
        "horizon_s": 0.0,
        "time_ms": None,
        "known_ms": None,
        "margin": None,
        "unit": "",
        "margins": [],
        "blame": None,
    }


def _told(one: Requirement, file: OwnFile) -> Data:
    return {
        "requirement": one.name,
        "title": one.title,
        "severity": one.severity,
        "source": one.source,
        "file": file.name,
        "line": line_of(file.text, one.name),
        "text": one.text,
        "kernels": [] if isinstance(one.formula, NotRead) else kernels(one.judged),
        "lint": [],
    }


def kernels(formula: Formula) -> list[str]:
    """Qualified names of the kernels that decide a formula."""
    found: set[str] = set()
    for part in parts(formula):
        if isinstance(part, Reaches):
            found |= {qualified(verdict.reaches)}
        elif isinstance(part, Not):
            found |= {qualified(verdict.negated)}
        elif isinstance(part, Join):
            found |= {qualified(verdict.both if part.is_and else verdict.either)}
        elif isinstance(part, Bounded) and part.past:
            steps = (since.is_due, since.since_found, since.since_broken, since.since_decided)
            found |= {qualified(step) for step in steps}
        elif isinstance(part, Bounded):
            found |= {qualified(step) for step in (until.until_decided, until.until_times)}
    return sorted(found)


def _note(one: Outcome, asked: int | None) -> str:
    """The reason for the verdict, in words."""
    total = one.holds + one.violated + one.unknown + one.undecided
    if not total:
        return "no sample: none of its signals came"
    if one.violated:
        at, known = one.first_violated / 1e9, one.decided_at / 1e9
        return (
            f"{one.violated} of {total} samples violated, first at {at:g} s, known at {known:g} s"
        )
    if one.unknown:
        at = one.first_unknown / 1e9
        spare = f", or {SPARE}" if one.requirement.between is not None else ""
        return f"{one.unknown} of {total} samples unknown{spare}, first at {at:g} s"
    if not one.whole:
        return one.so_far or "samples or messages are missing, so nothing holds"
    if one.undecided:
        return f"{one.undecided} of {total} samples undecided when the log ends"
    if asked == 0:
        return f"{total} samples hold, and what it depends on was so at none of them"
    return f"{total} samples hold"
