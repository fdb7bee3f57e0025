"""Receives everything from a ZeroMQ publisher, like UxAS's `LmcpObjectNetworkPublishPullBridge`; nothing is sent to
it.

ZeroMQ silently drops what is published before the subscription is active, or while its queue for us is full.
"""

from __future__ import annotations

import zmq

from cratous.bridge.port import Address, Report
from cratous.bridge.zmq_port import End, ZmqPort


class Subscription(ZmqPort):
    """A ZeroMQ SUB socket that connects, and reconnects when the connection is lost."""

    def __init__(self, where: Address, report: Report) -> None:
        """where: `zmq://HOST:PORT`; BadInput if it cannot be used."""
        self._own: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        publisher = where._replace(scheme="tcp", text=where.text.replace("zmq://", "tcp://", 1))
        try:
            super().__init__(self._own, None, End("SUB", publisher, False, ("",)), report=report)
        except BaseException:
            self._own.destroy(linger=0)
            raise

    @property
    def peers(self) -> int:
        """True while connected to the publisher."""
        return self.connected

    def close(self) -> None:
        """Close the socket and its context."""
        super().close()
        self._own.destroy(linger=0)
