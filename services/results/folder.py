"""The results folder of a run: replaced as a whole or not at all; the user's other files in it are kept."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cratous.core.files.whole_file import NO_ROOM, Workspace, cannot_write, in_turn, sync
from cratous.services.results.names import MANIFEST_NAME
from cratous.services.results.ownership import manifest_text
from cratous.services.results.swap import (
    FILLING,
    JOURNAL,
    READY,
    RUN,
    Tell,
    clear,
    install,
    keep,
    recover,
    refuse_foreign,
    remove,
)
from cratous.services.results.undisturbed import undisturbed
from cratous.spec.errors import BadInput


def _nobody(_text: str) -> None:
    """Discard progress messages."""


@contextmanager
def results_folder(target: Path, tell: Tell = _nobody) -> Iterator[Path]:
    """A new folder that replaces the results at `target` on success, and is removed otherwise.

    BadInput, before anything is done, if the target cannot be replaced later. Files there that
    CRATOUS did not write are kept; if one of them causes a conflict only at the end, the new
    results are kept beside it, and the error says where.
    """
    place = _resolved(target)
    made = [folder for folder in place.parents if not folder.exists()]
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        with in_turn(place.parent):
            recover(place.parent, tell)
        refuse_foreign(place, target)
        run = _Run(place)
    except OSError as error:
        _remove_empty(made)
        raise cannot_write(target, error, "the results folder") from None
    except BaseException:
        _remove_empty(made)
        raise
    filled = False
    try:
        yield run.filling
        filled = True
        run.put_in_place(tell)
    except OSError as error:
        ours = error.filename is not None and str(run.space.path) in str(error.filename)
        if not ours and not filled and error.errno not in NO_ROOM:
            raise
        name = Path(str(error.filename)).name if ours else ""
        raise cannot_write(target / name, error, "the results folder") from None
    except BadInput as error:
        error.where = error.where.replace(str(run.filling), str(target))
        raise
    finally:
        run.close()
        _remove_empty(made)


def _resolved(target: Path) -> Path:
    """The final location of the results: symbolic links are resolved, so that a link is kept."""
    try:
        place = target.resolve()
    except (OSError, RuntimeError):
        raise BadInput(
            "the results folder is a link that leads nowhere", where=str(target),
            expected="a folder, or a link to one", got="a loop of links",
        ) from None  # fmt: skip
    if os.path.lexists(place) and not place.is_dir():
        raise BadInput(
            "the results folder is no folder", where=str(target),
            expected="no such name, or a folder", got="a file",
        )  # fmt: skip
    if os.path.ismount(place):
        raise BadInput(
            "the results folder is where a file system is mounted, so it cannot be replaced",
            where=str(target), expected="a folder in it (--out)",
        )  # fmt: skip
    return place


class _Run:
    """The hidden folder of one run: new results, and the record for recovery."""

    def __init__(self, place: Path) -> None:
        self.place = place
        self.space = Workspace(place.parent, place.name, RUN)
        self.filling = self.space.path / FILLING
        self._stays = False
        try:
            self.filling.mkdir()
            note = {"target": place.name, "inode": self.filling.stat().st_ino}
            (self.space.path / JOURNAL).write_text(json.dumps(note), encoding="utf-8")
        except BaseException:
            self.close()
            raise

    def put_in_place(self, tell: Tell) -> None:
        """Exchange new and old results; signals are deferred meanwhile."""
        text = manifest_text(self.filling, sorted(entry.name for entry in self.filling.iterdir()))
        (self.filling / MANIFEST_NAME).write_text(text, encoding="utf-8")
        for entry in self.filling.iterdir():
            sync(entry)
        sync(self.filling)
        with undisturbed(), in_turn(self.place.parent):
            self._stays = True
            os.rename(self.filling, self.space.path / READY)
            try:
                install(self.space.path, self.place)
                clear(self.space.path, self.place, tell)
            except (OSError, BadInput) as error:
                keep(self.space.path, self.place, error, tell)
                return
            self._stays = False

    def close(self) -> None:
        """Remove the hidden folder, unless it contains something that exists nowhere else."""
        if not self._stays:
            remove(self.space.path)
        self.space.release()


def _remove_empty(made: list[Path]) -> None:
    for folder in made:
        with suppress(OSError):
            folder.rmdir()
