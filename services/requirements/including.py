"""Includes of requirements files: where their texts are found, their parameters, and limits on
nesting.

    include "common/link.req" as link_1 with vehicle is 1, limit is 2 s
    include "link" as link_2 only UP with vehicle is 2

A name that ends with `.req` is a file, by its path relative to the including file; any other is a
library of the product.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.services.requirements.fret_import import Files, quantity, unit_at
from cratous.services.requirements.fret_terms import Wrong
from cratous.services.requirements.units import Quantity, dimension, in_unit
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES
from cratous.spec.files.text_file import text_of

SUFFIX, LIBRARY = ".req", "library "
FOLDER = Path(__file__).with_name("library")
DEEPEST, MOST = 8, 50
"""Maximum nesting of includes, and maximum number of included files."""
Value = Quantity | str
"""Value of a parameter: a number with its unit, or the digits of an id."""


def libraries() -> list[str]:
    """The names of the product's libraries."""
    return sorted(file.stem for file in FOLDER.glob(f"*{SUFFIX}"))


def library_text(name: str) -> str:
    """The text of a library; BadInput if there is none of this name."""
    if name not in libraries():
        expected = f"{', '.join(libraries())}, or a file *{SUFFIX}"
        raise BadInput("there is no such library", item=name[:60], expected=expected)
    return text_of(FOLDER / f"{name}{SUFFIX}", CONFIG_BYTES, "a library of requirements")


@dataclass
class Reach:
    """What one requirements file may still include. chain: the files from the first (named "") to
    this one; taken: number of files so far; size: their characters.
    """

    files: Files | None
    chain: tuple[str, ...] = ("",)
    counts: dict[str, int] = field(default_factory=lambda: {"taken": 0, "size": 0})

    @property
    def folder(self) -> str:
        """The folder of the file, relative to that of the first."""
        return posixpath.dirname(self.chain[-1])

    @property
    def where(self) -> str:
        """The file's name for messages."""
        name, folder = self.chain[-1], getattr(self.files, "folder", self.files)
        if isinstance(folder, Path) and not name.startswith(LIBRARY):
            return str(folder / name)
        return name

    def include(self, token: Any) -> tuple[Reach, str]:
        """(state for the included file, its text). Raises Wrong for recursive includes, exceeded
        limits and names that are no requirements files; BadInput for a missing file.
        """
        said, at = str(token).strip('"'), token.start_pos
        if self.files is None:
            raise Wrong("a text that lies in no folder imports nothing", at)
        name = self._name(said, at)
        if name in self.chain:
            raise Wrong("a file includes itself", at, got=" > ".join([*self.chain[1:], name]))
        self.counts["taken"] += 1
        if len(self.chain) > DEEPEST or self.counts["taken"] > MOST:
            expected = f"{DEEPEST} levels and {MOST} files"
            raise Wrong("too much is included", at, expected, name)
        text = self._text(name)
        self.counts["size"] += len(text)
        if self.counts["size"] > CONFIG_BYTES:
            raise Wrong("what is included is too long", at, f"{CONFIG_BYTES} characters", name)
        return Reach(self.files, (*self.chain, name), self.counts), text

    def _name(self, said: str, at: int) -> str:
        if not said.endswith(SUFFIX):
            return f"{LIBRARY}{said}"
        if self.chain[-1].startswith(LIBRARY):
            raise Wrong("a library includes libraries alone", at, ", ".join(libraries()), said)
        if said.startswith("/") or re.search(r"[\\:\x00]", said):
            raise Wrong("this is no path from here", at, "as common/link.req", said)
        return posixpath.normpath(posixpath.join(self.folder, said))

    def _text(self, name: str) -> str:
        assert self.files is not None
        if isinstance(self.files, Path):
            return text_at(self.files, name)
        if name not in self.files:
            known = ", ".join(list(self.files)[:8]) or "none is there"
            raise BadInput("the file that is included is not there", item=name, expected=known)
        return self.files[name]


def text_at(folder: Path, name: str) -> str:
    """The text of an included file, by its path relative to a folder, or of a library."""
    if name.startswith(LIBRARY):
        return library_text(name.removeprefix(LIBRARY))
    return text_of(folder / name, CONFIG_BYTES, "requirements that are included")


class Parameters:
    """The parameters of one file, with values from the include or from their defaults."""

    def __init__(self, given: Mapping[str, tuple[Value, Any]], is_open: bool = False) -> None:
        """given: values by name, with the position of each; is_open: parameters without a value are
        taken as 1, for a file that is only inspected.
        """
        self.given, self.is_open = given, is_open
        self.values: dict[str, Value] = {}

    def declare(self, item: Any) -> None:
        """Declare a parameter; Wrong if it has no value, or one of another kind."""
        name, kind = item.children[0], item.children[1]
        if str(name) in self.values or "." in str(name):
            raise Wrong("a parameter is declared twice, or has no plain name", name.start_pos)
        own = quantity(*item.children[2].children) if len(item.children) > 2 else None
        value, at = self.given.get(str(name), (own, name))
        if value is None and self.is_open:
            value = (
                "1" if kind.type == "NUMERAL" else Quantity(Fraction(1), unit_at(kind), f"1 {kind}")
            )
        if value is None:
            expected = f"parameter {name}: {kind} is VALUE, or include ... with {name} is VALUE"
            raise Wrong("nothing gives this parameter a value", name.start_pos, expected)
        self.values[str(name)] = _fitting(value, kind, at)

    def refuse_others(self) -> None:
        """Wrong for a given value without a declared parameter."""
        for name, (_, at) in self.given.items():
            if name not in self.values:
                known = ", ".join(self.values) or "it has none"
                raise Wrong("the file has no such parameter", at.start_pos, known, name)

    def of(self, token: Any) -> Value:
        """The value of `$name`; Wrong if there is no such parameter."""
        name = str(token)[1:]
        if name not in self.values:
            known = ", ".join(f"${one}" for one in self.values) or "there is none"
            raise Wrong("this is no parameter", token.start_pos, known, str(token))
        return self.values[name]

    def number(self, token: Any) -> Quantity:
        """The value of `$name` where a number with a unit is needed."""
        value = self.of(token)
        if isinstance(value, str):
            raise Wrong("an id is no number", token.start_pos, "a parameter with a unit", value)
        return value

    def put_in(self, text: str) -> str:
        """A text with its parameter names replaced by their values."""
        return re.sub(r"\$([A-Za-z_][A-Za-z0-9_]*)", self._said, text)

    def _said(self, found: re.Match[str]) -> str:
        value = self.values.get(found[1])
        if value is None:
            return found[0]
        return value if isinstance(value, str) else value.text


def given_of(item: Any, parameters: Parameters) -> dict[str, tuple[Value, Any]]:
    """The values that an include gives, by name; Wrong if one is given twice."""
    found: dict[str, tuple[Value, Any]] = {}
    for one in item:
        name, what = one.children
        if str(name) in found:
            raise Wrong("a value is given twice", name.start_pos, got=str(name))
        is_tree = hasattr(what, "data")
        found[str(name)] = quantity(*what.children) if is_tree else parameters.of(what), name
    return found


def _fitting(value: Value, kind: Any, at: Any) -> Value:
    if kind.type == "NUMERAL":
        text = value if isinstance(value, str) else value.text.removesuffix(" 1")
        if not re.fullmatch("[0-9]{1,18}", text):
            raise Wrong("this is no id", at.start_pos, "digits", text)
        return text
    if isinstance(value, str):
        raise Wrong("an id is no number", at.start_pos, f"a number in {kind}", value)
    unit = unit_at(kind)
    if dimension(value.unit) != dimension(unit):
        expected = f"{dimension(unit)}, as {unit}"
        raise Wrong("units that do not fit", at.start_pos, expected, value.unit)
    return Quantity(in_unit(value, unit), unit, value.text)
