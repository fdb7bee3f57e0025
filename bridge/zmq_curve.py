"""Keys for ZeroMQ (CURVE): encryption and admission of known peers only, if configured.

The side that binds has a key pair and, if it is to admit known clients only, a folder of their public keys; the side
that connects has its own pair and the server's public key. Key files are those of ZeroMQ (`*.key`, `*.key_secret`);
`make_keys` writes them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import zmq
import zmq.auth
from zmq.utils import z85

from cratous.spec.errors import BadInput

_ZAP = "inproc://zeromq.zap.01"


def make_keys(folder: Path, name: str) -> tuple[Path, Path]:
    """Write a new pair as NAME.key and NAME.key_secret (readable by the owner only); returns the two paths."""
    folder.mkdir(parents=True, exist_ok=True)
    public, secret = map(Path, zmq.auth.create_certificates(folder, name))
    secret.chmod(0o600)
    return public, secret


def _load(path: Path, secret: bool, where: str, item: str) -> tuple[bytes, bytes | None]:
    try:
        public, private = zmq.auth.load_certificate(path)
    except (OSError, ValueError) as error:
        raise BadInput(
            f"the key cannot be read ({error})", where=where, item=item, expected="a ZeroMQ key"
        ) from None
    if not public or (secret and not private):
        kind = "public and secret key" if secret else "public key"
        raise BadInput("no key inside", where=where, item=item, expected=kind, got=str(path))
    return public, private


class Curve:
    """CURVE keys of one socket: its own pair, the server's public key (to connect), the accepted clients (to bind)."""

    def __init__(
        self,
        secret_file: Path,
        server_file: Path | None = None,
        clients: Path | None = None,
        *,
        where: str = "",
        domain: str = "cratous",
    ) -> None:
        """Raises BadInput if a file holds no key.

        clients: a folder of *.key files, or None to admit anyone; domain: the name of this set of keys at the
        doorkeeper.
        """
        self.where, self.domain = where, domain
        self.public, private = _load(secret_file, True, where, "CurveSecretKeyFile")
        assert private is not None
        self.secret = private
        self.server: bytes | None = None
        if server_file is not None:
            self.server, _ = _load(server_file, False, where, "CurveServerKeyFile")
        self.clients: frozenset[bytes] | None = None
        if clients is not None:
            if not clients.is_dir():
                raise BadInput(
                    "no such folder", where=where, item="CurveClientKeys", got=str(clients)
                )
            files = sorted(clients.glob("*.key"))
            self.clients = frozenset(_load(f, False, where, "CurveClientKeys")[0] for f in files)

    def apply(self, sock: Any, bind: bool) -> None:
        """Set a socket's keys before it binds or connects."""
        sock.curve_publickey, sock.curve_secretkey = self.public, self.secret
        if bind:
            sock.curve_server = True
            sock.zap_domain = self.domain.encode()
            return
        if self.server is None:
            raise BadInput(
                "no key of the server",
                where=self.where,
                item="CurveServerKeyFile",
                expected="the public key of the side that binds",
            )
        sock.curve_serverkey = self.server


class Doorkeeper:
    """Authenticates ZeroMQ clients (ZAP) for all sockets of one context."""

    def __init__(self, context: zmq.Context[Any]) -> None:
        self._sock = context.socket(zmq.REP)
        self._sock.linger = 0
        self._sock.bind(_ZAP)
        self._known: dict[bytes, frozenset[bytes] | None] = {}

    def admit(self, curve: Curve) -> None:
        """Accept the clients whose public keys `curve` lists, at the sockets of its domain."""
        self._known[curve.domain.encode()] = curve.clients

    def handles(self) -> list[tuple[Any, int]]:
        """The ZAP socket to poll, with its flags."""
        return [(self._sock, zmq.POLLIN)]

    def step(self) -> None:
        """Answer all pending authentication requests."""
        while True:
            try:
                frames: list[bytes] = self._sock.recv_multipart(zmq.NOBLOCK)
            except zmq.Again:
                return
            version, request, domain, _place, _identity, mechanism, *rest = [*frames, b""]
            key = z85.encode(rest[0]) if len(rest[0]) == 32 else b""
            known = self._known.get(domain, frozenset())
            good = mechanism == b"CURVE" and (known is None or key in known)
            code, text = (b"200", b"OK") if good else (b"400", b"unknown key")
            self._sock.send_multipart([version, request, code, text, key if good else b"", b""])

    def close(self) -> None:
        """Close the ZAP socket."""
        self._sock.close(linger=0)
