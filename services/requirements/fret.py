"""Import of requirements from FRET: its export in JSON, `{"requirements": [...], "variables": [...]}` or the first alone.

Where samples are counted, a requirement is what its formulas say: those that look ahead first, as they tell which
sample is to blame, then those that look back, then its sentence. Where samples have times it is its sentence: the
formulas have lost the unit of their bounds, so one is taken only if it has none. What cannot be said is refused with
the requirement, its formula and the place in it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from cratous.services.requirements import fret_formula, fretish_read
from cratous.services.requirements.formula import Formula
from cratous.services.requirements.fret_definitions import with_definitions
from cratous.services.requirements.fret_formula import Kind
from cratous.services.requirements.fret_terms import Defined, Meaning, Names, Unread, Wrong, number
from cratous.services.requirements.specification import (
    NotRead,
    Requirement,
    Signal,
    Specification,
    caret_of,
)
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of

AHEAD = ("ftInfAUExpanded", "ftInfAU", "ftExpanded", "ft")
BACK = ("ptExpanded", "pt")
SENTENCE = "fulltext"
CLOCK = re.compile(
    r"\b(?:within|for|after)\s+([0-9.eE+-]+\s*(?:(?:micro|milli)?(?:sec|second)s?|minutes?|hours?))\b",
    re.IGNORECASE,
)
"""A duration that is no number of ticks."""
DEFINED = re.compile(r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?")
"""A definition that is a number; `1/3` is for its author's tool to divide."""
PROBABLY = re.compile(r"\bwith\s+probability\b", re.IGNORECASE)
UNFORMED = "<b><i>"
"""FRET puts into these what it has taken over from a sentence as it stood, without reading it."""
BOOLS = ("boolean", "bool")
WHOLE = ("integer", "int", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
REALS = ("double", "single", "float", "real")


@dataclass(frozen=True)
class Export:
    """requirements: as they stand in the file, with an id each; variables: the kind of those that have one, and what
    its author defines."""

    where: str
    requirements: tuple[Mapping[str, Any], ...]
    variables: dict[str, Signal]
    defined: Mapping[str, Meaning]


def read(text: str, where: str = "FRET") -> Specification:
    """The requirements of an export over samples that are counted; its variables are the columns of the trace.

    Raises BadInput for a text that is no export, and for one of whose requirements none is told.
    """
    export = read_export(text, where)
    names = with_definitions(Names(export.variables, export.defined, counted=True))
    made = tuple(requirement(one, names, export.where, timed=False) for one in export.requirements)
    if not made:
        raise BadInput("there is no requirement", where=where, expected="requirements")
    return Specification(dict(export.variables), made)


def read_export(text: str, where: str) -> Export:
    """What stands in an export. Raises BadInput for what is none, and for an id that is given twice."""
    data = json_of(text, where)
    if isinstance(data, list):
        data = {"requirements": data}
    if not isinstance(data, dict):
        raise BadInput("this is no export of FRET", where=where, expected="requirements")
    rows = _rows(data, "requirements", where)
    seen: set[str] = set()
    for n, one in enumerate(rows):
        name = one.get("reqid")
        if not isinstance(name, str) or not name or name in seen:
            item = f"requirements[{n}].reqid"
            raise BadInput("no id of its own", where=where, item=item, got=str(name)[:60])
        seen.add(name)
    variables, defined = _variables(_rows(data, "variables", where), where)
    return Export(where, tuple(rows), variables, defined)


def _rows(data: Mapping[str, Any], key: str, where: str) -> list[Mapping[str, Any]]:
    rows = data.get(key, [])
    if not isinstance(rows, list) or any(not isinstance(one, dict) for one in rows):
        raise BadInput(
            "this is no export of FRET", where=where, item=key, expected="a list of objects"
        )
    return rows


def _variables(
    rows: Iterable[Mapping[str, Any]], where: str
) -> tuple[dict[str, Signal], dict[str, Meaning]]:
    """Of each name its kind, and its definition; what FRET knows of a model's ports has no use, and is passed over."""
    signals: dict[str, Signal] = {}
    defined: dict[str, Meaning] = {}
    for one in rows:
        name, use = one.get("variable_name"), one.get("idType")
        if not isinstance(name, str) or not name or not use:
            continue
        meaning = _definition(one)
        kind = _kind(one.get("dataType"))
        if meaning is None and kind is None:
            meaning = Unread("the export says no type of this variable")
        before = defined.get(name, signals.get(name))
        now = meaning if meaning is not None else Signal(kind or "")
        if before is not None and before != now:
            # of one component this, of another that: which is meant in a trace nobody knows
            now = Unread("the export declares this variable in two ways")
        signals.pop(name, None)
        if isinstance(now, Signal):
            signals[name] = now
        else:
            defined[name] = now
    return signals, defined


def _kind(of: Any) -> str | None:
    kinds = {**dict.fromkeys(BOOLS, "bool"), **dict.fromkeys(WHOLE, "int")}
    return {**kinds, **dict.fromkeys(REALS, "float")}.get(of) if isinstance(of, str) else None


def _definition(one: Mapping[str, Any]) -> Meaning | None:
    """What a variable is by its author's definition; None where it has none."""
    if one.get("idType") in ("Input", "Output"):  # FRET keeps what it was defined as before, unused
        return None
    if one.get("idType") == "Function":
        return Unread("this is a function")
    if one.get("modeRequirement"):
        return Unread("this is a mode that is defined by a formula")
    text = one.get("assignment")
    if not text:
        return None
    text = str(text).strip()
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    if DEFINED.fullmatch(text) is None:
        return Defined(
            "this variable is defined by a formula", text, _kind(one.get("dataType")) == "bool"
        )
    try:
        return number(text)
    except Wrong as no:
        return Unread(no.what)


def requirement(row: Mapping[str, Any], names: Names, where: str, *, timed: bool) -> Requirement:
    """One requirement of an export, or why it is not read. timed: as for `fretish_read.asked`."""
    name, sentence = str(row["reqid"]), " ".join(str(row.get(SENTENCE) or "").split())
    said = row.get("semantics")
    formulas = {k: str(v) for k, v in said.items() if v} if isinstance(said, dict) else {}
    left_out = _left_out(sentence, formulas, timed)
    first = None if left_out is None else (left_out, SENTENCE, sentence)
    for key, kind in _ways(timed) if left_out is None else ():
        text = sentence if key == SENTENCE else formulas.get(key, "")
        if not text:
            continue
        try:
            made = _asked(text, names, kind, timed)
            source = f"FRET, {row.get('project') or 'no project'}, {key}"
            return Requirement(name, sentence or text, made, source=source)
        except Wrong as no:
            first = first or (no, key, text)
    place = f"{where}, requirement {name}"
    if first is None:
        refused = NotRead("it has neither formula nor sentence", place, "", expected=SENTENCE)
        return Requirement(name, sentence, refused)
    wrong, key, text = first
    _, column, caret = caret_of(text, wrong.offset)
    where = f"{place}, {key}, column {column}"
    refused = NotRead(wrong.what, where, caret, expected=wrong.expected, got=wrong.got)
    return Requirement(name, sentence or text, refused)


def _left_out(sentence: str, formulas: Mapping[str, str], timed: bool) -> Wrong | None:
    """What the formulas of a requirement do not say of it, so that they may not be read for it."""
    if (found := PROBABLY.search(sentence)) or formulas.get("probability") == "bound":
        return Wrong("probabilities are not read", found.start() if found else 0)
    if not timed and (clock := CLOCK.search(sentence)):
        what = "samples are counted, so a time has no meaning"
        return Wrong(what, clock.start(1), "ticks, or a file *.req", clock[1])
    return None


def _ways(timed: bool) -> list[tuple[str, Kind | None]]:
    """In which order the texts of a requirement are tried."""
    counted = not timed
    ahead = [(key, Kind(True, counted, False)) for key in AHEAD]
    back = [(key, Kind(False, counted, False)) for key in BACK]
    late = [(key, Kind(True, counted, True)) for key in AHEAD]
    ways: list[tuple[str, Kind | None]] = [*ahead, *back, *late]
    return [(SENTENCE, None), *ways] if timed else [*ways, (SENTENCE, None)]


def _asked(text: str, names: Names, kind: Kind | None, timed: bool) -> Formula:
    if kind is None:
        return fretish_read.asked(text, names, timed)
    if UNFORMED in text:
        what = "FRET itself has not read this part of the sentence, so it has no formula"
        raise Wrong(what, text.index(UNFORMED), got=text[text.index(UNFORMED) + len(UNFORMED) :])
    return fret_formula.asked(text, names, kind)
