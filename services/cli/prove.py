"""`cratous prove`: prove every kernel against its definition, and write the ledger."""

from __future__ import annotations

import gc
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import click

from cratous.core.files.whole_file import write_atomically
from cratous.services.cli.progress import Bar
from cratous.services.cli.prove_checks import mutation, second_solver
from cratous.services.cli.prove_elsewhere import ask, refuse_what_vouches
from cratous.services.cli.prove_self_test import self_test as tried
from cratous.spec.errors import BadInput


def _show(theorem: Any, verbose: bool, statement: str) -> None:
    from cratous.proofs.ledger.report_formats import failure_text

    mark = (
        click.style("proved    ", fg="green")
        if theorem.proved
        else (click.style("NOT PROVED", fg="red"))
    )
    click.echo(f"{mark} {theorem.name} ({len(theorem.outcomes)} obligations)")
    if verbose:
        click.echo(f"           {theorem.sentence}")
        click.secho(f"           stated: {statement}", dim=True)
    for condition, owner, reason in theorem.assumptions:
        text = f"           ASSUMED by {owner}: {' '.join(condition.split())} ({reason})"
        click.secho(text, fg="red")
    for line in failure_text(theorem).splitlines():
        click.echo(f"           {line}")


def _tell_ran(theorems: list[Any], verbose: bool) -> None:
    """Report what was run on concrete numbers for proved theorems, and what could not be."""
    ran = [(t.name, t.ran) for t in theorems if t.ran is not None]
    held = [one for _, one in ran if one.points]
    left = sorted({text for _, one in ran for text in one.left_out})
    click.echo(
        f"{len(held)} of {len(theorems)} theorems run as Python, at {sum(o.points for o in held)} points; "
        f"{len(left)} {'reading' if len(left) == 1 else 'readings'} could not be compared"
    )
    if verbose:
        for name, one in ran:
            if not one.points:
                why = (
                    one.not_run
                    or "no point was found at which its premises hold and all is rational"
                )
                click.echo(f"not run: {name}: {why}")
    for text in left:
        click.echo(f"not compared: {text}")


def _statuses(said: dict[str, str]) -> dict[str, int]:
    """Number of kernels, folds and drivers in a ledger by status."""
    from cratous.core.ledger.status import counts

    kept = (json.loads(text) for place, text in said.items() if place.startswith("kernels/"))
    return counts([record["status"] for rows in kept for record in rows.values()])


def _export(theorems: list[Any], folder: Path, theorem_folder: Path) -> int:
    """Write each obligation as SMT-LIB; returns the number of files."""
    from functools import partial

    from cratous.proofs.engine import prover, worker_processes

    def texts(name: str) -> list[str]:
        claim, sentence = prover.state(name, theorem_folder)
        seen: dict[int, Any] = {}
        return [prover.smt2(obligation, sentence, seen) for obligation in claim.obligations]

    folder.mkdir(parents=True, exist_ok=True)
    written = 0
    for theorem in theorems:
        for number, text in enumerate(worker_processes.call(partial(texts, theorem.name)), 1):
            write_atomically(folder / f"{theorem.name}-{number:02d}.smt2", text)
            written += 1
    return written


def _refuse(problems: list[str]) -> None:
    """Structural faults end the run: no ledger could vouch for such code."""
    for problem in problems:
        click.echo(problem, err=True)
    where, _, what = problems[0].partition(": ")
    raise BadInput(
        f"{what} ({len(problems)} such places)" if len(problems) > 1 else what,
        where=where,
        expected="every kernel proved, and drivers that call what they name; the ledger is not written",
    )


class Output(NamedTuple):
    """Output options, number of processes, and the cluster to use first."""

    as_json: bool
    junit: Path | None
    sarif: Path | None
    smt2_folder: Path | None
    jobs: int | None
    scheduler: str | None
    verbose: bool


@click.command()
@click.option(
    "--only",
    multiple=True,
    metavar="GLOB",
    help="Only theorems whose name matches (one of several), with --mutate functions too; writes no ledger.",
)
@click.option("--changed", is_flag=True, help="Only what differs from the ledger; writes none.")
@click.option("--check", is_flag=True, help="Do not write the ledger; fail if it would differ.")
@click.option(
    "--recheck", is_flag=True, help="Put every obligation to cvc5 as well; with --only, of these."
)
@click.option(
    "--new",
    is_flag=True,
    help="With --recheck or --mutate: only what proofs/recheck.json and mutation.json have no verdict on.",
)
@click.option("--mutate", is_flag=True, help="Also look for faults that no theorem would notice.")
@click.option(
    "--self-test",
    is_flag=True,
    help="Try the prover itself: packages that it must refuse, and near misses that it must accept.",
)
@click.option("--package", "package_name", metavar="NAME", help="A package with own kernels.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option("--junit", type=click.Path(path_type=Path, dir_okay=False), help="Write JUnit XML.")
@click.option("--sarif", type=click.Path(path_type=Path, dir_okay=False), help="Write SARIF.")
@click.option(
    "--smt2",
    "smt2_folder",
    type=click.Path(path_type=Path, file_okay=False),
    help="Write every obligation as SMT-LIB 2 into this folder (unsat means proved).",
)
@click.option("--jobs", type=click.IntRange(1), help="Processes; by default one for each core.")
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Have workers of dask.distributed prove first; what vouches is asked here all the same.",
)
@click.option(
    "-v",
    "--verbose",
    is_flag=True,
    help="Print each theorem's sentence, and one made from what it states.",
)
def prove(
    only: tuple[str, ...],
    changed: bool,
    check: bool,
    recheck: bool,
    new: bool,
    mutate: bool,
    self_test: bool,
    package_name: str | None,
    **output: Any,
) -> None:
    """Prove every kernel against its definition and write the ledger.

    Runs each kernel on symbolic values, states every theorem of proofs/theorems about exactly
    that function, and asks z3. The ledger (core/ledger/records/) binds the proofs to the source:
    `cratous run` refuses a kernel that has changed since. What was proved before is known by its
    structural hash from the cache ($CRATOUS_CACHE), and where no file has changed nothing is even
    lifted; CI proves from an empty one.

    With --scheduler workers of a cluster prove first and tell what they find. It proves nothing here:
    with --only or --changed such theorems are told apart, and a ledger is written of what was asked here.

    Example: cratous prove --only 'well*' -v

    Exit code: 0 everything proved, 1 something refuted, not decided or contradicted, 2 bad input:
    a theorem or kernel that no proof could be bound to, 3 something is said to be proved elsewhere alone.
    """
    from cratous.core import ledger as gate
    from cratous.core.files.private_cache import private_cache
    from cratous.core.kernel import REGISTRY
    from cratous.core.kernel.names import fits, matching
    from cratous.core.ledger import records
    from cratous.proofs import ledger
    from cratous.proofs import recheck as again
    from cratous.proofs.engine import cache, prover
    from cratous.proofs.engine.theorem_files import home_folder
    from cratous.proofs.judgement import Memory, judge
    from cratous.proofs.ledger import report_formats
    from cratous.proofs.ledger.proof_recall import Recall
    from cratous.proofs.ledger.text_cache import Remembered
    from cratous.proofs.lint import decisions
    from cratous.proofs.phases import REST, SECOND, Phases, TimedCache

    as_json, junit, sarif, smt2_folder, jobs, scheduler, verbose = Output(**output)
    # most syntax trees live to the end: garbage collection would take a third of a warm run
    gc.set_threshold(200_000, 20, 100)
    begun = time.monotonic()
    if scheduler is not None:
        refuse_what_vouches(
            not only and not changed,
            {
                "--recheck": recheck, "--mutate": mutate, "--self-test": self_test, "--junit": junit,
                "--sarif": sarif, "--smt2": smt2_folder,
            },
        )  # fmt: skip
    if self_test:
        if only or changed or check or recheck or new or mutate or package_name:
            raise BadInput("--self-test goes with no other choice", item="cratous prove")
        sys.exit(0 if tried(as_json, verbose, jobs) else 1)
    if sum((bool(only), changed, check)) > 1:
        raise BadInput("--only, --changed and --check exclude each other", item="cratous prove")
    if package_name:
        sys.path.insert(0, str(Path.cwd()))
    if new and not (recheck or mutate):
        raise BadInput("--new is of --recheck or --mutate", item="cratous prove")
    home = gate.package(package_name or "cratous")
    gate.load_all()
    gate.load_all(home)
    folder = home_folder(home)
    every = list(prover.theorem_files(folder))
    patterns = only or ("*",)
    names = [name for name in every if any(fits(name, pattern) for pattern in patterns)]
    if changed:
        names = ledger.changed_theorems(home)
    whole = not only and not changed
    about = [] if whole else names
    if mutate and only:
        from cratous.proofs.mutation.keys import Keys
        from cratous.proofs.mutation.mutate import chosen

        for name in every:
            prover.load_claim(name, folder)  # reports the error in a file, with its position
        # theorems that involve a function of this name are proved too
        met = chosen(only, Keys(home), about)
        matching(only, [*every, *met], "theorem or function", "--only", REGISTRY)
        names = sorted({*names, *(name for users in met.values() for name in users)})
    elif only:
        matching(only, every, "theorem", "--only")
    if not every:
        raise BadInput("the package has no theorems", where=home.name, expected="one file a claim")
    workers = jobs or ledger.jobs_default()
    store, phases = TimedCache(cache.standard().folder), Phases(since=begun)
    recall = Recall(private_cache() / "theorems", home)
    said: list[str] = []
    if scheduler is not None:
        unknown = [name for name in names if recall.get(name) is None]
        said = ask(unknown, home, scheduler, whole=whole, jobs=workers, quiet=as_json)
        names = [name for name in names if name not in said]
    # each theorem is stated once, for both solvers
    write = again.writer(again.read(), again=not new) if recheck else None
    remembered = Remembered(private_cache() / "remembered", home)
    bar = Bar("proving", len(names), not as_json and sys.stderr.isatty())
    texts: dict[str, Any] = {}

    def tell(progress: Any) -> None:
        bar.step(progress.name, progress.done, progress.of)
        if progress.written is not None:
            texts[progress.name] = progress.written

    with bar:
        judged = judge(
            names,
            home,
            whole=whole,
            tell=tell,
            jobs=workers,
            memory=Memory(store, recall, private_cache() / "relations", write),
            phases=phases,
        )
    inventory = judged.inventory
    theorems = list(inventory.theorems)
    if not as_json:
        for theorem in theorems:
            _show(theorem, verbose, judged.statements.get(theorem.name, ""))
        for name in said:
            mark = click.style("elsewhere ", fg="yellow")
            click.echo(f"{mark} {name}: workers say it is proved; it was not asked here")
    outputs: list[tuple[Path | None, Callable[[list[str]], str]]] = [
        (junit, lambda found: report_formats.junit(theorems, found)),
        (sarif, lambda found: report_formats.sarif(theorems, found, home)),
    ]
    problems = judged.problems
    if whole and home.product:
        lint = remembered.text("decisions", "", lambda: json.dumps(decisions.unexplained()))
        problems += json.loads(lint)
    data: dict[str, Any] = {}
    if recheck:
        keep = home.product and not check
        phases.ended(REST)
        data["recheck"] = second_solver(theorems, folder, workers, as_json, keep, whole, new, texts)
        phases.ended(SECOND)
    if mutate:
        functions = only or (("*",) if whole else ())
        keep = home.product and not check
        data["mutation"] = mutation(functions, about, home, workers, as_json, keep, new)
    if smt2_folder is not None:
        count = _export(theorems, smt2_folder, folder)
        if not as_json:
            click.echo(f"{count} SMT-LIB files in {smt2_folder}")
    proved = sum(t.proved for t in theorems)
    statuses: dict[str, int] = {}
    if whole and judged.binds and not problems:
        record = ledger.text(inventory, home, judged.grounds, judged.statements)
        statuses = _statuses(record)
        if check:
            differing = records.differing(record, home.records, provenance=False)
            if differing:
                problems.append(
                    f"the ledger differs from these proofs in {', '.join(differing)}: "
                    "run `cratous prove`"
                )
        else:
            records.write(record, home.records)
    for path, make in outputs:
        if path is not None:
            report_formats.write(path, make(problems))
    dead = ledger.dead_paths(theorems) if whole else []
    second = data.get("recheck", {}).get("theorems", {})
    assumed = sum(len(t.assumptions) for t in theorems)
    phases.ended(REST)
    if as_json:
        shown = {
            "proved": proved,
            "statuses": statuses,
            "theorems": [
                {
                    **report_formats.theorem_data(t, second.get(t.name)),
                    "statement": judged.statements.get(t.name, ""),
                }
                for t in theorems
            ],
            "problems": problems,
            "dead_paths": dead,
            "assumptions": assumed,
            "said_elsewhere": said,
            "solver": gate.solver_version(),
            "seconds": round(time.monotonic() - begun, 2),
            "parts": {part: round(taken, 2) for part, taken in phases.seconds.items()},
            "z3_cpu_seconds": round(store.seconds, 2),
            **data,
        }
        click.echo(json.dumps(shown, indent=1))
    else:
        if not judged.structural:
            for problem in problems:
                click.echo(problem, err=True)
        kernels = len({k for t in theorems for k in t.kernels})
        click.echo(
            f"{proved} of {len(theorems)} theorems proved about {kernels} kernels, "
            f"{sum(len(t.outcomes) for t in theorems)} obligations, ",
            nl=False,
        )
        click.secho(f"{assumed} assumptions", fg="red" if assumed else None, nl=False)
        click.echo(f", {gate.solver_version()}")
        _tell_ran(theorems, verbose)
        click.echo(phases.line(store.seconds), err=True)
        if statuses:
            click.echo("; ".join(f"{number} {status}" for status, number in statuses.items()))
        before = [
            one for one in records.solvers(gate.read(home.records)) if one != gate.solver_version()
        ]
        if check and before:
            click.echo(f"the ledger was written with {', '.join(before)}")
        slow = [f"{t.name} {t.seconds:.1f} s" for t in theorems if t.seconds > 1]
        if slow and verbose:
            click.echo(f"more than 1 s of solver CPU: {', '.join(slow)}")
        if not whole:
            click.echo("a part only: the ledger is not written")
    if judged.structural:
        _refuse([*judged.structural, *judged.unmeant])
    contradicted = bool(data.get("recheck", {}).get("contradicted"))
    survives = mutate and not data["mutation"]["holds"]
    if proved < len(theorems) or problems or contradicted or survives:
        sys.exit(1)
    if said:
        sys.exit(3)
