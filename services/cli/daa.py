"""`cratous daa`: alerts, bands, metrics, plots and explanations for an encounter file."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import click

from cratous.core.files.whole_file import write_atomically
from cratous.services.cli.numbers import AnyNumber
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import printable

CONFIG = click.option(
    "--config", "-c", default="do_365b", show_default=True,
    help="A preset (see `cratous daa presets`) or a .conf file.",
)  # fmt: skip
OWN = click.option("--ownship", default="", help="Which aircraft; by default the first one.")
OUT = click.option(
    "--out", "-o", type=click.Path(path_type=Path, dir_okay=False), help="Write to this file."
)
FILE = click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
URGENCY = click.option(
    "--urgency", type=click.Choice(["none", "fixed", "dcpa"]),
    help="With whom to coordinate, for configurations with conflict_crit or recovery_crit: nobody, "
    "the aircraft of --urgent, or who comes nearest.",
)  # fmt: skip
URGENT = click.option(
    "--urgent", default="", help="Id of the most urgent aircraft (--urgency fixed)."
)
JSON = click.option("--json", "as_json", is_flag=True, help="JSON instead of CSV or text.")


def asks_steps(command: Any) -> Any:
    """Add the arguments of commands that compute the steps of a file, and its output options."""
    return FILE(CONFIG(OWN(URGENCY(URGENT(OUT(command))))))


@click.group()
def daa() -> None:
    """Detect and avoid: what alerting and guidance say about an encounter.

    FILE is an encounter file (.daa, .xyz); see docs/guides/detect-and-avoid.md.

    Example:  cratous daa bands encounter.daa --config do_365b
    """


def _steps(
    file: Path, config: str, ownship: str, dimensions: tuple[int, ...],
    urgency: str | None = None, urgent: str = "", *, quiet: bool = False,
) -> Generator[Any, None, None]:  # fmt: skip
    """The steps of a file in order; quiet: show no progress."""
    from cratous.core.ledger import require
    from cratous.services.cli.progress import waiting
    from cratous.services.daa import named_or_file, run
    from cratous.spec.daa.parameters import URGENCIES

    changes: dict[str, Any] = {}
    if urgency or urgent:
        changes["urgency_strategy"] = URGENCIES.index(urgency or "fixed")
        changes["most_urgent_aircraft"] = urgent
    with waiting("holding the code against its proofs", quiet) as wait:
        require()
        steps = run(file, named_or_file(config).parameters, ownship, dimensions, changes)
        yield from wait.each(steps, "steps of the encounter")


def _put(text: str, out: Path | None) -> None:
    if out is None:
        click.echo(printable(text, keep="\n\t"), nl=not text.endswith("\n"))
        return
    write_atomically(out, text)


def _table(kind: str) -> Callable[..., int]:
    def command(
        file: Path, config: str, ownship: str, urgency: str | None, urgent: str,
        out: Path | None, as_json: bool,
    ) -> int:  # fmt: skip
        from cratous.services.daa.tables import ROWS, as_csv

        dimensions = (0, 1, 2, 3) if kind == "bands" else ()
        rows = [
            row
            for step in _steps(file, config, ownship, dimensions, urgency, urgent, quiet=as_json)
            for row in ROWS[kind](step.instant)
        ]
        _put(json.dumps(rows, allow_nan=False) if as_json else as_csv(rows), out)
        return 0

    return command


for _kind, _help in (
    ("alerts", "Alert level of each intruder at each step."),
    ("bands", "Bands of all four dimensions at each step, with resolutions."),
    ("metrics", "Separation and closest approach of each intruder at each step."),
):
    daa.command(_kind, help=_help)(asks_steps(JSON(_table(_kind))))


@daa.command()
@asks_steps
def plot(
    file: Path, config: str, ownship: str, urgency: str | None, urgent: str, out: Path | None
) -> int:
    """Bands and alerts over time, and the plan view, as SVG or PNG."""
    from cratous.services.daa.plot import draw

    target = out or Path(file.stem + ".svg")
    draw(_steps(file, config, ownship, (0, 1, 2, 3), urgency, urgent), target)
    say(f"{target} written")
    return 0


def _at(steps: Iterator[Any], time_s: float, file: Path) -> Any:
    """The step at a time; later steps are not computed."""
    times = []
    for step in steps:
        if math.isclose(step.instant.time_s, time_s, abs_tol=1e-6):
            return step
        times.append(step.instant.time_s)
    raise BadInput(
        "there is no step at this time",
        where=str(file),
        item="--time",
        expected=f"{times[0]:g} to {times[-1]:g} s" if times else "none",
        got=f"{time_s:g} s",
    )


def _first_alert(steps: Iterator[Any]) -> Any:
    """The first step with an alert, otherwise the first step."""
    first = next(steps)
    with_alert = (
        s for s in itertools.chain([first], steps) if any(a.level for a in s.instant.alerts)
    )
    return next(with_alert, first)


@daa.command()
@FILE
@CONFIG
@OWN
@OUT
@JSON
@click.option("--time", "time_s", type=AnyNumber(), help="Only the step at this time [s].")
def excuse(
    file: Path, config: str, ownship: str, out: Path | None, as_json: bool, time_s: float | None
) -> int:
    """Whether a way out existed at each step: every manoeuvre, and who refuses it.

    Two judges try every turn, speed, climb rate and altitude against the corrective volumes within
    the look-ahead: the manoeuvres of the bands, and a check that integrates its own. Only what both
    say is said; anything else is undecided.
    """
    from cratous.services.daa.excuse import as_data, excuse_text, judge_step

    with closing(_steps(file, config, ownship, (), quiet=as_json)) as steps:
        chosen = steps if time_s is None else [_at(steps, time_s, file)]
        judged = [(s.instant.time_s, judge_step(s)) for s in chosen]
    if as_json:
        _put(json.dumps([as_data(*one) for one in judged], allow_nan=False), out)
    else:
        _put("\n".join(line for one in judged for line in excuse_text(*one)), out)
    return 0


@daa.command()
@asks_steps
@JSON
@click.option(
    "--time",
    "time_s",
    type=AnyNumber(),
    help="The step at this time [s]; by default the first with an alert.",
)
def explain(
    file: Path, config: str, ownship: str, urgency: str | None, urgent: str, out: Path | None,
    as_json: bool, time_s: float | None,
) -> int:  # fmt: skip
    """Why: for each alert, band edge and resolution of one step."""
    from cratous.services.daa.explain import explain as words
    from cratous.services.daa.tables import as_data

    every = _steps(file, config, ownship, (0, 1, 2, 3), urgency, urgent, quiet=as_json)
    with closing(every) as steps:
        chosen = _first_alert(steps) if time_s is None else _at(steps, time_s, file)
    lines = words(chosen.parameters, chosen.instant)
    if as_json:
        _put(json.dumps({**as_data(chosen.instant), "reasons": lines}, allow_nan=False), out)
    else:
        _put("\n".join(lines), out)
    return 0


@daa.command()
@FILE
@CONFIG
@OWN
@OUT
@click.option("--sweep", is_flag=True, help="Sweep hazard zones by the alerting time.")
def zones(file: Path, config: str, ownship: str, out: Path | None, sweep: bool) -> int:
    """Hazard zones and contours of every step as JSON polygons (east, north in metres)."""
    from cratous.services.daa.tables import zone_rows

    rows = [
        row
        for s in _steps(file, config, ownship, ())
        for row in zone_rows(s.parameters, s.instant, sweep)
    ]
    _put(json.dumps(rows, allow_nan=False), out)
    return 0


@daa.command()
@click.argument("config", default="")
def presets(config: str) -> int:
    """List the presets, or print one (or a .conf file) with all its keys."""
    from cratous.spec.daa.conf_files import write
    from cratous.spec.daa.presets import named_or_file, names

    _put(write(named_or_file(config)) if config else "\n".join(names()), None)
    return 0
