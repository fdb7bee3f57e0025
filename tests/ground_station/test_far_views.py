"""Addresses that name a view of nowhere near: the page stays usable."""

from __future__ import annotations

from pathlib import Path

import pytest
from chromium_tools import READY, browsing
from ground_station_tools import serving

pytestmark = pytest.mark.slow
VIEWS = ("1e20,0,1", "-1e300,1e308,100", "0,0,1e-300", "0,0,1e300", "-1e9,1e9,100")
NOBODY = "http://127.0.0.1:9/"
TILES = ("--tiles", NOBODY + "{z}/{x}/{y}.png")


@pytest.mark.parametrize("words", [(), TILES], ids=["alone", "tiles"])
def test_a_view_of_nowhere_near_is_shown_as_any_other(
    log: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    with serving(log, *words) as (_, port), browsing(tmp_path / "profile") as page:
        for k, view in enumerate(VIEWS):
            page.go(f"http://127.0.0.1:{port}/?{k}#t=0&map={view}")  # a new page each time
            page.until(READY)
            page.click("#whole")
            page.until("!location.hash.includes('map=')")
        # pictures of the map are not to be had here, which the browser tells
        assert [one for one in page.logged if NOBODY not in str(one)] == []
