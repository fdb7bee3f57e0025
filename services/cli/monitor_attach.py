"""`cratous monitor --attach`: checks a running system against user requirements."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.bridge.port import Report
    from cratous.services.logs.entry import Entry
    from cratous.services.logs.store import LogStore
    from cratous.services.requirements.attached import Attached
    from cratous.services.requirements.outcome import Outcome
    from cratous.services.requirements.tapped_bridge import Tapped

WAIT_S = 60.0
"""Maximum wait for a server at the address [s]."""
TAP_WAIT_S = 600.0
"""Maximum wait for a client of a tap [s]: it may have to check its proofs first."""
TAP = "cratous://"


class Live(NamedTuple):
    """Options besides the verdicts. seconds: None for no limit; metrics: a port, None for none;
    listen, keys: of a tap, the address for its clients, and the folder of vehicle keys.
    """

    seconds: float | None
    keep: Path | None
    metrics: int | None
    on_violation: str
    listen: str | None = None
    keys: Path | None = None


def attach(
    address: str, requirements: Path, live: Live, as_json: bool, allow_unproved: bool
) -> int:
    """Watch until the time is over or a signal arrives; returns the exit code."""
    from cratous.bridge.port import is_due
    from cratous.core import ledger
    from cratous.services.certify.blame_own import own_blame
    from cratous.services.cli.live_table import shown, table_of
    from cratous.services.cli.monitor_requirements import Judged, print_result, read
    from cratous.services.logs.store import Gap, LogStore
    from cratous.services.requirements.lint import lint
    from cratous.services.requirements.metrics import text_of
    from cratous.services.requirements.sampling import NOT_WHOLE, SAYS
    from cratous.services.requirements.tapped_bridge import refuse_untold
    from cratous.services.requirements.traces import rows_of_messages, wanted_of
    from cratous.services.requirements.watch import Watch

    open_source = _tap(address, live) if address.startswith(TAP) else _peer(address, live)
    spec = read(requirements)
    if not spec.timed:
        raise BadInput(
            "these requirements count samples", where=str(requirements), expected="a file *.req"
        )
    words = _command(live.on_violation)
    standing = ledger.require(allow_unproved=allow_unproved)
    remarks = lint(spec)
    watch = Watch(spec)
    wanted = wanted_of(spec, watch.needed)
    if address.startswith(TAP):
        refuse_untold(wanted)
    stores: list[LogStore] = []

    def find(kind: str, time_ns: int) -> None:
        watch.sampling.find(kind, "", time_ns)
        for store in stores if kind in NOT_WHOLE else ():
            now_ms = time_ns // 10**6
            # the number of missing messages is unknown
            store.keep_gap(Gap(store.count, 1, now_ms, now_ms, SAYS[kind]))

    attached, wait_s = open_source(lambda _severity, said: click.echo(said, err=True), find)
    stopping: list[int] = []
    limit_ms = None if live.seconds is None else live.seconds * 1000
    with ExitStack() as stack:
        for number in (signal.SIGINT, signal.SIGTERM):
            before = signal.signal(number, lambda got, _frame: stopping.append(got))
            stack.callback(signal.signal, number, before)
        if live.metrics is not None:
            from cratous.services.requirements.metrics_server import served

            port = stack.enter_context(served(live.metrics, lambda: text_of(watch, attached.seq)))
            click.echo(f"metrics: http://127.0.0.1:{port}/metrics", err=True)
        messages = attached.messages(
            wait_s, lambda now_ms: bool(stopping) or is_due(limit_ms, now_ms)
        )
        if live.keep is not None:
            stores.append(stack.enter_context(LogStore(live.keep, origin=address)))
            messages = _recorded(messages, stores[0])
        rows = rows_of_messages(
            messages,
            wanted,
            lambda entry: find("refused", entry.time_ms * 10**6),
            watch.sampling.told_by,
        )
        stack.enter_context(
            shown(lambda: table_of(watch, attached.seq, attached.now_ms()), not as_json)
        )
        for _ in watch.rows(rows):
            for event, one in watch.news:
                _tell(event, one, as_json, watch.is_unauthenticated(one))
                if event == "violated" and words:
                    _run(words, one)
            watch.news.clear()
        if watch.sampling.is_late(attached.now_ms() * 10**6):
            find("silent", watch.sampling.last)
    for line in attached.left():
        click.echo(line, err=True)
    seen_s = attached.now_ms() / 1000
    click.echo(f"watched until {seen_s:g} s; what the system does later is unseen", err=True)
    found = watch.result()
    blame = own_blame(found.outcomes, spec, None)
    return print_result(Judged(True, found, remarks, blame, notes=spec.notes), standing, as_json)


Find = Callable[[str, int], None]
Open = Callable[["Report", Find], tuple["Attached | Tapped", float]]


def _peer(address: str, live: Live) -> Open:
    """How to connect to a peer, and the maximum wait for it."""
    from cratous.bridge.port import address as read_address

    text = address if "://" in address else f"tcp://{address}"
    where = read_address(text, ("tcp", "zmq"), item="--attach")
    if live.listen is not None or live.keys is not None:
        name = "--keys" if live.listen is None else "--listen"
        raise BadInput(f"{name} is of a tap", expected=f"--attach {TAP}HOST:PORT", got=address)

    def opened(report: Report, find: Find) -> tuple[Attached | Tapped, float]:
        from cratous.services.requirements.attached import Attached

        return Attached(where, report, find), WAIT_S

    return opened


def _tap(address: str, live: Live) -> Open:
    """The same for a tap, with the maximum wait for a client."""
    from cratous.bridge.port import address as read_address

    if live.listen is None:
        raise BadInput(
            "a tap needs a place where clients connect", item="--listen", expected="HOST:PORT"
        )
    if live.keys is not None and not live.keys.is_dir():
        raise BadInput("there is no such folder", item="--keys", got=str(live.keys))
    _refuse_no_keys(live.keys)
    leads_to = read_address("tcp://" + address.removeprefix(TAP), ("tcp",), item="--attach")
    listens = read_address(f"tcp://{live.listen}", ("tcp",), item="--listen", free=True)

    def opened(report: Report, find: Find) -> tuple[Attached | Tapped, float]:
        from cratous.bridge.tap import Tap
        from cratous.services.requirements.tapped_bridge import Tapped

        tap = Tap(listens, leads_to)
        here = f"tap: clients connect to {tap.bound[0]}:{tap.bound[1]}"
        click.echo(f"{here}, which leads to {leads_to.host}:{leads_to.port}", err=True)
        return Tapped(tap, lambda vehicle: _key(vehicle, live.keys), report, find), TAP_WAIT_S

    return opened


def _refuse_no_keys(folder: Path | None) -> None:
    """BadInput for a key file without a key: its lines would silently not be authenticated."""
    from cratous.bridge.text_protocol.keys import key_of

    for file in sorted(folder.glob("vehicle_*.key")) if folder is not None else ():
        number = file.stem.removeprefix("vehicle_")
        if number.isdecimal() and str(int(number)) == number:
            key_of(int(number), folder)


def _key(vehicle: int, folder: Path | None) -> bytes | None:
    from cratous.bridge.text_protocol.keys import key_of

    try:
        return key_of(vehicle, folder)
    except BadInput:
        return None


def _recorded(messages: Iterator[Entry], store: LogStore) -> Iterator[Entry]:
    for entry in messages:
        store.write(entry)
        yield entry


def _tell(event: str, one: Outcome, as_json: bool, unauthenticated: bool) -> None:
    from cratous.services.requirements.outcome import TOLD_BY

    at_s = getattr(one, f"first_{event}") / 1e9
    if as_json:
        data: dict[str, Any] = {"event": event, "requirement": one.name, "at_s": at_s}
        if event == "violated":
            data["known_s"] = one.decided_at / 1e9
        said = {"severity": one.requirement.severity, "unauthenticated": unauthenticated}
        click.echo(json.dumps({**data, **said}))
        return
    severity = f" [{one.requirement.severity}]" if one.requirement.severity else ""
    who = f", {TOLD_BY}" if unauthenticated else ""
    click.echo(f"{one.name}{severity}: {event} at {at_s:g} s{who}")


def _command(text: str) -> list[str]:
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise BadInput("this is no command", item="--on-violation", got=str(error)) from None
    if words and shutil.which(words[0]) is None:
        raise BadInput(
            "there is no such program", item="--on-violation", expected="a program", got=words[0]
        )
    return words


def _run(words: list[str], one: Outcome) -> None:
    """Start the user's command without waiting for it."""
    about = {
        "CRATOUS_REQUIREMENT": one.name,
        "CRATOUS_SEVERITY": one.requirement.severity,
        "CRATOUS_AT_S": f"{one.first_violated / 1e9:.9g}",
    }
    try:
        subprocess.Popen(words, env={**os.environ, **about}, stdin=subprocess.DEVNULL)
    except OSError as error:
        click.echo(f"--on-violation: {words[0]}: {error.strerror}", err=True)
