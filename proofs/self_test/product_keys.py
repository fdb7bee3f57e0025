"""The keys of many packages, for which the product's own files are read and walked once.

A key of a package is made of walks over the product as well, which take far longer than its own and
come out the same for each package, as long as no file of the product changes, the product names
nothing of the package, and no loose statement of the package could change what the product defines.
Where one of these may be otherwise, the keys are made as always.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel import Entry
from cratous.core.ledger import kept_keys
from cratous.core.ledger.kept_keys import Found, Rests
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.module_trees import Tree
from cratous.core.ledger.package_home import PRODUCT, Home, theorems
from cratous.core.ledger.syntax_text import ANYTHING


@functools.cache
def _product() -> Keys:
    """The keys of the product, with all that they share walked."""
    keys = Keys()
    _ = keys.shared, keys._readings_border, keys._prover_border
    return keys


@functools.cache
def _named() -> frozenset[str]:
    """The packages that some module of the product names."""
    tree = _product().tree
    tables = [one for name in tree.every_module if (one := tree.table(name)) is not None]
    sources = {source for one in tables for unit in one.units for _, source, _ in unit.imports}
    sources |= {star for one in tables for star in one.stars} | tree.asked
    return frozenset(source.split(".")[0] for source in sources)


@functools.cache
def _asks_everything() -> bool:
    """Some of what all keys share depends on every file, whoever's it is."""
    walks = (_product().readings, _product().prover)
    return any(asks & ANYTHING for one in walks for asks in one.asks.values())


class PackageKeys(Keys):
    """The keys of a home; of a package, what is the product's is taken from one reading of it."""

    def __init__(self, home: Home = PRODUCT, edits: Mapping[Path, bytes] | None = None) -> None:
        if home.product or edits or home.name in _named() or _asks_everything():
            super().__init__(home, edits)
            return
        whole = _product()
        tree = Tree(
            {"cratous": PRODUCT.root, home.name: home.root},
            {"cratous": ("spec", "core", "proofs"), home.name: ("",)},
        )
        tree._tables = dict(whole.tree._tables)
        own = [name for name in _modules(home) if (table := tree.table(name)) and table.loose]
        if own:
            super().__init__(home, edits)
            return
        tree._edges, tree._meant = dict(whole.tree._edges), dict(whole.tree._meant)
        tree.open_classes, tree.asked = dict(whole.tree.open_classes), set(whole.tree.asked)
        vars(tree)["_changes"] = whole.tree._changes
        self.home, self.tree = home, tree
        self._files = {home: theorems(home), PRODUCT: whole._files[PRODUCT]}
        full = {f"{one.name}.{name}" for one, names in self._files.items() for name in names}
        self.names = frozenset(full.union(*self._files.values()))
        self._theorems, self._statement, self._walks = {}, {}, {}
        for part in ("readings", "prover", "_readings_border", "_prover_border", "shared"):
            vars(self)[part] = vars(whole)[part]


def _modules(home: Home) -> list[str]:
    """All modules of a package, its theorems among them."""
    places = (file.relative_to(home.root).with_suffix("") for file in home.root.rglob("*.py"))
    parts = (p.parts[:-1] if p.name == "__init__" else p.parts for p in places)
    return [".".join((home.name, *one)) for one in parts]


def keys_of(home: Home, known: Mapping[str, Entry], rests: Rests, data: Mapping[str, Any]) -> Found:
    """As the gate's, but of a package nothing is kept: its files live as long as the case."""
    if home.product:
        return kept_keys.keys_of(home, known, rests, data)
    keys, theorems = PackageKeys(home), data["theorems"]
    return {
        name: keys.of(entry, data["kernels"][name]["theorems"], theorems)
        for name, entry in known.items()
    }


def hold() -> None:
    """From now on this process, and those forked from it, make the keys of packages so."""
    _asks_everything(), _named()
    vars(gate).update(Keys=PackageKeys, keys_of=keys_of)
