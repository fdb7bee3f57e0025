"""What `cratous certify` writes for other tools, and how it verifies signed results."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cratous.services.attestation.names import (
    ARGUMENT_NAME,
    CSV_NAME,
    DRAWING_NAME,
    FOLDER,
    FULL_NAME,
    FULL_PDF_NAME,
    JUNIT_NAME,
    MCAP_NAME,
    PDF_NAME,
    SARIF_NAME,
    VIEWS,
)
from cratous.services.cli.show import say
from cratous.services.results.names import LOG_NAME

if TYPE_CHECKING:
    from cratous.services.attestation.findings import Subject
    from cratous.services.attestation.writing import Written

OPTIONS = (
    click.option(
        "-o", "--out", type=click.Path(path_type=Path),
        help="Folder of the views and the statement. [FOLDER/attestation]",
    ),
    click.option("--junit", is_flag=True, help="Write junit.xml: a test case a constraint."),
    click.option("--sarif", is_flag=True, help="Write report.sarif: what is not shown to hold."),
    click.option("--csv", is_flag=True, help="Write constraints.csv."),
    click.option("--argument", is_flag=True, help="Write argument.yaml and .svg: the assurance argument (GSN)."),
    click.option("--pdf", is_flag=True, help="Write report.pdf, two pages; with --full full.pdf."),
    click.option("--full", is_flag=True, help="Write full.html: the report with all its sections."),
    click.option("--mcap", is_flag=True, help="Write run.mcap: the messages of the log, for Foxglove."),
    click.option("--mission", type=click.Path(path_type=Path), help="Mission file, for lines in SARIF."),
    click.option("--sign", is_flag=True, help="Sign a statement over results and views (Ed25519)."),
    click.option(
        "--verify", is_flag=True, help="Verify what was signed; FOLDER is not judged by the monitor."
    ),
    click.option(
        "--public-key", type=click.Path(path_type=Path), help="File of the signer's public key, PEM."
    ),
    click.option(
        "--key", type=click.Path(path_type=Path),
        help="File of the private key, PEM. [the PEM in CRATOUS_SIGNING_KEY]",
    ),
)  # fmt: skip


def view_options(command: Any) -> Any:
    """Add this module's options before a command's own."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


class Asked(NamedTuple):
    """The options as given."""

    out: Path | None
    junit: bool
    sarif: bool
    csv: bool
    argument: bool
    pdf: bool
    full: bool
    mcap: bool
    mission: Path | None
    sign: bool
    verify: bool
    public_key: Path | None
    key: Path | None

    @property
    def anything(self) -> bool:
        """Whether any output was requested."""
        return self.named or self.sign or self.out is not None

    @property
    def named(self) -> bool:
        """Whether any view is named."""
        tools = self.junit or self.sarif or self.csv or self.argument
        return tools or self.pdf or self.full or self.mcap

    @property
    def names(self) -> tuple[str, ...]:
        """The views to write: all if none is named."""
        chosen = (
            (self.junit, JUNIT_NAME), (self.sarif, SARIF_NAME), (self.csv, CSV_NAME),
            (self.argument, ARGUMENT_NAME), (self.argument, DRAWING_NAME),
            (self.full, FULL_NAME), (self.pdf, FULL_PDF_NAME if self.full else PDF_NAME),
            (self.mcap, MCAP_NAME),
        )  # fmt: skip
        return tuple(name for wanted, name in chosen if wanted) or VIEWS

    def folder(self, results: Path) -> Path:
        """The folder of views and statement."""
        return self.out or results / FOLDER


def checked(asked: Asked) -> Any:
    """The signing key, None for none; refuses contradictory options."""
    if asked.key is not None and not asked.sign:
        raise click.UsageError("--key is the key of --sign")
    if asked.mission is not None and not (asked.anything and SARIF_NAME in asked.names):
        raise click.UsageError(f"--mission finds lines for {SARIF_NAME}, which is not asked for")
    if asked.public_key is not None and not asked.verify:
        raise click.UsageError("--public-key is the key of --verify")
    if asked.pdf and not asked.verify:
        from cratous.services.full_report.pdf_drawing import needed

        needed()
    if asked.mcap and not asked.verify:
        from cratous.services.logs import as_mcap

        as_mcap.needed()
    if not asked.sign:
        return None
    from cratous.services.attestation.dsse import private_key

    return private_key(asked.key)


def verified(results: Path, asked: Asked, as_json: bool) -> int:
    """Verify signed results, and print the outcome; returns the exit code.

    Nothing of planner, pilot, monitor or kernels is imported here, nor by the judge or for the
    argument.
    """
    from cratous.services.attestation.dsse import public_key
    from cratous.services.attestation.verification import signed_folder, verify
    from cratous.services.cli.judge import judgement

    if asked.sign or asked.named or asked.mission:
        raise click.UsageError("--verify writes nothing")
    if asked.public_key is None:
        raise click.UsageError("--verify needs --public-key")
    place = signed_folder(results, asked.out, FOLDER)
    found = verify(place, public_key(asked.public_key), judgement, _view_of(results))
    if as_json:
        click.echo(json.dumps({"verified": not found.refused, **asdict(found)}, indent=1))
        return found.exit_code
    for line in found.refused:
        say(f"refused: {line}", err=True)
    if not found.refused:
        say(
            f"verified: signature, {found.files} digests, {found.recomputed} of {found.expected} "
            "verdicts on the flight by the judge"
            + (f", {found.own} requirements of the user's own from the log" if found.own else "")
        )
    for line in found.undecided:
        say(f"not decided: {line}")
    for line in found.not_checked:
        say(f"not checked when it was signed: {line}")
    for line in found.not_judged:
        say(f"not judged: {line}")
    if not found.refused:
        say(
            f"the report says {found.verdict.upper()}; verified: {found.verified_verdict.upper()}; "
            f"exit code {found.exit_code}"
        )
    return found.exit_code


def write(done: Any, results: Path, asked: Asked, key: Any) -> Written:
    """Write the requested views of a confirmed judgement."""
    from cratous.services.attestation.findings import Subject
    from cratous.services.attestation.writing import Wanted, write_views
    from cratous.services.certify.result_files import no_result

    target = asked.folder(results)
    inside = target.resolve().parent == results.resolve()
    # the views are not part of the results that they describe
    unchecked = tuple(u for u in done.unchecked if not (inside and u == no_result(target.name)))
    subject = Subject(done.report, unchecked)
    wanted = Wanted(asked.names, asked.mission, key, _view_of(results))
    return write_views(subject, results, target, wanted)


def _view_of(results: Path) -> Callable[[Subject, str], bytes]:
    """A function that makes the views not implemented by `tools`, by name."""

    def made(subject: Subject, name: str) -> bytes:
        if name == MCAP_NAME:
            from cratous.services.logs.as_mcap import as_mcap

            return as_mcap(results / LOG_NAME)
        from cratous.services.full_report.views import view

        return view(subject, name)

    return made
