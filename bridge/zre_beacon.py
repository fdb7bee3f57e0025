"""The beacons of ZRE (RFC 36), by which peers on one network discover each other.

A beacon is a UDP broadcast with the sender's uuid and the port of its inbox; port 0 announces its departure.
"""

from __future__ import annotations

import errno
import fcntl
import socket
import struct
from collections.abc import Iterator

from cratous.bridge import zre_wire as wire
from cratous.bridge.port import Tally
from cratous.spec.errors import BadInput

BEACON_PORT = 5670
_BATCH = 2000
_GET_ADDRESS, _GET_BROADCAST = 0x8915, 0x8919  # ioctl of Linux


def interface(device: str, where: str = "") -> tuple[str, str]:
    """(address, broadcast address) of a network device, e.g. `lo` or `eth0`; BadInput if none."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        try:
            for code in (_GET_ADDRESS, _GET_BROADCAST):
                answer = fcntl.ioctl(sock, code, struct.pack("256s", device.encode()[:15]))
                found.append(socket.inet_ntoa(answer[20:24]))
        except OSError as error:
            raise BadInput(
                "no such network device",
                where=where,
                item="NetworkDevice",
                expected=", ".join(name for _, name in socket.if_nameindex()),
                got=f"{device} ({error.strerror})",
            ) from None
    address, broadcast = found
    if broadcast in ("0.0.0.0", address):
        broadcast = "127.255.255.255" if address.startswith("127.") else "255.255.255.255"
    return address, broadcast


class Beacon:
    """The socket of the beacons on a network device; `address` is the device's."""

    def __init__(self, device: str, port: int, uuid: bytes, tally: Tally, where: str = "") -> None:
        """Raises BadInput if there is no such device, or the port is not available."""
        self.address, broadcast = interface(device, where)
        self._to = (broadcast, port)
        self._uuid, self._tally = uuid, tally
        self._udp = _beacon_socket(port, where)

    def fileno(self) -> int:
        """The socket's file descriptor, for polling."""
        return self._udp.fileno()

    def shine(self, port: int) -> None:
        """Broadcast the port of our inbox; port 0: we leave."""
        try:
            self._udp.sendto(wire.beacon(self._uuid, port), self._to)
        except OSError as error:
            self._tally.lose("beacon not taken by the network", error.strerror or str(error))

    def read(self) -> Iterator[tuple[bytes, str, int]]:
        """(uuid, host, port) of each beacon received from another node."""
        for _ in range(_BATCH):
            try:
                data, (host, _port) = self._udp.recvfrom(1024)
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                if error.errno != errno.ECONNREFUSED:
                    self._tally.refuse("beacon", error.strerror or str(error))
                continue
            found = wire.read_beacon(data)
            if found is not None and found[0] != self._uuid:
                yield found[0], host, found[1]

    def close(self) -> None:
        """Close the socket."""
        self._udp.close()


def _beacon_socket(port: int, where: str) -> socket.socket:
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        sock.setblocking(False)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        # several peers on one machine receive the same beacons
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        sock.bind(("", port))
    except OSError as error:
        sock.close()
        raise BadInput(
            "cannot listen for beacons",
            where=where,
            item="BeaconPort",
            expected="a UDP port that can be shared",
            got=f"{port} ({error.strerror})",
        ) from None
    return sock
