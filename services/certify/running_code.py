"""Identifies the running code of services and bridge: the proofs of the kernels do not cover it.

The digest is over the files, so that it is the same wherever the same version runs; the functions
loaded in this process are compared with the files, and the files with the installed release, if
any.
"""

from __future__ import annotations

import base64
import hashlib
import importlib.metadata
import inspect
import os
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from cratous.core.kernel.sources import ROOT, runs_as_written

PARTS = ("bridge", "services")
NO_RELEASE = "no release to compare with"
SHOWN = 3
"""Number of files or functions named where more differ."""


def _files() -> dict[str, bytes]:
    """The sources of both parts by relative path, in sorted order."""
    found = {}
    for part in PARTS:
        for folder, _, names in os.walk(ROOT / part):
            above = Path(folder).relative_to(ROOT).parts
            for name in names:
                if name.endswith(".py"):
                    with open(os.path.join(folder, name), "rb") as file:
                        found[(*above, name)] = file.read()
    return {"/".join(parts): found[parts] for parts in sorted(found)}


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more


def _other_code() -> Iterator[str]:
    """Functions of imported modules of both parts whose code differs from their files."""
    for name, module in sorted(sys.modules.items()):
        parts = name.split(".")
        if parts[0] != "cratous" or parts[1:2] not in (["bridge"], ["services"]):
            continue
        for function in vars(module).values():
            own = inspect.isfunction(function) and function.__module__ == name
            if own and not hasattr(function, "__wrapped__") and not runs_as_written(function):
                yield f"{name.removeprefix('cratous.')}.{function.__qualname__}"


def _recorded(distribution: importlib.metadata.Distribution) -> dict[str, str]:
    """The hashes recorded in an installed release for the sources of both parts, by relative path."""
    found = {}
    for path in distribution.files or []:
        top, _, inside = path.as_posix().partition("/")
        mine = top == "cratous" and inside.split("/")[0] in PARTS and inside.endswith(".py")
        if mine and path.hash is not None and path.hash.mode == "sha256":
            found[inside] = path.hash.value
    return found


def against(files: dict[str, bytes], recorded: dict[str, str], version: str) -> str:
    """How the files compare with a release: `release X`, `differs from release X: ...`, or that there is none."""
    if not recorded:
        return NO_RELEASE
    now = {
        place: base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        for place, data in files.items()
    }
    wrong = sorted(p for p in {*now, *recorded} if now.get(p) != recorded.get(p))
    return f"differs from release {version}: {_listed(wrong)}" if wrong else f"release {version}"


@cache
def code_digest() -> str:
    """SHA-256 of the files of services and bridge, computed at the first call."""
    return _digest(_files())


def _digest(files: dict[str, bytes]) -> str:
    sha = hashlib.sha256()
    for place, data in files.items():
        sha.update(f"{place} {len(data)}\n".encode() + data)
    return sha.hexdigest()


@cache
def running_code() -> dict[str, str]:
    """Identity of services and bridge, computed once: `digest` of the files, `running` and `release` in words."""
    files = _files()
    try:
        installed = importlib.metadata.distribution("cratous")
        here = Path(str(installed.locate_file("cratous"))).resolve() == ROOT
        release = against(files, _recorded(installed) if here else {}, installed.version)
    except importlib.metadata.PackageNotFoundError:
        release = NO_RELEASE
    other = list(_other_code())
    running = f"not what its files say: {_listed(other)}" if other else "as its files say"
    return {"digest": _digest(files), "running": running, "release": release}
