"""The product's language of requirements: metric temporal logic over named signals with units.

Grammar: `language.lark`. Times are nanoseconds; a number is taken exactly and turned into the unit of the
signal that it is compared with. What does not fit (another dimension, a signal that is not declared, a
name given twice) is refused with its line, its column and a caret.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cratous.services.requirements.formula import (
    FALSE,
    MAX_TIME,
    TRUE,
    Bounded,
    Formula,
    Join,
    Not,
    Reaches,
    compared,
    eventually,
    globally,
    historically,
    iff,
    implies,
    once,
)
from cratous.services.requirements.fret_import import Files, imported, of_sentence, quantity
from cratous.services.requirements.fret_terms import Wrong, value_in
from cratous.services.requirements.specification import (
    NotRead,
    Requirement,
    Signal,
    Specification,
    caret_of,
)
from cratous.services.requirements.units import Quantity, dimension, in_unit
from cratous.spec.files.limits import CONFIG_BYTES, at_most

if TYPE_CHECKING:
    from lark import Lark

NESTED = 200
ONE_SIDED: dict[str, Callable[[Formula, int, int], Formula]] = {
    "always": globally,
    "eventually": eventually,
    "historically": historically,
    "once": once,
}


def read(text: str, where: str = "requirements", files: Files | None = None) -> Specification:
    """The requirements of a text. Raises NotRead, with a caret, for what is outside of the language.

    files: where files that it imports lie; None: it may import none. Of these a requirement that is not read
    stands among the others, and says why.
    """
    at_most(len(text.encode()), CONFIG_BYTES, "the requirements are too long", where)
    try:
        _refuse_deep(text)
        return _Reader(text, files).specification(_parsed(text))
    except Wrong as no:
        line, column, caret = caret_of(text, no.offset)
        place = f"{where}, line {line}, column {column}"
        raise NotRead(no.what, place, caret, expected=no.expected, got=no.got) from None


def _refuse_deep(text: str) -> None:
    depth = 0
    for found in re.finditer(r'"[^"\n]*"|#[^\n]*|[()]', text):
        depth += {"(": 1, ")": -1}.get(found.group(), 0)
        if depth > NESTED:
            raise Wrong("the formula is nested too deeply", found.start(), f"{NESTED} levels")


def _parsed(text: str) -> Any:
    from lark.exceptions import UnexpectedCharacters, UnexpectedInput

    try:
        return _parser().parse(text)
    except UnexpectedInput as error:
        offset = error.pos_in_stream if error.pos_in_stream is not None else len(text)
        token = None if isinstance(error, UnexpectedCharacters) else getattr(error, "token", None)
        if offset < 0 or (token is not None and token.type == "$END"):
            offset, token = len(text.rstrip()), None
        got = str(token or text[offset : offset + 1]) or "the end of the file"
        known = sorted(getattr(error, "expected", None) or getattr(error, "allowed", None) or ())
        raise Wrong("this cannot stand here", offset, _in_words(known), got) from None


WORDS = {
    "UNIT": "a unit", "NAME": "a name", "NUMBER": "a number", "RELATION": "a comparison",
    "ID": "the requirement's id", "ORIGIN": "TYPE[FIELD=VALUE].FIELD", "BOOL": "bool",
    "UNARY": "always, eventually, historically or once", "BINARY": "until or since",
    "STRING": "a text in quotes", "LPAR": "(", "RPAR": ")", "COLON": ":", "COMMA": ",",
    "CONSTANT": "true or false", "$END": "the end of the file",
}  # fmt: skip


def _in_words(known: list[str]) -> str:
    return ", ".join(WORDS.get(name, name.lower()) for name in known[:12])


class _Reader:
    def __init__(self, text: str, files: Files | None) -> None:
        self.text, self.files = text, files
        self.signals: dict[str, Signal] = {}
        self.requirements: list[Requirement] = []
        self.period_ns = self.gap_ns = 0
        self.begins_with_all = False

    def specification(self, tree: Any) -> Specification:
        # signals may be declared after what uses them
        for item in tree.children:
            if item.data == "signal":
                self._signal(item)
            elif item.data == "trace":
                self._trace(item)
        for item in tree.children:
            if item.data == "requirement":
                self._requirement(item)
            elif item.data == "import":
                for one in imported(item, self.signals, self.files):
                    self._add(one, item.children[1])
        if not self.requirements:
            raise Wrong("there is no requirement", len(self.text.rstrip()), "requirement ID: ...")
        return Specification(
            self.signals, tuple(self.requirements), True, self.gap_ns, self.period_ns,
            self.begins_with_all,
        )  # fmt: skip

    def _trace(self, item: Any) -> None:
        at = _offset(item)
        if self.period_ns:
            raise Wrong("the trace is described twice", at)
        self.begins_with_all = item.children[-1].data == "begins"
        times = [self._duration(one) for one in item.children if one.data != "begins"]
        self.period_ns, self.gap_ns = times[0], times[-1] if len(times) > 1 else 0
        if not self.period_ns or (self.gap_ns and self.gap_ns < self.period_ns):
            raise Wrong("these are no times between samples", at, "0 < every <= gap")

    def _signal(self, item: Any) -> None:
        names = [t for t in item.children if getattr(t, "type", "") == "NAME"]
        (kind,) = [t for t in item.children if getattr(t, "type", "") in ("UNIT", "BOOL")]
        subs = {str(t.data): t for t in item.children if hasattr(t, "data")}
        origin: tuple[str, tuple[tuple[str, str], ...], str] = ("", (), "")
        word = ""
        if "origin" in subs:
            place, *words = subs["origin"].children
            origin, word = _origin(place), str(words[0]) if words else ""
            if word and kind.type != "BOOL":
                raise Wrong("that a field is a word is true or false", words[0].start_pos, "bool")
        hold = self._duration(subs["hold"].children[0]) if "hold" in subs else 0
        for name in names:
            if str(name) in self.signals:
                raise Wrong("a signal is declared twice", name.start_pos, got=str(name))
            of, unit = ("bool", "") if kind.type == "BOOL" else ("float", str(kind))
            self.signals[str(name)] = Signal(of, unit, *origin, hold_ns=hold, word=word)

    def _requirement(self, item: Any) -> None:
        name = item.children[0]
        said = {str(t.data): str(t.children[0]).strip('"') for t in item.children[1:-1]}
        asked = item.children[-1]
        formula = (
            of_sentence(asked.children[1], self.signals)
            if asked.data == "fretish"
            else self._formula(asked)
        )
        text = " ".join(self.text[item.meta.start_pos : item.meta.end_pos].split())
        made = Requirement(
            str(name), text, formula, said.get("title", ""), said.get("severity", ""),
            said.get("source", ""),
        )  # fmt: skip
        self._add(made, name)

    def _add(self, made: Requirement, at: Any) -> None:
        if any(one.name == made.name for one in self.requirements):
            raise Wrong("a requirement's id is given twice", at.start_pos, got=made.name)
        self.requirements.append(made)

    def _formula(self, tree: Any) -> Formula:
        made: Formula = FALSE
        for node in tree.iter_subtrees():  # parts before the whole
            made = node.made = self._made(node)
        return made

    def _made(self, node: Any) -> Any:
        got = [getattr(child, "made", child) for child in node.children]
        kind = str(node.data)
        if kind == "duration":
            return self._duration(node)
        if kind in ("within", "between"):
            return self._window(got, _offset(node))
        if kind == "name":
            return got[0]
        if kind == "quantity":
            return quantity(*got)
        if kind == "truth":
            return self._truth(got[0])
        if kind == "constant":
            return TRUE if got[0] == "true" else FALSE
        if kind == "compare":
            return self._compared(*got)
        if kind == "negation":
            return Not(got[0])
        if kind == "unary":
            return ONE_SIDED[str(got[0])](got[2], *got[1])
        if kind == "binary":
            phi, operator, (low, high), psi = got
            return Bounded(phi, psi, low, high, operator == "since")
        if kind in ("either", "both"):
            return Join(got[0], got[1], kind == "both")
        return (iff if kind == "iff" else implies)(got[0], got[1])

    def _duration(self, node: Any) -> int:
        number, unit = node.children
        one = quantity(number, unit)
        if dimension(one.unit) != "time":
            raise Wrong("this is no time", unit.start_pos, "ns, us, ms, s, min or h", str(unit))
        value = in_unit(one, "ns")
        if value.denominator != 1 or not 0 <= value <= MAX_TIME:
            expected = f"whole nanoseconds from 0 to {MAX_TIME}"
            raise Wrong("this time cannot be taken exactly", number.start_pos, expected, one.text)
        return int(value)

    def _window(self, got: list[int], at: int) -> tuple[int, int]:
        low, high = got if len(got) > 1 else (0, got[0])
        if low > high:
            raise Wrong("these bounds are empty", at, "from the earlier to the later")
        return low, high

    def _known(self, token: Any, wanted: str) -> Signal:
        found = self.signals.get(str(token))
        if found is None or (found.kind == "bool") != (wanted == "bool"):
            declared = {n: s.kind for n, s in self.signals.items() if s.made is None}
            known = sorted(n for n in declared if (declared[n] == "bool") == (wanted == "bool"))
            expected = f"a signal declared as {wanted}: {', '.join(known[:8]) or 'there is none'}"
            raise Wrong("this is no such signal", token.start_pos, expected, str(token))
        return found

    def _truth(self, token: Any) -> Formula:
        self._known(token, "bool")
        return Reaches(str(token), 1.0)

    def _compared(self, left: Any, relation: Any, right: Any) -> Formula:
        sides = [left, right]
        units = {}
        for k, side in enumerate(sides):
            if not isinstance(side, Quantity):
                units[k] = self._known(side, "a unit").unit
        if not units:
            raise Wrong("no signal is compared", relation.start_pos, "a signal on one side")
        unit = units[min(units)]
        values: list[str | float] = []
        for k, side in enumerate(sides):
            other = units.get(k) or side.unit
            if dimension(other) != dimension(unit):
                expected = f"{dimension(unit)}, as {unit}"
                raise Wrong("units that do not fit", relation.start_pos, expected, other)
            if k in units and other != unit:
                raise Wrong("signals of two units are compared", relation.start_pos, unit, other)
            values.append(str(side) if k in units else value_in(side, unit, relation.start_pos))
        return compared(values[0], str(relation), values[1])


def _offset(node: Any) -> int:
    return int(node.meta.start_pos)


def _origin(token: Any) -> tuple[str, tuple[tuple[str, str], ...], str]:
    """The message type, what its fields must be, and the field, of `TYPE[FIELD=VALUE].FIELD`."""
    message, _, rest = str(token).partition("[")
    inside, _, field = rest.partition("].")
    chosen = []
    for part in filter(None, (piece.strip() for piece in inside.split(","))):
        name, is_given, value = (piece.strip() for piece in part.partition("="))
        if not (name and is_given and value):
            raise Wrong("this chooses no message", token.start_pos, "FIELD=VALUE", part)
        chosen.append((name, value))
    return message, tuple(chosen), field


@cache
def _parser() -> Lark:
    from lark import Lark

    grammar = Path(__file__).with_name("language.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", propagate_positions=True, maybe_placeholders=False)
