"""The ledger's gate: a kernel flies only with the source that was proved.

A ledger is written by `cratous prove`: the product's is `core/ledger/records/`, a package with kernels of its own has
`<package>/ledger/`. For every registered kernel, fold and driver it stores the parts of its key (`keys`): its own
definition with all that it calls, the definition in `spec`, its theorems with all their dependencies, the prover, the
readings (how a kernel becomes machine code or an exact verdict) and the compiler. `check` recomputes them and names
every difference; it also compares the running code with the hashed file, and the meaning of the names in it with that
file. The solver that proved an entry is recorded beside the key and is no reason to refuse.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.core.kernel import REGISTRY, Entry, Fold, named
from cratous.core.kernel.names import short
from cratous.core.kernel.sources import altered_of, position, reached, stands_for_itself
from cratous.core.ledger.kept_keys import keys_of
from cratous.core.ledger.key_parts import MISSING, PARTS, compiler, solver_version
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.meant_folds import other_parts
from cratous.core.ledger.meant_names import Looked, replaced
from cratous.core.ledger.package_home import (
    PRODUCT,
    Home,
    package,
    theorem_file,
    theorem_home,
    theorem_name,
)
from cratous.core.ledger.records import read
from cratous.spec.errors import BadInput, Refused

__all__ = [
    "PARTS", "PRODUCT", "Home", "Keys", "Problem", "Standing", "check", "check_everything",
    "compiler", "load_all", "package", "place_of", "read", "require", "solver_version",
    "theorem_file", "theorem_name",
]  # fmt: skip


@dataclass(frozen=True)
class Problem:
    """A kernel not covered by the ledger: its name, and what is wrong."""

    name: str
    what: str


@dataclass(frozen=True)
class Standing:
    """The result of comparing the running code with the ledger.

    kernels: number of kernels and folds; drivers are checked by kernels, not proved.
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
    """Import every module that may contain kernels; the registered ones of this home, by name.

    Raises BadInput for a module of another package that cannot be imported, or whose file is not the one that Python
    runs.
    """
    for file in home.shadowed():
        raise BadInput(
            "this file is not what Python runs: a folder or machine code of its name is beside it",
            where=file.relative_to(home.root.parent).as_posix(),
            expected="one of the two",
        )
    for name in home.modules():
        try:
            importlib.import_module(name)
        except (ImportError, SyntaxError, ValueError) as error:
            if home.product:
                raise
            raise BadInput(f"the module cannot be imported: {error}", where=name) from error
    return {n: entry for n, entry in sorted(REGISTRY.items()) if _top(entry) == home.name}


def _not_proved(names: list[str], theorems: dict[str, Any], home: Home) -> str:
    """The first of these theorems, or of this home's lemmas that they depend on, without a proof."""
    todo, seen = list(names), set(names)
    for name in todo:
        record = theorems.get(name.removeprefix(f"{home.name}."))
        if record is None and name not in names and theorem_home(name, home) != home:
            continue  # another ledger's
        if record is None or record["status"] != "proved":
            return name
        todo += [lemma for lemma in record["lemmas"] if lemma not in seen]
        seen.update(record["lemmas"])
    return ""


def _problems(home: Home, entries: dict[str, Entry], data: dict[str, Any]) -> Iterator[Problem]:
    theorems = data["theorems"]
    known = {name: entry for name, entry in entries.items() if name in data["kernels"]}
    rests = {name: reached(entry.function) for name, entry in known.items()}
    keys = keys_of(home, known, rests, data)
    looked: Looked = {}
    for name, entry in entries.items():
        record = data["kernels"].get(name)
        if record is None:
            yield Problem(name, "it is not in the ledger")
            continue
        if not isinstance(entry.function, Fold) and not stands_for_itself(entry.function):
            yield Problem(name, "its module calls something else so, which would run in its place")
            continue
        if isinstance(entry.function, Fold) and (other := list(other_parts(entry.function))):
            yield Problem(name, "the fold that runs is not its file's: " + ", ".join(other))
            continue
        if not record["proved"]:
            yield Problem(name, f"it is {record['status']}")
            continue
        if lacking := _not_proved(record["theorems"], theorems, home):
            yield Problem(name, f"it rests on what is not in the ledger as proved: {lacking}")
            continue
        now, then = keys[name], record["key"]
        changed = [PARTS[p] for p in PARTS if now[p] != then.get(p) or now[p] == MISSING]
        if changed:
            yield Problem(name, "changed since the proof: " + ", ".join(changed))
            continue
        if wrong := altered_of(rests[name]):
            yield Problem(name, "the code that runs is not its file's: " + ", ".join(wrong))
        elif other := replaced([*rests[name].values(), Fold], looked):
            yield Problem(
                name, "names mean something else than their files say: " + ", ".join(other)
            )
    for name in sorted(set(data["kernels"]) - set(entries)):
        yield Problem(name, "it was proved but is no longer registered")


def check(folder: Path | None = None, home: Home = PRODUCT) -> Standing:
    """Compare every registered kernel, fold and driver of a home with its ledger, or with that in another folder."""
    entries = load_all(home)
    data = read(home.records if folder is None else folder)
    try:
        problems = tuple(_problems(home, entries, data))
    except (SyntaxError, OSError, LookupError) as error:
        raise Refused(f"what the proofs rest on cannot be read: {error}") from error
    records = data["theorems"].values()
    proved = sum(record["status"] == "proved" for record in records)
    assumed = sum(len(record["assumptions"]) for record in records)
    kernels = sum(entry.kind != "driver" for entry in entries.values())
    return Standing(kernels, proved, assumed, problems)


def check_everything(folder: Path | None = None) -> Standing:
    """Check the product, and every other package that has registered a kernel in this process."""
    standings = [check(folder)]
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
"""Maximum number of kernels named when the ledger refuses; the others are counted."""


def require(*, allow_unproved: bool = False, folder: Path | None = None) -> Standing:
    """The standing, or `Refused` with the name of each kernel and what changed."""
    standing = check_everything(folder)
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
    """Location of a registered kernel, fold or driver."""
    return position(named(name).function)
