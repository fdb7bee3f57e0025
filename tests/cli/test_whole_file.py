"""Files appear whole or not at all, whichever command writes them."""

from __future__ import annotations

import ast
import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from log_tools import full_disk

from cratous.core.files import whole_file
from cratous.core.files.whole_file import PART, Workspace, replacing, write_atomically
from cratous.services.cli import main
from cratous.spec.errors import BadInput

ROOT = Path(__file__).resolve().parents[2]


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def test_a_file_is_written_and_replaced(tmp_path: Path) -> None:
    file = tmp_path / ("ä" * 20) / "f"
    file.parent.mkdir(parents=True)
    write_atomically(file, "één")
    assert file.read_text(encoding="utf-8") == "één"
    write_atomically(file, b"\x00\xff")
    assert file.read_bytes() == b"\x00\xff"
    assert names(file.parent) == ["f"]


def test_permissions_and_links_stay(tmp_path: Path) -> None:
    file = tmp_path / "f"
    old = os.umask(0o027)
    try:
        write_atomically(file, "a")
        assert file.stat().st_mode & 0o777 == 0o640, "a new one has those of the user"
    finally:
        os.umask(old)
    file.chmod(0o604)
    (tmp_path / "link").symlink_to("f")
    write_atomically(tmp_path / "link", "b")
    assert (tmp_path / "link").is_symlink()
    assert file.read_text() == "b"
    assert file.stat().st_mode & 0o777 == 0o604


def test_a_full_disk_keeps_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "f"
    file.write_text("good")
    with full_disk(1000), pytest.raises(BadInput, match="cannot be written") as caught:
        write_atomically(file, "x" * 5000)
    assert "greatest size" in caught.value.what
    assert caught.value.where == str(file)
    assert file.read_text() == "good"
    assert names(tmp_path) == ["f"]


@pytest.mark.parametrize("name", ["open", "fsync", "replace", "mkdir"])
def test_a_call_that_fails_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    file = tmp_path / "f"
    file.write_text("good")

    def full(*_arguments: object, **_named: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, name, full)
        with pytest.raises(BadInput, match="the disk is full"):
            write_atomically(file, "x")
    assert file.read_text() == "good"
    assert names(tmp_path) == ["f"]


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "file").write_text("f")
    for path in (tmp_path, tmp_path / "loop", tmp_path / "no" / "f", tmp_path / "file" / "f"):
        with pytest.raises(BadInput, match="cannot be written"):
            write_atomically(path, "x")
    assert names(tmp_path) == ["file", "loop"]


def test_devices_and_pipes_are_written_to_not_replaced(tmp_path: Path) -> None:
    write_atomically(Path("/dev/null"), "x")
    assert Path("/dev/null").is_char_device()
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE) as cat:
        write_atomically(pipe, "through")
        assert cat.communicate(timeout=60)[0] == b"through"
    assert pipe.is_fifo()
    assert names(tmp_path) == ["pipe"]


def test_what_a_killed_process_left_is_swept(tmp_path: Path) -> None:
    code = (
        "import os, signal; from pathlib import Path; from cratous.core.files.whole_file import replacing\n"
        f"with replacing(Path({str(tmp_path / 'f')!r})) as part:\n"
        "    part.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], timeout=120)
    assert done.returncode == -signal.SIGKILL
    assert [name.endswith(PART) for name in names(tmp_path)] == [True]
    (tmp_path / ".user.1-0a.cratous-part").mkdir()  # not of the form of ours
    (tmp_path / ".user.1-00000000.cratous-part").write_text("a file of that name")
    with replacing(tmp_path / "g") as part:  # the living one's stays
        part.write_text("g")
        write_atomically(tmp_path / "f", "f")
        assert part.exists()
    assert names(tmp_path) == [
        ".user.1-00000000.cratous-part", ".user.1-0a.cratous-part", "f", "g",
    ]  # fmt: skip


def test_processes_take_turns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(whole_file, "TURN_S", 0.2)
    with whole_file.in_turn(tmp_path):
        began = time.monotonic()
        with whole_file.in_turn(tmp_path):  # after a while it goes on: somebody may be stopped
            pass
        assert time.monotonic() - began >= 0.2
    space = Workspace(tmp_path, "x", PART)
    assert list(whole_file.dead(tmp_path, PART)) == []
    space.remove()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_signals_clean_up(tmp_path: Path, number: signal.Signals) -> None:
    """The usual code (128 and the number), and nothing is left of a run that has begun to fly."""
    mission = ROOT / "examples" / "crossing" / "mission.yaml"
    code = (
        "import signal, sys, time; from cratous.services.cli import job, main\n"
        # a test run under nohup or in the background hands its ignored signals on
        "if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:\n"
        "    signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"
        "if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:\n"
        "    signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def stay(mission, folder, settings, tell, **_gate):\n"
        "    (folder / 'report.json').write_text('half'); print('flying', flush=True)\n"
        "    time.sleep(60)\n"
        "import cratous.services.cli.run as run; run.run_mission = stay\n"
        f"sys.exit(main(['run', {str(mission)!r}, '--out', {str(tmp_path / 'out')!r}]))\n"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "flying\n"
    child.send_signal(number)
    _, said = child.communicate(timeout=120)
    assert child.returncode == 128 + number, said
    assert "cratous: stopped" in said
    assert names(tmp_path) == []


def test_signals_are_as_before_when_a_command_has_ended() -> None:
    before = [signal.getsignal(n) for n in (signal.SIGTERM, signal.SIGHUP)]
    assert main(["version"]) == 0
    assert [signal.getsignal(n) for n in (signal.SIGTERM, signal.SIGHUP)] == before


KEPT = {
    "core/readings/machine/compiled.py": "machine code, renamed when whole, in the private cache",
    "core/files/whole_file.py": "the helper itself",
    "core/kernel/sources.py": "hashes of code, renamed when whole, in the private cache",
    "core/ledger/records.py": "the ledger, renamed when whole; to change the file is to prove all anew",
    "core/ledger/tables.py": "tables of definitions, renamed when whole, in the private cache",
    "core/ledger/kept_keys.py": "keys of kernels, renamed when whole, in the private cache",
    "proofs/engine/cache.py": "solver answers, renamed when whole, in the private cache",
    "proofs/mutation/keys.py": "verdicts, renamed when whole, in the private cache",
    "proofs/ledger/proof_recall.py": "theorems, renamed when whole, in the private cache",
    "proofs/statements/relation_cache.py": "what statements relate, renamed when whole, in the private cache",
    "proofs/self_test/case.py": "packages of the self-test, in a temporary folder",
    "proofs/ledger/text_cache.py": "texts, renamed when whole, in the private cache",
    "services/startup/sample_missions.py": "a mission in a temporary folder",
    "services/startup/warm.py": "a mission in a temporary folder",
    "services/startup/gate_process.py": "a pipe to the parent process",
    "services/results/folder.py": "inside the hidden folder of a run",
    "services/logs/log.py": "inside the hidden folder of a run; renamed when whole",
    "services/logs/export.py": "inside `replacing`",
    "services/logs/store.py": "a log that grows: readable at any moment",
    "services/logs/sqlite_log.py": "opened for reading",
    "services/logs/uxas_log.py": "inside `replacing`",
    "services/logs/text_files.py": "a log that grows",
    "services/uxas/logs.py": "a log that grows",
    "services/cli/sim.py": "inside `replacing`",
    "services/daa/plot.py": "inside `replacing`",
    "docs/tools/geofence_pictures.py": "inside `replacing`",
    "docs/tools/ground_station_pictures.py": "inside `replacing`, and a copy for the editor in a folder of its own",
    "docs/tools/moving_tasks.py": "inside `replacing`",
    "docs/tools/pictures_well_clear.py": "into memory",
    "services/results/legacy_results.py": "opened for reading",
    "services/campaign/store.py": "results in SQLite, in transactions",
    "services/cli/campaign_flight.py": "a mission in a temporary folder",
    "services/cli/serve_flight.py": "what was commanded, beside the results in their hidden folder, renamed when whole",
    "services/processes/children.py": "what processes say, inside the hidden folder of a run",
    "services/uxas/diagram.py": "inside a hidden folder of this process, renamed when whole",
}
WRITES = {"write_text", "write_bytes", "savefig"}


def test_every_place_that_writes_is_known(root: Path) -> None:
    """A new one uses `write_atomically` or `replacing`, or is listed with its reason."""
    found = set()
    for part in ("core", "bridge", "services", "proofs", "docs", "spec"):
        for file in sorted((root / part).rglob("*.py")):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and _writes(node):
                    found.add(file.relative_to(root).as_posix())
    assert found == set(KEPT)


def _writes(call: ast.Call) -> bool:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    modes = [a.value for a in [*call.args, *(k.value for k in call.keywords)]
             if isinstance(a, ast.Constant)]  # fmt: skip
    opens = name == "open" and any(isinstance(m, str) and set(m) & set("wax+") for m in modes)
    connects = name == "connect" and "sqlite3" in ast.unparse(call.func)
    return name in WRITES or opens or connects


def test_a_full_disk_leaves_a_good_certificate(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from cratous.services.planning.assign_certificate import write

    file = tmp_path / "plan.json"
    write(file, {"format": "x"})
    before = file.read_text()
    with full_disk(2000), pytest.raises(BadInput, match="the certificate cannot be written"):
        write(file, {"format": "y" * 5000})
    assert file.read_text() == before
    assert json.loads(before) == {"format": "x"}
    assert names(tmp_path) == ["plan.json"]
