"""`cratous algebra`: check a process-algebra text, show its tree, list its orders of assignment."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path
from typing import Any, NoReturn

import click

from cratous.spec import algebra as pa
from cratous.spec.algebra import meaning
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES
from cratous.spec.files.printable import json_text, printable
from cratous.spec.files.text_file import text_of

EXAMPLES = """
\b
Operators stand before their operands; tasks are p<id>; times are in ms:
  .(p1 p2)   p2 starts no earlier than p1 ends
  ~(p1 p2)   p2 starts no earlier than p1 starts
  |(p1 p2)   both, in any order
  +(p1 p2)   exactly one of them
  p1_[0-5000]         p1 starts and ends between 0 and 5000 ms after mission start
  .(p1 p2)-[100-900]  p2 starts at least 100 ms and ends at most 900 ms after p1 ends
"""


@click.group(epilog=EXAMPLES)
def algebra() -> None:
    """Check and explain process-algebra texts (the order and timing of tasks)."""


def _input(command: Any) -> Any:
    for option in (
        click.option("--json", "as_json", is_flag=True, help="Print JSON, for machines."),
        click.option("--tasks", metavar="1,2,3", help="Ids of the tasks that exist."),
        click.option("-f", "--file", metavar="FILE", help="Read the text from a file."),
        click.argument("text", required=False),
    ):
        command = option(command)
    return command


@algebra.command(epilog=EXAMPLES)
@_input
@click.option(
    "--limit", default=8, show_default=True, type=click.IntRange(1), help="Branches shown."
)
def check(text: str | None, file: str | None, tasks: str | None, as_json: bool, limit: int) -> None:
    """Check TEXT and print its canonical form, its tasks, and its constraints by branch.

    A branch is one way of choosing an operand of every +.
    """
    term = _term(text, file, tasks, as_json)
    shown = [_facts(branch) for branch in islice(meaning.branches(term), limit)]
    canonical, found = pa.format_term(term), meaning.tasks(term)
    count = meaning.count_branches(term)
    if as_json:
        facts = {"canonical": canonical, "tasks": found, "branches": count, "shown": shown}
        click.echo(json.dumps(facts, ensure_ascii=False))
        return
    click.echo(f"canonical  {canonical}")
    click.echo(f"tasks      {' '.join(f'p{task}' for task in found)}")
    click.echo(f"branches   {count}")
    for number, branch in enumerate(shown, 1):
        click.echo(f"\nbranch {number}: {branch['branch']}")
        for row in branch["rows"]:
            click.echo(f"  {row['text']}")
        if not branch["rows"]:
            click.echo("  no constraint on times")
        for idle in branch["idle"]:
            click.echo(f"  note: the timing {idle} bounds no task")
    if count > len(shown):
        click.echo(f"\n... and {count - len(shown)} more branches; show them with --limit")


def _facts(branch: pa.Term) -> dict[str, Any]:
    idle = [f"{part.suffix} of {meaning.quote(part)}" for part in meaning.idle_timings(branch)]
    return {
        "branch": pa.format_term(branch),
        "rows": [row._asdict() for row in meaning.rows(branch)],
        "idle": idle,
    }


@algebra.command(epilog=EXAMPLES)
@_input
def tree(text: str | None, file: str | None, tasks: str | None, as_json: bool) -> None:
    """Print TEXT as a tree."""
    term = _term(text, file, tasks, as_json)
    click.echo(json.dumps(_as_data(term)) if as_json else "\n".join(_lines(term)))


@algebra.command(epilog=EXAMPLES)
@_input
@click.option(
    "--limit", default=20, show_default=True, type=click.IntRange(1), help="Orders shown."
)
def runs(text: str | None, file: str | None, tasks: str | None, as_json: bool, limit: int) -> None:
    """List the orders in which the tasks of TEXT may be assigned."""
    term = _term(text, file, tasks, as_json)
    found = [list(run) for run in meaning.runs(term, limit + 1)]
    if as_json:
        click.echo(json.dumps({"runs": found[:limit], "all": len(found) <= limit}))
        return
    for run in found[:limit]:
        click.echo(" ".join(f"p{task}" for task in run))
    if len(found) > limit:
        click.echo(f"... and more; show them with --limit {10 * limit}")


def _term(text: str | None, file: str | None, tasks: str | None, as_json: bool) -> pa.Term:
    try:
        if (text is None) == (file is None):
            got = "neither" if text is None else "both"
            raise BadInput("what to read is unclear", expected="TEXT, or -f FILE", got=got)
        known = None if tasks is None else _ids(tasks)
        if file is not None:
            return pa.parse(_read(file), known, where=file)
        return pa.parse(text or "", known)
    except BadInput as error:
        _refuse(error, as_json)


def _read(file: str) -> str:
    return text_of(Path(file), CONFIG_BYTES, "a UTF-8 text")


def _ids(tasks: str) -> frozenset[int]:
    parts = [part.strip() for part in tasks.split(",")]
    for part in parts:
        if not (part.isascii() and part.isdecimal() and len(part) <= 19):
            raise BadInput(
                "this is not a list of task ids", item="--tasks", expected="1,2,3", got=tasks[:60]
            )
    return frozenset(int(part) for part in parts)


def _refuse(error: BadInput, as_json: bool) -> NoReturn:
    if as_json:
        click.echo(json_text(error.data()))
    click.echo(printable(f"Error: {error}"), err=True)
    if isinstance(error, pa.AlgebraError):
        click.echo(error.caret(), err=True)
    raise SystemExit(error.exit_code)


NAMES = {".": "sequential", "~": "start to start", "|": "parallel", "+": "exactly one of"}


def _lines(term: pa.Term, lead: str = "", hang: str = "") -> list[str]:
    name = f"p{term.task}" if isinstance(term, pa.Atom) else f"{term.op}  {NAMES[term.op]}"
    timing = f"  {term.suffix.kind} {term.suffix}" if term.suffix else ""
    lines = [f"{lead}{name}{timing}"]
    operands = term.operands if isinstance(term, pa.Op) else ()
    for operand in operands:
        last = operand is operands[-1]
        below = hang + ("   " if last else "│  ")
        lines += _lines(operand, hang + ("└─ " if last else "├─ "), below)
    return lines


def _as_data(term: pa.Term) -> dict[str, Any]:
    data: dict[str, Any] = {"span": list(term.span)}
    if isinstance(term, pa.Atom):
        data["task"] = term.task
    else:
        data["op"] = term.op
        operands = data["operands"] = []
        for operand in term.operands:
            operands.append(_as_data(operand))
    if term.suffix:
        data["timing"] = {
            "kind": term.suffix.kind,
            "t1_ms": term.suffix.t1_ms,
            "t2_ms": term.suffix.t2_ms,
        }
    return data
