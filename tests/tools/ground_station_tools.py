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
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

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


@contextlib.contextmanager
def serving(path: Path) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """`cratous serve PATH` on a free port: the process and the port; it is ended at the end."""
    running = subprocess.Popen(
        [sys.executable, "-m", "cratous", "serve", str(path), "--port", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    try:
        assert running.stdout is not None
        line = running.stdout.readline()
        assert "http://127.0.0.1:" in line, line
        yield running, int(line.partition("http://127.0.0.1:")[2].partition("/")[0])
    finally:
        if running.poll() is None:
            running.kill()
        running.communicate(timeout=LIMIT_S)


def ask(port: int, path: str, method: str = "GET", **headers: str) -> Got:
    """One request; `Host` in the headers takes the place of the true one."""
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=LIMIT_S)
    try:
        line.putrequest(method, path, skip_host="Host" in headers, skip_accept_encoding=True)
        for name, value in headers.items():
            line.putheader(name.replace("_", "-"), value)
        line.endheaders()
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
