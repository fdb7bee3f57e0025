"""A process ends without the interpreter's teardown, and nothing that matters is left out."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cratous.services.cli.ending import end

HEAD = """
import atexit, sys, tempfile, threading, time
from cratous.services.cli.ending import end
class Last:
    def __del__(self): print("taken apart")
last = Last()
folder = tempfile.TemporaryDirectory(dir=sys.argv[1])
open(folder.name + "/file", "w").close()
atexit.register(print, "handler")
"""


def ended(words: str, place: Path, out: int | None = None) -> subprocess.CompletedProcess[str]:
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    return subprocess.run(
        [sys.executable, "-c", f"{HEAD}{words}", str(place)], text=True, check=False, timeout=60,
        env=buffered, stdout=subprocess.PIPE if out is None else out, stderr=subprocess.PIPE,
    )  # fmt: skip


def test_output_threads_handlers_and_temporary_folders_are_done(tmp_path: Path) -> None:
    words = (
        "threading.Thread(target=lambda: (time.sleep(0.2), print('thread'))).start()\n"
        "print('said'); print('told', file=sys.stderr); end(3)"
    )
    done = ended(words, tmp_path)
    assert (done.returncode, done.stdout) == (3, "said\nthread\nhandler\n")
    assert done.stderr == "told\n"
    assert [*tmp_path.iterdir()] == []


def test_the_interpreter_reports_output_that_cannot_be_written(tmp_path: Path) -> None:
    """As at any other end: exit code 120, and why."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = ended("del last; end(0)", tmp_path, write)
    finally:
        os.close(write)
    assert done.returncode == 120
    assert "BrokenPipeError" in done.stderr
    assert [*tmp_path.iterdir()] == []


def test_a_profiler_or_tracer_may_write_what_it_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "gettrace", lambda: len)
    with pytest.raises(SystemExit) as stop:
        end(5)
    assert stop.value.code == 5


@pytest.mark.parametrize(("words", "code"), [(["version"], 0), (["nothing"], 2), (["-h"], 0)])
def test_the_command_ends_so(words: list[str], code: int) -> None:
    import cratous.services.cli as cli

    script = (
        "import atexit, sys; import cratous.services.cli as cli\n"
        "class Last:\n    def __del__(self): print('taken apart')\n"
        f"last = Last(); sys.argv[1:] = {words!r}; cli.program()"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == code
    assert done.stdout + done.stderr
    assert "taken apart" not in done.stdout
    assert cli.main(words) == code
