"""Which messages ask for a plan."""

from __future__ import annotations

WRAPPED = {
    "CoordinatedAutomationRequest": "OriginalRequest",
    "TaskAutomationRequest": "OriginalRequest",
    "ImpactAutomationRequest": "TrialRequest",
}
"""Messages that wrap an automation request, and the field that contains it."""


def is_request(kind: str) -> bool:
    """True for a type of message that asks for a plan."""
    return kind == "AutomationRequest" or kind in WRAPPED
