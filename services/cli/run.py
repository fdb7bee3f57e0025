"""`cratous run`: the main job, for one mission or for many seeded variants of it."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import click

from cratous.services.cli.job import Settings, folder_name, run_mission
from cratous.services.cli.job import silent as untold
from cratous.services.cli.progress import waiting
from cratous.services.cli.show import requirement_table, say, table
from cratous.spec.errors import CratousError, NoPlan
from cratous.spec.mission.guarantees import Outcome, exit_code

Tell = Callable[[str], None]


def seed_range(_ctx: Any, _param: Any, value: str | None) -> range | None:
    """`1-50` as a range, both ends included."""
    if value is None:
        return None
    match = re.fullmatch(r"(\d{1,9})-(\d{1,9})", value)
    if not match or int(match[1]) > int(match[2]) or int(match[2]) - int(match[1]) >= 10_000:
        raise click.BadParameter(f"expected A-B with A <= B, for example 1-50; got {value!r}")
    return range(int(match[1]), int(match[2]) + 1)


@click.command()
@click.argument("mission", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the results. [out]")
@click.option("--seed", type=click.IntRange(0), default=0, help="Variant; 0 is as written.")
@click.option("--seeds", callback=seed_range, metavar="A-B", help="Run all these variants.")
@click.option("--no-daa", is_flag=True, help="Switch avoidance off; the requirements stay.")
@click.option("--allow-unproved", is_flag=True, help="Fly kernels without proof (recorded).")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option("--quiet", is_flag=True, help="No progress, only the result.")
def run(
    mission: Path,
    out: Path | None,
    seed: int,
    seeds: range | None,
    no_daa: bool,
    allow_unproved: bool,
    as_json: bool,
    quiet: bool,
) -> int:
    """Plan, prove, fly, monitor and certify a MISSION.

    MISSION is a mission file (YAML), or a UxAS folder or configuration as it is. The results,
    report.html first of all, are written to out/<mission>/ when everything is done; former results
    there are replaced, other files stay.

    Example:  cratous run examples/crossing/mission.yaml

    Exit codes: 0 all requirements hold, 1 something is violated or no plan exists, 2 bad input,
    3 something is unknown or excused.
    """
    command = ["cratous", "run", shown_path(mission)]
    command += ["--no-daa"] * no_daa + ["--allow-unproved"] * allow_unproved
    daa = not no_daa
    if seeds is not None:
        if seed:
            raise click.UsageError("--seed and --seeds exclude each other")
        return _many(mission, seeds, out, daa, allow_unproved, command, as_json, quiet)
    command += ["--seed", str(seed)] if seed else []
    settings = Settings(daa, allow_unproved, shlex.join(command))
    silent = quiet or as_json
    with waiting("loading the mission", silent) as wait:
        tell = untold if silent else wait.tell
        report, folder = run_one(mission, seed, out or Path("out"), settings, tell)
    if as_json:
        click.echo(json.dumps(summary(report, folder), indent=1))
    else:
        _show(report, folder)
    return int(report["exit_code"])


def shown_path(path: Path) -> str:
    """A path as it goes into a report: never a folder of one machine."""
    return path.name if path.is_absolute() else path.as_posix()


def run_one(
    path: Path, seed: int, out: Path, settings: Settings, tell: Tell
) -> tuple[dict[str, Any], Path]:
    """Load, run and keep one mission; returns the report and its folder."""
    from cratous.services.loading import load
    from cratous.services.results.folder import results_folder

    loaded = load(path, seed)
    target = out / folder_name(loaded)
    with results_folder(target, tell) as folder:
        report = run_mission(loaded, folder, settings, tell)
    return report, target


def summary(report: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """What a machine wants to know of one run."""
    return {
        "mission": report["mission"]["name"],
        "seed": report["mission"]["seed"],
        "verdict": report["verdict"],
        "exit_code": report["exit_code"],
        "requirements": report["requirements"],
        "takeovers": len(report["flight"]["takeovers"]),
        "outcome": report["flight"]["outcome"],
        "digest": report["log"]["digest"],
        "mission_hash": report["mission_hash"],
        "folder": None if folder is None else str(folder),
    }


def _show(report: dict[str, Any], folder: Path) -> None:
    flight = report["flight"]
    requirement_table(report["requirements"])
    for served in flight["served"]:
        note = f" ({served['note']})" if served["note"] else ""
        who = f"vehicle {served['vehicle']}" if served["vehicle"] else "no vehicle"
        say(
            f"p{served['task']}: {served['phase'].lower()} by {who} "
            f"at {served['time_ms'] / 1000:.1f} s, {100 * served['served']:.1f} % served{note}"
        )
    count = len(flight["takeovers"])
    say(
        f"{report['verdict'].upper()}: {flight['outcome']}, {flight['end_ms'] / 1000:.1f} s of "
        f"flight, {count} takeover{'' if count == 1 else 's'}; exit code {report['exit_code']}"
    )
    say(f"log digest {report['log']['digest']}")
    say(f"report: {folder / 'report.html'}")


def _many(
    path: Path,
    seeds: range,
    out: Path | None,
    daa: bool,
    allow_unproved: bool,
    command: list[str],
    as_json: bool,
    quiet: bool,
) -> int:
    """Run all variants; folders are kept only if --out was given."""
    found: list[dict[str, Any]] = []
    silent = quiet or as_json
    with (
        waiting("variants", silent) as wait,
        TemporaryDirectory(prefix="cratous-") as scratch,
    ):
        tell = untold if silent else wait.tell
        for seed in wait.each(seeds, "variants"):
            settings = Settings(daa, allow_unproved, shlex.join([*command, "--seed", str(seed)]))
            keep = out or Path(scratch)
            row = _variant(path, seed, keep, settings)
            found.append(row)
            tell(f"seed {seed}: {row['verdict']}, {row['takeovers']} takeovers")
    outcomes = [Outcome(row["verdict"]) for row in found]
    code = exit_code(outcomes)
    if as_json:
        click.echo(json.dumps({"exit_code": code, "variants": found}, indent=1))
        return code
    table(
        ["seed", "geometry", "takeovers", "least separation", "verdict", "named"],
        [
            [
                str(row["seed"]),
                row["geometry"],
                str(row["takeovers"]),
                row["separation"],
                row["verdict"],
                row["named"],
            ]
            for row in found
        ],
        verdict_column=4,
    )
    counts = ", ".join(f"{outcomes.count(kind)} {kind}" for kind in Outcome if outcomes.count(kind))
    click.echo(f"{len(found)} variants: {counts}; exit code {code}")
    return code


def _variant(path: Path, seed: int, out: Path, settings: Settings) -> dict[str, Any]:
    """One row of the table; a variant without a plan is a row too, bad input is an error."""
    from cratous.services.loading import load

    geometry = geometry_text(load(path, seed))
    try:
        report, _ = run_one(path, seed, out, settings, lambda _text: None)
    except NoPlan as error:
        return {
            "seed": seed,
            "geometry": geometry,
            "takeovers": 0,
            "separation": "-",
            "verdict": str(Outcome.VIOLATED),
            "named": str(error),
            "digest": "",
        }
    except CratousError as error:
        error.add_note(f"(seed {seed})")
        raise
    return {
        "seed": seed,
        "geometry": geometry,
        "takeovers": len(report["flight"]["takeovers"]),
        "separation": separation_text(report),
        "verdict": report["verdict"],
        "named": named_text(report),
        "digest": report["log"]["digest"],
    }


def named_text(report: dict[str, Any]) -> str:
    """The requirements that do not hold, the violated ones first."""
    parts = []
    for outcome in (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.EXCUSED):
        ids = [r["requirement"] for r in report["requirements"] if r["verdict"] == outcome]
        if ids:
            parts.append(f"{outcome}: {', '.join(ids)}")
    if report["proofs"]["problems"]:
        parts.append("kernels without proof")
    return "; ".join(parts)


def geometry_text(mission: Any) -> str:
    """Courses and speeds of the first two vehicles."""
    from math import degrees

    return ", ".join(
        f"{degrees(v.heading_rad) % 360:.0f}° {v.speed_m_s:.1f} m/s" for v in mission.vehicles[:2]
    )


def separation_text(report: dict[str, Any]) -> str:
    """The least horizontal distance of a vehicle to another one or to traffic, once a second."""
    from cratous.services.certify.charts import separation_view

    view = separation_view(report)
    if view is None:
        return "-"
    return f"{view['curves'][0]['least_m']:.0f} m"
