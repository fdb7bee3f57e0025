"""User requirements at the command line: the option, its files, and the results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cratous.services.cli.show import shown_path

if TYPE_CHECKING:
    from cratous.services.requirements.requirement_files import OwnFile

Data = dict[str, Any]


def own_option(said: str) -> Any:
    """The option `--requirements FILE.req`, which may be repeated."""
    return click.option(
        "--requirements",
        type=click.Path(path_type=Path),
        metavar="FILE.req",
        multiple=True,
        help=said,
    )


def own_files(paths: Sequence[Path]) -> tuple[OwnFile, ...]:
    """Read these requirement files; BadInput, before anything is flown or judged, for one that no flight log can be
    checked against."""
    if not paths:
        return ()
    from cratous.services.requirements.requirement_files import own_file, refuse_clashes

    found = tuple(own_file(path, shown_path(path)) for path in paths)
    refuse_clashes(found)
    return found


def own_data(report: Data) -> Data:
    """A report's rows of user requirements, without the texts of their files."""
    own = report["own"]
    files = [{key: one[key] for key in ("file", "sha256")} for one in own["files"]]
    return {**own, "files": files}


def own_lines(report: Data) -> Iterator[str]:
    """The report's results for user requirements as lines of text; empty if it has none."""
    from cratous.services.certify.requirement_texts import margin as said
    from cratous.services.certify.requirement_texts import sentence

    own = report.get("own")
    if not own:
        return
    for one in own["lint"]:
        yield f"lint: {one['file']}: {one['text']}"
    for one in own["findings"]:
        yield f"finding: {one['file']}: {one['text']}"
    for row in own["requirements"]:
        name = f"{row['requirement']} ({row['title']})" if row["title"] else row["requirement"]
        severity = f" [{row['severity']}]" if row["severity"] else ""
        yield f"{name}{severity}: {row['verdict']}; {row['note']}"
        yield from (f"  lint: {one['text']}" for one in row["lint"])
        yield from (f"  {said(one)}" for one in row["margins"])
        if (blame := row["blame"]) is not None:
            yield f"  blame at {blame['at_s']:g} s: {sentence(blame)}"
