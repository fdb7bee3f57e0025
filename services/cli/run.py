"""`cratous run`: runs one mission; many variants of it are a campaign."""

from __future__ import annotations

import gc
import json
import shlex
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.campaign import seed_range
from cratous.services.cli.job import InProcesses, Settings, folder_name, run_mission
from cratous.services.cli.job import silent as untold
from cratous.services.cli.numbers import Number
from cratous.services.cli.progress import waiting
from cratous.services.cli.show import requirement_table, say, shown_path
from cratous.services.cli.user_requirements import own_data, own_files, own_lines, own_option

if TYPE_CHECKING:
    from cratous.spec.mission import Mission

Tell = Callable[[str], None]
COLLECTED_AT = 1_000_000
"""Number of objects made and kept in a flight at which garbage is looked for."""


@click.command()
@click.argument("mission", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the results. [out]")
@click.option("--seed", type=click.IntRange(0), default=0, help="Variant; 0 is as written.")
@click.option(
    "--seeds", callback=seed_range, metavar="A-B", help="All these variants, as `cratous campaign`."
)
@click.option("--no-daa", is_flag=True, help="Switch avoidance off; the requirements stay.")
@click.option("--allow-unproved", is_flag=True, help="Fly kernels without proof (recorded).")
@click.option(
    "--processes", is_flag=True,
    help="Fly with simulator, UxAS and each ICAROUS in processes of their own, in real time.",
)  # fmt: skip
@click.option(
    "--rate", type=Number(0.1, 100), metavar="X",
    help="Times real time, with --processes. [1]",
)  # fmt: skip
@click.option(
    "--original-clients", is_flag=True,
    help="With --processes: wait for the original's clients, which you start, in place of `cratous icarous`.",
)  # fmt: skip
@click.option(
    "--simulator", metavar="amase://HOST:PORT",
    help="As --processes, with an OpenAMASE that runs there in place of `cratous sim`, at its rate.",
)  # fmt: skip
@click.option(
    "--direct", metavar="GROUP:PORT",
    help="With --processes: ICAROUS tell each other their states too, by UDP multicast on this machine. [not]",
)  # fmt: skip
@own_option("Also hold the log of the flight against requirements of your own.")
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
    **how: Any,
) -> int:
    """Plan, prove, fly, monitor and certify a MISSION.

    MISSION is a mission file (YAML), a UxAS folder or configuration, or an AMASE scenario. The results,
    report.html first of all, are written to out/<mission>/ when everything is done; former results
    there are replaced, other files stay.

    With --processes a mission file is flown by processes that `ps` shows, over sockets of loopback and
    against the clock: `cratous sim`, `cratous uxas` and a `cratous icarous` for each protected vehicle.

    With --simulator the aircraft are put into an OpenAMASE that runs, whatever scenario it has loaded that has no
    other aircraft, and it is met again when it is lost.

    With --requirements (again for each file), the log is then held against requirements of your own, as
    `cratous monitor --requirements` does. They stand in the report, with the text of their files, margins and
    who was in command where one is violated; the exit code is that of all.

    Example:  cratous run examples/crossing/mission.yaml

    Exit codes: 0 all requirements hold, 1 something is violated or no plan exists, 2 bad input,
    3 something is unknown or excused.
    """
    command = ["cratous", "run", shown_path(mission)]
    command += ["--no-daa"] * no_daa + ["--allow-unproved"] * allow_unproved
    daa, quiet, rate = not no_daa, bool(how["quiet"]), how["rate"]
    own = own_files(how["requirements"])
    for file in own:
        command += ["--requirements", file.name]
    if how["simulator"] is not None and rate is not None:
        raise click.UsageError("--rate is not of --simulator: AMASE's clock runs at its own rate")
    how["processes"] = how["processes"] or how["simulator"] is not None
    if rate is not None and not how["processes"]:
        raise click.UsageError("--rate is of --processes")
    if how["original_clients"] and not how["processes"]:
        raise click.UsageError("--original-clients is of --processes")
    if how["direct"] is not None and not how["processes"]:
        raise click.UsageError("--direct is of --processes")
    if how["direct"] is not None and how["original_clients"]:
        raise click.UsageError("--direct is not of --original-clients, which have no such link")
    if how["processes"]:
        if seed or seeds is not None:
            raise click.UsageError(
                "--processes flies a mission as it is written: no --seed, no --seeds"
            )
        command += (
            ["--processes"] if how["simulator"] is None else ["--simulator", how["simulator"]]
        )
        command += ["--rate", f"{rate:g}"] if rate is not None else []
        command += ["--original-clients"] * how["original_clients"]
        command += ["--direct", how["direct"]] if how["direct"] is not None else []
        settings = Settings(daa, allow_unproved, shlex.join(command), own)
        processes = InProcesses(
            rate or 1.0, how["original_clients"], _amase(how["simulator"]), _group(how["direct"])
        )
        return fly_and_show(mission, seed, out, settings, as_json, quiet, processes)
    if seeds is not None:
        if seed:
            raise click.UsageError("--seed and --seeds exclude each other")
        return _many(mission, seeds, out, Settings(daa, allow_unproved, own=own), as_json, quiet)
    command += ["--seed", str(seed)] if seed else []
    settings = Settings(daa, allow_unproved, shlex.join(command), own)
    return fly_and_show(mission, seed, out, settings, as_json, quiet)


def _amase(text: str | None) -> Any:
    """The address of an AMASE; None without one."""
    if text is None:
        return None
    from cratous.services.processes.amase import amase_address

    return amase_address(text)


def _group(text: str | None) -> Any:
    """The address of a group; None without one."""
    if text is None:
        return None
    from cratous.bridge.port import address

    return address(f"udp://{text}", ("udp",), item="--direct")


def fly_and_show(
    mission: Path,
    seed: int,
    out: Path | None,
    settings: Settings,
    as_json: bool,
    quiet: bool,
    processes: InProcesses | None = None,
) -> int:
    """Run one mission and print the outcome; returns the exit code. processes: how to fly in
    processes; None: in this process, in virtual time.
    """
    silent = quiet or as_json
    report, folder = run_one(mission, seed, out or Path("out"), settings, silent, processes)
    if as_json:
        click.echo(json.dumps(summary(report, folder), indent=1))
    else:
        _show(report, folder)
    return int(report["exit_code"])


def run_one(
    path: Path,
    seed: int,
    out: Path,
    settings: Settings,
    silent: bool,
    processes: InProcesses | None = None,
) -> tuple[dict[str, Any], Path]:
    """Load, run and store one mission; returns the report and its folder.

    silent: whether no progress is shown; processes: as in `fly_and_show`.
    """
    from cratous.services.loading import load

    with waiting("loading the mission", silent):
        loaded = load(path, seed)
    target = out / folder_name(loaded)
    if processes is not None:
        return _run_in_processes(loaded, path, target, settings, silent, processes), target

    from cratous.services.startup import gate_process

    with (
        gate_process.begun(allow_unproved=settings.allow_unproved) as gate,
        _stored(loaded, target, "holding the code against its proofs", silent) as (folder, tell),
        _rarely_collected(),
    ):
        report = run_mission(loaded, folder, settings, tell, gate=gate)
    return report, target


def _run_in_processes(
    loaded: Mission,
    path: Path,
    target: Path,
    settings: Settings,
    silent: bool,
    processes: InProcesses,
) -> dict[str, Any]:
    from cratous.services.cli.processes_job import run_in_processes

    with _stored(loaded, target, "starting the processes", silent) as (folder, tell):
        return run_in_processes(loaded, path, folder, settings, processes, tell)


@contextmanager
def _stored(loaded: Mission, target: Path, what: str, silent: bool) -> Iterator[tuple[Path, Tell]]:
    """A folder whose contents are stored as `target` at the end, and what tells the progress; what: its beginning."""
    from cratous.services.cli.relation_places import RelationPlaces
    from cratous.services.results.folder import results_folder
    from cratous.services.startup import ahead

    places = RelationPlaces(loaded)
    with waiting(what, silent) as wait, places.in_reasons():
        tell = untold if silent else wait.tell
        ahead.begin([loaded])
        with results_folder(target, tell) as folder:
            yield folder, lambda text: tell(places.told(text))


@contextmanager
def _rarely_collected() -> Iterator[None]:
    """Context in which garbage is collected rarely: a flight leaves hardly any, and nobody waits for its next step."""
    before = gc.get_threshold()
    gc.set_threshold(COLLECTED_AT, 10, 10)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def summary(report: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """The machine-readable summary of one run."""
    return {
        "mission": report["mission"]["name"],
        "seed": report["mission"]["seed"],
        "verdict": report["verdict"],
        "exit_code": report["exit_code"],
        "requirements": report["requirements"],
        **({"own": own_data(report)} if "own" in report else {}),
        "takeovers": len(report["flight"]["takeovers"]),
        "outcome": report["flight"]["outcome"],
        "digest": report["log"]["digest"],
        "mission_hash": report["mission_hash"],
        "folder": None if folder is None else str(folder),
    }


def _show(report: dict[str, Any], folder: Path) -> None:
    from cratous.services.assumptions.observation_texts import GROUNDLESS, sentence
    from cratous.services.certify.blame_texts import lines
    from cratous.services.certify.verdicts import without_ground

    flight = report["flight"]
    requirement_table(report["requirements"])
    for line in own_lines(report):
        say(line)
    for served in flight["served"]:
        note = f" ({served['note']})" if served["note"] else ""
        who = f"vehicle {served['vehicle']}" if served["vehicle"] else "no vehicle"
        say(
            f"p{served['task']}: {served['phase'].lower()} by {who} "
            f"at {served['time_ms'] / 1000:.1f} s, {100 * served['served']:.1f} % served{note}"
        )
    for change in flight["changes"]:
        what = f"{change['what']}: {change['consequence']}"
        say(f"change at {change['time_ms'] / 1000:.1f} s: {what}")
    for line in lines([one for one in report["blame"] if one["verdict"] != "unknown"]):
        say(line)
    for row in report["assumptions"]:
        if row["state"] == "broken":
            say(f"assumption {row['name']}: {sentence(row)}")
    if without_ground(report["command"], report["assumptions"]):
        say(GROUNDLESS)
    count = len(flight["takeovers"])
    say(
        f"{report['verdict'].upper()}: {flight['outcome']}, {flight['end_ms'] / 1000:.1f} s of "
        f"flight, {count} takeover{'' if count == 1 else 's'}; exit code {report['exit_code']}"
    )
    say(f"log digest {report['log']['digest']}")
    say(f"report: {folder / 'report.html'}")


def _many(
    mission: Path,
    seeds: range,
    out: Path | None,
    settings: Settings,
    as_json: bool,
    quiet: bool,
) -> int:
    """Run all variants as a campaign with one worker, stored only if --out was given."""
    from cratous.services.campaign.definition import load_campaign
    from cratous.services.cli.campaign import conducted, option_of, show, table_of_runs

    campaign = load_campaign(mission, seeds, (option_of(settings.daa),), settings.own)
    how = {"workers": 1, "scheduler": None, "allow_unproved": settings.allow_unproved}
    silent = quiet or as_json
    with waiting("variants", silent) as wait, TemporaryDirectory(prefix="cratous-") as scratch:
        tell = untold if silent else wait.tell
        place = out or Path(scratch) / "campaign"
        found, lost = conducted(campaign, place, how, 10 if out else 0, tell)
    if as_json:
        click.echo(json.dumps(found, indent=1, sort_keys=True))
    else:
        table_of_runs(found)
        show(found, lost)
    return int(found["exit_code"])
