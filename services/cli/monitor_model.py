"""`cratous monitor --model`: checks a flight's log against the composed steps of authority."""

from __future__ import annotations

from pathlib import Path

import click

from cratous.spec.files.printable import json_text

UNASKED = "not known whether it fits the model: no vehicle was flown with an ICAROUS instance"


def model(log: Path, as_json: bool, allow_unproved: bool) -> int:
    """Print whether each authority event is a step of the model, or the first that is not; returns
    the exit code.

    0 all are, 1 one is not, 3 all are by kernels without a proof, or no vehicle has an ICAROUS
    instance: then nothing was checked, and the log neither fits nor fails.
    """
    from cratous.core import ledger
    from cratous.services.certify.evidence import counted
    from cratous.services.certify.rejudge import subject
    from cratous.services.cli.show import say
    from cratous.services.logs.log import read_envelopes, read_meta
    from cratous.services.logs.source import DOUBTS, doubts
    from cratous.services.system_model import coverage
    from cratous.services.system_model.replay import replay
    from cratous.spec.errors import BadInput

    standing = ledger.require(allow_unproved=allow_unproved)
    mission, _ = subject(log)
    avoidance = read_meta(log).get("avoidance", True)
    if not isinstance(avoidance, bool):
        raise BadInput(
            "the log does not say how it was flown",
            where=str(log),
            item="meta.avoidance",
            expected="true or false",
            got=str(avoidance),
        )
    doubted = [DOUBTS[one] for one in doubts(log)]
    with counted() as calls:
        found = replay(mission, avoidance, read_envelopes(log))
    asked = bool(found.vehicles)
    code = 1 if found.finding is not None else 3 if standing.problems or doubted or not asked else 0
    steps, unseen = coverage.steps(calls.data()), coverage.rows(found.passed)
    if as_json:
        data = {
            "fits": False if found.finding is not None else True if asked else None,
            "finding": found.finding._asdict() if found.finding is not None else None,
            "events": dict(sorted(found.events.items())),
            "vehicles_with_icarous": found.vehicles,
            "steps": steps,
            "not_covered": unseen,
            "doubts": doubted,
            "proofs": standing.line,
            "exit_code": code,
        }
        click.echo(json_text(data))
        for line in doubted:
            say(f"unknown at best: {line}", err=True)
        if found.finding is None and not asked:
            say(UNASKED, err=True)
        if standing.problems:
            say(f"proofs: {standing.line}", err=True)
        return code
    events = ", ".join(f"{count} {kind}" for kind, count in sorted(found.events.items()))
    if found.finding is not None:
        say(f"DOES NOT FIT the model: {found.finding.text}")
        say("what follows it in the log was not looked at")
    elif asked:
        say(f"fits the model: each of {found.events.total()} events is a step of it")
    else:
        say(UNASKED)
    say(f"events: {events or 'none'}; {found.vehicles} vehicles with ICAROUS")
    for line in coverage.lines(steps):
        say(line)
    for row in unseen:
        say(f"not covered: {row}")
    for line in doubted:
        say(f"unknown at best: {line}")
    click.echo(f"proofs: {standing.line}")
    return code
