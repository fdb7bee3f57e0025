"""Atomic file writes, with clean-up of what a killed writer leaves behind.

A file is written in a hidden folder beside its target and renamed when it is complete and on disk. The hidden folder
holds a lock for as long as its process lives: one whose lock is free belongs to a dead process, whatever its process
number, and the next writer beside it removes it.
"""

from __future__ import annotations

import errno
import fcntl
import os
import re
import secrets
import shutil
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cratous.spec.errors import BadInput

LOCK = "lock"
PART = ".cratous-part"
TURN_S = 10.0
UNLOCKED_S = 60.0
"""A hidden folder without a lock is assumed to be just being created, unless it is older than this [s]."""
NO_ROOM = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "the greatest size of a file is reached",
}
SQLITE_FULL, SQLITE_TEXT = 13, "database or disk is full"


def cannot_write(path: Path, error: BaseException, what: str = "the file") -> BadInput:
    """The error for a path that cannot be written; states whether space has run out."""
    full = NO_ROOM.get(getattr(error, "errno", None) or 0)
    if getattr(error, "sqlite_errorcode", None) == SQLITE_FULL or SQLITE_TEXT in str(error):
        full = NO_ROOM[errno.ENOSPC]
    return BadInput(
        f"{what} cannot be written" + (f": {full}" if full else ""),
        where=str(path),
        expected="room on its disk" if full else "a folder that can be written",
        got=getattr(error, "strerror", None) or str(error),
    )


def write_atomically(path: Path, data: str | bytes, what: str = "the file") -> None:
    """Write a file; at any moment its name refers to the old or the new content.

    Text is UTF-8. A link is followed; the permissions of an existing file are kept. Raises BadInput if it cannot be
    written, and then nothing has changed.
    """
    with replacing(path, what) as part:
        part.write_bytes(data.encode("utf-8") if isinstance(data, str) else data)


@contextmanager
def replacing(path: Path, what: str = "the file") -> Iterator[Path]:
    """Context with a path to write to; that file replaces `path` on success."""
    try:
        target = path.resolve()
        kept = _regular(target)
        space = Workspace(target.parent if kept is not None else _scratch(), target.name, PART)
    except (OSError, RuntimeError) as error:  # a loop of links is a RuntimeError before 3.13
        raise cannot_write(path, error, what) from None
    part = space.path / target.name
    try:
        yield part
        if kept is None:
            target.write_bytes(part.read_bytes())  # a device or a pipe is not replaced
            return
        _like(part, kept)
        sync(part)
        os.replace(part, target)
        sync(target.parent)
    except OSError as error:
        if error.filename is not None and str(space.path) not in str(error.filename):
            raise
        raise cannot_write(path, error, what) from None
    except BadInput as error:
        error.where = error.where.replace(str(part), str(path))
        raise
    finally:
        space.remove()


def _regular(target: Path) -> list[os.stat_result] | None:
    """The status of the existing file, if any; None for a device or a pipe; OSError if it must not be replaced."""
    try:
        found = target.stat()
    except FileNotFoundError:
        return []
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(found.st_mode):
        return None
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "the file that is there is read-only")
    return [found]


def _scratch() -> Path:
    import tempfile

    return Path(tempfile.gettempdir())


def _like(part: Path, kept: list[os.stat_result]) -> None:
    for found in kept:
        part.chmod(stat.S_IMODE(found.st_mode))
        now = part.stat()
        if (now.st_uid, now.st_gid) != (found.st_uid, found.st_gid):
            with suppress(OSError):  # only its owner or root may
                os.chown(part, found.st_uid, found.st_gid)


def sync(path: Path) -> None:
    """Flush a file, or the entries of a folder, to disk."""
    handle = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # a file system that has no fsync
            raise
    finally:
        os.close(handle)


class Workspace:
    """A hidden folder of this process, `.NAME.PID-TOKEN` and a suffix, with a lock that it holds."""

    def __init__(self, folder: Path, name: str, suffix: str) -> None:
        """Create it; remains of dead processes that wrote files in this folder are removed first."""
        with in_turn(folder):
            if suffix == PART:
                for old, handle in dead(folder, PART):
                    shutil.rmtree(old, ignore_errors=True)
                    os.close(handle)
            token = f"{os.getpid()}-{secrets.token_hex(4)}"
            self.path = folder / f".{name[:40]}.{token}{suffix}"
            os.mkdir(self.path, 0o700)
            try:
                flags = os.O_CREAT | os.O_RDWR | os.O_CLOEXEC
                self._lock = os.open(self.path / LOCK, flags, 0o600)
            except OSError:
                self.path.rmdir()
                raise
            with suppress(OSError):  # a file system without locks: then nothing is swept
                fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def remove(self) -> None:
        """Remove the folder with all that is in it."""
        shutil.rmtree(self.path, ignore_errors=True)
        self.release()

    def release(self) -> None:
        """Release the lock: what is left is removed by the next writer."""
        with suppress(OSError):
            os.close(self._lock)
        self._lock = -1


@contextmanager
def in_turn(folder: Path) -> Iterator[None]:
    """Context that admits one process at a time per folder (if its file system has locks)."""
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except OSError:
        handle = -1  # one that cannot be listed may still be written
    try:
        if handle >= 0:
            _wait_for(handle)
        yield
    finally:
        if handle >= 0:
            os.close(handle)


def _wait_for(handle: int) -> None:
    limit = time.monotonic() + TURN_S
    while time.monotonic() < limit:  # longer is somebody else's lock, or a process that is stopped
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            time.sleep(0.01)
        except OSError:
            return


def dead(folder: Path, suffix: str) -> Iterator[tuple[Path, int]]:
    """The hidden folders whose processes have ended, each with its lock, which the caller closes."""
    ours = re.compile(r"\..+\.\d+-[0-9a-f]{8}" + re.escape(suffix))
    try:
        names = sorted(name for name in os.listdir(folder) if ours.fullmatch(name))
    except OSError:
        return
    for name in names:
        handle = _taken(folder / name)
        if handle is not None:
            yield folder / name, handle


def _taken(path: Path) -> int | None:
    """The lock of one of our folders, if it is free."""
    try:
        found = path.lstat()
        if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid():
            return None
        if not (path / LOCK).exists():
            if time.time() - found.st_mtime > UNLOCKED_S:
                path.rmdir()  # killed before it had a lock, so there is nothing in it
            return None
        handle = os.open(path / LOCK, os.O_RDWR | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        return None
    return handle
