"""Published JSON assignment problems in two forms, read into `AssignmentProblem`.

*Chains* (`process_algebra`, `travel_ms`, `start_cost_ms`): one option per task, one speed. *Cost matrix*
(`task_relationships`, `cost_matrix`): rows (vehicle, task, option, task, option, ms) as in the message
AssignmentCostMatrix; task 0, option 0 is the vehicle's start.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

from cratous.services.logs.records import from_data
from cratous.services.planning.assign_problem import check
from cratous.spec import algebra
from cratous.spec.assignment.search import MINMAX, AssignmentProblem, Choice, Cost, Rows
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import TRAVEL_CELLS, at_most

T = TypeVar("T")


class _Chains(NamedTuple):
    vehicles: tuple[Any, ...]
    tasks: tuple[Any, ...]
    travel_ms: Any
    start_cost_ms: tuple[Any, ...]
    process_algebra: str


class _Matrix(NamedTuple):
    vehicles: tuple[int, ...]
    tasks: tuple[Any, ...]
    cost_matrix: tuple[Any, ...]
    task_relationships: str


class _Vehicle(NamedTuple):
    id: int


class _Task(NamedTuple):
    id: int
    duration_ms: int
    eligible: tuple[int, ...]


class _Choices(NamedTuple):
    task: int
    composition: str
    options: tuple[Any, ...]


class _Option(NamedTuple):
    option: int
    cost_ms: int
    eligible: tuple[int, ...]


class _Leg(NamedTuple):
    vehicle: int
    task: int
    option: int
    to_task: int
    to_option: int
    time_ms: int


def read(data: Any, semantics: str, cost: Cost = MINMAX, name: str = "") -> AssignmentProblem:
    """The problem of one JSON object; BadInput with the item for an invalid one."""
    given = data if isinstance(data, dict) else {}
    form = _matrix if "cost_matrix" in given else _chains
    found = form(data, semantics, cost, name or str(given.get("name", "")))
    check(found)
    return found


def rows_of(value: Any, item: str) -> tuple[Rows, ...]:
    """Tables of numbers, one per vehicle; `check` validates the numbers."""
    return tuple(
        tuple(tuple(_listed(row, f"{item}[{v}][{a}]")) for a, row in enumerate(table))
        for v, table in (
            (v, _listed(part, f"{item}[{v}]")) for v, part in enumerate(_listed(value, item))
        )
    )


def _listed(value: Any, item: str) -> Sequence[Any]:
    if not isinstance(value, (list, tuple)):
        raise BadInput("not a list", item=item, expected="a list", got=repr(value)[:60])
    return value


def _taken(kind: type[T], data: Any, item: str = "") -> T:
    """The fields of a kind; others are ignored. BadInput for a missing or invalid one."""
    wanted = kind._fields  # type: ignore[attr-defined]
    shown = ", ".join(wanted)
    if not isinstance(data, dict):
        raise BadInput(
            "not an object", item=item, expected=f"an object with {shown}", got=repr(data)[:60]
        )
    for name in wanted:
        if name not in data:
            place = f"{item}.{name}" if item else name
            raise BadInput(
                "a field is missing", item=place, expected=shown, got=", ".join(data)[:80]
            )
    return from_data(kind, {name: data[name] for name in wanted}, item or "problem")


def _fits(vehicles: int, choices: int) -> None:
    cells = vehicles * choices * (choices + 1)
    at_most(cells, TRAVEL_CELLS, "too many ways between options", "", "of all vehicles")


def _chains(data: Any, semantics: str, cost: Cost, name: str) -> AssignmentProblem:
    form = _taken(_Chains, data)
    vehicles = tuple(_taken(_Vehicle, v, f"vehicles[{k}]").id for k, v in enumerate(form.vehicles))
    tasks = [_taken(_Task, t, f"tasks[{k}]") for k, t in enumerate(form.tasks)]
    choices = tuple(Choice(t.id, 1, t.duration_ms, t.eligible) for t in tasks)
    _fits(len(vehicles), len(choices))
    (between,) = rows_of([form.travel_ms], "travel_ms")
    travel = tuple(
        (*between, tuple(_listed(start, f"start_cost_ms[{k}]")))
        for k, start in enumerate(form.start_cost_ms)
    )
    return AssignmentProblem(
        name, vehicles, (0,) * len(vehicles), choices, travel, form.process_algebra, cost=cost,
        semantics=semantics,
    )  # fmt: skip


def _matrix(data: Any, semantics: str, cost: Cost, name: str) -> AssignmentProblem:
    form = _taken(_Matrix, data)
    vehicles, choices = form.vehicles, list[Choice]()
    for k, part in enumerate(form.tasks):
        task = _taken(_Choices, part, f"tasks[{k}]")
        options = [
            _taken(_Option, o, f"tasks[{k}].options[{j}]") for j, o in enumerate(task.options)
        ]
        _composition(task.task, task.composition, {o.option for o in options})
        for o in options:
            able = tuple(v for v in o.eligible if v in vehicles)
            choices.append(Choice(task.task, o.option, o.cost_ms, able))
    _fits(len(vehicles), len(choices))
    number = {(c.task_id, c.option_id): k for k, c in enumerate(choices)}
    number[0, 0] = len(choices)
    rows: list[list[list[int | None]]] = [
        [[None] * len(choices) for _ in range(len(choices) + 1)] for _ in vehicles
    ]
    for k, entry in enumerate(form.cost_matrix):
        item = f"cost_matrix[{k}]"
        cells = _listed(entry, item)
        if len(cells) != len(_Leg._fields) or any(type(c) is not int for c in cells):
            raise BadInput(
                "not a row of the cost matrix", item=item,
                expected=f"whole numbers: {', '.join(_Leg._fields)}", got=repr(cells)[:60],
            )  # fmt: skip
        leg = _Leg(*cells)
        if leg.vehicle not in vehicles:
            raise BadInput("no such vehicle", item=item, got=str(leg.vehicle))
        a, b = number.get((leg.task, leg.option)), number.get((leg.to_task, leg.to_option))
        if a is None or b is None or b == len(choices):
            raise BadInput("no such task option", item=item, got=str(leg[1:5]))
        rows[vehicles.index(leg.vehicle)][a][b] = leg.time_ms
    travel = tuple(tuple(tuple(row) for row in table) for table in rows)
    return AssignmentProblem(
        name, vehicles, (0,) * len(vehicles), tuple(choices), travel, form.task_relationships,
        cost=cost, semantics=semantics,
    )  # fmt: skip


def _composition(task: int, text: str, listed: set[int]) -> None:
    """Check that a task's composition is a choice of one of its options; BadInput otherwise."""
    item = f"composition of task {task}"
    term = algebra.parse(text, where=item)
    flat = isinstance(term, algebra.Atom) or (
        term.op == algebra.ALTERNATIVE and all(isinstance(o, algebra.Atom) for o in term.operands)
    )
    named = {atom.task for atom in algebra.atoms(term)}
    if not flat or named != listed:
        raise BadInput(
            "this composition is out of reach", item=item,
            expected="one + over all options of the task", got=text.strip(),
        )  # fmt: skip
