"""Who may import whom."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ALLOWED = {
    "spec": set(),
    "core": {"spec"},
    "proofs": {"spec", "core"},
    "bridge": {"spec", "core"},
    "services": {"spec", "core", "bridge"},
    "judge": {"spec"},
}
JUDGE_MAY_IMPORT = {"cratous.spec.errors"}
JUDGE_OUTSIDE = {"numpy", "yaml"}
JUDGE_COMMAND = "services/cli/judge.py"
SPEC_DATA = {
    "cratous.spec.mission",
    "cratous.spec.mission.plan",
    "cratous.spec.constraint_rows",
    "cratous.spec.errors",
    "cratous.spec.daa.parameters",
}
CORE_OUTSIDE = {"numpy", "numba"}
PROOF_COMMANDS = {
    "services/cli/prove.py",
    "services/cli/prove_checks.py",
    "services/cli/prove_elsewhere.py",
    "services/cli/prove_self_test.py",
    "services/cli/certify.py",
    "services/cli/search_faults.py",
}


def _imports(file: Path) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{file}: relative import"
            names.add(node.module)
            if node.module in ("cratous", *(f"cratous.{p}" for p in ALLOWED)):
                names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    return names


@pytest.mark.parametrize("part", sorted(ALLOWED))
def test_imports_follow_the_table(part: str, root: Path) -> None:
    wrong = []
    for file in sorted((root / part).rglob("*.py")):
        place = file.relative_to(root).as_posix()
        for name in _imports(file):
            if not name.startswith("cratous."):
                top = name.split(".")[0]
                if part == "core" and top not in sys.stdlib_module_names | CORE_OUTSIDE | {
                    "cratous"
                }:
                    wrong.append(f"{place} imports {name}")
                continue
            target = name.split(".")[1]
            if target in {part, "__version__"} | ALLOWED[part]:
                continue
            if target == "proofs" and place in PROOF_COMMANDS:
                continue
            if target == "judge" and place == JUDGE_COMMAND:
                continue
            wrong.append(f"{place} imports {name}")
    assert not wrong


def test_core_uses_only_data_of_spec(root: Path) -> None:
    wrong = [
        f"{file.name} imports {name}"
        for file in sorted((root / "core").rglob("*.py"))
        for name in _imports(file)
        if name.startswith("cratous.spec.") and name not in SPEC_DATA
    ]
    assert not wrong


def test_the_judge_shares_no_code(root: Path) -> None:
    wrong = []
    for file in sorted((root / "judge").rglob("*.py")):
        assert "import_module" not in file.read_text()
        for name in _imports(file):
            ours = name == "cratous" or name.startswith("cratous.")
            if ours and not name.startswith("cratous.judge"):
                wrong += [] if _base(name) in JUDGE_MAY_IMPORT else [f"{file.name} imports {name}"]
            elif not ours and name.split(".")[0] not in sys.stdlib_module_names | JUDGE_OUTSIDE:
                wrong.append(f"{file.name} imports {name}")
    ours = {name for name in _imports(root / JUDGE_COMMAND) if name.startswith("cratous")}
    wrong += [f"{JUDGE_COMMAND} imports {n}" for n in ours if not n.startswith("cratous.judge")]
    assert not wrong


def _base(name: str) -> str:
    return ".".join(name.split(".")[:3])


def test_nothing_of_the_judged_is_loaded_with_the_judge() -> None:
    """What the import statements say is also what happens, down to what is imported by what is imported."""
    code = (
        "import sys, pathlib\n"
        "from cratous.judge import judge\n"
        "import cratous.judge.mission_file\n"
        "try:\n"
        "    judge(pathlib.Path('no such log'))\n"
        "except Exception as error:\n"
        "    assert type(error).__name__ == 'BadInput'\n"
        "print(*sorted(m for m in sys.modules if m.startswith('cratous')))\n"
        "print(*[m for m in ('numba', 'z3', 'shapely', 'lark', 'pyproj') if m in sys.modules])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=900
    )
    ours, engines = done.stdout.splitlines()
    loaded = {m for m in ours.split() if not m.startswith("cratous.judge")}
    assert loaded == {"cratous", "cratous.spec", "cratous.spec.errors"}
    assert engines == ""


def _module(root: Path, name: str) -> Path | None:
    file = root.joinpath(*name.split(".")[1:])
    for candidate in (file.with_suffix(".py"), file / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


def test_no_circular_imports(root: Path) -> None:
    graph: dict[Path, set[Path]] = {}
    for part in ALLOWED:
        for file in (root / part).rglob("*.py"):
            found: set[Path | None] = set()
            for node in ast.parse(file.read_text()).body:
                if isinstance(node, ast.ImportFrom) and str(node.module).startswith("cratous."):
                    for alias in node.names:
                        inner = _module(root, f"{node.module}.{alias.name}")
                        found.add(inner or _module(root, str(node.module)))
            graph[file] = {f for f in found if f is not None and f != file}
    state: dict[Path, int] = {}

    def visit(file: Path, trail: tuple[Path, ...]) -> None:
        if state.get(file) == 2:
            return
        assert state.get(file) != 1, " -> ".join(f.name for f in (*trail, file))
        state[file] = 1
        for other in sorted(graph.get(file, ())):
            visit(other, (*trail, file))
        state[file] = 2

    for file in sorted(graph):
        visit(file, ())


def test_folders_refuse_another_name(root: Path) -> None:
    for name in ("core", "judge"):
        code = f"import sys; sys.path.insert(0, '.'); import {name}"
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=root, capture_output=True, text=True, timeout=900
        )
        assert done.returncode != 0
        assert f"cratous.{name}" in done.stderr
