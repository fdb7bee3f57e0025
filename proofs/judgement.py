"""The result of `cratous prove` for a product or package: theorems, and whatever prevents vouching for it.

The command and its self-test use the same functions, so both refuse the same.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cratous.core import ledger as gate
from cratous.core.ledger.package_home import Home
from cratous.core.ledger.status import Grounds
from cratous.proofs import ledger
from cratous.proofs.engine.cache import Cache
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.phases import COMPARING, COMPILING, GOALS, STATEMENTS, THEOREMS, Phases
from cratous.proofs.running.compiling import compile_ahead
from cratous.proofs.running.theorem import Function
from cratous.proofs.statements import definitions
from cratous.proofs.statements.relation_cache import Kept
from cratous.proofs.statements.status_evidence import grounds


@dataclass(frozen=True)
class Judgement:
    """The result of proving these theorems.

    structural: items to which no proof can be bound, including code outside of the subset; unmeant: kernels without a
    proper definition; both with their places. grounds: the evidence for each kernel's status. These are only
    determined where all theorems are judged. statements: by theorem, its claim as text.
    """

    inventory: ledger.Inventory
    structural: tuple[str, ...]
    unmeant: tuple[str, ...]
    grounds: Mapping[str, Grounds] = field(default_factory=dict)
    statements: Mapping[str, str] = field(default_factory=dict)

    @property
    def problems(self) -> list[str]:
        """All problems other than theorems that are not proved."""
        return [*self.structural, *self.unmeant]

    @property
    def binds(self) -> bool:
        """Whether a ledger may be written from it."""
        return not self.structural and not self.unmeant

    @property
    def holds(self) -> bool:
        """Whether everything is proved and there are no problems: the command then exits with 0."""
        return not self.problems and all(t.proved for t in self.inventory.theorems)


class Memory(NamedTuple):
    """Caches kept between runs: solver answers, proved theorems, and the folder with the relations between theorems;
    write: computes something from each theorem's claim, passed to the listener."""

    cache: Cache | None = None
    recall: Recall | None = None
    relations: Path | None = None
    write: ledger.Writer | None = None


NOTHING = Memory()


@dataclass
class _Ahead:
    """A progress listener; after the last theorem it compiles the kernels, before they are compared."""

    left: int
    tell: ledger.Listener | None
    jobs: int
    phases: Phases
    masks: dict[Function, frozenset[int]] = field(default_factory=dict)

    def __call__(self, progress: ledger.Progress) -> None:
        if self.tell is not None:
            self.tell(progress)
        if progress.theorem is None:
            return
        for key, bits in progress.functions.masks.items() if progress.functions else ():
            self.masks[key] = self.masks.get(key, frozenset()) | bits
        self.left -= 1
        if self.left == 0:
            self.phases.ended(THEOREMS)
            compile_ahead(self.masks, self.jobs)
            self.phases.ended(COMPILING)


def judge(
    names: Iterable[str],
    home: Home,
    *,
    whole: bool = True,
    tell: ledger.Listener | None = None,
    jobs: int | None = None,
    memory: Memory = NOTHING,
    machine: bool = True,
    phases: Phases | None = None,
) -> Judgement:
    """Prove these theorems of a home, and check its kernels and definitions.

    whole: they are all theorems of the home; memory: caches kept between runs; machine: compare kernels with their
    machine code too; phases: told which part has ended. Raises BadInput for a theorem that cannot be stated.
    """
    wanted, parts = list(names), phases or Phases()
    inventory = ledger.prove_all(
        wanted,
        _Ahead(len(wanted), tell, jobs or ledger.jobs_default(), parts) if machine else tell,
        home=home,
        jobs=jobs,
        cache=memory.cache,
        recall=memory.recall,
        machine=machine,
        write=memory.write,
    )
    parts.ended(COMPARING)
    findings = [str(finding) for finding in inventory.findings]
    # code outside of the subset is not analysed further
    kept, stated = Kept(memory.relations, home), [t.name for t in inventory.theorems]
    read = {} if findings else kept.all(stated, jobs or ledger.jobs_default())
    parts.ended(STATEMENTS)
    statements = {name: found.statement for name, found in read.items()}
    if not whole:
        return Judgement(inventory, tuple(findings), (), statements=statements)
    bare = [
        f"{gate.place_of(name)}: {name.rpartition('.')[2]}: no theorem is about this kernel"
        for name in inventory.bare
    ]
    dead = ledger.dead_paths(inventory.theorems)
    structural = (*inventory.problems, *bare, *findings, *dead)
    if findings:
        return Judgement(inventory, structural, ())
    entries, theorems = gate.load_all(home), inventory.theorems
    proofs = definitions.Proofs(
        {theorem.name: theorem.kernels for theorem in theorems},
        frozenset(theorem.name for theorem in theorems if theorem.proved),
        read,
        {theorem.name: theorem.uses for theorem in theorems},
        frozenset(t.name for t in theorems if not t.proved or (t.ran and t.ran.doubles)),
        assuming=frozenset(t.name for t in theorems if t.assumptions),
    )
    ask = functools.partial(kept.decided, jobs=jobs or ledger.jobs_default())
    proofs = definitions.with_decided(entries, home, proofs, ask)
    parts.ended(GOALS)
    unmeant = tuple(definitions.problems(entries, home, proofs))
    return Judgement(inventory, structural, unmeant, grounds(entries, home, proofs), statements)
