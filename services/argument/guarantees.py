"""Goals on one guarantee: its rows in this run, and the theorems on the composed system."""

from __future__ import annotations

from itertools import groupby
from typing import Any

from cratous.services.argument.assumptions import BEARS_ON, PLACED, UP_TO, Assumed
from cratous.services.argument.elements import (
    OF_VERDICT,
    Argument,
    Element,
    Kind,
    State,
    counted,
    worst,
)
from cratous.services.argument.proved import Proofs
from cratous.spec.mission.guarantees import Outcome, Requirement

Data = dict[str, Any]
TOGETHER = 10
"""Maximum number of rows of one kind, decided by the same kernels, in one goal; more are split."""
SOURCES = {"plan": "In the plan", "flight": "In the flight"}


class Guarantees:
    """Adds guarantees to an argument.

    rows: of the report, each with its chains (`trace.traced`); names: short names of kernels;
    assumed: by element id.
    """

    def __init__(
        self, argument: Argument, proofs: Proofs, traced: Data, assumed: dict[str, Assumed]
    ) -> None:
        self._argument = argument
        self._proofs = proofs
        self._names = traced["names"]
        self._assumed = assumed
        self._drivers: dict[str, set[str]] = {}
        for row in traced["rows"]:
            for chain in row["chains"]:
                drivers = self._drivers.setdefault(chain["kernel"], set())
                drivers |= {self._names.get(chain["by"], chain["by"])} - {""}

    def add(self, wanted: Requirement, rows: list[tuple[Data, Data]]) -> str:
        """The goal that a guarantee held in this run; rows: (report row, its chains)."""
        goals = [
            self._rows(wanted.id, number, group) for number, group in enumerate(_groups(rows), 1)
        ]
        state = worst(self._argument.state(goal) for goal in goals)
        state = State.UNKNOWN if state is State.NOTHING else state  # nothing of it was observed
        system = self._system(wanted.id)
        below: tuple[str, ...] = (system,)
        if goals:
            strategy = Element(
                f"S-{wanted.id}-run",
                Kind.STRATEGY,
                "Over each constraint that plan check and monitor judged in this run "
                f"({len(rows)}), and the kernels that decided it",
                tuple(goals),
                state=state,
            )
            below = (self._argument.add(strategy), system)
        return self._argument.add(
            Element(
                wanted.id, Kind.GOAL,
                f"{wanted.id} {wanted.title}: {wanted.text} In this run: {_counted(rows)}.",
                below, (), worst((state, self._argument.state(system))),
            )
        )  # fmt: skip

    def _rows(self, of: str, number: int, group: list[tuple[Data, Data]]) -> str:
        """The goal that some rows hold, or that a single row does not."""
        row, chained = group[0]
        state, why = _state(row, chained)
        where = SOURCES.get(row["source"], row["source"])
        said = [
            f"{one['item']} ({one['note']})" if one["note"] else one["item"] for one, _ in group
        ]
        text = f"{where}: {'; '.join(said)}"
        text += f". {why}" if why else ""
        below: list[str] = []
        if state in (State.SUPPORTED, State.NOT_PROVED):
            kernels = {chain["kernel"]: chain for chain in chained["chains"]}
            below = [
                self._proofs.kernel(chain, self._names[name], sorted(self._drivers[name]))
                for name, chain in kernels.items()
            ]
            # the current ledger may lack what the report's had
            if any(self._argument.state(goal) is not State.SUPPORTED for goal in below):
                state = State.NOT_PROVED
        if state is State.SUPPORTED:
            below.append(self._argument.add(_evidence(of, number, [one for one, _ in group])))
        return self._argument.add(
            Element(f"G-{of}-row-{number}", Kind.GOAL, text, tuple(below), (), state)
        )

    def _system(self, of: str) -> str:
        """The goal on the theorems about the composed system, independent of the run."""
        goals = tuple(self._proofs.theorem(theorem) for theorem in BEARS_ON[of])
        of_this = {name: one for name, one in self._assumed.items() if of in one.guarantees}
        broken = [one for one in of_this.values() if one.broken]
        # an assumption shown at a theorem above is not repeated here, unless it broke
        context = tuple(
            name for name, one in of_this.items() if one.broken or not one.theorems & PLACED
        )
        state = worst(self._argument.state(goal) for goal in goals)
        text = f"{of} beyond this run: what is proved of the composed system, under its assumptions"
        if broken:
            state = State.NO_GROUND
            text += ", of which broke in this run: " + "; ".join(one.text for one in broken)
        elif state is State.NOTHING:
            state = State.NO_THEOREM
        text += f"; {UP_TO[of]}" if of in UP_TO else ""
        return self._argument.add(Element(f"G-{of}-system", Kind.GOAL, text, goals, context, state))


def _state(row: Data, chained: Data) -> tuple[State, str]:
    """The state of one row, and why it is not supported, in words."""
    state = OF_VERDICT[Outcome(row["verdict"])]
    if state is not State.SUPPORTED:
        return state, "" if row["time_ms"] is None else f"At {row['time_ms'] / 1000:.2f} s"
    if not row["checks"]:
        return State.NOTHING, "Nothing was checked"
    if chained["missing"]:
        return State.NOT_PROVED, f"Missing: {'; '.join(chained['missing'])}"
    return State.SUPPORTED, ""


def _groups(rows: list[tuple[Data, Data]]) -> list[list[tuple[Data, Data]]]:
    """Groups of at most TOGETHER rows that hold by the same kernels; every other row forms its own group."""
    found: list[list[tuple[Data, Data]]] = []
    for key, run in groupby(rows, lambda pair: _kind(*pair)):
        group = list(run)
        size = TOGETHER if key else 1
        found += [group[start : start + size] for start in range(0, len(group), size)]
    return found


def _kind(row: Data, chained: Data) -> tuple[str, ...]:
    """Key of rows that may share a goal; empty for a row that is not supported."""
    state, _ = _state(row, chained)
    return (row["source"], *row["kernels"]) if state is State.SUPPORTED else ()


def _evidence(of: str, number: int, rows: list[Data]) -> Element:
    """Evidence that the rows are in the report, and were confirmed from the log."""
    kinds = ", ".join(sorted({row["kind"] for row in rows}))
    checks = sum(row["checks"] for row in rows)
    margins = [row for row in rows if row["margin"] is not None]
    text = (
        f"report.json, {counted(len(rows), 'row')}: holds by {counted(checks, 'check')} ({kinds})"
    )
    if len({row["unit"] for row in margins}) == 1:
        least = min(margins, key=lambda row: float(row["margin"]))
        text += f", margin {least['margin']:.4g} {least['unit']}"
    return Element(f"Sn-{of}-row-{number}", Kind.SOLUTION, f"{text}; judged again from the log")


def _counted(rows: list[tuple[Data, Data]]) -> str:
    """Number of rows by state."""
    if not rows:
        return "nothing was observed"
    found = [_state(*pair)[0] for pair in rows]
    said = [
        f"{found.count(state)} {'hold' if state is State.SUPPORTED else state}"
        for state in State
        if state in found
    ]
    return f"constraints {len(rows)}, of these {', '.join(said)}"
