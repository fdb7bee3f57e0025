"""`cratous prove`: prove every kernel against its definition, and write the ledger."""

from __future__ import annotations

import fnmatch
import json
import sys
from pathlib import Path
from typing import Any

import click

from cratous.spec.errors import BadInput


def _theorem_data(theorem: Any) -> dict[str, Any]:
    outcomes = [
        {
            "kind": outcome.obligation.kind,
            "text": outcome.obligation.text,
            "status": outcome.status,
            "rlimit": outcome.rlimit,
            "logic": outcome.logic,
            "counterexample": dict(outcome.counterexample),
        }
        for outcome in theorem.outcomes
    ]
    return {
        "name": theorem.name,
        "sentence": theorem.sentence,
        "proved": theorem.proved,
        "kernels": sorted(theorem.kernels),
        "lemmas": sorted(set(theorem.lemmas)),
        "premises": theorem.premises,
        "assumptions": [list(a) for a in theorem.assumptions],
        "rlimit": theorem.rlimit,
        "obligations": outcomes,
    }


def _show(theorem: Any, verbose: bool) -> None:
    mark = "proved" if theorem.proved else "NOT PROVED"
    click.echo(f"{mark:10s} {theorem.name} ({len(theorem.outcomes)} obligations)")
    if verbose:
        click.echo(f"           {theorem.sentence}")
    if theorem.premises != "satisfiable":
        click.echo(f"           its premises are {theorem.premises}")
    for outcome in theorem.outcomes:
        if outcome.status == "proved":
            continue
        where = f"{outcome.obligation.kind}: {outcome.obligation.text}"
        click.echo(f"           {outcome.status}: {where}")
        for name, value in outcome.counterexample:
            if "!" not in name:
                click.echo(f"             {name} = {value}")


def _export(names: list[str], folder: Path) -> int:
    """Write each obligation as SMT-LIB; returns how many files."""
    from cratous.proofs import prover
    from cratous.proofs.claim import Claim

    folder.mkdir(parents=True, exist_ok=True)
    written = 0
    for name in names:
        statement, sentence = prover.load_claim(name)
        claim = Claim(load=lambda other: prover.load_claim(other)[0])
        statement(claim)
        for number, obligation in enumerate(claim.obligations, 1):
            file = folder / f"{name}-{number:02d}.smt2"
            file.write_text(prover.smt2(obligation, sentence), encoding="utf-8")
            written += 1
    return written


@click.command()
@click.option("--only", metavar="GLOB", help="Only theorems whose name matches; writes no ledger.")
@click.option("--check", is_flag=True, help="Do not write the ledger; fail if it would differ.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option(
    "--smt2",
    "smt2_folder",
    type=click.Path(path_type=Path, file_okay=False),
    help="Also write every obligation as SMT-LIB 2 into this folder (unsat means proved).",
)
@click.option("-v", "--verbose", is_flag=True, help="Print each theorem's sentence.")
def prove(
    only: str | None, check: bool, as_json: bool, smt2_folder: Path | None, verbose: bool
) -> None:
    """Prove every kernel against its definition and write core/ledger.json.

    Runs each kernel on symbolic values, states every theorem of proofs/theorems about exactly
    that function, and asks z3. The ledger binds the proofs to the source: `cratous run` refuses a
    kernel that has changed since.

    Example: cratous prove --only 'well*' -v

    Exit code: 0 everything proved, 1 something refuted or not decided, 2 bad input.
    """
    from cratous.core import ledger as gate
    from cratous.proofs import ledger, prover

    names = [n for n in prover.theorem_files() if fnmatch.fnmatch(n, only or "*")]
    if not names:
        raise BadInput("no theorem matches", item="--only", got=str(only), expected="a file name")
    tell = None if as_json else (lambda theorem: _show(theorem, verbose))
    try:
        inventory = ledger.prove_all(names, tell)
    except ValueError as error:
        raise BadInput(str(error), where="proofs/theorems") from error
    if smt2_folder is not None:
        count = _export(names, smt2_folder)
        if not as_json:
            click.echo(f"{count} SMT-LIB files in {smt2_folder}")
    proved = sum(t.proved for t in inventory.theorems)
    problems = [str(finding) for finding in inventory.findings]
    stale = False
    if only is None:
        problems += [f"{name}: no theorem is about this kernel" for name in inventory.bare]
        if check:
            stale = ledger.text(inventory) != gate.LEDGER.read_text(encoding="utf-8")
            if stale:
                problems.append("core/ledger.json differs from these proofs: run `cratous prove`")
        else:
            ledger.write(inventory)
    if as_json:
        data = {
            "proved": proved,
            "theorems": [_theorem_data(t) for t in inventory.theorems],
            "problems": problems,
            "assumptions": sum(len(t.assumptions) for t in inventory.theorems),
            "solver": gate.solver_version(),
        }
        click.echo(json.dumps(data, indent=1))
    else:
        obligations = sum(len(t.outcomes) for t in inventory.theorems)
        kernels = len({k for t in inventory.theorems for k in t.kernels})
        assumed = sum(len(t.assumptions) for t in inventory.theorems)
        for problem in problems:
            click.echo(problem, err=True)
        click.echo(
            f"{proved} of {len(inventory.theorems)} theorems proved about {kernels} kernels, "
            f"{obligations} obligations, {assumed} assumptions, {gate.solver_version()}"
        )
    if proved < len(inventory.theorems) or problems:
        sys.exit(1)
