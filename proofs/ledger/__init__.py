"""Proves all theorems and writes the results into the ledger.

Its files hold facts only (no times, no machine): they are the same on every machine that proves the same code with
the same solver, so CI can compare them byte by byte. Theorems are proved on all cores, each in a process forked from
the same state, so that the result does not depend on how they are distributed.
"""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY, Entry, Fold, checkers, entry_of, supported
from cratous.core.kernel.names import short
from cratous.core.kernel.sources import altered, place, position, reached
from cratous.core.ledger.meant_folds import other_parts
from cratous.core.ledger.meant_names import replaced
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.core.ledger.records import seal, sealed, texts
from cratous.core.ledger.status import Grounds, status_of
from cratous.proofs.engine import prover, solver_memory
from cratous.proofs.engine.cache import Cache
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.cpu_limit import may_be_killed, of_the_user, what_ended
from cratous.proofs.engine.solver_order import ask_apart
from cratous.proofs.engine.subset import Finding, lint_all
from cratous.proofs.engine.theorem_files import home_folder
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.running.all import compare_all, told
from cratous.proofs.running.nudged import taken
from cratous.proofs.running.theorem import Functions, run
from cratous.spec.errors import BadInput


@dataclass(frozen=True)
class Inventory:
    """The result of a run of the prover: theorems, lint findings, kernels without a theorem.

    problems: whatever else prevents writing a ledger, each with its place.
    """

    theorems: tuple[prover.Theorem, ...]
    findings: tuple[Finding, ...]
    bare: tuple[str, ...]
    problems: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """True iff everything is proved and nothing is missing."""
        whole = not (self.findings or self.bare or self.problems)
        return whole and all(t.proved for t in self.theorems)


@dataclass(frozen=True)
class Progress:
    """Progress of a theorem: obligations done, of how many; at the end the theorem itself.

    functions: the functions that it looked into, where they are still to be compared. written: the result of
    `Writer`.
    """

    name: str
    done: int
    of: int
    theorem: prover.Theorem | None = None
    functions: Functions | None = None
    written: Any = None


Listener = Callable[[Progress], None]
Writer = Callable[[prover.Theorem, Claim, str], Any]
"""Computes something from a theorem, its stated claim and its sentence, in the theorem's own process."""


def jobs_default() -> int:
    """One worker for each core that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _tell(name: str, out: Connection, done: int, of: int) -> None:
    out.send(Progress(name, done, of))


def _work(
    name: str, folder: Path, cache: Cache, write: Writer | None, out: Connection, *, apart: bool
) -> None:
    """Prove a theorem and run it; apart: each question in a process of its own."""
    may_be_killed()
    if apart:
        ask_apart()
    try:
        claim, sentence = prover.state(name, folder)
        tell = partial(_tell, name, out)
        theorem = prover.prove(
            name, claim, sentence, cache=cache, tell=tell, taken=taken(name, claim, folder)
        )
        functions = None
        if theorem.proved:
            ran, functions = run(name, claim, folder)
            theorem = theorem.after(ran)
        written = None if write is None else write(theorem, claim, sentence)
        out.send(Progress(name, 1, 1, theorem, functions, written))
    except Exception as error:
        out.send(error)
    finally:
        out.close()


def _no_answer(name: str, folder: Path, process: Any, *, again: bool) -> Exception | None:
    """The error for a theorem whose process ended; None if it is to be proved again with its questions apart."""
    process.join()
    user = of_the_user()
    ends = {-signal.SIGXCPU} | ({-signal.SIGKILL} if user < math.inf else set())
    if process.exitcode not in ends:
        why = f"ended without an answer (exit code {process.exitcode})"
        return RuntimeError(f"the prover of {name} {why}")
    if again:
        return None
    if user <= prover.STATE_CPU_S:
        return BadInput(
            f"the theorem is not proved: {what_ended(process.exitcode)}",
            where=place(prover.find(name, folder)),
            expected="more CPU time for the prover (ulimit -t unlimited)",
            got=f"{user:.0f} s",
        )
    # with its questions apart, only stating the theorem can end this way
    return prover.not_stated(name, folder)


def prove_theorems(
    names: Iterable[str],
    *,
    folder: Path = prover.FOLDER,
    jobs: int | None = None,
    cache: Cache | None = None,
    tell: Listener | None = None,
    machine: bool = True,
    write: Writer | None = None,
) -> list[prover.Theorem]:
    """Prove these theorems on several cores and run those that are proved; results in the order of the names.

    machine: compare the functions' readings with machine code too; write: called for each claim. Raises whatever a
    theorem file raises, for the first such file in that order.
    """
    solver_memory.keep()
    wanted = list(names)
    store = cache or Cache(None)
    fork = multiprocessing.get_context("fork")
    results: dict[str, prover.Theorem | Exception] = {}
    looked_into: dict[str, Functions] = {}
    running: dict[Connection, tuple[str, Any]] = {}
    queue = list(reversed(wanted))
    apart: set[str] = set()
    while queue or running:
        while queue and len(running) < (jobs or jobs_default()):
            name = queue.pop()
            here, there = fork.Pipe(duplex=False)
            process = fork.Process(
                target=_work,
                args=(name, folder, store, write, there),
                kwargs={"apart": name in apart},
                daemon=name not in apart,  # daemonic processes may not have children
            )
            process.start()
            there.close()
            running[here] = (name, process)
        for ready in wait(list(running)):
            assert isinstance(ready, Connection)
            name, process = running[ready]
            try:
                message = ready.recv()
            except EOFError:
                message = _no_answer(name, folder, process, again=name not in apart)
            if isinstance(message, Progress):
                if message.theorem is not None:
                    results[name] = message.theorem
                    if message.functions is not None:
                        looked_into[name] = message.functions
                if tell is not None:
                    tell(message)
                if message.theorem is None:
                    continue
            elif message is None:  # the process of a question was ended
                apart.add(name)
                queue.append(name)
            else:
                results[name] = message
            process.join()
            ready.close()
            del running[ready]
    proved = []
    for name in wanted:
        result = results[name]
        if isinstance(result, Exception):
            raise result
        proved.append(result)
    compared = compare_all(looked_into.values(), jobs or jobs_default(), machine=machine)
    return [
        told(theorem, looked_into[theorem.name], compared)
        if theorem.name in looked_into
        else theorem
        for theorem in proved
    ]


def prove_all(
    names: Iterable[str],
    tell: Listener | None = None,
    *,
    home: Home = PRODUCT,
    jobs: int | None = None,
    cache: Cache | None = None,
    recall: Recall | None = None,
    machine: bool = True,
    write: Writer | None = None,
) -> Inventory:
    """Prove these theorems, and find everything that the ledger could not vouch for.

    cache: solver answers; recall: theorems proved before, whose definitions are unchanged; machine, write: see
    `prove_theorems`, for those that are proved anew.
    """
    entries = gate.load_all(home)
    folder = home_folder(home)
    wanted = list(names)
    memory = recall or Recall(None)
    kept = {name: theorem for name in wanted if (theorem := memory.get(name)) is not None}
    for name, theorem in kept.items():
        if tell is not None:
            tell(Progress(name, 1, 1, theorem))
    rest = [name for name in wanted if name not in kept]
    anew = prove_theorems(
        rest, folder=folder, jobs=jobs, cache=cache, tell=tell, machine=machine, write=write
    )
    memory.put(anew)
    kept |= {theorem.name: theorem for theorem in anew}
    theorems = [kept[name] for name in wanted]
    named = {kernel for theorem in theorems for kernel in theorem.kernels}
    bare = [n for n, e in entries.items() if e.kind != "driver" and n not in named]
    findings = tuple(lint_all(entries))
    return Inventory(tuple(theorems), findings, tuple(bare), tuple(problems(entries, home)))


def problems(entries: dict[str, Entry], home: Home = PRODUCT) -> list[str]:
    """Kernels and drivers to which no proof can be bound, each with its place and the reason."""
    found = []
    calls = {n: _called(e) | {n} for n, e in entries.items() if e.kind == "driver"}
    if other := replaced([Fold], {}):
        found.append(f"{position(Fold)}: not what its file says: {', '.join(other)}")
    for name, entry in entries.items():
        where = f"{position(entry.function)}: {name.rpartition('.')[2]}"
        if isinstance(entry.function, Fold) and (other := list(other_parts(entry.function))):
            found.append(f"{where}: the fold that runs is not its file's: {', '.join(other)}")
        if wrong := altered(entry.function):
            found.append(f"{where}: the code that runs is not its file's: {', '.join(wrong)}")
        if entry.kind == "driver":
            if not entry.uses:
                found.append(f"{where}: no kernel decides in this driver (checked_by)")
            for checker in checkers(entry):
                if checker not in REGISTRY or REGISTRY[checker].kind == "driver":
                    found.append(f"{where}: its checker {checker!r} is no kernel or fold")
                elif not any({name, checker} <= names for names in calls.values()):
                    found.append(
                        f"{where}: nothing calls {checker!r}, by which it is said to be checked: "
                        "neither itself nor a driver that uses it"
                    )
    return found


def dead_paths(theorems: Iterable[prover.Theorem]) -> list[str]:
    """Paths of kernels that are not reachable under the premises of any theorem: dead code, or a gap in the proofs."""
    reached: dict[str, list[tuple[bool, ...]]] = {}
    for theorem in theorems:
        for name, seen in theorem.paths:
            reached.setdefault(name, []).append(seen)
    found = []
    names = short([*REGISTRY, *reached])
    for name, views in sorted(reached.items()):
        most = max(len(view) for view in views)
        whole = [view for view in views if len(view) == most]
        for number, possible in enumerate(zip(*whole, strict=True), 1):
            if not any(possible):
                found.append(f"{names[name]}: no premises let anything reach path {number} of it")
    return found


def _called(entry: Entry) -> set[str]:
    """Names of the kernels, folds and drivers that a driver calls, directly or not."""
    found = set()
    for name, value in reached(entry.function).items():
        if name.startswith("fold "):
            found.add(name.removeprefix("fold "))
        elif (other := entry_of(value)) is not None:
            found.add(other.name)
    return found


def _theorem_record(theorem: prover.Theorem) -> dict[str, Any]:
    return {
        "sentence": theorem.sentence,
        "kernels": sorted(theorem.kernels),
        "lemmas": sorted(set(theorem.lemmas)),
        "status": "proved" if theorem.proved else "not proved",
        "premises": theorem.premises,
        "obligations": len(theorem.outcomes),
        "assumptions": [list(a) for a in theorem.assumptions],
    }


def records(
    inventory: Inventory,
    home: Home = PRODUCT,
    grounds: Mapping[str, Grounds] | None = None,
    statements: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """The ledger as data.

    grounds: evidence by kernel, fold or driver, from `proofs.statements.status_evidence`; without it none is recorded
    as proved against a definition or as re-checked. statements: by theorem, its claim as a sentence.
    """
    theorems: dict[str, dict[str, Any]] = {
        t.name: {**_theorem_record(t), "statement": (statements or {}).get(t.name, "")}
        for t in inventory.theorems
    }
    entries = gate.load_all(home)
    proved = {
        kernel: all(r["status"] == "proved" for r in theorems.values() if kernel in r["kernels"])
        for record in theorems.values()
        for kernel in record["kernels"]
    }
    kernels: dict[str, Any] = {}
    keys = gate.Keys(home)
    for name, entry in entries.items():
        own = sorted(t for t, record in theorems.items() if name in record["kernels"])
        checked_by = list(checkers(entry)) if entry.kind == "driver" else []
        ground = (grounds or {}).get(name, Grounds())
        good = proved.get(name, False)
        if entry.kind == "driver":
            asked = {*checked_by, *ground.rechecked_by}
            good = bool(checked_by) and all(proved.get(one, False) for one in asked)
        record: dict[str, Any] = {
            "kind": entry.kind,
            "implements": entry.implements,
            "supports": supported(entry) if entry.supports else "",
            "restates": entry.restates,
            "checked_by": checked_by,
            "rechecked_by": sorted(ground.rechecked_by),
            "theorems": own,
            "against": sorted(ground.against),
            "proved": good,
            "key": keys.of(entry, own, theorems),
        }
        kernels[name] = {**record, "status": status_of(record)}
    for theorem in theorems.values():
        for lemma in theorem["lemmas"]:
            if lemma not in theorems and gate.theorem_file(lemma, home) is None:
                theorem["status"] = "not proved"
    data: dict[str, Any] = {
        "kernels": {name: sealed(name, record) for name, record in kernels.items()},
        "theorems": {name: sealed(name, record) for name, record in theorems.items()},
    }
    return {**data, "seal": seal(data)}


def changed_theorems(home: Home = PRODUCT) -> list[str]:
    """Theorems that are new or unproved, are about a kernel whose ledger entry is stale, or, if any is, ask what is
    registered."""
    data, keys = gate.read(home.records), gate.Keys(home)
    entries = gate.load_all(home)
    stale, found = set(), []
    for name, entry in entries.items():
        record = data["kernels"].get(name) or {"proved": False}
        if not record["proved"] or record["key"] != keys.of(
            entry, record["theorems"], data["theorems"]
        ):
            stale.add(name)
    for name in prover.theorem_files(home_folder(home)):
        record = data["theorems"].get(name)
        met = record is None or record["status"] != "proved" or stale & set(record["kernels"])
        if met or (stale and keys.asks_registry(name)):
            found.append(name)
    return found


def text(
    inventory: Inventory,
    home: Home = PRODUCT,
    grounds: Mapping[str, Grounds] | None = None,
    statements: Mapping[str, str] | None = None,
) -> dict[str, str]:
    """The text of each file of the ledger, by its path in the folder."""
    return texts(records(inventory, home, grounds, statements), home)
