"""Checks the definition that a kernel names: it exists, its theorems use it, and it is not the kernel itself.

A kernel or fold names a function of `spec` (implements), which one of its theorems, or a lemma of one, must use;
where the definition has the kernel's own formula the kernel says so (restates). A step of another kernel or fold
names that one instead (supports), which must call it, have a definition, and be proved itself.
"""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from cratous.core.kernel import REGISTRY, Entry, Fold, supported
from cratous.core.kernel.sources import position, reached
from cratous.core.ledger.package_home import Home
from cratous.proofs.engine.argument_values import FEW
from cratous.proofs.engine.reachable_paths import NOT, of_more_than_one, values_left
from cratous.proofs.statements.closed_definitions import full_name
from cratous.proofs.statements.decided import Decided, Group
from cratous.proofs.statements.relations import Relations
from cratous.proofs.statements.restated import restates
from cratous.proofs.statements.unconditional import Use


@dataclass(frozen=True)
class Proofs:
    """The proved theorems of a home by name, and what their statements relate.

    kernels: those that each theorem is about; proved: the proved theorems; varied: how the arguments of their uses of
    kernels vary, by name and number; run: all theorems but those proved without a run at a point of doubles; None
    where not determined. decided: by theorem, a definition and a use whose result it decides at many values, by goals
    with conditions; assuming: theorems with an assumption (c.assume).
    """

    kernels: Mapping[str, tuple[str, ...]]
    proved: frozenset[str]
    relations: Mapping[str, Relations]
    varied: Mapping[str, Mapping[tuple[str, int], str]]
    run: frozenset[str] | None = None
    decided: Mapping[str, frozenset[Decided]] = field(default_factory=dict)
    assuming: frozenset[str] = frozenset()

    def holds_of_any(self, theorem: str, pair: tuple[str, str]) -> bool:
        """Whether the theorem relates the two for more than a few values, considering its premises and its goals.

        False for a theorem that has an assumption, or depends on one that has.
        """
        if not self.assuming.isdisjoint(self.resting([theorem])):
            return False
        plain = self.relations[theorem].plain
        decided = self.decided.get(theorem, frozenset())
        uses = self.related_uses(theorem, pair)
        return of_more_than_one(
            [
                how
                for use, how in uses.items()
                if (*pair, *use) in plain or (pair[1], *use) in decided
            ]
        )

    def undecided(self, theorem: str, pair: tuple[str, str]) -> dict[Use, str]:
        """The uses that relate the two, if only the conditions in its goals are left to be decided; otherwise empty."""
        known = self.holds_of_any(theorem, pair) or not self.assuming.isdisjoint(
            self.resting([theorem])
        )
        uses = {
            u: how for u, how in self.related_uses(theorem, pair).items() if not how.startswith(NOT)
        }
        return {} if known or not of_more_than_one(uses.values()) else uses

    def by_goals(self, theorem: str, pair: tuple[str, str]) -> bool:
        """Whether its premises leave many values, but its goals do not, or were not found to."""
        return bool(self.undecided(theorem, pair))

    def left(self, theorem: str, pair: tuple[str, str]) -> int:
        """The greatest number of values it leaves an argument that takes a few; 0 if there is none."""
        return values_left(self.related_uses(theorem, pair).values())

    def related_uses(self, theorem: str, pair: tuple[str, str]) -> dict[Use, str]:
        """The uses by which it relates the two, and how their arguments vary."""
        uses = self.relations[theorem].uses
        varied = self.varied.get(theorem, {})
        return {use: how for use, how in varied.items() if (*pair, *use) in uses}

    def was_run(self, theorem: str) -> bool:
        """Whether it was run at a point of doubles where its premises hold; true where not determined."""
        return self.run is None or theorem in self.run

    def size(self, theorem: str) -> tuple[bool, int, int, str]:
        """Sort key for theorems: those that were run first, then the shortest; no two are equal."""
        related = self.relations[theorem]
        return not self.was_run(theorem), len(related.statement), len(related.uses), theorem

    def about(self, name: str) -> list[str]:
        """The theorems about a kernel, sorted by name."""
        return sorted(theorem for theorem, named in self.kernels.items() if name in named)

    def resting(self, theorems: list[str]) -> list[str]:
        """These theorems and all lemmas that they depend on."""
        found: list[str] = []
        todo = list(theorems)
        while todo:
            one = todo.pop()
            if one in self.relations and one not in found:
                found.append(one)
                todo += self.relations[one].lemmas
        return sorted(found)

    def holds(self, name: str) -> bool:
        """Whether a kernel is proved: there are theorems about it, and all of them are proved."""
        about = self.about(name)
        return bool(about) and all(theorem in self.proved for theorem in about)


def definition_name(entry: Entry, home: Home) -> str:
    """The full name of what an entry implements."""
    return f"{home.name}.spec.{entry.implements}"


def definition(entry: Entry, home: Home) -> Callable[..., Any] | None:
    """The function that an entry implements; None if there is no such function."""
    module, _, name = definition_name(entry, home).rpartition(".")
    if not home.definition(entry.implements).is_file():
        return None
    found = getattr(importlib.import_module(module), name, None)
    return found if inspect.isfunction(found) and found.__module__ == module else None


def is_restated(entry: Entry, home: Home) -> bool | None:
    """Whether the definition has the formula of the kernel, or of the fold's step; None if undetermined."""
    meant = definition(entry, home)
    function = entry.function.step if isinstance(entry.function, Fold) else entry.function
    return None if meant is None else restates(function, meant)


def relating(entry: Entry, home: Home, proofs: Proofs) -> list[str]:
    """The theorems about an entry, and lemmas of them, whose goals relate it to its definition."""
    if not entry.implements:
        return []
    pair = (full_name(entry.function), definition_name(entry, home))
    theorems = proofs.resting(proofs.about(entry.name))
    return [theorem for theorem in theorems if pair in proofs.relations[theorem].pairs]


def to_decide(
    entries: Mapping[str, Entry],
    home: Home,
    proofs: Proofs,
    asked: Collection[tuple[str, tuple[str, str]]] = (),
) -> dict[str, list[tuple[tuple[str, str], dict[Use, str]]]]:
    """By theorem, the kernels not yet proved against their definitions, each with its uses there.

    Each kernel is listed under one theorem: the first by size of those not asked about it yet.
    """
    found: dict[str, list[tuple[tuple[str, str], dict[Use, str]]]] = {}
    for entry in entries.values():
        if entry.kind == "driver" or not entry.implements:
            continue
        pair = (full_name(entry.function), definition_name(entry, home))
        theorems = relating(entry, home, proofs)
        if any(proofs.holds_of_any(name, pair) and proofs.was_run(name) for name in theorems):
            continue
        for theorem in sorted(theorems, key=proofs.size):
            if (theorem, pair) not in asked and (uses := proofs.undecided(theorem, pair)):
                found.setdefault(theorem, []).append((pair, uses))
                break
    return {theorem: sorted(some, key=lambda of: of[0]) for theorem, some in sorted(found.items())}


def with_decided(
    entries: Mapping[str, Entry],
    home: Home,
    proofs: Proofs,
    ask: Callable[[Mapping[str, list[Group]]], Mapping[str, frozenset[Decided]]],
) -> Proofs:
    """The proofs, completed by what goals with conditions decide, as far as a kernel needs it.

    In rounds: one theorem is asked for each kernel, until one relates it or all were asked. So which questions are
    asked depends only on previous answers.
    """
    asked: set[tuple[str, tuple[str, str]]] = set()
    while wanted := to_decide(entries, home, proofs, asked):
        asked |= {(name, pair) for name, some in wanted.items() for pair, _ in some}
        said = ask({n: [(pair[1], uses) for pair, uses in some] for n, some in wanted.items()})
        known = proofs.decided
        more = {name: known.get(name, frozenset()) | some for name, some in said.items()}
        proofs = replace(proofs, decided={**known, **more})
    return proofs


def problems(entries: Mapping[str, Entry], home: Home, proofs: Proofs) -> list[str]:
    """Problems with the definitions that kernels and folds name, each with its place.

    proofs: of all theorems of the home.
    """
    found = []
    for name, entry in entries.items():
        if entry.kind != "driver":
            texts = _of_step(entry, proofs) if entry.supports else _of_meaning(entry, home, proofs)
            found += [f"{position(entry.function)}: {name}: {text}" for text in texts]
    return found


def _of_meaning(entry: Entry, home: Home, proofs: Proofs) -> Iterator[str]:
    """Problems with `implements`."""
    named = repr(entry.implements)
    if not home.definition(entry.implements).is_file():
        yield f"implements {named}, but there is no spec/{home.definition(entry.implements).name}"
    elif definition(entry, home) is None:
        yield f"implements {named}, but spec has no such function"
    else:
        full = definition_name(entry, home)
        theorems = proofs.resting(proofs.about(entry.name))
        if not any(full in proofs.relations[theorem].definitions for theorem in theorems):
            yield f"implements {named}, which none of its theorems uses (c.define)"
        elif not relating(entry, home, proofs):
            yield (
                f"implements {named}, which none of its theorems holds it against: a goal relates "
                "the two, and does not hold of other functions as well"
            )
        else:
            yield from _of_points((full_name(entry.function), full), entry, theorems, proofs)
        same = is_restated(entry, home)
        if same and not entry.restates:
            yield (
                f"implements {named}, which has its own formula: define what is meant, or say with "
                "restates=... what the formula is for"
            )
        if same is False and entry.restates:
            yield f"implements {named}, which has another formula: it restates nothing"


def _of_points(
    pair: tuple[str, str], entry: Entry, theorems: list[str], proofs: Proofs
) -> Iterator[str]:
    """Problems with the points at which its theorems relate it to its definition."""
    several = [theorem for theorem in theorems if proofs.holds_of_any(theorem, pair)]
    named = f"implements {entry.implements!r}, which none of its theorems"
    if not several and not proofs.assuming.isdisjoint(proofs.resting(theorems)):
        yield f"{named} holds it against without an assumption (c.assume): state it as a premise"
    elif not several and any(proofs.by_goals(theorem, pair) for theorem in theorems):
        yield (
            f"{named} holds it against for more than a few values: their goals have conditions, and it was "
            "not found that they are false of other results elsewhere: show it without a condition "
            "(c.implies, c.any_of, c.when), or for all of its cases"
        )
    elif not several:
        left = max((proofs.left(theorem, pair) for theorem in theorems), default=0)
        points = f"more than {FEW} points, all apart" if left > FEW else f"{left} points"
        what = f"a few values: its premises leave an argument {points}"
        yield (
            f"{named} holds it against for more than {what if left else 'one value of each argument'}: "
            "use arbitrary values (c.real) that no premise fixes"
        )
    elif not any(map(proofs.was_run, several)):
        yield (
            f"{named} was run with on doubles: no point of doubles was found at which the premises "
            "of one hold (see docs/proofs/running.md)"
        )


def _of_step(entry: Entry, proofs: Proofs) -> Iterator[str]:
    """Problems with `supports`."""
    whole = REGISTRY.get(supported(entry))
    if whole is None or whole.kind == "driver":
        yield f"supports {entry.supports!r}, which is no kernel or fold"
    elif not calls(whole, entry):
        yield f"supports {entry.supports!r}, which does not call it"
    elif not whole.implements:
        yield f"supports {entry.supports!r}, which has no definition itself"
    elif not proofs.holds(whole.name):
        yield f"supports {entry.supports!r}, which is not proved"


def calls(whole: Entry, part: Entry) -> bool:
    """Whether `whole` calls `part`, directly or indirectly."""
    return full_name(part.function) in reached(whole.function)
