"""One hash for a definition and all its dependencies, independent of their location.

A walk follows names from its roots to definitions, and numbers these in the order of their discovery: names are taken
in order, so the numbers follow from the text alone. The hash covers what each definition says and the number that
each of its names refers to. A class is included with its dunder methods; another method is included once something
already included names it, whatever object it is named of.
"""

from __future__ import annotations

import fnmatch
import functools
import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from cratous.core.ledger.module_trees import Place, Target, Tree
from cratous.core.ledger.syntax_text import ANY_ATTRIBUTE, ANYTHING, EVERY, REGISTERED

CLOSED = frozenset(
    {
        "object", "NamedTuple", "Generic", "Protocol", "ABC", "Exception", "ValueError", "TypeError",
        "RuntimeError", "KeyError", "ArithmeticError", "tuple",
    }
)  # fmt: skip
"""External bases that call no method of a class other than dunder methods."""


@dataclass(frozen=True)
class Walk:
    """What a walk has found, numbered.

    edge: what it found at the border; asks: by place, dynamic look-ups in its code (`syntax_text.Reading`), without
    the excused ones; registry: it looks up registered items, excused or not; strings: known names, in order.
    """

    digest: str
    places: dict[Place, int]
    attributes: frozenset[str]
    classes: tuple[Place, ...]
    edge: frozenset[Place]
    asks: dict[Place, frozenset[str]]
    registry: bool
    strings: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Border:
    """Where a walk ends: places hashed elsewhere, each with a text that represents it.

    attributes, classes: those of the code behind the border, which may refer to code before it.
    """

    places: frozenset[Place] = frozenset()
    text: Callable[[Place], str] = str
    attributes: frozenset[str] = frozenset()
    classes: tuple[Place, ...] = ()


def walk(
    tree: Tree,
    roots: Iterable[Place],
    border: Border | None = None,
    known: frozenset[str] = frozenset(),
    excused: Mapping[str, frozenset[str]] | None = None,
) -> Walk:
    """Walk from the roots. known: texts that name something hashed elsewhere.

    excused: by `module.definition`, dynamic look-ups that need not be followed there; code that looks up any code or
    file in another way depends on everything.
    """
    one = _Walk(tree, border or Border(), known, excused or {})
    for root in roots:
        one.meet(root)
    one.go()
    return one.result()


class _Walk:
    def __init__(
        self,
        tree: Tree,
        border: Border,
        known: frozenset[str],
        excused: Mapping[str, frozenset[str]],
    ) -> None:
        self.tree, self.border, self.known, self.excused = tree, border, known, excused
        self.places: dict[Place, int] = {}
        self.todo: list[Place] = []
        self.classes: list[Place] = list(border.classes)
        self.methods_of = list(_methods_beyond(tree, border))
        self.attributes = set(border.attributes)
        self.edge: set[Place] = set()
        self.asks: dict[Place, frozenset[str]] = {}
        self.registry = False
        self.strings: dict[str, int] = {}
        self.sha = hashlib.sha256()

    def say(self, text: str) -> None:
        self.sha.update(f"{len(text)}:{text}".encode())

    def meet(self, place: Place) -> str:
        if place not in self.places:
            self.places[place] = len(self.places)
            self.todo.append(place)
        return str(self.places[place])

    def text(self, target: Target) -> str:
        if isinstance(target, str):
            return f"outside {target}"
        if target in self.border.places and target not in self.places:
            self.edge.add(target)
            return self.border.text(target)
        return self.meet(target)

    def go(self) -> None:
        while True:
            while self.todo:
                self.unit(self.todo.pop(0))
            if not self.methods():
                return

    def unit(self, place: Place) -> None:
        unit = self.tree.unit(place)
        self.say(unit.digest)
        for word in unit.strings:
            names = _fitting(word, self.known)
            for name in names:
                self.strings.setdefault(name, len(self.strings))
            # which name it is follows from the order of discovery
            self.say(f"names {[self.strings[name] for name in names]}" if names else word)
        for chain, targets in self.tree.edges(place):
            self.say(chain)
            for target in targets:
                self.say(self.text(target))
        asks = frozenset(unit.asks) - self.excused.get(f"{place[0]}.{unit.name}", frozenset())
        if asks:
            self.asks[place] = asks
        if not REGISTERED.isdisjoint(unit.asks):
            self.registry = True
        if asks & ANYTHING:
            self.say(self.tree.everything)
        if asks & ANY_ATTRIBUTE:
            self.attributes.add(EVERY)
        self.attributes.update(unit.attributes)
        if unit.kind == "class":
            self.classes.append(place)
            self.methods_of.append((place, unit.methods))

    def methods(self) -> bool:
        """Add the methods that are named so far; True iff there was one."""
        found = False
        for place, methods in self.methods_of:
            every = EVERY in self.attributes or open_class(self.tree, place)
            for name, number in methods:
                method = (place[0], number)
                if not (every or name in self.attributes) or method in self.places:
                    continue
                if method in self.border.places:
                    continue
                self.say(f"method {self.places.get(place, 'beyond')} {name} {self.meet(method)}")
                found = True
        return found

    def result(self) -> Walk:
        return Walk(
            self.sha.hexdigest(),
            self.places,
            frozenset(self.attributes),
            tuple(self.classes),
            frozenset(self.edge),
            dict(self.asks),
            self.registry,
            tuple(self.strings),
        )


@functools.lru_cache(maxsize=8)
def _methods_beyond(
    tree: Tree, border: Border
) -> tuple[tuple[Place, tuple[tuple[str, int], ...]], ...]:
    """The classes of a border with those of their methods that a walk up to it may add."""
    return tuple(
        (place, beyond)
        for place in border.classes
        if (
            beyond := tuple(
                (name, number)
                for name, number in tree.unit(place).methods
                if (place[0], number) not in border.places
            )
        )
    )


@functools.cache
def _fitting(word: str, known: frozenset[str]) -> tuple[str, ...]:
    """The known names that a text equals, or could become."""
    if "*" not in word:
        return (word,) if word in known else ()
    fits = [n for n in known if ("." in n) == ("." in word) and fnmatch.fnmatchcase(n, word)]
    return tuple(sorted(fits))


def open_class(tree: Tree, place: Place) -> bool:
    """Whether a class has an external base, which may call any of its methods."""
    if place not in tree.open_classes:
        tree.open_classes[place] = True  # a circle of bases is no Python
        tree.open_classes[place] = _open(tree, place)
    return tree.open_classes[place]


def _open(tree: Tree, place: Place) -> bool:
    for chain in tree.unit(place).bases:
        targets = tree.meant(place[0], tuple(chain.split(".")))
        for target in targets:
            if isinstance(target, str):
                if target.rpartition(".")[2] not in CLOSED:
                    return True
            elif tree.unit(target).kind == "class" and open_class(tree, target):
                return True
        if not targets and chain.rpartition(".")[2] not in CLOSED:
            return True
    return False
