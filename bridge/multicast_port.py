"""Datagrams to a group of programs on this machine: UDP multicast on the loopback interface, both ways on one socket.

Losses in the network cannot be counted. Any program on this machine can send to the group, so received datagrams have
to be authenticated; if they arrive too fast the system drops some before they are read.
"""

from __future__ import annotations

import socket
from ipaddress import ip_address

from cratous.bridge.port import LOOPBACK, Address, Report, Tally
from cratous.spec.errors import BadInput

MOST_READ = 200
"""The most datagrams read in one step, so that a flood leaves time for other links."""
_LONGEST = 65536
_KEPT_BYTES = 1 << 20


class MulticastPort:
    """One UDP socket of a multicast group; see the module."""

    def __init__(self, where: Address, report: Report = lambda _severity, _text: None) -> None:
        """Raises BadInput if `where` is not a multicast group, or cannot be joined."""
        try:
            group = ip_address(where.host)
        except ValueError:
            group = None
        if group is None or group.version != 4 or not group.is_multicast:
            raise BadInput(
                "no group",
                where=where.text,
                expected="224.0.0.0 to 239.255.255.255",
                got=where.host,
            )
        self.where = where
        self._to = where.host, where.port
        self._tally = Tally(where.text, report)
        self.counts = self._tally.counts
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        near, all_of = socket.inet_aton(LOOPBACK), socket.inet_aton(where.host)
        try:
            self._socket.setblocking(False)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _KEPT_BYTES)
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, near)
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)  # stays here
            self._socket.bind(self._to)
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, all_of + near)
        except OSError as error:
            self._socket.close()
            raise BadInput(
                "the group cannot be joined",
                where=where.text,
                expected="a group and port of the loopback interface",
                got=error.strerror or str(error),
            ) from None

    def fileno(self) -> int:
        """The socket's file descriptor, for polling."""
        return self._socket.fileno()

    def step(self) -> list[bytes]:
        """The datagrams that have arrived, at most MOST_READ a call; those sent by this socket come back too."""
        found = list[bytes]()
        for _ in range(MOST_READ):
            try:
                found.append(self._socket.recv(_LONGEST))
            except OSError:  # nothing has arrived, or an earlier datagram was not accepted
                break
        self.counts.received += len(found)
        return found

    def send(self, data: bytes) -> None:
        """Send one datagram to the group."""
        try:
            self._socket.sendto(data, self._to)
        except OSError as error:
            self._tally.lose("not taken by the network", error.strerror or str(error))
            return
        self.counts.sent += 1

    def refuse(self, why: str, detail: str) -> None:
        """Count a dropped datagram under `why`; reported at its 1st, 2nd, 4th, 8th... occurrence with `detail`."""
        self._tally.refuse(why, detail)

    def close(self) -> None:
        """Leave the group and close the socket. May be called twice."""
        self._socket.close()
