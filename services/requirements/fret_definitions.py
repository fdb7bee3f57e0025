"""Variables of FRET's that are defined by a formula over others at the same sample: conditions, and what is calculated.

Grammar: `fret_definition.lark`. A definition with `pre`, `->`, `if` or a function, one that comes back to itself, and one
of another kind than its variable is not read: a requirement that needs it says why.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from cratous.services.requirements.arithmetic import Term
from cratous.services.requirements.fret_nodes import term, tree_of
from cratous.services.requirements.fret_terms import (
    Defined,
    Meaning,
    Names,
    Unread,
    Wrong,
    grammar,
    parsed,
)
from cratous.services.requirements.units import Quantity

if TYPE_CHECKING:
    from lark import Lark


NOT_READ = "this variable is defined by a formula that is not read"
MOST = 2000
"""Variables that a definition may come to, each as often as it stands there, with those that it is made of."""


def with_definitions(names: Names) -> Names:
    """The same names, with what the definitions that can be read over them say."""
    bound, size = dict(names.bound), dict[str, int]()
    left = {name: one for name, one in bound.items() if isinstance(one, Defined)}
    inside = {name: _names_in(one.text) for name, one in left.items()}
    while left:
        known = replace(names, bound=bound)
        # what another definition says is told once that is read
        ready = {n: one for n, one in left.items() if left.keys().isdisjoint(inside[n])}
        if not ready:
            said = "this variable is defined by itself"
            return replace(names, bound={**bound, **{n: Unread(said) for n in left}})
        for name, one in ready.items():
            size[name] = sum(size.get(one, 1) for one in inside[name])
            is_long = size[name] > MOST
            bound[name] = Unread("its definition is too long") if is_long else _meaning(one, known)
            del left[name]
    return replace(names, bound=bound)


def _names_in(text: str) -> list[str]:
    try:
        tree = parsed(_parser(), text, "definitions")
    except Wrong:
        return []
    return [str(one.children[0]) for one in tree.iter_subtrees() if one.data == "truth"]


def _meaning(one: Defined, names: Names) -> Meaning:
    try:
        tree = tree_of(_parser(), one.text, "definitions", is_number=not one.is_bool)
        for node in tree.iter_subtrees():  # parts before the whole
            if node.data != "start":
                got = [getattr(child, "made", child) for child in node.children]
                node.made = term(str(node.data), got, names, int(node.meta.start_pos))
        made: Any = tree.children[0].made
    except Wrong as no:
        # of one that is defined by another the reason of that is enough
        return Unread(no.what if no.what.startswith(NOT_READ) else f"{NOT_READ}: {no.what}")
    is_signal = isinstance(made, str) and names.signals[made].kind != "bool"
    if one.is_bool == (is_signal or isinstance(made, Quantity | Term)):
        return Unread("this variable is defined as what it is not")
    found: Meaning = made
    return found


@cache
def _parser() -> Lark:
    return grammar("fret_definition.lark")
