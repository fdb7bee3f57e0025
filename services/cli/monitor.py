"""`cratous monitor`: runs the monitor on a message log."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.numbers import Number
from cratous.spec.errors import BadInput
from cratous.spec.mission.guarantees import Outcome, exit_code


@click.command()
@click.argument("log", type=click.Path(path_type=Path), required=False)
@click.option(
    "--requirements",
    type=click.Path(path_type=Path),
    help="Requirements of your own: a file *.req, FRET's export *.json, or C2PO; LOG may be CSV then.",
)
@click.option(
    "--model", is_flag=True, help="Is each event of authority a step of the proved system?"
)
@click.option("--verdicts", is_flag=True, help="Also each verdict, as `id:sample,T`, F or ?.")
@click.option(
    "--attach",
    metavar="ADDRESS",
    help="Watch a running system instead of a LOG: HOST:PORT of a TCP bridge of UxAS, or of AMASE; "
    "zmq://HOST:PORT of what a ZeroMQ bridge publishes; cratous://HOST:PORT: a tap on a CRATOUS bridge.",
)
@click.option(
    "--listen",
    metavar="HOST:PORT",
    help="Of a tap: where those connect that would have connected to the address.",
)
@click.option(
    "--keys",
    type=click.Path(path_type=Path),
    metavar="FOLDER",
    help="Of a tap: vehicle_ID.key, by which lines of v2 are authenticated. [environment: CRATOUS_BRIDGE_KEY_ID]",
)
@click.option("--seconds", type=Number(0, min_open=True), help="With --attach: end after so many.")
@click.option(
    "--keep",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="With --attach: keep what comes in a log.",
)
@click.option(
    "--metrics",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    help="With --attach: counts for Prometheus, on 127.0.0.1.",
)
@click.option(
    "--on-violation",
    default="",
    metavar="COMMAND",
    help="With --attach: started when a requirement is violated for the first time.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the verdicts as JSON.")
@click.option("--allow-unproved", is_flag=True, help="Judge with kernels that have no proof.")
def monitor(
    log: Path | None,
    requirements: Path | None,
    model: bool,
    verdicts: bool,
    as_json: bool,
    allow_unproved: bool,
    **attached: Any,
) -> int:
    """Replay a message LOG (log.sqlite, or its folder) through the monitor of G1 to G5, and of the
    assumptions of the theorems on the whole system: held, broken since when, or not observed and why.

    With --requirements, hold a trace (a CSV file of signals; with *.req also a message log of any
    format) against requirements of your own.

    With --attach, hold what a running system tells against such requirements, until Ctrl-C: a line
    (with --json a JSON object) when one is violated or unknown for the first time, all verdicts at the
    end. Nothing is sent to it. A tap relays a CRATOUS bridge byte for byte, in a process of its own, and reads along.

    With --model, replay all that concerns authority over the vehicles (takeovers, handbacks, commands
    at the gate, heartbeats) through the steps that are proved together; the first event that is none
    is named, and so is what is not looked at.

    Example:  cratous monitor out/crossing/log.sqlite

    Exit codes: 0 all requirements hold, 1 something is violated, 2 bad input, 3 something is
    unknown or excused.
    """
    address = attached.pop("attach")
    if (log is None) == (address is None):
        raise BadInput("one of them is watched", expected="LOG or --attach HOST:PORT")
    if address is not None:
        from cratous.services.cli.monitor_attach import Live, attach

        if requirements is None or verdicts or model:
            raise BadInput("--attach watches requirements", expected="--requirements FILE.req")
        return attach(address, requirements, Live(**attached), as_json, allow_unproved)
    assert log is not None
    if given := [name for name, value in attached.items() if value not in (None, "")]:
        raise BadInput(
            f"--{given[0].replace('_', '-')} needs --attach", expected="--attach HOST:PORT"
        )
    if model and requirements is not None:
        raise BadInput("two questions at once", item="--model", expected="no --requirements")
    if requirements is not None:
        from cratous.services.cli.monitor_requirements import trace

        return trace(log, requirements, verdicts, as_json, allow_unproved)
    if verdicts:
        raise BadInput("there are no such verdicts", item="--verdicts", expected="--requirements")
    from cratous.services.results.names import LOG_NAME

    log = log / LOG_NAME if log.is_dir() else log
    if model:
        from cratous.services.cli import monitor_model

        return monitor_model.model(log, as_json, allow_unproved)
    from cratous.services.cli.progress import waiting
    from cratous.services.startup import gate_process

    what = "holding the code against its proofs"
    with (
        gate_process.begun(allow_unproved=allow_unproved) as gate,
        waiting(what, as_json) as wait,
    ):
        from cratous.services.assumptions.observation_texts import GROUNDLESS
        from cratous.services.assumptions.observation_texts import lines as assumption_lines
        from cratous.services.certify.blame import blame_rows
        from cratous.services.certify.blame_texts import lines as blame_lines
        from cratous.services.certify.evidence import counted
        from cratous.services.certify.proofs import inventory, summary
        from cratous.services.certify.rejudge import watch
        from cratous.services.certify.verdicts import (
            constraint_rows,
            requirement_rows,
            without_ground,
        )
        from cratous.services.cli.job import imported
        from cratous.services.cli.show import requirement_table, say
        from cratous.services.logs.log import read_meta
        from cratous.services.logs.source import DOUBTS, doubts

        standing = gate.standing(lambda: imported(("monitor",)))
        wait.at("judging the messages of the log")
        doubted = [DOUBTS[one] for one in doubts(log)]
        with counted() as calls:
            judged, assumptions, commands, end_ms = watch(log)
    evidence = inventory(standing, calls.data())
    rows = constraint_rows(judged, "flight")
    blame = blame_rows(rows, commands, assumptions, end_ms)
    groundless = without_ground(str(read_meta(log).get("command", "")), assumptions)
    unproved = bool(standing.problems or doubted) or groundless
    code = exit_code([v.outcome for v in judged], unproved=unproved)
    required = requirement_rows(rows)
    if as_json:
        data = {
            "requirements": required,
            "constraints": rows,
            "assumptions": assumptions,
            "blame": blame,
            "doubts": doubted,
            "proofs": standing.line,
            "evidence": evidence,
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        for row in required:
            if row["verdict"] != Outcome.HOLDS:
                say(f"{row['requirement']} {row['title']}: {row['verdict']}", err=True)
        for line in doubted:
            say(f"unknown at best: {line}", err=True)
        if groundless:
            say(GROUNDLESS, err=True)
        if standing.problems:
            say(f"proofs: {standing.line}", err=True)
    else:
        requirement_table(required)
        for line in (*blame_lines(blame), *assumption_lines(assumptions)):
            say(line)
        for line in doubted:
            say(f"unknown at best: {line}")
        if groundless:
            say(GROUNDLESS)
        click.echo(f"proofs: {standing.line}")
        click.echo(f"evidence: {summary(evidence)}")
    return code
