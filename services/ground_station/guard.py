"""Access check before every request: the server's own name and its token; and security headers of
each answer.

starlette's TrustedHostMiddleware ignores the port: names of other servers on this machine would be
trusted.
"""

from __future__ import annotations

from collections.abc import Callable

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from cratous.services.ground_station.access import BEARER, Access
from cratous.services.web.answers import json_answer

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self'{images}; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Guard:
    """Wraps an application with the access check."""

    def __init__(self, app: ASGIApp, access: Access, images: Callable[[], str]) -> None:
        """images: origins from which pages may load additional images, "" for none."""
        self._app, self._access, self._images = app, access, images

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        request = Request(scope)
        shown = self._access.shown_by(request)
        refused = self._refused(request, shown)
        images = self._images()
        port = scope["server"][1]

        async def send_guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(raw=message["headers"])
                for name, value in HEADERS.items():
                    headers[name] = value.format(images=f" {images}" if images else "")
                if refused is None and shown == "address":
                    headers["Set-Cookie"] = self._access.kept(port)
            await send(message)

        await (refused or self._app)(scope, receive, send_guarded)

    def _refused(self, request: Request, shown: str | None) -> Response | None:
        """The refusal of a request that names another server, or lacks the token; None if it is permitted."""
        near = request.scope["server"]
        if not self._access.called(request.headers.getlist("host"), near, near[1]):
            told = f"this server is {self._access.url(near[1])} and answers to no other name"
            return json_answer({"error": told}, 421)
        if shown is None:
            told = (
                "this server needs the token of the address that was printed where it was started"
            )
            return json_answer({"error": told}, 401, **{"WWW-Authenticate": BEARER.strip()})
        return None
