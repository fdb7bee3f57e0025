"""The copy of a flight's process that is asked for the verdicts so far: what it holds, its failure, its end."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cratous.services.cli import serve_flight
from cratous.services.ground_station import live_flight
from cratous.services.ground_station.live_flight import LiveFlight, forward
from cratous.services.loading import load
from cratous.spec.mission.guarantees import Verdict

CROSSING = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"
REPORT = {"verdict": "holds", "requirements": [], "constraints": []}


class Monitor:
    """Gives no verdicts, after it has done something."""

    def __init__(self, act: Callable[[], object]) -> None:
        self._act = act

    def verdicts(self) -> list[Verdict]:
        self._act()
        return []


class Judged:
    """A flight that stands at 0 s, whose monitor is given; sent: all that was sent, in its order."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []
        read, self.write = os.pipe()
        self.live = LiveFlight(load(CROSSING), self.sent.append, self.write)
        self._forwarded = forward(read, self.sent.append)

    def ask(self, act: Callable[[], object]) -> None:
        self.live.planned([], Monitor(act))
        self.live._standing()

    def close(self) -> None:
        self.live.end_judge()
        os.close(self.write)
        self._forwarded.join()

    def verdicts(self) -> list[dict[str, Any]]:
        return [u["set"]["verdicts"] for u in self.sent if "verdicts" in u.get("set", {})]


@pytest.fixture
def judged() -> Iterator[Judged]:
    yield (one := Judged())
    if one.live._judge:
        one.close()


def _fail() -> None:
    raise RuntimeError("the monitor is broken")


def test_it_holds_no_descriptor_but_its_pipe(judged: Judged, tmp_path: Path) -> None:
    """Neither the ends of other pipes nor a lock of the flight outlive the flight in it."""
    told = tmp_path / "descriptors"

    def tell() -> None:
        told.write_text(json.dumps({n: os.readlink(f"/dev/fd/{n}") for n in os.listdir("/dev/fd")
                                    if os.path.lexists(f"/dev/fd/{n}")}))  # fmt: skip

    read, write = os.pipe()
    with (tmp_path / "lock").open("w"):
        judged.ask(tell)
        assert judged.live._reap(wait=True)
    os.close(read)
    os.close(write)
    found = {int(number): name for number, name in json.loads(told.read_text()).items()}
    assert found[0] == os.devnull
    assert {n for n in found if n > 2} == {judged.write}
    judged.close()
    assert [said["so_far_ms"] for said in judged.verdicts()] == [0]


@pytest.mark.parametrize(
    ("act", "how"), [(_fail, "exit code 1"), (lambda: os.kill(os.getpid(), 9), "signal 9")]
)
def test_its_failure_takes_the_place_of_the_verdicts(
    judged: Judged, act: Callable[[], object], how: str, capfd: pytest.CaptureFixture[str]
) -> None:
    judged.ask(act)
    assert judged.live._reap(wait=True)
    judged.close()
    (said,) = judged.verdicts()
    assert said["why_none"].startswith("at 0.0 s the monitor could not be asked")
    assert how in said["why_none"]


def test_a_line_that_was_cut_off_does_not_hide_the_next() -> None:
    judged = Judged()
    os.write(judged.write, b'\n{"set": {"verdicts": {"overall": "\xc3')
    judged.live._write({"set": {"verdicts": {"overall": "unknown"}}})
    judged.close()
    assert judged.verdicts() == [{"overall": "unknown"}]


class Flight:
    """`serve_flight` with a flight of our own in the place of the pipeline's; sent: all that it sends."""

    def __init__(self, patch: pytest.MonkeyPatch, out: Path) -> None:
        self.sent: list[dict[str, Any]] = []
        self._patch, self._out = patch, out
        patch.setattr(serve_flight, "_commands", lambda live: None)

    def fly(self, run: Callable[[LiveFlight], dict[str, Any]]) -> None:
        self._patch.setattr(serve_flight, "run_mission", lambda *given: run(given[-1]))
        asked = {"path": str(CROSSING), "seed": 0, "options": [], "out": str(self._out), "daa": True,
                 "allow_unproved": True, "command": "", "text": CROSSING.read_text(encoding="utf-8")}  # fmt: skip
        serve_flight._fly(asked, self.sent.append, lambda *_, **__: None)


@pytest.fixture
def flight(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Flight:
    return Flight(monkeypatch, tmp_path / "out")


def test_no_verdicts_so_far_come_after_those_of_the_whole_flight(
    flight: Flight, monkeypatch: pytest.MonkeyPatch
) -> None:
    def slow_forward(source: int, send: live_flight.Send) -> Any:
        return forward(source, lambda update: (time.sleep(0.3), send(update))[1])

    def run(live: LiveFlight) -> dict[str, Any]:
        live.planned([], Monitor(lambda: None))
        live._standing()
        live._reap(wait=True)  # its verdicts are in the pipe, and not sent yet
        return REPORT

    monkeypatch.setattr(serve_flight, "forward", slow_forward)
    flight.fly(run)
    said = [u["set"]["verdicts"] for u in flight.sent if "verdicts" in u.get("set", {})]
    assert [one["overall"] for one in said] == ["unknown", "holds"]


def test_it_ends_with_a_flight_that_fails(flight: Flight) -> None:
    judges: list[int] = []

    def run(live: LiveFlight) -> dict[str, Any]:
        live.planned([], Monitor(lambda: time.sleep(60)))
        live._standing()
        judges.append(live._judge)
        raise BrokenPipeError

    before_s = time.monotonic()
    with pytest.raises(BrokenPipeError):
        flight.fly(run)
    assert time.monotonic() - before_s < 30
    with pytest.raises(ProcessLookupError):
        os.kill(judges[0], 0)
