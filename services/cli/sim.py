"""`cratous sim`: the simulator as a stand-alone program."""

from __future__ import annotations

import re
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.numbers import Number
from cratous.services.cli.progress import Waiting, waiting

if TYPE_CHECKING:
    from cratous.bridge.port import Address
    from cratous.services.simulator.scenario import Scenario
    from cratous.services.simulator.sensed import Sensed
    from cratous.services.simulator.terrain import Terrain
    from cratous.services.simulator.world import World
    from cratous.spec.mission.sensing import Sensing


@click.command()
@click.argument("scenario", type=click.Path(path_type=Path))
@click.option("--listen", metavar="HOST:PORT", help="Be AMASE for clients at this address.")
@click.option(
    "--rate", type=Number(0, 1e6, min_open=True), default=1.0, show_default=True,
    help="Times faster than real time, with --listen.",
)  # fmt: skip
@click.option(
    "--clients", type=click.IntRange(0, 100), default=0, help="Begin when so many are connected."
)
@click.option(
    "--only", type=click.IntRange(1, 100), metavar="N",
    help="Let so many clients in and then nobody; end when one of them goes.",
)  # fmt: skip
@click.option(
    "--vehicle", "vehicles", multiple=True, metavar="ID=HOST:PORT",
    help="A port of its own for a vehicle, with --listen; repeatable.",
)  # fmt: skip
@click.option(
    "--terrain", "tiles", multiple=True, type=click.Path(path_type=Path), metavar="PATH",
    help="A DTED or SRTM tile (.dt0 .dt1 .dt2 .hgt), or a folder of them; repeatable.",
)  # fmt: skip
@click.option(
    "--sensing", type=click.Path(path_type=Path), metavar="FILE",
    help="Aircraft have the sensors of the section `sensing` of a mission file (YAML); else states are the true ones.",
)  # fmt: skip
@click.option("--until", type=Number(0, min_open=True), help="End after so many seconds of it.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Write all that is told: sentinel frames.")  # fmt: skip
@click.option(
    "--compatibility", type=click.Choice(["none", "amase"]), default="none", show_default=True,
    help="amase: with AMASE's defects.",
)  # fmt: skip
def sim(
    scenario: Path,
    listen: str | None,
    until: float | None,
    output: Path | None,
    compatibility: str,
    **how: Any,
) -> int:
    """Fly the aircraft of an AMASE SCENARIO (XML), and move what drives or sails.

    Without --listen as fast as it goes, to the end; -o keeps what AMASE would tell (read it with
    `cratous lmcp decode`). With --listen for clients such as UxAS, at --rate: they send MissionCommand,
    VehicleActionCommand and others, and SessionStatus to pause, run, reset or stop.

    Example:  cratous sim 02_waterway.xml --listen 127.0.0.1:5555

    Exit codes: 0 the scenario is over, or it was asked to end (SIGTERM, Ctrl-C, Stopped), 2 bad input,
    3 a client has gone that --only counts on.
    """
    from cratous.services.simulator.scenario import read
    from cratous.services.simulator.world import World
    from cratous.spec.errors import BadInput

    clients, only, vehicles = how["clients"], how["only"], how["vehicles"]
    tiles, sensing_file = how.pop("tiles"), how.pop("sensing")
    if sensing_file is not None and compatibility == "amase":
        raise BadInput(
            "AMASE has no such sensors", item="--sensing", expected="--compatibility none"
        )
    if listen is not None and output is not None:
        raise BadInput("not both", item="--listen, -o", expected="one of them")
    if listen is None and (clients or only):
        raise BadInput("clients of nothing", item="--clients, --only", expected="--listen as well")
    if vehicles and (listen is None or only):
        raise BadInput(
            "a vehicle's port", item="--vehicle", expected="--listen as well, and no --only"
        )
    if only is not None and clients > only:
        raise BadInput(
            "more clients than are let in",
            item="--clients",
            expected=f"at most {only}, as --only says",
            got=str(clients),
        )
    plan = read(scenario)
    terrain, sensing = _terrain(tiles), _sensing(sensing_file)
    for note in plan.notes:
        click.echo(f"note: {note}", err=True)
    end_s = min(plan.duration_s, until or plan.duration_s)

    def make() -> World:
        compatible = compatibility == "amase"
        return World(
            plan.events,
            end_s,
            start_s=plan.start_s,
            compatible=compatible,
            terrain=terrain,
            sensed=None if sensing is None else _sensed(sensing),
        )

    if listen is not None:
        return _serve(make, plan, listen, how | {"only": only or 0, "vehicles": _ports(vehicles)})
    began_s = time.monotonic()
    world = make()
    with waiting("flying the scenario") as wait:
        _write(world, output, wait)
    took_s = max(1e-9, time.monotonic() - began_s)
    _tell_unheard(world)
    played_s = world.time_s - world.start_s
    click.echo(
        f"{plan.name}: {played_s:.0f} s of {_count(world)}, {played_s / took_s:.0f} times real time"
    )
    return 0


def _terrain(paths: Sequence[Path]) -> Terrain | None:
    """The terrain in files and folders; None without any."""
    if not paths:
        return None
    from cratous.services.simulator.terrain import Terrain

    return Terrain(paths)


def _sensing(path: Path | None) -> Sensing | None:
    """The sensors in a file; None without one."""
    if path is None:
        return None
    from cratous.services.loading.yaml_sensing import sensing_of_file
    from cratous.services.simulator.sensed import LEAST_PERIOD_MS

    return sensing_of_file(path, LEAST_PERIOD_MS)


def _sensed(sensing: Sensing) -> Sensed:
    from cratous.services.simulator.sensed import Sensed

    return Sensed(sensing)


def _ports(texts: Sequence[str]) -> dict[int, Address]:
    """Addresses by vehicle; BadInput for an invalid text or a duplicate vehicle."""
    from cratous.bridge.port import address
    from cratous.spec.errors import BadInput

    found: dict[int, Address] = {}
    for text in texts:
        key, equal, place = text.partition("=")
        if not equal or not re.fullmatch(r"[0-9]{1,18}", key) or int(key) in found:
            raise BadInput(
                "no vehicle with its port, or a vehicle twice",
                item="--vehicle",
                expected="ID=HOST:PORT, each ID once",
                got=text,
            )
        found[int(key)] = address(f"tcp://{place}", ("tcp",), item="--vehicle", free=True)
    return found


def _configures(body: Any) -> bool:
    """Whether an object defines a vehicle."""
    from cratous.services.simulator.server import CONFIGURATIONS

    return type(body).__name__ in CONFIGURATIONS


def _count(world: World) -> str:
    """Number of aircraft, and of other entities, in words."""
    others = len(world.drivers.there)
    more = f" and {others} that drive or sail" if others else ""
    return f"{len(world.aircraft)} aircraft{more}"


def _tell(world: World, wait: Waiting) -> None:
    for text in world.warnings():
        wait.line(f"WARN: {text}")
    flown_s, whole_s = world.time_s - world.start_s, world.ends_s - world.start_s
    wait.at("flying the scenario, seconds", int(flown_s), int(whole_s))


def _tell_unheard(world: World) -> None:
    for kind, count in sorted(world.unheard.items()):
        click.echo(f"note: {count} x {kind} changes nothing in the simulator", err=True)


def _write(world: World, output: Path | None, wait: Waiting) -> None:
    """Run a world to its end; its messages are written to a file, which appears only when complete."""
    from cratous.bridge import sentinel
    from cratous.core.files.whole_file import cannot_write, replacing
    from cratous.services.simulator.server import frame_payload

    if output is None:
        while not world.over:
            world.tick()
            _tell(world, wait)
        return
    with replacing(output) as part:
        try:
            with part.open("wb") as file:
                while not world.over:
                    for body in world.tick():
                        file.write(sentinel.frame(frame_payload(body)))
                    _tell(world, wait)
        except OSError as error:
            raise cannot_write(output, error) from error


def _serve(make: Callable[[], World], plan: Scenario, listen: str, how: Mapping[str, Any]) -> int:
    from cratous.bridge.port import address
    from cratous.services.simulator.server import Server

    def report(severity: str, text: str) -> None:
        if severity != "DEBUG":
            click.echo(f"{severity}: {text}", err=True)

    where = address(f"tcp://{listen}", ("tcp",), item="--listen", free=True)
    server = Server(make, where, report, **how)

    def stop(*_: object) -> None:
        server.stopping = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    known = {event.body.ID for event in plan.events if _configures(event.body)}
    for key in sorted(how["vehicles"].keys() - known):
        there = ", ".join(map(str, sorted(known)[:20])) or "none"
        text = f"note: --vehicle {key}: the scenario has no such vehicle (it has {there})"
        click.echo(f"{text}; its port is silent unless a client adds it", err=True)
    host, port = server.port.bound
    click.echo(f"{plan.name}: listening on {host}:{port}")
    for key, its_own in server.vehicle_ports.items():
        host, port = its_own.bound
        click.echo(f"vehicle {key}: listening on {host}:{port}")
    server.run()
    _tell_unheard(server.world)
    click.echo(f"{plan.name}: ended at {server.world.time_s:.0f} s")
    return 0
