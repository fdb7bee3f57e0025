"""The cache folder for data kept between runs: machine code, solver answers, verdicts.

Anyone who can write there can change what runs, so it belongs to this user alone. A folder that another user may have
written to is refused; one that others could only read is closed to them.
"""

from __future__ import annotations

import functools
import os
import stat
from pathlib import Path

from cratous.spec.errors import BadInput

WRITABLE = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Its location: $CRATOUS_CACHE, else a folder in the user's cache folder."""
    base = os.environ.get("CRATOUS_CACHE") or os.environ.get("XDG_CACHE_HOME")
    root = Path(base) if base else Path.home() / ".cache"
    return root / "cratous"


def private_cache() -> Path:
    """The folder, created if necessary; raises BadInput if it is not this user's alone."""
    return _private(cache_folder())


@functools.cache
def _private(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        found = folder.lstat()
    except OSError as error:
        raise _refusal(folder, f"it cannot be made: {error.strerror}") from error
    if not stat.S_ISDIR(found.st_mode):
        raise _refusal(folder, "it is no folder")
    if not hasattr(os, "getuid"):
        return folder  # no owners in mode bits here
    if found.st_uid != os.getuid():
        raise _refusal(folder, f"it belongs to the user with number {found.st_uid}")
    if found.st_mode & WRITABLE:
        raise _refusal(folder, f"others may write to it (mode {stat.S_IMODE(found.st_mode):o})")
    for above in folder.resolve().parents:
        mode = above.stat().st_mode
        if mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
            raise _refusal(folder, f"anybody may exchange it: {above} is open to all")
    if stat.S_IMODE(found.st_mode) != 0o700:
        folder.chmod(0o700)
    return folder


def _refusal(folder: Path, what: str) -> BadInput:
    return BadInput(
        f"the cache folder cannot be trusted: {what}",
        where=str(folder),
        expected="a folder of your own, mode 700 (remove this one, or set CRATOUS_CACHE)",
    )
