"""Formulas of bounded metric temporal logic over named signals. Semantics:
`spec.requirements.operators`.

Times are integers in one unit chosen by the trace: milliseconds, or one per sample. Other operators
are derived: `F phi = true U phi`, `G phi = not F not phi`, `once = true S`, `historically = not
once not`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from cratous.spec.errors import BadInput

MAX_TIME = 2**60
"""Limit of bounds and time stamps, so that no sum exceeds 62 bits."""


@dataclass(frozen=True)
class Always:
    """A constant: 0 false, 2 true."""

    verdict: int


@dataclass(frozen=True)
class Reaches:
    """Left >= right; each is the name of a signal or a number, both in one unit."""

    left: str | float
    right: str | float


@dataclass(frozen=True)
class Not:
    """Not phi."""

    phi: Formula


@dataclass(frozen=True)
class Join:
    """Phi and psi, or phi or psi."""

    phi: Formula
    psi: Formula
    is_and: bool


@dataclass(frozen=True)
class Bounded:
    """`phi U[low,high] psi`, or with `past` `phi S[low,high] psi`; 0 <= low <= high, in time units."""

    phi: Formula
    psi: Formula
    low: int
    high: int
    past: bool

    def __post_init__(self) -> None:
        if not 0 <= self.low <= self.high <= MAX_TIME:
            raise BadInput(
                "these are no bounds of time",
                item="U" if not self.past else "S",
                expected=f"0 <= low <= high <= {MAX_TIME}",
                got=f"[{self.low},{self.high}]",
            )


Formula: TypeAlias = Always | Reaches | Not | Join | Bounded

TRUE, FALSE = Always(2), Always(0)


def compared(left: str | float, relation: str, right: str | float) -> Formula:
    """A comparison with one of `>= <= > < == !=`."""
    above, below = Reaches(left, right), Reaches(right, left)
    made: dict[str, Formula] = {
        ">=": above,
        "<=": below,
        ">": Not(below),
        "<": Not(above),
        "==": Join(above, below, True),
        "!=": Not(Join(above, below, True)),
    }
    return made[relation]


def eventually(phi: Formula, low: int, high: int) -> Formula:
    """Phi holds at some sample between low and high time units ahead."""
    return Bounded(TRUE, phi, low, high, False)


def globally(phi: Formula, low: int, high: int) -> Formula:
    """Phi holds at every sample between low and high time units ahead."""
    return Not(eventually(Not(phi), low, high))


def once(phi: Formula, low: int, high: int) -> Formula:
    """Phi held at some sample between low and high time units ago."""
    return Bounded(TRUE, phi, low, high, True)


def historically(phi: Formula, low: int, high: int) -> Formula:
    """Phi held at every sample between low and high time units ago."""
    return Not(once(Not(phi), low, high))


def implies(phi: Formula, psi: Formula) -> Formula:
    """If phi then psi."""
    return Join(Not(phi), psi, False)


def iff(phi: Formula, psi: Formula) -> Formula:
    """Phi if and only if psi."""
    return Join(implies(phi, psi), implies(psi, phi), True)


def parts(formula: Formula) -> Iterator[Formula]:
    """Every distinct part once, children before parents; iterative, so the depth is not limited."""
    done: set[int] = set()
    todo: list[tuple[Formula, bool]] = [(formula, False)]
    while todo:
        one, ready = todo.pop()
        if id(one) in done:
            continue
        if ready:
            done.add(id(one))
            yield one
            continue
        todo.append((one, True))
        todo += [(child, False) for child in children(one)]


def children(formula: Formula) -> tuple[Formula, ...]:
    """The parts directly below a formula."""
    if isinstance(formula, Not):
        return (formula.phi,)
    if isinstance(formula, Join | Bounded):
        return (formula.phi, formula.psi)
    return ()


def same(one: Formula, other: Formula) -> bool:
    """Whether two formulas are structurally equal. Iterative; each pair of parts is compared once."""
    done: set[tuple[int, int]] = set()
    todo = [(one, other)]
    while todo:
        a, b = todo.pop()
        if (id(a), id(b)) in done:
            continue
        done.add((id(a), id(b)))
        if _head(a) != _head(b):
            return False
        todo += zip(children(a), children(b), strict=True)
    return True


def _head(formula: Formula) -> tuple[object, ...]:
    """A node without its children, as a comparable tuple."""
    of = {k: v for k, v in vars(formula).items() if k not in ("phi", "psi")}
    return type(formula), *sorted(of.items())


def horizon(formula: Formula) -> int:
    """Maximum time after a sample at which the formula is decided there, in time units."""
    return _horizons(formula)[id(formula)]


def _horizons(formula: Formula) -> dict[int, int]:
    longest: dict[int, int] = {}
    for part in parts(formula):
        below = max((longest[id(child)] for child in children(part)), default=0)
        ahead = part.high if isinstance(part, Bounded) and not part.past else 0
        longest[id(part)] = below + ahead
    return longest


def waiting(formula: Formula, period: int) -> int:
    """Maximum length of any queue of the evaluation, if samples are at least `period` apart."""
    longest, found = _horizons(formula), 0
    for part in parts(formula):
        old = part.low if isinstance(part, Bounded) and part.past else 0
        if isinstance(part, Join | Bounded):
            found = max(found, (longest[id(part)] + old) // period + 1)
    return found


def signals(formula: Formula) -> tuple[str, ...]:
    """The names of the signals that it reads, in order."""
    found = {
        side
        for part in parts(formula)
        if isinstance(part, Reaches)
        for side in (part.left, part.right)
        if isinstance(side, str)
    }
    return tuple(sorted(found))
