"""A real scheduler and real workers, processes on loopback, one of which is killed."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import pytest
from campaign_child import FUNCTION, written
from cluster_tools import cluster

from cratous.services.campaign.campaign import Conduct, Course
from cratous.services.campaign.definition import load_campaign
from cratous.services.campaign.engine import engine
from cratous.services.campaign.identity import version_digest
from cratous.services.campaign.store import Store
from cratous.services.campaign.summary import build, text_of
from cratous.spec.errors import BadInput

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow
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


def _flies(worker: int) -> bool:
    """Whether a worker has begun an attempt: then there is a process that flies."""
    threads = Path(f"/proc/{worker}/task").iterdir()
    return any((thread / "children").read_text() for thread in threads)


def test_a_killed_worker_costs_an_attempt_and_no_byte(tmp_path: Path) -> None:
    file = written(tmp_path, {"plain": "sleep"}, VARIED)
    with engine(1, None) as alone:
        expected, _ = conduct(file, tmp_path / "one", alone)
    killed: list[int] = []
    with cluster(2) as (address, processes), engine(1, address) as made:

        def watch(course: Course) -> None:
            if course.flown >= 2 and not killed and _flies(processes[1].pid):
                killed.append(processes[1].pid)
                os.kill(processes[1].pid, signal.SIGKILL)

        text, course = conduct(file, tmp_path / "two", made, watch)
    assert killed
    assert text == expected
    assert course.flown == 10
    assert course.lost >= 1, "the attempt of the killed worker is told"


@pytest.mark.long
def test_the_scheduler_gone_leaves_what_is_stored(tmp_path: Path) -> None:
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
    with engine(1, None) as alone:
        text, course = conduct(file, tmp_path / "out", alone)
        expected, _ = conduct(file, tmp_path / "new", alone)
    assert 2 <= course.stored < 10
    assert course.stored + course.flown == 10
    assert text == expected


def test_no_scheduler_is_bad_input() -> None:
    with pytest.raises(BadInput, match="no scheduler"), engine(1, "nonsense://x"):
        pass
