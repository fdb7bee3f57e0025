"""A package with kernels of its own: its name and folder, and the locations of its parts."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

from cratous.core.kernel.sources import ROOT, add_package
from cratous.spec.errors import BadInput


@dataclass(frozen=True)
class Home:
    """A package with kernels: its name and folder, and the locations of its parts."""

    name: str
    root: Path

    @property
    def product(self) -> bool:
        """True iff it is the product itself."""
        return self.name == "cratous"

    @property
    def records(self) -> Path:
        """The folder of its ledger."""
        return self.root / "core" / "ledger" / "records" if self.product else self.root / "ledger"

    @property
    def theorems(self) -> Path:
        """The folder of its theorem files."""
        return self.root / "proofs" / "theorems" if self.product else self.root / "theorems"

    def definition(self, implements: str) -> Path:
        """The file of a definition, named as `module.function` or `folder.module.function`."""
        module = self.root.joinpath("spec", *implements.split(".")[:-1])
        return module / "__init__.py" if module.is_dir() else module.with_suffix(".py")

    def modules(self) -> Iterator[str]:
        """Every module that may contain kernels."""
        folder = self.root / "core" if self.product else self.root
        for file in sorted(folder.rglob("*.py")):
            parts = file.relative_to(self.root).with_suffix("").parts
            if parts[0] != "theorems" and parts[-1] not in ("__init__", "__main__"):
                yield ".".join((self.name, *parts))

    def shadowed(self) -> Iterator[Path]:
        """Module files that Python does not run because a folder or an extension module of that name is beside them."""
        folder = self.root / "core" if self.product else self.root
        for around, folders, names in os.walk(folder):
            modules = [name.removesuffix(".py") for name in sorted(names) if name.endswith(".py")]
            for stem in modules:
                package = stem in folders and any(Path(around, stem).glob("__init__.*"))
                if package or any(f"{stem}{end}" in names for end in EXTENSION_SUFFIXES):
                    yield Path(around, f"{stem}.py")

    def module(self, theorem: Path) -> str:
        """The module name of a theorem file."""
        inside = "cratous.proofs.theorems" if self.product else f"{self.name}.theorems"
        return ".".join((inside, *theorem.relative_to(self.theorems).with_suffix("").parts))


PRODUCT = Home("cratous", ROOT)


def package(name: str) -> Home:
    """The home of an installed or importable package with kernels of its own.

    Raises BadInput if there is no such package.
    """
    if name == "cratous":
        return PRODUCT
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        raise BadInput(
            f"the package cannot be imported ({error})",
            item=name,
            expected="the name of a package on the Python path",
        ) from error
    if not getattr(module, "__path__", None) or "." in name:
        raise BadInput(
            "this is a module, not a package", item=name, expected="a top-level folder of modules"
        )
    root = Path(next(iter(module.__path__))).resolve()
    for place, leads_to in _elsewhere(root, map(Path, module.__path__)):
        raise BadInput(
            "a module of the package lies elsewhere than its name says",
            where=place,
            expected="files and folders of its own, in one folder, and no symbolic links to modules",
            got=leads_to,
        )
    add_package(name, root)
    return Home(name, root)


def _elsewhere(root: Path, folders: Iterable[Path]) -> Iterator[tuple[str, str]]:
    """Further folders of a package, and symbolic links in it, through which modules are found.

    The target of a link is not part of a key, and can change later.
    """
    for folder in folders:
        if folder.resolve() != root:
            yield f"{root}: __path__", str(folder)
    for around, below, names in os.walk(root):
        for name in (*below, *(name for name in sorted(names) if name.endswith(".py"))):
            if Path(around, name).is_symlink():
                yield str(Path(around, name)), os.readlink(Path(around, name))


# -- theorems --------------------------------------------------------------------------------
def theorem_file(name: str, home: Home) -> Path | None:
    """The file of a theorem, named as such or as `package.name`: of this home, else of the product."""
    found = theorem_home(name, home)
    return None if found is None else theorems(found)[name.rpartition(".")[2]]


def theorem_home(
    name: str, home: Home, files: Mapping[Home, dict[str, Path]] | None = None
) -> Home | None:
    """The home of a theorem: this one, else the product. files: `theorems` of each."""
    package, _, plain = name.rpartition(".")
    for one in (home, PRODUCT):
        if package in ("", one.name) and plain in (theorems(one) if files is None else files[one]):
            return one
    return None


def theorems(home: Home) -> dict[str, Path]:
    """The possible theorem files of this home, by name."""
    found: dict[str, Path] = {}
    for folder, _, names in os.walk(home.theorems):
        around = "".join(f"{part}_" for part in Path(folder).relative_to(home.theorems).parts)
        for name in names:
            if name.endswith(".py"):
                # as `theorem_name` has it, which would take each path apart
                found[around + name.removesuffix(".py")] = Path(folder, name)
    return found


def theorem_name(file: Path, folder: Path) -> str:
    """The name of a theorem from its file: the folders below `theorems` and the file name, joined by `_`."""
    return "_".join(file.relative_to(folder).with_suffix("").parts)


def theorem_names(home: Home, files: Mapping[Home, dict[str, Path]] | None = None) -> set[str]:
    """All names of theorems of this home or of the product, alone or after the package name.

    files: `theorems` of each.
    """
    known = files or {one: theorems(one) for one in (home, PRODUCT)}
    whole = {f"{one.name}.{name}" for one, names in known.items() for name in names}
    return {name for names in known.values() for name in names} | whole
