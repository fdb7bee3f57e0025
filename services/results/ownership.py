"""Identifies the files of a results folder that a run wrote and that are unchanged.

`manifest.json` lists them with their digests. Without a manifest (results of an earlier version),
files are ours if they match a `report.json` of ours by content.
"""

from __future__ import annotations

import hashlib
import json
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from cratous.services.results.legacy_results import former_files
from cratous.services.results.names import BESIDE_LOG, MANIFEST_NAME, NAMES

MANIFEST_FORMAT = "cratous-results/1"
LARGEST_MANIFEST = 1_000_000


@dataclass(frozen=True)
class Holding:
    """Content of a folder. ours: written by CRATOUS and unchanged; foreign: anything else.

    blocking: what prevents replacing the folder, with reasons.
    """

    ours: frozenset[str]
    foreign: tuple[str, ...]
    blocking: tuple[str, ...]


def look(folder: Path) -> Holding:
    """Classify the entries of a folder."""
    there = sorted(entry.name for entry in folder.iterdir())
    written = read_manifest(folder)
    if written is not None:
        named = {name for name in written if name in there}
        ours = {name for name in named if digest_of(folder / name) == written[name]}
        ours.add(MANIFEST_NAME)
    else:
        named = {name for name in NAMES if name in there}
        ours = former_files(folder)
    foreign = tuple(name for name in there if name not in ours)
    if there and not ours:
        blocking = foreign
    else:
        blocking = tuple(
            f"{name} (not as it was written by a run)"
            for name in foreign
            if name in named or name in NAMES or name in BESIDE_LOG
        )
    return Holding(frozenset(ours), foreign, blocking)


def manifest_text(folder: Path, names: Iterable[str]) -> str:
    """The text of `manifest.json` for these files of a folder."""
    files = {name: digest_of(folder / name) for name in names}
    data = {"format": MANIFEST_FORMAT, "files": files}
    return json.dumps(data, indent=1, sort_keys=True) + "\n"


def read_manifest(folder: Path) -> dict[str, str] | None:
    """The SHA-256 of each file that a run wrote into a folder; None without a manifest of ours."""
    path = folder / MANIFEST_NAME
    try:
        if not is_plain(path) or path.stat().st_size > LARGEST_MANIFEST:
            return None
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    files = data.get("files") if isinstance(data, dict) else None
    if not isinstance(files, dict) or data.get("format") != MANIFEST_FORMAT:
        return None
    if not all(
        isinstance(digest, str) and Path(name).name == name for name, digest in files.items()
    ):
        return None
    return dict(files)


def digest_of(path: Path) -> str:
    """SHA-256 of a file in hexadecimal; empty if it is no regular file."""
    if not is_plain(path):
        return ""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def is_plain(path: Path) -> bool:
    """Whether it is a regular file, not a symbolic link."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False
