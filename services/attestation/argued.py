"""Is the assurance argument that was signed the one that its report gives, with the ledger as it is now?"""

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
"""They are written together."""
SEAL = re.compile(
    rf"^(# |<text [^<>]*>){re.escape(LEDGER)}([0-9a-f]{{64}}|none)(?=$|</text>$)".encode(),
    re.MULTILINE,
)
"""The line that names the ledger, in YAML and in SVG."""
SHOWN = 16
"""So many digits of a seal are said."""


class Argued(NamedTuple):
    """What came of it, in words. refused: what was tampered with; undecided: what cannot be made again
    here; not_judged: what was not looked into of what is the same."""

    refused: list[str]
    undecided: list[str]
    not_judged: list[str]


def argued(folder: Path, named: dict[str, str], subject: Subject) -> Argued:
    """Make the argument again and hold its files against it, byte for byte.

    folder: of the views; named: what was signed, whose files are there. An argument that was made with
    another ledger is the same but for the name of that, or is left undecided.
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
    """The seal of the ledger that a file names; empty if it names none."""
    found = SEAL.search(data)
    return found[2] if found else b""


def _short(seal: bytes) -> str:
    return seal[:SHOWN].decode("ascii")
