"""The wheel holds what the repository holds, and works where there is no source tree."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous import __version__

PARTS = ("spec", "core", "proofs", "bridge", "services", "judge", "examples")
Run = Callable[..., subprocess.CompletedProcess[str]]
CROSSING = "66bf2d0262dc461bd58b8d4ce0f53ed83e591f17a6cc2e2a08af33c1bdd7f312"
"""The digest of the log of examples/crossing, whatever Python and wherever it is flown."""


@pytest.fixture(scope="module")
def built(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with sdist and wheel of what is committed."""
    folder = tmp_path_factory.mktemp("built")
    if subprocess.run(["git", "-C", str(root), "rev-parse"], capture_output=True).returncode:
        pytest.skip("no git checkout to build from")
    done = subprocess.run(
        [sys.executable, str(root / ".ci" / "dist"), str(folder)],
        capture_output=True, text=True, timeout=900,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> Path:
    return built / f"cratous-{__version__}-py3-none-any.whl"


def _cratous(python: Path, folder: Path) -> Run:
    """The command of an environment, run in an empty folder that knows nothing of this checkout."""
    folder.mkdir()
    hidden = ("PYTHONPATH", "VIRTUAL_ENV")
    environment = {k: v for k, v in os.environ.items() if k not in hidden}

    def run(*arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(python.with_name("cratous")), *arguments],
            cwd=folder, env={**environment, **more}, capture_output=True, text=True, timeout=1800,
        )  # fmt: skip

    return run


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The command of an environment that has the wheel, and what it needs from this one."""
    folder = tmp_path_factory.mktemp("installed")
    env = folder / "env"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(env)], check=True)
    python = env / "bin" / "python"
    subprocess.run(
        [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet", "--no-deps",
         "--no-compile", str(wheel)],
        check=True, capture_output=True, timeout=900,
    )  # fmt: skip
    site = next(env.glob("lib/python*/site-packages"))
    # a plain path: editable installs are not followed from it
    (site / "needed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return _cratous(python, folder / "work")


@pytest.mark.slow
def test_wheel_and_sdist_hold_what_git_tracks(root: Path, built: Path, wheel: Path) -> None:
    # what stands in the commit that was built, not what is being edited
    listed = ["git", "ls-tree", "-r", "--name-only", "HEAD", *PARTS]
    tracked = subprocess.run(listed, cwd=root, check=True, capture_output=True, text=True).stdout
    wanted = {f"cratous/{name}" for name in tracked.split()}
    inside = {n for n in zipfile.ZipFile(wheel).namelist() if n.startswith("cratous/")}
    links = {f"cratous/{name}" for name in ("__init__.py", "__main__.py", "py.typed")}
    assert wanted | links == inside
    with tarfile.open(next(built.glob("*.tar.gz"))) as packed:
        names = packed.getnames()
        assert not any(member.issym() or member.islnk() for member in packed.getmembers())
    top = f"cratous-{__version__}"
    assert {f"{top}/src/{name}" for name in wanted} <= set(names)
    assert {f"{top}/{n}" for n in ("LICENSE", "CITATION.cff", "CHANGELOG.md")} <= set(names)


@pytest.mark.slow
def test_the_installed_package_flies_and_proves(installed: Run, tmp_path: Path) -> None:
    flown = installed("demo", "--json")
    assert flown.returncode == 0, flown.stderr
    assert json.loads(flown.stdout)["digest"] == CROSSING
    assert json.loads(flown.stdout)["folder"] == "out/crossing"
    # from an empty cache, so that nothing is recalled
    proved = installed("prove", "--only", "schedule_row_*", "--json", CRATOUS_CACHE=str(tmp_path))
    assert proved.returncode == 0, proved.stderr
    found = json.loads(proved.stdout)
    assert found["proved"] == len(found["theorems"]) >= 1


def _pythons() -> list[str]:
    """This interpreter, and those of other minor versions that the path has."""
    others = [f"python3.{minor}" for minor in (11, 12, 13) if minor != sys.version_info.minor]
    return [
        sys.executable,
        *(path for name in others if (path := shutil.which(name)) and _runs(path)),
    ]


def _runs(python: str) -> bool:
    """A name on the path may lead to no interpreter, as pyenv's does where that version is not chosen."""
    return not subprocess.run([python, "--version"], capture_output=True, timeout=60).returncode


@pytest.mark.long
@pytest.mark.parametrize("python", _pythons(), ids=lambda p: Path(p).name)
@pytest.mark.parametrize("extra", ["", "[prove]"])
def test_an_empty_environment(wheel: Path, tmp_path: Path, python: str, extra: str) -> None:
    """`pip install` of the wheel with whatever the index has; with the extra it proves everything."""
    subprocess.run([python, "-m", "venv", str(tmp_path / "env")], check=True, timeout=900)
    pip = [str(tmp_path / "env" / "bin" / "python"), "-m", "pip"]
    done = subprocess.run(
        [*pip, "install", "--quiet", f"{wheel}{extra}"],
        capture_output=True,
        text=True,
        timeout=1800,
    )
    assert done.returncode == 0, done.stderr
    cratous = _cratous(tmp_path / "env" / "bin" / "python", tmp_path / "work")
    cache = {"CRATOUS_CACHE": str(tmp_path)}
    flown = cratous("demo", "--json", **cache)
    assert flown.returncode == 0, flown.stderr
    assert json.loads(flown.stdout)["digest"] == CROSSING
    if extra:
        proved = cratous("prove", "--check", **cache)
        assert proved.returncode == 0, proved.stdout[-2000:] + proved.stderr
