"""The ledger's gate: a kernel flies only with the source that was proved.

`ledger.json` is written by `cratous prove`. For every registered kernel, fold and driver it keeps
the parts of its key: its own syntax tree with all that it calls, the definition in `spec`, its
theorems, the prover, the solver's version and the compiler flags. `check` computes them anew and
names whatever differs.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.core.compiled import FLAGS
from cratous.core.kernel import REGISTRY, Entry, Fold
from cratous.core.sources import ROOT, closure, digest, files_digest, function_parts
from cratous.spec.errors import Refused

LEDGER = ROOT / "core" / "ledger.json"
PARTS = {
    "source": "its source or that of something it calls",
    "spec": "its definition in spec",
    "theorems": "its theorems",
    "prover": "the prover",
    "solver": "the solver's version",
    "flags": "the compiler flags",
}


@dataclass(frozen=True)
class Problem:
    """A kernel that the ledger does not vouch for: its name, and what is wrong."""

    name: str
    what: str


@dataclass(frozen=True)
class Standing:
    """The result of holding the running code against the ledger."""

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


def load_all() -> dict[str, Entry]:
    """Import every module of core, so that the registry is complete."""
    for file in sorted((ROOT / "core").glob("*.py")):
        if file.stem != "__init__":
            importlib.import_module(f"cratous.core.{file.stem}")
    return dict(sorted(REGISTRY.items()))


def read(path: Path = LEDGER) -> dict[str, Any]:
    """The ledger as data; empty where there is none."""
    if not path.is_file():
        return {"kernels": {}, "theorems": {}}
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["seal"] != seal(data):
            raise Refused(f"{path.name} was edited after the prover wrote it; run `cratous prove`")
    except (ValueError, KeyError, TypeError) as error:
        raise Refused(f"{path.name} cannot be read ({error!r}); run `cratous prove`") from error
    return dict(data)


def seal(data: dict[str, Any]) -> str:
    """A checksum over the ledger's contents: notices edits by hand and broken merges."""
    body = {key: value for key, value in data.items() if key != "seal"}
    return digest([json.dumps(body, sort_keys=True)])


def solver_version() -> str:
    """The installed z3."""
    try:
        return "z3 " + importlib.metadata.version("z3-solver")
    except importlib.metadata.PackageNotFoundError:
        return "z3 not installed"


def _source(entry: Entry) -> str:
    function = entry.function
    if isinstance(function, Fold):
        parts = function_parts(function.step) + function_parts(function.finish)
        return digest([*parts, repr(function.start)])
    module = sys.modules[function.__module__]
    if entry.kind == "driver":
        return files_digest(closure(Path(str(module.__file__)).resolve()))
    return digest(function_parts(function))


def theorem_digest(names: list[str], theorems: dict[str, Any]) -> str:
    """The meaning of some theorem files and of the lemmas that they rest on."""
    todo, seen = list(names), set()
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += theorems.get(name, {}).get("lemmas", [])
    folder = ROOT / "proofs" / "theorems"
    files = [folder / f"{name}.py" for name in sorted(seen)]
    if any(not file.is_file() for file in files):
        return "missing"
    return files_digest(files, docstrings=True)


def key_parts(entry: Entry, names: list[str], theorems: dict[str, Any]) -> dict[str, str]:
    """All parts of a kernel's key as the code stands now; names are its theorems."""
    spec = ""
    if entry.implements:
        file = ROOT / "spec" / f"{entry.implements.split('.')[0]}.py"
        spec = files_digest(closure(file)) if file.is_file() else "missing"
    engine = sorted((ROOT / "proofs").glob("*.py"))
    return {
        "source": _source(entry),
        "spec": spec,
        "theorems": theorem_digest(names, theorems),
        "prover": files_digest(engine),
        "solver": solver_version(),
        "flags": FLAGS,
    }


def check(path: Path = LEDGER) -> Standing:
    """Hold every registered kernel, fold and driver against the ledger."""
    data = read(path)
    problems = []
    theorems = data["theorems"]
    for name, entry in load_all().items():
        record = data["kernels"].get(name)
        if record is None:
            problems.append(Problem(name, "it is not in the ledger"))
            continue
        if record["status"] != "proved":
            problems.append(Problem(name, f"it is {record['status']}"))
            continue
        now = key_parts(entry, record["theorems"], theorems)
        changed = [PARTS[part] for part in PARTS if now[part] != record["key"].get(part)]
        if changed:
            problems.append(Problem(name, "changed since the proof: " + ", ".join(changed)))
    proved = sum(record["status"] == "proved" for record in theorems.values())
    assumed = sum(len(record["assumptions"]) for record in theorems.values())
    return Standing(len(REGISTRY), proved, assumed, tuple(problems))


def require(*, allow_unproved: bool = False, path: Path = LEDGER) -> Standing:
    """The standing, or `Refused` with the name of each kernel and what changed."""
    standing = check(path)
    if standing.problems and not allow_unproved:
        shown = "\n".join(f"  {p.name}: {p.what}" for p in standing.problems[:12])
        more = len(standing.problems) - 12
        if more > 0:
            shown += f"\n  and {more} more"
        raise Refused(
            "the proof ledger does not vouch for the code that would fly:\n"
            f"{shown}\nprove it again with `cratous prove`, or fly it as it is with "
            "`--allow-unproved` (the report will say so)"
        )
    return standing
