"""`cratous serve`: the ground station for a flight, a run, two runs or a message log, in the browser."""

from __future__ import annotations

import functools
import shlex
import signal
from contextlib import ExitStack, closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from cratous.services.ground_station.access import Access
    from cratous.services.ground_station.page_data import Recorded
    from cratous.services.ground_station.server import GroundStation
    from cratous.services.ground_station.tiles import Tiles

    Listening = tuple[int, Access]
    """Listening port, and access control with the address."""

MISSIONS = (".yaml", ".yml")
FLIGHT, PLANNER = "cratous.services.cli.serve_flight", "cratous.services.cli.serve_plan"


@click.command()
@click.argument("run", metavar="RUN|MISSION", required=False, type=click.Path(path_type=Path))
@click.argument("other", metavar="[RUN_B]", required=False, type=click.Path(path_type=Path))
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8760, show_default=True,
    help="Port; 0 takes a free one.",
)  # fmt: skip
@click.option(
    "--host", metavar="ADDRESS", default="127.0.0.1", show_default=True,
    help="Listen there. Others than 127.0.0.1 need a token, and are not encrypted.",
)  # fmt: skip
@click.option(
    "--access-token-file", "token_file", metavar="FILE", type=click.Path(path_type=Path),
    help="The token that readers need. [environment: CRATOUS_ACCESS_TOKEN; else a new one]",
)  # fmt: skip
@click.option("--edit", is_flag=True, help="MISSION: edit and plan it; nothing flies.")
@click.option(
    "--attach", metavar="HOST:PORT",
    help="Watch a running system instead: a TCP bridge of UxAS, or AMASE.",
)  # fmt: skip
@click.option(
    "--overlay", "overlays", metavar="FILE.geojson", multiple=True, type=click.Path(path_type=Path),
    help="Show this beneath the map: coast, roads, airspace; again for more.",
)  # fmt: skip
@click.option(
    "--tiles", metavar="URL", help="Pictures beneath the map, as https://HOST/{z}/{x}/{y}.png."
)
@click.option("--tiles-attribution", metavar="TEXT", help="What the map says of the pictures.")
@click.option("--out", type=click.Path(path_type=Path), help="MISSION: folder for results. [out]")
@click.option("--seed", type=click.IntRange(0), help="MISSION: variant; 0 is as written.")
@click.option("--no-daa", is_flag=True, help="MISSION: avoidance off; the requirements stay.")
@click.option("--allow-unproved", is_flag=True, help="MISSION: fly kernels without proof.")
def serve(
    run: Path | None,
    other: Path | None,
    port: int,
    host: str,
    token_file: Path | None,
    edit: bool,
    attach: str | None,
    overlays: tuple[Path, ...],
    **more: Any,
) -> int:
    """Replay a RUN in the browser, or two side by side, or fly a MISSION there.

    RUN is the folder of `cratous run`, or a message log of any format. MISSION is a mission file
    (*.yaml): it is planned at once, and flies, pauses and stops as the page says; the results are
    those of `cratous run`, in out/<mission>/, if it flies to its end. Whoever has the whole address
    that is printed may command the flight, from one page at a time.

    RUN RUN_B are two runs of missions in the same frame: one clock, a map, altitudes and events of
    each, and a table of what only one of them has or what is not the same in both, such as takeovers
    and verdicts, with instants to jump to.

    With --attach a running UxAS or AMASE is watched: aircraft, plans, zones and tasks as it tells them
    on sentinel frames, the last hour of it. Nothing is sent to it; a connection that is lost is made
    again.

    With --edit the mission is edited: on the map, as text, its relations with the place of an error
    while they are typed; it is planned as it stands, and saved to its file.

    --overlay shows shapes of GeoJSON files beneath the map, --tiles pictures of a tile server, which then is told by
    the browser what part of the world is looked at. Nothing is planned, flown or judged by them.

    Map with tracks, routes, zones, tasks and takeovers, altitudes over time, verdicts, and events to
    jump to. The address of the page names the instant, so it can be kept. Only this machine reaches
    it, unless --host says otherwise, and nothing but --tiles comes from elsewhere.

    With --host, other machines reach it, and whatever they ask for needs a token: that of the address that
    is printed, or of a file or the environment. There is no TLS: who can listen on the way reads all of it,
    the token too.

    \b
    Example:  cratous serve out/crossing
              cratous serve out/crossing bare/crossing
              cratous serve examples/crossing/mission.yaml --edit
              cratous serve --attach tcp://127.0.0.1:5555

    Exit codes: 0 asked to end (Ctrl-C, SIGTERM), 2 bad input.
    """
    from cratous.services.ground_station.access import access_of
    from cratous.services.ground_station.background import Beneath
    from cratous.services.ground_station.overlays import overlays_of
    from cratous.spec.files.printable import printable

    flight = {name: value for name, value in more.items() if not name.startswith("tiles")}
    tiles = _tiles(more["tiles"], more["tiles_attribution"])
    if (run is None) == (attach is None):
        raise click.UsageError("one of them is shown: RUN or MISSION, or --attach HOST:PORT")
    missions = [path for path in (run, other) if path and _is_mission(path)]
    if other is not None and missions:
        raise click.UsageError(f"two runs are shown side by side, and {missions[0]} is a mission")
    alone = {name: value for name, value in flight.items() if name != "allow_unproved"}
    if edit and (not missions or any(_is_given(value) for value in alone.values())):
        raise click.UsageError("--edit needs a MISSION, and goes without --out, --seed, --no-daa")
    if not missions and any(_is_given(value) for value in flight.values()):
        raise click.UsageError("--out, --seed, --no-daa, --allow-unproved need a MISSION")
    beneath, listening = Beneath(overlays_of(overlays), tiles), (port, access_of(host, token_file))
    with ExitStack() as stack:
        if attach is not None:
            server, name = _watching(attach, listening, stack), attach
        else:
            assert run is not None
            name = f"{run}" if other is None else f"{run} and {other}"
            if edit:
                server = _editing(run, listening, flight["allow_unproved"], stack)
            elif missions:
                server = _flying(run, listening, flight, stack)
            else:
                server = _replaying(run, other, listening, stack)

        server.beneath = beneath

        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda *_: server.shutdown())
        click.echo(printable(f"{name}: {server.whole_url} (Ctrl-C ends it)"))
        if server.access.from_elsewhere():
            click.echo(
                "cratous: other machines can reach this, and nothing is encrypted (no TLS)",
                err=True,
            )
        server.serve_forever()
    return 0


def _tiles(url: str | None, attribution: str | None) -> Tiles | None:
    from cratous.services.ground_station.tiles import tiles_of

    if url is None and attribution is not None:
        raise click.UsageError("--tiles-attribution needs --tiles")
    return None if url is None else tiles_of(url, attribution or "")


def _is_given(value: Any) -> bool:
    return value is not None and value is not False


def _failed(error: Exception) -> None:
    from cratous.spec.errors import BadInput
    from cratous.spec.files.printable import printable

    name = "" if isinstance(error, BadInput) else f"{type(error).__name__}: "
    click.echo(printable(f"cratous: {name}{error}"), err=True)


def _replayed(path: Path) -> Recorded:
    from cratous.services.ground_station.page_data import Recorded
    from cratous.services.ground_station.recording import recording

    return Recorded(lambda: recording(path), _failed)


def _editing(
    mission: Path, listening: Listening, allow_unproved: bool, stack: ExitStack
) -> GroundStation:
    from cratous.services.ground_station.page_data import ReadAnew
    from cratous.services.ground_station.server import PAGE_OF_EDITOR, Commands, GroundStation
    from cratous.services.mission_editor.editor import LONGEST, Editor

    editor = stack.enter_context(closing(Editor(mission, PLANNER, allow_unproved)))
    commands = Commands(editor.orders, LONGEST, {"/planned.json": editor.planned}, editor.token)
    shown = ReadAnew(editor.opened)
    return stack.enter_context(
        GroundStation(shown, *listening, first=PAGE_OF_EDITOR, commands=commands)
    )


def _flying(
    mission: Path, listening: Listening, flight: dict[str, Any], stack: ExitStack
) -> GroundStation:
    from cratous.services.ground_station.live_session import Direct, LiveSession
    from cratous.services.ground_station.page_data import LiveRecorded
    from cratous.services.ground_station.server import GroundStation
    from cratous.services.mission_editor.operator_commands import DIRECT, commanded, directed
    from cratous.spec.files.limits import MISSION_BYTES
    from cratous.spec.files.text_file import text_of

    asked = {**_asked(mission, **flight), "text": text_of(mission, MISSION_BYTES, "a mission file")}

    def amended(now_ms: int, command: Any) -> dict[str, Any]:
        nonlocal asked
        found = commanded(asked["text"], str(mission), asked["seed"], now_ms, command)
        asked = {**asked, "text": found.text, "until_ms": found.at_ms, "commanded": True}
        return asked

    def checked(now_ms: int, command: Any) -> None:
        directed(asked["text"], str(mission), asked["seed"], now_ms, command)

    def flown_with(text: str) -> None:
        nonlocal asked
        asked = {**asked, "text": text, "commanded": True}

    direct = Direct(DIRECT, checked, flown_with)
    live = stack.enter_context(closing(LiveSession(FLIGHT, asked, amended, direct)))
    flown = LiveRecorded(live, lambda folder: _replayed(Path(folder)))
    return stack.enter_context(GroundStation(flown, *listening, live))


def _watching(address: str, listening: Listening, stack: ExitStack) -> GroundStation:
    from cratous.bridge.port import address as read_address
    from cratous.services.ground_station.attached_session import AttachedSession
    from cratous.services.ground_station.page_data import ReadAnew
    from cratous.services.ground_station.server import GroundStation

    text = address if "://" in address else f"tcp://{address}"
    where = read_address(text, ("tcp",), item="--attach")
    session = stack.enter_context(closing(AttachedSession(where)))
    return stack.enter_context(GroundStation(ReadAnew(session.begun), *listening, session))


def _replaying(
    run: Path, other: Path | None, listening: Listening, stack: ExitStack
) -> GroundStation:
    from cratous.services.ground_station.comparison import check_comparable, comparison
    from cratous.services.ground_station.page_data import Recorded
    from cratous.services.ground_station.server import PAGE_OF_TWO, GroundStation
    from cratous.services.logs.source import open_log

    open_log(run).close()  # an invalid log is reported before the server starts
    if other is None:
        return stack.enter_context(GroundStation(_replayed(run), *listening))
    check_comparable(run, other)
    both = Recorded(functools.partial(comparison, run, other), _failed)
    return stack.enter_context(GroundStation(both, *listening, first=PAGE_OF_TWO))


def _is_mission(path: Path) -> bool:
    return path.is_file() and path.suffix in MISSIONS


def _asked(
    mission: Path, out: Path | None, seed: int | None, no_daa: bool, allow_unproved: bool
) -> dict[str, Any]:
    """The request for the flight's process; its report names the equivalent command."""
    from cratous.services.cli.show import shown_path

    options = ["--no-daa"] * no_daa + ["--allow-unproved"] * allow_unproved
    options += ["--seed", str(seed)] if seed else []
    command = ["cratous", "run", shown_path(mission), *options]
    return {
        "path": str(mission), "out": str(out or "out"), "seed": seed or 0, "daa": not no_daa,
        "allow_unproved": allow_unproved, "command": shlex.join(command), "options": options,
    }  # fmt: skip
