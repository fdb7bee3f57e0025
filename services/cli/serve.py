"""`cratous serve`: the ground station, a run or a message log in the browser."""

from __future__ import annotations

import signal
import threading
from pathlib import Path

import click


@click.command()
@click.argument("run", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8760, show_default=True,
    help="Port on 127.0.0.1; 0 takes a free one.",
)  # fmt: skip
def serve(run: Path, port: int) -> int:
    """Replay a RUN in the browser: the folder of `cratous run`, or a message log of any format.

    Map with tracks, routes, zones, tasks and takeovers, altitudes over time, verdicts of the run's
    report, and events to jump to. Open the address that is printed; the address of the page names
    the instant, so it can be kept. Only this machine reaches it, and nothing comes from elsewhere.

    Example:  cratous serve out/crossing

    Exit codes: 0 asked to end (Ctrl-C, SIGTERM), 2 bad input.
    """
    from cratous.services.ground_station.recording import recording
    from cratous.services.ground_station.server import GroundStation, Recorded
    from cratous.services.logs.source import open_log
    from cratous.spec.errors import BadInput
    from cratous.spec.files.printable import printable

    open_log(run).close()  # what is no log is told before anything listens

    def failed(error: Exception) -> None:
        name = "" if isinstance(error, BadInput) else f"{type(error).__name__}: "
        click.echo(printable(f"cratous: {name}{error}"), err=True)

    with GroundStation(Recorded(lambda: recording(run), failed), port) as server:

        def stop(*_: object) -> None:
            # from a thread: it waits for the loop that this signal interrupts
            threading.Thread(target=server.shutdown, daemon=True).start()

        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, stop)
        click.echo(printable(f"{run}: {server.url} (Ctrl-C ends it)"))
        server.serve_forever(poll_interval=0.2)
    return 0
