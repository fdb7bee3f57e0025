"""What the page draws and lays out anew while it plays, and what it leaves as it stands."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import Page, playing

pytestmark = pytest.mark.slow
COUNT = """(() => {
  window.drawn = {}; window.frames = 0; window.since = performance.now();
  const clear = CanvasRenderingContext2D.prototype.clearRect, ask = window.requestAnimationFrame.bind(window);
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    const name = this.canvas.id || this.canvas.className;
    window.drawn[name] = (window.drawn[name] ?? 0) + 1;
    clear.apply(this, box);
  };
  window.requestAnimationFrame = act => ask(now => { window.frames++; act(now); });
})()"""
COUNTED = "[(performance.now() - window.since) / 1000, window.frames, window.drawn.drawing ?? 0, window.drawn.altitude ?? 0]"


@pytest.fixture
def page(crossing: Path, tmp_path: Path) -> Iterator[Page]:
    with playing(crossing, tmp_path, 2) as page:
        yield page


def test_a_frame_in_which_nothing_moves_to_be_seen_draws_nothing(page: Page) -> None:
    page.value(COUNT)
    page.click("#play")
    time.sleep(3)
    page.until("window.frames > 20")
    passed_s, frames, maps, charts = page.value(COUNTED)
    # aircraft move 2 pixels a second: a quarter of one takes an eighth of a second; and all is drawn five times a
    # second, or at each frame where there are fewer
    least = min(2 * passed_s, frames - 2)
    assert least < maps < 14 * passed_s + 4
    assert least < charts < 14 * passed_s + 4


def test_what_moves_by_pixels_is_drawn_at_each_frame(page: Page) -> None:
    page.value("location.hash = '#t=2&rate=20&map=-1500,0,0.5'")
    page.until("document.getElementById('rate').value === '20'")
    page.value(COUNT)
    page.click("#play")
    page.until("window.frames > 14")
    _, frames, maps, _ = page.value(COUNTED)
    assert maps >= frames - 2 > 10


def test_a_row_that_is_the_same_stays_and_one_that_is_not_says_what_is_new(page: Page) -> None:
    cells = "document.querySelector('#aircraft tr[data-aircraft=\"2\"]')"
    told = f"{cells}.nextElementSibling"
    page.value(f"[window.row, window.told] = [{cells}, {told}], 1")
    page.key("ArrowRight")
    assert page.text("at") == "3.0 s"
    assert page.value(f"window.row === {cells} && window.told === {told}")
    assert page.value("window.told.textContent.startsWith('authority UxAS')")
    page.key("n")
    assert page.value("window.told.isConnected && window.told.textContent").startswith(
        "authority ICAROUS since 21.5 s"
    )
    page.click("#aircraft tr[data-aircraft='2']")
    assert page.value(f"{cells}.className") == "picked"
    page.key("u")
    assert "ft" in page.value(f"{cells}.textContent")


def test_a_chart_has_the_extremes_of_what_is_nearer_than_half_a_pixel(page: Page) -> None:
    page.value(
        "import('/altitude.js').then(one => { window.seen = (track, ms) => [...one.seen(track, ms)].map(([row, on]) => [row[0], row[3], on]); })"
    )
    page.until("window.seen")
    track = [[1000 * k, 0, 0, 300 + (k == 17) * 50 - (k == 12) * 40, 0] for k in range(100)]
    track += [[200_000, 0, 0, 310, 0]]  # not seen for long before
    found = page.value(f"window.seen({track}, 10000)")
    assert found[:4] == [[0, 300, False], [9000, 300, True], [10000, 300, True], [12000, 260, True]]
    assert [17000, 350, True] in found
    assert found[-1] == [200_000, 310, False]
    assert len(found) < 30
    assert page.value(f"window.seen({track}, 500).length") == len(track), "all where there is room"


def test_the_margins_and_the_scale_have_the_units_of_the_page(page: Page) -> None:
    assert "70.54\u00a0m" in page.text("verdicts")
    page.key("u")
    assert "231.4\u00a0ft" in page.text("verdicts")
    assert "492 ft across" in page.text("pairs-note")
    page.key("u")
    assert "70.54\u00a0m" in page.text("verdicts")
