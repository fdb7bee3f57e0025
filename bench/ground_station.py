"""The page of a message log in headless Chromium: time to first view, and frame times.

    python bench/ground_station.py [--vehicles 50] [--minutes 5] [--seconds 30]

The log is made first: states of the vehicles at 2 Hz, each on a circle of its own. Then `cratous serve`
is started on it, the page is opened in a browser of its own, and played in real time. Wall times,
on the machine as it is; a frame is the time between two calls of requestAnimationFrame, and
its script time is the part in which the page itself draws.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "tools"))

from chromium_tools import Page, browsing
from day_of_traffic import STEP_MS, state_of
from ground_station_tools import serving

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.logs.message_logger import MessageLogger

SEEN = "(document.getElementById('clock')?.textContent ?? '').includes(' of ')"
COUNT_FRAMES = """(() => {
  window.frames_ms = []; window.script_ms = [];
  const ask = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = act => ask(now => {
    const begun = performance.now(); act(now); window.script_ms.push(performance.now() - begun);
  });
  let last = performance.now();
  ask(function next(now) { window.frames_ms.push(now - last); last = now; ask(next); });
})()"""


class Figures(NamedTuple):
    """The figures; for frames and their scripts the 95th percentile and the maximum [ms]."""

    serve_s: float
    first_view_ms: float
    frames: int
    frame_p95_ms: float
    frame_most_ms: float
    script_p95_ms: float
    script_most_ms: float


def made(folder: Path, vehicles: int, minutes: float) -> Path:
    """Write a log of this many vehicles and minutes."""
    bus = Bus(lmcp.full_names)
    logger = MessageLogger(folder, clock="virtual")
    bus.tap(logger.tap)
    for step in range(int(minutes * 60_000 / STEP_MS) + 1):
        bus.now_ms = step * STEP_MS
        for vehicle in range(1, vehicles + 1):
            bus.publish(state_of(vehicle, bus.now_ms), "sim")
        bus.run()
    logger.close()
    return Path(logger.log.path)


def measured(log: Path, seconds: float) -> Figures:
    """Open the page of a log and play it for some seconds; SystemExit if too few frames were drawn."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as profile, serving(log) as (_, port):
        serve_s = time.monotonic() - begun
        with browsing(Path(profile)) as page:
            page.go(f"http://127.0.0.1:{port}/")
            page.until(SEEN)
            # since the page was requested; includes the time of this query
            first_ms = float(page.value("performance.now()"))
            frames, scripts = played(page, seconds)
    if len(frames) < 100:
        raise SystemExit(f"{len(frames)} frames in {seconds:g} s say nothing")

    def p95(values: list[float]) -> float:
        return values[int(0.95 * len(values))]

    return Figures(
        serve_s, first_ms, len(frames), p95(frames), frames[-1], p95(scripts), scripts[-1]
    )


def played(page: Page, seconds: float) -> tuple[list[float], list[float]]:
    """Times of the frames, and of the scripts in them, while the page plays [ms], each sorted in ascending order."""
    page.value(COUNT_FRAMES)
    page.click("#play")
    time.sleep(seconds)
    if page.text("play") != "Pause":
        raise SystemExit("it does not play")
    found = page.value("[window.frames_ms, window.script_ms]")
    return sorted(found[0]), sorted(found[1])


def main() -> None:
    """Print the figures of one run."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--vehicles", type=int, default=50)
    options.add_argument("--minutes", type=float, default=5.0)
    options.add_argument("--seconds", type=float, default=30.0, help="how long it is played")
    given = options.parse_args()
    if not (shutil.which("chromium") or shutil.which("chromium-browser")):
        raise SystemExit("there is no Chromium on this machine")
    with tempfile.TemporaryDirectory() as folder:
        log = made(Path(folder), given.vehicles, given.minutes)
        for name, value in measured(log, given.seconds)._asdict().items():
            print(f"{name:16} {value:,.1f}")


if __name__ == "__main__":
    main()
