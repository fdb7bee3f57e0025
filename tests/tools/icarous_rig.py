"""UxAS's end of the bridge in this process, and fake ICAROUS clients of it."""

from __future__ import annotations

import contextlib
import socket
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from bridge_flight import Aircraft
from uxas_tools import process, until, write_cfg

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.handshake import ClientHandshake
from cratous.services.bus import Envelope
from cratous.services.monitor.authority import AuthorityWatch
from cratous.spec.mission.guarantees import Verdict

SERVICE = "IcarousCommunicationService"


class Fake:
    """A client of the text protocol that does what the test says."""

    def __init__(
        self,
        port: int,
        hello: int | None = None,
        dialect: tp.Dialect = tp.Dialect.CRATOUS,
        host: str = "127.0.0.1",
    ) -> None:
        self.sock = socket.create_connection((host, port), timeout=60)
        self.sock.setblocking(False)
        self.handshake, self.hello, self.ended = ClientHandshake(), hello, False
        self.dialect = dialect
        self.parser = tp.StreamParser(tp.Direction.DOWN, limits=tp.WIDE_LIMITS, dialect=dialect)
        self.got: list[Any] = []
        self.raw = b""

    def read(self) -> list[Any]:
        """All records so far."""
        with contextlib.suppress(BlockingIOError, ConnectionError):
            while data := self.sock.recv(65536):
                if self.handshake.done:
                    self.take(data)
                    continue
                self.sock.sendall(self.handshake.feed(data))
                if self.handshake.done:
                    if self.hello is not None:
                        self.say(tp.Hello(self.hello))
                    self.take(self.handshake.rest)
            self.ended = True
        return self.got

    def take(self, data: bytes) -> None:
        self.raw += data
        self.got += self.parser.feed(data)

    def say(self, *lines: tp.Message) -> None:
        for line in lines:
            self.sock.sendall(tp.encode(line, dialect=self.dialect, limits=tp.WIDE_LIMITS))

    def all(self, kind: type[Any]) -> list[Any]:
        return [record for record in self.read() if isinstance(record, kind)]

    def close(self) -> None:
        self.sock.close()


class Rig:
    """A process with the service alone, all that it publishes, and fakes."""

    def __init__(self, folder: Path, attributes: str, opened: list[Any]) -> None:
        if "Dialect" not in attributes:  # the fakes have no keys
            attributes += ' Dialect="cratous"'
        text = f'<Service Type="{SERVICE}" Address="tcp://127.0.0.1:0" {attributes}/>'
        self.process, self.said = process(write_cfg(folder, text))
        opened.append(self.process)
        self.opened, self.sent = opened, list[Envelope]()
        self.process.bus.tap(self.sent.append)
        (self.service,) = self.process.ports
        self.port = self.service.port.bound[1]

    def fake(self, hello: int | None = None, dialect: tp.Dialect = tp.Dialect.CRATOUS) -> Fake:
        one = Fake(self.port, hello, dialect)
        self.opened.append(one)
        self.until(lambda: one.read() is not None and (one.handshake.done or one.ended))
        return one

    def until(self, done: Any) -> None:
        until(done, self.process, limit_s=60.0)

    def tell(self, *bodies: Any) -> None:
        for body in bodies:
            self.process.bus.publish(body, "test")
        self.process.turn(0.0)

    def got(self, kind: str) -> list[Any]:
        return [e.body for e in self.sent if type(e.body).__name__ == kind and e.source == SERVICE]

    def authority(self) -> Verdict:
        """What the monitor says of the authority over vehicle 1, from what was published."""
        ours = SimpleNamespace(vehicles=[SimpleNamespace(id=1, protected=True)], daa=None)
        watch = AuthorityWatch(ours)  # type: ignore[arg-type]
        for envelope in self.sent:
            kind = type(envelope.body).__name__
            if kind in ("GateState", "GatedCommand", "ModeRefused"):
                watch.message(kind, envelope.body, envelope.time_ms)
        watch.end(lmcp.new("MissionEnd", Time=3000), {})
        (verdict,) = watch.verdicts()
        return verdict


def state(vehicle: int, north: float = 0.0, now_ms: int = 1000) -> Any:
    craft = Aircraft(vehicle, north, 0.0, 0.0)
    craft.waypoint = 1
    return craft.state(now_ms)
