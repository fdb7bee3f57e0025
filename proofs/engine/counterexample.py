"""Counterexamples in the user's terms: the kernel's arguments with names, units and meaning.

`Watched` is a claim that records which kernels and definitions it ran on which values. For a refuted obligation the
solver's model gives each argument a number; names, units and meaning come from the kernel's signature and docstring.
Kernel and definition are then run on these numbers, and their results are printed beside the values of the proof, so
that a reader sees whether the kernel is wrong or a lemma or contract too weak.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import zip_longest
from typing import Any

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.solver_order import check
from cratous.proofs.engine.symbolic import Sym

UNITS = {
    "_m": "m", "_s": "s", "_ms": "ms", "_rad": "rad", "_deg": "deg", "_mps": "m/s", "_m2": "m^2",
}  # fmt: skip
WORDS = {
    "violat": ("violated", "clear"),
    "meet": ("they meet", "they do not meet"),
    "on_segment": ("on it", "not on it"),
    "accepts": ("accepted", "dropped"),
    "eligible": ("eligible", "not eligible"),
}
DIGITS = 12
TELLING_RLIMIT = 400_000


@dataclass(frozen=True)
class Run:
    """One kernel or definition that a claim ran: its symbolic arguments and its result."""

    role: str
    function: Callable[..., Any]
    args: tuple[Any, ...]
    value: Any


@dataclass
class Watched(Claim):
    """A claim that records the kernels and definitions it ran."""

    runs: list[Run] = field(default_factory=list)
    folds: list[Fold[Any]] = field(default_factory=list)

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        value = super().use(kernel, *args, when=when)
        self.runs.append(Run("kernel", kernel, args, value))
        return value

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        value = super().define(definition, *args)
        self.runs.append(Run("definition", definition, args, value))
        return value

    def fold(self, kernel_fold: Fold[Any], **parts: Any) -> None:
        self.folds.append(kernel_fold)
        super().fold(kernel_fold, **parts)


# -- what a signature and a docstring say ----------------------------------------------------
@dataclass(frozen=True)
class Meaning:
    """An argument's unit and description, as far as the docstring gives them."""

    unit: str = ""
    text: str = ""


def meanings(function: Callable[..., Any]) -> dict[str, Meaning]:
    """Unit and meaning of every argument: from `name: text [unit]` in the docstring, else from a name ending in
    `_m`."""
    names = list(inspect.signature(function).parameters)
    found = {name: Meaning(_suffix_unit(name)) for name in names}
    body = " ".join((inspect.getdoc(function) or "").split("\n\n")[-1].split())
    # an entry begins at a list of argument names with a colon
    listed = "|".join(re.escape(name) for name in names)
    starts = list(re.finditer(rf"\b((?:{listed})(?:, (?:{listed}))*): ", body)) if listed else []
    for here, after in zip_longest(starts, starts[1:]):
        entry = body[here.end() : after.start() if after else len(body)].split(";")[0]
        unit = re.search(r"\[([^\],]+)\]", entry)
        text = re.split(r"\[|, >|\. ", entry)[0].strip(" .,")
        for name in here.group(1).split(", "):
            own = unit.group(1) if unit else _suffix_unit(name)
            found[name] = Meaning(own, text)
    return found


def _suffix_unit(name: str) -> str:
    for suffix in sorted(UNITS, key=len, reverse=True):
        if name.endswith(suffix):
            return UNITS[suffix]
    return ""


def number_text(value: Any, unit: str = "") -> str:
    """A value for people: finite decimals in full, others rounded and followed by the fraction."""
    tail = f" {unit}" if unit else ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        names = getattr(value, "_fields", ())
        if names and tuple(names) != ("x", "y"):
            parts = zip(names, value, strict=True)
            return f"({', '.join(f'{n} = {number_text(v, _suffix_unit(n))}' for n, v in parts)})"
        return f"({', '.join(number_text(v, unit) for v in value)})"
    if isinstance(value, Fraction):
        return _decimal(value) + tail
    return f"{value}{tail}"


def _decimal(value: Fraction) -> str:
    if value.denominator == 1:
        return str(value.numerator)
    rest, twos, fives = value.denominator, 0, 0
    while rest % 2 == 0:
        rest, twos = rest // 2, twos + 1
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    places = max(twos, fives)
    if rest == 1 and places <= DIGITS:
        digits = str(abs(value.numerator) * 10**places // value.denominator).rjust(places + 1, "0")
        return f"{'-' if value < 0 else ''}{digits[:-places]}.{digits[-places:]}"
    return f"{float(value):.6g} (exactly {value})"


def verdict_text(function: Callable[..., Any], value: Any) -> str:
    """A function's result as text; a truth value in the function's own words."""
    if isinstance(value, bool):
        for part, (yes, no) in WORDS.items():
            if part in function.__name__:
                return yes if value else no
    return number_text(value, _suffix_unit(function.__name__))


# -- from a model to numbers -----------------------------------------------------------------
class Model:
    """A solver's model as numbers; an irrational value is replaced by a rational near it."""

    def __init__(self, model: z3.ModelRef, context: z3.Context) -> None:
        self._model, self._context = model, context
        self.rounded = False

    def value(self, value: Any) -> Any:
        """A symbolic value, or a tuple of them, as Python numbers."""
        if isinstance(value, tuple):
            parts = [self.value(part) for part in value]
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        if not isinstance(value, Sym):
            return value
        term = self._model.eval(value.term.translate(self._context), model_completion=True)
        return self.number(term)

    def number(self, term: z3.ExprRef) -> Any:
        """A constant term as a Python number."""
        if z3.is_true(term) or z3.is_false(term):
            return z3.is_true(term)
        if z3.is_algebraic_value(term):
            self.rounded = True
            term = term.approx(20)
        if z3.is_int_value(term) or z3.is_bv_value(term):
            return term.as_long()
        if z3.is_rational_value(term):
            return Fraction(term.numerator_as_long(), term.denominator_as_long())
        return str(term)

    def variables(self) -> list[tuple[str, Any]]:
        """Every free variable that the claim itself introduced, by name."""
        found = [d for d in self._model.decls() if d.arity() == 0]
        named = [(str(d.name()), self._model[d]) for d in found]
        return sorted((n, self.number(v)) for n, v in named if "!" not in n and "#" not in n)


def telling(
    terms: list[z3.BoolRef], found: z3.ModelRef, make: Callable[[], z3.Solver]
) -> z3.ModelRef:
    """A readable model: no needless zeros, whole numbers where possible.

    terms: what the model satisfies; make: returns a fresh solver. Where none is found, the model as given.
    """

    def ask(extra: list[z3.BoolRef]) -> z3.ModelRef | None:
        solver = make()
        solver.add(*terms, *extra)
        said = check(solver, solver.ctx, TELLING_RLIMIT)
        return solver.model() if said.result == "sat" else None

    names = sorted((d for d in found.decls() if d.arity() == 0), key=lambda d: str(d.name()))
    reals = [d() for d in names if z3.is_real(d())]
    near = {x: z3.And(x * x >= 1, x * x <= 10**6) for x in reals}
    # motion along one axis first: distances are then plain numbers, without roots
    across = [x for x in reals if str(x).endswith(".y")]
    along = [x == 0 for x in across] + [near[x] for x in reals if not str(x).endswith(".y")]
    for extra in (along, list(near.values()), [x != 0 for x in reals]):
        better = ask(extra) if reals else None
        if better is not None:
            found = better
            break
    else:
        extra = []
    # then each value in turn is set to a nearby whole number where that is possible
    fixed: list[z3.BoolRef] = []
    for x in reals:
        value = found.eval(x, model_completion=True)
        value = value.approx(3) if z3.is_algebraic_value(value) else value
        if not z3.is_rational_value(value):
            continue
        number = Fraction(value.numerator_as_long(), value.denominator_as_long())
        for whole in dict.fromkeys((10 * round(number / 10), round(number))):
            pinned = x == z3.RealVal(whole, x.ctx)
            better = ask([*extra, *fixed, pinned])
            if better is not None:
                found = better
                fixed.append(pinned)
                break
    return found


def story(claim: Claim, model: Model) -> list[str]:
    """The counterexample line by line; empty for a claim that recorded no runs."""
    runs = getattr(claim, "runs", [])
    lines: list[str] = []
    shown: dict[str, None] = {}
    told: list[str] = []
    confirmed = bool(runs)
    for run in runs:
        known = meanings(run.function)
        args = tuple(model.value(arg) for arg in run.args)
        names = list(inspect.signature(run.function).parameters)
        for name, arg, symbolic in zip(names, args, run.args, strict=False):
            # a definition mostly has the kernel's values: each is shown once
            if not _mark(shown, symbolic):
                continue
            meaning = known[name]
            line = f"{name} = {number_text(arg, meaning.unit)}"
            lines.append(f"{line}   {meaning.text}" if meaning.text else line)
        given = model.value(run.value)
        line, right = _says(run, args, given)
        confirmed = confirmed and right
        if line not in told:
            told.append(line)
    free = [(n, v) for n, v in model.variables() if n.split(".")[0] not in shown]
    lines += [f"{name} = {number_text(value, _suffix_unit(name))}" for name, value in free]
    lines += told
    if model.rounded:
        lines.append("(irrational values are rounded here; the solver's are exact)")
    elif confirmed:
        lines.append("(confirmed: the functions, run on these numbers, say the same)")
    elif runs:
        lines.append(
            "(not confirmed by running: what the theorem knows of an opaque function or through "
            "a lemma allows more than the functions do)"
        )
    return lines


def _mark(shown: dict[str, None], value: Any) -> bool:
    """Record the variables of a value; True iff the value itself has not been shown yet."""
    parts = value if isinstance(value, tuple) else (value,)
    terms = [part.term for part in parts if isinstance(part, Sym)]
    key = "; ".join(str(term) for term in terms)
    if not terms or key in shown:
        return False
    shown[key] = None
    for term in terms:
        if z3.is_const(term):
            shown[str(term)] = None
            shown[str(term).split(".")[0]] = None
    return True


def _says(run: Run, args: tuple[Any, ...], given: Any) -> tuple[str, bool]:
    """One line for a run, and whether running the function really gives that result."""
    home = run.function.__module__.split(".")[-1]
    name = f"{home}.{run.function.__name__}" if run.role == "definition" else run.function.__name__
    try:
        real = run.function(*args)
    except (ZeroDivisionError, TypeError, ValueError) as error:
        return f"{run.role} {name} cannot be run there: {error}", False
    line = f"{run.role} {name} says {verdict_text(run.function, real)}"
    same = _plain(real) == _plain(given)
    if not same:
        line += f" (the theorem allows {verdict_text(run.function, given)})"
    return line, same


def _plain(value: Any) -> Any:
    return tuple(_plain(part) for part in value) if isinstance(value, tuple) else value
