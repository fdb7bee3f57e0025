"""User requirements in the sections of the full report: source, lint, margins, blame, trace."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.core import ledger
from cratous.core.kernel.names import short
from cratous.services.attestation.findings import doubt
from cratous.services.certify.html import seconds
from cratous.services.certify.requirement_texts import margin as said
from cratous.services.certify.requirement_texts import sentence
from cratous.services.certify.requirement_views import own_constraints, own_requirements
from cratous.services.full_report import document
from cratous.spec.errors import CratousError

Data = dict[str, Any]
Rows = list[tuple[str, ...]]


def of_own(report: Data) -> Iterator[document.Part]:
    """For section 2: the requirements with severity and source, the files, and lint findings."""
    own = report["own"]
    yield document.Head("Requirements of one's own")
    rows: Rows = [
        (one["requirement"], f"{one['title']}\n{one['text']}".strip(), one["severity"] or document.DASH,
         one["source"] or document.DASH, "\n".join(r["text"] for r in one["lint"]) or "nothing odd", one["verdict"])
        for one in own["requirements"]
    ]  # fmt: skip
    head = ("Id", "Requirement", "Severity", "Source", "Lint (z3)", "Verdict")
    yield document.Table(head, tuple(rows), (12, 38, 10, 14, 14, 12))
    rows = []
    for file in own["files"]:
        rows += [(one["file"], one["sha256"]) for one in (file, *file["imports"])]
    yield document.Table(("File, whole in report.json", "SHA-256"), tuple(rows), (35, 65))
    for one in own["lint"]:
        yield document.Words(f"Lint of {one['file']}: {one['text']}", "item")
    yield document.Words("Lint of the five: not asked for, they are fixed.")


def margins_of_own(report: Data) -> Iterator[document.Part]:
    """For section 3: samples and margins, and faults of the samples; empty if there are none."""
    own = own_requirements(report)
    if not own:
        return
    yield document.Head("Requirements of one's own")
    rows: Rows = [
        (one["requirement"], one["verdict"], seconds(one["time_ms"]), str(one["checks"]),
         "\n".join([one["note"], *map(said, one["margins"])]))
        for one in own
    ]  # fmt: skip
    yield document.Words("Checks: samples at which it asked something and was decided.")
    head = ("", "Verdict", "At", "Checks", "Samples, and margins of its comparisons")
    yield document.Table(head, tuple(rows), (14, 10, 10, 10, 56), (2, 3))
    for one in report["own"]["findings"]:
        yield document.Words(f"Samples for {one['file']}: {one['text']}", "item")


def untested_own(report: Data) -> Rows:
    """For section 9: requirements that nothing in the flight tested."""
    return [
        (row["requirement"], row["item"], doubt(row) or row["note"])
        for row in own_constraints(report)
        if not row["checks"]
    ]


def trace_of_own(report: Data) -> Iterator[document.Part]:
    """For section 9: from each requirement to its deciding kernels and their theorems, by the current ledger."""
    own = own_requirements(report)
    if not own:
        return
    yield document.Head("Requirements of one's own, from each to its theorems")
    try:
        known = ledger.read()["kernels"]
    except CratousError as error:
        yield document.Words(f"Not made: {error}", "alarm")
        return
    names = short([name for one in own for name in one["kernels"]])
    rows: Rows = []
    for one in own:
        links = [f"{names[k]} -> {_held(known, k)}" for k in one["kernels"]]
        rows.append((one["requirement"], one["file"], "\n".join(links) or document.DASH))
    yield document.Words(
        "The monitor judged them after the flight, so they are not among the kernels of section 7."
    )
    yield document.Table(("", "File", "Kernel, theorems, definition"), tuple(rows), (14, 26, 60))


def _held(known: Data, name: str) -> str:
    """The theorems that relate a kernel, or the fold to which it belongs, to its definition."""
    if name not in known:
        return "not in the ledger"
    one = known[name]
    whole = known[one["supports"]] if one.get("supports") in known else one
    against = ", ".join(whole.get("against", [])) or "no theorem"
    return f"{against} -> {whole.get('implements') or 'no definition'} ({whole.get('status', '')})"


def blame_of_own(report: Data) -> Rows:
    """For section 10: the commander at each violation of a user requirement."""
    return [
        (one["requirement"], one["title"], seconds(one["time_ms"]), sentence(one["blame"]))
        for one in own_requirements(report)
        if one["blame"] is not None
    ]
