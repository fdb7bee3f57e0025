"""The page as it is used: keys, buttons and clicks in a real browser."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import Page, playing

pytestmark = pytest.mark.slow


@pytest.fixture
def page(crossing: Path, tmp_path: Path) -> Iterator[Page]:
    with playing(crossing, tmp_path, 0) as page:
        yield page


def _time_s(page: Page) -> float:
    return float(page.value("document.getElementById('slider').value")) / 1000


def test_keys_jump_from_event_to_event_and_the_address_follows(page: Page) -> None:
    page.key("n")
    assert page.text("clock").startswith("00:00:21.5 of")
    assert "ICAROUS since 21.5 s" in page.text("aircraft")
    assert page.value("location.hash").startswith("#t=21.5&rate=1")
    page.key("n")
    assert page.text("clock").startswith("00:00:34.5 of")
    page.key("p")
    page.key("ArrowRight")
    assert page.text("clock").startswith("00:00:22.5 of")
    page.key("End")
    assert page.text("clock").startswith("00:03:40.8 of")
    page.key("Home")
    assert page.text("clock").startswith("00:00:00.0 of")


PIXELS = """(() => { const map = document.querySelector('#map .drawing');
  return Array.from(map.getContext('2d').getImageData(0, 0, map.width, map.height).data); })()"""


def test_the_map_shows_an_instant_alike_whatever_was_shown_before(page: Page) -> None:
    page.key("n")
    early = page.value(PIXELS)
    page.key("n")
    page.key("n")
    late = page.value(PIXELS)
    page.key("p")
    page.key("p")
    again = page.value(PIXELS)
    # pieces that are drawn one by one meet a little otherwise than those drawn at once
    parted = [
        sum(abs(a - b) > 40 for a, b in zip(early, one, strict=True)) for one in (again, late)
    ]
    assert parted[0] < 40
    assert parted[1] > 1000


def test_it_plays_at_its_rate_stops_at_the_end_and_pauses(page: Page) -> None:
    for _ in range(6):
        page.key("]")
    assert page.value("document.getElementById('rate').value") == "100"
    page.value(
        "window.said = []; new MutationObserver(() => window.said.push(document.getElementById('play').textContent))"
        ".observe(document.getElementById('play'), { childList: true, characterData: true, subtree: true })"
    )
    page.key(" ")
    page.until("window.said.includes('Pause')")  # it may be at the end by now
    page.until("Number(document.getElementById('slider').value) > 20000")
    page.click("#play")
    page.until("document.getElementById('play').textContent === 'Play'")
    stood = _time_s(page)
    assert 20 < stood <= 220.75
    time.sleep(0.3)
    assert _time_s(page) == stood
    page.key("End")
    page.key("ArrowLeft")
    page.key(" ")
    page.until("document.getElementById('play').textContent === 'Play'")
    assert page.text("clock").startswith("00:03:40.8 of 00:03:40.8")


def test_clicks_go_to_events_margins_and_the_chart_and_pick_an_aircraft(page: Page) -> None:
    page.click("#events li:nth-child(7) button")
    assert page.value("document.querySelector('#events .now').textContent").startswith("34.5 s")
    assert "authority UxAS" in page.text("aircraft")
    page.click("#verdicts .jump")
    assert page.text("clock").startswith("00:01:39.3 of")  # where the margin of G2 is least
    page.click("#altitude")
    assert 90 < _time_s(page) < 115
    page.click("#aircraft tr[data-aircraft='2']")
    assert "aircraft=2" in page.value("location.hash")
    page.key("u")
    assert "ft" in page.text("aircraft")
    page.key("d")
    assert page.value("document.documentElement.className") == "dark"
    page.key("+")
    page.until("location.hash.includes('map=')")
    page.key("f")
    page.until("!location.hash.includes('map=')")


def test_a_verdict_leads_to_its_kernel_theorem_solvers_and_mutants(
    page: Page, crossing: Path
) -> None:
    row = "[...document.querySelectorAll('#verdicts tr')].find(one => one.textContent.includes({}))"
    part = row.format("'well clear of 1 and 2'")
    page.value(f"{part}.querySelector('td:last-child button').click()")
    told = " ".join(page.text("proofs").split())
    report = json.loads((crossing / "report.json").read_text(encoding="utf-8"))
    (name,) = {
        name
        for one in report["constraints"]
        for name in one["kernels"]
        if one["item"] == "well clear of 1 and 2"
    }
    (short,) = {name.rpartition(".")[2]}
    assert f"Kernel {short}: " in told
    (theorem, *_) = report["proofs"]["kernels"][name]["against"]
    assert report["proofs"]["theorems"][theorem]["sentence"] in told
    assert f"{report['proofs']['solver']}: proved, " in told
    assert "confirmed" in told
    assert "mutants on record" in told
    assert f"Definition {report['proofs']['kernels'][name]['definition']} in spec/" in told
    # lemmas are made when they are asked for
    lemmas = "document.querySelector('#proofs .lemmas')"
    page.value(f"{lemmas}.open = true")
    page.until(f"{lemmas}.querySelector('.theorem')?.textContent.startsWith('Lemma ')")
    # keys of the page behind do nothing
    page.key("n")
    assert page.text("clock").startswith("00:00:00.0 of")
    page.click("#proofs button")
    assert not page.value("document.getElementById('proofs').open")
    page.value(row.format("'G1 '") + ".querySelector('td:last-child button').click()")
    parts = sum(one["requirement"] == "G1" for one in report["constraints"])
    assert page.value("document.querySelectorAll('#proofs-parts > details').length") == parts


def test_the_map_draws_the_takeover_in_its_colour(page: Page) -> None:
    """Pixels of the colour of ICAROUS: none before the takeover, a trail and a ring in it."""
    count = """(() => {
        const map = document.querySelector('#map .drawing'), pen = map.getContext('2d');
        const pixels = pen.getImageData(0, 0, map.width, map.height).data;
        let found = 0;
        for (let k = 0; k < pixels.length; k += 4)
            found += pixels[k] === 0xc9 && pixels[k + 1] === 0x44 && pixels[k + 2] === 0;
        return found;
    })()"""
    assert page.value(count) == 0
    page.value("location.hash = '#t=34&theme=light'")
    page.until("document.getElementById('clock').textContent.startsWith('00:00:34.0')")
    assert page.value(count) > 200


def test_of_a_lost_vehicle_it_is_not_said_that_uxas_commands_it(
    popup: Path, tmp_path: Path
) -> None:
    second = "document.querySelectorAll(\"#aircraft tr[data-aircraft='2']\")[1].textContent"
    with playing(popup, tmp_path, 59.9) as page:
        assert page.value(second).startswith("authority UxAS")
        page.value("location.hash = '#t=60'")
        page.until("document.getElementById('clock').textContent.startsWith('00:01:00.0')")
        assert page.value(second).startswith("authority lost since 60.0 s: it takes no part")
        assert "authority UxAS" in page.text("aircraft")  # vehicle 1 flies on
