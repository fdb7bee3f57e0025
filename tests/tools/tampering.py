"""Changes to the messages of a log, as one who tampers with it would make them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from cratous.bridge.lmcp import jsonform
from cratous.services.bus import Envelope

Log = list[Envelope]


def at(log: Log, short: str, since_ms: int = 0, **fields: Any) -> int:
    """Where the first message is of this kind, with these fields, not before this time."""
    for k, one in enumerate(log):
        if one.time_ms >= since_ms and one.topic.endswith(f".{short}"):
            data = json.loads(jsonform.to_json(one.body))
            if all(data[key] == value for key, value in fields.items()):
                return k
    raise AssertionError(f"no {short} with {fields}")


def other(one: Envelope, **fields: Any) -> Envelope:
    """The same message with other fields."""
    data = {**json.loads(jsonform.to_json(one.body)), **fields}
    return replace(one, body=jsonform.from_json(json.dumps(data)))


def remove(short: str, since_ms: int = 0, **fields: Any) -> Callable[[Log], None]:
    def change(log: Log) -> None:
        del log[at(log, short, since_ms, **fields)]

    return change


def strike(*shorts: str, **fields: Any) -> Callable[[Log], None]:
    """Remove all messages of these kinds, with these fields."""

    def change(log: Log) -> None:
        def struck(one: Envelope) -> bool:
            if one.topic.rpartition(".")[2] not in shorts:
                return False
            data = json.loads(jsonform.to_json(one.body))
            return all(data.get(key) == value for key, value in fields.items())

        log[:] = [one for one in log if not struck(one)]

    return change


def alter(
    to: dict[str, Any], short: str, since_ms: int = 0, **fields: Any
) -> Callable[[Log], None]:
    def change(log: Log) -> None:
        k = at(log, short, since_ms, **fields)
        log[k] = other(log[k], **to)

    return change


def send_as(source: str, short: str, since_ms: int = 0, **fields: Any) -> Callable[[Log], None]:
    def change(log: Log) -> None:
        k = at(log, short, since_ms, **fields)
        log[k] = replace(log[k], source=source)

    return change


def swap(short: str, with_next: str, since_ms: int = 0, **fields: Any) -> Callable[[Log], None]:
    def change(log: Log) -> None:
        k = at(log, short, since_ms, **fields)
        m = at(log, with_next, log[k].time_ms, VehicleID=fields["VehicleID"])
        assert m > k
        log[k], log[m] = log[m], log[k]

    return change


def copy_to(
    since_ms: int, to: dict[str, Any], short: str, source: str = "", **fields: Any
) -> Callable[[Log], None]:
    """A copy of the first such message, before the first heartbeat to ICAROUS from this time on."""

    def change(log: Log) -> None:
        one = other(log[at(log, short, **fields)], **to)
        k = at(log, "Heartbeat", since_ms, Direction="Down")
        time_ms = log[k].time_ms
        if "Time" in json.loads(jsonform.to_json(one.body)):
            one = other(one, Time=to.get("Time", time_ms))
        log.insert(k, replace(one, time_ms=time_ms, source=source or one.source))

    return change


def make(since_ms: int, source: str, **data: Any) -> Callable[[Log], None]:
    """A message of its own, before the first heartbeat to ICAROUS from this time on."""

    def change(log: Log) -> None:
        k = at(log, "Heartbeat", since_ms, Direction="Down")
        body = {"Time": log[k].time_ms, **data, "$type": f"CRATOUS/{data['$type']}"}
        topic = f"cratous.{data['$type']}"
        body = jsonform.from_json(json.dumps(body))
        log.insert(k, replace(log[k], source=source, topic=topic, body=body))

    return change


def deaf(log: Log) -> None:
    """No heartbeat of vehicle 1 is heard from 10 s to 15 s."""
    log[:] = [
        one
        for one in log
        if not (
            one.topic.endswith(".Heartbeat")
            and 10_000 <= one.time_ms <= 15_000
            and (one.body.VehicleID, one.body.Direction.name) == (1, "Up")
        )
    ]


def cut_short(log: Log) -> None:
    del log[at(log, "MissionEnd") :]


def after_the_end(log: Log) -> None:
    k = at(log, "GatedCommand")
    log.append(replace(log[k], seq=log[-1].seq + 1, time_ms=log[-1].time_ms))


def time_goes_back(log: Log) -> None:
    k = at(log, "GatedCommand", 30_000)
    log[k] = replace(log[k], time_ms=20_000)


def days_later(log: Log) -> None:
    log[-1] = replace(log[-1], time_ms=2**62)
