"""Builds the argument of one run from its report alone, and checks it against the current ledger."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.core import ledger
from cratous.services.argument import assumptions, trust
from cratous.services.argument.elements import (
    OF_VERDICT,
    Argument,
    Element,
    Kind,
    State,
    worst,
)
from cratous.services.argument.guarantees import Guarantees
from cratous.services.argument.proved import Proofs
from cratous.services.argument.user_requirements import Own
from cratous.services.certify.trace import traced
from cratous.spec.mission.guarantees import REQUIREMENTS, Outcome

ROOT = "G-run"
Data = dict[str, Any]


def argument(
    report: Data, unshown: Iterable[tuple[str, str]], kept: Data | None = None
) -> dict[str, Element]:
    """The elements by id, from the top goal down.

    report: confirmed from its log; unshown: what no row of it covers, or nothing vouches for (what,
    why); kept: the current ledger, of `ledger.read`; read here if not given.
    """
    found = Argument()
    kept = ledger.read() if kept is None else kept
    proofs = Proofs(found, report["proofs"], kept["theorems"])
    known = assumptions.assumed(report)
    by_id = {
        found.add(element): one
        for element, one in zip(assumptions.elements(known), known, strict=True)
    }
    for name, one in by_id.items():
        for theorem in one.theorems:
            proofs.context[theorem] = (*proofs.context.get(theorem, ()), name)
            if one.broken:
                said = f"An assumption broke in this run: {one.text}, {one.broken}."
                proofs.without[theorem] = f"{proofs.without.get(theorem, '')} {said}".strip()
    chains = traced(report)
    rows = list(zip(report["constraints"], chains["rows"], strict=True))
    guarantees = Guarantees(found, proofs, chains, by_id)
    goals = [
        guarantees.add(wanted, [pair for pair in rows if pair[0]["requirement"] == wanted.id])
        for wanted in REQUIREMENTS
    ]
    _top(found, report, goals, Own(found, report, kept), unshown)
    return _reachable(found.elements)


def _top(
    found: Argument, report: Data, goals: list[str], own: Own, unshown: Iterable[tuple[str, str]]
) -> None:
    """Add the top goal, with its context and what is trusted."""
    states = [found.state(goal) for goal in goals]
    of_own = own.add()
    # the report's own verdict counts too: unproved kernels make it unknown
    verdict = OF_VERDICT[Outcome(report["verdict"])]
    state = worst([*states, *map(found.state, of_own), verdict])
    context = [*_subject(report), trust.trusted(), *trust.limits(report), *trust.not_shown(unshown)]
    strategy = found.add(
        Element(
            "S-guarantees", Kind.STRATEGY,
            f"Over the {len(goals)} guarantees, each for all of its constraints", tuple(goals),
            state=worst(states),
        )
    )  # fmt: skip
    held = [goal for goal, one in zip(goals, states, strict=True) if one is State.SUPPORTED]
    held += own.names(State.SUPPORTED)
    text = f"In this run of {report['mission']['name']} {', '.join(goals)} hold for the protected vehicles"
    if of_own:
        text += f", and so do {', '.join(row['requirement'] for row in own.rows)} of one's own"
        if untested := own.names(State.NOTHING):
            text += f", of which nothing tested {', '.join(untested)}"
    if state is not State.SUPPORTED:
        text += f". Supported here: {', '.join(held) or 'none'}"
        text += f". Verdict of the report: {report['verdict']}"
    names = tuple(found.add(element) for element in context)
    found.add(Element(ROOT, Kind.GOAL, text, (strategy, *of_own), names, state))


def _subject(report: Data) -> list[Element]:
    """The context of the argument: the run, and the ledger with which it was flown."""
    protected = [
        str(vehicle["id"])
        for vehicle in report["mission"]["vehicles"]
        if vehicle["id"] not in report["not_covered"]
    ]
    proofs = report["proofs"]
    return [
        Element(
            "C-run", Kind.CONTEXT,
            f"`{report['command']}` by {report['product']['name']} {report['product']['version']}, "
            f"avoidance {'on' if report['avoidance'] else 'off'}; protected vehicles: "
            f"{', '.join(protected) or 'none'}; log of {report['log']['messages']} messages with the "
            f"digest {report['log']['digest']}",
        ),
        Element(
            "C-ledger", Kind.CONTEXT,
            f"Ledger of the run: {proofs['line']}; {proofs['solver']}; seal {proofs['seal']}",
        ),
    ]  # fmt: skip


def _reachable(elements: dict[str, Element]) -> dict[str, Element]:
    """The elements reachable from the top goal, parents before children."""
    found: dict[str, Element] = {}
    todo = [ROOT]
    while todo:
        name = todo.pop()
        if name not in found:
            one = found[name] = elements[name]
            todo += reversed((*one.in_context_of, *one.supported_by))
    return found
