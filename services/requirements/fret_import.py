"""Imports of FRET in a requirements file: exports, with a mapping of their variables, and FRETish
sentences.

    fret "export.json" only ALT-1, ALT-2 with alt is altitude_1, floor is 90 m
    requirement ALT-3: fretish "Whenever armed the system shall within 5 seconds satisfy alt >= 90.0"

A variable not named in `with` is the signal of the same name; a number defined in the export stays
one, in the unit of what it is compared with.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.services.requirements import fret, fretish_read
from cratous.services.requirements.formula import Formula
from cratous.services.requirements.fret_definitions import with_definitions
from cratous.services.requirements.fret_terms import Meaning, Names, Wrong
from cratous.services.requirements.specification import Requirement
from cratous.services.requirements.units import NoUnit, Quantity, of_text
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DIGITS, DOCUMENT_BYTES
from cratous.spec.files.text_file import text_of


def of_sentence(token: Any, names: Names) -> Formula:
    """The requirement of a sentence in quotes; Wrong, with the position in the file, if it cannot be read."""
    try:
        return fretish_read.asked(_text(token), names, timed=True)
    except Wrong as no:
        raise Wrong(no.what, token.start_pos + 1 + no.offset, no.expected, no.got) from None


Files = Path | Mapping[str, str]
"""Where imported files are found: a folder, or their texts by name."""


def imported(
    item: Any, known: Names, files: Files | None, folder: str = ""
) -> Iterator[Requirement]:
    """The requirements that an import names, or all of the export; one that is not read states why.

    known: the signals; folder: that of the importing file, relative to `files`. Raises Wrong for
    ids that are not in the export, BadInput for an invalid file.
    """
    token = item.children[1]
    if files is None:
        raise Wrong("a text that lies in no folder imports nothing", token.start_pos)
    parts = {str(one.data): one.children for one in item.children[2:]}
    export = fret.read_export(*_export(files, posixpath.join(folder, _text(token))))
    bound = _bound(parts.get("variables", ()), known)
    names = with_definitions(Names(known.signals, {**known.bound, **export.defined, **bound}))
    rows = {str(one["reqid"]): one for one in export.requirements}
    wanted = [(_text(one), one.start_pos) for one in parts.get("only", ())]
    for name, at in wanted or [(name, token.start_pos) for name in rows]:
        if name not in rows:
            there = ", ".join(list(rows)[:8]) or "it has none"
            raise Wrong("the export has no such requirement", at, there, name)
        yield fret.requirement(rows[name], names, export.where, timed=True)


def _export(files: Files, name: str) -> tuple[str, str]:
    """(text of an export, its location)."""
    if not isinstance(files, Path):
        if name not in files:
            known = ", ".join(list(files)[:8]) or "none is there"
            raise BadInput("the export is not there", item=name, expected=known)
        return files[name], name
    return text_of(files / name, DOCUMENT_BYTES, "an export of FRET"), str(files / name)


def _bound(variables: Any, known: Names) -> dict[str, Meaning]:
    found: dict[str, Meaning] = {}
    for one in variables:
        token, what = one.children
        name = _text(token)
        if name in found:
            raise Wrong("a variable is given twice", token.start_pos, got=name)
        if getattr(what, "data", "") == "quantity":
            found[name] = quantity(*what.children)
        elif what.type == "CONSTANT":
            found[name] = str(what) == "true"
        elif str(what) in known.bound:
            found[name] = known.bound[str(what)]
        else:
            said = ", ".join(sorted(known.bound)[:8]) or "there is none"
            raise Wrong("this is no signal", what.start_pos, said, str(what))
    return found


def _text(token: Any) -> str:
    return str(token).strip('"')


def quantity(number: Any, unit: Any = "1") -> Quantity:
    """A number with its unit, as written; Wrong if it is too long."""
    mantissa, _, exponent = str(number).lower().partition("e")
    if len(mantissa) > DIGITS or len(exponent) > 4 or abs(int(exponent or "0")) > DIGITS:
        raise Wrong("the number is too long", number.start_pos, f"up to {DIGITS} digits")
    return Quantity(Fraction(str(number)), unit_at(unit), f"{number} {unit}")


def unit_at(token: Any) -> str:
    """The canonical unit of a token; Wrong if it is no unit."""
    try:
        return of_text(str(token))
    except NoUnit as no:
        raise Wrong(str(no), token.start_pos) from None
