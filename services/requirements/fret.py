"""Import of FRET requirements: its JSON export, `{"requirements": [...], "variables": [...]}` or
only the list.

If samples are counted, a requirement is read from its formulas: future-time ones first, since they
tell which sample violates it, then past-time ones, then its sentence. If samples have times, the
sentence is read: formulas do not contain the unit of their bounds, so one is used only if it has no
bounds. What cannot be read is refused with the requirement, its formula and the position in it.
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
"""A duration in clock time instead of ticks."""
DEFINED = re.compile(r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?")
"""A definition that is a number; quotients such as `1/3` are refused."""
PROBABLY = re.compile(r"\bwith\s+probability\b", re.IGNORECASE)
UNFORMED = "<b><i>"
"""Marks text that FRET copied from a sentence without parsing it."""
BOOLS = ("boolean", "bool")
WHOLE = ("integer", "int", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
REALS = ("double", "single", "float", "real")


@dataclass(frozen=True)
class Export:
    """requirements: as in the file, each with an id; variables: declared signals with their type;
    and the definitions by the export's author.
    """

    where: str
    requirements: tuple[Mapping[str, Any], ...]
    variables: dict[str, Signal]
    defined: Mapping[str, Meaning]


def read(text: str, where: str = "FRET") -> Specification:
    """The requirements of an export over counted samples; its variables are the columns of the
    trace.

    Raises BadInput for a text that is no export, or if no requirement can be read.
    """
    export = read_export(text, where)
    names = with_definitions(Names(export.variables, export.defined, counted=True))
    made = tuple(requirement(one, names, export.where, timed=False) for one in export.requirements)
    if not made:
        raise BadInput("there is no requirement", where=where, expected="requirements")
    return Specification(dict(export.variables), made)


def read_export(text: str, where: str) -> Export:
    """The content of an export. Raises BadInput for an invalid file, and for an id that occurs twice."""
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
    """Signals by name with their type, and definitions by name; data on model ports are ignored."""
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
            # declared differently by two components: ambiguous for a trace
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
    """The author's definition of a variable; None if it has none."""
    if one.get("idType") in ("Input", "Output"):  # FRET keeps a former definition, which is unused
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
    """One requirement of an export, or the reason why it is not read. timed: as for `fretish_read.asked`."""
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
    """Reason why the formulas do not express the whole requirement and must not be used; None if they do."""
    if (found := PROBABLY.search(sentence)) or formulas.get("probability") == "bound":
        return Wrong("probabilities are not read", found.start() if found else 0)
    if not timed and (clock := CLOCK.search(sentence)):
        what = "samples are counted, so a time has no meaning"
        return Wrong(what, clock.start(1), "ticks, or a file *.req", clock[1])
    return None


def _ways(timed: bool) -> list[tuple[str, Kind | None]]:
    """The order in which the texts of a requirement are tried."""
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
