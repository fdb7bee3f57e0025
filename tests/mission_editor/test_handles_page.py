"""Headings, radii and places that are dragged on the map of the editor, in a real browser."""

from __future__ import annotations

import json

import pytest
from chromium_tools import Page
from editor_tools import TEXT, click_map, data, drag_pixels, place, write

pytestmark = pytest.mark.slow


def test_headings_and_radii_are_dragged_by_their_circles(page: Page) -> None:
    before = page.value(TEXT)
    first = data(page)["vehicles"][0]["position"]
    ahead = _handle(page, "vehicles,0,heading_deg")
    start = _handle(page, "vehicles,0,position")
    assert start == pytest.approx(place(page, first["north_m"], first["east_m"]), abs=2)
    assert ahead == pytest.approx((start[0], start[1] - 44), abs=1)  # it flies north
    drag_pixels(page, ahead, (start[0] - 60, start[1] + 60))
    page.until(f"{TEXT} !== {json.dumps(before)}")
    assert data(page)["vehicles"][0]["heading_deg"] == pytest.approx(225, abs=1.5)
    assert data(page)["vehicles"][0]["position"] == first
    # the circle stands ahead again, as far as before
    turn = (start[0] - 44 * 0.7071, start[1] + 44 * 0.7071)
    assert _handle(page, "vehicles,0,heading_deg") == pytest.approx(turn, abs=2)
    assert page.value("!document.getElementById('remove').disabled")  # the vehicle is picked
    page.click("[data-tool=loiter]")
    click_map(page, -400, 1200)
    click_map(page, -400, 1500)
    page.until(f"{TEXT}.includes('kind: loiter')")
    page.until(_marker("tasks,2,radius_m"))
    centre, rim = _handle(page, "tasks,2,points,0"), _handle(page, "tasks,2,radius_m")
    assert rim[1] == pytest.approx(centre[1], abs=1)
    scale = (rim[0] - centre[0]) / data(page)["tasks"][2]["radius_m"]
    drag_pixels(page, rim, (centre[0], centre[1] - 500 * scale))
    page.until(f"!{TEXT}.includes('radius_m: {data(page)['tasks'][2]['radius_m']}')")
    assert data(page)["tasks"][2]["radius_m"] == pytest.approx(500, abs=1.5 / scale)
    circle = (
        "  - {id: 9, kind: area_search, circle: {centre: {north_m: 0, east_m: 0}, radius_m: 300}}"
    )
    write(page, "text", before.replace("\ntasks:\n", f"\ntasks:\n{circle}\n"))
    page.until(_marker("tasks,0,circle,radius_m"))
    rim, centre = (_handle(page, f"tasks,0,circle,{name}") for name in ("radius_m", "centre"))
    drag_pixels(page, rim, (centre[0], centre[1] + 400 * scale))
    page.until(f"!{TEXT}.includes('radius_m: 300')")
    assert data(page)["tasks"][0]["circle"]["radius_m"] == pytest.approx(400, abs=3 / scale)
    page.click("#undo")
    page.until(f"{TEXT}.includes('radius_m: 300')")


def test_what_is_dragged_is_moved_by_arrow_keys_too(page: Page) -> None:
    before = data(page)["tasks"][1]["points"][0]
    x, y = _handle(page, "tasks,1,points,0")
    page.value(f"{_marker('tasks,1,points,0')}.focus()")
    for _ in range(3):
        page.key("ArrowRight")
    page.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowUp", modifiers=8)
    page.until(f"!{TEXT}.includes('east_m: {before['east_m']}')")
    assert _handle(page, "tasks,1,points,0") == pytest.approx((x + 3, y - 10), abs=1)
    page.click("#undo")  # one change, not four
    assert data(page)["tasks"][1]["points"][0] == before
    page.value(f"{_marker('vehicles,0,heading_deg')}.focus()")
    for _ in range(10):
        page.key("ArrowRight")
    page.until(f"!{TEXT}.includes('heading_deg: 0')")
    assert data(page)["vehicles"][0]["heading_deg"] == pytest.approx(12.8, abs=1.5)  # 10 of 44 px


def _marker(name: str) -> str:
    return f"document.querySelector('#map .handle[data-key=\"{name}\"]')"


def _handle(page: Page, name: str) -> tuple[float, float]:
    """Pixels of the page of what is dragged for a value of the file."""
    page.until(_marker(name))
    x, y = page.value(
        f"(b => [b.x + b.width / 2, b.y + b.height / 2])({_marker(name)}.getBoundingClientRect())"
    )
    return x, y
