"""Replaces old results by new ones atomically, and recovers after a killed process.

The hidden folder of a run contains `filling`, then `ready`; the exchange with the target is one
system call (two renames if the file system cannot exchange), after which the former folder is
`old`. Other files of the user are linked into the new folder before the exchange, folders are moved
afterwards. At any time the old or the new results are at the target, or the next run restores them.
"""

from __future__ import annotations

import ctypes
import errno
import json
import os
import shutil
import stat
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from cratous.core.files.whole_file import LOCK, dead, sync
from cratous.services.results.names import MANIFEST_NAME, REPORT_NAME
from cratous.services.results.ownership import is_plain, look
from cratous.spec.errors import BadInput

RUN = ".cratous-run"
FILLING, READY, OLD, JOURNAL = "filling", "ready", "old", "journal"
EXCHANGE = 2  # RENAME_EXCHANGE of linux/fs.h
HERE = -100  # AT_FDCWD

Tell = Callable[[str], None]


def refuse_foreign(place: Path, target: Path) -> None:
    """BadInput if what is at the target cannot be replaced."""
    if not place.exists():
        return
    if not os.access(place, os.R_OK | os.W_OK | os.X_OK):
        raise BadInput(
            "the results folder cannot be replaced", where=str(target),
            expected="a folder that may be written", got="one that may not",
        )  # fmt: skip
    found = look(place)
    if found.blocking:
        more = f" and {len(found.blocking) - 5} more" if len(found.blocking) > 5 else ""
        raise BadInput(
            "the results folder holds something else",
            where=str(target),
            expected="no such folder, an empty one, or results of a run as they were written "
            "(other files may stand beside them); move these, or give another --out",
            got=", ".join(found.blocking[:5]) + more,
        )


def install(space: Path, place: Path) -> None:
    """Move the `ready` folder to its place; what was there becomes `old`."""
    ready, old = space / READY, space / OLD
    if not os.path.lexists(place):
        os.rename(ready, place)
        sync(place.parent)
        return
    refuse_foreign(place, place)
    mode = stat.S_IMODE(place.stat().st_mode)
    for name in look(place).foreign:
        if is_plain(place / name):
            with suppress(OSError, NotImplementedError):  # otherwise moved after the exchange
                os.link(place / name, ready / name, follow_symlinks=False)
    if exchange(ready, place):
        os.rename(ready, old)
    else:
        os.rename(place, old)
        os.rename(ready, place)
    place.chmod(mode)
    sync(place.parent)


def clear(space: Path, place: Path, tell: Tell) -> None:
    """Move foreign files from the old folder to the new one, and remove the rest."""
    old = space / OLD
    if not old.exists():
        return
    found = look(old)
    for name in found.foreign:
        here, there = old / name, place / name
        if not os.path.lexists(there):
            os.rename(here, there)
        elif os.path.samestat(here.lstat(), there.lstat()):
            here.unlink()
    # the manifest and report, which identify the others as ours, are removed last
    for name in sorted(found.ours, key=lambda n: (n == MANIFEST_NAME, n == REPORT_NAME)):
        (old / name).unlink()
    if any(old.iterdir()):
        kept = _free(place, "kept")
        os.rename(old, kept)
        tell(f"{place}: files of the same names had changed meanwhile; they are in {kept}")
        return
    old.rmdir()


def keep(space: Path, place: Path, error: Exception, tell: Tell) -> None:
    """Keep results that could not be installed under another name, stated in the error."""
    if not _is_new(space):  # installed, but some of the old results could not be removed
        tell(
            f"{place}: the results are in place, but not all of the former folder is cleared away "
            f"({error}); the rest is in {space}, and the next run here will try again"
        )
        return
    kept = _free(place, "new")
    try:
        if not os.path.lexists(place) and (space / OLD).exists():
            os.rename(space / OLD, place)
        os.rename(space / READY, kept)
    except OSError:
        kept = space / READY
        reason = f"{error}; the next run here will try again"
        raise BadInput(
            f"the new results could not take their place: {reason}", where=str(place),
            got=f"the new results are in {kept}",
        ) from None  # fmt: skip
    remove(space)
    raise BadInput(
        f"the new results could not take their place, so they are in {kept}: {error}",
        where=str(place),
    ) from None


def _free(place: Path, word: str) -> Path:
    number = 1
    while os.path.lexists(place.with_name(f"{place.name}-{word}-{number}")):
        number += 1
    return place.with_name(f"{place.name}-{word}-{number}")


def recover(parent: Path, tell: Tell) -> None:
    """Complete or undo what killed runs left beside their targets in a folder."""
    for space, handle in dead(parent, RUN):
        try:
            _recover(space, tell)
        except (OSError, BadInput, ValueError, KeyError, TypeError) as error:
            tell(f"what a killed run left in {space} is not cleared away: {error}")
        finally:
            os.close(handle)


def _recover(space: Path, tell: Tell) -> None:
    if not (space / READY).exists() and not (space / OLD).exists():
        remove(space)
        return
    name = str(_journal(space)["target"])
    if Path(name).name != name:
        raise ValueError(f"no name of a folder: {name!r}")
    place, ready, old = space.parent / name, space / READY, space / OLD
    if ready.exists() and not _is_new(space):
        os.rename(ready, old)  # killed right after the exchange
    if ready.exists():
        try:
            install(space, place)
            tell(f"{place}: put in place the results of a run that was killed at its end")
        except BadInput as error:
            with suppress(BadInput):
                keep(space, place, error, tell)
            tell(f"{error.where}: {error.what}; results of a killed run are beside it")
            return
    elif not os.path.lexists(place):
        os.rename(old, place)
        tell(f"{place}: restored the results that a killed run had moved away")
    else:
        tell(f"{place}: cleared away what a killed run had left")
    clear(space, place, tell)
    remove(space)


def _journal(space: Path) -> dict[str, object]:
    data = json.loads((space / JOURNAL).read_text(encoding="utf-8"))
    return dict(data)


def _is_new(space: Path) -> bool:
    """Whether `ready` contains the new results; after the exchange it contains the replaced ones."""
    ready = space / READY
    return ready.exists() and ready.stat().st_ino == _journal(space)["inode"]


def remove(space: Path) -> None:
    """Remove a hidden folder that CRATOUS made, unless it contains results."""
    if (space / READY).exists() or (space / OLD).exists():
        return
    shutil.rmtree(space / FILLING, ignore_errors=True)
    with suppress(OSError):  # the lock is removed last, so that the next run can find leftovers
        (space / JOURNAL).unlink(missing_ok=True)
        (space / LOCK).unlink(missing_ok=True)
        space.rmdir()


def exchange(one: Path, other: Path) -> bool:
    """Exchange two names atomically; False if the system or its file system cannot."""
    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):
        return False
    if rename(HERE, os.fsencode(one), HERE, os.fsencode(other), ctypes.c_uint(EXCHANGE)) == 0:
        return True
    number = ctypes.get_errno()
    if number in (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP):
        return False
    raise OSError(number, os.strerror(number), str(other))
