"""`cratous judge`: whether a logged flight satisfies G1 to G5, by a program that shares no code with it."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import click

PATIENCE_S, DOING = 1.0, "judging the flight from its log"
"""Progress message, printed if judging takes longer than this [s]."""


def _say(text: str) -> None:
    """Print one line; text from a log cannot control the terminal or start a new line."""
    shown = (c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    click.echo("".join(shown))


@click.command()
@click.argument("log", type=click.Path(path_type=Path))
@click.option(
    "--mission", type=click.Path(path_type=Path),
    help="Judge by this mission file instead of the mission in the log.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the judgement as JSON.")
@click.option("--all", "every", is_flag=True, help="Print all rows, also those that hold.")
def judge(log: Path, mission: Path | None, as_json: bool, every: bool) -> int:
    """Judge a LOG (an output folder of cratous run, or its log.sqlite) by an independent program.

    It shares no code with planner, pilot, monitor and kernels. Where the folder has a report, its
    monitor's verdicts are compared row by row, and disagreement is the first line.

    Example:  cratous judge out/crossing

    Exit codes: 0 all requirements hold, 1 something is violated or the two disagree, 2 bad input,
    3 something is unknown.
    """
    from cratous.judge.verdict import GUARANTEES, HOLDS

    # its own progress line: this command imports nothing of the judged code
    told = threading.Timer(PATIENCE_S, click.echo, (DOING,), {"err": True})
    told.daemon = True
    if not as_json:
        told.start()
    try:
        found = judgement(log, mission)
    finally:
        told.cancel()
    if as_json:
        click.echo(json.dumps(found.data(), indent=1))
        return found.exit_code
    if found.disagreements:
        click.echo(f"DISAGREEMENT of judge and monitor in {len(found.disagreements)} rows")
    for difference in found.differences:
        _say(f"  {difference.kind}: {difference.line()}")
    for name, title in GUARANTEES.items():
        rows = [row for row in found.rows if row.guarantee == name]
        click.echo(f"{name} {found.of(name):9} {len(rows)} rows: {title}")
        for row in rows:
            if every or row.verdict != HOLDS:
                _say(f"   {row.verdict:9} {row.item}: {row.note}")
    if found.not_covered:
        click.echo(f"not covered (not protected): {', '.join(map(str, found.not_covered))}")
    beside = "no report to compare with"
    if found.report:
        beside = "as the monitor" if not found.differences else "see above for the monitor"
    click.echo(f"JUDGED {found.verdict} ({beside}); exit code {found.exit_code}")
    return found.exit_code


def judgement(log: Path, mission: Path | None = None) -> Any:
    """The judge's result for a log, a `cratous.judge.Judgement`; the only access to it."""
    from cratous.judge import judge as decide

    return decide(log, mission)


def encounter_rows(file: Path, states: Any, reached: Any) -> list[Any]:
    """The judge's rows for a short flight without a log. See `cratous.judge.encounter`."""
    from cratous.judge.encounter import judge_encounter

    return judge_encounter(file, states, reached)
