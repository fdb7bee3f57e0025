"""Writing a theorem: for any input of this kind under these premises, using the kernel, this holds.

A theorem is a file in `proofs/theorems/` whose docstring is the sentence that reports print and whose function
`claim(c: Claim)` states it. `c.real`, `c.integer`, ... introduce arbitrary values; `c.premise` restricts them;
`c.use` runs a kernel and `c.define` a definition of `spec`; `c.show` states what must follow. `c.lemma` uses a
theorem proved elsewhere: its premises become obligations here. `c.fold` proves a fold for every number of items by
induction. A name is introduced once, and lemmas must not be circular: otherwise a theorem would be weakened silently.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Unpack

import z3

from cratous.core.kernel import Fold, Vec2, entry_of, qualified
from cratous.proofs.engine import closed, hidden_calls
from cratous.proofs.engine.closed import TRUE, path_to
from cratous.proofs.engine.induction import DefinedBy, Induction, arbitrary, side_of
from cratous.proofs.engine.lift import CLOSED, OPAQUE, REPLACED, VISITS, Visit, join, lift
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.symbolic import (
    INT64,
    RANGE,
    LiftError,
    SymBool,
    SymInt,
    SymMask,
    SymReal,
    equality,
)
from cratous.proofs.engine.terms import (
    Stub,
    depending,
    fields_of_both,
    flatten,
    free_names,
    of_its_kinds,
    of_kind,
    statement,
)

NAME = re.compile(r"[A-Za-z_]\w*(\.\w+)*", re.ASCII)
"""Names of a claim's values; the prover's own symbols have ! or # in theirs."""


@dataclass(repr=False)
class Claim:
    """The theorem under construction.

    asked: it called `calls`; asking: its lemmas that did; hidden: `calls` returns no calls.
    """

    prefix: str = ""
    circle: tuple[str, ...] = ()
    fixed: dict[str, Any] = field(default_factory=dict)
    load: Callable[[str], Callable[[Claim], None]] | None = None
    premises: list[z3.BoolRef] = field(default_factory=list)
    facts: list[z3.BoolRef] = field(default_factory=list)
    obligations: list[Obligation] = field(default_factory=list)
    kernels: list[str] = field(default_factory=list)
    lemmas: list[str] = field(default_factory=list)
    asking: set[str] = field(default_factory=set)
    asked: bool = False
    hidden: bool = False
    assumptions: list[tuple[str, str, str]] = field(default_factory=list)
    goals: list[z3.BoolRef] = field(default_factory=list)
    stubs: dict[Callable[..., Any], Stub] = field(default_factory=dict)
    roots: list[z3.BoolRef] = field(default_factory=list)
    congruences: list[z3.BoolRef] = field(default_factory=list)
    visits: list[Visit] = field(default_factory=list)
    granted: tuple[z3.BoolRef, ...] = ()
    used: list[Callable[..., Any]] = field(default_factory=list)
    wide: set[str] = field(default_factory=set)
    unseen: set[Callable[..., Any]] = field(default_factory=set)
    vouched: set[Callable[..., Any]] = field(default_factory=set)
    names: set[str] = field(default_factory=set)
    dropped: frozenset[int] = frozenset()
    weakened: Callable[[int, z3.BoolRef], z3.BoolRef] | None = None
    stated: int = 0
    uses: list[closed.Call] = field(default_factory=list)
    told: closed.Told = field(default_factory=closed.Told)

    def __repr__(self) -> str:
        raise LiftError("a claim is made into text")

    def _value(self, name: str, make: Callable[[str], Any]) -> Any:
        if name in self.names:
            raise ValueError(f"the value {name!r} is introduced twice")
        if not NAME.fullmatch(name):
            raise ValueError(f"{name!r} is no name of a value: letters, digits, _ and . only")
        self.names.add(name)
        fresh = make(self.prefix + name)
        return of_kind(self.fixed[name], fresh, name) if name in self.fixed else fresh

    def real(self, name: str) -> Any:
        """An arbitrary real number."""
        return self._value(name, lambda n: SymReal(z3.Real(n)))

    def reals(self, names: str) -> list[Any]:
        """Several, from names separated by blanks."""
        return [self.real(name) for name in names.split()]

    def integer(self, name: str) -> Any:
        """An arbitrary integer of at most 62 bits (a premise that the run time checks)."""
        value = self._value(name, lambda n: SymInt(z3.Int(n)))
        self._restrict(z3.And(value.term >= -(2**61), value.term <= 2**61))
        return value

    def whole(self, name: str) -> Any:
        """An arbitrary integer of any size: for definitions, which are never compiled."""
        value = self._value(name, lambda n: SymInt(z3.Int(n)))
        self.wide.add(str(value.term))
        return value

    def boolean(self, name: str) -> Any:
        """An arbitrary truth value."""
        return self._value(name, lambda n: SymBool(z3.Bool(n)))

    def mask(self, name: str) -> Any:
        """An arbitrary mask of 64 bits."""
        return self._value(name, lambda n: SymMask(z3.BitVec(n, 64)))

    def bits(self, value: int) -> Any:
        """A known mask."""
        return SymMask(z3.BitVecVal(value, 64))

    def vector(self, name: str) -> Vec2:
        """An arbitrary vector in the plane."""
        return Vec2(*self.reals(f"{name}.x {name}.y"))

    def premise(self, condition: Any) -> None:
        """Restrict the theorem to values that satisfy `condition`."""
        self._restrict(statement(condition))

    def _restrict(self, premise: z3.BoolRef) -> None:
        """Add a premise, unless this reading of the claim drops or weakens it (`proofs.mutation.mutate`)."""
        number, self.stated = self.stated, self.stated + 1
        if number not in self.dropped:
            weaker = premise if self.weakened is None else self.weakened(number, premise)
            self.premises.append(weaker)

    def assume(self, condition: Any, *, owner: str, reason: str) -> None:
        """Take something for granted; the ledger lists it with owner and reason."""
        self.facts.append(statement(condition))
        self.assumptions.append((str(statement(condition)), owner, reason))

    def use(self, kernel: Callable[..., Any], *args: Any, when: Any = True) -> Any:
        """Run a kernel of `core` on these values; the theorem is about it.

        when: where the call counts; elsewhere its value is arbitrary and no obligation arises.
        """
        self.used.append(kernel)
        self._name()
        where = TRUE if when is True else statement(when)
        # an opaque kernel's is unknown already
        name = "" if kernel in self.stubs else f"{self.prefix}elsewhere!{len(self.used)}"
        return closed.only_where(where, self._lift(kernel, args, where=where), kernel, name)

    def _name(self) -> None:
        for kernel in self.used:  # and those that the theorem or a lemma looks into
            if kernel not in self.stubs or kernel in self.vouched:
                self._about(kernel)

    def _about(self, kernel: Any) -> None:
        self.kernels += [qualified(kernel)] if qualified(kernel) not in self.kernels else []

    def define(self, definition: Callable[..., Any], *args: Any) -> Any:
        """Evaluate a definition of `spec` on these values."""
        return self._lift(definition, args, machine=False)

    def opaque(self, *functions: Callable[..., Any]) -> None:
        """Treat these functions as unknown: equal arguments give equal, otherwise unknown results.

        Facts about them then come only from `lemma`, whose premises are owed for the arguments of the call; the
        functions' own side conditions are owed at every call (see `closed`).
        """
        for function in functions:
            self.unseen.add(function)
            if function not in self.stubs:
                self.stubs[function] = Stub(self.prefix + qualified(function), function)

    def calls(self, function: Callable[..., Any]) -> list[tuple[Any, ...]]:
        """The arguments of every call of an opaque function so far."""
        self.asked = True
        return [] if self.hidden else list(self.stubs[function].calls)

    def congruence(
        self, function: Callable[..., Any], one: tuple[Any, ...], other: tuple[Any, ...]
    ) -> None:
        """For an opaque function: equal argument lists give equal results."""
        stub = self.stubs[function]
        fact = self.implies(self.same(one, other), self.same(stub(*one), stub(*other))).term
        self.congruences.append(fact)
        self.facts.append(fact)

    def _lift(
        self,
        function: Callable[..., Any],
        args: tuple[Any, ...],
        machine: bool = True,
        where: z3.BoolRef = TRUE,
    ) -> Any:
        """The lifted value. machine: integers are 64-bit, as in compiled code; where: when the call counts."""
        of_its_kinds(function, args)
        before = dict(OPAQUE)
        OPAQUE.update(self.stubs)
        VISITS.append([])
        met: list[tuple[Callable[..., Any], tuple[Any, ...], z3.BoolRef]] = []
        CLOSED.append(lambda f, given: met.append((f, given, path_to(where))))
        try:
            lifted = lift(function, *args)
        finally:
            CLOSED.pop()
            self.visits += [replace(v, granted=self.granted) for v in VISITS.pop()]
            OPAQUE.clear()
            OPAQUE.update(before)
        self.facts += lifted.roots
        self._closed(function, args, met, machine, where)
        self.roots += lifted.roots
        named = (n for premise in self.premises for n in free_names(premise))
        wide = self.wide.intersection(named) if machine and self.wide else set()
        for name, term in depending(args, wide) if wide else ():
            text = f"{function.__name__}: argument {name}: {RANGE}"
            self._owe("defined", text, z3.And(term >= -INT64, term < INT64))
        for text, condition in lifted.obligations:
            if machine or not text.endswith(RANGE):
                goal = condition if where is TRUE else z3.Implies(where, condition)
                self._owe("defined", f"{function.__name__}: {text}", goal)
        return lifted.value

    def _closed(
        self, function: Callable[..., Any], args: Any, met: list[Any], machine: bool, where: Any
    ) -> None:
        """Record the calls of opaque functions, for their side conditions; a lemma proves those of its own kernel."""
        if self.prefix:
            own = machine or entry_of(function) is None  # else its integers may overflow
            if own and function in self.stubs and function not in self.unseen:
                self.told.add(function, self.stubs[function].key(args), where, ())
            return
        given = (*self.premises, *self.facts)
        for called, values, path in met:
            key = self.stubs[called].key(values)
            self.uses.append(closed.Call(called, values, key, path, machine, given))

    def settle(self) -> None:
        """State the side conditions of calls of opaque functions, after everything else is stated."""
        calls, self.uses = self.uses, []
        for text, given, goal in closed.owed(calls, self.told):
            self.obligations.append(Obligation("defined", text, given, goal))

    def _owe(self, kind: str, text: str, goal: z3.BoolRef) -> None:
        given = (*self.premises, *self.facts)
        self.obligations.append(Obligation(kind, text, given, goal))

    def show(self, goal: Any, text: str = "the claim") -> None:
        """State a goal; later statements may use it."""
        Claim.step(self, goal, text)
        self.goals.append(self.facts[-1])

    def step(self, goal: Any, text: str) -> None:
        """Prove an intermediate step: later statements here may use it, a user of the lemma does not see it."""
        term = statement(goal)
        self._owe("goal", text, term)
        self.facts.append(term)

    def cases(self, *conditions: Any, goal: Any, text: str = "the claim") -> None:
        """Prove the goal case by case; that the cases are exhaustive is an obligation too."""
        terms = [statement(c) for c in conditions]
        self._owe("goal", f"{text}: the cases cover everything", z3.Or(*terms))
        for number, term in enumerate(terms, 1):
            self._owe("goal", f"{text}: case {number}", z3.Implies(term, statement(goal)))
        self.goals.append(statement(goal))
        self.facts.append(self.goals[-1])

    def lemma(self, name: str, *, when: Any = True, **values: Any) -> None:
        """Use the theorem `name` for these values where `when` holds: its premises are owed there.

        What is opaque here is opaque in the lemma too.
        """
        if name in self.circle:
            way = " -> ".join([*self.circle[self.circle.index(name) :], name])
            raise ValueError(f"the lemmas go in a circle: {way}")
        inner = self._lemma(name, values, hidden=False)
        if inner.asked:
            self.asking.add(name)
            hidden_calls.show_nothing_else(
                name, inner, lambda: self._lemma(name, values, hidden=True)
            )
        if strangers := sorted(set(inner.fixed) - inner.names):
            raise ValueError(f"the lemma {name} has no value called {', '.join(strangers)}")
        self.vouched |= inner.vouched | (set(inner.used) - inner.unseen)
        self._name()
        given = statement(when)
        self.told.through(inner.told, given, (*self.premises, *self.granted))
        self.lemmas.append(name)
        for premise in inner.premises:
            self._owe("lemma", f"premise of {name}", z3.Implies(given, premise))
        self.facts += [z3.Implies(given, goal) for goal in inner.goals]
        self.facts += inner.roots

    def _lemma(self, name: str, values: dict[str, Any], *, hidden: bool) -> Claim:
        number = sum(other == name for other in self.lemmas)
        inner = Claim(
            prefix=f"{self.prefix}{name}!{number}!",
            circle=(*self.circle, name),
            fixed=flatten(values),
            load=self.load,
            stubs=dict(self.stubs),
            hidden=hidden,
        )
        if self.load is None:
            raise RuntimeError("lemmas need a loader")
        self.load(name)(inner)
        return inner

    def implies(self, if_: Any, then: Any) -> Any:
        """Implication: if `if_` holds, so does `then`."""
        return SymBool(z3.Implies(statement(if_), statement(then)))

    def all_of(self, *conditions: Any) -> Any:
        """Conjunction of all conditions."""
        return SymBool(z3.And(*[statement(c) for c in conditions]))

    def any_of(self, *conditions: Any) -> Any:
        """Disjunction of all conditions."""
        return SymBool(z3.Or(*[statement(c) for c in conditions]))

    def negation(self, condition: Any) -> Any:
        """Negation of a condition."""
        return SymBool(z3.Not(statement(condition)))

    def when(self, condition: Any, yes: Any, no: Any) -> Any:
        """`yes` where the condition holds, else `no`."""
        term = statement(condition)
        return join([(term, yes), (z3.Not(term), no)])

    def same(self, a: Any, b: Any) -> Any:
        """Equality of two values; of tuples, field by field."""
        if isinstance(a, tuple) or isinstance(b, tuple):
            return self.all_of(*[self.same(x, y) for x, y in fields_of_both(a, b)])
        return equality(a, b)

    def fold(
        self,
        kernel_fold: Fold[Any],
        *,
        acc: Any,
        model: Any,
        item: tuple[Any, ...],
        context: tuple[Any, ...],
        relation: Callable[[Any, Any], Any],
        **definition: Unpack[DefinedBy],
    ) -> None:
        """The fold equals its definition for every number of items, by induction on it.

        acc and model are arbitrary accumulators of kernel and definition; the definition starts from `model_start`,
        proceeds by `model_step`, and its result is `model_finish` of the accumulator, if given. Base: `relation`
        holds at the start. Step: if it holds before any item it holds after it. Use: where it holds the results are
        equal; without a finish the accumulator is the result. The three are the induction over the number of items,
        provided that the accumulators are distinct free values which no premise restricts, and that neither they nor
        the relation depend on the item: checked here (see `induction`). Whatever the proof needs to know of the
        accumulators belongs in `relation`. A premise on the item applies to every item; base and use do not have it,
        since there may be no item.
        """
        if self.prefix:
            return  # used as a lemma, a fold has no goals to offer
        model_start, model_step, model_finish = side_of(definition)
        kernel_fold = REPLACED.get(kernel_fold, kernel_fold)
        arbitrary(self, (acc, model), (item, context))
        self._about(kernel_fold)
        induction = Induction(self, acc, model, item)
        before = statement(relation(acc, model))
        with induction.without_items():
            base = statement(relation(kernel_fold.start, model_start))
            induction.relation(before, base, start=model_start, context=context)
            self._owe("base", "relation at the start", base)
        # both are run only where the relation holds, so their side conditions are owed there
        plain = list(self.facts)
        self._grant(before)
        after = self.use(kernel_fold.step, acc, *item, *context)
        model_after = self.define(model_step, model, *item, *context)
        self._owe("step", "relation is kept", statement(relation(after, model_after)))
        with induction.without_items():
            finish = kernel_fold.finish
            result = acc if finish is None else self.use(finish, acc)
            wanted = model if model_finish is None else self.define(model_finish, model)
            self._owe("use", "results are equal", statement(self.same(result, wanted)))
        induction.model_only(model_after, wanted)
        # what was shown under the relation as a hypothesis holds under it only
        there = {fact.get_id() for fact in (*self.roots, *self.congruences)}
        gained = [fact for fact in self.facts[len(plain) :] if fact.get_id() in there]
        self.facts, self.granted = [*plain, *gained], ()

    def _grant(self, condition: z3.BoolRef) -> None:
        self.facts.append(condition)
        self.granted = (condition,)
