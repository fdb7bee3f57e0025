"""What `cratous prove` finds of a product or package: theorems, and all that forbids to vouch for it.

The command and its self-test judge by the same functions, so what the one refuses the other does.
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
    """What came of proving these theorems.

    structural: what no proof could be bound to, what is outside of the subset included; unmeant: kernels
    whose definition is none; both with their places. grounds: what the status of each kernel rests on.
    These are only looked for where all theorems are judged. statements: by theorem, what it says.
    """

    inventory: ledger.Inventory
    structural: tuple[str, ...]
    unmeant: tuple[str, ...]
    grounds: Mapping[str, Grounds] = field(default_factory=dict)
    statements: Mapping[str, str] = field(default_factory=dict)

    @property
    def problems(self) -> list[str]:
        """Everything that is wrong beside theorems that are not proved."""
        return [*self.structural, *self.unmeant]

    @property
    def binds(self) -> bool:
        """A ledger may be written of it."""
        return not self.structural and not self.unmeant

    @property
    def holds(self) -> bool:
        """Everything is proved and nothing is wrong: the command ends with 0."""
        return not self.problems and all(t.proved for t in self.inventory.theorems)


class Memory(NamedTuple):
    """What is remembered from run to run: proofs, theorems as they were stated, and the folder in which the
    relations of theorems are kept; write: what is made of each theorem's claim beside, and told."""

    cache: Cache | None = None
    recall: Recall | None = None
    relations: Path | None = None
    write: ledger.Writer | None = None


NOTHING = Memory()


@dataclass
class _Ahead:
    """Hears how far the theorems are; when all are done their kernels are compiled, then compared."""

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
    """Prove these theorems of a home, and look at its kernels and definitions.

    whole: they are all that it has; memory: what is remembered from run to run;
    machine: compare kernels with their machine code too; phases: told which part has ended.
    Raises BadInput for a theorem that cannot be stated.
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
    # what is outside of the subset is not read any further
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
