"""The house: no import circle, arrows between folders one way, a page that names what is in it."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

PARTS = ("spec", "core", "proofs", "bridge", "services", "judge")


def _modules(root: Path) -> dict[str, Path]:
    found = {}
    for part in PARTS:
        for file in sorted((root / part).rglob("*.py")):
            names = file.relative_to(root).with_suffix("").parts
            found[".".join(("cratous", *names)).removesuffix(".__init__")] = file
    return found


def _imported(file: Path, modules: Iterable[str]) -> Iterator[str]:
    """Modules of ours that a file imports anywhere, inside functions and for types alone included."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            whole = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in modules else str(node.module) for name in whole]
        yield from (name for name in names if name in modules)


def circles(edges: dict[str, set[str]]) -> list[str]:
    """What can be reached from itself."""
    found = []
    for start in edges:
        seen: set[str] = set()
        todo = list(edges[start])
        while todo:
            one = todo.pop()
            if one not in seen:
                seen.add(one)
                todo += edges.get(one, ())
        if start in seen:
            found.append(start)
    return sorted(found)


@pytest.fixture(scope="module")
def imports(root: Path) -> dict[str, set[str]]:
    modules = _modules(root)
    assert len(modules) > 400
    return {name: set(_imported(file, modules)) - {name} for name, file in modules.items()}


def test_a_circle_is_seen() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == ["b", "c"]


def test_no_module_imports_itself_by_others(imports: dict[str, set[str]]) -> None:
    assert circles(imports) == []


def test_arrows_between_folders_go_one_way(imports: dict[str, set[str]], root: Path) -> None:
    modules = _modules(root)
    arrows: dict[str, set[str]] = {}
    for name, others in imports.items():
        folder = str(modules[name].parent)
        arrows.setdefault(folder, set()).update(str(modules[other].parent) for other in others)
        arrows[folder].discard(folder)
    assert circles(arrows) == []


@pytest.mark.parametrize("part", ["spec", "core", "proofs", "services", "bridge", "tests"])
def test_its_page_names_every_folder(part: str, root: Path) -> None:
    text = (root / part / "README.md").read_text(encoding="utf-8")
    folders = [f for f in (root / part).iterdir() if f.is_dir() and f.name != "__pycache__"]
    assert [f.name for f in folders if f"`{f.name}/`" not in text] == []


@pytest.mark.parametrize("part", ["spec", "judge"])
def test_its_page_names_every_module(part: str, root: Path) -> None:
    text = (root / part / "README.md").read_text(encoding="utf-8")
    modules = [f.name for f in (root / part).glob("*.py") if f.name != "__init__.py"]
    assert [name for name in modules if f"`{name}`" not in text] == []


def test_services_have_no_loose_files(root: Path) -> None:
    assert [file.name for file in (root / "services").glob("*.py")] == ["__init__.py"]


def test_modules_stay_short(root: Path) -> None:
    """At most 400 lines, message classes that are generated apart."""
    long = {
        file.relative_to(root).as_posix()
        for file in _written(root)
        if len(file.read_text(encoding="utf-8").splitlines()) > 400
    }
    assert long == set()


def _written(root: Path) -> Iterator[Path]:
    """Every module and test, message classes that are generated apart."""
    for part in (*PARTS, "tests"):
        for file in (root / part).rglob("*.py"):
            if "lmcp/messages" not in file.as_posix():
                yield file


def parameters(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Its parameters, positional and by keyword, the instance or class of a method apart."""
    positional = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
    return len(positional) + len(node.args.kwonlyargs) - (positional[:1] in (["self"], ["cls"]))


def test_functions_have_few_parameters(root: Path) -> None:
    """At most 8."""
    many = [
        f"{file.relative_to(root).as_posix()}:{node.lineno} {node.name}"
        for file in _written(root)
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and parameters(node) > 8
    ]
    assert many == []
