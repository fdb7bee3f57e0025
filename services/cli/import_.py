"""`cratous import`: makes a mission file from other tools' files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cratous.services.cli.numbers import Number
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput


def _origin(_context: Any, _option: Any, text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    from cratous.services.importing.imported_content import latitude, longitude

    lat, comma, lon = text.partition(",")
    if not comma:
        raise click.BadParameter("two numbers of degrees: LATITUDE,LONGITUDE")
    return latitude(lat, "--origin"), longitude(lon, "--origin")


@click.command("import")
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), help="The mission file; else printed."
)
@click.option("--name", help="Of the mission. [the folder's or the first file's]")
@click.option(
    "--speed", type=Number(0.01, 350), metavar="M_S", help="Of flight plans that say none."
)
@click.option(
    "--altitude", type=Number(-500, 30000), metavar="M", help="MSL, of ways on maps that say none."
)
@click.option(
    "--terrain",
    type=Number(-500, 9000),
    default=0.0,
    metavar="M",
    help="Height MSL of the ground at home, to which altitudes above it are added. [0]",
)
@click.option(
    "--origin",
    callback=_origin,
    metavar="LAT,LON",
    help="Of tables in metres (.eutl, .daa).",
)
@click.option(
    "--areas",
    type=click.Choice(["keep_in", "keep_out"]),
    help="What areas on maps are that do not say it.",
)
def import_(files: tuple[Path, ...], out: Path | None, **said: Any) -> int:
    """Make a mission of FILES (or of the files in a folder), recognised by what is in them: flight plans (QGC WPL 110,
    .eutl, the ownship of a .daa), geofences (XML, YAML), zones and ways (GeoJSON, KML), traffic (YAML), a
    parameter file of ICAROUS.

    Example:  cratous import examples/icarous-files -o mission.yaml && cratous run mission.yaml

    Each plan is a vehicle that starts at the plan's first waypoint, home, and flies through the others in their
    order. What is not taken over is told on stderr, and stands on top of the file.

    Exit codes: 0 written, 2 bad input: nothing is written.
    """
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.cli.progress import waiting
    from cratous.services.importing.composing import Asked, composed
    from cratous.services.importing.gathering import gathered
    from cratous.services.importing.imported_content import Reading
    from cratous.services.importing.mission_text import checked, mission_text
    from cratous.services.loading.uxas_parts import safe_name

    with waiting("reading the files"):
        parts = gathered(files, Reading(said["areas"] or "", said["altitude"], said["origin"]))
    first = files[0].absolute()
    name = said["name"] or safe_name(first.name if first.is_dir() else first.stem)
    made = composed(parts, Asked(name[:64], said["speed"], said["terrain"]))
    text = mission_text(made, [file.name for file in files])
    notes = checked(text, str(out or "the mission"))
    if out is None:
        click.echo(text, nl=False)
    elif out.is_dir():
        raise BadInput("a folder", where=str(out), expected="a file, such as mission.yaml")
    else:
        write_atomically(out, text, "the mission")
    for note in (*made.notes, *notes):
        say(f"note: {note}", err=True)
    return 0
