"""Pictures of a tile server beneath the map: which ones, where, and what the page may load."""

from __future__ import annotations

import base64
import contextlib
import struct
import threading
import time
import zlib
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import READY, Page, browsing
from ground_station_tools import LIMIT_S, ask, serving

from cratous.services.cli import main
from cratous.services.ground_station.tiles import MOST, Tiles, View, seen, tiles_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

URL = "https://tiles.example:8443/a/{z}/{x}/{y}.png?key=1"
PLACE = Frame(51.51202, 0.02435)
"""Of which OpenStreetMap's wiki names the tile: at zoom 17 column 65544, row 43582."""
QUARTERS = {"nw": (200, 30, 30), "ne": (30, 160, 30), "sw": (30, 30, 200), "se": (200, 200, 30)}
PLANE = Frame(45.0, 9.0)
"""Of the log that is shown."""
SCALE = 0.03
"""Pixels to a metre of the page that is looked at."""
VIEW = View(0.0, 0.0, 4000.0, 6000.0, 0.2)


def test_the_origin_lies_on_the_tile_that_has_it() -> None:
    tiles = tiles_of("https://a.example/{z}/{x}/{y}")
    # a pixel of 256 to a tile of zoom 17 is 0.743 m there
    found = seen(tiles, PLACE, View(0, 0, 1, 1, 1 / 0.743))
    assert [one["url"] for one in found] == ["https://a.example/17/65544/43582"]
    ((north, west), (_, east), (south, _)) = found[0]["corners"]
    assert south < 0 < north
    assert west < 0 < east
    assert east - west == pytest.approx(0.743 * 256, rel=0.01)
    assert north - south == pytest.approx(0.743 * 256, rel=0.01)
    # half as many pixels to a metre: one zoom less
    (wider,) = seen(tiles, PLACE, View(0, 0, 1, 1, 0.5 / 0.743))
    assert wider["url"].startswith("https://a.example/16/32772/21791")


@pytest.mark.parametrize("frame", [Frame(45.0, 9.0), Frame(-33.9, 151.2), Frame(70.0, 179.99)])
def test_tiles_cover_the_view_and_meet_at_their_corners(frame: Frame) -> None:
    tiles, view = tiles_of("https://a.example/{z}/{x}/{y}.png"), VIEW._replace(north_m=1500.0)
    found = seen(tiles, frame, view)
    assert 4 < len(found) <= MOST
    assert len({one["url"] for one in found}) == len(found)
    corners = [tuple(one["corners"][0]) for one in found]
    for one in found:
        _, (n1, e1), (n2, e2) = one["corners"]
        for north, east in ((n1, e1), (n2, e2)):  # that of a neighbour, or the edge of all
            inside = abs(north - 1500) < 1500 and abs(east) < 2500
            near = min(abs(north - n) + abs(east - e) for n, e in corners)
            assert near < 0.05 or not inside
    for north in (-500.0, 1500.0, 3500.0):
        for east in (-3000.0, 0.0, 3000.0):
            assert any(_has(one["corners"], north, east) for one in found)


def _has(corners: list[list[float]], north: float, east: float) -> bool:
    (n0, e0), (n1, e1), (n2, e2) = corners
    (rn, re), (dn, de) = (n1 - n0, e1 - e0), (n2 - n0, e2 - e0)
    whole = rn * de - re * dn
    right = ((north - n0) * de - (east - e0) * dn) / whole
    down = (rn * (east - e0) - re * (north - n0)) / whole
    return -1e-3 <= right <= 1 + 1e-3 and -1e-3 <= down <= 1 + 1e-3


def test_a_view_of_much_has_no_more_tiles_than_are_kept() -> None:
    tiles = tiles_of("https://a.example/{z}/{x}/{y}.png")
    wide = View(0, 0, 3e5, 3e5, 1.0)  # as finely as a pixel to a metre there would be millions
    assert 0 < len(seen(tiles, PLACE, wide)) <= MOST
    assert seen(tiles, PLACE, View(0, 0, 1e7, 1e7, 1e-4)) == []
    assert seen(tiles, PLACE, View(5e6, 0, 100, 100, 1)) == []


def test_where_web_mercator_has_nothing_is_said() -> None:
    with pytest.raises(BadInput, match="there are no tiles there") as told:
        seen(tiles_of("https://a.example/{z}/{x}/{y}.png"), Frame(86.0, 9.0), VIEW)
    assert told.value.item == "--tiles"


def test_an_address_gives_its_origin_and_nothing_else_to_the_policy() -> None:
    assert tiles_of(URL, "© somebody") == Tiles(URL, "https://tiles.example:8443", "© somebody")
    assert tiles_of("http://[::1]:80/{z}/{x}/{y}").origin == "http://[::1]:80"


@pytest.mark.parametrize(
    "url",
    ["", "tiles", "ftp://a.example/{z}/{x}/{y}", "https:///{z}/{x}/{y}", "file:///{z}/{x}/{y}",
     "https://a.example/{z}/{x}.png", "https://a.example/{z}/{x}/{y}/{y}", "https://{z}/{x}/{y}",
     "https://a.example/{z}/{x}/{y}/{s}", "https://a:b@a.example/{z}/{x}/{y}",
     "https://a.example;script-src/{z}/{x}/{y}", "https://*/{z}/{x}/{y}",
     "https://a.example {z}/{x}/{y}", "https://a.example/{z}/{x}/{y}'", "https://a.example:x/{z}/{x}/{y}",
     "https://a.example/{z}/{x}/{y}#a", "https://a.example/{z}/{x}/{y}\n", "https://*.example/{z}/{x}/{y}"],
)  # fmt: skip
def test_what_is_no_address_of_tiles_is_refused(
    url: str, log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(BadInput) as told:
        tiles_of(url)
    assert (told.value.item, told.value.got) == ("--tiles", url)
    assert main(["serve", str(log), "--port", "0", "--tiles", url]) == 2
    assert "--tiles" in capsys.readouterr().err


def test_an_attribution_is_a_line_of_tiles(log: Path) -> None:
    for bad in ("a\nb", "a" * 201):
        with pytest.raises(BadInput, match="not an attribution"):
            tiles_of(URL, bad)
    assert main(["serve", str(log), "--tiles-attribution", "x"]) == 2


def test_without_the_option_nothing_comes_from_elsewhere(log: Path) -> None:
    with serving(log) as (_, port):
        assert "img-src 'self';" in ask(port, "/").headers["content-security-policy"]
        assert ask(port, "/tiles.json?latitude=45&longitude=9").status == 404
        told = ask(port, "/overlays.json?latitude=45&longitude=9").data()
        assert told == {"shapes": [], "tiles": None}


def test_the_policy_allows_pictures_of_that_origin_alone(log: Path) -> None:
    words = ("--tiles", URL, "--tiles-attribution", "Somebody")
    with serving(log, *words) as (_, port):
        for path in ("/", "/recording.json", "/none"):
            policy = ask(port, path).headers["content-security-policy"]
            assert "img-src 'self' https://tiles.example:8443;" in policy
            assert policy.count("tiles.example") == 1
            assert policy.startswith("default-src 'none'; script-src 'self'; style-src 'self';")
        told = ask(port, "/overlays.json?latitude=45&longitude=9").data()
        assert told == {"shapes": [], "tiles": "Somebody"}
        view = "north=0&east=0&height=2000&width=2000&pixels_per_m=0.2"
        found = ask(port, f"/tiles.json?latitude=45&longitude=9&{view}").data()["tiles"]
        assert found[0]["url"].startswith("https://tiles.example:8443/a/1")
        no_origin = ask(port, f"/tiles.json?{view}")
        assert (no_origin.status, no_origin.data()["error"]) == (
            400, "expected latitude=DEG&longitude=DEG, the origin of a frame",
        )  # fmt: skip
        assert ask(port, f"/tiles.json?latitude=89&longitude=9&{view}").status == 422
        far = view.replace("north=0&east=0", "north=-1000000001&east=1000000005")
        told = ask(
            port, f"/tiles.json?latitude=45&longitude=9&{far}"
        )  # a tile at the edge of a far view
        assert (told.status, told.data()) == (200, {"tiles": []})
        for bad in ("", "north=0", view.replace("2000", "nan"), view.replace("0.2", "0"),
                    view.replace("2000", "-1"), view.replace("north=0", "north=1e300")):  # fmt: skip
            assert ask(port, f"/tiles.json?latitude=45&longitude=9&{bad}").status == 400


def _png() -> bytes:
    """A picture of 256 x 256, each quarter in a colour of its own."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    def row(left: str, right: str) -> bytes:
        return b"\0" + bytes(QUARTERS[left]) * 128 + bytes(QUARTERS[right]) * 128

    lines = row("nw", "ne") * 128 + row("sw", "se") * 128
    head = struct.pack(">IIBBBBB", 256, 256, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines))
        + chunk(b"IEND", b"")
    )  # fmt: skip


@contextlib.contextmanager
def tile_server() -> Iterator[tuple[int, list[Any]]]:
    """On loopback; what was asked for, with the headers that might tell who asks."""
    asked: list[Any] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append((self.path, self.headers.get("Referer"), self.headers.get("Cookie")))
            self.send_response(200)
            self.send_header("Content-Type", "image/png")
            self.end_headers()
            self.wfile.write(_png())

        def log_message(self, format: str, *args: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.05,))
    thread.start()
    try:
        yield server.server_port, asked
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def _pixel(page: Page, x: float, y: float) -> tuple[int, ...]:
    """Red, green and blue of a point of the page: a picture of one pixel has no neighbours to be told from."""
    clip = {"x": int(x), "y": int(y), "width": 1, "height": 1, "scale": 1}
    shot = base64.b64decode(page.call("Page.captureScreenshot", format="png", clip=clip)["data"])
    size = struct.unpack(">II", shot[16:24])
    assert size == (1, 1)
    lines, at = b"", 8
    while at < len(shot):
        (length,) = struct.unpack(">I", shot[at : at + 4])
        if shot[at + 4 : at + 8] == b"IDAT":
            lines += shot[at + 8 : at + 8 + length]
        at += 12 + length
    return tuple(zlib.decompress(lines)[1:4])


def _until_pixel(page: Page, x: float, y: float, wanted: tuple[int, ...]) -> None:
    """Wait until a point of the page has a colour: pictures come one by one."""
    until_s = time.monotonic() + LIMIT_S
    while (got := _pixel(page, x, y)) != pytest.approx(wanted, abs=3):
        assert time.monotonic() < until_s, (got, wanted)
        time.sleep(0.05)


@pytest.mark.slow
def test_the_page_lays_the_pictures_on_their_places(log: Path, tmp_path: Path) -> None:
    with tile_server() as (number, asked):
        url = f"http://127.0.0.1:{number}/{{z}}/{{x}}/{{y}}.png"
        words = ("--tiles", url, "--tiles-attribution", "<b>Some</b>body & co")
        with (
            serving(log, *words) as (_, port),
            browsing(tmp_path / "profile") as page,
        ):
            page.go(f"http://127.0.0.1:{port}/#t=0&theme=light&map=0,0,{SCALE}")
            page.until(READY)
            box = page.value(
                "(b => [b.x, b.y, b.width, b.height])"
                "(document.getElementById('map').getBoundingClientRect())"
            )
            view = View(0, 0, box[3] / SCALE, box[2] / SCALE, SCALE)
            found = seen(tiles_of(url), PLANE, view)
            # one on which nothing else is drawn: the aircraft is in the middle of the map
            tile = min(found, key=lambda one: _away(one["corners"], -500.0, -6200.0))
            (n0, e0), (n1, e1), (n2, e2) = tile["corners"]
            for name, (right, down) in {
                "nw": (0.3, 0.3), "ne": (0.7, 0.3), "sw": (0.3, 0.7), "se": (0.7, 0.7),
            }.items():  # fmt: skip
                north = n0 + right * (n1 - n0) + down * (n2 - n0)
                east = e0 + right * (e1 - e0) + down * (e2 - e0)
                x = box[0] + box[2] / 2 + SCALE * east
                y = box[1] + box[3] / 2 - SCALE * north
                _until_pixel(page, x, y, QUARTERS[name])
            page.until(
                "performance.getEntriesByType('resource')"
                f".filter(e => e.name.includes(':{number}/')).length >= {len(found)}"
            )
            # all of the view, and no more than a tile of the layer beyond it
            beyond_m = 2 * 256 * 2**5
            wide = View(0, 0, view.height_m + beyond_m, view.width_m + beyond_m, SCALE)
            paths = {path for path, _, _ in asked}
            of_view, of_wide = (
                {one["url"].partition(f"{number}")[2] for one in seen(tiles_of(url), PLANE, box)}
                for box in (view, wide)
            )
            assert of_view <= paths <= of_wide
            said = "document.querySelector('.leaflet-control-attribution').textContent"
            assert page.value(said) == "<b>Some</b>body & co"
            # who is asked learns nothing of where the page is from
            assert {(referer, cookie) for _, referer, cookie in asked} == {(None, None)}
            assert page.logged == []
            # no other origin is asked, though it is the same server
            before = len(asked)
            page.value(
                "document.addEventListener('securitypolicyviolation', e => window.refused = e.blockedURI);"
                f"new Image().src = 'http://localhost:{number}/1/1/1.png'"
            )
            page.until(f"window.refused === 'http://localhost:{number}/1/1/1.png'")
            assert len(asked) == before


def _away(corners: list[list[float]], north: float, east: float) -> float:
    """How far the middle of a tile is from a place, along and across."""
    _, (n1, e1), (n2, e2) = corners
    return abs((n1 + n2) / 2 - north) + abs((e1 + e2) / 2 - east)
