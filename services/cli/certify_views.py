"""What `cratous certify` writes for other tools, and how it verifies what was signed."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import click

OPTIONS = (
    click.option(
        "-o", "--out", type=click.Path(path_type=Path),
        help="Folder of the views and the statement. [FOLDER/attestation]",
    ),
    click.option("--junit", is_flag=True, help="Write junit.xml: a test case a constraint."),
    click.option("--sarif", is_flag=True, help="Write report.sarif: what is not shown to hold."),
    click.option("--csv", is_flag=True, help="Write constraints.csv."),
    click.option("--mission", type=click.Path(path_type=Path), help="Mission file, for lines in SARIF."),
    click.option("--sign", is_flag=True, help="Sign a statement over results and views (Ed25519)."),
    click.option(
        "--key", type=click.Path(path_type=Path),
        help="File of the private key, PEM. [the PEM in CRATOUS_SIGNING_KEY]",
    ),
)  # fmt: skip


def view_options(command: Any) -> Any:
    """The options of this module, put before a command's own."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


class Asked(NamedTuple):
    """The options as given."""

    out: Path | None
    junit: bool
    sarif: bool
    csv: bool
    mission: Path | None
    sign: bool
    key: Path | None

    @property
    def anything(self) -> bool:
        """Whether anything is to be written."""
        return self.junit or self.sarif or self.csv or self.sign or self.out is not None

    def folder(self, results: Path) -> Path:
        """Where views and statement stand."""
        from cratous.services.attestation.names import FOLDER

        return self.out or results / FOLDER


def checked(asked: Asked) -> Any:
    """The key to sign with, None for none; refuses options that go against each other."""
    if asked.key is not None and not asked.sign:
        raise click.UsageError("--key is the key of --sign")
    if asked.mission is not None and not asked.anything:
        raise click.UsageError("--mission finds lines for --sarif")
    if not asked.sign:
        return None
    from cratous.services.attestation.dsse import private_key

    return private_key(asked.key)


def write(done: Any, results: Path, asked: Asked, key: Any) -> list[str]:
    """Write what was asked for of a confirmed judgement; returns what to say of it."""
    from cratous.services.attestation.findings import Subject
    from cratous.services.attestation.names import CSV_NAME, JUNIT_NAME, SARIF_NAME, VIEWS
    from cratous.services.attestation.writing import Wanted, write_views

    chosen = ((asked.junit, JUNIT_NAME), (asked.sarif, SARIF_NAME), (asked.csv, CSV_NAME))
    names = tuple(name for wanted, name in chosen if wanted) or VIEWS
    target = asked.folder(results)
    inside = f"{target.name}: " if target.resolve().parent == results.resolve() else None
    # the views themselves are no part of what they are about
    unchecked = tuple(u for u in done.unchecked if inside is None or not u.startswith(inside))
    subject = Subject(done.report, unchecked)
    return write_views(subject, results, target, Wanted(names, asked.mission, key))
