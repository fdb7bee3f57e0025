"""Goals on user requirements: the verdict over the log as evidence, the file as context.

The monitor evaluated them after the flight, so their kernels are not among those of the run: they
are checked against the current ledger. No theorem on the composed system concerns them, and their
strategy says so.
"""

from __future__ import annotations

from typing import Any

from cratous.core.kernel.names import short
from cratous.services.argument import elements
from cratous.services.argument.proved import Proofs, plain
from cratous.services.certify.proofs import theorems_of
from cratous.services.certify.requirement_texts import sentence
from cratous.services.certify.requirement_views import own_requirements
from cratous.services.certify.trace import definition_of
from cratous.services.results.names import OWN
from cratous.spec.mission.guarantees import Outcome

Data = dict[str, Any]
STRATEGY = "S-own"


class Own:
    """Adds the user requirements of a report to an argument. kept: the current ledger."""

    def __init__(self, argument: elements.Argument, report: Data, kept: Data) -> None:
        self.rows = own_requirements(report)
        self._argument = argument
        self._known = kept["kernels"]
        self._unproved = {problem["kernel"] for problem in report["proofs"]["problems"]}
        deciding = sorted({name for row in self.rows for name in row["kernels"]})
        self._names = short(deciding)
        wholes = {name: self._whole(name) for name in deciding}
        said = theorems_of({n: w for n, w in wholes.items() if w is not None}, kept["theorems"])
        proofs = {
            "theorems": said, "solver": report["proofs"]["solver"],
            "kernels": {one for row in self.rows for one in row["kernels"]},
        }  # fmt: skip
        self._proofs = Proofs(
            argument, proofs, kept["theorems"], "judged a requirement of one's own"
        )
        own = report.get(OWN, {})
        self._files = {
            one["file"]: argument.add(
                elements.Element(
                    f"C-own-file-{number}", elements.Kind.CONTEXT, _file_said(one, own["findings"])
                )
            )
            for number, one in enumerate(own.get("files", ()), 1)
        }

    def add(self) -> tuple[str, ...]:
        """Add the strategy over all user requirements; nothing if the report has none."""
        if not self.rows:
            return ()
        goals = tuple(self._goal(number, row) for number, row in enumerate(self.rows, 1))
        text = (
            f"Over each requirement of one's own ({len(goals)}), held against the log by the monitor after "
            "the flight; nothing is proved of them beyond this run"
        )
        state = elements.worst(map(self._argument.state, goals))
        return (
            self._argument.add(
                elements.Element(STRATEGY, elements.Kind.STRATEGY, text, goals, state=state)
            ),
        )

    def names(self, *states: elements.State) -> list[str]:
        """The ids of the requirements whose goals have one of these states."""
        numbered = enumerate(self.rows, 1)
        return [row["requirement"] for n, row in numbered if self._argument.state(_id(n)) in states]

    def _goal(self, number: int, row: Data) -> str:
        state = elements.OF_VERDICT[Outcome(row["verdict"])]
        text = f"{row['text']} In this run: {row['verdict']}, {row['note']}"
        if row["blame"] is not None:
            text += f". Blame: {sentence(row['blame'])}"
        below: tuple[str, ...] = ()
        if state is elements.State.SUPPORTED:
            kernels = tuple(self._kernel(name) for name in row["kernels"])
            if any(self._argument.state(one) is not elements.State.SUPPORTED for one in kernels):
                state, below = elements.State.NOT_PROVED, kernels
            elif not (row["checks"] and kernels):  # no signals: decided by no kernel
                state = elements.State.NOTHING
                text += ". Nothing in the flight tested it"
            else:
                below = (*kernels, self._evidence(number, row))
        context = [self._files[row["file"]]] if row["file"] in self._files else []
        if row["lint"]:
            odd = f"Odd about {row['requirement']}: " + "; ".join(
                one["text"] for one in row["lint"]
            )
            context.append(
                self._argument.add(
                    elements.Element(f"C-own-lint-{number}", elements.Kind.CONTEXT, odd)
                )
            )
        return self._argument.add(
            elements.Element(_id(number), elements.Kind.GOAL, text, below, tuple(context), state)
        )

    def _evidence(self, number: int, row: Data) -> str:
        text = (
            f"report.json, {row['requirement']}: holds at {elements.counted(row['samples']['holds'], 'sample')}, "
            f"{elements.counted(row['checks'], 'check')}"
        )
        if row["margin"] is not None:
            text += f", margin {row['margin']:.4g} {row['unit']}".rstrip()
        text += "; judged again from its text and the log"
        return self._argument.add(
            elements.Element(f"Sn-own-{number}", elements.Kind.SOLUTION, text)
        )

    def _whole(self, name: str) -> Data | None:
        """The record of a kernel, or of the fold to which it belongs."""
        one: Data | None = self._known.get(name)
        return one and self._known.get(one["supports"], one)

    def _kernel(self, name: str) -> str:
        """The goal that a monitor kernel implements its definition."""
        whole = self._whole(name)
        missing = ["it is not in the ledger"] if whole is None else []
        against = [] if whole is None else whole["against"]
        definition = "" if whole is None else whole["implements"]
        file, absent = definition_of(name.split(".")[0], definition)
        missing += [absent] if absent else []
        if whole is not None and not (against and definition):
            missing.append("no theorem holds it against a definition")
        if {name, self._names[name]} & self._unproved:
            missing.append("the ledger did not vouch for it in this run")
        text = f"Kernel {self._names[name]} of the monitor, by the ledger as it is now"
        if whole is not None:
            text += f": {whole['status']}"
            if whole is not self._known[name]:
                text += f", as a step of {definition.rpartition('.')[2]}"
        key = f"G-own-kernel-{plain(self._names[name])}"
        return self._proofs.goal(key, text, (definition, file), against, missing)


def _id(number: int) -> str:
    return f"G-own-{number}"


def _file_said(file: Data, findings: list[Data]) -> str:
    """A requirements file, the exports that it imports, and the faults of its samples, in words."""
    text = f"{file['file']}, whole in report.json, SHA-256 {file['sha256']}"
    for one in file["imports"]:
        text += f"; it takes {one['file']}, SHA-256 {one['sha256']}"
    wrong = [one["text"] for one in findings if one["file"] == file["file"]]
    return text + (f". Its samples: {'; '.join(wrong)}" if wrong else "")
