"""Checks that a report lists exactly the existing assumptions, broken as the log recorded.

What was observed of the others can only be confirmed by the watch itself (`cratous certify`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import zip_longest
from typing import Any

from cratous.services.assumptions.listing import LISTING, Assumption, State
from cratous.services.attestation.findings import Data
from cratous.services.results.names import ASSUMPTIONS, REPORT_NAME


def assumption_faults(report: Data, meta: Mapping[str, Any]) -> list[str]:
    """Where the report contradicts the listing or the log. meta: recorded in the log."""
    if ASSUMPTIONS not in report:
        told = ASSUMPTIONS in meta
        return [f"{REPORT_NAME}: it lacks the assumptions that the log recorded"] if told else []
    rows = report[ASSUMPTIONS]
    found = list(_listed(rows))
    found += [text for row, one in zip(rows, LISTING, strict=False) for text in _of(row, one)]
    broken = [row for row in rows if row["state"] == State.BROKEN]
    if ASSUMPTIONS in meta and meta[ASSUMPTIONS] != broken:
        found.append("the broken assumptions are not those that the log recorded")
    return [f"{REPORT_NAME}: {text}" for text in found]


def _listed(rows: list[Data]) -> Iterator[str]:
    """The first row that is not that of the listing, in its order."""
    for row, one in zip_longest(rows, LISTING):
        if row is None or one is None or row["name"] != one.name:
            got, expected = row["name"] if row else "none", one.name if one else "none"
            yield f"the assumption {got} stands where {expected} belongs"
            return


def _of(row: Data, one: Assumption) -> Iterator[str]:
    """Contents of a row that no watch writes."""
    if row["name"] != one.name:
        return
    name = f"the assumption {one.name}"
    broken = row["state"] == State.BROKEN
    text = (one.text, one.theorems, one.guarantees)
    if (row["text"], tuple(row["theorems"]), tuple(row["guarantees"])) != text:
        yield f"{name} has another text, other theorems or guarantees"
    if (row["lost"], row["stands"]) != ((one.lost, one.stands) if broken else ("", "")):
        yield f"{name} says otherwise what is lost and what stands"
    if (row["since_ms"] is not None) != broken:
        yield f"{name} is {row['state']}, since {row['since_ms']} ms"
    if row["state"] != State.NOT_OBSERVED and not row["checks"]:
        yield f"{name} is {row['state']} without a check"
    if (row["state"] == State.HELD) == bool(row["note"]):
        yield f"{name} is {row['state']}, with the note {row['note'] or 'none'!r}"


def assumptions_not_judged(report: Data, meta: Mapping[str, Any]) -> list[str]:
    """The assumptions that were not checked here, in words."""
    if ASSUMPTIONS not in report:
        return ["assumptions of the system theorems: the report was made before they were watched"]
    told = ASSUMPTIONS in meta
    rows = [row for row in report[ASSUMPTIONS] if not told or row["state"] != State.BROKEN]
    return [f"{len(rows)} assumptions that held or were not observed: whether it is so (cratous certify)"
            if told else f"{len(rows)} assumptions: the log says nothing of those that broke"]  # fmt: skip
