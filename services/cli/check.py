"""`cratous check`: validates mission files, process-algebra texts and requirements; for hooks and CI."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.progress import waiting
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.services.requirements.specification import Specification

ALGEBRA, REQUIREMENTS = ".algebra", (".req", ".json")


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--fretish", is_flag=True, help="Also say requirements in FRET's structured English.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def check(files: tuple[Path, ...], fretish: bool, as_json: bool) -> int:
    """Check FILES: mission files (.yaml, .xml, or folders), process-algebra texts (.algebra) and
    requirements (.req, or an export of FRET, .json).

    Each is read as `cratous run` and `cratous algebra check` read it, with all that they refuse; nothing
    is planned or flown, so a mission that is well formed may still have no plan.

    Example:  cratous check examples/crossing/mission.yaml

    Parameters that can be read and do not fit the vehicles (`cratous params`) are named.

    With --fretish each requirement whose form FRETish has is printed as its sentence, and of the others
    why it has none.

    Exit codes: 0 all can be read, 2 one cannot (all that is wrong is printed), 3 with --fretish a
    requirement has no sentence.
    """
    notes: dict[Path, tuple[str, ...]] = {}
    with waiting("reading", as_json) as wait:
        found = [_read(file, notes) for file in wait.each(files, "reading files")]
    said = {str(file): _said(file) for file, bad in found if fretish and not bad}
    missing = any(not one["sentence"] for rows in said.values() for one in rows)
    code = 2 if any(problems for _, problems in found) else 3 if missing else 0
    if as_json:
        data = {
            "files": [
                {
                    "file": str(file),
                    "problems": [_data(one) for one in problems],
                    "notes": list(notes.get(file, ())),
                    **({"fretish": said.get(str(file), [])} if fretish else {}),
                }
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
        for note in notes.get(file, ()):
            say(f"{file}: {note}")
        for row in said.get(str(file), ()):
            say(f"{row['requirement']}: {row['sentence'] or 'not in FRETish: ' + row['why']}")
    return code


def _read(file: Path, notes: dict[Path, tuple[str, ...]]) -> tuple[Path, list[BadInput]]:
    """The file and its faults; notes: receives unsuitable parameters of missions."""
    try:
        if file.suffix == ALGEBRA:
            from cratous.spec import algebra
            from cratous.spec.files.limits import CONFIG_BYTES
            from cratous.spec.files.text_file import text_of

            algebra.parse(text_of(file, CONFIG_BYTES, "a UTF-8 text"), None, where=str(file))
        elif file.suffix in REQUIREMENTS:
            from cratous.services.cli.monitor_requirements import read
            from cratous.services.requirements.specification import NotRead

            spec = read(file, is_open=True)
            asked = [one.formula for one in spec.requirements]
            # requirements without times have no period
            notes[file] = (*spec.notes, *_kept(spec)) if spec.period_ns else ()
            return file, [one for one in asked if isinstance(one, NotRead)]
        else:
            from cratous.services.loading import load
            from cratous.services.loading.fitness import warnings_of
            from cratous.services.mission.landing import sites_of
            from cratous.services.mission.take_off import grounded

            mission = load(file)
            if sites_of(mission):
                from cratous.services.flight.landing_reach import require_reachable

                require_reachable(mission)
            if grounded(mission):
                from cratous.services.flight.take_off import require_take_offs

                require_take_offs(mission)
            notes[file] = warnings_of(mission)
    except BadInput as error:
        return file, list(getattr(error, "problems", ())) or [error]
    return file, []


def _kept(spec: Specification) -> list[str]:
    """Maximum number of samples waiting for their verdict, in words."""
    from cratous.services.requirements.formula import waiting
    from cratous.services.requirements.specification import NotRead

    read = [one for one in spec.requirements if not isinstance(one.formula, NotRead)]
    most = max((waiting(one.judged, spec.period_ns) for one in read), default=0)
    return [f"{most} samples wait at most for a verdict, where they come as often as it says"]


def _said(file: Path) -> list[dict[str, str]]:
    """The sentence of each requirement of a file, or why it has none; empty for other files."""
    if file.suffix not in REQUIREMENTS:
        return []
    from cratous.services.cli.monitor_requirements import read
    from cratous.services.requirements.fretish import NoForm, sentence
    from cratous.services.requirements.specification import NotRead

    spec, rows = read(file, is_open=True), []
    for one in spec.requirements:
        made, why = "", ""
        try:
            if isinstance(one.formula, NotRead):
                raise one.formula
            made = sentence(one.formula, spec)
        except NoForm as no:
            why = str(no)
        rows.append({"requirement": one.name, "sentence": made, "why": why})
    return rows


def _data(problem: BadInput) -> dict[str, Any]:
    return dict(problem.data())
