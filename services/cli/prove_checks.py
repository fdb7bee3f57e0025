"""Additional checks of `cratous prove`: the second solver, and mutation."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.progress import Bar


def second_solver(
    theorems: list[Any],
    folder: Path,
    jobs: int,
    as_json: bool,
    keep: bool,
    whole: bool,
    new: bool,
    texts: dict[str, Any],
) -> dict[str, Any]:
    """Check the obligations with cvc5 and report its answers; new: only those without a recorded
    verdict.

    keep: write the record. whole: these are all theorems. texts: obligations written during the
    proofs.
    """
    from cratous.core.files.private_cache import private_cache
    from cratous.proofs import recheck
    from cratous.proofs.mutation.keys import Store

    begun = time.monotonic()
    bar = Bar("cvc5", 1, not as_json and sys.stderr.isatty())
    with bar:
        found = recheck.recheck(
            theorems,
            folder=folder,
            jobs=jobs,
            tell=lambda c, n, of: bar.step("cvc5", n, of),
            record=recheck.read(),
            again=not new,
            store=Store(private_cache() / "recheck"),
            texts=texts,
        )
    if keep:
        recheck.write(found, theorems, whole=whole)
    names = found.theorems
    counts = {v: found.count(v) for v in ("confirmed", "no answer", "contradicted")}
    good = sum(check.verdict == recheck.CONFIRMED for check in found.checks)
    if not as_json:
        for check in found.checks:
            if check.verdict != recheck.CONFIRMED:
                click.echo(f"{check.verdict:12s} {check.theorem} {check.number}: {check.text}")
        click.echo(
            f"{found.solver}: {counts['confirmed']} of {len(names)} theorems confirmed, "
            f"{counts['no answer']} no answer, {counts['contradicted']} contradicted; "
            f"{good} of {len(found.checks)} obligations confirmed"
        )
    return {
        "solver": found.solver,
        "theorems": {name: found.verdict(name) for name in names},
        **{key.replace(" ", "_"): value for key, value in counts.items()},
        "obligations": len(found.checks),
        "obligations_confirmed": good,
        "not_confirmed": [
            {"theorem": c.theorem, "obligation": c.text, "verdict": c.verdict, "key": c.key}
            for c in found.checks
            if c.verdict != recheck.CONFIRMED
        ],
        "seconds": round(time.monotonic() - begun, 1),
    }


def mutation(
    patterns: tuple[str, ...],
    about: list[str],
    home: Any,
    jobs: int,
    as_json: bool,
    keep: bool,
    new: bool,
) -> dict[str, Any]:
    """Judge the mutants; patterns: names of functions; about: theorems whose functions are
    included.

    new: recorded verdicts are not judged again; surviving mutants in the record are reported and
    count.
    """
    from cratous.proofs.mutation import mutate
    from cratous.proofs.mutation import record as mutation_record
    from cratous.proofs.mutation.keys import Keys
    from cratous.proofs.mutation.report import ENOUGH

    keys = Keys(home)

    def tell(target: str, results: list[Any]) -> None:
        if keep:
            # immediately, so that an interrupted run keeps its results
            mutation_record.write(mutate.part(target, results), keys)
        if as_json:
            return
        counts = {v: sum(getattr(r, "verdict", "") == v for r in results) for v in mutate.VERDICTS}
        shown = ", ".join(f"{count} {v}" for v, count in counts.items() if count)
        click.echo(f"mutated    {target}: {shown or f'{len(results)} premises'}", err=True)

    data = mutation_record.read() if new and home.product else mutation_record.EMPTY
    known = mutation_record.fresh(data, keys) if new else set()
    report = mutate.run(patterns, tell, jobs, about=about, keys=keys, skip=known)
    recorded = mutation_record.survivors(data, known)
    listed = {v: report.of(v) for v in ("survived", "undecided")}
    if not as_json:
        for verdict, results in listed.items():
            for result in results:
                click.echo(f"{verdict:10s} {result.place}: {result.target}: {result.diff}")
        for target, _, diff in recorded:
            click.echo(f"survived   {target}: {diff} (as recorded)")
        click.echo(report.line)
    found: dict[str, Any] = {
        "mutants": len(report.results),
        **{verdict: report.count(verdict) for verdict in mutate.VERDICTS},
        "score": float(report.score),
        "holds": report.holds and all(kind == "definition" for _, kind, _ in recorded),
        "listed": [
            {"verdict": v, "target": r.target, "place": r.place, "diff": r.diff, "note": r.note}
            for v, results in listed.items()
            for r in results
        ],
    }
    if new and home.product:
        # the totals of the whole record matter, not of this run alone
        found["record"] = mutation_record.totals(mutation_record.merged(data, report, keys), keys)
        score = mutation_record.score_of(found["record"])
        found["holds"] = found["holds"] and (score is None or score >= ENOUGH)
        if not as_json:
            click.echo(f"with what was recorded: {mutation_record.summary(found['record'])}")
    return found
