"""`cratous plan`: plan a mission and check the plan; nothing flies."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

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
@click.option("--why", "task", type=click.IntRange(1), help="Why this vehicle does task N.")
@click.option("--allow-unproved", is_flag=True, help="Plan with kernels that have no proof.")
def plan(
    mission: Path,
    seed: int,
    as_json: bool,
    certificate: Path | None,
    task: int | None,
    allow_unproved: bool,
) -> int:
    """Plan a MISSION and check the plan with the proved kernels; nothing flies.

    Example:  cratous plan examples/relations/mission.yaml

    Where not all tasks can be done, the plan is of those that can, by priority, and the others are
    named with the reasons.

    Exit codes: 0 the plan satisfies all its constraints, 1 it does not, leaves tasks out or does
    not exist, 2 bad input, 3 something is unknown.
    """
    from cratous.services.loading import load

    loaded = load(mission, seed)  # a bad mission is refused before anything that takes time

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
        planning_told,
        write_certificate,
    )
    from cratous.services.cli.progress import waiting
    from cratous.services.cli.show import margin_text, say, table
    from cratous.services.logs.records import to_data
    from cratous.spec.mission.plan import COST_UNITS

    bus = new_bus()
    with waiting("holding the code against its proofs", as_json) as wait:
        standing = ledger.require(allow_unproved=allow_unproved)
        bus.tap(planning_told(wait.at, len(loaded.tasks)))
        with counted() as calls:
            made, checks = plan_and_check(loaded, bus)
            instead = None if task is None else reasons_of(loaded, made, task)
        wait.at("gathering the evidence")
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
        if instead is not None:
            vehicles = [one._asdict() for one in instead]
            data["why"] = {"task": task, "unit": COST_UNITS[made.cost], "vehicles": vehicles}
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
    for line in (plan_line(loaded, made, checks), *left_out_lines(made), *absent_lines(loaded)):
        click.echo(line)
    if task is not None and instead:
        for one in why_lines(loaded, made, task, instead):
            click.echo(one)
    click.echo(f"proofs: {standing.line}")
    click.echo(f"evidence: {summary(evidence)}")
    return code


def reasons_of(mission: Any, made: Any, task: int) -> tuple[Any, ...]:
    """For each vehicle what the plan would cost with it."""
    from cratous.services.mission.taking_part import absent
    from cratous.services.mission.wind import known_at
    from cratous.services.planning.why import why

    return why(known_at(mission, 0), made, task, absent(mission, 0))


def why_lines(mission: Any, made: Any, task: int, instead: tuple[Any, ...]) -> list[str]:
    """In words: what the plan costs, and with the task for each other vehicle."""
    from cratous.services.pipeline.plan import cost_of
    from cratous.spec.mission.plan import cost_text

    who = next(i.vehicle_id for i in made.items if i.task_id == task)
    cost = cost_text(made.cost, cost_of(made, mission))
    lines = [f"task {task} is given to vehicle {who}: the plan costs {cost}"]
    for one in instead:
        if one.vehicle == who:
            continue
        told = one.reason
        if one.cost is not None:
            doubt = "" if one.sure else ", or less"
            told = f"the best plan would cost {cost_text(made.cost, one.cost)}{doubt}"
        lines.append(f"  with vehicle {one.vehicle}: {told}")
    return lines
