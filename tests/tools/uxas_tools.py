"""What the tests of `cratous uxas` share: configurations, loops with a limit, a CMASI client."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp, sentinel
from cratous.services.loading.uxas_settings import read
from cratous.services.processes.children import free_port as free_port
from cratous.services.uxas.logs import Logs
from cratous.services.uxas.process import Process

HEAD = '<UxAS FormatVersion="1.0" EntityID="{}" EntityType="Aircraft" {}>\n'
LIMIT_S = 120.0


def write_cfg(folder: Path, body: str, root: str = "", entity: int = 100) -> Path:
    path = folder / "cfg.xml"
    path.write_text(HEAD.format(entity, root) + body + "\n</UxAS>\n")
    return path


class Said(list):
    """A logger's console."""

    def has(self, text: str) -> bool:
        return any(text in line for line in self)


def process(path: Path, **more: Any) -> tuple[Process, Said]:
    """A process in this test's thread; it runs only while `until` turns it."""
    said = Said()
    return Process(read(path), Logs("DEBUG", echo=said.append), say=said.append, **more), said


def until(done: Any, *processes: Process, limit_s: float = LIMIT_S) -> None:
    end = time.monotonic() + limit_s
    while not done():
        assert time.monotonic() < end, "the time limit is over"
        for one in processes:
            one.turn(0.002)


class Client:
    """A client as a test-suite would have it: a plain socket and sentinel frames."""

    def __init__(self, port: int, of: subprocess.Popen[Any] | None = None) -> None:
        """of: whose port it is, if that process may have to start first."""
        end = time.monotonic() + 5 * LIMIT_S  # which may compile
        while True:
            assert of is None or of.poll() is None, f"it has ended with {of.returncode}"
            try:
                self.sock = socket.create_connection(("127.0.0.1", port), timeout=60)
                break
            except OSError:
                assert time.monotonic() < end, "nobody listens"
                time.sleep(0.05)
        # else each second small frame waits for the acknowledgement of the first, 40 ms
        self.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.sock.setblocking(False)
        self.stream = sentinel.FrameStream()
        self.got: list[wire.AddressedMessage] = []
        self.ended = False

    def send(self, body: Any, entity: int = 0, service: int = 0) -> None:
        message = wire.enclose(
            body.all_names[0], lmcp.binary.pack(body), entity_id=entity, service_id=service
        )
        self.raw(sentinel.frame(message.pack()))

    def raw(self, data: bytes) -> None:
        self.sock.setblocking(True)
        self.sock.sendall(data)
        self.sock.setblocking(False)

    def read(self) -> list[wire.AddressedMessage]:
        with contextlib.suppress(BlockingIOError):
            while data := self.sock.recv(1 << 16):
                self.got += [wire.parse(p) for p in self.stream.feed(data)]
            self.ended = True
        return self.got

    def kinds(self) -> list[str]:
        return [message.descriptor.rpartition(".")[2] for message in self.read()]

    def wait(self, kind: str) -> Any:
        """The first message of a kind, from another process, which may have to compile first."""
        end = time.monotonic() + 5 * LIMIT_S
        while kind not in self.kinds():
            assert not self.ended, f"the connection has ended without a {kind}"
            assert time.monotonic() < end, f"no {kind} came, but {self.kinds()}"
            time.sleep(0.01)
        return lmcp.binary.unpack(self.got[self.kinds().index(kind)].payload)

    def close(self) -> None:
        self.sock.close()


@contextlib.contextmanager
def ended(running: subprocess.Popen[Any]) -> Any:
    """A process that is asked to end when it is left, and killed if it does not."""
    try:
        yield running
    finally:
        if running.poll() is None:
            running.terminate()
        try:
            running.wait(60)
        except subprocess.TimeoutExpired:
            running.kill()
            running.wait(60)


@contextlib.contextmanager
def started(path: Path, *options: str) -> Any:
    """`cratous uxas` as a process of its own, in the configuration's folder."""
    running = subprocess.Popen(
        [sys.executable, "-m", "cratous", "uxas", "-cfgPath", str(path), *options],
        cwd=path.parent,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    with ended(running):
        yield running
