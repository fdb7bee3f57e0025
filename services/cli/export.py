"""`cratous export`: writes a mission in other tools' formats."""

from __future__ import annotations

from pathlib import Path

import click

from cratous.services.cli.show import say
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import exit_code
from cratous.spec.mission.plan import Plan


@click.command()
@click.argument("mission", type=click.Path(path_type=Path))
@click.option(
    "--format",
    "form",
    type=click.Choice(["amase", "uxas", "geojson", "kml", "qgc", "geofence"]),
    required=True,
    help="What to write.",
)
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    help="File, or for uxas a new or empty folder; without it, the text is printed.",
)
@click.option(
    "--plan", "planned", is_flag=True, help="With the planned routes (geojson, kml, qgc)."
)
@click.option("--vehicle", type=click.IntRange(1), help="Of a flight plan (qgc): whose.")
@click.option("--request", type=click.IntRange(1), default=1, help="Of several requests the N-th.")
@click.option("--strict", is_flag=True, help="Write nothing if the format cannot say everything.")
@click.option("--allow-unproved", is_flag=True, help="Plan with kernels that have no proof.")
def export(
    mission: Path,
    form: str,
    out: Path | None,
    planned: bool,
    vehicle: int | None,
    request: int,
    strict: bool,
    allow_unproved: bool,
) -> int:
    """Write a MISSION as AMASE scenario, UxAS configuration with messages, GeoJSON or KML, or of it a vehicle's
    flight plan (qgc: QGC WPL 110) or the zones (geofence: XML), as ICAROUS reads them.

    What the format cannot say is listed on stderr, each field by name; with --strict that is bad
    input, and nothing is written. AMASE scenarios and UxAS folders are missions again, for `cratous
    check`, `plan`, `run` and `export`; `cratous import` reads the others. A flight plan without --plan has the points
    that the mission has the vehicle fly through in one order.

    Example:  cratous export examples/crossing/mission.yaml --format geojson --plan -o crossing.geojson

    Exit codes: 0 written, 2 bad input; with --plan as `cratous plan`: 1 the plan does not satisfy all its
    constraints or leaves tasks out (written, and told) or does not exist, 3 something is unknown.
    """
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.exporting.exported import ROUTED, UXAS, beside, exported
    from cratous.services.exporting.folder import write_folder
    from cratous.services.exporting.icarous import QGC
    from cratous.services.loading import load

    if form == UXAS and out is None:
        raise click.UsageError("--format uxas writes a folder: name it with -o")
    if planned and form not in ROUTED:
        raise click.UsageError(f"--plan goes with --format {' or '.join(ROUTED)}")
    if vehicle is not None and form != QGC:
        raise click.UsageError(f"--vehicle goes with --format {QGC}")
    loaded = load(mission, 0, request)
    plan, code = _planned(loaded, allow_unproved) if planned else (None, 0)
    folder = None if out is None else out.absolute().name
    made = exported(loaded, form, plan, folder, vehicle)
    unsaid = [*made.unsaid, *beside(mission, request)]
    if strict and unsaid:
        raise BadInput(
            f"the format {form} cannot say everything",
            where=str(mission),
            item=unsaid[0].partition(":")[0],
            expected="an export without --strict",
            got="; ".join(unsaid),
        )
    if form == UXAS and out is not None:
        write_folder(out, made.files)
    else:
        (text,) = made.files.values()
        if out is None:
            click.echo(text, nl=False)
        else:
            write_atomically(out, text, "the export")
    for one in unsaid:
        say(f"not said in {form}: {one}", err=True)
    return code


def _planned(mission: Mission, allow_unproved: bool) -> tuple[Plan, int]:
    """The plan, and the exit code of `cratous plan`; NoPlan if there is none."""
    from cratous.core import ledger
    from cratous.services.cli.job import new_bus, plan_and_check
    from cratous.services.cli.plan_lines import left_out_lines
    from cratous.services.cli.progress import waiting
    from cratous.services.monitor.moving_plan import check_in_time

    with waiting("holding the code against its proofs", False):
        standing = ledger.require(allow_unproved=allow_unproved)
    with waiting("planning", False):
        plan, checks = plan_and_check(mission, new_bus())
        checks += check_in_time(mission, plan)
    for check in checks:
        if exit_code([check.outcome]):
            say(
                f"plan: {check.item or check.requirement}: {check.outcome.value}; {check.note}",
                err=True,
            )
    for line in left_out_lines(plan):
        say(f"plan: {line}", err=True)
    if standing.problems:
        say(f"plan: {standing.line}", err=True)
    outcomes = [check.outcome for check in checks]
    return plan, exit_code(outcomes, unproved=bool(standing.problems))
