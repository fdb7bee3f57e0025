"""`cratous params`: the parameters of ICAROUS and detect-and-avoid for a mission, and their origin."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.show import say, table

if TYPE_CHECKING:
    from cratous.services.parameters.parameter_file import Given


@click.command()
@click.argument("mission", required=False, type=click.Path(path_type=Path))
@click.option(
    "--icarous", "file", type=click.Path(path_type=Path), metavar="FILE",
    help="A parameter file of ICAROUS: what each of its lines is here.",
)  # fmt: skip
@click.option("--names", is_flag=True, help="Every name that such a file may have.")
@click.option("--request", type=click.IntRange(1), default=1, help="Of several requests the N-th.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def params(
    mission: Path | None, file: Path | None, names: bool, request: int, as_json: bool
) -> int:
    """List every parameter that ICAROUS and detect-and-avoid use for a MISSION: value, unit, default, range, and
    whether it was given, left out (default), derived from vehicle and mission, and how, or is fixed.

    Example:  cratous params examples/crossing/mission.yaml

    With --icarous also, or alone, a parameter file of ICAROUS (`key = value [unit]`): the item of the mission file
    that each line sets, or why it is not used here; a name that ICAROUS does not have is refused.

    Derived values are those at cruise speed. What does not fit the vehicles is printed as a note, which stays in the
    report of a run.

    Exit codes: 0 listed, 2 bad input.
    """
    if mission is None and file is None and not names:
        raise click.UsageError("name a MISSION, or --icarous FILE, or --names")
    from cratous.services.loading import load
    from cratous.services.loading.fitness import warnings_of
    from cratous.services.parameters.icarous_names import NAMES
    from cratous.services.parameters.listing import parameters_of
    from cratous.services.parameters.parameter_file import read

    data: dict[str, Any] = {}
    if mission is not None:
        loaded = load(mission, 0, request)
        rows = parameters_of(loaded, mission)
        data = {
            "mission": loaded.name,
            "parameters": [row.data() for row in rows],
            "notes": list(warnings_of(loaded)),
        }
        if not as_json:
            _show(rows, data["notes"])
    if file is not None:
        given = read(file)
        data["icarous"] = [_line(one) for one in given.values()]
        if not as_json:
            _show_file(data["icarous"])
    if names:
        data["names"] = [name._asdict() for name in NAMES.values()]
        if not as_json:
            head = ["name", "default", "unit", "sets", "how, or why it is not used here"]
            table(head, [[n.name, n.default, n.unit, n.item or "-", n.why] for n in NAMES.values()])
    if as_json:
        click.echo(json.dumps(data, indent=1))
    return 0


def _show(rows: Any, notes: list[str]) -> None:
    head = ["parameter", "of", "value", "unit", "default", "range", "origin", "how"]
    table(
        head,
        [
            [
                row.name,
                f"vehicle {row.vehicle}" if row.vehicle else "mission",
                _text(row.value),
                row.unit,
                "-" if row.default is None else _text(row.default),
                row.range_text,
                row.origin,
                row.how,
            ]
            for row in rows
        ],
    )
    for note in notes:
        say(f"note: {note}")


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:.6g}"


def _line(one: Given) -> dict[str, Any]:
    name = one.name
    return {
        "name": name.name,
        "given": one.text,
        "value": one.value,
        "default": f"{name.default} {name.unit}".strip(),
        "sets": name.item,
        "why": name.why,
        "where": one.where,
    }


def _show_file(rows: list[dict[str, Any]]) -> None:
    head = ["name", "given", "default", "sets", "how, or why it is not used here"]
    table(
        head,
        [[r["name"], r["given"], r["default"], r["sets"] or "-", r["why"]] for r in rows],
    )
    used = sum(bool(row["sets"]) for row in rows)
    say(
        f"{used} of {len(rows)} lines set something here; `cratous import` writes it into a mission"
    )
