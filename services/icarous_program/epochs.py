"""A vehicle's gate in a small file, so that its epoch does not go back when its ICAROUS is restarted."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path

from cratous.core.authority.gate import ICAROUS, UXAS, Gate, epoch_given
from cratous.core.files.whole_file import write_atomically
from cratous.services.flight.link_lines import MOST_TOLD
from cratous.services.icarous_program.step import resumed
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import bytes_of

_WORDS = {UXAS: "UxAS", ICAROUS: "ICAROUS"}
_LINE = re.compile(rb"vehicle ([0-9]{1,18}) epoch ([0-9]{1,15}) (UxAS|ICAROUS)( offered)?\n")


class EpochFile:
    """File with one vehicle's latest gate; a new gate is written before any peer is told of it."""

    def __init__(self, path: Path, vehicle_id: int) -> None:
        self._path, self._vehicle_id = path, vehicle_id

    def resumed(self) -> Gate:
        """The gate to start with; BadInput if the file is malformed or of another vehicle. Without a file,
        epoch 0 of UxAS.
        """
        with suppress(OSError):  # an inaccessible file fails below, when it is read
            if not self._path.exists():
                return Gate(UXAS, 0, False)
        expected = f"`vehicle {self._vehicle_id} epoch N UxAS` or `... ICAROUS`, or no file"
        data = bytes_of(self._path, expected=expected)
        found = _LINE.fullmatch(data)
        if (
            found is None
            or int(found[1]) != self._vehicle_id
            or not epoch_given(MOST_TOLD, int(found[2]))
        ):
            raise BadInput(
                "not the epoch of this vehicle",
                where=str(self._path),
                item="--epochs",
                expected=expected,
                got=repr(data[:60]),
            )
        owner = ICAROUS if found[3] == b"ICAROUS" else UXAS
        return resumed(Gate(owner, int(found[2]), found[4] is not None))

    def keep(self, gate: Gate) -> None:
        """Write the gate. BadInput if that fails."""
        offered = " offered" if gate.offered else ""
        text = f"vehicle {self._vehicle_id} epoch {gate.epoch} {_WORDS[gate.owner]}{offered}\n"
        write_atomically(self._path, text, "the epoch")
