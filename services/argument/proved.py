"""Goals on proofs: kernels against their definitions, theorems, and their records."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.services.argument.elements import Argument, Element, Kind, State, counted

Data = dict[str, Any]
SAME = ("sentence", "statement", "status", "obligations", "premises")
"""Fields of a current record that must agree with the report."""


def plain(name: str) -> str:
    """A qualified name as a part of an id."""
    return name.replace(".", "-")


class Proofs:
    """Adds proofs to an argument.

    argument: to which they are added; proofs: of the report; records: theorems of the current
    ledger; ran: evidence of the calls of a theorem's kernels.
    """

    def __init__(
        self, argument: Argument, proofs: Data, records: Data, ran: str = "ran in this run"
    ) -> None:
        self._argument = argument
        self._theorems = proofs["theorems"]
        self._solver = proofs["solver"]
        self._called = proofs["kernels"]
        self._records = records
        self._ran = ran
        self.context: dict[str, tuple[str, ...]] = {}
        self.without: dict[str, str] = {}
        self._whole: set[str] = set()

    def kernel(self, chain: Data, name: str, drivers: Iterable[str]) -> str:
        """The goal that a kernel implements its definition; returns its id.

        chain: of `trace`, from the kernel to theorems and definition; name: short name; drivers:
        those in which it decides.
        """
        calls = (
            counted(chain["calls"], "call") if chain["calls"] else "compiled into what was called"
        )
        inside = ", ".join(drivers)
        text = f"Kernel {name} ({calls} in this run{f', in {inside}' if inside else ''}): "
        text += chain["status"] or "not in the report"
        if chain["step_of"]:
            text += f", a step of {chain['step_of'].rpartition('.')[2]}"
        if chain["restates"]:
            text += f" ({chain['restates']})"
        return self.goal(
            f"G-kernel-{plain(name)}",
            text,
            (chain["definition"], chain["file"]),
            chain["theorems"],
            chain["missing"],
        )

    def goal(
        self,
        key: str,
        text: str,
        definition: tuple[str, str],
        theorems: Iterable[str],
        missing: list[str],
    ) -> str:
        """The goal on a kernel with this id, supported by its theorems, with its definition as
        context; returns the id.

        definition: its name and its file, which may be empty; missing: other missing links of its
        chain.
        """
        below = tuple(self.theorem(theorem) for theorem in theorems)
        if not missing:
            missing = [f"{theorem}: {why}" for theorem in theorems if (why := self._lacks(theorem))]
        context: tuple[str, ...] = ()
        name, file = definition
        if name and file:
            said = f"Definition {name} in {file}"
            element = Element(f"C-definition-{plain(name)}", Kind.CONTEXT, said)
            context = (self._argument.add(element),)
        if missing:
            text += f". Missing: {'; '.join(dict.fromkeys(missing))}"
        # theorems support nothing if another link of the chain is missing
        below, state = ((), State.NOT_PROVED) if missing else (below, State.SUPPORTED)
        return self._argument.add(Element(key, Kind.GOAL, text, below, context, state))

    def theorem(self, name: str) -> str:
        """The goal that a theorem holds, by its record and those of its lemmas; returns its id."""
        key = f"G-theorem-{name}"
        if key in self._argument.elements:
            return key
        found = self._theorems.get(name, {})
        lacks = self._lacks(name)
        text = found.get("sentence") or f"the theorem {name}."
        context = self.context.get(name, ())
        below: tuple[str, ...] = ()
        if not found and self._rests(name):
            state, context = State.NO_THEOREM, ()
            text = f"The theorem {name} is about nothing that ran in this run: no kernel of it was called."
        elif lacks:
            state = State.NOT_PROVED
            text += f" Missing: {lacks}"
        elif name in self.without:
            state = State.NO_GROUND
            text += f" {self.without[name]}"
        else:
            state = State.SUPPORTED
            context += self._assumptions(name)
            below = (self._record(name), *(self.theorem(lemma) for lemma in found["lemmas"]))
        return self._argument.add(Element(key, Kind.GOAL, text, below, context, state))

    def _rests(self, name: str) -> bool:
        """Whether a theorem missing in the report is on record, and concerns no kernel that ran."""
        record = self._records.get(name)
        return record is not None and not set(record["kernels"]) & set(self._called)

    def _lacks(self, name: str, above: tuple[str, ...] = ()) -> str:
        """What a theorem, or a lemma it depends on, lacks; empty if it is proved."""
        if name in self._whole:  # many theorems depend on the same lemmas
            return ""
        said, record = self._theorems.get(name), self._records.get(name)
        if said is None or said["status"] != "proved":
            return "it is not among the proved theorems of this run"
        if record is None:
            return "the ledger has no record of it now"
        if any(record[key] != said[key] for key in SAME):
            return "the ledger's record of it is another now"
        for lemma in said["lemmas"]:
            if lemma in above:
                return f"its lemma {lemma} rests on it"
            if why := self._lacks(lemma, (*above, name)):
                return f"lemma {lemma}: {why}"
        self._whole.add(name)
        return ""

    def _record(self, name: str) -> str:
        found = self._theorems[name]
        known = sum(kernel in self._called for kernel in found["kernels"])
        return self._argument.add(
            Element(
                f"Sn-{name}",
                Kind.SOLUTION,
                f"Record in the ledger: proved by {self._solver}, "
                f"{counted(found['obligations'], 'obligation')}, premises {found['premises']}, "
                f"{counted(len(found['assumptions']), 'assumption')} in the proof; {known} of its "
                f"{counted(len(found['kernels']), 'kernel')} {self._ran}",
            )
        )

    def _assumptions(self, name: str) -> tuple[str, ...]:
        """Assumptions of the proof itself, from its record."""
        return tuple(
            self._argument.add(
                Element(
                    f"A-proof-{name}-{number}", Kind.ASSUMPTION, f"Assumed in the proof: {text}"
                )
            )
            for number, text in enumerate(self._theorems[name]["assumptions"], 1)
        )
