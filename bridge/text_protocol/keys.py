"""Keys of the authenticated dialect: one per vehicle, from a file or the environment, never shown."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from cratous.bridge.text_protocol.handshake import SECRET_LENGTH, is_secret
from cratous.spec.errors import BadInput

KEY_VARIABLE = "CRATOUS_BRIDGE_KEY_{}"
"""The environment variable with the key of a vehicle."""
DIRECT_VARIABLE = "CRATOUS_DIRECT_KEY_{}"
"""The environment variable with the direct key of a vehicle, by which other vehicles authenticate it without UxAS."""
WITHOUT = (
    """, there or in a folder of keys; without keys: --plain, and Dialect="cratous" at UxAS's end"""
)
"""The hint for messages where no setting says that keys are to be used."""


@dataclass(frozen=True)
class Keys:
    """The vehicles' keys that one end holds, 32 bytes each."""

    by_vehicle: Mapping[int, bytes] = field(repr=False)

    def of(self, vehicle_id: int) -> Keys:
        """The key of this vehicle only, for its ICAROUS."""
        return Keys({vehicle_id: self.by_vehicle[vehicle_id]})

    def environment(self, variable: str = KEY_VARIABLE) -> dict[str, str]:
        """The environment variables by which a child process receives the keys, see `key_of`."""
        return {variable.format(vid): key.hex() for vid, key in self.by_vehicle.items()}


def without_keys(environment: Mapping[str, str]) -> dict[str, str]:
    """The environment without the variables that hold keys, for a child process that needs none."""
    stems = KEY_VARIABLE.format(""), DIRECT_VARIABLE.format("")
    return {name: value for name, value in environment.items() if not name.startswith(stems)}


def new_keys(vehicle_ids: Iterable[int]) -> Keys:
    """A new random key for each vehicle, from the operating system's generator."""
    return Keys({number: secrets.token_bytes(SECRET_LENGTH // 2) for number in vehicle_ids})


def keys_of(vehicle_ids: Iterable[int], folder: Path | None) -> Keys:
    """The keys of these vehicles; BadInput if one is missing, see `key_of`."""
    return Keys({number: key_of(number, folder) for number in vehicle_ids})


def direct_keys_of(vehicle_ids: Iterable[int], folder: Path | None) -> Keys:
    """The direct keys of these vehicles, from the files `vehicle_ID.direct` or the environment; BadInput if one is
    missing."""
    return Keys({number: _key(number, folder, "direct", "") for number in vehicle_ids})


def key_of(vehicle_id: int, folder: Path | None) -> bytes:
    """The key of a vehicle: from the file `vehicle_ID.key` of a folder, or from the environment if no folder is
    given. BadInput if it is missing or malformed; the key is never shown."""
    return _key(vehicle_id, folder, "key", WITHOUT)


def _key(vehicle_id: int, folder: Path | None, kind: str, plain: str) -> bytes:
    """kind: suffix of the file name; plain: the hint where no folder is given."""
    direct = kind == "direct"
    if folder is None:
        item = (DIRECT_VARIABLE if direct else KEY_VARIABLE).format(vehicle_id)
        where, text = "environment", os.environ.get(item)
    else:
        path = folder / f"vehicle_{vehicle_id}.{kind}"
        where, item, plain = str(path), "key", ""
        try:
            with path.open("rb") as file:
                text = file.read(SECRET_LENGTH + 3).decode("ascii", "replace").strip()
        except OSError:
            text = None
    if text is None or not is_secret(text):
        got = "nothing that can be read" if text is None else f"{len(text)} characters"
        raise BadInput(
            "no direct key" if direct else "no key of the bridge",
            where=where,
            item=item,
            expected=f"{SECRET_LENGTH} hexadecimal characters for vehicle {vehicle_id}{plain}",
            got=got,
        )
    return bytes.fromhex(text)
