"""`cratous icarous`: the ICAROUS of one vehicle as a stand-alone program, at its end of the bridge."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.numbers import Number
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.bridge.port import Address, Report
    from cratous.bridge.text_protocol.dialects import Dialect
    from cratous.services.icarous_program.program import Besides
    from cratous.services.icarous_program.step import Craft


@click.command()
@click.option("--vehicle", type=click.IntRange(1), required=True, help="Whose ICAROUS: its id.")
@click.option(
    "--mission", type=click.Path(path_type=Path), required=True,
    help="Where airframe, well clear volume and frame stand: a mission file or UxAS folder.",
)  # fmt: skip
@click.option(
    "--mission-hash", "digest", metavar="HEX",
    help="Refuse a mission whose hash is another one (`mission_hash` of a report).",
)  # fmt: skip
@click.option("--connect", metavar="HOST:PORT", help="Where UxAS listens.")
@click.option("--listen", metavar="HOST:PORT", help="Where to wait for UxAS, which connects.")
@click.option("--plain", is_flag=True, help="Our lines without keys: nothing is authenticated.")
@click.option(
    "--original", is_flag=True, help="UxAS's end is the original's: no HELLO, HBEAT and epochs."
)
@click.option(
    "--thesis", is_flag=True, help="UxAS's end speaks the thesis's dialect: five letters, no comma."
)
@click.option(
    "--v2", is_flag=True, help="v2, which authenticates both ends, see --keys. [the default]"
)
@click.option(
    "--keys", type=click.Path(path_type=Path), metavar="FOLDER",
    help="Folder with vehicle_ID.key, for v2. [environment: CRATOUS_BRIDGE_KEY_ID]",
)  # fmt: skip
@click.option(
    "--plain-beyond-loopback", is_flag=True, help="Another dialect than v2 to other machines too."
)
@click.option(
    "--direct", metavar="GROUP:PORT",
    help="Tell the other vehicles the own state, and hear theirs, by UDP multicast on this machine. [not]",
)  # fmt: skip
@click.option(
    "--autopilot", metavar="HOST:PORT",
    help="The vehicle's autopilot, to go on with when UxAS does not tell it any more. [none]",
)  # fmt: skip
@click.option("--once", is_flag=True, help="End when the connection ends; else connect again.")
@click.option(
    "--wait", type=Number(0), default=60.0, show_default=True,
    help="Seconds to wait for UxAS, at the start and when it is gone.",
)  # fmt: skip
@click.option(
    "--log", "folder", type=click.Path(path_type=Path), help="Folder of the log. [log/icarous_ID]"
)
@click.option(
    "--epochs", type=click.Path(path_type=Path), metavar="FILE",
    help="Keeps the epoch of this flight over a restart; without it, it is heard from UxAS.",
)  # fmt: skip
@click.option("--allow-unproved", is_flag=True, help="Fly with kernels that have no proof.")
def icarous(
    vehicle: int,
    mission: Path,
    digest: str | None,
    once: bool,
    wait: float,
    folder: Path | None,
    epochs: Path | None,
    allow_unproved: bool,
    **link: Any,
) -> int:
    """Avoid traffic and zones for one vehicle, over the CRATOUS bridge.

    The other end is the service IcarousCommunicationService of a UxAS configuration. Own state, traffic,
    plan and zones come over the wire and are believed; steering goes back over it. Both ends prove that they
    have the vehicle's key, and seal each line by it, unless a dialect without keys is asked for; of those the secret
    of the handshake is CRATOUS_BRIDGE_SECRET of the environment, if that is set. Either it connects to UxAS
    (--connect), or it waits for a UxAS whose service names its address in Connect (--listen).

    With --direct an aircraft of which UxAS has not told for 2 s is avoided by what it says of itself; that needs direct
    keys, vehicle_ID.direct of --keys or CRATOUS_DIRECT_KEY_ID of the environment, of all vehicles with an instance. With
    --autopilot it avoids, and steers, without UxAS too.

    Example:  cratous icarous --vehicle 1 --mission mission.yaml --connect 127.0.0.1:5557 --keys keys

    Exit codes: 0 it was asked to end (SIGTERM, Ctrl-C), 2 bad input, 3 UxAS was not reached, or is gone.
    """
    from cratous.bridge.port import address
    from cratous.bridge.text_port import TextPort
    from cratous.bridge.text_protocol.dialects import Dialect
    from cratous.bridge.text_protocol.handshake import secret_of_environment
    from cratous.bridge.text_protocol.keys import keys_of
    from cratous.core.ledger import require
    from cratous.services.icarous_program.epochs import EpochFile
    from cratous.services.icarous_program.program import Patience, Program
    from cratous.services.icarous_program.step import IcarousEnd
    from cratous.services.uxas.logs import Logs

    given = [(name, link[name]) for name in ("connect", "listen") if link[name] is not None]
    if len(given) != 1:
        raise click.UsageError("one of --connect and --listen is needed")
    ((name, text),) = given
    listens = name == "listen"
    plain = [name for name in ("plain", "original", "thesis") if link[name]]
    if len(plain) + link["v2"] > 1:
        raise click.UsageError(
            "one of --plain, --original, --thesis and --v2, or none, which is --v2: each is a dialect"
        )
    dialect = Dialect.CRATOUS if plain in ([], ["plain"]) else Dialect(plain[0])
    if listens and dialect is Dialect.ORIGINAL:
        raise click.UsageError("the original's UxAS connects to nobody: --original needs --connect")
    where = address(f"tcp://{text}", ("tcp",), item=f"--{name}", free=listens)
    if link["keys"] and plain and link["direct"] is None:
        raise click.UsageError(f"--keys is of --v2, and --{plain[0]} has none")
    if plain and not (where.loopback or link["plain_beyond_loopback"]):
        raise BadInput(
            "no authentication",
            item=f"--{name}",
            expected="--v2, an address of loopback, or --plain-beyond-loopback",
            got=text,
        )
    craft = craft_of(mission, vehicle, dialect, digest)
    other_ways = {
        name: address(f"{scheme}://{link[name]}", (scheme,), item=f"--{name}")
        for name, scheme in (("direct", "udp"), ("autopilot", "tcp"))
        if link[name] is not None
    }
    log = Logs(
        "WARN",
        "DEBUG",
        folder or Path("log") / f"icarous_{vehicle}",
        echo=lambda text: click.echo(text, err=True),
    )
    try:
        standing = require(allow_unproved=allow_unproved)
        log("WARN" if standing.problems else "INFO", f"proofs: {standing.line}")
        secret = secret_of_environment() if plain else keys_of((vehicle,), link["keys"])
        port = TextPort(
            where, server=False, listens=listens, dialect=dialect, secret=secret, report=log
        )
        kept = None if epochs is None else EpochFile(epochs, vehicle)
        besides = besides_of(craft, link["keys"], other_ways, log)
        program = Program(
            IcarousEnd(craft), port, log, Patience(wait, once), epochs=kept, besides=besides
        )

        def stop(*_: object) -> None:
            program.stopping = True

        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, stop)
        if listens:
            at = ":".join(map(str, port.bound))
            log("INFO", f"ICAROUS of vehicle {vehicle}, listens at {at}")
            if where.everywhere:
                log("WARN", "listens on all interfaces; whoever is there may connect")
        else:
            log("INFO", f"ICAROUS of vehicle {vehicle}, connecting to {text}")
        program.run()
    finally:
        log.close()
    return 0


def besides_of(craft: Craft, folder: Path | None, ways: dict[str, Address], log: Report) -> Besides:
    """The links in addition to UxAS; BadInput if a direct key is missing, or a vehicle has none to send with."""
    from cratous.bridge.text_protocol.keys import direct_keys_of
    from cratous.services.icarous_program.autopilot import Autopilot
    from cratous.services.icarous_program.direct import DirectLink
    from cratous.services.icarous_program.program import Besides

    vehicle, direct, autopilot = craft.config.vehicle_id, None, None
    if "direct" in ways:
        keys = direct_keys_of(sorted(craft.cooperating | {vehicle}), folder)
        direct = DirectLink(vehicle, keys, ways["direct"], log)
    if "autopilot" in ways:
        autopilot = Autopilot(vehicle, ways["autopilot"], craft.config.projection, log)
    return Besides(direct, autopilot)


def craft_of(path: Path, vehicle_id: int, dialect: Dialect, digest: str | None = None) -> Craft:
    """A vehicle of a mission as its ICAROUS needs it; BadInput if the mission has no such vehicle,
    or a digest other than `digest`.
    """
    from cratous.bridge.text_protocol.dialects import Dialect
    from cratous.services.certify.report import mission_hash
    from cratous.services.flight.dynamics import limits_of
    from cratous.services.icarous.state import Config
    from cratous.services.icarous_communication.unheard import CHOICES
    from cratous.services.icarous_program.step import Craft
    from cratous.services.loading import load
    from cratous.services.mission.frames import Projection
    from cratous.services.mission.ground import floor_of
    from cratous.services.mission.landing import on_failure_of
    from cratous.services.mission.merging import merging_of
    from cratous.services.mission.take_off import grounded

    mission = load(path)
    if digest is not None and mission_hash(mission) != digest:
        raise BadInput(
            "another mission",
            where=str(path),
            item="--mission-hash",
            expected=digest[:80],
            got=mission_hash(mission),
        )
    if mission.link_loss is not None and mission.link_loss.choice.value not in CHOICES:
        raise BadInput(
            "without the link UxAS's end of the bridge flies no landing",
            where=str(path),
            item="link_loss.choice",
            expected=f"{' or '.join(CHOICES)}, or cratous run without --processes",
            got=mission.link_loss.choice.value,
        )
    if (after := on_failure_of(mission)) is not None:
        raise BadInput(
            "the mission says what is flown after a failure, which a program of its own does not fly",
            where=str(path),
            item="on_failure",
            expected="no on_failure, or cratous run without --processes",
            got=after.choice.value,
        )
    if (merging := merging_of(mission)) is not None:
        raise BadInput(
            "vehicles merge at a fix, about which a program of its own does not talk",
            where=str(path),
            item="merging",
            expected="no merging, or cratous run without --processes",
            got=merging.name,
        )
    if grounded(mission):
        raise BadInput(
            "a vehicle starts on the ground, which a program of its own does not take off",
            where=str(path),
            item="vehicles.start",
            expected="vehicles that start in the air, or cratous run without --processes",
            got=", ".join(str(one.id) for one in grounded(mission)),
        )
    found = [v for v in mission.vehicles if v.id == vehicle_id]
    if not found:
        raise BadInput(
            "the mission has no such vehicle",
            where=str(path),
            item="--vehicle",
            expected=" or ".join(str(v.id) for v in mission.vehicles),
            got=str(vehicle_id),
        )
    projection, beat_ms = Projection(mission.frame), mission.simulation.heartbeat_ms
    running = dialect is Dialect.ORIGINAL
    config = Config(vehicle_id, mission.daa, projection, beat_ms, running)
    return Craft(
        config,
        limits_of(found[0]),
        floor_of(mission),
        frozenset(mission.instances),
        dialect,
        mission.simulation.step_ms / 1000,
    )
