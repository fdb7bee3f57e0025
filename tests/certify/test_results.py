"""Results folders: exchanged as a whole, nobody else's files touched, nothing left by what is killed."""

from __future__ import annotations

import errno
import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from log_tools import full_disk

from cratous.core.files.whole_file import Workspace
from cratous.services.logs.log import LogWriter
from cratous.services.results import swap
from cratous.services.results.folder import results_folder
from cratous.services.results.names import FORMAT, NAMES
from cratous.services.results.ownership import look
from cratous.spec.errors import BadInput

CHILD = Path(__file__).parents[1] / "children" / "results_child.py"


def fill(target: Path, text: str, names: tuple[str, ...] = ("report.json", "log.sqlite")) -> None:
    with results_folder(target) as folder:
        for name in names:
            (folder / name).write_text(text)


def hidden(folder: Path) -> list[str]:
    return [entry.name for entry in folder.iterdir() if entry.name.startswith(".")]


def snapshot(folder: Path) -> dict[str, str]:
    files = [file for file in folder.rglob("*") if file.is_file()]
    return {str(f.relative_to(folder)): f.read_text() for f in files if f.name != "manifest.json"}


def former(folder: Path) -> Path:
    """What the version before manifests left."""
    folder.mkdir()
    with LogWriter(folder / "log.sqlite", str, mission_hash="ab" * 32):
        pass
    certificate = {"sha256": "cd" * 32}
    report = {"format": FORMAT, "mission_hash": "ab" * 32, "plan": {"certificate": "cd" * 32}}
    (folder / "report.json").write_text(json.dumps(report))
    (folder / "report.html").write_text(f"<!doctype html>{'ab' * 32}")
    (folder / "map.svg").write_text('<svg aria-label="Map of the flight"/>')
    (folder / "certificate.json").write_text(json.dumps(certificate))
    return folder


@pytest.fixture(params=["exchange", "renames"])
def both(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """With the system call that exchanges two names, and on file systems without it."""
    if request.param == "renames":
        monkeypatch.setattr(swap, "exchange", lambda _one, _other: False)
    return str(request.param)


# --- whose files


def test_results_are_replaced(tmp_path: Path, both: str) -> None:
    target = tmp_path / "deep" / "out" / "x"
    fill(target, "one", ("report.json", "certificate.json"))
    assert sorted(f.name for f in target.iterdir()) == [
        "certificate.json", "manifest.json", "report.json",
    ]  # fmt: skip
    fill(target, "two")
    assert snapshot(target) == {"report.json": "two", "log.sqlite": "two"}
    assert [entry.name for entry in target.parent.iterdir()] == ["x"]


def test_files_and_folders_of_the_user_stay(tmp_path: Path, both: str) -> None:
    target = tmp_path / "x"
    fill(target, "one")
    (target / "notes.txt").write_text("mine")
    (target / "photos").mkdir()
    (target / "photos" / "a.jpg").write_text("mine too")
    (target / "link").symlink_to("notes.txt")
    (target / ".hidden").write_text("h")
    before = (target / "notes.txt").stat()
    target.chmod(0o750)
    fill(target, "two")
    assert snapshot(target) == {
        "report.json": "two", "log.sqlite": "two", "notes.txt": "mine",
        "photos/a.jpg": "mine too", "link": "mine", ".hidden": "h",
    }  # fmt: skip
    assert (target / "link").is_symlink()
    after = (target / "notes.txt").stat()
    assert (after.st_ino, after.st_mtime_ns, after.st_nlink) == (
        before.st_ino, before.st_mtime_ns, 1,
    )  # fmt: skip
    assert target.stat().st_mode & 0o777 == 0o750
    assert hidden(tmp_path) == []


def test_a_file_called_report_json_does_not_make_a_folder_ours(tmp_path: Path) -> None:
    for text in ("{}", "my report", json.dumps({"format": FORMAT}), "[" * 100_000):
        mine = tmp_path / "mine"
        mine.mkdir()
        (mine / "report.json").write_text(text)
        (mine / "thesis.txt").write_text("years of work")
        with pytest.raises(BadInput, match=r"holds something else.*report\.json, thesis\.txt"):
            fill(mine, "new")
        assert snapshot(mine) == {"report.json": text, "thesis.txt": "years of work"}
        assert hidden(tmp_path) == []
        shutil.rmtree(mine)


def test_an_empty_folder_is_filled(tmp_path: Path, both: str) -> None:
    (tmp_path / "x").mkdir()
    fill(tmp_path / "x", "one")
    assert snapshot(tmp_path / "x") == {"report.json": "one", "log.sqlite": "one"}


@pytest.mark.parametrize("name", [*NAMES[:5], "log.sqlite-journal"])
def test_what_was_changed_since_is_not_replaced(tmp_path: Path, name: str) -> None:
    fill(tmp_path / "x", "one", NAMES[:5])
    (tmp_path / "x" / name).write_text("my corrections")
    with pytest.raises(BadInput, match="not as it was written") as caught:
        fill(tmp_path / "x", "two")
    assert name in caught.value.got
    assert (tmp_path / "x" / name).read_text() == "my corrections"


def test_results_of_the_former_version_are_ours(tmp_path: Path, both: str) -> None:
    target = former(tmp_path / "x")
    (target / "notes.txt").write_text("mine")
    assert look(target).ours == {*NAMES} - {"manifest.json"}
    fill(target, "two")
    assert snapshot(target) == {"report.json": "two", "log.sqlite": "two", "notes.txt": "mine"}


@pytest.mark.parametrize("name", NAMES[1:5])
def test_of_the_former_version_only_what_belongs_to_its_report(tmp_path: Path, name: str) -> None:
    target = former(tmp_path / "x")
    (target / name).write_text("something else")
    with pytest.raises(BadInput, match="not as it was written"):
        fill(target, "two")
    assert (target / name).read_text() == "something else"


# --- targets


def test_a_link_stays_a_link(tmp_path: Path, both: str) -> None:
    disk, out = tmp_path / "disk", tmp_path / "out"
    disk.mkdir()
    out.mkdir()
    (out / "x").symlink_to(disk / "results")  # to what does not exist yet
    for text in ("one", "two"):
        fill(out / "x", text)
        assert (out / "x").is_symlink()
        assert snapshot(disk / "results") == {"report.json": text, "log.sqlite": text}
    assert hidden(disk) == hidden(out) == []


def test_targets_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("f")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "to-file").symlink_to(tmp_path / "file")
    for target, words in (
        (tmp_path / "file", "no folder"),
        (tmp_path / "to-file", "no folder"),
        (tmp_path / "loop", "leads nowhere"),
        (tmp_path / "file" / "x", "cannot be written"),
        (Path("/proc"), "mounted"),
        (Path("/proc/x"), "cannot be written"),
    ):
        with pytest.raises(BadInput, match=words), results_folder(target):
            pytest.fail("nothing is flown for a target that cannot be")
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "loop", "to-file"]


@pytest.mark.parametrize("locked", ["parent", "target"])
def test_folders_that_may_not_be_written(tmp_path: Path, locked: str) -> None:
    fill(tmp_path / "x", "one")
    folder = tmp_path if locked == "parent" else tmp_path / "x"
    folder.chmod(0o555)
    if os.access(folder, os.W_OK):
        folder.chmod(0o755)
        pytest.skip("who runs this may write everywhere")
    try:
        with pytest.raises(BadInput, match="cannot be"), results_folder(tmp_path / "x"):
            pytest.fail("nothing is flown for a target that cannot be")
    finally:
        folder.chmod(0o755)


# --- failures


def test_a_failure_keeps_the_old_results(tmp_path: Path) -> None:
    fill(tmp_path / "x", "old")

    def failing() -> None:
        with results_folder(tmp_path / "x") as folder:
            (folder / "report.json").write_text("new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        failing()
    assert snapshot(tmp_path / "x") == {"report.json": "old", "log.sqlite": "old"}
    assert [entry.name for entry in tmp_path.iterdir()] == ["x"]
    with pytest.raises(KeyboardInterrupt), results_folder(tmp_path / "a" / "b" / "c"):
        raise KeyboardInterrupt
    assert [entry.name for entry in tmp_path.iterdir()] == ["x"], "the folders that it made, too"


def test_what_gets_in_the_way_meanwhile_costs_no_results(tmp_path: Path) -> None:
    fill(tmp_path / "x", "old")

    def disturbed() -> None:
        with results_folder(tmp_path / "x") as folder:
            (folder / "report.json").write_text("new")
            (tmp_path / "x" / "report.json").write_text("edited while it flew")

    with pytest.raises(BadInput, match=r"could not take their place.*x-new-1"):
        disturbed()
    assert snapshot(tmp_path / "x-new-1") == {"report.json": "new"}
    assert (tmp_path / "x" / "report.json").read_text() == "edited while it flew"
    assert hidden(tmp_path) == []


@pytest.mark.parametrize("name", ["rename", "link", "unlink", "rmdir", "fsync", "open"])
def test_any_call_that_fails_at_the_end_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, both: str, name: str
) -> None:
    """Each call of a kind fails once, in turn; the old or the new results stand there, or both."""
    call = getattr(os, name)
    for turn in range(40):
        case = tmp_path / str(turn)
        case.mkdir()
        target = case / "x"
        fill(target, "old")
        (target / "notes.txt").write_text("mine")
        left = [turn]

        def fails(*arguments: object, left: list[int] = left, **named: object) -> object:
            left[0] -= 1
            if left[0] == -1:
                raise OSError(errno.EIO, "it fails", str(arguments[0]))
            return call(*arguments, **named)

        said: list[str] = []
        try:
            with results_folder(target, said.append) as folder:
                (folder / "report.json").write_text("new")
                monkeypatch.setattr(os, name, fails)
        except BadInput as error:
            said.append(str(error))
        monkeypatch.setattr(os, name, call)
        found = list(snapshot(case).items())
        assert "mine" in [text for path, text in found if path.endswith("notes.txt")], said
        assert said or left[0] >= 0 or name in ("link", "rmdir", "unlink", "open"), turn
        assert {text for path, text in found if path.endswith("report.json")} & {"old", "new"}
        with results_folder(target) as folder:  # the next run works, and clears up
            (folder / "report.json").write_text("next")
        assert snapshot(target) == {"report.json": "next", "notes.txt": "mine"}
        assert hidden(case) == no_lock_yet(case)
        if left[0] >= 0:
            return
    pytest.fail("it never came to its end")


def killed(target: Path, stop: int, how: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(CHILD), str(target), str(stop), how]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


@pytest.mark.slow
@pytest.mark.parametrize("how", ["exchange", pytest.param("renames", marks=pytest.mark.long)])
def test_killed_at_every_step(tmp_path: Path, how: str) -> None:
    """Before each call that changes the disk: old or new is there, or the next run restores it."""
    for stop in range(200):
        case = tmp_path / str(stop)
        case.mkdir()
        target = case / "x"
        fill(target, "old")
        (target / "notes.txt").write_text("mine")
        (target / "photos").mkdir()
        (target / "photos" / "a.jpg").write_text("mine too")
        done = killed(target, stop, how)
        assert done.returncode in (0, -signal.SIGKILL), done.stderr
        if how == "exchange":
            assert (target / "report.json").read_text() in ("old", "new"), "never a moment without"
            assert (target / "notes.txt").read_text() == "mine"
        said: list[str] = []
        was_there = target.exists()
        with pytest.raises(KeyboardInterrupt), results_folder(target, said.append):
            raise KeyboardInterrupt  # it only looks after what was left
        assert was_there or said, "a restored folder is told"
        text = (target / "report.json").read_text()
        assert snapshot(target) == {
            "report.json": text, "log.sqlite": text, "notes.txt": "mine",
            "photos/a.jpg": "mine too",
        }  # fmt: skip
        assert text in ("old", "new")
        assert {entry.name for entry in case.iterdir()} - {"x"} <= set(no_lock_yet(case)), stop
        if done.returncode == 0:
            assert text == "new"
            assert stop == int(done.stdout)
            return
    pytest.fail("it never came to its end")


def no_lock_yet(folder: Path) -> list[str]:
    """Folders whose maker was killed before it had made their lock: for a minute they stay."""
    return [name for name in hidden(folder) if not any((folder / name).iterdir())]


def test_the_folder_of_a_living_process_is_left_alone(tmp_path: Path) -> None:
    with results_folder(tmp_path / "x") as folder:
        fill(tmp_path / "x", "another")
        assert folder.is_dir()
        (folder / "report.json").write_text("mine")
    assert snapshot(tmp_path / "x") == {"report.json": "mine"}
    assert hidden(tmp_path) == []


def test_an_old_folder_without_a_lock_goes(tmp_path: Path) -> None:
    space = Workspace(tmp_path, "x", swap.RUN)
    (space.path / "lock").unlink()
    os.utime(space.path, (1, 1))
    fill(tmp_path / "x", "one")
    assert [entry.name for entry in tmp_path.iterdir()] == ["x"]


@pytest.fixture
def living(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """A process in the midst of a run into tmp_path/x."""
    command = [sys.executable, str(CHILD), str(tmp_path / "x"), "0", "wait"]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    yield child
    child.kill()
    child.wait()


def test_only_what_dead_processes_left_is_cleared(
    tmp_path: Path, living: subprocess.Popen[str]
) -> None:
    fill(tmp_path / "x", "one")
    assert len(hidden(tmp_path)) == 1, "its process lives"
    living.kill()
    living.wait()
    fill(tmp_path / "x", "two")
    assert [entry.name for entry in tmp_path.iterdir()] == ["x"]


# --- full disks


def test_a_disk_that_fills_during_a_run(tmp_path: Path) -> None:
    target = tmp_path / "x"
    fill(target, "old")

    def log() -> None:
        with results_folder(target) as folder, LogWriter(folder / "log.sqlite", str) as writer:
            for number in range(10_000):
                writer.note(f"{number}", "x" * 1000)

    def file() -> None:
        with results_folder(target) as folder:
            (folder / "report.json").write_text("x" * 200_000)

    for writes in (log, file):
        with full_disk(100_000), pytest.raises(BadInput) as caught:
            writes()
        assert "cannot be written" in caught.value.what
        assert caught.value.where.startswith(str(target)), "the place that the user knows"
        assert snapshot(target) == {"report.json": "old", "log.sqlite": "old"}
        assert [entry.name for entry in tmp_path.iterdir()] == ["x"]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_is_called_full(tmp_path: Path, number: int) -> None:
    with pytest.raises(BadInput, match=r"disk (is full|quota)"), results_folder(tmp_path / "x"):
        raise OSError(number, os.strerror(number))
    full = sqlite3.OperationalError("database or disk is full")
    full.sqlite_errorcode = sqlite3.SQLITE_FULL
    from cratous.services.logs.store import cannot_write

    assert "the disk is full" in cannot_write(tmp_path, full).what
    assert "the disk is full" in cannot_write(tmp_path, sqlite3.Error(str(full))).what
