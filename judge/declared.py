"""Declared failures: which ones a mission asks about and what is flown then, and what a log says of them."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.judge.fields import Node

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
