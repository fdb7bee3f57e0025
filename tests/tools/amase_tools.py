"""A stand-in for AMASE that can be killed, stopped and begun again, a way to it that is cut, and a flight's side of it."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import address
from cratous.bridge.tcp_port import TcpPort
from cratous.services.processes.amase import Amase, amase_address
from cratous.services.processes.children import Children, free_port

PATIENCE_S = 120.0


def until(done: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not done():
        assert time.monotonic() < end, "the time limit is over"
        time.sleep(0.005)


class Fake:
    """`cratous sim --compatibility amase`: AMASE's port and defects, which can be killed and begun again."""

    def __init__(self, folder: Path, text: str, rate: int = 4) -> None:
        self.port, self._text, self._rate = free_port(), text, rate
        self._children, self._folder, self._count = Children(folder, folder), folder, 0

    def start(self, clients: int = 0) -> None:
        """clients: its clock stands until so many are there."""
        self._count += 1
        name = f"amase{self._count}"
        (self._folder / "scenario.xml").write_text(self._text)
        self._children.start(
            name, "sim", str(self._folder / "scenario.xml"), "--listen", f"127.0.0.1:{self.port}",
            "--rate", str(self._rate), "--compatibility", "amase", "--clients", str(clients),
        )  # fmt: skip
        until(lambda: "listening" in self._children.said(name))

    def kill(self) -> None:
        child: subprocess.Popen[bytes] = self._children.running[f"amase{self._count}"]
        child.kill()
        child.wait()

    def signal(self, number: signal.Signals) -> None:
        os.kill(self._children.running[f"amase{self._count}"].pid, number)

    def end(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            self.signal(signal.SIGCONT)
        self._children.end()


class Way:
    """The way to a port: what goes over it can be lost from now on, and nobody is told, as where a cable is cut."""

    def __init__(self, port: int) -> None:
        self._to, self._pairs, self._cut = (
            port,
            dict[socket.socket, socket.socket](),
            set[socket.socket](),
        )
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port, self.met = self._server.getsockname()[1], 0
        self._ends, self._lock = False, threading.Lock()
        self._ended = list[socket.socket]()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def cut(self) -> None:
        """Whoever is connected now hears nothing any more, and is not heard."""
        with self._lock:
            self._cut = set(self._pairs)

    def _run(self) -> None:
        while not self._ends:
            for one in select.select([self._server, *self._pairs], (), (), 0.05)[0]:
                if one is self._server:
                    near, far = one.accept()[0], socket.create_connection(("127.0.0.1", self._to))
                    with self._lock:
                        self._pairs |= {near: far, far: near}
                    self.met += 1
                    continue
                try:
                    data = one.recv(65536)
                    with self._lock:
                        if data and one not in self._cut:
                            self._pairs[one].sendall(data)
                except ConnectionError:  # an end that goes with data unread is reset
                    data = b""
                if not data:
                    with self._lock:
                        self._ended.append(self._pairs.pop(one))

    def close(self) -> None:
        self._ends = True
        self._thread.join()
        for one in (self._server, *self._pairs, *self._pairs.values(), *self._ended):
            one.close()


class Session:
    """A flight's side of AMASE, and UxAS's; what each has heard."""

    def __init__(self, port: int) -> None:
        self.said: list[str] = []
        self.amase = Amase(amase_address(f"amase://127.0.0.1:{port}"), self.said.append)
        where = address(f"tcp://127.0.0.1:{self.amase.port}", ("tcp",))
        self.uxas = TcpPort(where, server=False)
        self.states: list[Any] = []
        self.heard_s = 0.0
        """When the newest states came [s]."""
        self.passed_on: list[Any] = []

    def turn(self) -> None:
        now_s = time.monotonic()
        for one in self.uxas.step(now_s):
            message = wire.parse(one.parts[0])
            self.passed_on.append(lmcp.binary.received(message.payload, message.descriptor)[0])
        heard, _ = self.amase.step(now_s)
        came = [body for body in heard if type(body).__name__ == "AirVehicleState"]
        self.states += came
        self.heard_s = now_s if came else self.heard_s

    def until(self, done: Callable[[], object]) -> None:
        def turned() -> object:
            self.turn()
            return done()

        until(turned)

    def command(self, body: Any) -> None:
        self.uxas.send((wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack(),))

    def newest(self, number: int) -> Any:
        return next(body for body in reversed(self.states) if number == body.ID)

    def close(self) -> None:
        self.uxas.close()
        self.amase.close()
