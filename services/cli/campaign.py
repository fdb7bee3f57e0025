"""`cratous campaign`: many runs, evaluated and counted, resumable."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import click

from cratous.services.cli.job import silent as untold
from cratous.services.cli.progress import passing, waiting
from cratous.services.cli.show import say, table
from cratous.services.cli.user_requirements import own_files, own_option
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.files.extras import told

Tell = Callable[[str], None]


def seed_range(_ctx: Any, _param: Any, value: str | None) -> range | None:
    """`1-50` as a range, both ends included."""
    import re

    if value is None:
        return None
    match = re.fullmatch(r"([1-9]\d{0,8})-([1-9]\d{0,8})", value)
    if not match or int(match[1]) > int(match[2]):
        raise click.BadParameter(f"expected A-B with 1 <= A <= B, for example 1-50; got {value!r}")
    return range(int(match[1]), int(match[2]) + 1)


class Wanted(NamedTuple):
    """What to produce: kept flights, or a search for a run that fails `find` (`worst`: of
    `searched_for`); and the printed form.
    """

    searched_for: str | None
    reports: int
    find: str | None
    budget: int
    as_json: bool
    parquet: bool
    quiet: bool


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("searched_for", metavar="", required=False)
@click.option("--seeds", callback=seed_range, metavar="A-B", help="Seeds, instead of the file's.")
@click.option("--workers", type=click.IntRange(1, 1024), default=1, help="Local processes. [1]")
@click.option("--scheduler", metavar="ADDRESS", help="A scheduler of dask.distributed to use.")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder. [out/campaigns/NAME]")
@click.option("--no-daa", is_flag=True, help="Of a mission: switch avoidance off.")
@click.option("--allow-unproved", is_flag=True, help="Fly kernels without proof (recorded).")
@click.option(
    "--reports", type=click.IntRange(0, 10), default=10, help="Worst flights to keep. [10]"
)
@own_option("Every run has to hold these requirements of your own too.")
@click.option(
    "--find",
    metavar="[worst] ID",
    help="Search for the worst run of G1 to G5 or one of these, one that fails it.",
)
@click.option(
    "--budget", type=click.IntRange(1, 100_000), default=200, help="Runs of a search. [200]"
)
@click.option("--json", "as_json", is_flag=True, help="Print campaign.json, or what was found.")
@click.option("--parquet", is_flag=True, help="Write runs.parquet beside runs.csv.")
@click.option("--quiet", is_flag=True, help="No progress, only the result.")
def campaign(
    file: Path, seeds: range | None, workers: int, scheduler: str | None, out: Path | None,
    no_daa: bool, allow_unproved: bool, requirements: tuple[Path, ...], **wanted: Any,
) -> int:  # fmt: skip
    """Fly and judge all runs of a campaign FILE, or all variants of a mission FILE.

    A run is named by a digest of all that decides it and stored once, so a campaign that was
    interrupted goes on, and a changed option flies only what it changes. campaign.json is the same
    whatever the workers, their order and what was lost on the way.

    With --requirements (again for each file) every run has to hold requirements of your own besides
    those that the campaign asks for; a campaign file names such files under `requirements`.

    \b
    Examples:  cratous campaign examples/campaigns/options.yaml --workers 2
               cratous campaign examples/crossing/mission.yaml --seeds 1-1000
               cratous campaign examples/campaigns/traffic.yaml --find worst G2

    Exit codes: 0 all runs hold, 1 something is violated, without a plan, a misfit, or judge and
    monitor disagree, 2 bad input, 3 something is unknown, excused, impossible or lost.
    """
    from cratous.services.campaign.definition import ALL, load_campaign

    searched_for, reports, find, budget, as_json, parquet, quiet = Wanted(**wanted)
    if searched_for is not None and find != "worst":
        raise click.UsageError(f"Got unexpected extra argument ({searched_for})")
    if searched_for is not None and Path(searched_for).suffix in (".yaml", ".yml"):
        file, searched_for = Path(searched_for), str(file)  # --find worst ID FILE
    find = searched_for or find
    if parquet and find is not None:
        raise click.UsageError("--parquet is of the runs of a campaign, not of --find")
    if parquet:
        with told():  # before anything is flown
            import pyarrow.parquet  # noqa: F401
    found = load_campaign(file, seeds, (option_of(not no_daa),), own_files(requirements))
    if find is not None and find not in {*ALL, *found.requirements}:
        asked = ", ".join(sorted({*ALL, *found.requirements}))
        raise BadInput("there is no such requirement", item="--find", expected=asked, got=find)
    place = out or Path("out") / "campaigns" / found.name
    how = {"workers": workers, "scheduler": scheduler, "allow_unproved": allow_unproved}
    silent = quiet or as_json
    with waiting("reading the campaign", silent) as wait:
        tell = untold if silent else wait.tell
        if find is not None:
            from cratous.services.cli.campaign_find import searched, show_found

            data = searched(found, place, how, find, budget, tell)
            show_found(data, place, as_json)
            return int(data["exit_code"])
        summary, lost = conducted(found, place, how, reports, tell)
        if parquet:
            _write_parquet(summary, place)
    if as_json:
        click.echo(json.dumps(summary, indent=1, sort_keys=True))
    else:
        show(summary, lost)
        say(f"summary: {place / 'campaign.html'}")
    return int(summary["exit_code"])


def option_of(daa: bool) -> Any:
    """The only option of a campaign made from a mission."""
    from cratous.services.campaign.definition import Option

    return Option(daa=daa) if daa else Option("without-daa", daa=False)


def conducted(
    campaign: Any, place: Path, how: dict[str, Any], reports: int, tell: Tell
) -> tuple[dict[str, Any], list[str]]:
    """Fly missing runs and write the summary into a folder; returns it and the reasons for lost attempts."""
    from cratous.core import ledger
    from cratous.services.campaign.campaign import Conduct, Course
    from cratous.services.campaign.engine import engine
    from cratous.services.campaign.identity import version_digest
    from cratous.services.campaign.store import Store
    from cratous.services.campaign.summary import build
    from cratous.services.cli.encounter_flight import function_of

    ledger.require(allow_unproved=how["allow_unproved"])  # before any process is started
    version = version_digest()
    with Store(place) as store:
        conduct = Conduct(
            campaign, store, function_of(campaign.kind), version, how["allow_unproved"]
        )
        seeds, missions = max(1, len(campaign.seeds)), max(1, len(campaign.missions))
        course = Course(seeds * missions * len(campaign.options))
        with engine(how["workers"], how["scheduler"]) as made:
            conduct.fly(made, course, passing(tell))
        tell(course.line())
        rows = list(conduct.rows())
        lost = [why for row in rows for why in store.lost(row.run.id)]
        summary = build(campaign, rows, version)
        _write(summary, place, _reports(conduct, rows, campaign, place, reports, tell))
    return summary, lost


def _reports(
    conduct: Any, rows: list[Any], campaign: Any, place: Path, count: int, tell: Tell
) -> dict[str, str]:
    """Fly the worst runs again and compare each with the stored result; keep its mission and, for
    whole flights, its report. Returns links to these by name.
    """
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.campaign import worker
    from cratous.services.campaign.definition import MISSIONS
    from cratous.services.campaign.engine import CHANGED, refuse_other_version
    from cratous.services.campaign.summary import worst
    from cratous.services.results.names import HTML_NAME
    from cratous.spec.errors import Refused

    links, whole = {}, campaign.kind == MISSIONS
    try:
        for row in worst(rows, campaign.requirements)[:count]:
            folder = place / "flights" / row.run.name
            link = f"flights/{row.run.name}/{HTML_NAME}"
            stored = row.result or {}
            if whole and _is_kept(folder, stored.get("log", ""), row.run.decides["own"]):
                links[row.run.name] = link
                continue
            tell(f"report of {row.run.name}")
            keep = {"keep": str(folder)} if whole else {}
            answer = worker.attempt(conduct.task(row.run, **keep))
            if "lost" in answer:
                tell(f"no report of {row.run.name}: {answer['lost']}")
                continue
            refuse_other_version(answer, CHANGED)
            if answer.get("result") != stored:
                raise Refused(
                    f"{row.run.name} flown again gives another result: {_other(answer, stored)}; "
                    "the stored results of this version are not to be trusted"
                )
            links[row.run.name] = link if whole else f"flights/{row.run.name}.yaml"
            folder.parent.mkdir(parents=True, exist_ok=True)
            mission = folder.parent / f"{row.run.name}.yaml"
            write_atomically(mission, row.run.decides["mission"])
    finally:
        worker.end()
    return links


def _other(answer: dict[str, Any], stored: dict[str, Any]) -> str:
    got = answer.get("result") or {}
    return ", ".join(sorted(key for key in stored if got.get(key) != stored[key]))


def _is_kept(folder: Path, digest: str, own: list[Any]) -> bool:
    """Whether a flight's report exists already, evaluated with these user requirement files."""
    from cratous.services.certify.report_input import read_report

    try:
        report = read_report(folder)
        found, files = report["log"]["digest"], report.get("own", {"files": []})["files"]
    except (CratousError, LookupError, TypeError):
        return False
    return bool(found == digest and files == own)


def _maps(place: Path, links: dict[str, str]) -> dict[str, bytes]:
    """The maps of the flights with kept reports."""
    from cratous.services.results.names import MAP_NAME

    found = {}
    for name, link in links.items():
        file = (place / link).with_name(MAP_NAME)
        if file.is_file():
            found[name] = file.read_bytes()
    return found


def _write(summary: dict[str, Any], place: Path, links: dict[str, str]) -> None:
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.campaign.pages import page
    from cratous.services.campaign.summary import text_of
    from cratous.services.campaign.tables import csv_text, junit_text

    texts = {
        "campaign.html": page(summary, links, _maps(place, links)), "runs.csv": csv_text(summary),
        "junit.xml": junit_text(summary), "campaign.json": text_of(summary),
    }  # fmt: skip
    for name, text in texts.items():
        write_atomically(place / name, text, "the summary")
    # an old table describes former runs; it is written again on request
    (place / "runs.parquet").unlink(missing_ok=True)


def _write_parquet(summary: dict[str, Any], place: Path) -> None:
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.campaign.tables import parquet_bytes

    write_atomically(place / "runs.parquet", parquet_bytes(summary), "the table")


def table_of_runs(summary: dict[str, Any]) -> None:
    """Print a line for each run."""
    rows = []
    for run in summary["runs"]:
        result = run["result"] or {}
        apart = result.get("separation_m")
        least = "-" if apart is None else f"{apart:.0f} m"
        row = [run["name"], str(result.get("takeovers", 0)), least, run["outcome"], run["why"]]
        rows.append(row)
    table(["run", "takeovers", "least separation", "outcome", "why"], rows, verdict_column=3)


def show(summary: dict[str, Any], lost: list[str]) -> None:
    """Print the summary; disagreement of judge and monitor comes first.

    lost: why attempts were lost, including those of runs that were flown later.
    """
    from cratous.services.campaign.pages import model_line, share

    if summary["disagreements"]:
        say(f"DISAGREEMENT of judge and monitor in {summary['disagreements']} runs")
    if summary["model"]:
        say(model_line(summary["model"]))
    head = ["mission", "option", "runs", "flown", "violated", "not holding"]
    rows = []
    for group in summary["groups"]:
        bad = [
            f"{name} {found['violated']['count']}"
            for name, found in group["requirements"].items()
            if found["violated"]["count"]
        ]
        row = [group["mission"], group["option"], str(group["runs"]), str(group["flown"])]
        rows.append([*row, ", ".join(bad) or "-", share(group["not_holding"])])
    table(head, rows)
    for one in summary["comparisons"]:
        for name, found in one["requirements"].items():
            if found["first_only"] or found["second_only"]:
                chance = f", p {found['p_value']:.2g}" if "p_value" in found else ""
                say(
                    f"{name}: of {found['pairs']} pairs {found['first_only']} hold under {one['first']} "
                    f"alone, {found['second_only']} under {one['second']} alone{chance}"
                )
    for why in sorted(set(lost))[:10]:
        say(f"attempts lost, {lost.count(why)}: {why}")
    for reason in summary["reasons"][:5]:
        say(f"{reason['outcome']}, {reason['count']} runs: {reason['why']}")
    for line in summary["limits"]:
        say(line)
    counts = ", ".join(f"{count} {name}" for name, count in summary["outcomes"].items())
    say(f"{summary['runs_in_all']} runs: {counts}; exit code {summary['exit_code']}")
