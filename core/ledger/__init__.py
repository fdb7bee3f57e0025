"""The ledger's gate: a kernel flies only with the source that was proved.

A ledger is written by `cratous prove`: the product's is `core/ledger.json`, a package with kernels
of its own has `<package>/ledger.json`. For every registered kernel, fold and driver it keeps the
parts of its key: its own syntax tree with all that it calls, the definition in `spec`, its
theorems with everything they take from elsewhere, the prover, the solver, the readings (how a
kernel becomes machine code or an exact verdict) and the compiler. `check` computes them anew and
names whatever differs; it also holds the code that runs against the file that was hashed.
"""

from __future__ import annotations

import ast
import functools
import importlib
import importlib.metadata
import json
import os
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.core.kernel import REGISTRY, Entry, checkers, named
from cratous.core.kernel.names import short
from cratous.core.kernel.sources import (
    ROOT,
    add_package,
    altered,
    closure,
    digest,
    files_digest,
    function_parts,
    position,
    statement_parts,
    tree,
)
from cratous.core.readings.machine.compiled import FLAGS
from cratous.spec.errors import BadInput, Refused

PARTS = {
    "source": "its source or that of something it calls",
    "spec": "its definition in spec",
    "theorems": "its theorems",
    "prover": "the prover",
    "solver": "the solver's version",
    "readings": "the readings (core/readings/machine/compiled.py, the exact reading, the registry)",
    "flags": "the compiler flags or the versions of numba, llvmlite, numpy",
}
READINGS = (
    "kernel/__init__.py",
    "kernel/sources.py",
    "readings/machine/compiled.py",
    "readings/exact/__init__.py",
    "ledger/__init__.py",
)
"""With all that they import from core: how a kernel is marked, compiled, read, and held to this."""
COMPILER = ("numba", "llvmlite", "numpy")


@dataclass(frozen=True)
class Home:
    """A package with kernels: its name and folder, and where its parts lie in it."""

    name: str
    root: Path

    @property
    def product(self) -> bool:
        """True iff it is the product itself."""
        return self.name == "cratous"

    @property
    def ledger(self) -> Path:
        """Its ledger."""
        return self.root / "core" / "ledger.json" if self.product else self.root / "ledger.json"

    @property
    def theorems(self) -> Path:
        """The folder of its theorem files."""
        return self.root / "proofs" / "theorems" if self.product else self.root / "theorems"

    def definition(self, implements: str) -> Path:
        """The file of a definition, named as `module.function` or `folder.module.function`."""
        module = self.root.joinpath("spec", *implements.split(".")[:-1])
        return module / "__init__.py" if module.is_dir() else module.with_suffix(".py")

    def modules(self) -> Iterator[str]:
        """Every module that may hold kernels."""
        folder = self.root / "core" if self.product else self.root
        for file in sorted(folder.rglob("*.py")):
            parts = file.relative_to(self.root).with_suffix("").parts
            if parts[0] != "theorems" and parts[-1] not in ("__init__", "__main__"):
                yield ".".join((self.name, *parts))


PRODUCT = Home("cratous", ROOT)
LEDGER = PRODUCT.ledger


def package(name: str) -> Home:
    """The home of an installed or importable package with kernels of its own.

    Raises BadInput if there is no such package.
    """
    if name == "cratous":
        return PRODUCT
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        raise BadInput(
            f"the package cannot be imported ({error})",
            item=name,
            expected="the name of a package on the Python path",
        ) from error
    if not getattr(module, "__path__", None) or "." in name:
        raise BadInput(
            "this is a module, not a package", item=name, expected="a top-level folder of modules"
        )
    root = Path(next(iter(module.__path__))).resolve()
    add_package(name, root)
    return Home(name, root)


@dataclass(frozen=True)
class Problem:
    """A kernel that the ledger does not vouch for: its name, and what is wrong."""

    name: str
    what: str


@dataclass(frozen=True)
class Standing:
    """The result of holding the running code against the ledger.

    kernels: how many kernels and folds there are; drivers are checked by kernels, not proved.
    """

    kernels: int
    theorems: int
    assumptions: int
    problems: tuple[Problem, ...]

    @property
    def line(self) -> str:
        """One line for the terminal and the report."""
        text = f"{self.kernels} kernels, {self.theorems} theorems proved, "
        text += f"{self.assumptions} assumptions"
        return text if not self.problems else f"{text}; {len(self.problems)} NOT VOUCHED FOR"


def _top(entry: Entry) -> str:
    return entry.name.split(".")[0]


def load_all(home: Home = PRODUCT) -> dict[str, Entry]:
    """Import every module that may hold kernels; the registered ones of this home, by name.

    Raises BadInput for a module of another package that cannot be imported.
    """
    for name in home.modules():
        try:
            importlib.import_module(name)
        except (ImportError, SyntaxError, ValueError) as error:
            if home.product:
                raise
            raise BadInput(f"the module cannot be imported: {error}", where=name) from error
    return {n: entry for n, entry in sorted(REGISTRY.items()) if _top(entry) == home.name}


def read(path: Path = LEDGER) -> dict[str, Any]:
    """The ledger as data; empty where there is none."""
    if not path.is_file():
        return {"kernels": {}, "theorems": {}}
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["seal"] != seal(data):
            raise Refused(f"{path.name} was edited after the prover wrote it; run `cratous prove`")
        if not isinstance(data["kernels"], dict) or not isinstance(data["theorems"], dict):
            raise TypeError("kernels and theorems must be objects")
    except (ValueError, KeyError, TypeError) as error:
        raise Refused(f"{path.name} cannot be read ({error!r}); run `cratous prove`") from error
    return dict(data)


def seal(data: dict[str, Any]) -> str:
    """A checksum over the ledger's contents: notices edits by hand and broken merges."""
    body = {key: value for key, value in data.items() if key != "seal"}
    return digest([json.dumps(body, sort_keys=True)])


@functools.cache
def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def solver_version() -> str:
    """The installed z3."""
    return f"z3 {_version('z3-solver')}"


def compiler() -> str:
    """How machine code is made: numba's flags, and the versions that decide what they mean."""
    return "; ".join([FLAGS, *(f"{name} {_version(name)}" for name in COMPILER)])


@functools.cache
def engine() -> frozenset[Path]:
    """The files that decide what `proved` means: the prover and all of proofs that it imports."""
    roots = [
        ROOT / "proofs" / name
        for name in ("engine/prover.py", "engine/subset.py", "ledger/__init__.py")
    ]
    found = closure(*[file for file in roots if file.is_file()])
    return frozenset(file for file in found if file.is_relative_to(ROOT / "proofs"))


@functools.cache
def _tools() -> dict[str, str]:
    """The parts of the key that all kernels share."""
    roots = [ROOT / "core" / name for name in READINGS]
    readings = [file for file in closure(*roots) if file.is_relative_to(ROOT / "core")]
    return {
        "prover": files_digest(sorted(engine())),
        "solver": solver_version(),
        "readings": files_digest(readings),
        "flags": compiler(),
    }


def _source(entry: Entry) -> str:
    if entry.kind == "driver":
        module = sys.modules[entry.function.__module__]
        return digest(
            [files_digest(closure(Path(str(module.__file__)).resolve())), repr(checkers(entry))]
        )
    return digest(function_parts(entry.function))


def theorem_file(name: str, home: Home) -> Path | None:
    """The file of a theorem, called so or `package.name`: of this home, else of the product."""
    package, _, plain = name.rpartition(".")
    for one in (home, PRODUCT):
        if package in ("", one.name) and plain in _theorems(one):
            return _theorems(one)[plain]
    return None


def _theorems(home: Home) -> dict[str, Path]:
    """What could be a theorem of this home: the files by name."""
    found: dict[str, Path] = {}
    for folder, _, names in os.walk(home.theorems):
        for name in names:
            if name.endswith(".py"):
                file = Path(folder, name)
                found[theorem_name(file, home.theorems)] = file
    return found


def theorem_name(file: Path, folder: Path) -> str:
    """How the theorem of a file is called: its folders below `theorems` and itself, with `_`."""
    return "_".join(file.relative_to(folder).with_suffix("").parts)


def theorem_names(home: Home) -> set[str]:
    """What could name a theorem of this home or of the product, alone or after its package."""
    known = {one: _theorems(one) for one in (home, PRODUCT)}
    whole = {f"{one.name}.{name}" for one, names in known.items() for name in names}
    return {name for names in known.values() for name in names} | whole


@functools.cache
def _statement(path: Path) -> str:
    return digest(statement_parts(path, engine()))


@functools.cache
def mentioned(path: Path) -> frozenset[str]:
    """All texts in a theorem file that could be the name of a lemma."""
    nodes = ast.walk(tree(path))
    texts = {n.value for n in nodes if isinstance(n, ast.Constant) and isinstance(n.value, str)}
    return frozenset(text for text in texts if text.replace(".", "_").isidentifier())


def theorem_digest(names: Iterable[str], theorems: dict[str, Any], home: Home = PRODUCT) -> str:
    """The meaning of some theorem files and of the lemmas that they rest on.

    Lemmas are what the ledger lists for a theorem and whatever its file names as text.
    """
    todo, parts = list(names), {}
    known = theorem_names(home)
    while todo:
        name = todo.pop()
        if name in parts:
            continue
        file = theorem_file(name, home)
        if file is None:
            return "missing"
        parts[name] = _statement(file)
        todo += theorems.get(name, {}).get("lemmas", [])
        todo += mentioned(file) & known
    return digest(f"{name}={text}" for name, text in sorted(parts.items()))


def key_parts(
    entry: Entry, names: list[str], theorems: dict[str, Any], home: Home = PRODUCT
) -> dict[str, str]:
    """All parts of a kernel's key as the code stands now; names are its theorems."""
    spec = ""
    if entry.implements:
        file = home.definition(entry.implements)
        spec = files_digest(closure(file)) if file.is_file() else "missing"
    return {
        "source": _source(entry),
        "spec": spec,
        "theorems": theorem_digest(names, theorems, home),
        **_tools(),
    }


def _problems(home: Home, entries: dict[str, Entry], data: dict[str, Any]) -> Iterator[Problem]:
    theorems = data["theorems"]
    for name, entry in entries.items():
        record = data["kernels"].get(name)
        if record is None:
            yield Problem(name, "it is not in the ledger")
            continue
        if record["status"] != "proved":
            yield Problem(name, f"it is {record['status']}")
            continue
        now = key_parts(entry, record["theorems"], theorems, home)
        changed = [PARTS[part] for part in PARTS if now[part] != record["key"].get(part)]
        if changed:
            yield Problem(name, "changed since the proof: " + ", ".join(changed))
        elif wrong := altered(entry.function):
            yield Problem(name, "the code that runs is not its file's: " + ", ".join(wrong))
    for name in sorted(set(data["kernels"]) - set(entries)):
        yield Problem(name, "it was proved but is no longer registered")


def check(path: Path | None = None, home: Home = PRODUCT) -> Standing:
    """Hold every registered kernel, fold and driver of a home against its ledger."""
    entries = load_all(home)
    data = read(home.ledger if path is None else path)
    problems = tuple(_problems(home, entries, data))
    records = data["theorems"].values()
    proved = sum(record["status"] == "proved" for record in records)
    assumed = sum(len(record["assumptions"]) for record in records)
    kernels = sum(entry.kind != "driver" for entry in entries.values())
    return Standing(kernels, proved, assumed, problems)


def check_everything(path: Path | None = None) -> Standing:
    """The product, and every other package that has registered a kernel in this process."""
    standings = [check(path)]
    for name in sorted({_top(entry) for entry in REGISTRY.values()} - {"cratous"}):
        try:
            standings.append(check(home=package(name)))
        except BadInput as error:
            strangers = [n for n, entry in sorted(REGISTRY.items()) if _top(entry) == name]
            problems = tuple(Problem(n, f"it has no ledger: {error}") for n in strangers)
            standings.append(Standing(len(strangers), 0, 0, problems))
    return Standing(
        sum(s.kernels for s in standings),
        sum(s.theorems for s in standings),
        sum(s.assumptions for s in standings),
        tuple(problem for s in standings for problem in s.problems),
    )


LISTED = 40
"""So many kernels are named when the ledger refuses; the others are counted."""


def require(*, allow_unproved: bool = False, path: Path | None = None) -> Standing:
    """The standing, or `Refused` with the name of each kernel and what changed."""
    standing = check_everything(path)
    if standing.problems and not allow_unproved:
        names = short([*REGISTRY, *(problem.name for problem in standing.problems)])
        shown = "\n".join(f"  {names[p.name]}: {p.what}" for p in standing.problems[:LISTED])
        more = len(standing.problems) - LISTED
        if more > 0:
            shown += f"\n  and {more} more"
        raise Refused(
            "the proof ledger does not vouch for the code that would fly:\n"
            f"{shown}\nprove it again with `cratous prove`, or fly it as it is with "
            "`--allow-unproved` (the report will say so)"
        )
    return standing


def place_of(name: str) -> str:
    """Where a registered kernel, fold or driver stands."""
    return position(named(name).function)
