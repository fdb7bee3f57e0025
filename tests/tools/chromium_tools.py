"""Headless Chromium driven over a pipe by its DevTools protocol: keys, clicks, and what the page then says."""

from __future__ import annotations

import contextlib
import json
import os
import select
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from ground_station_tools import serving

LIMIT_S = 120.0
READY = "!document.getElementById('station')?.hidden && document.querySelector('#aircraft tr')"


class Page:
    """One page; every call waits for its answer, LIMIT_S at most."""

    def __init__(self, write: int, read: int) -> None:
        self._write, self._read = write, read
        self._session: str | None = None
        self._number, self._kept = 0, b""
        self.logged: list[dict[str, Any]] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)[
            "sessionId"
        ]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **values: Any) -> dict[str, Any]:
        """One command of the protocol and its result."""
        self._number += 1
        asked: dict[str, Any] = {"id": self._number, "method": method, "params": values}
        if self._session is not None:
            asked["sessionId"] = self._session
        os.write(self._write, json.dumps(asked).encode() + b"\0")
        until_s = time.monotonic() + LIMIT_S
        while True:
            told = self._next(until_s)
            if told.get("id") == self._number:
                assert "error" not in told, told
                result: dict[str, Any] = told["result"]
                return result
            about = told.get("params", {})
            failed = about.get("entry", {}).get("level") == "error"
            if failed or told.get("method") == "Runtime.exceptionThrown":
                self.logged.append(about)

    def _next(self, until_s: float) -> dict[str, Any]:
        while b"\0" not in self._kept:
            ready, _, _ = select.select([self._read], [], [], max(0.0, until_s - time.monotonic()))
            assert ready, "Chromium does not answer"
            self._kept += os.read(self._read, 1 << 16)
        head, _, self._kept = self._kept.partition(b"\0")
        told: dict[str, Any] = json.loads(head)
        return told

    def go(self, url: str) -> None:
        """Open an address."""
        self.call("Page.navigate", url=url)

    def value(self, script: str) -> Any:
        """What an expression of JavaScript gives."""
        done = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in done, done
        return done["result"].get("value")

    def text(self, name: str) -> str:
        """The text of the element with an id; empty while there is none."""
        return str(self.value(f"document.getElementById({name!r})?.textContent ?? ''"))

    def until(self, script: str) -> None:
        """Wait until an expression is true."""
        until_s = time.monotonic() + LIMIT_S
        while not self.value(f"!!({script})"):
            assert time.monotonic() < until_s, f"never true: {script}"
            time.sleep(0.02)

    def key(self, key: str) -> None:
        """Press and release a key by its name, such as `n`, ` ` or `ArrowRight`."""
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def click(self, selector: str) -> None:
        """Click in the middle of an element, as a mouse does."""
        self.value(f"document.querySelector({selector!r}).scrollIntoView({{block: 'nearest'}})")
        box = f"document.querySelector({selector!r}).getBoundingClientRect()"
        x, y = self.value(f"(b => [b.x + b.width / 2, b.y + b.height / 2])({box})")
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)


@contextlib.contextmanager
def browsing(profile: Path) -> Iterator[Page]:
    """A page in a Chromium of its own, ended at the end; skips where there is no Chromium."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("there is no Chromium on this machine")
    to_read, write = os.pipe()
    read, to_write = os.pipe()
    # the browser reads commands at descriptor 3 and answers at 4
    moved = f'exec {chromium} "$@" 3<&{to_read} 4>&{to_write}'
    running = subprocess.Popen(
        [
            "bash", "-c", moved, "chromium", "--headless", "--no-sandbox", "--disable-gpu",
            "--no-first-run", "--disable-background-networking", "--window-size=1280,800",
            f"--user-data-dir={profile}", "--remote-debugging-pipe",
        ],
        pass_fds=(to_read, to_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(to_read)
    os.close(to_write)
    try:
        yield Page(write, read)
    finally:
        os.close(write)  # a browser whose pipe is closed ends itself
        try:
            running.wait(60)
        except subprocess.TimeoutExpired:
            running.kill()
            running.wait(60)
        os.close(read)


@contextlib.contextmanager
def playing(results: Path, profile: Path, time_s: float) -> Iterator[Page]:
    """The ground station's page on results, from an instant [s] on. Nothing was refused by the content security policy,
    and no script failed."""
    with serving(results) as (_, port), browsing(profile) as page:
        page.go(f"http://127.0.0.1:{port}/#t={time_s:g}")
        page.until(READY)
        yield page
        assert page.logged == []
