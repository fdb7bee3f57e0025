"""Takes the pictures of the ground station in `docs/img`, in a headless Chromium, from live flights, plans and
replays.

    PYTHONPATH=$PWD/src:tests/tools python docs/tools/ground_station_pictures.py [NAME...]

NAME: one of two, bands, live, hold, command, edit, attached, or replay; without any, all. Check each one by eye.
"""

from __future__ import annotations

import base64
import contextlib
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import chromium_tools
from chromium_tools import READY, Page, browsing, playing
from daidalus_sky import SEES, Craft, Sky, fly
from editor_tools import write as type_into
from ground_station_tools import Served, attaching, editing, flying, serving
from log_tools import write as write_log

from cratous.bridge import lmcp
from cratous.core.files.whole_file import replacing
from cratous.services.logs.entry import Entry

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "img"
CROSSING = Path("examples/crossing/mission.yaml")
STATE = "document.getElementById('live-state')?.textContent"
NEWEST_MS = "Number(document.getElementById('slider').max)"


def taken(page: Page, name: str, width_px: int = 1280, height_px: int = 800) -> None:
    """Write a screenshot of the page as a file of docs/img."""
    page.call(
        "Emulation.setDeviceMetricsOverride",
        width=width_px, height=height_px, deviceScaleFactor=1, mobile=False,
    )  # fmt: skip
    time.sleep(1.0)  # the page redraws after a change of size
    shot = page.call("Page.captureScreenshot", format="png")
    with replacing(FOLDER / name) as unnamed:
        unnamed.write_bytes(base64.b64decode(shot["data"]))
    print(FOLDER / name)


def flown(work: Path, *more: str) -> Path:
    """The results folder of a flight of the crossing."""
    out = work / ("bare" if more else "out")
    words = ["run", str(CROSSING), "--allow-unproved", "--quiet", "--out", str(out), *more]
    subprocess.run([sys.executable, "-m", "cratous", *words], cwd=ROOT, check=False)
    return out / "crossing"


def replay(work: Path) -> None:
    """Picture `replay`: the replay of a takeover."""
    with playing(flown(work), work / "replay", 30.0) as page:
        page.value("location.hash = '#t=30&theme=light&aircraft=2'")
        taken(page, "ground-station.png")


def two(work: Path) -> None:
    """Picture `two`: flights with and without ICAROUS; well clear is lost without it."""
    flown(work)
    flown(work, "--no-daa")
    with (
        serving(Path("out/crossing"), Path("bare/crossing")) as (_, port),
        browsing(work / "two") as page,
    ):
        page.go(f"http://127.0.0.1:{port}/#t=83.5&theme=light")
        page.until("document.querySelector('#differences tr')")
        taken(page, "ground-station-two.png", 1280, 900)


def bands(work: Path) -> None:
    """Picture `bands`: the bands of a vehicle with an intruder on a collision course and a third aircraft nearby."""
    sky = Sky(work, SEES)
    fly(
        sky,
        [Craft(2, 0.0, 0.0, 10.0), Craft(1, 6000.0, 0.0, 180.0), Craft(3, 5000.0, 9000.0, 250.0)],
        90,
    )
    made = [
        Entry(k, e.time_ms, e.source, e.topic, lmcp.to_json(e.body)) for k, e in enumerate(sky.all)
    ]
    log = write_log(work / "log.sqlite", made)
    with playing(log, work / "bands", 20.0) as page:
        page.value("location.hash = '#t=20&theme=light&aircraft=2'")
        page.value("document.getElementById('bands-note').parentElement.scrollIntoView()")
        taken(page, "ground-station-bands.png")


@contextlib.contextmanager
def commanded(work: Path, name: str) -> Iterator[tuple[Served, Page]]:
    """The crossing in flight, paused at its start, and the page that commands it."""
    with flying(CROSSING, work / name, ROOT) as live, browsing(work / f"{name}-page") as page:
        page.go(live.url)
        page.until(f"{STATE} === 'paused' && !document.getElementById('fly').disabled")
        yield live, page


def until_ms(page: Page, time_ms: int, rate: int) -> None:
    """Fly to a time and pause."""
    choose(page, "live-rate", str(rate))
    page.click("#fly")
    page.until(f"{NEWEST_MS} >= {time_ms}")
    page.click("#fly")
    page.until(f"{STATE} === 'paused'")


def click_map(page: Page, across: float, down: float) -> None:
    """Click on the map, at fractions of its width and height."""
    x, y, width, height = page.value(
        "(b => [b.x, b.y, b.width, b.height])(document.getElementById('map').getBoundingClientRect())"
    )
    place = {"x": x + across * width, "y": y + down * height}
    for kind in ("mousePressed", "mouseReleased"):
        page.call("Input.dispatchMouseEvent", type=kind, button="left", clickCount=1, **place)


def choose(page: Page, name: str, value: str) -> None:
    """Select an item of a list."""
    page.value(
        f"(s => {{ s.value = {value!r}; s.dispatchEvent(new Event('change')); }})"
        f"(document.getElementById({name!r}))"
    )


def drawn(page: Page, what: str, *places: tuple[float, float]) -> None:
    """Select a kind of command of the operator, and click its places on the map."""
    choose(page, "operate", what)
    page.until("document.getElementById('operate-hint').textContent.startsWith('Click')")
    for across, down in places:
        click_map(page, across, down)


def live(work: Path) -> None:
    """Picture `live`: a flight, paused while ICAROUS commands a vehicle."""
    with commanded(work, "live") as (_, page):
        until_ms(page, 24_000, 5)
        page.until("document.getElementById('verdicts-at').textContent.startsWith('so far, at ')")
        taken(page, "ground-station-live.png")


def hold(work: Path) -> None:
    """Picture `hold`: a vehicle that holds at the position commanded."""
    with commanded(work, "hold") as (_, page):
        until_ms(page, 120_000, 50)
        drawn(page, "hold_at", (0.6, 0.45))
        page.until("document.getElementById('confirm-command').open")
        page.value("document.getElementById('command-vehicle').value = 1")
        page.click("#command-yes")
        page.until("!document.getElementById('confirm-command').open")
        until_ms(page, 200_000, 50)
        page.until("document.getElementById('live-text').textContent.includes('circles')")
        taken(page, "ground-station-hold.png")


def command(work: Path) -> None:
    """Picture `command`: a keep-out zone of the operator's."""
    with commanded(work, "command") as (_, page):
        until_ms(page, 24_000, 5)
        drawn(page, "keep_out", (0.66, 0.62), (0.86, 0.62), (0.86, 0.9))
        page.key("Enter")
        page.until("document.getElementById('confirm-command').open")
        page.click("#command-yes")
        page.until("document.getElementById('events')?.textContent.includes('zone')")
        page.until(f"{STATE} === 'paused'")
        taken(page, "ground-station-command.png")


def edit(work: Path) -> None:
    """Picture `edit`: relations with an error in them, beside the plan of the previous version."""
    copy = Path("relations.yaml")
    copy.write_bytes((ROOT / "examples/relations/mission.yaml").read_bytes())
    with editing(copy) as served, browsing(work / "edit") as page:
        page.go(served.url)
        page.until("document.getElementById('relations-tree')?.textContent.includes('p1')")
        page.click("#plan")
        page.until("document.querySelectorAll('#gantt .bar').length >= 2")
        page.value(
            "document.querySelector('#gantt .bar[data-task=\"1\"]').dispatchEvent(new Event('click'))"
        )
        page.until("document.body.textContent.includes('with vehicle 2: ')")
        type_into(page, "relations", "|(.(p1 p2) +(p3 p4))_[240000-1200000] ~(p5 p6)")
        page.until("document.getElementById('relations-error').textContent !== ''")
        taken(page, "ground-station-edit.png", 1400, 1000)


def attached(work: Path) -> None:
    """Picture `attached`: a simulation that is observed."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    scenario = work / "crossing.xml"
    whole = ["export", str(CROSSING), "--format", "amase", "-o", str(scenario)]
    subprocess.run([sys.executable, "-m", "cratous", *whole], cwd=ROOT, check=True)
    where = f"127.0.0.1:{port}"
    words = ["sim", str(scenario), "--listen", where, "--rate", "5", "--clients", "1"]
    simulator = subprocess.Popen([sys.executable, "-m", "cratous", *words], cwd=ROOT)
    try:
        with attaching(f"tcp://{where}") as page_port, browsing(work / "attached") as page:
            page.go(f"http://127.0.0.1:{page_port}/")
            page.until(READY)
            page.until(f"{NEWEST_MS} > 20000")
            taken(page, "ground-station-attached.png")
    finally:
        simulator.kill()
        simulator.wait()


ALL: dict[str, Callable[[Path], None]] = {
    "replay": replay, "two": two, "bands": bands, "live": live, "hold": hold, "command": command,
    "edit": edit, "attached": attached,
}  # fmt: skip


def main() -> None:
    """Take the pictures named on the command line, or all."""
    chromium_tools.LIMIT_S = 400.0
    for name in sys.argv[1:] or ALL:
        with TemporaryDirectory(prefix="cratous-") as work, contextlib.chdir(work):
            ALL[name](Path(work))


if __name__ == "__main__":
    main()
