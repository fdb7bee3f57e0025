"""The ledger's status of a kernel, fold or driver: how far a proof, or a check of its output, goes.

The status follows from the facts of a record. It is stored beside them and recomputed on reading, so a record that
claims more than its facts support is refused.
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
"""From a proof about the function itself to none; a re-check concerns a driver's output, run by run."""


class Grounds(NamedTuple):
    """What a status is based on beside proofs.

    against: theorems, and lemmas of them, that relate a kernel to its definition; rechecked_by: kernels and folds
    that a driver's output goes through before it is returned.
    """

    against: tuple[str, ...] = ()
    rechecked_by: tuple[str, ...] = ()


def status_of(record: dict[str, Any]) -> str:
    """The status that follows from the facts of a kernel's record."""
    if not record["proved"]:
        return NOT_PROVED
    if record["kind"] == "driver":
        return RECHECKED if record["rechecked_by"] else USES
    if not record["against"]:
        return PROPERTIES
    return RESTATED if record["restates"] else AGAINST


def in_words(record: dict[str, Any], names: dict[str, str] | None = None) -> str:
    """The status with the names it refers to: the re-checking kernels, or the kernel it is a step of. names: shorter
    ones.
    """
    said = names or {}
    text: str = record["status"]
    if record.get("rechecked_by"):
        text += " by " + ", ".join(said.get(name, name) for name in record["rechecked_by"])
    if record.get("supports"):
        text += f", a step of {said.get(record['supports'], record['supports'])}"
    return text


def counts(statuses: list[str]) -> dict[str, int]:
    """The number of entries of each status that occurs, in the order of `STATUSES`."""
    found = {status: statuses.count(status) for status in (*STATUSES, *sorted(set(statuses)))}
    return {status: number for status, number in found.items() if number}
