"""A ServiceStatus about an automation request."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.bridge import lmcp


def status(request_id: int, kind: str, facts: Iterable[tuple[str, str]]) -> Any:
    """A ServiceStatus about a request. kind: Information, Warning or Error."""
    pairs = [("RequestID", str(request_id)), *facts]
    return lmcp.new(
        "ServiceStatus",
        StatusType=kind,
        PercentComplete=100.0 if kind == "Information" else 0.0,
        Info=[lmcp.new("KeyValuePair", Key=key, Value=value) for key, value in pairs],
    )
