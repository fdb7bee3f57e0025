"""Where the reference inputs lie, if they are there (the product stands without them), and what is
closed when a test ends."""

from __future__ import annotations

import fcntl
import gc
import hashlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from cratous.services.cli import progress

# what is told of work that takes long has tests of its own (tests/cli/test_waiting.py)
progress.PATIENCE_S = 3600.0
# a machine under load is no reason to fail; CI draws the same cases every time
settings.register_profile("default", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "default")
# half a million objects live to the end: looking for garbage in them is a third of collecting the tests
gc.set_threshold(10_000, 20, 50)

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared"
# as measured (tests/programs/slow_tests.py): files, and functions of files
SLOW = frozenset((ROOT / "tests" / "slow.txt").read_text(encoding="utf-8").split())


def pytest_itemcollected(item: pytest.Item) -> None:
    """What is listed as slow is marked so."""
    file = item.path.relative_to(ROOT).as_posix()
    if {file, f"{file}::{getattr(item, 'originalname', item.name)}"} & SLOW:
        item.add_marker(pytest.mark.slow)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files with slow tests come first, so that no process is left alone with one at the end."""
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: item.path not in slow)


def pytest_collection_finish() -> None:
    """What has been imported until now is no garbage: nobody looks at it again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of reference vectors and examples; skips where it is absent."""
    if not SHARED.is_dir():
        pytest.skip("the reference vectors (../shared) are not on this machine")
    return SHARED


@pytest.fixture(scope="session", autouse=True)
def _gate_once() -> Iterator[None]:
    from gate_once import ask_once

    with pytest.MonkeyPatch.context() as patch:
        ask_once(patch)
        yield


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def fly_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Results of `cratous run MISSION --allow-unproved --quiet [OPTION]...`, flown once for all processes of a run.

    Whoever changes anything in the folder copies it first.
    """
    shared_by_all = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared_by_all = shared_by_all.parent

    def results(mission: Path, *options: str) -> Path:
        from cratous.services.cli import main

        asked = "\0".join((str(mission), *options))
        home = shared_by_all / "flown" / hashlib.sha256(asked.encode()).hexdigest()[:16]
        home.mkdir(parents=True, exist_ok=True)
        with (home / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (home / "done").exists():
                words = ["run", str(mission), "--allow-unproved", "--quiet", *options]
                main([*words, "--out", str(home / "out")])
                (home / "done").touch()
        (folder,) = (home / "out").iterdir()
        return folder

    return results


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Run a command line in this process; gives exit code, standard output and standard error."""
    from cratous.services.cli import main

    def call(*arguments: object) -> tuple[int, str, str]:
        code = main([str(part) for part in arguments])
        printed = capsys.readouterr()
        return code, printed.out, printed.err

    return call


@pytest.fixture
def opened() -> Iterator[list[Any]]:
    """Everything in here is closed at the end."""
    made: list[Any] = []
    yield made
    for one in reversed(made):
        one.close()


@pytest.fixture
def straight_run_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Vehicles come to a rendezvous by straight run-ins alone, as those that are elsewhere before."""
    from cratous.services.following import rendezvous_options

    monkeypatch.setattr(rendezvous_options, "_direct", lambda *_: None)
