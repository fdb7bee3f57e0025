"""Which functions of `spec` a theorem refers to, and against which of them it proves a kernel.

The statement is read once more with every kernel and definition left closed: each use becomes an unknown value that
records its function and those of its arguments. So a goal shows what it is made of, whatever loops and helpers were
used to write it. Nothing is proved here: a theorem that is not proved vouches for nothing.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import z3

from cratous.core.kernel import REGISTRY, Fold, qualified
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.closed import TRUE
from cratous.proofs.engine.lemma_calls import hangs_on_calls
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.solver_order import check
from cratous.proofs.engine.symbolic import SymBool, SymInt, SymMask, SymReal, _raw
from cratous.proofs.engine.terms import free_names, free_values, fresh, known, leaves
from cratous.proofs.engine.theorem_files import FOLDER, load_claim, package_of
from cratous.proofs.statements import sentences
from cratous.proofs.statements.closed_definitions import (
    Closed,
    full_name,
    in_spec,
    part_of,
    plain,
    reopened,
)
from cratous.proofs.statements.premise_and_goal import sides, signs
from cratous.proofs.statements.sentences import UNREAD, Call, Stated
from cratous.proofs.statements.unconditional import unconditional

SAYS_RLIMIT = 200_000
KINDS = {SymReal: "real number", SymInt: "integer", SymBool: "truth value", SymMask: "64-bit mask"}
NONE: frozenset[tuple[str, str]] = frozenset()
Function = Callable[..., Any]
Use = tuple[str, int]


@dataclass(frozen=True)
class Relations:
    """Definitions that a statement uses, by `module.name`; the pairs (function of core, definition).

    together: both in the conclusion, as in an equality, or the definition applied to the kernel's result; follows:
    the kernel from the definition; leads: the definition from the kernel. lemmas: those the theorem depends on. uses:
    the pairs, each with a use of a kernel by which they are related (of a fold, its step): qualified name, and number
    among the theorem's uses of it. plain: those uses that some goal, or an induction, relates without a condition.
    statement: the claim as a sentence.
    """

    definitions: frozenset[str]
    together: frozenset[tuple[str, str]]
    follows: frozenset[tuple[str, str]]
    leads: frozenset[tuple[str, str]]
    lemmas: tuple[str, ...]
    uses: frozenset[tuple[str, str, str, int]] = frozenset()
    plain: frozenset[tuple[str, str, str, int]] = frozenset()
    statement: str = UNREAD

    @property
    def pairs(self) -> frozenset[tuple[str, str]]:
        """All pairs, however they are related."""
        return self.together | self.follows | self.leads


def _unknown(name: str, kind: Any) -> Any:
    """An arbitrary value of this type; TypeError if there is none."""
    if get_origin(kind) is tuple:
        return tuple(_unknown(f"{name}.{i}", part) for i, part in enumerate(get_args(kind)))
    if kind in (bool, int, float) or hasattr(kind, "_fields"):
        return fresh(name, kind)
    raise TypeError(f"{name} gives {kind}, of which there is no arbitrary value")


def _equal(one: z3.ExprRef, other: z3.ExprRef) -> bool:
    """Whether two written values are equal: an integer may stand for a real."""
    return str(z3.simplify(one)) == str(z3.simplify(other))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | Fraction)


@dataclass
class Outline(Claim):
    """A claim in which only the statement itself is looked into.

    stated_uses: every use of a kernel in order, with its arguments.
    """

    met: dict[Any, Any] = field(default_factory=dict)
    kept: list[z3.ExprRef] = field(default_factory=list)
    looked_at: dict[int, tuple[z3.ExprRef, frozenset[str]]] = field(default_factory=dict)
    arguments: dict[Function, list[tuple[Any, ...]]] = field(default_factory=dict)
    made_of: dict[str, frozenset[Function]] = field(default_factory=dict)
    evaluated: dict[Function, list[tuple[tuple[str, ...], Any]]] = field(default_factory=dict)
    written: dict[Use, tuple[str, ...]] = field(default_factory=dict)
    used_in: dict[str, frozenset[Use]] = field(default_factory=dict)
    counted: dict[str, int] = field(default_factory=dict)
    stated_uses: list[tuple[Use, tuple[Any, ...]]] = field(default_factory=list)
    results: dict[str, set[tuple[str, Use]]] = field(default_factory=dict)
    meant: dict[str, str] = field(default_factory=dict)
    given_to: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    stepped: dict[str, Use] = field(default_factory=dict)
    of_folds: set[Use] = field(default_factory=set)
    given_then: dict[int, tuple[z3.BoolRef, ...]] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    values_of: dict[str, Call] = field(default_factory=dict)
    folded: tuple[Fold[Any], tuple[str, ...]] | None = None
    relation: z3.BoolRef | None = None
    ended: dict[int, tuple[str, frozenset[str]]] = field(default_factory=dict)

    def _value(self, name: str, make: Callable[[str], Any]) -> Any:
        value = super()._value(name, make)
        self.kinds[name] = KINDS[type(value)]
        return value

    def fold(self, kernel_fold: Fold[Any], **how: Any) -> None:
        """An induction over the items of a fold."""
        items = tuple(str(known(leaf)) for leaf in leaves(how["item"]))
        self.folded = (kernel_fold, items)
        step = qualified(kernel_fold.step)
        self.stepped[full_name(kernel_fold)] = (step, self.counted.get(step, -1) + 1)
        first, before = len(self.obligations), len(self.stated_uses)
        super().fold(kernel_fold, **how)
        self.of_folds |= {use for use, _ in self.stated_uses[before:]}
        if kernel_fold.finish is None:
            # without a finish the accumulator is the result, where the results are compared
            result = full_name(kernel_fold), frozenset(str(known(v)) for v in leaves(how["acc"]))
            added = enumerate(self.obligations[first:], first)
            self.ended |= {number: result for number, owed in added if owed.kind == "use"}

    def _grant(self, condition: z3.BoolRef) -> None:
        self.relation = condition
        super()._grant(condition)

    def as_stated(self) -> Stated:
        """The claim's content, for writing it as a sentence."""
        fold, items = self.folded or (None, ())
        return Stated(
            self.kinds, self.values_of, self.obligations, self.given_then, fold, items, self.relation
        )  # fmt: skip

    def closed_value(self, function: Function, args: tuple[Any, ...]) -> Any:
        """An unknown value of the function's type that records what it is made of.

        Equal arguments give the same value. For known numbers its value is computed, since later statements depend on
        it. Raises TypeError for a type without values.
        """
        terms = [known(leaf) for leaf in leaves(args)]
        self.arguments.setdefault(function, []).append(args)
        if args and all(map(_is_number, leaves(args))):
            said = function(*args)
            self.evaluated.setdefault(function, []).append((tuple(map(str, terms)), said))
            return said
        key = (function, tuple(term.get_id() for term in terms))
        if key not in self.met:
            name = f"{full_name(function)}#{len(self.met)}"
            value = self.met[key] = _unknown(name, get_type_hints(function).get("return"))
            self.values_of[name] = Call(function, args)
            self.kept += terms
            inner = frozenset([function]).union(*[self.functions_in(term) for term in terms])
            self.made_of |= {str(known(leaf)): inner for leaf in leaves(value)}
            uses = frozenset[Use]().union(*[self.uses_in(term) for term in terms])
            self.used_in |= {str(known(leaf)): uses for leaf in leaves(value)}
            if in_spec(function):
                self.meant |= {str(known(leaf)): full_name(function) for leaf in leaves(value)}
            self.given_to |= {str(known(leaf)): args for leaf in leaves(value)}
        return self.met[key]

    def use(self, kernel: Function, *args: Any, when: Any = True) -> Any:
        value = super().use(kernel, *args, when=when)
        name = qualified(kernel)
        number = self.counted[name] = self.counted.get(name, -1) + 1
        self.stated_uses.append(((name, number), args))
        written = [leaf for leaf in leaves(args) if isinstance(leaf, int)]
        self.written[name, number] = tuple(str(known(leaf)) for leaf in written)
        for leaf in map(known, leaves(value)):
            if str(leaf) in self.used_in:
                self.used_in[str(leaf)] |= {(name, number)}
                self.results.setdefault(str(leaf), set()).add((full_name(kernel), (name, number)))
        return value

    def names_in(self, term: z3.ExprRef) -> frozenset[str]:
        """The names in a term; each term is traversed once."""
        seen = self.looked_at.get(term.get_id())
        if seen is None:  # the term is kept alive so that its id stays unique
            seen = self.looked_at[term.get_id()] = (term, frozenset(free_names(term)))
        return seen[1]

    def uses_in(self, term: z3.ExprRef) -> frozenset[Use]:
        """The uses of kernels that a term is made of."""
        none: frozenset[Use] = frozenset()
        return none.union(*[self.used_in.get(name, none) for name in self.names_in(term)])

    def uses_of(self, kernel: str, terms: Iterable[z3.BoolRef]) -> frozenset[Use]:
        """The uses in these terms of a kernel, or of a fold's step, given by its full name."""
        if kernel in self.stepped:
            return frozenset([self.stepped[kernel]])
        found = frozenset[Use]().union(*map(self.uses_in, terms))
        fold = next((f for f in self.folds() if full_name(f) == kernel), None)
        names = (kernel,) if fold is None else tuple(map(qualified, fold.kernels))
        return frozenset(use for use in found if use[0] in names)

    def rows(self, uses: Iterable[Use], value: z3.ExprRef | None = None) -> set[str]:
        """The definitions that were evaluated at literals of these uses; value: and gave it, or a record with it."""
        written = [set(self.written.get(use, ())) for use in uses]
        return {
            full_name(function)
            for function, points in self.evaluated.items()
            for point, said in points
            if in_spec(function)
            and any(set(point) and set(point) <= row for row in written)
            and (value is None or any(_equal(known(leaf), value) for leaf in leaves(said)))
        }

    def folds(self) -> list[Fold[Any]]:
        """The folds that the theorem is about."""
        entries = [REGISTRY[name] for name in self.kernels if name in REGISTRY]
        return [entry.function for entry in entries if isinstance(entry.function, Fold)]

    def functions_in(self, value: Any) -> frozenset[Function]:
        """All functions from whose results a value is made."""
        term = value if z3.is_expr(value) else _raw(value)
        names = self.names_in(term) if term is not None else ()
        return frozenset().union(*[self.made_of.get(name, frozenset()) for name in names])

    def names_of(self, kernel: str) -> frozenset[str]:
        """The unknown values that contain a kernel's result."""
        return frozenset(
            name for name, made in self.made_of.items() if kernel in {full_name(f) for f in made}
        )

    def _lift(
        self,
        function: Any,
        args: tuple[Any, ...],
        machine: bool = True,
        where: z3.BoolRef = TRUE,
    ) -> Any:
        function = plain(function)
        if part_of(function) in ("proofs", "theorems"):
            # the statement's own helper is looked into, but not the functions that it calls
            stubs: dict[Any, Any] = self.stubs
            for value in function.__globals__.values():
                if isinstance(value, types.FunctionType) and part_of(value) == "core":
                    stubs.setdefault(value, Closed(value, self))
            return super()._lift(function, args, machine, where)
        return self.closed_value(function, args)

    def opaque(self, *functions: Function) -> None:
        """No effect: everything is closed already."""

    def _closed(self, *_: Any) -> None:
        """No effect: side conditions of closed functions are not needed here."""

    def calls(self, function: Function) -> list[tuple[Any, ...]]:
        """The argument lists with which it was used."""
        self.asked = True
        return [] if self.hidden else list(self.arguments.get(plain(function), []))

    def congruence(self, function: Function, one: tuple[Any, ...], other: tuple[Any, ...]) -> None:
        """No effect: equal arguments give the same value already."""

    def _owe(self, kind: str, text: str, goal: z3.BoolRef) -> None:
        self.given_then[len(self.obligations)] = tuple(self.premises)
        super()._owe(kind, text, goal)

    def lemma(self, name: str, *, when: Any = True, **values: Any) -> None:
        """Only recorded: the content of a lemma is not needed."""
        self.lemmas.append(name)


def outline(name: str, folder: Path = FOLDER, *, hidden: bool = False) -> tuple[Outline, bool]:
    """The statement of a theorem, read with all functions closed; and whether it could be read completely.

    hidden: `c.calls` returns no calls.
    """
    claim = Outline(load=lambda other: load_claim(other, folder)[0], hidden=hidden)
    try:
        reopened(load_claim(name, folder)[0], claim)(claim)
    except (LiftError, TypeError, ValueError, RuntimeError, IndexError, KeyError, AttributeError):
        return claim, False  # it needs more than closed functions provide
    return claim, True


def relations(name: str, folder: Path = FOLDER) -> Relations:
    """The relations in the statement of a theorem; its kernels must be registered."""
    claim, whole = outline(name, folder)
    if not whole:  # only the names that it mentions are known
        named = _named_in(load_claim(name, folder)[0])
        return Relations(named, NONE, NONE, NONE, _lemmas(claim, folder))
    used = frozenset(full_name(f) for f in claim.arguments if in_spec(f))
    if claim.asked and hangs_on_calls(name, folder):
        # its goals are made of the calls that it meets, and this reading meets others
        return Relations(used, NONE, NONE, NONE, _lemmas(claim, folder))
    found: dict[str, set[tuple[str, str]]] = {"together": set(), "follows": set(), "leads": set()}
    uses: set[tuple[str, str, str, int]] = set()
    for number, owed in enumerate(claim.obligations):
        said = [owed.goal, *claim.given_then.get(number, ())]
        if owed.kind in ("goal", "base", "step", "use"):
            for how, pair in _pairs(claim, number):
                both = pair not in found[how] and owed.kind == "goal"
                if not both or all(_says(claim, number, function) for function in pair):
                    found[how].add(pair)
                    held = {(*pair, *use) for use in claim.uses_of(pair[0], said)}
                    uses |= held
    pairs = {how: frozenset(some) for how, some in found.items()}
    says = sentences.sentence(claim.as_stated())
    plain = unconditional(claim, uses)
    return Relations(
        used,
        lemmas=_lemmas(claim, folder),
        uses=frozenset(uses),
        plain=plain,
        statement=says,
        **pairs,
    )


def _lemmas(claim: Outline, folder: Path) -> tuple[str, ...]:
    """The theorems that it depends on; those of its own home by their plain names, however it calls them."""
    own = f"{package_of(folder)}."
    return tuple(sorted({name.removeprefix(own) for name in claim.lemmas}))


def _says(claim: Outline, number: int, function: str) -> bool:
    """Whether the goal depends on the function; not if it would also hold of any other result."""
    goal, premises = claim.obligations[number].goal, claim.given_then.get(number, ())
    names = claim.names_of(function)
    values = free_values([goal, *premises])
    others = [(v, z3.Const(f"{v}'", v.sort())) for v in values if str(v) in names]
    if not others:
        return True  # computed from known numbers, which are in the goal
    solver = z3.Solver()
    solver.add(*premises, goal, z3.substitute(z3.Not(goal), *others))
    solver.add(*[z3.substitute(premise, *others) for premise in premises])
    return check(solver, solver.ctx, SAYS_RLIMIT).result != "unsat"


def _pairs(claim: Outline, number: int) -> Iterator[tuple[str, tuple[str, str]]]:
    """The pairs of kernel and definition that an obligation's goal relates, and how."""
    owed = claim.obligations[number]
    ended, accumulator = claim.ended.get(number, ("", frozenset()))
    for given, conclusion in sides(owed.goal):
        spoken = claim.functions_in(conclusion)
        kernels = _kernels(spoken)
        if owed.kind != "goal":
            kernels |= _folds(claim, spoken)
        if claim.names_in(conclusion) & accumulator:
            kernels.add(ended)
        meant = _definitions(spoken)
        yield from (("together", (kernel, other)) for kernel in kernels for other in meant)
        for kernel in kernels:
            rows = claim.rows(claim.uses_of(kernel, [conclusion]))
            yield from (("together", (kernel, other)) for other in rows - meant)
        for condition in (*claim.premises, *given):
            before = claim.functions_in(condition)
            for kernel in _kernels(before) - kernels:
                for sign in signs(condition, claim.names_of(kernel), within=claim.names_in):
                    how = "leads" if sign else "follows"
                    yield from ((how, (kernel, other)) for other in meant)
            for kernel in kernels:
                for sign in signs(conclusion, claim.names_of(kernel), within=claim.names_in) or {
                    True
                }:
                    how = "follows" if sign else "leads"
                    yield from ((how, (kernel, other)) for other in _definitions(before) - meant)


def _named_in(statement: Function) -> frozenset[str]:
    """The definitions whose names occur in a statement."""
    assert isinstance(statement, types.FunctionType)
    scope, names = statement.__globals__, set(statement.__code__.co_names)
    places = [scope, *(vars(scope[n]) for n in names if isinstance(scope.get(n), types.ModuleType))]
    found = [place[name] for place in places for name in names if name in place]
    return frozenset(
        full_name(f) for f in found if isinstance(f, types.FunctionType) and in_spec(f)
    )


def _kernels(functions: Iterable[Function]) -> set[str]:
    return {full_name(f) for f in functions if not in_spec(f)}


def _folds(claim: Outline, spoken: Iterable[Function]) -> set[str]:
    """Of the folds that the theorem is about, those that an induction runs over."""
    return {full_name(f) for f in claim.folds() if set(f.kernels) & set(spoken)}


def _definitions(functions: Iterable[Function]) -> set[str]:
    return {full_name(f) for f in functions if in_spec(f)}
