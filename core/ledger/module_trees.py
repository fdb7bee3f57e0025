"""A tree of modules as written, and the definitions that a name in one of them refers to.

A tree need not be the one that runs: nothing of it is imported. Names are followed through imports, `import *` and
submodules to the statements that bind them; names bound by no module of the tree are external.
"""

from __future__ import annotations

import functools
import hashlib
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from cratous.core.ledger.tables import Table, Unit, table

Place = tuple[str, int]
"""A unit: its module, and its index there."""
Target = Place | str
"""What a name refers to: a unit of the tree, or a text for something external."""


class Tree:
    """Packages by name, with their folders. parts: folders of each whose loose statements are included.

    edits: replacement texts for some files.
    """

    def __init__(
        self,
        packages: Mapping[str, Path],
        parts: Mapping[str, tuple[str, ...]],
        edits: Mapping[Path, bytes] | None = None,
    ) -> None:
        self.packages, self.parts = dict(packages), dict(parts)
        self.edits = dict(edits or {})
        self._tables: dict[str, Table | None] = {}
        self._edges: dict[Place, tuple[tuple[str, tuple[Target, ...]], ...]] = {}
        self._meant: dict[tuple[str, tuple[str, ...]], tuple[Target, ...]] = {}
        self._imported: dict[tuple[str, str, tuple[str, ...]], tuple[Target, ...]] = {}
        self._open: set[tuple[str, tuple[str, ...]]] = set()
        self._circles: set[tuple[str, tuple[str, ...]]] = set()
        self._found: dict[str, str | None] = {}
        self._folders: dict[str, bool] = {}
        self._before: Tree | None = None
        self.open_classes: dict[Place, bool] = {}
        self.asked: set[str] = set()
        """The modules and folders that were looked for."""

    def take_over(self, other: Tree) -> bool:
        """Reuse the name resolution of another tree, whose packages are some of this one's.

        Only if every file that it has read, and every name that it looked up, is unchanged here, and it imports
        nothing from this tree's other packages: then each name has the same meaning here.
        """
        mine = {name: self.packages.get(name) for name in other.packages}
        more = self.packages.keys() - other.packages.keys()
        if (
            self.edits
            or other.edits
            or mine != other.packages
            or not other.outside.isdisjoint(more)
        ):
            return False
        same = (
            all(self.table(name) is one for name, one in other._tables.items())
            and all(self._where(name) == one for name, one in other._found.items())
            and all(self._folder(name) == one for name, one in other._folders.items())
        )
        if same:
            self._meant |= other._meant
            self._imported |= other._imported
            self._before = other
        return same

    def walks_as(self, places: Iterable[Place]) -> bool:
        """Whether a walk of the reused tree that found these places would be the same here.

        It is not if loose statements of the other packages change them.
        """
        before = self._before
        return before is not None and all(
            self._changes.get(place) == before._changes.get(place) for place in places
        )

    @property
    def outside(self) -> frozenset[str]:
        """The external packages from which the modules read so far import."""
        read = [one for one in self._tables.values() if one is not None]
        named = {source for one in read for unit in one.units for _, source, _ in unit.imports}
        named.update(star for one in read for star in one.stars)
        return frozenset(source.split(".")[0] for source in named) - self.packages.keys()

    # -- modules ----------------------------------------------------------------------------------
    def file(self, module: str) -> Path | None:
        """The source file of a module of the tree."""
        found = self._where(module)
        return None if found is None else Path(found)

    def _where(self, module: str) -> str | None:
        self.asked.add(module)
        if module not in self._found:
            self._found[module] = self._file(module)
        return self._found[module]

    def _file(self, module: str) -> str | None:
        top, *parts = module.split(".")
        if top not in self.packages:
            return None
        base = os.sep.join((os.fspath(self.packages[top]), *parts))
        inside = f"{base}{os.sep}__init__.py"
        if not parts:
            return inside if os.path.isfile(inside) else None
        for name in (inside, f"{base}.py"):  # of the two, Python runs the folder
            if os.path.isfile(name) or (self.edits and Path(name) in self.edits):
                return name
        return None

    def table(self, module: str) -> Table | None:
        """The definitions of a module; None if it is not part of the tree."""
        if module not in self._tables:
            file = self._where(module)
            self._tables[module] = None if file is None else self._read(file, module)
        return self._tables[module]

    def _read(self, file: str, module: str) -> Table:
        data = self.edits.get(Path(file)) if self.edits else None
        if data is None:
            with open(file, "rb") as text:
                data = text.read()
        return table(data, module, os.path.basename(file) == "__init__.py")

    def unit(self, place: Place) -> Unit:
        """The unit there."""
        found = self.table(place[0])
        assert found is not None
        return found.units[place[1]]

    @functools.cached_property
    def every_module(self) -> tuple[str, ...]:
        """The modules of all parts of the packages."""
        found: set[str] = set()
        for package, root in self.packages.items():
            for part in self.parts.get(package, ()):
                found.update(_modules(package, root, part))
        return tuple(sorted(found))

    @functools.cached_property
    def everything(self) -> str:
        """The contents of all of these modules, and of the data files beside them."""
        said = [one.digest for name in self.every_module if (one := self.table(name)) is not None]
        for package, root in self.packages.items():
            for part in self.parts.get(package, ()):
                said += map(_data, _data_files(root / part))
        return " ".join(sorted(said))

    # -- names ------------------------------------------------------------------------------------
    def meant(self, module: str, chain: tuple[str, ...]) -> tuple[Target, ...]:
        """What a name with its attributes refers to in a module; empty for a builtin."""
        key = (module, chain)
        if key in self._meant:
            return self._meant[key]
        if key in self._open:
            self._circles.add(key)  # imports that go in a circle bind nothing
            return ()
        self._open.add(key)
        found = tuple(dict.fromkeys(self._bound(module, chain)))
        self._open.discard(key)
        self._circles.discard(key)
        if not self._circles:  # else it lacks what an open one will bind
            self._meant[key] = found
        return found

    def _bound(self, module: str, chain: tuple[str, ...]) -> Iterator[Target]:
        found = self.table(module)
        if found is None:
            return
        name, rest = chain[0], chain[1:]
        for number in found.bound.get(name, ()):
            unit = found.units[number]
            if unit.kind == "import":
                _, source, there = unit.imports[0]
                yield from self.imported(source, there, rest)
            else:
                yield module, number
        for star in found.stars:
            if self.table(star) is None:
                yield f"{star}.*"
            else:
                yield from self.meant(star, chain)
        if name not in found.bound and name != "__getattr__" and "__getattr__" in found.bound:
            yield from self.meant(module, ("__getattr__",))

    def imported(self, source: str, there: str, rest: tuple[str, ...]) -> Iterator[Target]:
        """What `from source import there`, or `import source`, refers to with these attributes."""
        if source.split(".")[0] not in self.packages:
            yield f"{source}.{there}"
            return
        key = (source, there, rest)
        found = self._imported.get(key)
        if found is None:
            found = tuple(self._inside(source, (there, *rest) if there else rest))
            if not self._circles:
                self._imported[key] = found
        yield from found

    def _inside(self, module: str, chain: tuple[str, ...]) -> Iterator[Target]:
        if not chain:
            yield from self.whole(module)
            return
        inner = f"{module}.{chain[0]}"
        found = self.meant(module, chain)
        yield from found
        if self._where(inner) is not None or self._folder(inner):
            yield from self._inside(inner, chain[1:])
        elif not found:
            yield f"nothing called {chain[0]}"

    def _folder(self, module: str) -> bool:
        if module not in self._folders:
            top, *parts = module.split(".")
            inside = top in self.packages
            self._folders[module] = inside and os.path.isdir(
                os.path.join(self.packages[top], *parts)
            )
        return self._folders[module]

    def whole(self, module: str) -> Iterator[Target]:
        """Everything that a module defines, for a use that cannot be resolved."""
        found = self.table(module)
        if found is None:
            yield "a package"
            return
        yield from ((module, n) for n, u in enumerate(found.units) if u.kind != "import")
        for unit in found.units:
            if unit.kind == "import":
                name, source, there = unit.imports[0]
                if there and name not in ("annotations",):
                    yield from self.imported(source, there, ())

    # -- edges ------------------------------------------------------------------------------------
    def edges(self, place: Place) -> tuple[tuple[str, tuple[Target, ...]], ...]:
        """What a unit looks up: each name, as written, with what it refers to."""
        if place not in self._edges:
            self._edges[place] = tuple(self._edges_of(place))
        return self._edges[place]

    def _edges_of(self, place: Place) -> Iterator[tuple[str, tuple[Target, ...]]]:
        module, number = place
        unit = self.unit(place)
        for chain in unit.names:
            if targets := self.meant(module, tuple(chain.split("."))):
                yield chain, targets
        for name, source, there in unit.imports:
            yield name, tuple(self.imported(source, there, ()))
        found = self.table(module)
        assert found is not None
        if loose := [(module, n) for n in found.loose if n != number]:
            yield "loose", tuple(loose)
        if changed := self._changes.get(place):
            yield "changed by", changed

    @functools.cached_property
    def _changes(self) -> dict[Place, tuple[Place, ...]]:
        """Units of other modules that a module's loose statements mention and so may change."""
        found: dict[Place, list[Place]] = {}
        known: frozenset[str] = frozenset()
        if self._before is not None:  # each of its names means the same here
            known = frozenset(self._before.every_module)
            found = {place: list(some) for place, some in self._before._changes.items()}
        for module in self.every_module:
            one = self.table(module) if module not in known else None
            for number in one.loose if one is not None else ():
                for target in self._mentioned((module, number)):
                    if target[0] != module:
                        found.setdefault(target, []).append((module, number))
        # in the order of the modules, whoever looked them up
        return {p: tuple(sorted(some, key=lambda one: one[0])) for p, some in found.items()}

    def _mentioned(self, place: Place) -> set[Place]:
        seen: set[Place] = set()
        todo = [place]
        while todo:
            one = todo.pop()
            if one in seen:
                continue
            seen.add(one)
            unit = self.unit(one)
            found = [t for n in unit.names for t in self.meant(one[0], tuple(n.split(".")))]
            found += [t for _, source, n in unit.imports for t in self.imported(source, n, ())]
            todo += [target for target in found if not isinstance(target, str)]
        return seen


DATA = (".lark", ".conf")
"""Data files that the modules may read; ledger records, which decide nothing, are not among them."""


def _modules(package: str, root: Path, part: str) -> Iterator[str]:
    """The dotted names of the files below a folder of a package."""
    for at, folders, files in os.walk(root / part):
        folders.sort()
        inside = os.path.relpath(at, root)
        around = [package, *(() if inside == os.curdir else inside.split(os.sep))]
        for file in files:
            if file == "__init__.py":
                yield ".".join(around)
            elif file.endswith(".py"):
                yield ".".join((*around, file.removesuffix(".py")))


def _data_files(folder: Path) -> Iterator[Path]:
    for at, _, files in os.walk(folder):
        yield from (Path(at, file) for file in files if file.endswith(DATA))


@functools.cache
def _data(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
