"""Messages over ZeroMQ: one socket that sends and one that receives, as UxAS pairs them.

PUB with PULL (the side that binds), SUB with PUSH (the side that connects). A message is one part,
`address$attributes$payload`; IMPACT's has two, its address and the LMCP bytes. Transports: inproc, ipc, tcp, and udp
(one datagram per message, by `udp_port`).

Backpressure: a PUB whose subscriber's queue is full sends to the others, and counts and reports this; ZeroMQ does not
tell how many messages that subscriber loses until it reads again, so `since_full` gives an upper bound. A PUSH
without a reader keeps a bounded queue, then discards by the policy.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import zmq
from zmq.utils.monitor import recv_monitor_message

from cratous.bridge.port import Address, Counts, Incoming, Limits, Report, Tally, is_due, often
from cratous.bridge.zmq_curve import Curve
from cratous.spec.errors import BadInput

SLOW = "a subscriber does not read"
STALLED = "nobody takes it"
_BATCH = 2000  # messages in one step, so that a flood leaves time for the others

_KINDS = {"PUB": zmq.PUB, "PUSH": zmq.PUSH, "PULL": zmq.PULL, "SUB": zmq.SUB}
_TELL = {
    zmq.EVENT_HANDSHAKE_SUCCEEDED: ("INFO", "a peer has connected"),
    zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL: ("WARN", "a peer was refused: no handshake"),
    zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL: ("WARN", "a peer was refused: wrong protocol"),
    zmq.EVENT_HANDSHAKE_FAILED_AUTH: ("WARN", "a peer was refused: its key is not known"),
    zmq.EVENT_DISCONNECTED: ("INFO", "a peer is gone"),
    zmq.EVENT_ACCEPT_FAILED: ("WARN", "a peer was refused: no room for connections"),
}


@dataclass(frozen=True)
class End:
    """One socket: kind (PUB, PUSH, PULL, SUB), its address, whether it binds, its subscriptions."""

    kind: str
    address: Address
    bind: bool
    subscriptions: tuple[str, ...] = ()


class ZmqPort:
    """A pair of ZeroMQ sockets; see the module."""

    due_s: float | None = None

    def __init__(
        self,
        context: zmq.Context[Any],
        sender: End | None,
        receiver: End | None,
        *,
        parts: int = 1,
        limits: Limits | None = None,
        curve: Curve | None = None,
        report: Report = lambda _severity, _text: None,
        settle_s: float = 0.0,
    ) -> None:
        """parts: number of parts of a message. Raises BadInput if an address cannot be used.

        settle_s: time [s] after the first step during which nothing is read, so that a client that has been trying to
        connect is there to receive the answer to what it has queued.
        """
        self._settle_s = settle_s  # 0 when it is over
        self._limits = limits or Limits()
        self._parts, self._report = parts, report
        name = " and ".join(end.address.text for end in (sender, receiver) if end)
        self._tally = Tally(name, report)
        self.counts: Counts = self._tally.counts
        self._monitors: list[tuple[Any, str]] = []
        self._out: Any = None
        self._in: Any = None
        self._sender, self._receiver = sender, receiver
        self._context, self._curve = context, curve
        self._waiting: deque[tuple[bytes, ...]] = deque()
        self._bytes = 0
        self.connected = 0  # peers that have completed the handshake and are still connected
        self.since_full = 0  # messages since a subscriber's queue was first full, inclusive
        try:
            if receiver is not None:
                self._in = self._open(receiver)
            if sender is not None:
                self._out = self._open(sender)
        except BaseException:
            self.close()
            raise

    @property
    def waiting(self) -> int:
        """Bytes queued because no subscriber has room."""
        return self._bytes

    def bound(self, receiving: bool) -> str:
        """The address of the sending, or if `receiving` of the receiving socket, with the port that the system
        chose."""
        sock = self._in if receiving else self._out
        return str(sock.getsockopt_string(zmq.LAST_ENDPOINT))

    def handles(self) -> list[tuple[Any, int]]:
        """Both sockets and their monitors to poll, each with its flags."""
        found: list[tuple[Any, int]] = [(sock, zmq.POLLIN) for sock, _ in self._monitors]
        if self._in is not None and not self._settle_s:
            found.append((self._in, zmq.POLLIN))
        if self._out is not None and self._waiting:
            found.append((self._out, zmq.POLLOUT))
        return found

    def step(self, now_s: float) -> list[Incoming]:
        """Write what is queued, read what has arrived; the messages in order. now_s: monotonic clock [s]."""
        self._tell()
        self._flush()
        found: list[Incoming] = []
        if self._in is None:
            return found
        if self._settle_s:
            if self.due_s is None:
                self.due_s = now_s + self._settle_s
            if not is_due(self.due_s, now_s):
                return found
            self._settle_s, self.due_s = 0.0, None
        assert self._receiver is not None
        peer = self._receiver.address.text
        for _ in range(_BATCH):
            try:
                parts = tuple(self._in.recv_multipart(zmq.NOBLOCK))
            except zmq.Again:
                break
            if len(parts) != self._parts:
                self._tally.refuse(
                    "wrong number of parts", f"expected {self._parts}, got {len(parts)}"
                )
                continue
            found.append(Incoming(parts, peer))
        self.counts.received += len(found)
        return found

    def send(self, parts: tuple[bytes, ...]) -> None:
        """Send to all subscribers that have room; without any, queue."""
        if self._out is None or self._sender is None:
            return
        size = sum(map(len, parts))
        if size > self._limits.payload_bytes:
            self._tally.lose("message longer than the limit", f"{size} bytes")
            return
        if self._sender.kind == "PUB":
            self._publish(parts)
            return
        if not self._waiting and self._try(parts):
            return
        if self._limits.when_full == "DropOldest":
            while self._waiting and self._bytes + size > self._limits.waiting_bytes:
                self._bytes -= sum(map(len, self._waiting.popleft()))
                self._tally.lose(STALLED, "the oldest message")
        if self._waiting and self._bytes + size > self._limits.waiting_bytes:
            self._tally.lose(STALLED, f"{self._bytes} bytes wait")
            return
        self._waiting.append(parts)
        self._bytes += size

    def close(self) -> None:
        """Give queued messages a moment to be sent, then close the sockets."""
        if self._out is not None and not self._out.closed:
            self._flush()
            if self.since_full:
                self._report(
                    "WARN",
                    f"{self._tally.name}: {SLOW}: of the {self.since_full} messages sent since one "
                    "was first full, it has lost an unknown part",
                )
            if self._waiting:
                count = len(self._waiting)
                self._waiting.clear()
                self._bytes = 0
                self._tally.counts.lost["closed before all was sent"] += count
                self._report("WARN", f"{self._tally.name}: closed with {count} messages unsent")
        for sock in (self._in, self._out):
            if sock is not None and not sock.closed:
                sock.disable_monitor()  # while its reader exists: its last event waits for one
        for monitor, _ in self._monitors:
            monitor.close(linger=0)
        self._monitors.clear()
        for sock in (self._in, self._out):
            if sock is not None:
                sock.close(linger=200)

    def _open(self, end: End) -> Any:
        sock = self._context.socket(_KINDS[end.kind])
        try:
            sock.linger = 200  # [ms]; a peer that has gone must not delay the shutdown
            sock.sndhwm = sock.rcvhwm = self._limits.high_water
            sock.maxmsgsize = self._limits.payload_bytes + 8192
            sock.ipv6 = ":" in end.address.host
            if end.kind == "PUB":
                sock.setsockopt(zmq.XPUB_NODROP, 1)
            if self._curve is not None and end.address.scheme == "tcp":
                self._curve.apply(sock, end.bind)
            monitor = sock.get_monitor_socket(sum(_TELL))
            self._monitors.append((monitor, end.address.text))
            for prefix in end.subscriptions:
                sock.subscribe(prefix)
            text = end.address.text
            if end.bind:
                sock.bind(text)
            else:
                sock.connect(text.replace("//*:", "//127.0.0.1:"))
        except (zmq.ZMQError, BadInput) as error:
            sock.disable_monitor()
            sock.close(linger=0)
            if isinstance(error, BadInput):
                raise
            raise BadInput(
                f"{'cannot listen' if end.bind else 'cannot connect'} ({error})",
                where=end.address.text,
                expected="an address of this machine that is free" if end.bind else "an address",
            ) from None
        return sock

    def _publish(self, parts: tuple[bytes, ...]) -> None:
        self.counts.sent += 1
        self.since_full += self.since_full > 0
        for _ in range(2):
            try:
                self._out.send_multipart(parts, zmq.NOBLOCK)
                return
            except zmq.Again:
                _ = self._out.events  # makes the socket process what was read meanwhile
        # a subscriber's queue is full: it alone loses this message, and further ones until it reads again
        self.since_full = max(1, self.since_full)
        self._tally.lose(SLOW, f"{self.since_full} messages sent since one was first full")
        self._out.setsockopt(zmq.XPUB_NODROP, 0)
        try:
            self._out.send_multipart(parts, zmq.NOBLOCK)
        finally:
            self._out.setsockopt(zmq.XPUB_NODROP, 1)

    def _try(self, parts: tuple[bytes, ...]) -> bool:
        try:
            self._out.send_multipart(parts, zmq.NOBLOCK)
        except zmq.Again:
            return False
        self.counts.sent += 1
        return True

    def _flush(self) -> None:
        while self._waiting and self._try(self._waiting[0]):
            self._bytes -= sum(map(len, self._waiting.popleft()))

    def _tell(self) -> None:
        for monitor, text in self._monitors:
            while monitor.poll(0):
                event = recv_monitor_message(monitor, zmq.NOBLOCK)
                found = _TELL.get(event["event"])
                if found is None:
                    continue
                self.connected += event["event"] == zmq.EVENT_HANDSHAKE_SUCCEEDED
                if event["event"] == zmq.EVENT_DISCONNECTED:
                    self.connected = max(0, self.connected - 1)
                severity, what = found
                if severity != "WARN":
                    self._report(severity, f"{text}: {what}")
                    continue
                self.counts.refused[what] += 1
                if often(self.counts.refused[what]):
                    self._report(severity, f"{text}: {what}")
