"""`cratous prove --self-test`: the prover refuses what is false and accepts what is true."""

from __future__ import annotations

import json
import sys
import time

import click

from cratous.services.cli.progress import Bar


def self_test(as_json: bool, verbose: bool, jobs: int | None) -> bool:
    """Run every case and print the results by kind; True iff each verdict is the expected one."""
    from cratous.proofs.ledger import jobs_default
    from cratous.proofs.self_test.case import cases
    from cratous.proofs.self_test.trial import Trial, attempts

    begun = time.monotonic()
    chosen = list(cases())
    trials: list[Trial] = []
    with Bar("trying", len(chosen), not as_json and sys.stderr.isatty()) as bar:
        for trial in attempts(chosen, jobs or jobs_default()):
            trials.append(trial)
            bar.step(trial.case.id, 1, 1)
    trials.sort(key=lambda trial: (trial.case.id, trial.case.verdict))
    wrong = [trial for trial in trials if trial.wrong]
    seconds = time.monotonic() - begun
    if as_json:
        rows = [
            {
                "case": trial.case.id,
                "must_be": trial.case.verdict,
                "was": trial.verdict,
                "because": trial.case.because,
                "reason": trial.reason,
                "wrong": trial.wrong,
            }
            for trial in trials
        ]
        data = {"cases": rows, "wrong": len(wrong), "seconds": round(seconds, 2)}
        data["open"] = [trial.case.id for trial in trials if trial.case.verdict == "open"]
        click.echo(json.dumps(data, indent=1))
        return not wrong
    for kind in sorted({trial.case.kind for trial in trials}):
        ours = [trial for trial in trials if trial.case.kind == kind]
        counts = [
            f"{sum(not t.wrong for t in some)} of {len(some)} {verdict}"
            for verdict in ("refused", "accepted")
            if (some := [t for t in ours if t.case.verdict == verdict])
        ]
        good = not any(trial.wrong for trial in ours)
        click.secho(f"{kind.replace('_', ' ')}: {', '.join(counts)}", fg=None if good else "red")
        for trial in ours:
            if trial.wrong:
                click.echo(
                    f"  {trial.case.name}: {trial.wrong}\n    {trial.case.because}", err=True
                )
            elif verbose:
                click.echo(f"  {trial.case.name}: {trial.case.because}")
    for trial in trials:
        if trial.case.verdict == "open":
            click.secho(f"open: {trial.case.id}: {trial.case.because}", fg="yellow")
    kinds = len({trial.case.kind for trial in trials})
    right = len(trials) - len(wrong)
    click.echo(f"{right} of {len(trials)} cases of {kinds} kinds as they must be, {seconds:.0f} s")
    return not wrong
