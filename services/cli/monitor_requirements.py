"""`cratous monitor --requirements`: checks a trace against user requirements."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

if TYPE_CHECKING:
    from cratous.core.ledger import Standing
    from cratous.services.requirements.lint import Remark
    from cratous.services.requirements.outcome import Margin, Outcome
    from cratous.services.requirements.specification import Specification
    from cratous.services.requirements.watch import Watched


UNTESTED = "nothing tested it, as what it depends on was so at no sample"


class Judged(NamedTuple):
    """Result of checking a trace. lines: a line for each verdict, None if not requested."""

    timed: bool
    watched: Watched
    remarks: Sequence[Remark]
    blame: list[dict[str, Any]]
    lines: list[str] | None = None
    notes: tuple[str, ...] = ()

    @property
    def code(self) -> int:
        """The exit code, if the kernels are proved."""
        words = {outcome.verdict for outcome in self.watched.outcomes}
        return 1 if "violated" in words else 0 if words == {"holds"} else 3


def trace(
    trace: Path, requirements: Path, verdicts: bool, as_json: bool, allow_unproved: bool
) -> int:
    """Check a trace and print the result of each requirement; returns the exit code."""
    from cratous.core import ledger

    spec = read(requirements)
    standing = ledger.require(allow_unproved=allow_unproved)
    return print_result(judged(spec, trace, verdicts), standing, as_json)


def judged(spec: Specification, trace: Path, verdicts: bool = False) -> Judged:
    """Check a trace against requirements; verdicts: with a line for each verdict."""
    from cratous.services.certify.blame_own import own_blame
    from cratous.services.requirements.lint import lint
    from cratous.services.requirements.watch import watch

    remarks = lint(spec)
    lines: list[str] | None = [] if verdicts else None
    watched = watch(spec, trace, lines)
    return Judged(
        spec.timed, watched, remarks, own_blame(watched.outcomes, spec, trace), lines, spec.notes
    )


def print_result(found: Judged, standing: Standing, as_json: bool) -> int:
    """Print verdicts, margins, blame, and faults of samples and requirements; returns the exit code."""
    from cratous.services.cli.show import say

    code = found.code or (3 if standing.problems else 0)
    if as_json:
        data = {**result(found), "proofs": standing.line, "exit_code": code}
        click.echo(
            json.dumps(data if found.lines is None else {**data, "verdicts": found.lines}, indent=1)
        )
        for one in found.watched.outcomes:
            if one.verdict != "holds":
                say(_line(one, found.timed), err=True)
        if standing.problems:
            say(f"proofs: {standing.line}", err=True)
        return code
    for line in (*(found.lines or ()), *told(found)):
        say(line)
    click.echo(f"proofs: {standing.line}")
    return code


def result(found: Judged) -> dict[str, Any]:
    """Verdicts, findings, lint and blame as data."""
    return {
        "requirements": [_data(one, found.timed) for one in found.watched.outcomes],
        "findings": [vars(one) for one in found.watched.findings],
        "lint": [vars(one) for one in found.remarks],
        "blame": found.blame,
        "untested": found.watched.untested,
        "notes": list(found.notes),
    }


def told(found: Judged) -> Iterator[str]:
    """The same as lines of text."""
    from cratous.services.certify.requirement_texts import lines

    for remark in found.remarks:
        yield f"lint: {remark.text}"
    for note in found.notes:
        yield f"note: {note}"
    for finding in found.watched.findings:
        yield f"finding: {finding.text}"
    for one in found.watched.outcomes:
        tested = one.name not in (found.watched.untested or ())
        yield _line(one, found.timed) + ("" if tested else f"; {UNTESTED}")
        for margin in one.margins if found.timed else ():
            yield f"  {_margin(margin)}"
    yield from lines(found.blame)


def read(requirements: Path, is_open: bool = False) -> Specification:
    """The requirements of a file, in the language given by its suffix; BadInput if it is invalid.

    is_open: its parameters need no values.
    """
    from cratous.services.requirements import c2po, fret, language
    from cratous.spec.files.limits import CONFIG_BYTES, DOCUMENT_BYTES
    from cratous.spec.files.text_file import text_of

    if requirements.suffix == ".json":
        text = text_of(requirements, DOCUMENT_BYTES, "an export of FRET")
        return fret.read(text, str(requirements))
    text = text_of(requirements, CONFIG_BYTES, "requirements")
    if requirements.suffix == ".req":
        return language.read(text, str(requirements), requirements.parent, is_open)
    return c2po.read(text, str(requirements))


def _data(one: Outcome, timed: bool) -> dict[str, Any]:
    required = one.requirement
    instants = {k: getattr(one, k) for k in ("first_violated", "decided_at", "first_unknown")}
    if timed:
        instants = {f"{k}_s": v / 1e9 if v >= 0 else None for k, v in instants.items()}
        instants["until_s"] = one.until / 1e9 if one.until >= 0 else None
    counts = {k: getattr(one, k) for k in ("holds", "violated", "unknown", "undecided")}
    return {
        "name": one.name,
        "verdict": one.verdict,
        "text": required.text,
        "title": required.title,
        "severity": required.severity,
        "so_far": one.so_far,
        "unauthenticated": one.unauthenticated,
        "source": required.source,
        **({"horizon_s": one.horizon / 1e9} if timed else {"horizon": one.horizon}),
        **counts,
        **instants,
        "margins": [
            {
                "of": f"{m.left} - {m.right}",
                "unit": m.unit,
                "least": m.least if m.at >= 0 else None,
                "at": m.at / 1e9 if timed and m.at >= 0 else m.at,
                "greatest": m.greatest if m.at >= 0 else None,
                "greatest_at": m.greatest_at / 1e9 if timed and m.at >= 0 else m.greatest_at,
            }
            for m in one.margins
        ],
    }


def _line(one: Outcome, timed: bool) -> str:
    from cratous.services.requirements.outcome import SPARE, TOLD_BY

    name = f"{one.name} ({one.requirement.title})" if one.requirement.title else one.name
    severity = f" [{one.requirement.severity}]" if one.requirement.severity else ""
    text = f"{name}{severity}: {one.verdict}; samples: {one.holds} hold, {one.violated} violated"
    spare = f" (or {SPARE})" if one.unknown and one.requirement.between is not None else ""
    text += f", {one.unknown} unknown{spare}, {one.undecided} undecided at the end"
    if one.violated:
        first, known = (
            (f"{one.first_violated / 1e9:g} s", f"{one.decided_at / 1e9:g} s")
            if timed
            else (f"sample {one.first_violated}", str(one.decided_at))
        )
        text += f"; first violated at {first}, known at {known}"
    said = [text, one.so_far, TOLD_BY if one.unauthenticated else ""]
    return "; ".join(filter(None, said))


def _margin(margin: Margin) -> str:
    """The closest approach of the two sides, in their unit."""
    unit = "" if margin.unit == "1" else f" {margin.unit}"
    right = margin.right if isinstance(margin.right, str) else f"{margin.right:g}{unit}"
    if margin.at < 0:
        return f"{margin.left} - {right}: never known"
    return (
        f"{margin.left} - {right}: least {margin.least:g}{unit} at {margin.at / 1e9:g} s, "
        f"greatest {margin.greatest:g}{unit} at {margin.greatest_at / 1e9:g} s"
    )
