"""`cratous plan`: plan a mission and check the plan; nothing flies."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import click

from cratous.services.cli import error_data, report_error
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import exit_code
from cratous.spec.mission.plan import COST_UNITS


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
@click.option(
    "--request",
    type=click.IntRange(1),
    help="Of a UxAS folder with several requests the N-th alone.",
)
@click.option("--allow-unproved", is_flag=True, help="Plan with kernels that have no proof.")
def plan(
    mission: Path,
    seed: int,
    as_json: bool,
    certificate: Path | None,
    task: int | None,
    request: int | None,
    allow_unproved: bool,
) -> int:
    """Plan a MISSION and check the plan with the proved kernels; nothing flies.

    Example:  cratous plan examples/relations/mission.yaml

    Where not all tasks can be done, the plan is of those that can, by priority, and the others are
    named with the reasons. Of a UxAS folder every automation request is planned, in the order in which
    they are sent, each from where the messages put the vehicles.

    Exit codes: 0 the plan satisfies all its constraints, 1 it does not, leaves tasks out or does
    not exist, 2 bad input, 3 something is unknown; of several requests the worst: 2, 1, 3, 0.
    """
    from cratous.services.loading import count_requests, load

    count = 1 if request else count_requests(mission)
    if count > 1 and (certificate is not None or task is not None):
        raise BadInput(
            "several requests",
            where=str(mission),
            item="--certificate" if task is None else "--why",
            expected=f"--request 1 to {count} with it",
        )
    # bad input is refused before lengthy work; with several requests it is one of the answers
    loaded: list[Mission | CratousError] = []
    for number in range(1, count + 1):
        try:
            loaded.append(load(mission, seed, request or number))
        except CratousError as error:
            loaded.append(error)
            if count == 1:
                raise
    if task is not None and isinstance(loaded[0], Mission):
        _check_asked(task, loaded[0])

    from cratous.services.cli.progress import waiting
    from cratous.services.startup import gate_process

    with (
        gate_process.begun(allow_unproved=allow_unproved) as gate,
        waiting("holding the code against its proofs", as_json),
    ):
        from cratous.services.cli.job import PLANNED_WITH, imported
        from cratous.services.startup import ahead

        ahead.begin(one for one in loaded if isinstance(one, Mission))
        standing = gate.standing(lambda: imported(PLANNED_WITH))
    job = _Job(as_json, certificate, task, standing)
    if count == 1:
        assert isinstance(loaded[0], Mission)
        data, code = _planned(loaded[0], job)
        if as_json:
            click.echo(json.dumps(data, indent=1))
        return code
    answers: list[dict[str, Any]] = []
    for number, one in enumerate(loaded, 1):
        if not as_json:
            click.echo(f"{'' if number == 1 else chr(10)}request {number} of {count}")
        try:
            if isinstance(one, CratousError):
                raise one
            data, code = _planned(one, job)
        except CratousError as error:
            code = error.exit_code
            data = {**error_data(error), "exit_code": code}
            if not as_json:
                report_error(error, as_json=False)
        answers.append(data)
    codes = [answer["exit_code"] for answer in answers]
    code = next(c for c in (2, 1, 3, *codes) if c in codes)
    if as_json:
        click.echo(json.dumps({"requests": answers, "exit_code": code}, indent=1))
    return code


def _check_asked(task: int, mission: Mission) -> None:
    """BadInput for a task that the mission does not have."""
    known = sorted(one.id for one in mission.tasks)
    if task not in known:
        raise BadInput(
            "no such task in the mission",
            item="--why",
            expected="one of " + ", ".join(map(str, known)),
            got=str(task),
        )


class _Job(NamedTuple):
    """Options for each plan, and the proof status of the code."""

    as_json: bool
    certificate: Path | None
    task: int | None
    standing: Any


def _planned(loaded: Mission, job: _Job) -> tuple[dict[str, Any], int]:
    """Plan one mission, print it unless as JSON; returns the data and the exit code. NoPlan if there is none."""
    from cratous.services.certify.evidence import counted
    from cratous.services.certify.proofs import inventory
    from cratous.services.certify.verdicts import constraint_rows
    from cratous.services.cli.job import new_bus, plan_and_check, planning_told, write_certificate
    from cratous.services.cli.progress import waiting
    from cratous.services.cli.relation_places import RelationPlaces
    from cratous.services.logs.records import to_data
    from cratous.services.monitor.moving_plan import check_in_time

    bus, standing, task = new_bus(), job.standing, job.task
    with waiting("planning", job.as_json) as wait:
        bus.tap(planning_told(wait.at, len(loaded.tasks)))
        with counted() as calls, RelationPlaces(loaded).in_reasons():
            made, checks = plan_and_check(loaded, bus)
            checks += check_in_time(loaded, made)
            instead = None if task is None else reasons_of(loaded, made, task)
        wait.at("gathering the evidence")
        evidence = inventory(standing, calls.data())
    if job.certificate is not None:
        write_certificate(bus, job.certificate)
    code = exit_code([check.outcome for check in checks], unproved=bool(standing.problems))
    data = {
        "plan": to_data(made),
        "constraints": constraint_rows(checks, "plan"),
        "notes": list(loaded.notes),
        "proofs": standing.line,
        "evidence": evidence,
        "exit_code": code,
    }
    if instead is not None:
        vehicles = [one._asdict() for one in instead]
        data["why"] = {"task": task, "unit": COST_UNITS[made.cost], "vehicles": vehicles}
    if not job.as_json:
        _print(loaded, made, checks, data)
        if task is not None and instead:
            for line in why_lines(loaded, made, task, instead):
                click.echo(line)
        _print_evidence(data)
    return data, code


def _print(loaded: Mission, made: Any, checks: list[Any], data: dict[str, Any]) -> None:
    """Print the plan, its constraints and notes as tables."""
    from cratous.services.cli.job import absent_lines
    from cratous.services.cli.plan_lines import left_out_lines, plan_line
    from cratous.services.cli.relation_places import RelationPlaces
    from cratous.services.cli.show import margin_text, say, table

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
        [[r["item"], r["verdict"], margin_text(r), r["note"]] for r in data["constraints"]],
        verdict_column=1,
    )
    click.echo()
    for note in loaded.notes:
        say(f"note: {note}")
    places = RelationPlaces(loaded)
    for line in (plan_line(loaded, made, checks), *left_out_lines(made), *absent_lines(loaded)):
        click.echo(places.told(line))


def _print_evidence(data: dict[str, Any]) -> None:
    from cratous.services.certify.proofs import summary

    click.echo(f"proofs: {data['proofs']}")
    click.echo(f"evidence: {summary(data['evidence'])}")


def reasons_of(mission: Any, made: Any, task: int) -> tuple[Any, ...]:
    """For each vehicle the plan's cost if it did the task."""
    from cratous.services.mission.availability import absent
    from cratous.services.mission.wind import known_at
    from cratous.services.planning.vehicle_alternatives import why

    return why(known_at(mission, 0), made, task, absent(mission, 0))


def why_lines(mission: Any, made: Any, task: int, instead: tuple[Any, ...]) -> list[str]:
    """As text: the plan's cost, and the cost with the task assigned to each other vehicle."""
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
