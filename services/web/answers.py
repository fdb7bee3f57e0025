"""HTTP responses of a server, as starlette sends them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from anyio import to_thread
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from cratous.spec.files.printable import json_text

T = TypeVar("T")
JSON = "application/json"


def json_bytes(data: dict[str, Any]) -> bytes:
    """The JSON text as bytes."""
    return json_text(data).encode()


def json_answer(data: dict[str, Any], status: int = 200, **headers: str) -> Response:
    """A JSON response."""
    return Response(json_bytes(data), status, headers, JSON)


async def in_thread(do: Callable[..., T], *words: Any) -> T:
    """The result of a blocking call; a server that ends does not wait for it."""
    return await to_thread.run_sync(do, *words, abandon_on_cancel=True)


async def body_of(request: Request, longest: int) -> bytes:
    """The body of a request. Raises HTTPException 413 if it has more than `longest` bytes."""
    content = bytearray()
    if int(request.headers.get("content-length", "0")) <= longest:
        async for part in request.stream():
            content += part
            if len(content) > longest:
                break
        else:
            return bytes(content)
    raise HTTPException(413, f"expected at most {longest} bytes")
