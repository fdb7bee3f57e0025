"""`cratous certify`: a finished flight judged again from its log."""

from __future__ import annotations

import json
from pathlib import Path

import click


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def certify(folder: Path, as_json: bool) -> int:
    """Judge a finished flight again from its log and compare with its report.

    FOLDER is an output folder of `cratous run`. The log's digest, the plan check and the monitor
    are made again; report.html and map.svg are written again from report.json.

    Example:  cratous certify out/crossing

    Exit codes: as of the flight if the report is confirmed (0, 1 or 3); 1 if it is not, with the
    differences named; 2 bad input.
    """
    from cratous.services.certify.again import certify_again
    from cratous.services.cli.show import requirement_table

    report, found = certify_again(folder)
    code = 1 if found else int(report["exit_code"])
    if as_json:
        data = {
            "confirmed": not found,
            "differences": found,
            "verdict": report["verdict"],
            "digest": report["log"]["digest"],
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        return code
    if found:
        click.echo(f"cratous: {folder}: the report is not what its log says", err=True)
        for difference in found:
            click.echo(f"  {difference}", err=True)
        return code
    requirement_table(report["requirements"])
    click.echo(f"confirmed from the log with the digest {report['log']['digest']}")
    click.echo(f"report: {folder / 'report.html'}")
    return code
