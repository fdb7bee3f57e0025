"""A campaign's runs as CSV for spreadsheets, as Parquet for programs, and as JUnit for continuous integration."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

from cratous.services.campaign.outcomes import FAILED, IMPOSSIBLE, LOST
from cratous.spec.files.extras import told
from cratous.spec.files.printable import cell, printable
from cratous.spec.mission.guarantees import Outcome

HEAD = ("run", "mission", "option", "seed", "outcome", "takeovers", "end_ms", "separation_m", "log")


MEASURES = ("verdict", "margin", "unit")
WHOLE, REAL = ("seed", "takeovers", "end_ms"), ("separation_m",)
"""Numeric columns, besides margins and drawn values; all others are text."""
EXACT = 2**53
"""Up to this value every integer is exact as a double."""


def csv_text(summary: dict[str, Any]) -> str:
    """A line for each run; text that a spreadsheet would read as a formula is prefixed with `'`."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    for row in (_names(summary), *_rows(summary)):
        writer.writerow([cell(value) for value in row])
    return out.getvalue()


def parquet_bytes(summary: dict[str, Any]) -> bytes:
    """The same columns as Parquet: 64-bit integers, doubles, text, null for missing values.

    A column of drawn values has doubles if they represent all values exactly, otherwise text.
    NotInstalled without pyarrow.
    """
    with told():
        import pyarrow as pa
        import pyarrow.parquet as pq
    kinds = {**dict.fromkeys(WHOLE, pa.int64()), **dict.fromkeys(REAL, pa.float64())}
    kinds |= {f"{name} margin": pa.float64() for name in summary["requirements"]}
    names, rows = _names(summary), list(_rows(summary))
    columns = [[row[k] for row in rows] for k in range(len(names))]
    for name in _drawn(summary):
        k = names.index(name, len(HEAD))
        if all(value is None or _is_double(value) for value in columns[k]):
            kinds[name] = pa.float64()
        else:
            columns[k] = [None if value is None else str(value) for value in columns[k]]
    types = [kinds.get(name, pa.string()) for name in names]
    arrays = [pa.array(column, kind) for column, kind in zip(columns, types, strict=True)]
    out = pa.BufferOutputStream()
    pq.write_table(pa.Table.from_arrays(arrays, names=names), out, compression="zstd")
    found: bytes = out.getvalue().to_pybytes()
    return found


def _is_double(value: Any) -> bool:
    """Whether it is a number that a double represents exactly."""
    return type(value) is float or (type(value) is int and abs(value) <= EXACT)


def _drawn(summary: dict[str, Any]) -> list[str]:
    return sorted({name for run in summary["runs"] for name in run["drawn"]})


def _names(summary: dict[str, Any]) -> list[str]:
    measures = [f"{name} {what}" for name in summary["requirements"] for what in MEASURES]
    return [*HEAD, *measures, *_drawn(summary), "why"]


def _rows(summary: dict[str, Any]) -> Iterator[list[Any]]:
    drawn = _drawn(summary)
    for run in summary["runs"]:
        result = run["result"] or {}
        row = [run["name"], run["mission"], run["option"], run["seed"], run["outcome"]]
        row += [result.get(key) for key in HEAD[5:]]
        for name in summary["requirements"]:
            found = result.get("requirements", {}).get(name, {})
            row += [found.get(key) for key in MEASURES]
        row += [run["drawn"].get(name) for name in drawn]
        yield [*row, run["why"]]


def junit_text(summary: dict[str, Any]) -> str:
    """A test for each run: not shown to hold is a failure, not flown an error or skipped."""
    root = ElementTree.Element("testsuites", name=summary["name"])
    suites: dict[tuple[str, str], ElementTree.Element] = {}
    for run in summary["runs"]:
        key = (run["mission"], run["option"])
        if key not in suites:
            suites[key] = ElementTree.SubElement(root, "testsuite", name=".".join(key))
        case = ElementTree.SubElement(
            suites[key], "testcase", name=run["name"], classname=".".join((summary["name"], *key))
        )
        kind = _kind(run["outcome"])
        if kind:
            told = {"type": run["outcome"], "message": printable(run["why"])}
            ElementTree.SubElement(case, kind, told)
    for suite in suites.values():
        suite.set("tests", str(len(suite)))
        for kind, name in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            suite.set(name, str(len(suite.findall(f"testcase/{kind}"))))
    ElementTree.indent(root, " ")
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'


def _kind(outcome: str) -> str:
    """The JUnit element of an outcome; empty for a run that holds."""
    if outcome == Outcome.HOLDS:
        return ""
    if outcome == IMPOSSIBLE:
        return "skipped"
    return "error" if outcome in (FAILED, LOST) else "failure"
