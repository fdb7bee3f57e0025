"""`cratous certify-plan`: checks the certificate of an assignment without the search that made it."""

from __future__ import annotations

import json
from pathlib import Path

import click

from cratous.services.cli.show import say


@click.command("certify-plan")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def certify_plan(file: Path, as_json: bool) -> int:
    """Check the certificate of an assignment.

    FILE holds a problem, a schedule and what proves its bound (docs/guides/assignment.md). The schedule is
    replayed by the proved kernels and by z3; the bound is proved anew from the file. Nothing of
    the search that wrote the file is trusted.

    Example:  cratous certify-plan out/plan.certificate.json

    Exit codes: 0 the claim holds, 1 it does not (with the reason), 2 bad input.
    """
    from cratous.core.ledger import require
    from cratous.services.cli.progress import waiting
    from cratous.services.planning.assign_certificate import read, verify

    with waiting("checking the certificate", as_json):
        require()
        verdict = verify(read(file))
    code = 1 if verdict.wrong else 0
    if as_json:
        data = {
            "holds": not verdict.wrong, "status": verdict.status, "cost": verdict.cost,
            "bound": verdict.bound, "wrong": verdict.wrong, "exit_code": code,
        }  # fmt: skip
        click.echo(json.dumps(data, indent=1))
        return code
    if verdict.wrong:
        say(f"cratous: {file}: refused: {verdict.wrong}", err=True)
        return code
    if verdict.cost is None:
        say(f"confirmed: {verdict.status}")
        return code
    gap = (verdict.cost - verdict.bound) / verdict.cost if verdict.cost > verdict.bound else 0.0
    click.echo(
        f"confirmed: {verdict.status}, cost {verdict.cost}, nothing below {verdict.bound}"
        + (f" (gap {100 * gap:.2f} %)" if gap else "")
    )
    return code
