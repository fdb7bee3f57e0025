"""The number of bytes at the other end of a TCP connection that a program of this machine has not read yet.

Queried from the system (sock_diag(7) of Linux): the TCP window reports it too late and too coarsely.
"""

from __future__ import annotations

import fcntl
import socket
import struct
import termios
from contextlib import suppress

_NETLINK_SOCK_DIAG = 4
_BY_FAMILY = 20  # message types: request for one socket, and its reply
_REQUEST = 1
_ALL_STATES = 0xFFFFFFFF
_HEADER = struct.Struct("=IHHII")  # length, type, flags, sequence, port
_ASKED = struct.Struct("=BBBxI")  # family, protocol, extensions, states
_ADDRESSES = struct.Struct("!HH4s12x4s12x")
_ANY = struct.pack("=III", 0, 0xFFFFFFFF, 0xFFFFFFFF)  # interface and cookie
_QUEUE = _HEADER.size + 4 + _ADDRESSES.size + len(_ANY) + 4  # offset of the unread count


def unread_by_peer(link: socket.socket) -> int | None:
    """Bytes sent to the other end of a connection, arrived or not, that its program has not read; None where the
    system cannot tell: another machine, a system other than Linux, IPv6, or an end that has gone."""
    with suppress(OSError, ValueError, struct.error):
        here, there = link.getsockname(), link.getpeername()
        if link.family != socket.AF_INET:
            return None
        ends = (socket.inet_aton(there[0]), socket.inet_aton(here[0]))
        # read first: data arriving in between may be counted twice but must not be missed
        on_its_way = struct.unpack("=i", fcntl.ioctl(link, termios.TIOCOUTQ, bytes(4)))[0]
        body = _ASKED.pack(socket.AF_INET, socket.IPPROTO_TCP, 0, _ALL_STATES)
        body += _ADDRESSES.pack(there[1], here[1], *ends) + _ANY
        header = _HEADER.pack(_HEADER.size + len(body), _BY_FAMILY, _REQUEST, 1, 0)
        with socket.socket(
            getattr(socket, "AF_NETLINK", -1), socket.SOCK_RAW, _NETLINK_SOCK_DIAG
        ) as diag:
            diag.settimeout(0.1)
            diag.send(header + body)
            answer = diag.recv(4096)
        if _HEADER.unpack_from(answer)[1] == _BY_FAMILY:
            return int(struct.unpack_from("=I", answer, _QUEUE)[0]) + int(on_its_way)
    return None
