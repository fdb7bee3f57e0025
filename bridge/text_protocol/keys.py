"""Keys of the authenticated dialect: one for each vehicle, from a file or the environment, never shown."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from cratous.bridge.text_protocol.handshake import SECRET_LENGTH, is_secret
from cratous.spec.errors import BadInput

KEY_VARIABLE = "CRATOUS_BRIDGE_KEY_{}"
"""The variable of the environment with the key of a vehicle."""
WITHOUT = (
    """, there or in a folder of keys; without keys: --plain, and Dialect="cratous" at UxAS's end"""
)
"""What else to write where nothing says that there are to be keys."""


@dataclass(frozen=True)
class Keys:
    """The keys that an end has, by vehicle."""

    by_vehicle: Mapping[int, bytes] = field(repr=False)

    def of(self, vehicle_id: int) -> Keys:
        """The key of this vehicle alone, for its end."""
        return Keys({vehicle_id: self.by_vehicle[vehicle_id]})

    def environment(self) -> dict[str, str]:
        """The variables from which another process takes them, see `key_of`."""
        return {KEY_VARIABLE.format(vid): key.hex() for vid, key in self.by_vehicle.items()}


def without_keys(environment: Mapping[str, str]) -> dict[str, str]:
    """The environment of a process that needs no key of the bridge."""
    stem = KEY_VARIABLE.format("")
    return {name: value for name, value in environment.items() if not name.startswith(stem)}


def new_keys(vehicle_ids: Iterable[int]) -> Keys:
    """Keys that nobody has had before, from the system's source of random bytes."""
    return Keys({number: secrets.token_bytes(SECRET_LENGTH // 2) for number in vehicle_ids})


def keys_of(vehicle_ids: Iterable[int], folder: Path | None) -> Keys:
    """The keys of these vehicles; BadInput if one is missing, see `key_of`."""
    return Keys({number: key_of(number, folder) for number in vehicle_ids})


def key_of(vehicle_id: int, folder: Path | None) -> bytes:
    """The key of a vehicle: of the file `vehicle_ID.key` of a folder, or of the environment where no folder
    is said. BadInput if there is none, or it is no key; it is never shown."""
    if folder is None:
        where, item = "environment", KEY_VARIABLE.format(vehicle_id)
        text, plain = os.environ.get(item), WITHOUT
    else:
        path = folder / f"vehicle_{vehicle_id}.key"
        where, item, plain = str(path), "key", ""
        try:
            with path.open("rb") as file:
                text = file.read(SECRET_LENGTH + 3).decode("ascii", "replace").strip()
        except OSError:
            text = None
    if text is None or not is_secret(text):
        got = "nothing that can be read" if text is None else f"{len(text)} characters"
        raise BadInput(
            "no key of the bridge",
            where=where,
            item=item,
            expected=f"{SECRET_LENGTH} hexadecimal characters for vehicle {vehicle_id}{plain}",
            got=got,
        )
    return bytes.fromhex(text)
