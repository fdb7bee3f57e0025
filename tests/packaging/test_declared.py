"""What `pip install` brings is what the product imports, in the versions that the ledger vouches for."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path
from typing import Any

import pytest

from cratous import __version__
from cratous.core import ledger
from cratous.services.cli import main
from cratous.services.cli.demo import missions
from cratous.spec.errors import NotInstalled
from cratous.spec.files.extras import EXTRAS, told

PARTS = ("spec", "core", "proofs", "bridge", "services", "judge")
COMPILER = ("numpy", "numba", "llvmlite")


@pytest.fixture(scope="module")
def project(root: Path) -> dict[str, Any]:
    return dict(tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"])


def plain(requirement: str) -> str:
    """The name of a distribution, as indexes compare it."""
    name = re.split(r"[=<>!~\[; ]", requirement)[0]
    return re.sub(r"[-_.]+", "-", name).lower()


def locked(root: Path) -> dict[str, str]:
    text = (root / "requirements.lock").read_text(encoding="utf-8")
    return {plain(n): v for n, v in re.findall(r"^([\w.-]+)==(\S+)", text, re.MULTILINE)}


def imported(root: Path) -> dict[str, set[str]]:
    """Distributions that the product imports anywhere, each with the files that do."""
    found: dict[str, set[str]] = {}
    known = packages_distributions()
    for file in (file for part in PARTS for file in (root / part).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module:
                names = [node.module]
            for top in {name.partition(".")[0] for name in names}:
                if top not in sys.stdlib_module_names | {"cratous"}:
                    place = file.relative_to(root).as_posix()
                    # an extra need not be installed
                    library = known[top][0] if top in known else EXTRAS[top][0]
                    found.setdefault(plain(library), set()).add(place)
    return found


def test_every_library_is_declared(root: Path, project: dict[str, Any]) -> None:
    always = {plain(one) for one in project["dependencies"]}
    optional = {plain(library) for library, _ in EXTRAS.values()}
    used = imported(root)
    # the compiler is loaded by name, the one it is made of by itself
    assert set(used) | {"numba", "llvmlite"} == always | optional
    assert not always & optional


def test_extras_bring_what_is_told(project: dict[str, Any]) -> None:
    extras = project["optional-dependencies"]
    for library, extra in EXTRAS.values():
        assert plain(library) in {plain(one) for one in extras[extra]}, library


def test_pins_are_those_of_the_lock(root: Path, project: dict[str, Any]) -> None:
    lock = locked(root)
    extras = project["optional-dependencies"]
    declared = project["dependencies"] + extras["prove"] + extras["sign"] + extras["pdf"]
    pins = dict(one.split("==") for one in declared if "==" in one)
    assert set(pins) == {*COMPILER, "uvicorn", "z3-solver", "cvc5", "cryptography", "reportlab"}
    assert pins == {name: lock[name] for name in pins}
    for record in ledger.read()["kernels"].values():
        for name in COMPILER:
            assert f"{name} {pins[name]}" in record["key"]["flags"]
        assert record["key"]["solver"] == f"z3 {pins['z3-solver']}"


def test_everything_of_the_extras_is_in_the_lock(root: Path, project: dict[str, Any]) -> None:
    lock = locked(root)
    extras = project["optional-dependencies"].values()
    wanted = [*project["dependencies"], *(one for extra in extras for one in extra)]
    assert [one for one in wanted if plain(one) not in lock] == []


def test_the_citation_names_this_version(root: Path) -> None:
    text = (root / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(rf"^version: {re.escape(__version__)}$", text, re.MULTILINE)
    assert f"\n## {__version__}" in (root / "CHANGELOG.md").read_text(encoding="utf-8")


def test_a_picture_without_its_library_is_told(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.backends", None)
    monkeypatch.delitem(sys.modules, "matplotlib.backends.backend_agg", raising=False)
    file = root / "examples" / "encounters" / "two_intruders.daa"
    assert main(["daa", "plot", str(file), "-o", str(tmp_path / "two.svg")]) == 2
    said = capsys.readouterr().err
    assert "matplotlib is not installed; expected the extra 'plots'" in said
    assert "pip install 'cratous[plots]'" in said
    assert list(tmp_path.iterdir()) == []


def test_what_belongs_to_no_extra_is_a_defect() -> None:
    with pytest.raises(NotInstalled, match=r"pyzmq is not installed.*cratous\[wires\]"), told():
        raise ModuleNotFoundError(name="zmq.auth")
    with pytest.raises(ModuleNotFoundError), told():
        import a_library_that_nobody_has  # type: ignore[import-not-found]  # noqa: F401


def test_examples_are_listed_and_others_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert set(missions()) >= {"crossing", "popup", "relations", "search"}
    assert main(["demo", "--list"]) == 0
    shown = capsys.readouterr().out
    assert all(str(file) in shown for file in missions().values())
    assert main(["demo", "nosuch"]) == 2
    assert f"expected {', '.join(missions())}; got nosuch" in capsys.readouterr().err
