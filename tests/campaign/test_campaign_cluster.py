"""A real scheduler and real workers, processes on loopback, one of which is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from campaign_child import FUNCTION, written
from campaign_tools import stored
from cluster_tools import cluster

from cratous.services.campaign.campaign import Conduct, Course
from cratous.services.campaign.definition import load_campaign
from cratous.services.campaign.engine import engine
from cratous.services.campaign.identity import version_digest
from cratous.services.campaign.store import Store
from cratous.services.campaign.summary import build, text_of
from cratous.spec.errors import BadInput, Refused

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow
CLIENT = """
import sys
from pathlib import Path
sys.path[:0] = [sys.argv[1], str(Path(sys.argv[1]).parent / "tools")]
import test_campaign_cluster as t
with t.engine(1, sys.argv[4]) as made:
    t.conduct(Path(sys.argv[2]), Path(sys.argv[3]), made)
"""
VARIED = "seeds: [1, 10]\nvary: [{item: 'vehicles[0].speed_m_s', range: [10, 40]}]\n"


@pytest.fixture(autouse=True)
def _child(monkeypatch: pytest.MonkeyPatch, root: Path) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{root / 'tests' / 'children'}:{root / 'src'}")


def conduct(file: Path, folder: Path, engine: Any, watch: Any = None) -> tuple[str, Course]:
    campaign = load_campaign(file, None, ())
    with Store(folder) as store:
        one = Conduct(campaign, store, FUNCTION, version_digest(), False)
        course = Course(10)
        one.fly(engine, course, lambda _text: watch(course) if watch else None)
        return text_of(build(campaign, list(one.rows()), "v")), course


def test_a_killed_worker_costs_an_attempt_and_no_byte(tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    file = written(tmp_path, {"plain": f"hang {mark}"}, VARIED)
    mark.write_text("alone no run hangs")
    with engine(1, None) as alone:
        expected, _ = conduct(file, tmp_path / "one", alone)
    mark.unlink()
    killed: list[int] = []
    with cluster(2) as (address, processes), engine(1, address) as made:

        def watch(course: Course) -> None:
            # the hanging attempt has been told by now: others were flown since
            if course.flown >= 2 and not killed and (worker := mark.read_text().strip()):
                killed.append(int(worker))
                assert killed[0] in [one.pid for one in processes[1:]]
                os.kill(killed[0], signal.SIGKILL)

        text, course = conduct(file, tmp_path / "two", made, watch)
    assert killed
    assert text == expected
    assert course.flown == 10
    assert course.lost >= 1, "the attempt of the killed worker is told"


@pytest.mark.long
def test_a_scheduler_that_is_gone_and_begun_again_changes_no_byte(tmp_path: Path) -> None:
    file = written(tmp_path, {"plain": "sleep"}, VARIED)
    killed: list[int] = []
    with cluster(1) as (address, processes):

        def watch(course: Course) -> None:
            if course.flown >= 2 and not killed:
                killed.append(processes[0].pid)
                os.kill(processes[0].pid, signal.SIGKILL)

        def campaign() -> None:
            with engine(1, address) as made:
                conduct(file, tmp_path / "out", made, watch)

        with pytest.raises(BadInput, match="scheduler is gone"):
            campaign()
    port = int(address.rpartition(":")[2])
    with cluster(1, port=port) as (again, _), engine(1, again) as made:
        assert again == address
        text, course = conduct(file, tmp_path / "out", made)
    with engine(1, None) as alone:
        expected, _ = conduct(file, tmp_path / "new", alone)
    assert 2 <= course.stored < 10
    assert course.stored + course.flown == 10
    assert text == expected


@pytest.mark.long
def test_a_client_that_is_killed_comes_back_to_the_same_cluster(tmp_path: Path) -> None:
    file, folder = written(tmp_path, {"plain": "sleep"}, VARIED), tmp_path / "out"
    with cluster(2) as (address, _):
        command = [sys.executable, "-c", CLIENT, str(Path(__file__).parent), str(file), str(folder)]
        client = subprocess.Popen([*command, address])
        until = time.monotonic() + 120
        while stored(folder) < 3 and time.monotonic() < until:
            time.sleep(0.05)
        client.kill()
        client.wait()
        kept = stored(folder, beside=False)
        with engine(1, address) as made:
            text, course = conduct(file, folder, made)
    with engine(1, None) as alone:
        expected, _ = conduct(file, tmp_path / "new", alone)
    assert 2 <= kept < 10
    assert (course.stored, course.flown) == (kept, 10 - kept)
    assert text == expected


def test_a_worker_of_another_version_flies_nothing(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": f"die {tmp_path}/flown"}, ""), None, ())
    with cluster(1) as (address, _), engine(1, address) as made, Store(tmp_path / "out") as store:
        one = Conduct(campaign, store, FUNCTION, "0" * 64, False)
        with pytest.raises(Refused, match=r"a worker of tcp://.* has another version"):
            one.fly(made, Course(1), lambda _text: None)
        assert all(store.result(run.id) is None for run in one.runs())
    assert not (tmp_path / "flown").exists()


def test_no_scheduler_is_bad_input() -> None:
    with pytest.raises(BadInput, match="no scheduler"), engine(1, "nonsense://x"):
        pass
