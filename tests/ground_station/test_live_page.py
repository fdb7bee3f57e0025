"""A mission that is flown from the page, in a real browser."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import Page, browsing
from ground_station_tools import Served, flying

ROOT = Path(__file__).resolve().parents[2]
CROSSING = Path("examples/crossing/mission.yaml")
STATE = "document.getElementById('live-state')?.textContent"
NEWEST_MS = "Number(document.getElementById('slider').max)"
pytestmark = pytest.mark.slow


@pytest.fixture
def live(tmp_path: Path) -> Iterator[Served]:
    with flying(CROSSING, tmp_path / "live", ROOT) as served:
        yield served


@pytest.fixture
def page(live: Served, tmp_path: Path) -> Iterator[Page]:
    with browsing(tmp_path / "profile") as page:
        page.go(live.url)
        page.until(f"{STATE} === 'paused' && !document.getElementById('fly').disabled")
        yield page
        # nothing was refused by the content security policy, no script failed
        assert [one for one in page.logged if "ERR_CONNECTION" not in str(one)] == []


def _speed(page: Page, rate: int) -> None:
    page.value(
        f"(s => {{ s.value = {rate}; s.dispatchEvent(new Event('change')); }})"
        "(document.getElementById('live-rate'))"
    )


def test_a_mission_is_flown_paused_stepped_and_its_results_are_replayed(page: Page) -> None:
    assert page.text("live-who") == "This page commands the flight."
    page.until("document.getElementById('aircraft').textContent.includes('authority UxAS')")
    page.click("#fly-step")
    page.until(f"{NEWEST_MS} === 1000")
    _speed(page, 50)
    page.value("document.activeElement.blur()")  # a button that has the focus takes the key itself
    page.key(" ")
    page.until(f"{STATE} === 'flying' && {NEWEST_MS} > 40000")
    page.click("#fly")
    page.until(f"{STATE} === 'paused'")
    page.until("document.getElementById('verdicts-at').textContent.startsWith('so far, at ')")
    assert page.text("overall") == "so far unknown"
    assert page.text("source") == "flown now"
    page.key("p")  # looking back does not move the flight
    page.key("p")
    assert page.text("clock").startswith("00:00:21.5 of")
    assert "ICAROUS since 21.5 s" in page.text("aircraft")
    page.click("#now")
    assert page.value(f"document.getElementById('slider').value / 1 === {NEWEST_MS}")
    _speed(page, 1000)
    page.click("#fly")
    page.until(f"{STATE} === 'ended'")
    page.until("document.getElementById('overall').textContent === 'holds'")
    assert page.text("live-text").startswith("HOLDS: results in ")
    assert page.text("source") == "flown to its end"
    page.click("#results")
    page.until(
        "document.getElementById('live')?.hidden && document.getElementById('play')?.hidden === false"
    )
    page.until("document.getElementById('overall').textContent === 'holds'")
    assert page.text("source").startswith("log.sqlite")


def test_stopping_asks_first(page: Page, live: Served, tmp_path: Path) -> None:
    page.key(" ")
    page.until(f"{STATE} === 'flying'")
    page.click("#stop")
    page.until("document.getElementById('confirm-stop').open")
    page.click("#stop-not")
    page.until("!document.getElementById('confirm-stop').open")
    assert live.told()["status"]["state"] == "flying"
    page.click("#stop")
    page.click("#stop-yes")
    page.until(f"{STATE} === 'stopped'")
    assert "no results were written" in page.text("live-text")
    assert page.text("source") == "stopped before its end"
    assert page.value("document.getElementById('fly').disabled")
    assert not (tmp_path / "live").exists()
    page.go("about:blank")
    page.go(live.url)  # also to a page that is opened later
    page.until("document.getElementById('source')?.textContent === 'stopped before its end'")


def test_where_the_monitor_could_not_be_asked_no_older_verdicts_stand(page: Page) -> None:
    page.until("document.getElementById('overall').textContent === 'so far unknown'")
    page.click("#stop")  # nothing new comes any more
    page.click("#stop-yes")
    page.until(f"{STATE} === 'stopped'")
    assert page.value("document.querySelectorAll('#verdicts tr').length") > 5
    page.value(
        "import('/panels.js').then(panels => "
        "panels.verdicts({ verdicts: { why_none: 'its process failed' } }))"
    )
    page.until("document.getElementById('verdicts-note').textContent.startsWith('Not judged')")
    assert page.text("overall") == page.text("verdicts-at") == page.text("verdicts") == ""


def test_a_flight_that_is_lost_is_said(page: Page, live: Served) -> None:
    page.key(" ")
    page.until(f"{NEWEST_MS} > 500")
    (child,) = live.children()
    os.kill(child, signal.SIGKILL)
    page.until(f"{STATE} === 'lost'")
    assert "ended without a word (signal 9)" in page.text("live-text")
    assert page.text("source") == "lost before its end"
    assert page.value("document.getElementById('fly').disabled")


def test_a_server_that_is_lost_is_said(page: Page, live: Served) -> None:
    live.process.kill()
    page.until(f"{STATE} === 'server lost'")
    assert "The server does not answer" in page.text("live-text")
    assert page.text("source") == "whether it is still flown is unknown"


def test_a_second_page_is_told_takes_over_and_the_first_is_told(
    page: Page, live: Served, tmp_path: Path
) -> None:
    with browsing(tmp_path / "other") as other:
        other.go(live.url)
        other.until("document.getElementById('live-who')?.textContent.startsWith('Another page')")
        assert other.value("document.getElementById('fly').disabled")
        other.click("#take")
        other.until("document.getElementById('live-who').textContent.startsWith('This page c')")
        page.until("document.getElementById('live-who').textContent.startsWith('Another page')")
        other.go(live.url.partition("?")[0])
        other.until("document.getElementById('live-who')?.textContent.startsWith('This page w')")
        assert other.value("document.getElementById('stop').disabled")
