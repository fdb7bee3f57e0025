"""Declared failures: which ones a mission asks about and what is flown then, and what a log says of them."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.judge.fields import Node
from cratous.spec.errors import BadInput

KINDS = ("blocked", "expiring", "surprised", "ended")
NAMES = tuple(kind.capitalize() for kind in KINDS)
CHANGES = ("Offered", "Refused", "Known", "Left", "Flown", "Expired", "Missing")
MODES = {"hold": "Loiter", "return": "Return", "land": "Land", "ditch": "Land"}


class AfterFailure(NamedTuple):
    """What is flown after a failure, named as in the log, and the failures that count."""

    choice: str
    of: frozenset[str]


class Declared(NamedTuple):
    """A vehicle's report of a failure. said: number of its reports of what it flies by itself before this one."""

    time_ms: int
    failure: str
    said: int


class Event(NamedTuple):
    """A message from which it follows whether a failure is due. word: what it says in short; data: its other fields as far
    as they are needed.
    """

    kind: str
    time_ms: int
    word: str
    data: Node


SHORT = {
    "FailureCheck": "Failure", "FailureState": "Failure", "GateState": "Owner", "HandState": "Change",
    "LinkLossState": "Mode", "TakeOffState": "Mode",
}  # fmt: skip
"""The field of a message that says it in short."""
OTHERS = ("UxasHeard", "TaskProgress")
OF_HAND = ("Expiry", "Surprises")
BLOCKED_NOTE = "blocked: "


def after_failure(data: Node) -> AfterFailure:
    """The section as logged, or as in the mission file. BadInput if it is malformed."""
    of = frozenset(one.one_of(*KINDS).capitalize() for one in data.get("of", list(KINDS)))
    return AfterFailure(MODES[data["choice"].one_of(*MODES)], of)


def read_hand(log: Any, body: Node, _time_ms: int) -> None:
    """Add a `HandState` to the log's extract: what changed of the certificate in hand."""
    change = body["Change"].one_of(*CHANGES)
    log.hands.setdefault(body["VehicleID"].whole, []).append((body["Time"].whole, change))


def read_declared(log: Any, body: Node, _time_ms: int) -> None:
    """Add a `FailureState` to the log's extract."""
    vehicle, failure = body["VehicleID"].whole, body["Failure"].one_of(*NAMES)
    said = Declared(body["Time"].whole, failure, len(log.alone.get(vehicle, [])))
    log.declared.setdefault(vehicle, []).append(said)


def read_check(_log: Any, body: Node, _time_ms: int) -> None:
    """Refuse a malformed `FailureCheck` or `UxasHeard`: `note_due` keeps them."""
    _ = body["VehicleID"].whole, body["Time"].whole


def note_due(log: Any, kind: str, body: Node) -> None:
    """Keep a message from which it follows whether a failure is due, in the order of the log.

    Nothing else needs what it says: where a field is missing or malformed only this is unknown.
    """
    if kind not in SHORT and kind not in OTHERS:
        return
    vehicle = body["VehicleID"].whole
    try:
        log.due.setdefault(vehicle, []).append(_event(kind, body))
    except BadInput as error:
        log.unread.setdefault(vehicle, f"{error.item}: {error.what}")


def _event(kind: str, body: Node) -> Event:
    if kind in SHORT:
        word = body[SHORT[kind]].text
    elif kind == "UxasHeard":
        word = str(body["Heard"].flag)
    else:
        blocked = body["Phase"].text == "Failed" and body["Note"].text.startswith(BLOCKED_NOTE)
        word = "Blocked" if blocked else ""
    data = body
    if kind != "FailureCheck":  # of a certificate two numbers are needed, of others none
        numbers = {name: body[name].whole for name in OF_HAND} if kind == "HandState" else {}
        data = Node(numbers, body.where, body.item)
    return Event(kind, body["Time"].whole, word, data)
