"""`cratous demo`: flies an example included in the product."""

from __future__ import annotations

import json
from pathlib import Path

import click

from cratous.services.cli.job import Settings
from cratous.services.cli.run import fly_and_show
from cratous.spec.errors import BadInput

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
"""The examples, beside `services` in a checkout and in an installed package."""


def missions() -> dict[str, Path]:
    """The example missions, by name."""
    return {file.parent.name: file for file in sorted(EXAMPLES.glob("*/mission.yaml"))}


@click.command()
@click.argument("name", default="crossing")
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the results. [out]")
@click.option("--allow-unproved", is_flag=True, help="Fly kernels without proof (recorded).")
@click.option("--list", "listed", is_flag=True, help="Only list the examples, with their files.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option("--quiet", is_flag=True, help="No progress, only the result.")
def demo(
    name: str, out: Path | None, allow_unproved: bool, listed: bool, as_json: bool, quiet: bool
) -> int:
    """Fly an example that ships with the product: crossing, or the one called NAME.

    It is run as `cratous run` runs a mission file; the results are written to out/NAME/ below the
    present folder. The file may be copied and changed: --list says where it is.

    Example:  cratous demo

    Exit codes: as those of `cratous run`.
    """
    known = missions()
    if listed:
        shown = {one: str(file) for one, file in known.items()}
        click.echo(
            json.dumps(shown, indent=1)
            if as_json
            else "\n".join(f"{n}  {f}" for n, f in shown.items())
        )
        return 0
    if name not in known:
        raise BadInput("there is no such example", item="NAME", expected=", ".join(known), got=name)
    command = f"cratous demo {name}" + " --allow-unproved" * allow_unproved
    settings = Settings(allow_unproved=allow_unproved, command=command)
    return fly_and_show(known[name], 0, out, settings, as_json, quiet)
