"""`cratous serve` as a process of its own, requests to it, and Chromium to look at its page."""

from __future__ import annotations

import contextlib
import gzip
import http.client
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import parse_qsl

import pytest

LIMIT_S = 120


class Got(NamedTuple):
    """An answer; names of headers are in small letters."""

    status: int
    headers: dict[str, str]
    body: bytes

    def data(self) -> Any:
        """The body as JSON, unpacked."""
        packed = self.headers.get("content-encoding") == "gzip"
        return json.loads(gzip.decompress(self.body) if packed else self.body)


class Served(NamedTuple):
    """`cratous serve MISSION`: the process, its port, and what commands need."""

    process: subprocess.Popen[str]
    port: int
    token: str
    path: str = "/command"

    @property
    def url(self) -> str:
        """The address that it printed."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def children(self) -> list[int]:
        """The processes that it started, whichever of its threads did: one is the main one's once that is over."""
        found = set[int]()
        for thread in Path(f"/proc/{self.process.pid}/task").iterdir():
            with contextlib.suppress(FileNotFoundError, ProcessLookupError):
                found.update(int(n) for n in (thread / "children").read_text().split())
        return sorted(found)

    def order(self, page: str = "a", body: bytes | None = None, **asked: Any) -> Got:
        """A command of a page."""
        return self.sent(page, json.dumps(asked).encode() if body is None else body)

    def sent(self, page: str, body: bytes, **changed: str) -> Got:
        """A request with the headers of a page, but for those that are changed."""
        own = f"127.0.0.1:{self.port}"
        headers = {
            "Origin": f"http://{own}", "Content-Type": "application/json", "Host": own,
            "X-Cratous-Token": self.token, "X-Cratous-Page": page, "Content-Length": str(len(body)),
            **{name.replace("_", "-"): value for name, value in changed.items()},
        }  # fmt: skip
        return ask(self.port, self.path, "POST", body, **headers)

    def edit(self, path: str, **asked: Any) -> Got:
        """What the page of the editor asks for at a path."""
        return self._replace(path=path).sent("a", json.dumps(asked).encode())

    def told(self, first: int = 0, page: str = "a") -> Any:
        """What is new from an update on."""
        named = {"X-Cratous-Token": self.token, "X-Cratous-Page": page}
        return ask(self.port, f"/live.json?from={first}", **named).data()

    def until(self, *states: str) -> Any:
        """How the flight is once it is in one of these states."""
        until_s = time.monotonic() + LIMIT_S
        while (status := self.told()["status"])["state"] not in states:
            assert time.monotonic() < until_s, status
            time.sleep(0.05)
        return status


@contextlib.contextmanager
def _started(
    *words: str, cwd: Path | None = None, host: str = "127.0.0.1", **environment: str
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    running = subprocess.Popen(
        [sys.executable, "-m", "cratous", "serve", *words, "--port", "0"], cwd=cwd,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", **environment},
    )  # fmt: skip
    try:
        assert running.stdout is not None
        line = running.stdout.readline()
        assert f"http://{host}:" in line, line
        yield running, line.partition(f"http://{host}:")[2]
    finally:
        if running.poll() is None:
            running.kill()
        running.communicate(timeout=LIMIT_S)


@contextlib.contextmanager
def serving(*paths: Path | str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """`cratous serve PATH...` on a free port: the process and the port; it is ended at the end."""
    with _started(*map(str, paths)) as (running, line):
        yield running, int(line.partition("/")[0])


@contextlib.contextmanager
def serving_at(host: str, *words: str, **environment: str) -> Iterator[tuple[int, dict[str, str]]]:
    """`cratous serve WORDS --host HOST` on a free port: the port and what the printed address has behind `?`."""
    with _started(*words, "--host", host, host=host, **environment) as (_, line):
        port, _, rest = line.partition(" ")[0].partition("/")
        yield int(port), dict(parse_qsl(rest.removeprefix("?")))


@contextlib.contextmanager
def attaching(address: str) -> Iterator[int]:
    """`cratous serve --attach ADDRESS` on a free port; it is ended at the end."""
    with _started("--attach", address) as (_, line):
        yield int(line.partition("/")[0])


@contextlib.contextmanager
def flying(mission: Path, out: Path, cwd: Path | None = None) -> Iterator[Served]:
    """`cratous serve MISSION --out OUT` on a free port; it is ended at the end."""
    with _started(str(mission), "--out", str(out), cwd=cwd) as (running, line):
        port, _, token = line.partition(" ")[0].partition("/?token=")
        yield Served(running, int(port), token)


@contextlib.contextmanager
def editing(mission: Path) -> Iterator[Served]:
    """`cratous serve MISSION --edit` on a free port; it is ended at the end."""
    with _started(str(mission), "--edit", "--allow-unproved") as (running, line):
        port, _, token = line.partition(" ")[0].partition("/?token=")
        yield Served(running, int(port), token)


def ask(port: int, path: str, method: str = "GET", body: bytes = b"", /, **headers: str) -> Got:
    """One request; `Host` in the headers takes the place of the true one."""
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=LIMIT_S)
    try:
        line.putrequest(method, path, skip_host="Host" in headers, skip_accept_encoding=True)
        for name, value in headers.items():
            line.putheader(name.replace("_", "-"), value)
        line.endheaders(body or None)
        answer = line.getresponse()
        found = {name.lower(): value for name, value in answer.getheaders()}
        return Got(answer.status, found, answer.read())
    finally:
        line.close()


def dom(url: str, profile: Path) -> str:
    """The page's document in headless Chromium after its scripts have run; skips where there is none."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("there is no Chromium on this machine")
    # without its sandbox, since tests may run as root; it opens pages of this machine alone
    done = subprocess.run(
        [
            chromium, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
            "--disable-background-networking", f"--user-data-dir={profile}",
            "--virtual-time-budget=10000", "--dump-dom", url,
        ],
        capture_output=True, text=True, timeout=LIMIT_S,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout
