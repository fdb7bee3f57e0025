"""`docs/guides/own-kernel.md`, followed to the letter; and what is refused of a package's kernels."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from guide_package import written
from ledger_tools import restored

from cratous.core import ledger

COMMAND = re.compile(r"^```console\n\$ (.*?)\n```\n```\n(.*?)```", re.S | re.M)


@pytest.fixture
def package(root: Path, tmp_path: Path) -> Path:
    return written(root, tmp_path)


def _run(
    folder: Path, root: Path, command: str, *, path: str = ""
) -> subprocess.CompletedProcess[str]:
    words = command.split()
    program = {"cratous": [sys.executable, "-m", "cratous"], "python": [sys.executable]}[words[0]]
    search = os.pathsep.join(part for part in (str(root / "src"), path) if part)
    return subprocess.run(
        [*program, *words[1:]],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": search},
        capture_output=True,
        text=True,
        timeout=900,
    )


def test_the_page_is_true(package: Path, root: Path) -> None:
    text = (root / "docs" / "guides" / "own-kernel.md").read_text(encoding="utf-8")
    commands = COMMAND.findall(text)
    assert [c.split()[0] for c, _ in commands] == ["cratous", "python"]
    for command, printed in commands:
        done = _run(package, root, command)
        assert done.returncode == 0, done.stderr
        wanted = re.sub(r"z3 [\d.]+", ledger.solver_version(), printed)
        assert done.stdout.strip() == wanted.strip()
    record = json.loads(
        (package / "my_pkg" / "ledger" / "kernels" / "my_pkg.reserve.json").read_text()
    )
    mine = record["my_pkg.reserve.reaches_home"]
    assert (mine["status"], mine["against"]) == (
        "proved against its definition",
        ["reserve_is_kept"],
    )
    again = _run(package, root, "cratous prove --package my_pkg --check")
    assert again.returncode == 0, again.stderr


GATE = """
from cratous.core import ledger
import my_pkg.reserve
print([f"{p.name}: {p.what}" for p in ledger.check_everything().problems if p.name.endswith("my_pkg.reserve.reaches_home")])
"""


@pytest.fixture(scope="module")
def proved(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's package with a ledger that vouches for it; whoever edits a file restores it."""
    home = written(root, tmp_path_factory.mktemp("proved"))
    assert _run(home, root, "cratous prove --package my_pkg").returncode == 0
    (home / "gate.py").write_text(GATE)
    fine = _run(home, root, "python gate.py")
    assert fine.stdout.strip() == "[]", fine.stdout + fine.stderr
    return home


@pytest.mark.parametrize(
    ("place", "old", "new", "what"),
    [
        ("reserve.py", ">= burn", "> burn", "its source"),
        ("spec/fuel.py", "fuel_kg - burn_kg_s *", "0 + fuel_kg - burn_kg_s *", "its definition"),
        ("theorems/reserve_is_kept.py", "speed > 0", "speed > 1", "its theorems"),
        ("ledger/theorems/theorems.json", "reserve_is_kept", "reserve_was_kept", "edited"),
    ],
)
def test_the_gate_covers_the_package(
    proved: Path, root: Path, place: str, old: str, new: str, what: str
) -> None:
    file = proved / "my_pkg" / place
    with restored(file):
        text = file.read_text()
        assert old in text
        file.write_text(text.replace(old, new))
        done = _run(proved, root, "python gate.py")
    assert what in done.stdout + done.stderr


def test_a_kernel_of_a_package_without_ledger_is_not_vouched_for(package: Path, root: Path) -> None:
    (package / "gate.py").write_text(GATE)
    assert "not in the ledger" in _run(package, root, "python gate.py").stdout


THEOREM = '''"""A sentence."""

{imports}


def claim(c):
{body}
'''


@pytest.mark.parametrize(
    ("name", "imports", "body", "wanted"),
    [
        ("names_nothing", "", "    c.show(c.real('x') >= 0)", "names no kernel"),
        (
            "shows_nothing",
            "from my_pkg.reserve import reaches_home",
            "    c.use(reaches_home, *c.reals('a b d e f'))",
            "shows nothing",
        ),
        (
            "of_a_stranger",
            "def lone(x: float) -> bool:\n    return x >= 0",
            "    c.show(c.same(c.use(lone, c.real('x')), True))",
            "'lone', which is not registered",
        ),
        (
            "of_a_lookalike",
            "def reaches_home(x: float) -> bool:\n    return x >= x",
            "    c.show(c.use(reaches_home, c.real('x')))",
            "'reaches_home', which is not registered",
        ),
        (
            "of_a_missing_kernel",
            "from my_pkg.reserve import nowhere",
            "    c.show(True)",
            "is not there",
        ),
        ("broken", "from", "    pass", "no Python"),
    ],
)
def test_a_theorem_that_binds_nothing_is_refused_with_its_place(
    package: Path, root: Path, name: str, imports: str, body: str, wanted: str
) -> None:
    file = package / "my_pkg" / "theorems" / f"{name}.py"
    file.write_text(THEOREM.format(imports=imports, body=body))
    done = _run(package, root, "cratous prove --package my_pkg")
    assert done.returncode == 2, done.stdout + done.stderr
    assert wanted in done.stderr
    assert f"my_pkg/theorems/{name}.py" in done.stderr
    assert not (package / "my_pkg" / "ledger").exists()


def test_a_kernel_without_theorem_or_definition_is_refused_with_its_place(
    package: Path, root: Path
) -> None:
    (package / "my_pkg" / "more.py").write_text(
        '"""More."""\n\nfrom cratous.core.kernel import kernel\n\n\n'
        '@kernel(implements="nowhere.at_all")\ndef one_more(a: float) -> bool:\n'
        '    """True iff a is not negative. a: any number."""\n    return a >= 0\n'
    )
    done = _run(package, root, "cratous prove --package my_pkg")
    assert done.returncode == 2
    assert "my_pkg/more.py:6: one_more: no theorem is about this kernel" in done.stderr
    assert "there is no spec/nowhere.py" in done.stderr
    assert not (package / "my_pkg" / "ledger").exists()


def test_a_kernel_and_a_theorem_may_have_names_of_the_product(package: Path, root: Path) -> None:
    file = package / "my_pkg" / "reserve.py"
    file.write_text(file.read_text().replace("def reaches_home", "def violation"))
    theorem = package / "my_pkg" / "theorems" / "reserve_is_kept.py"
    same = theorem.with_name("well_clear_violation_is_symmetric.py")
    same.write_text(theorem.read_text().replace("reaches_home", "violation"))
    theorem.unlink()
    done = _run(package, root, "cratous prove --package my_pkg")
    assert done.returncode == 0, done.stderr
    (package / "gate.py").write_text(GATE.replace("reaches_home", "my_pkg.reserve.violation"))
    assert _run(package, root, "python gate.py").stdout.strip() == "[]"


def test_a_lemma_of_two_theorems_is_named_with_its_package(package: Path, root: Path) -> None:
    folder = package / "my_pkg" / "theorems"
    text = (folder / "reserve_is_kept.py").read_text()
    (folder / "authority_exactly_one_gives_way.py").write_text(text)
    for name, status, said in (
        ("authority_exactly_one_gives_way", 2, "two theorems are called"),
        (
            "my_pkg.authority_exactly_one_gives_way",
            1,
            "premise of my_pkg.authority_exactly_one_gives_way",
        ),
        (
            "cratous.authority_exactly_one_gives_way",
            1,
            "premise of cratous.authority_exactly_one_gives_way",
        ),
        ("my_pkg.violation_is_symmetric", 2, "there is no theorem called"),
    ):
        lemma = f'    c.lemma("{name}")\n    c.show'
        (folder / "user.py").write_text(text.replace("    c.show", lemma))
        done = _run(package, root, "cratous prove --package my_pkg --only user")
        assert done.returncode == status, done.stdout + done.stderr
        assert said in done.stdout + done.stderr


def test_a_package_that_is_none_is_bad_input(tmp_path: Path, root: Path) -> None:
    done = _run(tmp_path, root, "cratous prove --package no_such_package")
    assert done.returncode == 2
    assert "no_such_package" in done.stderr
    (tmp_path / "lonely").mkdir()
    (tmp_path / "lonely" / "__init__.py").write_text("")
    done = _run(tmp_path, root, "cratous prove --package lonely")
    assert done.returncode == 2
    assert "no theorems" in done.stderr


@pytest.mark.long
def test_faults_of_the_package_s_kernel_are_looked_for(package: Path, root: Path) -> None:
    """Mutation judges the package's functions by its theorems, and leaves the product's record."""
    record = root / "proofs" / "mutation.json"
    before = record.read_bytes() if record.is_file() else b""
    done = _run(package, root, "cratous prove --package my_pkg --mutate --json")
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout)["mutation"]
    assert found["killed"] > 10
    assert found["survived"] == found["undecided"] == 0
    assert found["holds"]
    assert (record.read_bytes() if record.is_file() else b"") == before


def _to_another_file(package: Path) -> None:
    (package / "my_pkg" / "reserve.py").rename(package / "reserve.py")
    (package / "my_pkg" / "reserve.py").symlink_to(package / "reserve.py")


def _to_another_folder(package: Path) -> None:
    (package / "my_pkg" / "theorems").rename(package / "theorems")
    (package / "my_pkg" / "theorems").symlink_to(package / "theorems")


def _of_two_folders(package: Path) -> None:
    (package / "more").mkdir()
    (package / "my_pkg" / "__init__.py").write_text(f"__path__.append({str(package / 'more')!r})\n")


@pytest.mark.parametrize("change", [_to_another_file, _to_another_folder, _of_two_folders])
def test_a_package_whose_modules_lie_elsewhere_is_refused(
    package: Path, root: Path, change: Callable[[Path], None]
) -> None:
    change(package)
    done = _run(package, root, "cratous prove --package my_pkg")
    assert done.returncode != 0
    assert "a module of the package lies elsewhere than its name says" in done.stdout + done.stderr
