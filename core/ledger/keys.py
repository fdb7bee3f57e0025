"""What a proof depends on, as hashes of definitions: a key for each kernel, fold and driver.

A key has parts: the entry's own definition with all that it calls; the definition in `spec`; its theorems with their
sentences and lemmas; the prover; the readings; the versions. Each is a walk from definition to definition
(`definition_hash`), so unused code is in no key, and no hash depends on locations: a move changes none. The prover
and the readings are walked once; other walks end there.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from cratous.core.kernel import Entry, checkers
from cratous.core.kernel.sources import constants, digest
from cratous.core.ledger.definition_hash import Border, Walk, walk
from cratous.core.ledger.key_parts import (
    MISSING,
    PROVER,
    READINGS,
    REMEMBERS,
    compiler,
    solver_version,
)
from cratous.core.ledger.lookup_exceptions import EXCUSED
from cratous.core.ledger.module_trees import Place, Tree
from cratous.core.ledger.package_home import PRODUCT, Home, theorem_home, theorem_names, theorems
from cratous.core.ledger.syntax_text import ANYTHING

_PRODUCT: list[Keys] = []
"""The product's keys, once requested: its names are not resolved or walked again."""


class Keys:
    """The keys of one home, from the files as they are at the first request.

    edits: replacement texts for some files.
    """

    def __init__(self, home: Home = PRODUCT, edits: Mapping[Path, bytes] | None = None) -> None:
        self.home = home
        packages = {"cratous": PRODUCT.root}
        parts: dict[str, tuple[str, ...]] = {"cratous": ("spec", "core", "proofs")}
        if not home.product:
            packages[home.name], parts[home.name] = home.root, ("",)
        self.tree = Tree(packages, parts, edits)
        taken = bool(_PRODUCT) and self.tree.take_over(_PRODUCT[0].tree)
        self._as_before = taken and home.product
        self._product = _PRODUCT[0] if taken and not home.product else None
        self._files = {one: theorems(one) for one in (home, PRODUCT)}
        self.names = frozenset(theorem_names(home, self._files))
        self._theorems: dict[str, tuple[str, tuple[str, ...]] | None] = {}
        self._statement: dict[str, Walk | None] = {}
        self._walks: dict[tuple[str, ...], Walk] = {}

    # -- walks ---------------------------------------------------------------------------------
    def places(self, name: str) -> tuple[Place, ...]:
        """The statements that bind a name, `package.module.name`; empty if there are none."""
        module, _, last = name.rpartition(".")
        if self.tree.table(module) is not None:
            found = self.tree.meant(module, (last,))
            return tuple(place for place in found if not isinstance(place, str))
        classes = self.places(module) if "." in module else ()
        methods = [
            (p[0], number, p)
            for p in classes
            for n, number in self.tree.unit(p).methods
            if n == last
        ]
        return tuple(place for home, number, own in methods for place in ((home, number), own))

    def _roots(self, names: Iterable[str]) -> list[Place]:
        found: list[Place] = []
        for name in names:
            places = self.places(f"cratous.{name}")
            if not places:
                raise LookupError(
                    f"core/ledger/key_parts.py names {name}, and there is nothing so called"
                )
            found += places
        return found

    @functools.cached_property
    def readings(self) -> Walk:
        """The walk over the readings and the gate."""
        if self._product is not None and self._walked(self._product.readings):
            return self._product.readings
        return walk(self.tree, self._roots(READINGS), excused=EXCUSED)

    @functools.cached_property
    def prover(self) -> Walk:
        """The walk over the prover, up to the readings and code that only prints or caches."""
        same = self._product is not None and self.readings is self._product.readings
        if self._product is not None and same and self._walked(self._product.prover):
            return self._product.prover
        return self.deciding(PROVER)

    def _walked(self, done: Walk) -> bool:
        """Whether a walk over the product's definitions would be the same together with this home's."""
        anything = any(asks & ANYTHING for asks in done.asks.values())
        return not anything and self.tree.walks_as(done.places)

    def asking(self, roots: Iterable[str]) -> Walk:
        """The walk over code that states obligations, up to code that only prints or caches."""
        left_out = {p: f"remembers {k}" for k, p in enumerate(self._roots(REMEMBERS))}
        border = Border(frozenset(left_out), left_out.__getitem__)
        return walk(self.tree, self._roots(roots), border, excused=EXCUSED)

    def deciding(self, roots: Iterable[str]) -> Walk:
        """The walk over code that decides, up to the readings and code that only prints or caches."""
        left_out = {p: str(k) for k, p in enumerate(self._roots(REMEMBERS))}
        places = frozenset(self.readings.places) | frozenset(left_out)

        def text(place: Place) -> str:
            other = self.readings.places.get(place)
            return f"remembers {left_out[place]}" if other is None else f"readings {other}"

        border = Border(places, text, self.readings.attributes, self.readings.classes)
        return walk(self.tree, self._roots(roots), border, excused=EXCUSED)

    @functools.cached_property
    def _readings_border(self) -> Border:
        one = self.readings
        return Border(
            frozenset(one.places),
            lambda p: f"readings {one.places[p]}",
            one.attributes,
            one.classes,
        )

    @functools.cached_property
    def _prover_border(self) -> Border:
        one, other = self.prover, self.readings

        def text(place: Place) -> str:
            number = one.places.get(place)
            return f"prover {number}" if number is not None else f"readings {other.places[place]}"

        return Border(
            frozenset(one.places) | frozenset(other.places),
            text,
            one.attributes | other.attributes,
            (*one.classes, *other.classes),
        )

    # -- functions -----------------------------------------------------------------------------
    def function(self, *names: str) -> Walk | None:
        """The walk over these functions, folds or classes; None if one is missing."""
        if names not in self._walks:
            places = [self.places(name) for name in names]
            if not all(places):
                return None
            roots = [place for some in places for place in some]
            self._walks[names] = walk(self.tree, roots, self._readings_border, excused=EXCUSED)
        return self._walks[names]

    def source(self, entry: Entry) -> str:
        """An entry with all that it calls, the values of its constants, and the kernels that re-check it."""
        found = self.function(entry.name, *(checkers(entry) if entry.kind == "driver" else ()))
        return MISSING if found is None else digest([found.digest, *constants(entry.function)])

    def definition(self, entry: Entry) -> str:
        """The definition that an entry implements; empty if it names none."""
        if not entry.implements:
            return ""
        found = self.function(f"{self.home.name}.spec.{entry.implements}")
        return MISSING if found is None else found.digest

    # -- theorems ------------------------------------------------------------------------------
    def _theorem(self, name: str) -> tuple[str, tuple[str, ...]] | None:
        """The hash of one theorem file, and the theorems that it names, in order."""
        if name not in self._theorems:
            self._theorems[name] = self._read(name)
        return self._theorems[name]

    def statement(self, name: str) -> Walk | None:
        """The walk over a theorem's statement; None if there is no such theorem."""
        if name not in self._statement:
            module = self._module(name)
            roots = self.places(f"{module}.claim") if module else ()
            border = self._prover_border
            found = walk(self.tree, roots, border, self.names, EXCUSED) if roots else None
            self._statement[name] = found
        return self._statement[name]

    def _module(self, name: str) -> str | None:
        home = theorem_home(name, self.home, self._files)
        if home is None:
            return None
        return home.module(self._files[home][name.rpartition(".")[2]])

    def _read(self, name: str) -> tuple[str, tuple[str, ...]] | None:
        found = self.statement(name)
        if found is None:
            return None
        table = self.tree.table(self._module(name) or "")
        return digest([table.sentence if table else "", found.digest]), found.strings

    def theorem(self, name: str, lemmas: Mapping[str, Iterable[str]] | None = None) -> str:
        """A hash of a theorem's meaning and of the lemmas that it depends on, independent of their names.

        lemmas: those known to be used, beside those named. `MISSING` if one is missing.
        """
        order, numbers, parts = [name], {name: 0}, []
        for one in order:
            found = self._theorem(one)
            if found is None:
                return MISSING
            own, named = found
            used = sorted(set((lemmas or {}).get(one, ())) - set(named))
            for other in (*named, *used):
                if other not in numbers:
                    numbers[other] = len(order)
                    order.append(other)
            parts.append(f"{own} {[numbers[other] for other in (*named, *used)]}")
        return digest(parts)

    def theorems(self, names: Iterable[str], records: Mapping[str, Any] | None = None) -> str:
        """A hash of the meaning of several theorems; records: the ledger's, which name the lemmas that were used."""
        lemmas = {n: record.get("lemmas", ()) for n, record in (records or {}).items()}
        found = sorted(self.theorem(name, lemmas) for name in names)
        return MISSING if MISSING in found else digest(found)

    def _statements(self, name: str) -> Iterator[Walk]:
        """The walks of a theorem and of all theorems that it names."""
        names, done = [name], set()
        while names:
            one = names.pop()
            found = self.statement(one) if one not in done else None
            done.add(one)
            if found is not None:
                yield found
                names += found.strings

    def asks_registry(self, name: str) -> bool:
        """Whether a theorem, or a lemma of it, looks up registered items."""
        return any(found.registry for found in self._statements(name))

    def lemmas(self, name: str) -> frozenset[str]:
        """The names by which a theorem, and the lemmas that it depends on, refer to others."""
        return frozenset(other for found in self._statements(name) for other in found.strings)

    def functions(self, name: str) -> frozenset[str]:
        """Qualified names of all functions, folds and classes that a theorem or a lemma could refer to."""
        found: set[str] = set()
        for one in self._statements(name):
            found |= {self.name(place) for place in one.places}
            for place in one.edge:  # kernels that the readings are made of
                found.add(self.name(place))
                inner = self.function(self.name(place)) if place in self.readings.places else None
                found |= {self.name(p) for p in (inner.places if inner else ())}
        return frozenset(found)

    def name(self, place: Place) -> str:
        """The qualified name of the definition at a place."""
        return f"{place[0]}.{self.tree.unit(place).name}"

    # -- keys ----------------------------------------------------------------------------------
    @functools.cached_property
    def shared(self) -> dict[str, str]:
        """The parts that all entries share."""
        found = {
            "prover": self.prover.digest,
            "solver": solver_version(),
            "readings": self.readings.digest,
            "flags": compiler(),
        }
        if self.home.product and not self.tree.edits and not self._as_before:
            _PRODUCT[:] = [self]
        return found

    def of(
        self, entry: Entry, names: Iterable[str], records: Mapping[str, Any] | None = None
    ) -> dict[str, str]:
        """All parts of an entry's key; names: its theorems; records: those of the ledger."""
        return {
            "source": self.source(entry),
            "spec": self.definition(entry),
            "theorems": self.theorems(names, records),
            **self.shared,
        }
