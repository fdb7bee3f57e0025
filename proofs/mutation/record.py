"""The recorded mutation results, `proofs/mutation/mutation.json`, and the document made from them.

Each target's results are stored under the key of all that they depend on (`proofs/mutation/keys.py`). A result whose
key differs from that of the present code is stale and listed as such; so is a kernel that was never mutated. A run on
some targets replaces those and leaves the others unchanged.
"""

from __future__ import annotations

import functools
import inspect
import json
from collections.abc import Container, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.files.whole_file import write_atomically
from cratous.proofs.mutation.judgement import faults
from cratous.proofs.mutation.keys import Keys, find
from cratous.proofs.mutation.report import MutationReport, percent
from cratous.proofs.mutation.results import VERDICTS

FILE = Path(__file__).with_name("mutation.json")
LISTED = ("survived", "undecided", "equivalent", "stillborn")
EMPTY: dict[str, Any] = {"targets": {}, "premises": {}}


def read(path: Path = FILE) -> dict[str, Any]:
    """The record; empty if there is none."""
    return dict(json.loads(path.read_text(encoding="utf-8"))) if path.is_file() else dict(EMPTY)


def merged(data: dict[str, Any], report: MutationReport, keys: Keys) -> dict[str, Any]:
    """The record with the entries of this report's targets and theorems replaced.

    Functions and theorems that no longer exist are dropped.
    """
    there = {k: row for k, row in data["targets"].items() if find(k) is not None}
    for target in dict.fromkeys(r.target for r in report.results):
        own = [r for r in report.results if r.target == target]
        listed = [
            {"verdict": r.verdict, "operator": r.operator, "diff": r.diff, "note": r.note}
            for r in own
            if r.verdict in LISTED
        ]
        there[target] = {
            "key": keys.target(target, find(target)),
            "kind": own[0].kind,
            "counts": {v: sum(r.verdict == v for r in own) for v in VERDICTS},
            "listed": listed,
        }
    premises = {n: row for n, row in data["premises"].items() if n in keys.theorems}
    for theorem in dict.fromkeys((*report.judged, *(p.theorem for p in report.premises))):
        rows = [p for p in report.premises if p.theorem == theorem]
        found = [[p.premise, p.dropped, p.weakened] for p in rows]
        premises[theorem] = {"key": keys.premises(theorem), "rows": found}
    return {"targets": there, "premises": premises}


def write(report: MutationReport, keys: Keys, path: Path = FILE) -> None:
    """Merge a report into the record."""
    text = json.dumps(merged(read(path), report, keys), indent=1, sort_keys=True) + "\n"
    write_atomically(path, text)


def stale(data: dict[str, Any], keys: Keys) -> dict[str, str]:
    """Targets whose results do not belong to the present code, with the reason."""
    found = {}
    for target, row in data["targets"].items():
        function = find(target)
        if function is None:
            found[target] = "it is no longer there"
        elif keys.target(target, function) != row["key"]:
            found[target] = "it, a theorem about it, or the judging code has changed since"
    for name, entry in gate.load_all().items():
        definition = f"cratous.spec.{entry.implements}"
        wanted = [name] if entry.kind != "driver" else []
        # some definitions are in a file without a function of the name
        wanted += [definition] if entry.implements and find(definition) is not None else []
        for one in wanted:
            # a function without possible faults needs no record
            if one not in data["targets"] and _has_faults(find(one)):
                found[one] = "it was never mutated"
    for one in _definitions(keys) - set(data["targets"]):
        found[one] = "it was never mutated"
    return found


def _definitions(keys: Keys) -> frozenset[str]:
    """The functions of `spec` that these theorems could look into and that have possible faults."""
    names = {name for one in keys.theorems for name in keys.reach(one)}
    there = {name: find(name) for name in names if name.startswith("cratous.spec.")}
    return frozenset(n for n, f in there.items() if inspect.isfunction(f) and _has_faults(f))


def stale_premises(data: dict[str, Any], keys: Keys) -> dict[str, str]:
    """Theorems whose premises have no valid record, with the reason."""
    found = {}
    for theorem in keys.theorems:
        row = data["premises"].get(theorem)
        if row is None:
            found[theorem] = "its premises were never judged"
        elif row["key"] != keys.premises(theorem):
            found[theorem] = "it, what it is about, or the judging code has changed since"
    return found


def fresh(data: dict[str, Any], keys: Keys) -> set[str]:
    """Targets, and theorems with their premises, whose record is valid for the present code.

    Functions without possible faults are included.
    """
    old = {**stale(data, keys), **stale_premises(data, keys)}
    entries = [(n, e.function) for n, e in gate.load_all().items() if e.kind != "driver"]
    bare = {name for name, function in entries if not _has_faults(function)}
    return ({*data["targets"], *data["premises"]} - set(old)) | bare


def survivors(data: dict[str, Any], names: Container[str]) -> list[tuple[str, str, str]]:
    """Target, kind and change of each recorded survivor of these targets."""
    return [
        (name, row["kind"], one["diff"])
        for name, row in sorted(data["targets"].items())
        if name in names
        for one in row["listed"]
        if one["verdict"] == "survived"
    ]


def totals(data: dict[str, Any], keys: Keys) -> dict[str, int]:
    """The number of mutants with each verdict, of functions, and of stale entries.

    Only results valid for the present code are counted.
    """
    old = stale(data, keys)
    rows = [row for name, row in data["targets"].items() if name not in old]
    found = {v: sum(row["counts"][v] for row in rows) for v in VERDICTS}
    out = {
        "functions_out_of_date": len(old),
        "premises_out_of_date": len(stale_premises(data, keys)),
    }
    return {**found, "functions": len(rows), **out}


def score_of(counts: dict[str, int]) -> Fraction | None:
    """The share killed among those that are viable and not proved equivalent; None where there are none."""
    viable = counts["killed"] + counts["survived"] + counts["undecided"]
    return Fraction(counts["killed"], viable) if viable else None


def summary(counts: dict[str, int]) -> str:
    """`totals` as a sentence or two."""
    found = score_of(counts)
    score = "nothing was" if found is None else percent(found)
    shown = ", ".join(f"{counts[v]} {v}" for v in VERDICTS)
    return (
        f"{sum(counts[v] for v in VERDICTS)} mutants in {counts['functions']} functions: {shown}; "
        f"{score} killed of those that are viable and not proved equivalent. "
        f"{counts['functions_out_of_date']} functions and the premises of "
        f"{counts['premises_out_of_date']} theorems are not up to date."
    )


@functools.cache
def _has_faults(function: Any) -> bool:
    return any(True for _ in faults(function))


# -- the document ---------------------------------------------------------------------------------
def document(data: dict[str, Any], keys: Keys) -> str:
    """The record as Markdown: counts per function, then every mutant that was not killed."""
    targets = dict(sorted(data["targets"].items()))
    old = stale(data, keys)
    loose = stale_premises(data, keys)
    # stale results do not count
    own = {name: row for name, row in targets.items() if name not in old}
    lines = [
        "# Mutation of kernels, definitions and premises",
        "",
        "Generated from `proofs/mutation/mutation.json` by `make docs`; do not edit. `cratous prove --mutate`",
        "writes that file, of what `--only GLOB` matches; with `--new` it judges only what the file",
        "has no verdict on, because it or something that it depends on has changed.",
        "Each mutant is one small fault: put in place of the original, some theorem must be refuted.",
        "*Survived* means that a theorem is missing; *equivalent* that the solver proved that the",
        "fault changes nothing, everywhere or where the theorems apply (the list says which);",
        "*undecided* counts as not killed; *stillborn* mutants cannot be run.",
        "",
        f"**{summary(totals(data, keys))}**",
        "",
        "| kind | " + " | ".join(VERDICTS) + " |",
        "|---|" + "---|" * len(VERDICTS),
    ]
    for kind in ("kernel", "fold", "definition"):
        rows = [row["counts"] for row in own.values() if row["kind"] == kind]
        lines.append(f"| {kind} | {' | '.join(str(sum(c[v] for c in rows)) for v in VERDICTS)} |")
    lines += ["", "## Not up to date", ""]
    known = sorted(old.items()) + sorted(loose.items())
    lines += [f"- `{name}`: {why}" for name, why in known] or ["None."]
    lines += ["", "## By function", "", "| function | kind | mutants | " + " | ".join(VERDICTS)]
    lines[-1] += " | |"
    lines.append("|---|---|---|" + "---|" * len(VERDICTS) + "---|")
    for name, row in targets.items():
        each = " | ".join(str(row["counts"][v]) for v in VERDICTS)
        mark = "stale" if name in old else ""
        lines.append(
            f"| `{name}` | {row['kind']} | {sum(row['counts'].values())} | {each} | {mark} |"
        )
    for verdict in LISTED:
        lines += ["", f"## {verdict.capitalize()}", ""]
        found = [
            f"- `{name}` `{_short(one['diff'])}`: {_short(one['note'])}"
            for name, row in targets.items()
            for one in row["listed"]
            if one["verdict"] == verdict
        ]
        lines += found or ["None."]
    premises = [
        (name, *row)
        for name, one in sorted(data["premises"].items())
        if name not in loose
        for row in one["rows"]
    ]
    lines += ["", "## Premises", "", *_premises(premises), ""]
    return "\n".join(lines)


def _short(text: str, most: int = 240) -> str:
    return text if len(text) <= most else text[: most - 3] + "..."


def _premises(rows: Iterable[tuple[str, str, str, str]]) -> list[str]:
    found = list(rows)
    unused = [f"- `{name}`: `{_short(p)}`" for name, p, dropped, _ in found if dropped == "unused"]
    loose = [
        f"- `{name}`: `{_short(premise)}`"
        for name, premise, dropped, weakened in found
        if dropped == "matters" and weakened == "unused"
    ]
    unknown = sum(dropped == "undecided" for _, _, dropped, _ in found)
    text = [
        f"{len(found)} premises; without it the theorem is refuted for "
        f"{sum(dropped == 'matters' for _, _, dropped, _ in found)}, still proved for "
        f"{len(unused)}, undecided for {unknown}.",
        "",
        "Not needed (the theorem holds without; kept where they say what the kernel is for):",
        "",
    ]
    text += unused or ["- none"]
    text += ["", "Needed, though a slightly weaker form would do:", "", *(loose or ["- none"])]
    return text
