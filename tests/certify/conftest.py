"""A flight of the crossing mission that is certified, and the command that does it."""

from __future__ import annotations

import functools
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, read
from own_tools import EXPORT, TEXT

from cratous.services.certify import flight_record, rejudge, report, result_files
from cratous.services.certify import user_requirements as own_module
from cratous.services.cli import main
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.requirements.requirement_files import own_file


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory, fly_once: Callable[[Path], Path]) -> Path:
    done = fly_once(ROOT / "examples" / "crossing" / "mission.yaml")
    assert json.loads((done / "report.json").read_text())["exit_code"] in (0, 3)
    return Path(shutil.copytree(done, tmp_path_factory.mktemp("flown") / "crossing"))


@pytest.fixture(scope="module")
def judged(flown: Path) -> Iterator[None]:
    """What takes long is done once for the log: its digest, the monitor, the plan check, z3, the ledger.

    All that compares, and all that reads the report and the folder, is the product's own.
    """
    patch = pytest.MonkeyPatch()

    def once(place: Any, name: str, key: Callable[..., Any] = lambda *_a, **_k: 0) -> None:
        real, kept = getattr(place, name), {}

        @functools.wraps(real)
        def call(*arguments: Any, **named: Any) -> Any:
            found = key(*arguments, **named)
            if found not in kept:
                kept[found] = real(*arguments, **named)
            return kept[found]

        patch.setattr(place, name, call)

    once(SqliteLog, "digest", lambda log: log.path.stat().st_mtime_ns)
    once(rejudge, "watch")
    once(rejudge, "watched_and_told")
    once(rejudge, "_certificate")
    once(flight_record, "inventory", lambda _standing, calls: json.dumps(calls))
    once(flight_record.ledger, "require")
    once(report, "told_by", lambda path, _mission: path.stat().st_mtime_ns)
    rows = list(rejudge.read_log(flown / "log.sqlite"))
    patch.setattr(rejudge, "read_log", lambda _path: rows)
    once(result_files, "pages", report.report_text)
    yield
    patch.undo()


@pytest.fixture(scope="module")
def signed_run(
    flown: Path, judged: None, tmp_path_factory: pytest.TempPathFactory
) -> Path:  # `run` is the results, `views` stands beside it
    signing = pytest.importorskip("signing", reason="the extra `sign` is not installed")
    home = tmp_path_factory.mktemp("signed")
    signing.write_keys(home, "own", signing.KEY)
    signing.write_keys(home, "other", signing.OTHER)
    shutil.copytree(flown, home / "run")
    words = ["certify", home / "run", "-o", home / "views", "--sign", "--key", home / "own.pem"]
    assert main([str(word) for word in words]) == read(flown)["exit_code"]
    return home


@pytest.fixture
def home(signed_run: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(signed_run, tmp_path / "home"))


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("own")
    (folder / "own.req").write_text(TEXT)
    (folder / "export.json").write_text(json.dumps(EXPORT))
    return folder / "own.req"


@pytest.fixture(scope="module")
def watched_once() -> Iterator[None]:
    """Each text is held against the log of the flight once; all that compares is the product's own."""
    patch, real, kept = pytest.MonkeyPatch(), own_module._watched, dict[str, Any]()

    def watched(spec: Any, log: Path) -> Any:
        if repr(spec) not in kept:
            kept[repr(spec)] = real(spec, log)
        return kept[repr(spec)]

    patch.setattr(own_module, "_watched", watched)
    yield
    patch.undo()


@pytest.fixture(scope="module")
def with_own(
    flown: Path,
    judged: None,
    watched_once: None,
    own: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> Path:
    folder = tmp_path_factory.mktemp("with-own") / "run"
    shutil.copytree(flown, folder)
    rejudge.certify_again(folder, own=(own_file(own, own.name),))
    return folder
