"""The handshake that opens a CRATOUS connection, as two state machines that accept bytes in any segmentation.

1. server: `ICAROUS-UxAS_LMCP`; 2. client: 64 hexadecimal characters; 3. server: `ok ` or `error`.
No newlines. Messages may follow immediately after the last step; `rest` holds them. The secret
only tells a wrong program from the right one: it is sent in clear text and is no security measure.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from hmac import compare_digest

from cratous.spec.errors import BadInput

HELLO = b"ICAROUS-UxAS_LMCP"
ACCEPT = b"ok "
REFUSE = b"error"
SECRET_LENGTH = 64
# A constant of this product; not a security measure, see above.
DEFAULT_SECRET = "c7a705" + "0a11ce5afe" * 5 + "facade42"
SECRET_VARIABLE = "CRATOUS_BRIDGE_SECRET"
"""The environment variable for a secret other than the product's."""


def secret_of_environment() -> str:
    """The handshake secret from the environment, else the default; BadInput (without showing it) if it is malformed."""
    text = os.environ.get(SECRET_VARIABLE, DEFAULT_SECRET)
    if not is_secret(text):
        raise BadInput(
            "not a secret of the handshake",
            item=SECRET_VARIABLE,
            expected=f"{SECRET_LENGTH} hexadecimal characters",
            got=f"{len(text)} characters",
        )
    return text


def is_secret(text: str) -> bool:
    """True for 64 hexadecimal characters."""
    return len(text) == SECRET_LENGTH and set(text) <= set("0123456789abcdefABCDEF")


@dataclass
class Handshake:
    """State of the handshake: `done`, or `failed` with the reason; `rest`: bytes received after it."""

    secret: str = DEFAULT_SECRET
    done: bool = False
    failed: str = ""
    rest: bytes = b""

    def __post_init__(self) -> None:
        if not is_secret(self.secret):
            raise ValueError(f"a secret is {SECRET_LENGTH} hexadecimal characters")

    def start(self) -> bytes:
        """The bytes to send first."""
        return b""

    def feed(self, data: bytes) -> bytes:
        """Process bytes from the other end; returns the bytes to send now."""
        self.rest += data
        return b"" if self.done or self.failed else self._step()

    def _step(self) -> bytes:
        raise NotImplementedError

    def _expect(self, wanted: bytes) -> bool:
        """Consume `wanted` at the front once it is complete, and return True; another text is a failure."""
        got = self.rest[: len(wanted)]
        if not wanted.startswith(got):
            self.failed = f"expected {wanted.decode('ascii')!r}, got {ascii(got)[1:]}"
            return False
        if len(got) < len(wanted):
            return False
        self.rest = self.rest[len(wanted) :]
        return True


@dataclass
class ServerHandshake(Handshake):
    """The end that listens (UxAS), which speaks first."""

    def start(self) -> bytes:
        """The server's greeting."""
        return HELLO

    def _step(self) -> bytes:
        # Waits for all 64: closing with bytes unread would destroy the answer on its way.
        if len(self.rest) < SECRET_LENGTH:
            return b""
        given, self.rest = self.rest[:SECRET_LENGTH], self.rest[SECRET_LENGTH:]
        if not compare_digest(given, self.secret.encode("ascii")):
            self.failed = "the client's secret is not ours"  # never shown in a log
            return REFUSE
        self.done = True
        return ACCEPT


@dataclass
class ClientHandshake(Handshake):
    """The end that connects (ICAROUS)."""

    greeted: bool = False

    def _step(self) -> bytes:
        if not self.greeted:
            if not self._expect(HELLO):
                return b""
            self.greeted = True
            return self.secret.encode("ascii") + self._answer()
        return self._answer()

    def _answer(self) -> bytes:
        if self.rest and REFUSE.startswith(self.rest[: len(REFUSE)]):
            if len(self.rest) >= len(REFUSE):
                self.failed = "the server refused our secret"
        elif self.rest:
            self.done = self._expect(ACCEPT)
        return b""
