"""`kill -9` of a campaign and all its processes: what was stored is there, and nothing stays behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from campaign_child import FUNCTION, written
from campaign_tools import stored

from cratous.services.campaign.campaign import Conduct, Course
from cratous.services.campaign.definition import load_campaign
from cratous.services.campaign.engine import here
from cratous.services.campaign.identity import version_digest
from cratous.services.campaign.store import Store
from cratous.services.campaign.summary import build, text_of

VARIED = "seeds: [1, 12]\nvary: [{item: 'vehicles[0].speed_m_s', range: [10, 40]}]\n"
PROGRAM = """
import sys
from pathlib import Path
sys.path[:0] = [sys.argv[3], str(Path(sys.argv[3]).parent / "tools")]
import test_campaign_killed as t
print(t.conduct(Path(sys.argv[1]), Path(sys.argv[2])))
"""


def conduct(file: Path, folder: Path) -> tuple[int, int, str]:
    """Runs that were stored, runs that were flown, campaign.json."""
    campaign = load_campaign(file, None, ())
    with Store(folder) as store, here() as engine:
        one = Conduct(campaign, store, FUNCTION, version_digest(), False)
        course = Course(12)
        one.fly(engine, course, lambda _text: None)
        text = text_of(build(campaign, list(one.rows()), "v"))
    return course.stored, course.flown, text


def children(pid: int) -> list[int]:
    text = Path(f"/proc/{pid}/task/{pid}/children").read_text()
    return [int(part) for part in text.split()]


def gone(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="no /proc")
def test_it_goes_on_after_kill_9(
    tmp_path: Path, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{root / 'tests' / 'children'}:{root / 'src'}")
    file, folder = written(tmp_path, {"plain": "sleep"}, VARIED), tmp_path / "out"
    command = [sys.executable, "-c", PROGRAM, str(file), str(folder), str(Path(__file__).parent)]
    first = subprocess.Popen(command, start_new_session=True)
    until = time.monotonic() + 120
    # the newest may still be being written, and is then none
    while stored(folder) < 4 and time.monotonic() < until:
        time.sleep(0.05)
    fliers = children(first.pid)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    while not all(gone(pid) for pid in fliers) and time.monotonic() < until:
        time.sleep(0.05)
    assert fliers
    assert all(gone(pid) for pid in fliers), "what flew ends by itself"
    kept = stored(folder, beside=False)
    assert 3 <= kept < 12
    again, flown, text = conduct(file, folder)
    assert (again, flown) == (kept, 12 - kept)
    assert text == conduct(file, tmp_path / "whole")[2]
