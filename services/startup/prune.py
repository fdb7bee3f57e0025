"""Cache cleaning: compiled kernels that have not been used for days, and old compiled templates.

Only files that are certainly ours are removed: folders of the private cache whose name is the hash of the
text in them, files of the gate's keys, and files named like jinja2's compiled templates; links are never
followed. Everything removed is recreated on demand.
"""

from __future__ import annotations

import shutil
import stat
import time
from pathlib import Path

from cratous.core.files.private_cache import private_cache
from cratous.core.ledger.kept_keys import KEPT
from cratous.core.readings.machine.compiled import PREFIX, folder_name
from cratous.services.certify import templates

DAY_S = 86_400.0


def prune(days: float) -> tuple[int, int]:
    """Remove compiled kernels and gate keys unused for this many days, and templates compiled that long ago.

    Returns the number of removed entries and their bytes.
    """
    before_s = time.time() - days * DAY_S
    cache = private_cache()
    old = [f for f in cache.glob(f"{PREFIX}*") if _is_ours(f) and f.lstat().st_mtime < before_s]
    freed = sum(_size(folder) for folder in old)
    for folder in old:
        shutil.rmtree(folder)
    pages = (cache / templates.KEPT).glob("*/__jinja2_*")
    kept = [*(cache / KEPT).glob("*"), *(page for page in pages if not page.parent.is_symlink())]
    files = [f for f in kept if _is_old_file(f, before_s)]
    freed += sum(file.stat().st_size for file in files)
    for file in files:
        file.unlink()
    return len(old) + len(files), freed


def _is_old_file(file: Path, before_s: float) -> bool:
    found = file.lstat()
    return stat.S_ISREG(found.st_mode) and found.st_mtime < before_s


def _is_ours(folder: Path) -> bool:
    """Whether it is a folder, not a link, with the text whose hash is its name, and without other files."""
    if not stat.S_ISDIR(folder.lstat().st_mode):
        return False
    source = folder / f"{folder.name}.py"
    try:
        if source.is_symlink() or folder_name(source.read_text(encoding="utf-8")) != folder.name:
            return False
    except (OSError, UnicodeDecodeError):
        return False
    beside = [f for f in folder.iterdir() if f.name not in (source.name, "__pycache__")]
    # left by an interrupted write
    return all(f.name.startswith(f"{folder.name}.") and f.is_file() for f in beside)


def _size(folder: Path) -> int:
    return sum(file.lstat().st_size for file in folder.rglob("*"))
