"""`cratous log`: message logs of any format: listing, selection, following, export, replay."""

from __future__ import annotations

import json
import socket
import sys
import time
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.numbers import AnyNumber
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.services.logs.entry import Entry
    from cratous.services.logs.selection import Selection
    from cratous.services.logs.source import Source

SUFFIXES = {
    ".mcap": "mcap",
    ".jsonl": "jsonl",
    ".csv": "csv",
    ".xml": "xml",
    ".lmcp": "lmcp",
    ".frames": "frames",
    ".sqlite": "sqlite",
    ".db3": "uxas",
}
FORMS = ("json", "frames", "lmcp")
_SHOWN = 5


@click.group()
def log() -> None:
    """List, filter, follow, export, import and replay message logs.

    A LOG is the SQLite file of `cratous run` or of the message logger (or a folder with
    log.sqlite), UxAS's own messageLog_*.db3, MCAP or JSON lines exported by us, an AMASE scenario
    or playback file, or a capture of sentinel frames or LMCP messages.

    Example:  cratous log list out/crossing

    Exit codes: 0 done, 2 bad input, 3 something is missing (lost, undecodable, damaged).
    """


def selecting(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the message selection options."""
    options = (
        click.option("--type", "types", multiple=True, metavar="TYPE",
                     help="Type, with what inherits from it; or a pattern as 'afrl.cmasi.*'."),
        click.option("--from", "start", metavar="S",
                     help="First time [s of the log's clock]; +S counts from its first message."),
        click.option("--to", "end", metavar="S", help="Last time [s], as --from."),
        click.option("--entity", "entities", type=int, multiple=True, metavar="ID",
                     help="Messages that name this vehicle or other entity."),
        click.option("--text", default="", help="Messages whose JSON form holds this text."),
        click.option("--source", "sources", multiple=True, metavar="NAME", help="Sender's name."),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def on_log(command: Callable[..., int]) -> Callable[..., int]:
    """Decorator: opens the log, builds the selection, and closes the log afterwards."""

    @wraps(command)
    def run(path: Path, types: tuple[str, ...], start: str | None, end: str | None,
            entities: tuple[int, ...], text: str, sources: tuple[str, ...], **rest: Any) -> int:  # fmt: skip
        from cratous.services.logs.selection import Selection
        from cratous.services.logs.source import open_log

        with open_log(path) as source:
            limits = [_time_ms(source, limit) for limit in (start, end)]
            chosen = Selection(types, limits[0], limits[1], entities, text, sources)
            if types:
                _check_types(source, chosen)
            return command(source, chosen, **rest)

    return run


def _check_types(source: Source, chosen: Selection) -> None:
    try:
        chosen.check_types(())
    except BadInput:  # not in our models: check the log
        chosen.check_types(found.topic for found in source.topics())


def _time_ms(source: Source, text: str | None) -> int | None:
    if text is None:
        return None
    try:
        number = float(text)
        ms = round(number * 1000)
    except (ValueError, OverflowError):
        raise BadInput(
            "wrong time",
            item="--from, --to",
            expected="seconds, or +seconds from the first message",
            got=text,
        ) from None
    if text.startswith("+"):
        first = next(iter(source.entries()), None)
        return ms + (first.time_ms if first is not None else 0)
    return ms


def _missing(source: Source) -> list[str]:
    """What is known to be lost, in words."""
    gaps = source.gaps()
    found = [
        f"{gap.missing} messages from {gap.first_ms / 1000:.3f} to {gap.last_ms / 1000:.3f} s were "
        f"lost: {gap.reason}"
        for gap in gaps
    ]
    unexplained = source.holes() - sum(gap.missing for gap in gaps)
    if unexplained > 0:
        found.append(f"{unexplained} numbers are missing and nothing says why")
    return found


@log.command("list")
@click.argument("path", metavar="LOG", type=click.Path(path_type=Path))
@selecting
@click.option("--verify", is_flag=True, help="Check the file and its digest first.")
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
@on_log
def list_(source: Source, chosen: Selection, verify: bool, as_json: bool) -> int:
    """Types in a LOG with their counts and times, and what is missing.

    Example:  cratous log list out/crossing --type EntityState
    """
    from cratous.services.cli.progress import waiting
    from cratous.services.cli.show import table
    from cratous.services.logs.source import Source

    with waiting("checking the log", as_json) as wait:
        if verify:
            source.verify()
        wait.at("counting its messages")
        counted: Source = source
        if chosen:
            counted = Source(source.path, source.kind, lambda _path: source.entries(chosen))
        topics = counted.topics()
        closing, missing = source.closing(), _missing(source)
    count = sum(found.messages for found in topics)
    if as_json:
        data = {
            "kind": source.kind,
            "count": count,
            "types": [found._asdict() for found in topics],
            "closed": closing is not None,
            "digest": closing.digest if closing else None,
            "verified": verify,
            "missing": missing,
        }
        click.echo(json.dumps(data, indent=1))
        return 3 if missing else 0
    rows = [
        [t.topic, str(t.messages), f"{t.first_ms / 1000:.3f}", f"{t.last_ms / 1000:.3f}"]
        for t in topics
    ]
    table(["type", "messages", "first [s]", "last [s]"], rows)
    click.echo(f"{count} messages of {len(topics)} types ({source.kind})")
    if end := source.end():
        click.echo(end + (" (verified)" if verify and closing is not None else ""))
    for line in missing:
        say(f"MISSING: {line}")
    return 3 if missing else 0


@log.command("filter")
@click.argument("path", metavar="LOG", type=click.Path(path_type=Path))
@selecting
@click.option("--limit", type=click.IntRange(1), help="Stop after so many messages.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON lines.")
@on_log
def filter_(source: Source, chosen: Selection, limit: int | None, as_json: bool) -> int:
    """Print the messages of a LOG that are chosen, one a line.

    Example:  cratous log filter out/crossing --type AuthorityChange --entity 1
    """
    show, undecoded = _printer(as_json)
    for number, entry in enumerate(source.entries(chosen)):
        if number == limit:
            break
        show(entry)
    return _told("shown as bytes", undecoded)


def _printer(as_json: bool) -> tuple[Callable[[Entry], None], list[str]]:
    from cratous.services.logs.files import json_line, text_form

    undecoded: list[str] = []

    def show(entry: Entry) -> None:
        line, error = json_line(entry)
        say(line if as_json else text_form(entry))
        if error is not None:
            undecoded.append(f"{entry.place}: {error}")

    return show, undecoded


def _told(what: str, problems: list[str]) -> int:
    if problems:
        click.echo(f"cratous: {len(problems)} messages {what}", err=True)
        for line in problems[:_SHOWN]:
            say(f"  {line}", err=True)
    return 3 if problems else 0


@log.command()
@click.argument("path", metavar="LOG", type=click.Path(path_type=Path))
@selecting
@click.option("--new", is_flag=True, help="Only messages from now on.")
@click.option("--for", "seconds", type=AnyNumber(), help="Stop after so many seconds.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON lines.")
def follow(path: Path, new: bool, seconds: float | None, as_json: bool, **choice: Any) -> int:
    """Print the messages of a LOG as they are written, until its writer closes it.

    The log must be one of the message logger (SQLite); it may not exist yet.

    Example:  cratous log follow datawork/SavedMessages/messageLog_0.sqlite --type MissionCommand
    """
    from cratous.services.logs.follow import follow_log
    from cratous.services.logs.selection import Selection

    show, undecoded = _printer(as_json)
    relative = (choice.pop("start"), choice.pop("end"))
    limits = []
    for text in relative:
        try:
            limits.append(None if text is None else round(float(text) * 1000))
        except (ValueError, OverflowError):
            raise BadInput(
                "wrong time", item="--from, --to", expected="seconds", got=str(text)
            ) from None
    chosen = Selection(from_ms=limits[0], to_ms=limits[1], **choice)
    try:
        chosen.check_types(())
    except BadInput as error:  # messages of this type may still arrive
        say(f"cratous: note: no type of ours: {error.item}", err=True)
    if not path.exists():
        say(f"cratous: note: {path} is not there yet; waiting for it", err=True)
    deadline = None if seconds is None else time.monotonic() + seconds
    closed = False
    for entry in follow_log(path, chosen, new=new, deadline=deadline):
        if entry is None:
            closed = True
            break
        show(entry)
    click.echo("the log is closed" if closed else "the time is over", err=True)
    return _told("shown as bytes", undecoded)


@log.command()
@click.argument("path", metavar="LOG", type=click.Path(path_type=Path))
@selecting
@click.option("-o", "--output", "target", required=True, type=click.Path(path_type=Path),
              help="File to write.")  # fmt: skip
@click.option("--format", "form", type=click.Choice(sorted(SUFFIXES.values())),
              help="Format; the default goes by the file's suffix.")  # fmt: skip
@click.option("--bytes", "with_bytes", is_flag=True, help="MCAP: a channel with the LMCP bytes.")
@click.option("--salvage", is_flag=True, help="Write what can be read of a damaged log.")
@on_log
def export(
    source: Source,
    chosen: Selection,
    target: Path,
    form: str | None,
    with_bytes: bool,
    salvage: bool,
) -> int:
    """Write a LOG in another format: MCAP, JSON lines, CSV, XML, LMCP, frames, SQLite, UxAS's.

    MCAP opens in Foxglove, with a JSON Schema for each type and vehicles on the map; the XML opens
    in AMASE; .db3 is UxAS's table `msg`; frames are what UxAS's TCP bridge sends.

    Example:  cratous log export out/crossing -o crossing.mcap
    """
    return _export(source, chosen, target, form, with_bytes, salvage)


def _export(
    source: Source,
    chosen: Selection | None,
    target: Path,
    form: str | None,
    with_bytes: bool,
    salvage: bool,
) -> int:
    from cratous.services.cli.progress import waiting
    from cratous.services.logs.export import export as write

    form = form or SUFFIXES.get(target.suffix)
    if form is None:
        raise BadInput(
            "no format", item=target.name, expected=f"--format, or one of {', '.join(SUFFIXES)}"
        )
    with waiting(f"writing {target}"):
        done = write(source, target, form, chosen, with_bytes=with_bytes, salvage=salvage)
    say(f"{done.count} messages written to {target} ({form})")
    code = _told("kept as bytes", done.undecoded)
    code = max(code, _told("left out", done.left_out))
    if done.damage is not None:
        click.echo(f"cratous: {done.damage}", err=True)
        code = 3
    return code


@log.command("import")
@click.argument("path", metavar="FILE", type=click.Path(path_type=Path))
@click.option("-o", "--output", "target", required=True, type=click.Path(path_type=Path),
              help="Log to write (SQLite).")  # fmt: skip
@click.option("--salvage", is_flag=True, help="Take what can be read of a damaged file.")
def import_(path: Path, target: Path, salvage: bool) -> int:
    """Make a log of ours (SQLite) of FILE: MCAP, JSON lines, XML, frames, LMCP, UxAS's .db3.

    Example:  cratous log import crossing.mcap -o log.sqlite
    """
    from cratous.services.logs.source import open_log

    with open_log(path) as source:
        return _export(source, None, target, "sqlite", False, salvage)


@log.command()
@click.argument("path", metavar="LOG", type=click.Path(path_type=Path))
@selecting
@click.option("--rate", type=AnyNumber(), default=1.0, show_default=True,
              help="Times faster than it was; 0 as fast as it goes.")  # fmt: skip
@click.option("--connect", "connect_to", metavar="ADDRESS",
              help="Send sentinel frames to a TCP server, as tcp://127.0.0.1:5555.")  # fmt: skip
@click.option("--listen", "listen_at", metavar="ADDRESS",
              help="Wait for a TCP client there and send it sentinel frames.")  # fmt: skip
@click.option("--form", type=click.Choice(FORMS), help="On standard output: json (default), ...")
@on_log
def replay(
    source: Source,
    chosen: Selection,
    rate: float,
    connect_to: str | None,
    listen_at: str | None,
    form: str | None,
) -> int:
    """Send the messages of a LOG again at their times, to standard output or over TCP.

    Example:  cratous log replay out/crossing --rate 10 --connect tcp://127.0.0.1:5555
    """
    from cratous.services.logs import replay as player
    from cratous.services.logs.entry import to_bytes
    from cratous.services.logs.files import framed, json_line

    if connect_to and listen_at:
        raise BadInput("two places to send to", expected="--connect or --listen")
    if (connect_to or listen_at) and form == "json":
        raise BadInput("wrong form", item="--form", expected="frames or lmcp on TCP", got="json")

    def as_json(entry: Entry) -> bytes:
        return (json_line(entry)[0] + "\n").encode()

    to_peer = connect_to or listen_at
    chosen_form = form or ("frames" if to_peer else "json")
    send_as = {"json": as_json, "frames": framed, "lmcp": to_bytes}[chosen_form]
    skipped: list[str] = []

    def skip(entry: Entry, error: BadInput) -> None:
        skipped.append(f"{entry.place}: {error}")

    entries = source.entries(chosen)
    if to_peer:
        with _peer(connect_to, listen_at) as peer:
            out = player.TcpOut(peer)
            sent = player.replay(entries, out, send_as, rate, skip)
    else:
        stdout = sys.stdout.buffer
        to_stream = player.StreamOut(stdout.write, stdout.flush)
        sent = player.replay(entries, to_stream, send_as, rate, skip)
    click.echo(f"{sent} messages sent", err=True)
    return _told("not sent", skipped)


def _peer(connect_to: str | None, listen_at: str | None) -> socket.socket:
    from cratous.services.logs import replay as player

    if connect_to:
        return player.connect(connect_to)
    return player.accept(str(listen_at), lambda at: click.echo(f"waiting at {at}", err=True))
