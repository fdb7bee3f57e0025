"""The bus over several processes: one process runs the hub, the others join it over ZeroMQ.

The hub's process binds HubPULL and HubPUB; a satellite connects HubPUSH and HubSUB. A satellite's
services publish to the hub and receive everything from it, including messages of their own process,
so that there is one total order for all: the hub's. The frames are UxAS's,
`address$attributes$payload`; anyone may subscribe to HubPUB. `Probe` frames (content type `hub`)
tell a satellite that its subscription works.

A satellite that does not read loses messages, counted here; messages without subscriber are not
sent.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Any

import zmq

from cratous.bridge import envelope as wire
from cratous.bridge.port import Limits, Tally, address, is_due
from cratous.bridge.zmq_curve import Curve
from cratous.bridge.zmq_port import End, ZmqPort
from cratous.services.bus import Bus, Envelope
from cratous.services.uxas.bridges import number, pack, unpack
from cratous.services.uxas.frame import Host
from cratous.spec.errors import BadInput

PROBE = "hub"
SCHEMES = ("tcp", "ipc", "inproc")
_JOIN_S = 10.0
_PROBE_MS = 50


class _Side:
    """Common part of both sides: a port, and counts of lost and refused messages. take: receives
    the other side's messages; echoes: whether probes are returned.
    """

    def __init__(
        self, host: Host, port: ZmqPort, name: str, take: Callable[[Envelope], object], echoes: bool
    ) -> None:
        self._host, self.port = host, port
        self._take, self._echoes = take, echoes
        self._tally = Tally(name, host.log)
        self._tally.counts = port.counts

    def pump(self, now_s: float) -> int:
        """Process input from the other side; returns the number of messages."""
        count = 0
        for incoming in self.port.step(now_s):
            try:
                message = wire.parse(incoming.parts[0])
                if message.content_type == PROBE:
                    if self._echoes:
                        self.port.send(incoming.parts)
                    continue
                self._take(_envelope(self._host.bus, message))
                count += 1
            except BadInput as error:
                self._tally.refuse(error.what, f"hub: {error}")
        return count

    def push(self, envelope: Envelope) -> None:
        """Send one message to the other side."""
        try:
            self.port.send((pack(envelope),))
        except BadInput as error:
            self._tally.lose("message has no form on the wire", str(error))

    def close(self) -> None:
        """Close the sockets."""
        self.port.close()


class Hub(_Side):
    """The ordering process: publishes what its bus delivers, accepts what satellites push."""

    prefixes = ("",)

    def __init__(self, host: Host, context: Any, pub: str, pull: str, curve: Curve | None) -> None:
        port = _port(host, context, ("PUB", pub), ("PULL", pull), True, curve)
        super().__init__(host, port, "hub", host.arrived, echoes=True)
        host.bus.tap(self.push)


class RemoteBus(Bus):
    """A satellite's bus: published messages go to the hub, messages from the hub are delivered."""

    satellite: Satellite | None = None

    def put(self, envelope: Envelope) -> None:
        """Push to the hub; before joining, behave as any bus."""
        if self.satellite is None:
            super().put(envelope)
        else:
            self.satellite.push(envelope)

    def hear(self, envelope: Envelope) -> None:
        """Queue a message that the hub has ordered."""
        super().put(envelope)


class Satellite(_Side):
    """The satellite side: joins a hub and feeds a `RemoteBus`."""

    def __init__(self, host: Host, context: Any, sub: str, push: str, curve: Curve | None) -> None:
        """Raises BadInput if no hub answers within ten seconds."""
        assert isinstance(host.bus, RemoteBus)
        self._bus = host.bus
        port = _port(host, context, ("PUSH", push), ("SUB", sub), False, curve)
        super().__init__(host, port, "satellite", self._bus.hear, echoes=False)
        try:
            self._join(push)
        except BaseException:
            self.port.close()
            raise
        self._bus.satellite = self

    def _join(self, push: str) -> None:
        """Wait until a probe message returns: from then on no message can be missed."""
        nonce = f"hub.probe.{os.getpid()}.{time.monotonic_ns()}"
        probe = wire.AddressedMessage(nonce, PROBE, nonce, "", "0", "0", b"?").pack()
        end_s = time.monotonic() + _JOIN_S
        poller = zmq.Poller()
        for sock, flags in self.port.handles():
            poller.register(sock, flags)
        while not is_due(end_s, time.monotonic()):
            self.port.send((probe,))
            poller.poll(_PROBE_MS)
            if any(incoming.parts == (probe,) for incoming in self.port.step(0.0)):
                return
        raise BadInput(
            "no hub answers",
            where=self._host.root.get("where", str(self._host.config)),
            item="UxAS.HubPUSH",
            expected="a process with HubPULL and HubPUB at these addresses",
            got=push,
        )


def _port(
    host: Host,
    context: Any,
    out: tuple[str, str],
    into: tuple[str, str],
    bind: bool,
    curve: Curve | None,
) -> ZmqPort:
    where = str(host.config)
    sender = End(out[0], address(out[1], SCHEMES, where=where, item=f"UxAS.Hub{out[0]}"), bind)
    receiver = End(
        into[0],
        address(into[1], SCHEMES, where=where, item=f"UxAS.Hub{into[0]}"),
        bind,
        ("",) if into[0] == "SUB" else (),
    )
    return ZmqPort(context, sender, receiver, limits=Limits(), curve=curve, report=host.log)


def _envelope(bus: Bus, message: wire.AddressedMessage) -> Envelope:
    body = unpack(message)
    topic = body.all_names[0]
    entity, service = number(message.entity_id), number(message.service_id)
    source = f"eid{entity}.sid{service}"
    for name in bus.names():  # one of our own messages returns with our own name
        if bus.identity(name)[:2] == (entity, service) and service:
            source = name
    target = "" if message.address == topic else message.address
    return Envelope(
        0, bus.now_ms, source, topic, body, target, message.group, entity, service, message.payload
    )
