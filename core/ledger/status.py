"""What the ledger says of a kernel, fold or driver: how far a proof, or a check of its output, goes.

The status follows from the facts of a record. It is recorded beside them and computed again on
reading, so a record that claims more than its facts give is refused.
"""

from __future__ import annotations

from typing import Any, NamedTuple

AGAINST = "proved against its definition"
RESTATED = "proved against a restated formula"
PROPERTIES = "properties proved"
RECHECKED = "output re-checked"
USES = "uses proved kernels"
NOT_PROVED = "not proved"
STATUSES = (AGAINST, RESTATED, PROPERTIES, RECHECKED, USES, NOT_PROVED)
"""From a proof about the function itself to none; a re-check is of what a driver gives, run by run."""


class Grounds(NamedTuple):
    """What a status rests on beside proofs.

    against: theorems, and lemmas of them, that hold a kernel against its definition; rechecked_by:
    kernels and folds that a driver's output goes through before it is returned.
    """

    against: tuple[str, ...] = ()
    rechecked_by: tuple[str, ...] = ()


def status_of(record: dict[str, Any]) -> str:
    """The status that the facts of a kernel's record give."""
    if not record["proved"]:
        return NOT_PROVED
    if record["kind"] == "driver":
        return RECHECKED if record["rechecked_by"] else USES
    if not record["against"]:
        return PROPERTIES
    return RESTATED if record["restates"] else AGAINST


def in_words(record: dict[str, Any], names: dict[str, str] | None = None) -> str:
    """The status with what it names: who re-checks, whose step it is. names: shorter ones."""
    said = names or {}
    text: str = record["status"]
    if record.get("rechecked_by"):
        text += " by " + ", ".join(said.get(name, name) for name in record["rechecked_by"])
    if record.get("supports"):
        text += f", a step of {said.get(record['supports'], record['supports'])}"
    return text


def counts(statuses: list[str]) -> dict[str, int]:
    """How many there are of each status that occurs, in their order."""
    found = {status: statuses.count(status) for status in (*STATUSES, *sorted(set(statuses)))}
    return {status: number for status, number in found.items() if number}
