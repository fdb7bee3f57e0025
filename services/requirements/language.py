"""The product's requirements language: metric temporal logic over named signals with units.

Grammar: `language.lark`. Times are nanoseconds; numbers are exact and are converted to the unit of
the signal they are compared with; units of computed numbers are derived. Errors (another dimension,
an undeclared signal, a duplicate name) are refused with line, column and a caret.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.between_samples import NoBound, between
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
    signals,
)
from cratous.services.requirements.fret_import import (
    Files,
    imported,
    of_sentence,
    quantity,
    unit_at,
)
from cratous.services.requirements.fret_nodes import SIGNS, settle, settled, term
from cratous.services.requirements.fret_terms import Names, Wrong, value_in
from cratous.services.requirements.including import Parameters, Reach, Value, given_of
from cratous.services.requirements.language_tree import parsed, refuse_deep
from cratous.services.requirements.specification import (
    NotRead,
    Requirement,
    Signal,
    Specification,
    caret_of,
)
from cratous.services.requirements.units import NoUnit, dimension, in_unit, product
from cratous.spec.files.limits import CONFIG_BYTES, at_most

ARITHMETIC = (*SIGNS, "negative", "call")
ONE_SIDED: dict[str, Callable[[Formula, int, int], Formula]] = {
    "always": globally,
    "eventually": eventually,
    "historically": historically,
    "once": once,
}


def read(
    text: str, where: str = "requirements", files: Files | None = None, is_open: bool = False
) -> Specification:
    """The requirements of a text. Raises NotRead, with a caret, for invalid text.

    files: where imported files are found; None: imports are refused. An imported requirement that
    is not read stays in the list with the reason. is_open: parameters without a value are taken as
    1, for a file that is meant to be included and is only inspected.
    """
    at_most(len(text.encode()), CONFIG_BYTES, "the requirements are too long", where)
    shared = _Shared()
    reader = _read(text, where, _Reader(shared, Reach(files), is_open=is_open))
    if not shared.requirements:
        line, column, caret = caret_of(text, len(text.rstrip()))
        place = f"{where}, line {line}, column {column}"
        raise NotRead("there is no requirement", place, caret, expected="requirement ID: ...")
    return Specification(
        shared.used(reader.own), tuple(shared.requirements), True, shared.gap_ns, shared.period_ns,
        shared.begins_with_all,
    )  # fmt: skip


def _read(text: str, where: str, reader: _Reader) -> _Reader:
    """Read all statements of a file; NotRead with the position in this file."""
    try:
        refuse_deep(text)
        reader.take(text, parsed(text))
    except Wrong as no:
        raise _refused(no, text, where) from None
    if reader.wrong:
        first, *others = [_refused(no, text, where, name) for name, no in reader.wrong]
        first.problems = (first, *others)
        raise first
    return reader


def _refused(no: Wrong, text: str, where: str, name: str = "") -> NotRead:
    line, column, caret = caret_of(text, no.offset)
    place = f"{where}, line {line}, column {column}"
    return NotRead(no.what, place, caret, item=name, expected=no.expected, got=no.got)


class _Shared:
    """State shared by a file and all its includes; signals by their names in the file."""

    def __init__(self) -> None:
        self.signals: dict[str, Signal] = {}
        self.requirements: list[Requirement] = []
        self.period_ns = self.gap_ns = 0
        self.begins_with_all = False

    def used(self, own: set[str]) -> dict[str, Signal]:
        """The signals without those of included files that no requirement uses."""
        read = {
            name
            for one in self.requirements
            if not isinstance(one.formula, NotRead)
            for name in (*signals(one.formula), *signals(one.judged))
        }
        kept = own | read | sources(read, self.signals)
        return {name: one for name, one in self.signals.items() if name in kept}


class _Reader:
    """Reader of one file. prefix: of its names; given: the values of its parameters."""

    def __init__(
        self,
        shared: _Shared,
        reach: Reach,
        prefix: str = "",
        given: Mapping[str, tuple[Value, Any]] | None = None,
        is_open: bool = False,
    ) -> None:
        self.shared, self.reach, self.prefix = shared, reach, prefix
        self.signals = shared.signals
        self.parameters = Parameters(given or {}, is_open)
        self.visible: dict[str, str] = {}
        """Signal names by the names that this file uses for them."""
        self.own: set[str] = set()
        self.wrong: list[tuple[str, Wrong]] = []
        """Invalid requirements by id, with the reason."""

    def take(self, text: str, tree: Any) -> None:
        """Read all statements of the file."""
        self.text = text
        items: dict[str, list[Any]] = {}
        for item in tree.children:
            items.setdefault(str(item.data), []).append(item)
        for item in items.get("parameter", ()):
            self.parameters.declare(item)
        self.parameters.refuse_others()
        for n, item in enumerate(items.get("trace", ())):
            self._trace(item, again=n > 0)
        # signals may be declared after their use
        for item in items.get("signal", ()):
            self._signal(item)
        for item in items.get("include", ()):
            self._include(item)
        names = Names(self.signals, self.visible, real=True)
        for item in tree.children:
            if item.data == "requirement":
                try:
                    self._requirement(item, names)
                except Wrong as no:
                    self.wrong.append((f"{self.prefix}{item.children[0]}", no))
            elif item.data == "import":
                known = Names(self.signals, self.visible)
                for one in imported(item, known, self.reach.files, self.reach.folder):
                    self._add(one, item.children[1])

    def _include(self, item: Any) -> None:
        token, parts = item.children[0], {str(p.data): p.children for p in item.children[1:]}
        given = given_of(parts.get("values", ()), self.parameters)
        reach, text = self.reach.include(token)
        alias = f"{parts['alias'][0]}." if "alias" in parts else ""
        if "." in alias[:-1]:
            raise Wrong("this is no plain name", parts["alias"][0].start_pos, got=alias[:-1])
        before = len(self.shared.requirements)
        child = _read(text, reach.where, _Reader(self.shared, reach, self.prefix + alias, given))
        for name, full in child.visible.items():
            if self.visible.setdefault(alias + name, full) != full:
                raise Wrong("a signal is declared twice", token.start_pos, got=alias + name)
        there = self.shared.requirements[before:]
        wanted = [(str(one).strip('"'), one.start_pos) for one in parts.get("only", ())]
        start = self.prefix + alias
        by_name = {one.name.removeprefix(start): one for one in there}
        for name, at in wanted:
            if name not in by_name:
                known = ", ".join(list(by_name)[:8]) or "it has none"
                raise Wrong("the file has no such requirement", at, known, name)
        if wanted:
            self.shared.requirements[before:] = [by_name[name] for name, _ in wanted]

    def _trace(self, item: Any, again: bool) -> None:
        at, shared = _offset(item), self.shared
        begins = item.children[-1].data == "begins"
        times = [self._duration(one) for one in item.children if one.data != "begins"]
        period, gap = times[0], times[-1] if len(times) > 1 else 0
        told = (shared.period_ns, shared.gap_ns, shared.begins_with_all)
        if again or (shared.period_ns and told != (period, gap, begins)):
            raise Wrong("the trace is described twice", at)
        shared.period_ns, shared.gap_ns, shared.begins_with_all = period, gap, begins
        if not period or (gap and gap < period):
            raise Wrong("these are no times between samples", at, "0 < every <= gap")

    def _signal(self, item: Any) -> None:
        names = [t for t in item.children if getattr(t, "type", "") == "NAME"]
        (kind,) = [t for t in item.children if getattr(t, "type", "") in ("UNIT", "BOOL")]
        subs = {str(t.data): t for t in item.children if hasattr(t, "data")}
        origin: tuple[str, tuple[tuple[str, str], ...], str] = ("", (), "")
        word = ""
        if "origin" in subs:
            place, *words = subs["origin"].children
            origin, word = self._origin(place), str(words[0]) if words else ""
            if word and kind.type != "BOOL":
                raise Wrong("that a field is a word is true or false", words[0].start_pos, "bool")
        hold = self._duration(subs["hold"].children[0]) if "hold" in subs else 0
        for name in names:
            full = f"{self.prefix}{name}"
            if full in self.signals:
                raise Wrong("a signal is declared twice", name.start_pos, got=str(name))
            if "." in str(name):
                raise Wrong("a signal has no dot in its name", name.start_pos, got=str(name))
            of, unit = ("bool", "") if kind.type == "BOOL" else ("float", unit_at(kind))
            rate = self._rate(subs["rate"].children[0], unit) if "rate" in subs else Fraction(0)
            self.signals[full] = Signal(of, unit, *origin, hold_ns=hold, word=word, rate=rate)
            self.visible[str(name)] = full
            self.own.add(full)

    def _rate(self, node: Any, unit: str) -> Fraction:
        """Maximum change of a signal of a unit per second."""
        at = node.children[0]
        given = self.parameters.number(at) if node.data == "given" else quantity(*node.children)
        try:
            a_second = replace(given, unit=product(given.unit, "s"))
        except NoUnit as no:
            raise Wrong(str(no), at.start_pos) from None
        if not unit or dimension(a_second.unit) != dimension(unit) or given.value <= 0:
            expected = f"{unit}/s, above 0" if unit else "no rate of a truth value"
            raise Wrong("this is no rate of the signal", at.start_pos, expected, given.text)
        if not self.shared.gap_ns:
            expected = "trace every ... gap ..."
            raise Wrong("nothing says how far samples are apart", at.start_pos, expected)
        return in_unit(a_second, unit)

    def _requirement(self, item: Any, names: Names) -> None:
        name = item.children[0]
        said = {str(t.data): str(t.children[0]).strip('"') for t in item.children[1:-1]}
        asked = item.children[-1]
        formula = (
            of_sentence(asked.children[1], Names(self.signals, self.visible))
            if asked.data == "fretish"
            else self._formula(asked, names)
        )
        text = " ".join(self.text[item.meta.start_pos : item.meta.end_pos].split())
        made = Requirement(
            str(name), self.parameters.put_in(text), formula, said.get("title", ""), said.get("severity", ""),
            said.get("source", ""),
        )  # fmt: skip
        self._add(made, name)

    def _add(self, made: Requirement, at: Any) -> None:
        made = replace(made, name=f"{self.prefix}{made.name}")
        if any(one.name == made.name for one in self.shared.requirements):
            raise Wrong("a requirement's id is given twice", at.start_pos, got=made.name)
        if not isinstance(made.formula, NotRead):
            try:
                judged = between(made.formula, self.signals, self.shared.gap_ns)
            except NoBound as no:
                expected = "sums, and factors that are numbers, of signals with a rate"
                raise Wrong(str(no), at.start_pos, expected) from None
            made = replace(made, between=judged)
        self.shared.requirements.append(made)

    def _formula(self, tree: Any, names: Names) -> Formula:
        settle(tree, False)
        settled(tree)
        made: Formula = FALSE
        for node in tree.iter_subtrees():  # children before parents
            made = node.made = self._made(node, names)
        return made

    def _made(self, node: Any, names: Names) -> Any:
        got = [getattr(child, "made", child) for child in node.children]
        kind = str(node.data)
        if kind == "duration":
            return self._duration(node)
        if kind in ("within", "between"):
            return self._window(got, _offset(node))
        if kind == "name":
            return self._known(got[0], "a unit")
        if kind == "quantity":
            return quantity(*got)
        if kind == "given":
            return self.parameters.number(got[0])
        if kind in ARITHMETIC:
            got = (
                ["absReal" if str(one) == "abs" else one for one in got] if kind == "call" else got
            )
            return term(kind, got, names, _offset(node))
        if kind == "truth":
            return self._truth(got[0])
        if kind == "constant":
            return TRUE if got[0] == "true" else FALSE
        if kind == "compare":
            return self._compared(got[0], got[1], got[2], names)
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
        number, unit = node.children[0], node.children[-1]
        one = self.parameters.number(number) if unit is number else quantity(number, unit)
        if dimension(one.unit) != "time":
            raise Wrong("this is no time", unit.start_pos, "ns, us, ms, s, min or h", one.unit)
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

    def _known(self, token: Any, wanted: str) -> str:
        """The global name of a signal, by the name that this file uses."""
        full = self.visible.get(str(token), "")
        found = self.signals.get(full)
        if found is None or (found.kind == "bool") != (wanted == "bool"):
            kinds = {name: self.signals[full].kind for name, full in self.visible.items()}
            known = sorted(n for n in kinds if (kinds[n] == "bool") == (wanted == "bool"))
            expected = f"a signal declared as {wanted}: {', '.join(known[:8]) or 'there is none'}"
            raise Wrong("this is no such signal", token.start_pos, expected, str(token))
        return full

    def _truth(self, token: Any) -> Formula:
        return Reaches(self._known(token, "bool"), 1.0)

    def _compared(self, left: Any, relation: Any, right: Any, names: Names) -> Formula:
        at = relation.start_pos
        sides = [names.named(side) for side in (left, right)]
        units = [self.signals[side].unit for side in sides if isinstance(side, str)]
        if not units:
            raise Wrong("no signal is compared", at, "a signal on one side")
        names.refuse_units(units, at)
        one, other = (s if isinstance(s, str) else value_in(s, units[0], at) for s in sides)
        return compared(one, str(relation), other)

    def _origin(self, token: Any) -> tuple[str, tuple[tuple[str, str], ...], str]:
        """The message type, the required field values, and the field of `TYPE[FIELD=VALUE].FIELD`."""
        message, _, rest = str(token).partition("[")
        inside, _, field = rest.partition("].")
        chosen = []
        for part in filter(None, (piece.strip() for piece in inside.split(","))):
            name, is_given, value = (piece.strip() for piece in part.partition("="))
            if not (name and is_given and value):
                raise Wrong("this chooses no message", token.start_pos, "FIELD=VALUE", part)
            if value.startswith("$"):
                at = token.update(value=value)
                id_or_number = self.parameters.of(at)
                if not isinstance(id_or_number, str):
                    expected = "a parameter that is an id"
                    raise Wrong("this chooses no message", token.start_pos, expected, value)
                value = id_or_number
            chosen.append((name, value))
        return message, tuple(chosen), field


def _offset(node: Any) -> int:
    return int(node.meta.start_pos)
