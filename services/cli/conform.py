"""`cratous conform`: published test vectors for the kernels and the wire formats."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import click

from cratous.services import conform as suites
from cratous.services.cli.progress import waiting
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput

LIST = "\n".join(f"  {name}: {text}" for name, text in suites.SUITES.items())


def _in_folders(given: tuple[Path, ...]) -> list[Path]:
    """The files given, and the files in each folder given, by name."""
    found: list[Path] = []
    for path in given:
        found += sorted(p for p in path.iterdir() if p.is_file()) if path.is_dir() else [path]
    return found


@click.command(epilog="Vectors of your own: docs/reference/conformance.md")
@click.argument("suite")
@click.argument("files", nargs=-1, type=click.Path(path_type=Path))
@click.option("--show", default=5, type=click.IntRange(0), help="Differences shown for each file.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def conform(suite: str, files: tuple[Path, ...], show: int, as_json: bool) -> int:
    """Run published vectors against the kernels and the wires.

    FILES are JSON lines, also gzipped (`frames` takes captured bytes); of a folder, all files in it.
    Geometry is decided by the exact reading of the proved kernels, messages by the codecs that talk
    to others, guidance and plans by what the product itself would say. A case of a kind that the
    suite does not cover, or one on a knife edge (where another system's own tolerance explains the
    difference), is listed apart and never counted as passed.

    Example:  cratous conform polygon vectors.jsonl.gz

    Exit codes: 0 nothing failed, 1 a case failed, 2 bad input, 3 no case was covered.
    """
    suites.suite(suite)
    if not files:
        raise BadInput("no file is given", item="FILES", expected="at least one file of vectors")
    reports = []
    for file in _in_folders(files):
        judge = suites.suite(suite)
        with waiting(f"judging the cases of {file.name}", as_json):
            report = suites.run(judge, file, show)
        report.summary = suites.summary_of(judge)
        reports.append(report)
        if as_json:
            continue
        say(report.line)
        for line in report.summary:
            say(line)
        for label, count in sorted(report.differences.items()):
            say(f"  {count} x {label}")
        for result in report.shown:
            say(f"    {result.case}: {result.text}")
        for label, count in sorted(report.edges.items()):
            say(f"  {count} x knife edge: {label}")
        for result in report.edge_cases[:show]:
            say(f"    {result.case}: {result.text}")
    good, bad = sum(r.passed for r in reports), sum(r.failed for r in reports)
    skipped: Counter[str] = sum((r.skipped for r in reports), Counter())
    edges = sum(r.edges.total() for r in reports)
    code = 1 if bad else (0 if good + edges else 3)
    if as_json:
        data = {
            "suite": suite,
            "passed": good,
            "failed": bad,
            "knife_edges": edges,
            "checks": sum(r.checks for r in reports),
            "not_covered": dict(sorted(skipped.items())),
            "files": [
                {
                    "file": r.file,
                    "passed": r.passed,
                    "failed": r.failed,
                    "not_covered": dict(sorted(r.skipped.items())),
                    "differences": dict(sorted(r.differences.items())),
                    "summary": r.summary,
                    "shown": [{"id": s.case, "kind": s.label, "text": s.text} for s in r.shown],
                    "knife_edges": dict(sorted(r.edges.items())),
                    "knife_edge_cases": [
                        {"id": s.case, "kind": s.label, "text": s.text} for s in r.edge_cases
                    ],
                }
                for r in reports
            ],
            "exit_code": code,
        }
        click.echo(json.dumps(data, indent=1))
        return code
    if skipped:
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(skipped.items()))
        say(f"not covered: {kinds}")
    tail = f", {edges} on a knife edge" if edges else ""
    click.echo(f"{good} passed, {bad} failed{tail}")
    return code
