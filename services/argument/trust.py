"""What remains to be trusted: the limits of the report, and the trusted base of the proofs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from cratous.services.argument.elements import Element, Kind

TRUSTED = (
    "the lifter",
    "an answer `unsat`",
    "the prover as a whole",
    "plain numbers in a theorem",
    "names of arguments",
    "the keys of the ledger",
    "services and bridge",
    "the ledger's records",
    "z3",
    "CPython",
    "what a package does while it is imported",
    "what Python runs before any of ours",
    "where the modules of a package lie",
    "what is not looked into",
    "how far a theorem reaches",
    "numba",
    "what is compiled beside the gate",
    "the reading over the reals",
    "the exact reading on arrays",
    "that a driver's output is re-checked",
    "the sentences made from statements",
    "the relations' text as data",
    "going through a term",
    "the rows of a branch",
    "the theorems themselves",
    "the caches",
    "answers of other machines",
    "the definitions in `spec/`",
    "the monitor, and what it shares with the rest",
    "the projection",
    "straight flight between samples",
    "operating system, network",
)
"""The parts of docs/proofs/trusted-base.md, which explains why each is trusted and how it is checked."""


def limits(report: dict[str, Any]) -> Iterator[Element]:
    """An assumption for each limit that the report states."""
    for number, text in enumerate(report["limits"], 1):
        yield Element(f"A-limit-{number}", Kind.ASSUMPTION, f"Limit of the report: {text}")


def trusted() -> Element:
    """The trusted base, and what is no evidence here."""
    text = "; ".join(TRUSTED)
    return Element(
        "C-trusted-base",
        Kind.CONTEXT,
        f"Trusted, see docs/proofs/trusted-base.md: {text}. Tests are on record in no run: no "
        "solution here is one.",
    )


def not_shown(found: Iterable[tuple[str, str]]) -> Iterator[Element]:
    """The element for what no row of the report covers and nothing vouches for; None if there is no such thing."""
    said = [f"{what}: {why}" for what, why in found]
    if said:
        yield Element("C-not-shown", Kind.CONTEXT, f"Not shown here: {'; '.join(said)}")
