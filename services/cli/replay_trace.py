"""`cratous replay-trace`: replays a trace of a broken design on the real actors."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from cratous.spec.files.printable import json_text, printable


@click.command()
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILE..."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, for machines.")
def replay_trace(files: tuple[Path, ...], as_json: bool) -> None:
    """Play traces of `cratous search-faults --traces DIR` on the actors that fly.

    Each is played from the start of a flight of one vehicle: gate, ICAROUS, the UxAS end and the executive are
    those of `cratous run`, and SETMOD lines go over its sockets. What arrives, and when, is the trace's. After each
    event gate, ICAROUS and UxAS have to stand as the trace says; the first that does not is told. A trace of the
    certificate in hand is played on the vehicle that holds it: gate, surveillance and autopilot of `cratous run`.

    Example: cratous replay-trace traces/*.json

    Exit code: 0 the actors leave each trace to a fault, and fly the others to their end; 1 they fly one to its
    fault, or leave one that has none; 2 bad input.
    """
    from cratous.services.cli.progress import waiting
    from cratous.services.trace_replay.files import read
    from cratous.services.trace_replay.play import play_trace

    code, rows = 0, []
    for file, trace in [(file, read(file)) for file in files]:
        with waiting(f"playing {file}", as_json):
            played = play_trace(trace)
        good = bool(played.why) == bool(trace.wrong)
        code = code if good else 1
        rows.append({"file": str(file), "design": trace.design, **played._asdict(), "good": good})
        if as_json:
            continue
        click.secho(printable(f"{trace.design}: {trace.says}"), bold=True)
        for number, text in enumerate(trace.texts[: played.followed + 1], 1):
            left = number > played.followed
            click.echo(printable(f"  {number}. {text}{': NOT SO' if left else ''}"))
        if played.why:
            click.secho(f"  what flies leaves the trace: {played.why}", fg=None if good else "red")
        elif trace.wrong:
            click.secho(printable(f"  WRONG, and flown so: {trace.wrong}"), fg="red")
        else:
            click.echo("  flown to its end as the trace says")
    if as_json:
        click.echo(json_text({"traces": rows, "exit_code": code}))
    sys.exit(code)
