"""The map as it is moved: wheel, mouse, fingers and keys in a real browser, and where things then are drawn."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import READY, Page, browsing, playing
from ground_station_tools import serving

pytestmark = pytest.mark.slow
BOX = "(b => [b.x, b.y, b.width, b.height])(document.getElementById('map').getBoundingClientRect())"
MOUSE, TOUCH = "Input.dispatchMouseEvent", "Input.dispatchTouchEvent"


@pytest.fixture
def page(crossing: Path, tmp_path: Path) -> Iterator[Page]:
    with playing(crossing, tmp_path, 0) as page:
        _view(page, 0, 0, 0.2)
        yield page


def _view(page: Page, north: float, east: float, scale: float) -> None:
    page.value(f"location.hash = '#t=2&theme=light&map={north},{east},{scale}'")
    page.until("document.getElementById('clock').textContent.startsWith('00:00:02.0')")


def _shown(page: Page) -> list[float]:
    """North and east [m] of the middle, and pixels to a metre, as the address says."""
    return [float(n) for n in page.value("location.hash.match(/map=([^&]*)/)[1]").split(",")]


def _under(page: Page, x: float, y: float) -> tuple[float, float]:
    """North and east [m] that the page tells of a point of it."""
    page.call(MOUSE, type="mouseMoved", x=x, y=y)
    words = page.text("cursor").replace(",", "").split()
    return float(words[1]), float(words[4])


def test_a_wheel_zooms_about_the_pointer(page: Page) -> None:
    left, top, width, height = page.value(BOX)
    x, y = left + width * 0.7, top + height * 0.3
    before = _under(page, x, y)
    page.call(MOUSE, type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-120)
    page.until("Number(location.hash.match(/map=[^,]*,[^,]*,([0-9.]+)/)[1]) > 0.22")
    assert _under(page, x, y) == pytest.approx(before, abs=1 / 0.2)
    page.click("#farther")
    page.until("Number(location.hash.match(/map=[^,]*,[^,]*,([0-9.]+)/)[1]) < 0.22")


def test_a_drag_moves_the_ground_with_the_pointer(page: Page) -> None:
    left, top, width, height = page.value(BOX)
    x, y = left + width * 0.5, top + height * 0.5
    before = _under(page, x, y)
    page.call(MOUSE, type="mousePressed", x=x, y=y, button="left", clickCount=1)
    for k in (1, 2, 3):
        page.call(MOUSE, type="mouseMoved", x=x + 30 * k, y=y - 20 * k, button="left")
    page.call(MOUSE, type="mouseReleased", x=x + 90, y=y - 60, button="left", clickCount=1)
    assert _under(page, x + 90, y - 60) == pytest.approx(before, abs=1 / 0.2)
    north, east, scale = _shown(page)
    assert (north, east) == pytest.approx((-60 / 0.2, -90 / 0.2), abs=1 / 0.2)
    assert scale == pytest.approx(0.2)


def test_arrows_with_shift_move_the_map_that_has_the_focus_and_without_the_clock(
    page: Page,
) -> None:
    page.value("document.getElementById('map').focus()")
    shifted = {"modifiers": 8, "key": "ArrowRight"}
    page.call("Input.dispatchKeyEvent", type="keyDown", **shifted)
    page.call("Input.dispatchKeyEvent", type="keyUp", **shifted)
    assert _shown(page)[:2] == pytest.approx([0, 60 / 0.2], abs=1 / 0.2)
    page.key("ArrowRight")
    assert page.text("clock").startswith("00:00:03.0")
    page.key("+")
    assert _shown(page)[2] == pytest.approx(0.3, rel=1e-3)


def test_two_fingers_zoom_and_one_moves(page: Page) -> None:
    left, top, width, height = page.value(BOX)
    x, y = left + width / 2, top + height / 2

    def touch(kind: str, *across: float) -> None:
        page.call(
            TOUCH,
            type=kind,
            touchPoints=[{"x": x + a, "y": y, "id": k} for k, a in enumerate(across)],
        )

    page.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    page.call("Page.reload")  # which now knows that there are fingers
    page.until(READY)
    touch("touchStart", -50, 50)
    for wide in (60, 80, 100):
        touch("touchMove", -wide, wide)
        page.value("new Promise(done => requestAnimationFrame(done))")
    touch("touchEnd")
    page.until("Number(location.hash.match(/map=[^,]*,[^,]*,([0-9.]+)/)?.[1]) > 0.35")
    assert _shown(page)[2] == pytest.approx(0.4, rel=0.05)
    east = _shown(page)[1]
    touch("touchStart", 0)
    for far in (20, 60, 100):
        touch("touchMove", far)
    touch("touchEnd")
    assert _shown(page)[1] == pytest.approx(east - 100 / _shown(page)[2], abs=25)


@pytest.mark.parametrize(
    ("north", "east", "scale"), [(0, 0, 0.05), (-1500, 7, 0.731), (0, -2200, 60.0)]
)
def test_what_is_drawn_lies_where_leaflet_has_its_place(
    page: Page, north: float, east: float, scale: float
) -> None:
    """The canvas and the layers of Leaflet are two ways to the same pixel, also where a map was dragged before."""
    page.value(
        "import('/plane_map.js').then(({ PlaneMap }) => import('/units.js').then(({ words }) => {"
        " const box = document.createElement('div'); box.className = 'map';"
        " box.id = 'other'; document.getElementById('mapbox').append(box);"
        " window.plane = new PlaneMap(box, words(false), false, () => {}); }))"
    )
    page.until("window.plane")
    view = json.dumps({"north": north, "east": east, "scale": scale})
    for moved in ("", "plane.leaflet.panBy([37, -21], { animate: false });"):
        (x, y), (at_x, at_y), size = page.value(
            f"(() => {{ plane.show({view}); {moved} plane.layer.cover();"
            f" const {{ x, y, scale }} = plane.origin(), place = [{north} + 90 / {scale}, {east} - 40 / {scale}];"
            " const at = plane.leaflet.latLngToContainerPoint(place);"
            " return [[x + place[1] * scale, y - place[0] * scale], [at.x, at.y],"
            " [plane.canvas.getBoundingClientRect().x - plane.element.getBoundingClientRect().x, 0]]; })()"
        )
        assert (x, y) == pytest.approx((at_x, at_y), abs=1)
        assert size[0] == pytest.approx(0, abs=0.01)


def test_a_page_asks_no_other_server(crossing: Path, tmp_path: Path) -> None:
    with serving(crossing) as (_, port), browsing(tmp_path) as page:
        page.go(f"http://127.0.0.1:{port}/")
        page.until(READY)
        page.click("#closer")
        asked = page.value("performance.getEntriesByType('resource').map(one => one.name)")
        assert all(one.startswith(f"http://127.0.0.1:{port}/") for one in asked)
        assert f"http://127.0.0.1:{port}/vendor/leaflet/leaflet.js" in asked
        assert page.logged == []


def test_an_address_names_a_place_as_finely_as_it_is_seen(page: Page) -> None:
    _view(page, 12.34, -2200.56, 60)
    page.key("n")
    assert _shown(page) == [12.34, -2200.56, 60]
    left, top, width, height = page.value(BOX)
    at = _under(page, left + width / 2, top + height / 2)
    assert at == pytest.approx((12.34, -2200.56), abs=1 / 60)
    page.value("location.hash = '#t=2&theme=light&map=0,0,1e9'")  # closer than the map comes
    page.until(
        "document.querySelector('.leaflet-control-scale-line').textContent.startsWith('2 m')"
    )
