"""`cratous uxas`: runs a UxAS configuration, with the options and folders of `uxas`."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.show import say

_COMPILING = (
    "TaskManagerService",
    "RoutePlannerVisibilityService",
    "AssignmentTreeBranchBoundService",
)
"""Services that run compiled loops."""


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "-cfgPath",
    "cfg_path",
    type=click.Path(path_type=Path),
    default=Path("cfg.xml"),
    show_default=True,
    help="The configuration.",
)
@click.option(
    "-runUntil", "run_until", type=click.IntRange(0), default=0, help="Seconds; 0: RunDuration_s."
)
@click.option("-version", "version", is_flag=True, help="Print the versions and go on.")
@click.option("--without", multiple=True, metavar="TYPE", help="Leave out services of a type.")
@click.option("--check", is_flag=True, help="Check the configuration, start nothing.")
@click.option("--strict", is_flag=True, help="Refuse what is read leniently otherwise.")
@click.option("--virtual-time", is_flag=True, help="Wait for nothing; no bridges.")
@click.option("--allow-unproved", is_flag=True, help="Plan with kernels that have no proof.")
def uxas(
    cfg_path: Path,
    run_until: int,
    version: bool,
    without: tuple[str, ...],
    check: bool,
    strict: bool,
    virtual_time: bool,
    allow_unproved: bool,
) -> int:
    """Run a UxAS configuration: its services and bridges, in one process.

    Logs go to ./log, data to ./datawork, as with `uxas`; paths of message files are relative to
    the present folder. Ends after -runUntil or RunDuration_s seconds, at KillService -1, or at
    Ctrl-C.

    Example:  cratous uxas -cfgPath cfg.xml -runUntil 60

    Exit codes: 0 it ran to its end, 2 the configuration is refused, 3 ICAROUS instances that it waits for
    have not come.
    """
    from cratous.services.loading.uxas_settings import read
    from cratous.services.uxas.logs import Logs
    from cratous.services.uxas.process import Process, data_folder

    if version:
        _versions()
    config = read(cfg_path, strict=strict)
    root = config.root
    if check:
        from cratous.services.uxas.manager import check as check_all

        notes: list[str] = []
        count = len(check_all(config, frozenset(without), notes))
        for note in notes:
            say(f"warning: {note}")
        say(f"{cfg_path}: {count} services and bridges")
        return 0
    log = Logs(
        root["ConsoleLoggerSeverityLevel"],
        root["MainFileLoggerSeverityLevel"],
        Path("log"),
        echo=lambda text: click.echo(text, err=True),
        thread_id=root["isLoggingThreadId"],
    )
    try:
        _require_proofs(config, log, allow_unproved)
        _compile_ahead(config, without, log)
        data = data_folder(config, Path("."))
        time.sleep(0 if virtual_time else root["StartDelay_ms"] / 1000)
        with Process(
            config,
            log,
            without=frozenset(without),
            virtual=virtual_time,
            say=say,
            data=data,
        ) as process:
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, lambda *_: _stop(process))
            log("INFO", f"running {cfg_path} as entity {root['EntityID']}")
            limit = run_until or root["RunDuration_s"]
            spare = _spare(config, without, process.host.shared.get("contexts"))
            process.run(None if limit is None else float(limit), spare)
        log("INFO", "ended")
    finally:
        log.close()
    return 0


def _stop(process: Any) -> None:
    if process.stopping:  # second request: do not wait for the plan in progress
        raise KeyboardInterrupt
    process.stopping = True


def _require_proofs(config: Any, log: Any, allow_unproved: bool) -> None:
    """Require proved kernels if the pipeline plans, unless the user allows unproved ones."""
    from cratous.services.uxas.registry import KINDS

    if any(KINDS[e.type].plans for e in config.entries if e.type in KINDS):
        from cratous.core.ledger import require
        from cratous.services.cli.progress import waiting

        with waiting("holding the code against its proofs"):
            standing = require(allow_unproved=allow_unproved)
        log("WARN" if standing.problems else "INFO", f"proofs: {standing.line}")


def _plans(config: Any, without: tuple[str, ...]) -> bool:
    """Whether a service of the configuration runs compiled loops."""
    return bool({e.type for e in config.entries if e.type not in without} & {*_COMPILING})


def _compile_ahead(config: Any, without: tuple[str, ...], log: Any) -> None:
    """Compile before the first request, so that planning services answer in time."""
    if _plans(config, without):
        from cratous.services.startup import codecs
        from cratous.services.startup.warm import ensure_planning

        ensure_planning(lambda text: log("WARN", text))
        codecs.make()


def _spare(config: Any, without: tuple[str, ...], contexts: Any) -> Iterator[bool] | None:
    """Background work before the first request, so that it takes no longer than the second."""
    if not _plans(config, without):
        return None
    from cratous.services.startup.idle_work import pieces

    return pieces(contexts)


def _versions() -> None:
    from cratous import __version__
    from cratous.bridge.lmcp import model

    click.echo(f"cratous {__version__}")
    for name in model.SERIES:
        click.echo(f"{name}: {model.load(name).version}")
