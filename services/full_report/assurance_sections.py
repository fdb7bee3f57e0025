"""Sections 7 and 9 to 13: proofs, coverage, discrepancies, tools, argument, reproduction."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.core import ledger
from cratous.services.argument.build import argument
from cratous.services.attestation.findings import Subject, doubt, unshown
from cratous.services.certify.blame_texts import sentence
from cratous.services.certify.html import repeats, seconds
from cratous.services.certify.proofs import NOT_RECORDED, statuses
from cratous.services.certify.requirement_views import own_requirements
from cratous.services.full_report import document
from cratous.services.full_report.user_requirements import blame_of_own, trace_of_own, untested_own
from cratous.spec.errors import CratousError
from cratous.spec.mission.guarantees import Outcome

Data = dict[str, Any]


def proofs(report: Data, names: dict[str, str]) -> document.Section:
    """Section 7. names: display names of the kernels, of `trace.traced`."""
    return document.Section("proofs", "7 Proofs of the kernels that were called", tuple(_proofs(report, names)))  # fmt: skip


def _proofs(report: Data, names: dict[str, str]) -> Iterator[document.Part]:
    found = report["proofs"]
    yield document.Words(f"Ledger of the run: {found['line']}; {found['solver']}; seal {found['seal'] or 'none'}.")  # fmt: skip
    for one in found["problems"]:
        yield document.Words(f"Not vouched for: {one['kernel']}: {one['what']}", "alarm")
    if found["calls"] == NOT_RECORDED:
        yield document.Words("What was called in this run was not recorded, so no kernel is listed as evidence.", "alarm")  # fmt: skip
    if found["uncounted"]:
        yield document.Words(
            f"Registered too late to be counted: {', '.join(found['uncounted'])}.", "alarm"
        )
    said = "; ".join(f"{number} {status}" for status, number in statuses(found).items())
    yield document.Words(
        f"Kernels, folds and drivers: {len(found['kernels'])}. {said}. Below each name the SHA-256 of its syntax tree "
        "that the gate held against the ledger before the flight: what was proved is what ran, but for what is named "
        "above as not vouched for. Solver time, unsat cores and proof "
        f"objects: {document.NOT_OBSERVED}, the report has none."
    )
    rows: list[tuple[str, ...]] = [
        (f"{names.get(name, name)}\n{one['source'] or 'no source digest'}", str(one["count"] or document.DASH), one["status"],
         f"{one['definition'] or document.DASH}\n{', '.join(one['against'] or one['theorems'])}")
        for name, one in sorted(found["kernels"].items())
    ]  # fmt: skip
    head = ("Name, source digest", "Calls", "Status", "Definition, theorems")
    yield document.Table(head, tuple(rows), (38, 9, 17, 36), (1,))
    yield document.Head("Theorems, with the lemmas that they rest on")
    rows = [
        (f"{t['sentence']}\n{name}" + (f"; rests on {', '.join(t['lemmas'])}" if t["lemmas"] else ""),
         t["status"], str(t["obligations"]))
        for name, t in sorted(found["theorems"].items())
    ]  # fmt: skip
    yield document.Table(("Theorem", "Status", "Obligations"), tuple(rows), (76, 12, 12), (2,))
    yield document.Head("Definitions")
    yield document.Table(
        ("Definition", "File"), tuple(sorted(found["definitions"].items())), (55, 45)
    )


def coverage(subject: Subject, chains: Data) -> document.Section:
    """Section 9. chains: of `trace.traced`."""
    return document.Section(
        "coverage", "9 Coverage and traceability", tuple(_coverage(subject, chains))
    )


def _coverage(subject: Subject, chains: Data) -> Iterator[document.Part]:
    report, names = subject.report, chains["names"]
    rows: list[tuple[str, ...]] = []
    for number, row in enumerate(chains["rows"], 1):
        links = [
            f"{names[c['kernel']]} -> {', '.join(c['theorems']) or 'no theorem'} -> {c['definition'] or 'no definition'}"
            for c in row["chains"]
        ]
        lacks = "; ".join(row["missing"]) or ("undecided" if row["undecided"] else "complete")
        rows.append(
            (str(number), row["requirement"], row["item"], "\n".join(links) or document.DASH, lacks)
        )
    kept = len(rows) - chains["missing"] - chains["undecided"]
    yield document.Words(
        f"{kept} of {len(rows)} rows trace to a definition, {chains['undecided']} undecided, {chains['missing']} with "
        "something missing."
    )
    yield document.Table(("No", "", "Constraint", "Kernel, theorems, definition", "Trace"), tuple(rows), (5, 5, 22, 53, 15))  # fmt: skip
    yield document.Head("Nothing tested these")
    untested: list[tuple[str, ...]] = [
        (one["requirement"], one["title"], "no row") for one in report["requirements"] if not one["constraints"]
    ]  # fmt: skip
    untested += [
        (row["requirement"], row["item"], doubt(row)) for row in report["constraints"] if not row["checks"]
    ]  # fmt: skip
    untested += untested_own(report)
    yield document.Table(("", "Requirement or constraint", "Why"), tuple(untested), (8, 46, 46), empty="Every constraint was checked at least once.")  # fmt: skip
    yield from trace_of_own(report)
    yield document.Head("Called, and named by no row")
    named = {name for row in report["constraints"] for name in row["kernels"]}
    called = sorted(names.get(k, k) for k in report["proofs"]["kernels"] if k not in named)
    yield document.Words(f"{len(called)}, called to plan, to fly, or inside of others: {', '.join(called) or 'none'}.")  # fmt: skip
    yield document.Words(
        f"Tests: on record in no run. Code that was not reached: {document.NOT_OBSERVED}."
    )


def discrepancies(subject: Subject) -> document.Section:
    """Section 10."""
    return document.Section("discrepancies", "10 Discrepancies, limits, what is unknown", tuple(_discrepancies(subject)))  # fmt: skip


def _discrepancies(subject: Subject) -> Iterator[document.Part]:
    report = subject.report
    yield document.Words("Between the report and what its log gives: none. A report with any is not written as this view.")  # fmt: skip
    yield document.Head("Rows that do not hold")
    rows: list[tuple[str, ...]] = [
        (row["requirement"], row["item"], row["verdict"], row["note"])
        for row in report["constraints"]
        if row["verdict"] != Outcome.HOLDS
    ]
    rows += [
        (one["requirement"], one["title"] or one["text"], one["verdict"], one["note"])
        for one in own_requirements(report)
        if one["verdict"] != Outcome.HOLDS
    ]
    yield document.Table(
        ("", "Constraint", "Verdict", "Note"), tuple(rows), (7, 38, 13, 42), empty="None."
    )
    yield document.Head("Who was in command then, and what had broken first")
    rows = [
        (one["requirement"], one["item"], seconds(one["time_ms"]), sentence(one))
        for one in report["blame"]
    ]
    rows += blame_of_own(report)
    yield document.Table(
        ("", "Constraint", "At", "Blame"), tuple(rows), (7, 38, 13, 42), (2,), empty="None."
    )
    yield document.Head("Not shown")
    yield document.Table(("What", "Why"), tuple(unshown(subject)), (50, 50), empty="Nothing was left unchecked.")  # fmt: skip
    yield document.Head("Notes of the mission")
    for text in report["mission"]["notes"] or ("None.",):
        yield document.Words(text, "item")
    yield document.Words(f"Changes since a last report: {document.NOT_ASKED}.")


def tools(report: Data) -> document.Section:
    """Section 11."""
    return document.Section("tools", "11 Tools and environment", tuple(_tools(report)))


def _tools(report: Data) -> Iterator[document.Part]:
    used = report["environment"]
    yield document.Words(report["limits"][0] if report["limits"] else "No tool is qualified.")
    rows: list[tuple[str, ...]] = [(report["product"]["name"], report["product"]["version"]), ("Python", used["python"]),
            ("System", used["system"]), ("Solver of the ledger", report["proofs"]["solver"]),
            *sorted(used["packages"].items())]  # fmt: skip
    yield document.Table(("Tool", "Version"), tuple(rows), (50, 50))
    code = used.get("code")
    if code:
        yield document.Words(f"Services and bridge: code {code['digest']}, running {code['running']}; {code['release']}.")  # fmt: skip
    yield document.Words(
        f"Processor and memory: {document.NOT_OBSERVED}. Qualification data (DO-330): none."
    )
    yield document.Words(
        "The same mission, seed and versions give the same log and report, byte for byte; no time of day is in them."
        if repeats(report)
        else "Flown by processes, in real time: another flight of the same mission gives another log. The same log "
        "gives the same report."
    )


def argued(subject: Subject) -> document.Section:
    """Section 12, from the current ledger; states the reason if it cannot be made."""
    return document.Section("argument", "12 Assurance argument", tuple(_argued(subject)))


def _argued(subject: Subject) -> Iterator[document.Part]:
    try:
        kept = ledger.read()
        elements = argument(subject.report, unshown(subject), kept)
    except CratousError as error:
        yield document.Words(f"Not made: {error}", "alarm")
        return
    yield document.Words(
        f"Goal Structuring Notation, held against the ledger with the seal {kept['seal'] or 'none'}. Drawn, and "
        "as YAML: cratous certify --argument."
    )
    rows: list[tuple[str, ...]] = [
        (e.id, str(e.kind.name).lower(), e.text, "" if e.kind.name not in ("GOAL", "STRATEGY") else str(e.state),
         "\n".join(", ".join(names) for names in (e.supported_by, e.in_context_of) if names) or document.DASH)
        for e in elements.values()
    ]  # fmt: skip
    yield document.Table(("Id", "Kind", "Text", "State", "Supported by, in context of"), tuple(rows), (16, 9, 42, 10, 23))  # fmt: skip


def reproduction(report: Data) -> document.Section:
    """Section 13."""
    return document.Section("reproduction", "13 Reproduction", tuple(_reproduction(report)))


def _reproduction(report: Data) -> Iterator[document.Part]:
    yield document.Words(report["command"], "code")
    rows: list[tuple[str, ...]] = [
        ("log of the flight", report["log"]["digest"]), ("mission", report["mission_hash"]),
        ("plan", report["plan"]["hash"]), ("certificate", report["plan"]["certificate"] or "none"),
        ("ledger", report["proofs"]["seal"] or "none"),
    ]  # fmt: skip
    expected = (
        "Expected digest of" if repeats(report) else "Digest, of this flight alone for its log, of"
    )
    yield document.Table((expected, "SHA-256"), tuple(rows), (30, 70))
    rows = [
        ("cratous certify FOLDER", "judges the log again and compares all that is written of it"),
        ("cratous judge FOLDER", "judges the log by a program that shares no code"),
        ("cratous certify-plan FOLDER/certificate.json", "checks the certificate without the search"),
        ("cratous prove --check --recheck", "proves every kernel again, and by a second solver"),
        ("cratous certify --verify FOLDER --public-key FILE", "signature and digests of all files"),
    ]  # fmt: skip
    yield document.Table(("Command", "What it does"), tuple(rows), (50, 50))
    yield document.Words(f"Time that this takes: {document.NOT_OBSERVED}.")
