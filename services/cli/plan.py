"""`cratous plan`: plan a mission and check the plan; nothing flies."""

from __future__ import annotations

import json
from pathlib import Path

import click

from cratous.spec.mission.guarantees import exit_code


@click.command()
@click.argument("mission", type=click.Path(path_type=Path))
@click.option("--seed", type=click.IntRange(0), default=0, help="Variant; 0 is as written.")
@click.option("--json", "as_json", is_flag=True, help="Print plan and checks as JSON.")
@click.option(
    "--certificate",
    type=click.Path(path_type=Path),
    default=None,
    help="Write what proves the assignment, for `cratous certify-plan`.",
)
@click.option("--allow-unproved", is_flag=True, help="Plan with kernels that have no proof.")
def plan(
    mission: Path, seed: int, as_json: bool, certificate: Path | None, allow_unproved: bool
) -> int:
    """Plan a MISSION and check the plan with the proved kernels; nothing flies.

    Example:  cratous plan examples/relations/mission.yaml

    Exit codes: 0 the plan satisfies all its constraints, 1 it does not or no plan exists, 2 bad
    input, 3 something is unknown.
    """
    from cratous.core import ledger
    from cratous.services.certify.evidence import counted
    from cratous.services.certify.proofs import inventory, summary
    from cratous.services.certify.verdicts import constraint_rows
    from cratous.services.cli.job import (
        absent_lines,
        left_out_lines,
        new_bus,
        plan_and_check,
        plan_line,
        write_certificate,
    )
    from cratous.services.cli.show import margin_text, say, table
    from cratous.services.loading import load
    from cratous.services.logs.records import to_data

    loaded = load(mission, seed)  # a bad mission is refused before anything takes time
    standing = ledger.require(allow_unproved=allow_unproved)
    bus = new_bus()
    with counted() as calls:
        made, checks = plan_and_check(loaded, bus)
    evidence = inventory(standing, calls.data())
    if certificate is not None:
        write_certificate(bus, certificate)
    code = exit_code([check.outcome for check in checks])
    if standing.problems and code == 0:
        code = 3  # no verdict of an unproved kernel is better than unknown
    rows = constraint_rows(checks, "plan")
    if as_json:
        data = {
            "plan": to_data(made),
            "constraints": rows,
            "notes": list(loaded.notes),
            "proofs": standing.line,
            "evidence": evidence,
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        return code
    table(
        ["task", "vehicle", "departs", "arrives", "waits", "starts", "ends"],
        [
            [
                f"p{item.task_id}",
                str(item.vehicle_id),
                *(
                    f"{time / 1000:.1f} s"
                    for time in (
                        item.depart_ms,
                        item.arrive_ms,
                        item.wait_ms,
                        item.start_ms,
                        item.end_ms,
                    )
                ),
            ]
            for item in made.items
        ],
    )
    click.echo()
    table(
        ["constraint", "verdict", "margin", "note"],
        [[row["item"], row["verdict"], margin_text(row), row["note"]] for row in rows],
        verdict_column=1,
    )
    click.echo()
    for note in loaded.notes:
        say(f"note: {note}")
    for line in (plan_line(made, checks), *left_out_lines(made), *absent_lines(loaded)):
        click.echo(line)
    click.echo(f"proofs: {standing.line}")
    click.echo(f"evidence: {summary(evidence)}")
    return code
