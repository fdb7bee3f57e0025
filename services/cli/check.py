"""`cratous check`: mission files and process-algebra texts, read as they would be flown; for hooks and CI."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.show import say
from cratous.spec.errors import BadInput

ALGEBRA = ".algebra"


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def check(files: tuple[Path, ...], as_json: bool) -> int:
    """Check FILES: mission files (.yaml, .xml, or folders) and process-algebra texts (.algebra).

    Each is read as `cratous run` and `cratous algebra check` read it, with all that they refuse; nothing
    is planned or flown, so a mission that is well formed may still have no plan.

    Example:  cratous check examples/crossing/mission.yaml

    Exit codes: 0 all can be read, 2 one cannot (all that is wrong is printed).
    """
    found = [_read(file) for file in files]
    code = 2 if any(problems for _, problems in found) else 0
    if as_json:
        data = {
            "files": [
                {"file": str(file), "problems": [_data(one) for one in problems]}
                for file, problems in found
            ],
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        return code
    for file, problems in found:
        for one in problems:
            say(f"cratous: {one}", err=True)
        if not problems:
            say(f"{file}: can be read")
    return code


def _read(file: Path) -> tuple[Path, list[BadInput]]:
    """The file and what is wrong with it."""
    try:
        if file.suffix == ALGEBRA:
            from cratous.spec import algebra
            from cratous.spec.files.limits import CONFIG_BYTES
            from cratous.spec.files.text_file import text_of

            algebra.parse(text_of(file, CONFIG_BYTES, "a UTF-8 text"), None, where=str(file))
        else:
            from cratous.services.loading import load

            load(file)
    except BadInput as error:
        return file, list(getattr(error, "problems", ())) or [error]
    return file, []


def _data(problem: BadInput) -> dict[str, Any]:
    return dict(problem.data())
