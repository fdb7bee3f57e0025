"""A mission that is flown from the page's commands: over HTTP, without a browser."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from ground_station_tools import LIMIT_S, Served, ask, flying

from cratous.services.ground_station.pace import STEP_MS, Ended, Pace

ROOT = Path(__file__).resolve().parents[2]
CROSSING = Path("examples/crossing/mission.yaml")

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A flight that stands at its begin, for tests that all leave it there."""
    with flying(CROSSING, tmp_path_factory.mktemp("standing") / "live", ROOT) as served:
        assert served.until("paused", "failed", "lost")["state"] == "paused"
        yield served


@pytest.fixture
def live(tmp_path: Path) -> Iterator[Served]:
    with flying(CROSSING, tmp_path / "live", ROOT) as served:
        assert served.until("paused", "failed", "lost")["state"] == "paused"
        yield served


def test_its_results_are_the_bytes_of_cratous_run(live: Served, tmp_path: Path) -> None:
    """Held back, stepped, paused, judged in between: what is written is the same."""
    assert live.order(do="step").status == 200
    _flown(live, STEP_MS)
    assert live.order(do="rate", rate=50).status == 200
    assert live.order(do="play").status == 200
    _flown(live, 30_000)
    assert live.order(do="pause").status == 200
    live.until("paused")
    assert live.order(do="rate", rate=1000).status == 200
    assert live.order(do="play").status == 200
    status = live.until("ended", "failed", "lost")
    assert status["state"] == "ended"
    assert status["text"].startswith("HOLDS: results in ")
    done = subprocess.run(
        [sys.executable, "-m", "cratous", "run", str(CROSSING), "--quiet", "--out", tmp_path / "run"],
        cwd=ROOT, timeout=LIMIT_S, capture_output=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    ours, other = tmp_path / "live" / "crossing", tmp_path / "run" / "crossing"
    names = sorted(file.name for file in other.iterdir())
    assert names == sorted(file.name for file in ours.iterdir())
    assert {"log.sqlite", "report.json", "report.html"} <= set(names)
    for name in names:
        assert (ours / name).read_bytes() == (other / name).read_bytes(), name
    replay = ask(live.port, "/recording.json").data()
    assert "live" not in replay
    assert replay["verdicts"]["overall"] == "holds"
    # what was told on the way, put together, is what the log says
    told, tracks = _all(live), dict[str, list[list[float]]]()
    for update in told:
        for number, rows in update.get("tracks", {}).items():
            tracks.setdefault(number, []).extend(rows)
    heads = [u["heads"] for u in told if "heads" in u][-1]
    assert heads == {number: rows[-1] for number, rows in replay["tracks"].items()}
    for number, rows in replay["tracks"].items():
        assert rows in (tracks[number], [*tracks[number], heads[number]])
    events = [event for update in told for event in update.get("more", {}).get("events", ())]
    assert events == replay["events"]


def test_verdicts_so_far_say_when_and_are_unknown_unless_broken(live: Served) -> None:
    live.order(do="rate", rate=200)
    live.order(do="play")
    _flown(live, 100_000)
    live.order(do="pause")
    live.until("paused")
    until_s = time.monotonic() + LIMIT_S
    # it says so before it stands: of the instant at which it does come the last verdicts
    while (said := _verdicts(live)).get("so_far_ms") != _end_ms(live):
        assert time.monotonic() < until_s, said
        time.sleep(0.05)
    rows = {row["requirement"]: row for row in said["requirements"]}
    assert said["overall"] == "unknown"
    assert {row["verdict"] for row in rows.values()} == {"unknown"}
    assert 70 < rows["G2"]["margin"] < 71  # the least distance was at 99.3 s
    assert any(row["item"] and row["verdict"] == "holds" for row in said["details"])  # of the plan


def test_it_stands_until_it_is_told_to_fly_and_after_a_step(live: Served) -> None:
    before = live.told()["next"]
    time.sleep(0.5)
    assert _end_ms(live) == 0
    live.order(do="step")
    _flown(live, STEP_MS)
    assert _stands(live) == STEP_MS
    assert live.told()["next"] > before


def test_a_command_needs_the_token_of_the_address(standing: Served) -> None:
    body = b'{"do": "play"}'
    for token in ("", "x", standing.token[:-1], standing.token + "x"):
        got = standing.sent("a", body, X_Cratous_Token=token)
        assert got.status == 403
        assert "token" in got.data()["error"]
    assert standing.token not in ask(standing.port, "/").body.decode()
    assert standing.token not in ask(standing.port, "/recording.json").body.decode()
    assert standing.told()["status"]["state"] == "paused"


def test_a_command_comes_from_the_page_itself(standing: Served) -> None:
    body = b'{"do": "play"}'
    for origin in ("", "null", "http://evil.example", f"http://localhost:{standing.port}"):
        assert standing.sent("a", body, Origin=origin).status == 403
    assert standing.sent("a", body, Host="evil.example").status == 421
    assert standing.sent("a", body, Content_Type="text/plain").status == 415
    assert standing.sent("a", body, Content_Length="-1").status == 400
    assert standing.sent("a", body, Content_Length="1001").status == 413
    assert ask(standing.port, "/command").status == 404
    assert standing.told()["status"]["state"] == "paused"


@pytest.mark.parametrize(
    "body",
    [
        b"{", b"[]", b"1", b'{"do": "fall"}', b'{"do": "rate"}', b'{"do": "rate", "rate": 3}',
        b'{"do": "rate", "rate": "1"}', b"[" * 900, b"\xff", b'{"do": ["play"]}',
        b'{"do": "rate", "rate": [1]}', b'{"do": "rate", "rate": NaN}',
    ],
)  # fmt: skip
def test_what_is_no_command_is_refused_and_changes_nothing(standing: Served, body: bytes) -> None:
    got = standing.sent("a", body)
    assert got.status == 400
    assert got.data()["error"]
    assert standing.told()["status"]["state"] == "paused"


def test_a_second_page_is_told_and_may_take_the_command(live: Served) -> None:
    assert live.told(page="a")["who"] == "you"
    assert live.told(page="b")["who"] == "other"
    got = live.order("b", do="play")
    assert got.status == 409
    assert got.data()["error"] == "another page commands this flight"
    assert ask(live.port, "/live.json?from=0").data()["who"] == "watch"
    assert live.order("b", do="take").status == 200
    assert live.told(page="a")["who"] == "other"
    assert live.order("a", do="play").status == 409
    assert live.order("b", do="step").status == 200


@pytest.mark.parametrize("first", ["x", "-1", "9" * 10, "²"])
def test_an_update_that_is_no_number_is_refused(standing: Served, first: str) -> None:
    quoted = first.encode().decode("latin-1").replace("Â", "%C2").replace("\xb2", "%B2")
    assert ask(standing.port, f"/live.json?from={quoted}").status == 400


def test_a_flight_that_is_stopped_leaves_nothing(live: Served, tmp_path: Path) -> None:
    assert live.order(do="stop").status == 200
    assert "no results were written" in live.until("stopped", "lost")["text"]
    _gone(live)
    assert not (tmp_path / "live").exists()
    assert live.order(do="play").status == 409


def test_a_flight_whose_process_dies_is_lost(live: Served) -> None:
    (child,) = live.children()
    os.kill(child, signal.SIGKILL)
    status = live.until("lost", "stopped")
    assert status["state"] == "lost"
    assert "signal 9" in status["text"]
    assert ask(live.port, "/recording.json").status == 200  # what it told stays there


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_the_flight_ends_with_its_server(live: Served, tmp_path: Path, number: int) -> None:
    (child,) = live.children()
    live.process.send_signal(number)
    live.process.wait(LIMIT_S)
    _ended(child, LIMIT_S)
    assert not (tmp_path / "live").exists()


def test_a_paused_flight_ends_with_a_server_that_was_killed_after_a_command(
    live: Served, tmp_path: Path
) -> None:
    """The command is read when nobody is there any more to be told that it is done."""
    (child,) = live.children()
    live.until("paused")
    os.kill(child, signal.SIGSTOP)
    try:
        assert live.order(do="pause").status == 200
        live.process.kill()
        live.process.wait(LIMIT_S)
    finally:
        os.kill(child, signal.SIGCONT)
    _ended(child, LIMIT_S)
    assert not (tmp_path / "live").exists()
    assert live.process.stderr is not None
    assert live.process.stderr.read() == ""  # of the flight, too


def test_a_flight_that_is_to_end_waits_no_more() -> None:
    """Also where the signal that ends it was lost."""
    pace, ended = Pace(), threading.Event()

    def fly() -> None:
        with pytest.raises(Ended):
            pace.wait(1000, lambda: None)
        ended.set()

    thread = threading.Thread(target=fly, daemon=True)
    thread.start()
    assert not ended.wait(0.1)
    pace.end()
    assert ended.wait(LIMIT_S)
    with pytest.raises(Ended):
        pace.wait(0, lambda: None)


def test_a_bad_mission_is_told_with_file_and_place(tmp_path: Path) -> None:
    bad = tmp_path / "mission.yaml"
    bad.write_text((ROOT / CROSSING).read_text().replace("vehicles:", "vehicle:", 1))
    with flying(bad, tmp_path / "out") as served:
        assert served.until("failed", "lost")["state"] == "failed"
        got = ask(served.port, "/recording.json")
        assert got.status == 422
        assert "mission.yaml" in got.data()["where"]


def test_options_of_a_flight_need_a_mission(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cratous", "serve", str(tmp_path), "--no-daa"],
        capture_output=True, text=True, timeout=LIMIT_S,
    )  # fmt: skip
    assert done.returncode == 2
    assert "need a MISSION" in done.stderr


def test_a_pace_keeps_its_rate_and_does_not_catch_up() -> None:
    pace = Pace()
    pace.set_rate(10)
    pace.play()
    begin_s = time.monotonic()
    for now_ms in range(0, 2001, 50):
        pace.wait(now_ms, pytest.fail)
    assert time.monotonic() - begin_s > 0.19
    time.sleep(0.3)  # the flight was slow: 3 s at this rate
    begin_s = time.monotonic()
    for now_ms in range(2050, 3051, 50):
        pace.wait(now_ms, pytest.fail)
    assert time.monotonic() - begin_s > 0.09


def test_a_pace_stands_when_paused_and_says_so_once() -> None:
    pace, stood, flown = Pace(), [], threading.Event()

    def fly() -> None:
        pace.wait(50, lambda: stood.append(50))
        flown.set()

    thread = threading.Thread(target=fly)
    thread.start()
    assert not flown.wait(0.2)
    pace.set_rate(0.25)
    assert not flown.wait(0.2)
    assert stood == [50]
    pace.play()
    assert flown.wait(LIMIT_S)
    thread.join()
    pace.step()
    begin_s = time.monotonic()
    pace.wait(50 + STEP_MS, pytest.fail)
    assert time.monotonic() - begin_s < 2  # a step is as fast as it goes: at its rate it takes 4 s


def _all(live: Served) -> list[dict[str, dict[str, list[object]]]]:
    found, told = list[dict[str, dict[str, list[object]]]](), {"next": 0, "more": True}
    while told["more"]:
        told = live.told(told["next"])
        found += told["updates"]
    return found


def _end_ms(live: Served) -> int:
    return max((u["set"].get("end_ms", 0) for u in _all(live) if "set" in u), default=0)


def _verdicts(live: Served) -> dict[str, object]:
    return next((u["set"]["verdicts"] for u in reversed(_all(live)) if "verdicts" in u["set"]), {})


def _flown(live: Served, time_ms: int) -> None:
    until_s = time.monotonic() + LIMIT_S
    while _end_ms(live) < time_ms:
        assert time.monotonic() < until_s, live.told()["status"]
        time.sleep(0.02)


def _stands(live: Served) -> int:
    """When it stands: the time does not move any more."""
    live.until("paused")
    before = -1
    while before != (now := _end_ms(live)):
        before = now
        time.sleep(0.4)
    return now


def _ended(process: int, limit_s: float) -> None:
    until_s, command = time.monotonic() + limit_s, Path(f"/proc/{process}/cmdline")
    with suppress(FileNotFoundError, ProcessLookupError):
        while command.read_bytes():  # of one that nobody has waited for there is none
            if time.monotonic() > until_s:
                os.kill(process, signal.SIGKILL)
                pytest.fail("the flight's process is still there")
            time.sleep(0.05)


def _gone(live: Served) -> None:
    until_s = time.monotonic() + LIMIT_S
    while live.children():
        assert time.monotonic() < until_s
        time.sleep(0.05)
