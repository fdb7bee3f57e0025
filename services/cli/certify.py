"""`cratous certify`: judges a finished flight again from its log."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.certify_views import Asked, checked, verified, view_options, write
from cratous.services.cli.user_requirements import own_files, own_lines, own_option

SHOWN = 20


def _print_schema(context: click.Context, _parameter: click.Parameter, wanted: bool) -> None:
    """Print the schema and exit; no folder is needed."""
    if wanted and not context.resilient_parsing:
        from cratous.services.certify.report_schema import schema_text

        click.echo(schema_text(), nl=False)
        context.exit()


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--schema", is_flag=True, is_eager=True, expose_value=False, callback=_print_schema,
    help="Print the JSON Schema of report.json, and do nothing else.",
)  # fmt: skip
@click.option(
    "--rewrite", is_flag=True, help="Make report.html and map.svg anew where they differ."
)
@click.option(
    "--trace",
    is_flag=True,
    help="Print for each row which kernels decided it, and their theorems and definitions.",
)
@own_option(
    "Hold the log against these requirements of your own too, and make the report anew with them."
)
@view_options
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON, all differences.")
def certify(
    folder: Path,
    rewrite: bool,
    trace: bool,
    as_json: bool,
    requirements: tuple[Path, ...],
    **views: Any,
) -> int:
    """Judge a finished flight again from its log and compare with all that is written of it.

    FOLDER may be a LOG alone, whole or cut: then its report is made, with its pages, in the folder of -o; of a log
    that is not whole nothing in flight holds. A certificate of a plan (certificate.json) is checked as by
    `cratous certify-plan`.

    Else FOLDER is an output folder of `cratous run`. The log's digest, the plan check and the monitor
    are made again; every entry of report.json, report.html, map.svg and manifest.json is held
    against what they give and against what the log recorded. What could not be checked is listed.
    Nothing is written, unless with --rewrite: what is made from report.json is then made anew, if
    report.json and the rest are confirmed.

    With --trace every row of the report is followed to the kernels that decided it and were called in
    this run, from each to the theorems that hold it against its definition, and to that definition.

    With --junit, --sarif, --csv, --argument, --sign or -o views of the confirmed report are written for
    other tools, all of these if none is named. In none of them does anything pass that was not checked.

    With --requirements (again for each file) a report that is confirmed is made anew with requirements of
    your own: verdict, margins and blame of each, and the text of the file. They count for the exit code. From
    then on they are judged again with the rest. Files of an earlier --requirements are replaced by those that
    are named now; those that the flight was flown with stay.

    --pdf writes the report as PDF (the extra `pdf`), --full as full.html with all sections: requirements,
    margins, certificate, proofs, assumptions, coverage, argument; --pdf --full as full.pdf. The same report
    and ledger give the same bytes. --mcap (the extra `wires`) writes the log's messages as run.mcap.

    --sign signs digests of results and views with the verdict; --verify checks signature and digests,
    makes every view again, and judges the log again by the judge, in a process without planner
    and pilot. It says what report and judge both say, and 3 where the report holds and the judge cannot tell.

    Example:  cratous certify out/crossing

    Exit codes: as of the flight if the report is confirmed (0, 1 or 3); 1 if it is not, with the
    differences named, or if something is missing in a trace; 2 bad input.
    """
    if folder.is_file():
        if rewrite or trace or any(value for name, value in views.items() if name != "out"):
            raise click.UsageError("of a file alone no views are made: name a folder of results")
        if folder.suffix == ".json":
            from cratous.services.cli.certify_plan import certify_plan

            code: int = click.get_current_context().invoke(
                certify_plan, file=folder, as_json=as_json
            )
            return code
        return _of_log(folder, views["out"], requirements, as_json)
    asked = Asked(**views)
    key = checked(asked)
    if asked.verify:
        if rewrite or trace or requirements:
            raise click.UsageError(
                "--verify judges by the judge alone, without --rewrite, --trace and --requirements"
            )
        return verified(folder, asked, as_json)

    from cratous.services.attestation.writing import earlier
    from cratous.services.certify.rejudge import certify_again
    from cratous.services.certify.trace import lines, traced
    from cratous.services.cli.progress import waiting
    from cratous.services.cli.show import requirement_table, say

    own = own_files(requirements)
    with waiting("judging the flight again from its log", as_json):
        done = certify_again(folder, rewrite=rewrite, own=own)
    report, found = done.report, done.found
    code = 1 if found else int(report["exit_code"])
    files: list[str] = []
    left_out: list[str] = []
    if asked.anything and not found:
        files, left_out = write(done, folder, asked, key)
    elif asked.anything:
        left_out = [f"{name}: the report is not confirmed" for name in asked.names]
    stale = earlier(asked.folder(folder)) if found else []
    chains = traced(report) if trace and not found else None
    if chains is not None and chains["missing"]:
        code = 1
    if as_json:
        data = {
            "confirmed": not found,
            "differences": found,
            "not_checked": done.unchecked,
            "rewritten": done.rewritten,
            "written": files,
            "not_written": left_out,
            "of_an_earlier_run": stale,
            "verdict": report.get("verdict"),
            "digest": report["log"]["digest"] if report else None,
            **({"own": report["own"]["requirements"]} if report.get("own") else {}),
            "exit_code": code,
            **({"trace": {k: v for k, v in chains.items() if k != "names"}} if chains else {}),
        }
        click.echo(json.dumps(data, indent=1))
        return code
    if found:
        say(f"cratous: {folder}: not what the log of the flight gives", err=True)
        for difference in found[:SHOWN]:
            say(f"  {difference}", err=True)
        if len(found) > SHOWN:
            say(f"  and {len(found) - SHOWN} more (--json lists all)", err=True)
    else:
        requirement_table(report["requirements"])
        for line in own_lines(report):
            say(line)
        say(f"confirmed from the log with the digest {report['log']['digest']}")
    for line in lines(chains) if chains is not None else ():
        say(line)
    for text in done.unchecked:
        say(f"not checked: {text}", err=bool(found))
    for name in done.rewritten:
        say(f"rewritten: {name}")
    for name in files:
        say(f"written: {name}")
    for text in left_out:
        say(f"not written: {text}", err=bool(found))
    for name in stale:
        say(f"of an earlier run, not confirmed now: {name}", err=True)
    if not found:
        say(f"report: {folder / 'report.html'}")
    return code


def _of_log(log: Path, out: Path | None, requirements: tuple[Path, ...], as_json: bool) -> int:
    """Make the report of a single log."""
    from cratous.services.certify.from_log import write_from_log
    from cratous.services.cli.progress import waiting
    from cratous.services.cli.show import requirement_table, say
    from cratous.spec.errors import BadInput

    if out is None:
        raise BadInput("a report of a log alone needs a folder", item="-o", expected="-o DIR")
    with waiting("judging the messages of the log", as_json):
        made = write_from_log(log, out, own_files(requirements))
    report = made.report
    code = int(report["exit_code"])
    if as_json:
        data = {
            "verdict": report["verdict"],
            "digest": report["log"]["digest"],
            "not_checked": made.unchecked,
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        return code
    requirement_table(report["requirements"])
    for line in own_lines(report):
        say(line)
    for text in made.unchecked:
        say(f"not checked: {text}")
    say(f"report: {out / 'report.html'}")
    return code
