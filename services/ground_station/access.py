"""Where the ground station listens, and access control: permitted Host names, and the token."""

from __future__ import annotations

import hmac
import os
import re
import secrets
import socket
from ipaddress import IPv4Address, IPv6Address, ip_address
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from starlette.requests import Request

from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of

LOOPBACK = "127.0.0.1"
"""The loopback address; the only one that needs no token by default."""
ENVIRONMENT, PARAMETER, BEARER = "CRATOUS_ACCESS_TOKEN", "access", "Bearer "
HTTP = 80
TOKEN_BYTES = 24
TOKEN = re.compile(r"[A-Za-z0-9_-]{16,200}")
EXPECTED = "16 to 200 letters, digits, - or _"


class Access:
    """host: listening address or name of this machine; token: required from clients, "" if none;
    told: whether the printed address contains the token. Raises BadInput for an invalid address.
    """

    def __init__(self, host: str = LOOPBACK, token: str = "", told: bool = False) -> None:
        self.host, self.token, self.told = host, token, told
        self.family, self.address = _resolved(host)

    def shown_host(self) -> str:
        """The host in the printed address: this machine's name if it listens on all interfaces."""
        return socket.gethostname() if self._everywhere() else self.host

    def url(self, port: int) -> str:
        """The URL of the first page, without any token."""
        return f"http://{_in_url(self.shown_host())}:{port}/"

    def whole_url(self, port: int, commands: str) -> str:
        """The URL with the access token, if generated here, and the command token, if there is one."""
        said = {PARAMETER: self.token if self.told else "", "token": commands}
        words = urlencode({name: token for name, token in said.items() if token})
        return self.url(port) + (f"?{words}" if words else "")

    def from_elsewhere(self) -> bool:
        """Whether other machines can reach it."""
        return not self._ip().is_loopback

    def names(self, port: int) -> set[str]:
        """Host names accepted for any address of this machine."""
        hosts = {self.host, self.shown_host()} | (
            {"localhost"} if self._everywhere() or not self.from_elsewhere() else set()
        )
        return _with_port(hosts, port)

    def called(self, hosts: list[str], near: tuple[Any, ...], port: int) -> bool:
        """Whether the single Host header of a request names this server; near: the local end of its
        connection.

        An IP address cannot be redirected like a name, so that of the connection is accepted too.
        """
        names = self.names(port) | _with_port({str(near[0]).removeprefix("::ffff:")}, port)
        return len(hosts) == 1 and hosts[0].lower() in names

    def cookie(self, port: int) -> str:
        """Name of the cookie, with the port, since cookies belong to a host whatever the port."""
        return f"cratous_{PARAMETER}_{port}"

    def kept(self, port: int) -> str:
        """The cookie that carries the token: for this server only, not readable by scripts, not
        sent from other sites.
        """
        return f"{self.cookie(port)}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    def shown_by(self, request: Request) -> str | None:
        """How a request presents the token: `cookie`, `header` or `address`, "" if none is needed;
        None if it is missing or wrong.
        """
        if not self.token:
            return ""
        bearer = request.headers.get("authorization", "")
        found = {
            "cookie": request.cookies.get(self.cookie(request.scope["server"][1]), ""),
            "header": bearer.removeprefix(BEARER) if bearer.startswith(BEARER) else "",
            "address": request.query_params.get(PARAMETER, ""),
        }
        good = [how for how, shown in found.items() if self._is_token(shown)]
        return good[0] if good else None

    def _is_token(self, shown: str) -> bool:
        return hmac.compare_digest(shown.encode("utf-8", "replace"), self.token.encode())

    def _everywhere(self) -> bool:
        return self._ip().is_unspecified

    def _ip(self) -> IPv4Address | IPv6Address:
        return ip_address(self.address.partition("%")[0])


def access_of(host: str, token_file: Path | None) -> Access:
    """Access for a requested address, with the token from a file, the environment, or a new one.

    A given token is required on 127.0.0.1 too. Raises BadInput for an invalid address or token.
    """
    if token_file is not None:
        given = text_of(token_file, expected="a file with a token").strip()
        return Access(host, _checked(given, "--access-token-file"))
    if given := os.environ.get(ENVIRONMENT, ""):
        return Access(host, _checked(given, ENVIRONMENT))
    if host == LOOPBACK:
        return Access()
    return Access(host, secrets.token_urlsafe(TOKEN_BYTES), told=True)


def _checked(token: str, item: str) -> str:
    if not TOKEN.fullmatch(token):  # do not print it: terminals are watched and recorded
        got = f"{len(token)} characters"
        raise BadInput("not a token", item=item, expected=EXPECTED, got=got)
    return token


def _resolved(host: str) -> tuple[socket.AddressFamily, str]:
    try:
        found = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM) if host else []
    except (OSError, UnicodeError):
        found = []
    if not found:
        raise BadInput(
            "no such address", item="--host", expected="an address or name of this machine", got=repr(host)
        )  # fmt: skip
    family, _, _, _, where = found[0]
    return family, str(where[0])


def _in_url(host: str) -> str:
    return f"[{host}]" if ":" in host else host


def _with_port(hosts: set[str], port: int) -> set[str]:
    named = {_in_url(host).lower() for host in hosts}
    return {f"{host}:{port}" for host in named} | (named if port == HTTP else set())
