"""Proved theorems that nothing has touched since: recalled without lifting their kernels again.

A theorem is kept under a hash of the bytes of every file that could change what was proved: its
own, those of its lemmas, all that these import, the prover; and of the versions of solver and
Python. A theorem that asks the registry or the disk for what it is about (`DYNAMIC`) could meet
any kernel, so every file counts for it. Only proved theorems are kept; what is refuted or unknown
is looked at anew. As with solver answers, CI begins with an empty cache.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import platform
import re
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from cratous.core import ledger as gate
from cratous.core.kernel.sources import ROOT, closure, digest, imports, place
from cratous.core.ledger import PRODUCT, Home
from cratous.proofs.engine.prover import RLIMIT, Theorem, restore

DYNAMIC = re.compile(
    rb"REGISTRY|load_all|import_module|__import__|importlib|read_text|read_bytes|(?<!\w)open\("
    rb"|environ|globals\(\)|sys\.modules"
)
"""Words in a file by which a theorem may depend on more than it imports."""
PUBLIC_READINGS = ROOT / "core" / "compiled.py"
REGISTRY_ITSELF = ROOT / "core" / "kernel" / "__init__.py"
MACHINERY = frozenset(
    ROOT / "core" / name
    for name in (
        "readings/machine/compiled.py",
        "readings/machine/domain.py",
        "files/private_cache.py",
        "kernel/sources.py",
    )
)
"""They look up sources, settings and machine code for whoever runs kernels on arrays. A term takes
nothing from what they find, unless a theorem's own file asks them."""


@functools.cache
def _hash(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def named(file: Path) -> str:
    return f"{place(file)}={_hash(file)}"


@functools.cache
def _dynamic(file: Path) -> bool:
    return file != REGISTRY_ITSELF and DYNAMIC.search(file.read_bytes()) is not None


@functools.cache
def _everything(home: Home) -> tuple[Path, ...]:
    parts = [ROOT / part for part in ("spec", "core", "proofs")]
    found = {file for part in parts for file in part.rglob("*") if file.suffix in (".py", ".lark")}
    if not home.product:
        found |= set(home.root.rglob("*.py"))
    return tuple(sorted(found))


def files(name: str, home: Home = PRODUCT) -> tuple[Path, ...]:
    """Every file on which the theorem may depend, but for the prover's own."""
    known = gate.theorem_names(home)
    todo, roots = [name], {}
    while todo:
        file = gate.theorem_file(todo[-1], home)
        one = todo.pop()
        if file is not None and one not in roots:
            roots[one] = file
            todo += gate.mentioned(file) & known
    found = closure(*roots.values())
    asked = {file for root in roots.values() for file in imports(root)}
    if PUBLIC_READINGS in asked:
        asked |= set(imports(PUBLIC_READINGS))
    looked_into = [file for file in found if file not in MACHINERY or file in asked]
    return _everything(home) if any(_dynamic(file) for file in looked_into) else found


def key(name: str, home: Home = PRODUCT) -> str:
    """The hash under which the theorem is kept, as the files stand now."""
    hashed = [named(file) for file in files(name, home)]
    prover = [named(file) for file in sorted(gate.engine())]
    versions = [gate.solver_version(), platform.python_version(), str(RLIMIT)]
    return digest([home.name, name, *hashed, "the prover", *prover, *versions])


class Recall:
    """Proved theorems of one home in a folder; without a folder nothing is kept."""

    def __init__(self, folder: Path | None, home: Home = PRODUCT) -> None:
        self.folder, self.home = folder, home

    def get(self, name: str) -> Theorem | None:
        """The theorem, if it was proved from the very same files."""
        if self.folder is None:
            return None
        try:
            wanted = key(name, self.home)
        except SyntaxError:
            return None  # the prover says where
        try:
            data = json.loads((self.folder / wanted[:2] / wanted).read_text(encoding="utf-8"))
            if data["key"] != wanted or data["name"] != name:
                return None
            theorem = restore(data["theorem"])
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return theorem if theorem.proved and theorem.name == name else None

    def put(self, theorems: Iterable[Theorem]) -> None:
        """Keep those that are proved; a folder that cannot be written is no error."""
        for theorem in theorems:
            if self.folder is None or not theorem.proved:
                continue
            name = key(theorem.name, self.home)
            file = self.folder / name[:2] / name
            if file.is_file():
                continue
            data: dict[str, Any] = asdict(theorem)
            data.pop("_key")
            text = json.dumps({"key": name, "name": theorem.name, "theorem": data})
            try:
                file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
                part = file.with_name(f"{name}.{os.getpid()}")
                part.write_text(text, encoding="utf-8")
                part.replace(file)
            except OSError:
                return
