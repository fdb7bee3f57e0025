"""Writes a folder of files, complete or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from cratous.core.files.whole_file import PART, Workspace, cannot_write, sync, write_atomically
from cratous.spec.errors import BadInput


def write_folder(folder: Path, files: dict[str, str]) -> None:
    """Write the texts by name into a new or empty folder.

    BadInput if it cannot be written or is not empty; nothing is changed then.
    """
    target = folder.absolute()
    try:
        space = Workspace(target.parent, target.name, PART)
    except OSError as error:
        raise cannot_write(folder, error, "the folder") from None
    try:
        made = space.path / target.name
        made.mkdir()
        for name, text in files.items():
            write_atomically(made / name, text)
        sync(made)
        # an empty folder is replaced; anything else makes this fail
        os.rename(made, target)
        sync(target.parent)
    except OSError as error:
        if target.exists():
            raise BadInput(
                "something is there already",
                where=str(folder),
                expected="a new folder, or an empty one",
            ) from None
        raise cannot_write(folder, error, "the folder") from None
    finally:
        space.remove()
