"""Runs one theorem: at the solver's witnesses, and at special and random numbers."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.core.kernel.sources import ours
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.outcomes import Ran
from cratous.proofs.engine.symbolic import SymMask
from cratous.proofs.engine.terms import leaves
from cratous.proofs.engine.theorem_files import load_claim, load_lemma
from cratous.proofs.running.copies import Undecided
from cratous.proofs.running.late_values import now
from cratous.proofs.running.points import witnesses
from cratous.proofs.running.statement import False_, NotRun, OnNumbers, Outside, Values

DRAWN, FEW, DRAWN_AT_MOST = 24, 3, 400
"""The number of points drawn beside the witnesses; more, up to DRAWN_AT_MOST, while at most FEW of them count."""
ENOUGH = 3
"""The most differences reported per theorem."""

Function = tuple[str, str]
"""A function that is not nested in another one: its module and its name there."""


@dataclass(frozen=True)
class Functions:
    """Functions that a theorem looked into: positions of bit masks, and arguments that it passed."""

    masks: dict[Function, frozenset[int]] = field(default_factory=dict)
    rows: dict[Function, tuple[tuple[Any, ...], ...]] = field(default_factory=dict)


def run(name: str, claim: Claim, folder: Path) -> tuple[Ran, Functions]:
    """Run the theorem of a file; claim: the same, stated for the solver."""
    statement = load_claim(name, folder)[0]
    called: dict[Function, list[tuple[Any, ...]]] = {}
    ran = _ran(name, statement, claim, folder, called)
    masks: dict[Function, frozenset[int]] = {}
    for visit in claim.visits:
        function = visit.function
        if _is_compared(function):
            key = (function.__module__, function.__qualname__)
            bits = {k for k, arg in enumerate(visit.args) if isinstance(arg, SymMask)}
            # an integer literal beside a mask is a mask too
            bits |= {k for k, arg in enumerate(visit.args) if bits and type(arg) is int}
            masks[key] = masks.get(key, frozenset()) | bits
    return ran, Functions(masks, {key: tuple(rows) for key, rows in called.items() if key in masks})


def _is_compared(function: Callable[..., Any]) -> bool:
    """Whether it is a kernel or definition: not a helper of a theorem, nor a nested function."""
    top, *parts = function.__module__.split(".")
    helper = "theorems" in parts or (top == "cratous" and parts[:1] == ["proofs"])
    return ours(function) and not helper and "<locals>" not in function.__qualname__


def _ran(
    name: str,
    statement: Callable[[Any], None],
    claim: Claim,
    folder: Path,
    called: dict[Function, list[tuple[Any, ...]]],
) -> Ran:
    found: list[str] = []
    points = doubles = 0
    given = witnesses(claim)
    lemma = functools.cache(lambda other: load_lemma(other, folder))
    for number in range(len(given) + DRAWN_AT_MOST):
        if number >= len(given) + DRAWN and points > FEW:
            break
        point = given[number] if number < len(given) else {}
        values = Values(point, f"{name} at {number}")
        on = OnNumbers(values, lemma, called=called)
        try:
            statement(on)
        except (Outside, Undecided, ZeroDivisionError):
            continue  # a division by zero in the statement itself may have any value
        except False_ as error:
            if len(found) < ENOUGH:
                found.append(f"run as Python: {error}: {_numbers(on.shown)}")
        except NotRun as error:
            return Ran(points, tuple(found), str(error), doubles=doubles)
        except (TypeError, AttributeError) as error:
            return Ran(points, tuple(found), f"{type(error).__name__}: {error}", doubles=doubles)
        else:
            points += 1
            doubles += all(map(_is_double, leaves(now(tuple(on.shown.values())))))
    return Ran(points, tuple(found), doubles=doubles)


def _is_double(value: Any) -> bool:
    """Whether the value is exactly a double, or an integer or truth value."""
    try:
        return not isinstance(value, Fraction) or Fraction(float(value)) == value
    except OverflowError:
        return False


def _numbers(shown: dict[str, Any]) -> str:
    return ", ".join(
        f"{name} = {value if isinstance(value, Fraction | int) else repr(value)}"
        for name, value in zip(shown, now(tuple(shown.values())), strict=True)
    )
