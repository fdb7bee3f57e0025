"""Where the ground station listens, and who is let in: by which name it may be called, and with which token."""

from __future__ import annotations

import hmac
import os
import re
import secrets
import socket
from email.message import Message
from ipaddress import ip_address
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlencode

from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of

LOOPBACK = "127.0.0.1"
"""This machine alone; the only address where nothing has to be shown."""
ENVIRONMENT, PARAMETER, BEARER = "CRATOUS_ACCESS_TOKEN", "access", "Bearer "
HTTP = 80
TOKEN_BYTES = 24
TOKEN = re.compile(r"[A-Za-z0-9_-]{16,200}")
EXPECTED = "16 to 200 letters, digits, - or _"


class Access:
    """host: where to listen, an address or name of this machine; token: what a client has to show, "" if nothing;
    told: whether the printed address contains the token. Raises BadInput for no address."""

    def __init__(self, host: str = LOOPBACK, token: str = "", told: bool = False) -> None:
        self.host, self.token, self.told = host, token, told
        self.family, self.address = _resolved(host)

    def shown_host(self) -> str:
        """The host of the printed address: where it listens everywhere, the name of this machine."""
        return socket.gethostname() if self._everywhere() else self.host

    def url(self, port: int) -> str:
        """Of the first page, without any token."""
        return f"http://{_in_url(self.shown_host())}:{port}/"

    def whole_url(self, port: int, commands: str) -> str:
        """With the token of access, if it was made here, and that of the commands, if there is one."""
        said = {PARAMETER: self.token if self.told else "", "token": commands}
        words = urlencode({name: token for name, token in said.items() if token})
        return self.url(port) + (f"?{words}" if words else "")

    def names(self, port: int) -> set[str]:
        """What a Host header may say whichever address of this machine was asked."""
        hosts = {self.host, self.shown_host()} | ({"localhost"} if self._loopback() else set())
        return _with_port(hosts, port)

    def called(self, hosts: list[str], near: tuple[Any, ...], port: int) -> bool:
        """Whether the Host headers of a request, one, call this server; near: the own end of its connection.

        An address, other than a name, leads nowhere else, so that of the connection is right too.
        """
        names = self.names(port) | _with_port({str(near[0]).removeprefix("::ffff:")}, port)
        return len(hosts) == 1 and hosts[0].lower() in names

    def cookie(self, port: int) -> str:
        """Its name: cookies are of a host, whatever the port."""
        return f"cratous_{PARAMETER}_{port}"

    def kept(self, port: int) -> str:
        """The cookie that shows the token from now on, to this server alone, by no script and from no other site."""
        return f"{self.cookie(port)}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    def shown_by(self, headers: Message, query: str, port: int) -> str | None:
        """How a request shows the token: `cookie`, `header` or `address`; None if it does not, or a wrong one."""
        bearer = headers.get("Authorization", "")
        found = {
            "cookie": _cookie(headers, self.cookie(port)),
            "header": bearer.removeprefix(BEARER) if bearer.startswith(BEARER) else "",
            "address": parse_qs(query).get(PARAMETER, [""])[0],
        }
        good = [how for how, shown in found.items() if self._is_token(shown)]
        return good[0] if good else None

    def _is_token(self, shown: str) -> bool:
        return hmac.compare_digest(shown.encode("utf-8", "replace"), self.token.encode())

    def _everywhere(self) -> bool:
        return ip_address(self.address.partition("%")[0]).is_unspecified

    def _loopback(self) -> bool:
        return self._everywhere() or ip_address(self.address.partition("%")[0]).is_loopback


def access_of(host: str, token_file: Path | None) -> Access:
    """Of an address that is asked for, with the token of a file, of the environment, or else a new one.

    A token that is given is asked for on 127.0.0.1 too. Raises BadInput for no address and for no token.
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
    if not TOKEN.fullmatch(token):  # it is not shown: terminals are seen and kept
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


def _cookie(headers: Message, name: str) -> str:
    """The value of a cookie; others of the same host may be of any form."""
    for given in headers.get_all("Cookie", []):
        for one in given.split(";"):
            called, _, value = one.strip().partition("=")
            if called == name:
                return value
    return ""
