"""`cratous assign`: solve an assignment problem from a JSON file, and write its certificate."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import click

from cratous.core.files.whole_file import write_atomically
from cratous.services.cli.numbers import AnyNumber
from cratous.services.cli.show import say
from cratous.spec.assignment.search import CUMULATIVE, MINMAX, AssignmentProblem, Cost, Solution
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of
from cratous.spec.files.text_file import bytes_of


class Output(NamedTuple):
    """Output options: files and printed form."""

    certificate: Path | None
    svg: Path | None
    progress: bool
    as_json: bool


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--semantics", type=click.Choice(["time", "order"]), default="time")
@click.option("--cost", default="MINMAX", help="MINMAX, CUMULATIVE, or weights `makespan,team`.")
@click.option("--seconds", type=AnyNumber(), default=None, help="Stop then, with what is known.")
@click.option("--nodes", type=int, default=None, help="Stop after so many; 0: first leaf.")
@click.option("--gap", type=AnyNumber(), default=0.0, help="Stop at this gap, e.g. 0.05.")
@click.option("--seed", type=int, default=1)
@click.option("--certificate", type=click.Path(path_type=Path), default=None)
@click.option(
    "--svg",
    type=click.Path(path_type=Path),
    default=None,
    help="Draw the schedule and the tree of the relations.",
)
@click.option("--progress", is_flag=True, help="Print incumbent and gap as they change.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def assign(
    file: Path, semantics: str, cost: str, seconds: float | None, nodes: int | None, gap: float,
    seed: int, **output: Any,
) -> int:  # fmt: skip
    """Solve an assignment problem.

    FILE is JSON as docs/guides/assignment.md says. `optimal` is said only with a certificate that was
    checked. If nothing can be planned, a smallest set of constraints that clash is named.

    Example:  cratous assign problem.json --certificate plan.json

    Exit codes: 0 optimal, or as good as asked for; 1 no plan exists; 2 bad input; 3 not decided.
    """
    from cratous.core.ledger import require
    from cratous.services.cli.progress import waiting
    from cratous.services.planning.assign import Limits, solve
    from cratous.services.planning.assign_certificate import certified, verify, write
    from cratous.services.planning.assign_solvers import why_infeasible
    from cratous.services.planning.assign_vectors import read

    certificate, svg, progress, as_json = Output(**output)
    require()
    data = json_of(bytes_of(file, expected="an assignment problem"), str(file))
    try:
        problem = read(data, semantics, _weights(cost), file.name)
    except BadInput as error:
        error.where = error.where or str(file)
        raise

    def tell(count: int, best: int | None, bound: int) -> None:
        shown = "-" if best is None else f"{100 * max(0, best - bound) / best:.1f} %"
        click.echo(f"{count} nodes: cost {best}, bound {bound}, gap {shown}", err=True)

    with waiting("searching for the best assignment", as_json or progress) as told:
        found = solve(problem, Limits(seconds, nodes, gap, seed=seed), tell if progress else None)
        told.at("making the certificate")
        solution, body = certified(problem, found)
        told.at("checking the certificate")
        verdict = verify(body)
    if verdict.wrong:
        raise RuntimeError(f"the certificate does not hold: {verdict.wrong}")
    if certificate is not None:
        write(certificate, body)
    if svg is not None:
        write_atomically(svg, _picture(problem, solution), "the picture")
    reasons, sure = why_infeasible(problem) if solution.status == "infeasible" else ((), True)
    code = _code(solution.status, solution.gap, gap, nodes, seconds)
    if as_json:
        click.echo(json.dumps({**_data(body), "reasons": reasons, "exit_code": code}, indent=1))
        return code
    for step in solution.steps:
        wait = step.start_ms - step.arrive_ms
        waits = f", waits {wait / 1000:.3f} s" if wait else ""
        click.echo(
            f"vehicle {step.vehicle_id}: task {step.task_id} (option {step.option_id}) "
            f"{step.start_ms / 1000:.3f} to {step.end_ms / 1000:.3f} s{waits}"
        )
    if solution.cost is not None:
        click.echo(
            f"{solution.status} ({semantics}): cost {solution.cost}, bound {solution.bound}, "
            f"gap {100 * (solution.gap or 0):.2f} %, {solution.nodes} nodes"
        )
    else:
        click.echo(f"no plan: {solution.status}")
        if reasons:
            click.echo("these contradict each other:" if sure else "these seem to clash:")
        for reason in reasons:
            say(f"  {reason}")
    return code


def _picture(problem: AssignmentProblem, solution: Solution) -> str:
    from cratous.services.certify.gantt import bars_of, both, gantt, tree
    from cratous.services.planning.assign_problem import binding, parts, term_of
    from cratous.services.planning.assign_replay import branch_of

    some = parts(problem)[0]
    part = branch_of(problem, solution.steps) if solution.steps else some[0]
    chart = gantt(bars_of(problem, solution.steps), problem.vehicles, binding(problem, part))
    return both(chart, tree(term_of(problem)))


def _code(
    status: str, got: float | None, gap: float, nodes: int | None, seconds: float | None
) -> int:
    if status == "infeasible":
        return 1
    if status == "unknown":
        return 3
    limited = nodes is not None or seconds is not None
    return 0 if status == "optimal" or limited or (got is not None and got <= gap) else 3


def _weights(text: str) -> Cost:
    named = {"MINMAX": MINMAX, "CUMULATIVE": CUMULATIVE}
    if text in named:
        return named[text]
    numbers = text.split(",")
    if len(numbers) != 2 or not all(n.strip().isdecimal() for n in numbers):
        raise BadInput(
            "no such cost", item="--cost", expected="MINMAX, CUMULATIVE or `1,2`", got=text
        )
    return Cost(int(numbers[0]), int(numbers[1]))


def _data(body: dict[str, object]) -> dict[str, object]:
    return {"claim": body["claim"], "steps": body["steps"], "sha256": body["sha256"]}
