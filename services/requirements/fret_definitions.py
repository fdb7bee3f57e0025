"""FRET variables defined by a formula over others, at the same sample or, if samples are counted,
the previous one: conditions and computed numbers.

Grammar: `fret_definition.lark`. A cyclic definition is not read, except for a number that refers to
its own previous value; nor is one whose type differs from its variable's. A requirement that needs
such a variable states why it is not read.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from cratous.services.requirements.arithmetic import Term
from cratous.services.requirements.fret_nodes import STREAMS, term, tree_of
from cratous.services.requirements.fret_streams import begun, named, only_before, stream
from cratous.services.requirements.fret_terms import (
    Defined,
    Meaning,
    Names,
    Unread,
    Wrong,
    grammar,
)
from cratous.services.requirements.specification import Signal
from cratous.services.requirements.units import Quantity

if TYPE_CHECKING:
    from lark import Lark


NOT_READ = "this variable is defined by a formula that is not read"
MOST = 2000
"""Maximum size of a definition: variables in it with those of their definitions, repetitions counted."""


def with_definitions(names: Names) -> Names:
    """The same names, with the meaning of every definition that can be read."""
    bound, size = dict(names.bound), dict[str, int]()
    left = {name: one for name, one in bound.items() if isinstance(one, Defined)}
    trees = {name: _tree(one) for name, one in left.items()}
    inside = {name: _names_in(name, tree) for name, tree in trees.items()}
    while left:
        known = replace(names, bound=bound)
        # a definition is resolved once all definitions that it uses are
        ready = {n: one for n, one in left.items() if left.keys().isdisjoint(inside[n])}
        if not ready:
            said = "this variable is defined by itself"
            return replace(names, bound={**bound, **{n: Unread(said) for n in left}})
        for name, one in ready.items():
            size[name] = sum(size.get(one, 1) for one in inside[name])
            is_long, tree = size[name] > MOST, trees[name]
            bound[name] = (
                Unread("its definition is too long")
                if is_long
                else _unread(tree)
                if isinstance(tree, Wrong)
                else _meaning(name, one, tree, known)
            )
            del left[name]
    return replace(names, bound=bound)


def _tree(one: Defined) -> Any:
    """The syntax tree of a definition, or the reason why there is none."""
    try:
        tree = tree_of(_parser(), one.text, "definitions", is_number=not one.is_bool)
        begun(tree)
    except Wrong as no:
        return no
    return tree


def _names_in(own: str, tree: Any) -> list[str]:
    """The variables in a definition; without itself if it occurs only under `pre`."""
    if isinstance(tree, Wrong):
        return []
    kinds = ("truth", "name")
    found = [str(one.children[0]) for one in tree.iter_subtrees() if str(one.data) in kinds]
    return [name for name in found if name != own] if only_before(tree, own) else found


def _unread(no: Wrong) -> Unread:
    # the reason of the definition that it depends on is enough
    return Unread(no.what if no.what.startswith(NOT_READ) else f"{NOT_READ}: {no.what}")


def _meaning(name: str, one: Defined, tree: Any, names: Names) -> Meaning:
    recursive = any(name == str(n.children[0]) for n in tree.iter_subtrees() if n.data == "name")
    if recursive:  # at the previous sample it is a number of that name
        signals = {**names.signals, name: Signal("float")}
        names = replace(names, signals=signals, bound={**names.bound, name: name})
    try:
        for node in tree.iter_subtrees():  # children before parents
            if node.data != "start":
                got = [getattr(child, "made", child) for child in node.children]
                kind = str(node.data)
                node.made = (
                    stream(node, got, names)
                    if kind in STREAMS
                    else term(kind, got, names, int(node.meta.start_pos))
                )
        made: Any = tree.children[0].made
    except Wrong as no:
        return _unread(no)
    is_signal = isinstance(made, str) and names.signals[made].kind != "bool"
    if one.is_bool == (is_signal or isinstance(made, Quantity | Term)):
        return Unread("this variable is defined as what it is not")
    if recursive and isinstance(made, Term):
        made = named(name, made)
    found: Meaning = made
    return found


@cache
def _parser() -> Lark:
    return grammar("fret_definition.lark")
