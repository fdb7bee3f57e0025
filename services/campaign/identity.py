"""Identifies a run and the version that flies it, so that results are never confused."""

from __future__ import annotations

import hashlib
import json
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from cratous.core.kernel.sources import ROOT

PARTS = ("spec", "core", "bridge", "services", "judge")
"""Source folders of flight and judgement; the proof gate in core/ledger covers proofs/."""
ENDINGS = {".py", ".json", ".lark", ".conf", ".case"}
PACKAGES = ("numpy", "numba", "llvmlite", "shapely", "pyproj", "lark", "lxml", "z3-solver")


def fingerprint(data: Any) -> str:
    """SHA-256 of plain data."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def version_digest() -> str:
    """SHA-256 of our sources at the first call, and of the versions of Python and the packages."""
    return fingerprint(
        {
            "sources": sources_digest(ROOT),
            "python": platform.python_version(),
            "packages": _packages(),
        }
    )


def sources_digest(root: Path) -> str:
    """SHA-256 over names and contents of the sources below a folder."""
    sha = hashlib.sha256()
    for part in PARTS:
        for file in sorted((root / part).rglob("*")):
            if file.suffix in ENDINGS and file.is_file():
                data = file.read_bytes()
                sha.update(f"{file.relative_to(root).as_posix()} {len(data)}\n".encode() + data)
    return sha.hexdigest()


def _packages() -> dict[str, str]:
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found
