"""Reads the parts of all files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cratous.services.importing.imported_content import Parts, Reading
from cratous.services.importing.kinds import KNOWN, NoKind, read_part
from cratous.spec.errors import BadInput

MOST = 200
"""Maximum number of files in a folder."""


def gathered(paths: Sequence[Path], how: Reading) -> Parts:
    """The parts of files, or of the files in folders (not subfolders) sorted by name.

    A file given by name must be of a supported kind; others in a folder are skipped and noted.
    Raises BadInput.
    """
    found = [parts for path in paths for parts in _of(path, how)]
    settings = [parts.parameters for parts in found if parts.parameters is not None]
    if len(settings) > 1:
        one = next(iter(settings[1].values()), None)
        raise BadInput(
            "two parameter files", where=one.where if one else "", expected="one, of one vehicle"
        )
    whole = Parts(
        ways=tuple(one for parts in found for one in parts.ways),
        fences=tuple(one for parts in found for one in parts.fences),
        intruders=tuple(one for parts in found for one in parts.intruders),
        parameters=settings[0] if settings else None,
        notes=tuple(one for parts in found for one in parts.notes),
    )
    if not whole.ways:
        left = "; ".join(note for note in whole.notes if "not read" in note)
        raise BadInput(
            "no flight plan", where=", ".join(map(str, paths))[:200], expected=KNOWN, got=left[:400]
        )
    return whole


def _of(path: Path, how: Reading) -> list[Parts]:
    try:
        if not path.exists():
            raise BadInput("there is no such file", where=str(path), expected=KNOWN)
        files = None
        if path.is_dir():
            files = sorted(f for f in path.iterdir() if f.is_file() and not f.name.startswith("."))
    except (OSError, ValueError) as error:
        raise BadInput(f"cannot be read ({error})", where=str(path), expected=KNOWN) from None
    if files is None:
        return [read_part(path, how)]
    if len(files) > MOST:
        raise BadInput(
            "too many files", where=str(path), expected=f"at most {MOST}", got=str(len(files))
        )
    found = []
    for file in files:
        try:
            found.append(read_part(file, how))
        except NoKind as error:
            found.append(Parts(notes=(f"{file}: not read: {error.what}",)))
    return found
