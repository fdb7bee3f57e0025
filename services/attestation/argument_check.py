"""Checks that the signed assurance argument is the one that its report and the current ledger give."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from cratous.services.argument.views import LEDGER, views
from cratous.services.attestation.findings import Subject, unshown
from cratous.services.attestation.names import ARGUMENT_NAME, DRAWING_NAME
from cratous.services.attestation.statement import VIEWS as MADE
from cratous.services.results.names import REPORT_NAME
from cratous.spec.errors import BadInput, Refused

BOTH = (ARGUMENT_NAME, DRAWING_NAME)
"""The files, which are always written together."""
SEAL = re.compile(
    rf"^(# |<text [^<>]*>){re.escape(LEDGER)}([0-9a-f]{{64}}|none)(?=$|</text>$)".encode(),
    re.MULTILINE,
)
"""The line that identifies the ledger, in YAML and in SVG."""
SHOWN = 16
"""Number of digits of a seal that are shown."""


class Argued(NamedTuple):
    """Findings in words. refused: tampering; undecided: what cannot be rebuilt here; not_judged:
    files equal except for the name of the ledger.
    """

    refused: list[str]
    undecided: list[str]
    not_judged: list[str]


def argued(folder: Path, named: dict[str, str], subject: Subject) -> Argued:
    """Rebuild the argument and compare its files byte for byte.

    folder: of the views; named: signed files that exist. An argument made with another ledger must
    be equal except for the ledger's name; otherwise it is undecided.
    """
    signed = [name for name in BOTH if f"{MADE}/{name}" in named]
    if not signed:
        return Argued([], [], [])
    if len(signed) != len(BOTH):
        (missing,) = set(BOTH) - set(signed)
        text = f"{MADE}/{missing}: {signed[0]} is written together with it, and it is not there"
        return Argued([text], [], [])
    try:
        made = views(subject.report, unshown(subject))
    except Refused as error:
        why = f"the ledger here cannot be read: {error}"
        return Argued([], [f"{MADE}/{name}: {why}" for name in signed], [])
    except (BadInput, RuntimeError) as error:
        return Argued([f"{MADE}/{ARGUMENT_NAME}: {REPORT_NAME} gives no argument: {error}"], [], [])
    found = Argued([], [], [])
    for name, text in zip(BOTH, made, strict=True):
        _hold(f"{MADE}/{name}", folder / name, text.encode(), found)
    return found


def _hold(called: str, file: Path, made: bytes, found: Argued) -> None:
    """Compare one file with its regenerated text."""
    with file.open("rb") as stream:
        there = stream.read(len(made) + 1)
    said, ours = _seal(there), _seal(made)
    if there == made:
        return
    if not said or said == ours:
        found.refused.append(f"{called}: it is not what {REPORT_NAME} and the ledger give")
    elif there == SEAL.sub(lambda line: line[1] + LEDGER.encode() + said, made, count=1):
        found.not_judged.append(
            f"{called}: made with the ledger {_short(said)}; with the one here, {_short(ours)}, it is the same"
        )
    else:
        found.undecided.append(
            f"{called}: made with the ledger {_short(said)}, the one here is {_short(ours)} and gives another"
        )


def _seal(data: bytes) -> bytes:
    """The ledger seal in a file; empty if there is none."""
    found = SEAL.search(data)
    return found[2] if found else b""


def _short(seal: bytes) -> str:
    return seal[:SHOWN].decode("ascii")
