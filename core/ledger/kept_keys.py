"""Cached keys of a home's entries, under the hash of everything that they are computed from.

The walks of `keys` take most of the gate's time and depend only on files, versions and the registry. So their result
is stored in the private cache, as `tables` stores what files define; every file is still read and hashed at each
start, and any difference causes the walks to be repeated.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import json
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cratous.core.files.private_cache import private_cache
from cratous.core.kernel import Entry, checkers
from cratous.core.kernel.sources import constants_of, digest
from cratous.core.ledger.key_parts import MISSING, PARTS, PROVENANCE, compiler, solver_version
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.module_trees import DATA
from cratous.core.ledger.package_home import PRODUCT, Home

FOLDERS = ("bridge", "core", "proofs", "services", "spec")
"""The product's folders with modules; results with names that lead elsewhere are not cached."""
KEPT = "keys"
"""The folder within the cache."""

Found = dict[str, dict[str, str]]
Rests = Mapping[str, Mapping[str, Any]]
"""The running dependencies of each entry, by its name (`core.kernel.sources.reached`)."""


def keys_of(home: Home, known: Mapping[str, Entry], rests: Rests, data: Mapping[str, Any]) -> Found:
    """The key parts of each of these entries, all of which have records in this ledger."""
    stamp = _stamp(home, known, rests, data)
    file = private_cache() / KEPT / stamp
    with contextlib.suppress(OSError, ValueError):
        found: Found = json.loads(file.read_text(encoding="utf-8"))
        if _is_found(found, known):
            return found
    keys = Keys(home)
    made = _made(keys, known, data)
    whole = not any(MISSING in key.values() for key in made.values())
    # a file edited meanwhile may be in the keys and not in the stamp
    if whole and not _elsewhere(keys.tree.asked) and _stamp(home, known, rests, data) == stamp:
        _keep(file, made)
    return made


def made_anew(
    home: Home, known: Mapping[str, Entry], rests: Rests, data: Mapping[str, Any]
) -> Found:
    """As `keys_of`, without reading or writing the cache."""
    return _made(Keys(home), known, data)


def _made(keys: Keys, known: Mapping[str, Entry], data: Mapping[str, Any]) -> Found:
    with _no_garbage():
        return {
            name: keys.of(entry, data["kernels"][name]["theorems"], data["theorems"])
            for name, entry in known.items()
        }


@contextlib.contextmanager
def _no_garbage() -> Iterator[None]:
    """Context without garbage collection: among a million syntax nodes there is hardly any garbage."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def _is_found(found: Any, known: Mapping[str, Entry]) -> bool:
    """Whether a cached result is complete: a key for each entry, a text for each part."""
    return (
        isinstance(found, dict)
        and set(found) == set(known)
        and all(
            isinstance(key, dict) and set(key) == {*PARTS, *PROVENANCE} for key in found.values()
        )
        and all(type(value) is str for key in found.values() for value in key.values())
    )


def _keep(file: Path, made: Found) -> None:
    with contextlib.suppress(OSError):  # a folder that cannot be written is no error
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = file.with_name(f"{file.name}.{os.getpid()}")
        part.write_text(json.dumps(made, separators=(",", ":")), encoding="utf-8")
        part.replace(file)


def _stamp(home: Home, known: Mapping[str, Entry], rests: Rests, data: Mapping[str, Any]) -> str:
    """One hash over everything that the keys are computed from: files, versions, the registry, the records."""
    texts = [sys.version, compiler(), solver_version(), home.name]
    for root, folders in _roots(home):
        texts += [f"{root.name} {name}" for name in _names(root)]
        for folder in folders:
            texts += _files(root, folder)
    for name, entry in sorted(known.items()):
        rechecked = checkers(entry) if entry.kind == "driver" else ()
        texts += [name, entry.kind, str(entry.implements), *constants_of(rests[name]), *rechecked]
        texts.append(json.dumps(data["kernels"][name]["theorems"]))
    lemmas = {name: record.get("lemmas", ()) for name, record in data["theorems"].items()}
    return digest([*texts, json.dumps(lemmas, sort_keys=True)])


def _roots(home: Home) -> Iterator[tuple[Path, tuple[str, ...]]]:
    yield PRODUCT.root, FOLDERS
    if not home.product:
        yield home.root, ("",)


def _names(root: Path) -> list[str]:
    """The entries at the top of a package, to which a name might lead."""
    return sorted(entry.name for entry in os.scandir(root))


def _files(root: Path, folder: str) -> Iterator[str]:
    """Every folder below, and every module and data file with the hash of its contents."""
    for place, folders, names in os.walk(root / folder, followlinks=True):
        folders[:] = sorted(name for name in folders if name != "__pycache__")
        yield os.path.relpath(place, root)
        for name in sorted(names):
            if name.endswith((".py", *DATA)):
                with open(os.path.join(place, name), "rb") as file:
                    yield f"{name} {hashlib.sha256(file.read()).hexdigest()}"


def _elsewhere(asked: set[str]) -> bool:
    """Whether a name led to a part of the product that is not hashed."""
    tops = {module.split(".")[1] for module in asked if module.startswith("cratous.")}
    return any(
        (PRODUCT.root / top).exists() or (PRODUCT.root / f"{top}.py").exists()
        for top in tops - set(FOLDERS)
    )
