"""Logs in which one assumption each is broken, made of flights in which all hold."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

from assumption_logs import LIMIT_MS, WHOLE, Change, flown
from flight_tools import meeting
from tampering import (
    Log,
    alter,
    at,
    copy_to,
    days_later,
    other,
    remove,
    send_as,
    time_goes_back,
)

from cratous.bridge import lmcp
from cratous.services.assumptions.listing import LISTING
from cratous.services.mission.leg_bounds import MOST_TAKEOVERS
from cratous.spec.mission import (
    FaultySimulation,
    Mission,
    Velocity,
)
from cratous.spec.mission.bridge_faults import BridgeFaults

WATCHED = {one.name for one in LISTING}
STILL = Velocity(0.0, 0.0, 0.0)


def with_faults(**faults: Any) -> Mission:
    simulation = FaultySimulation(limit_ms=150_000, bridge_faults=BridgeFaults(1, **faults))
    return replace(meeting(), simulation=simulation)


TAKEN = {"VehicleID": 1, "Owner": "ICAROUS", "Epoch": 1}
BY_ICAROUS = {"VehicleID": 1, "Sender": "ICAROUS"}


def taken_ms() -> int:
    return (log := list(flown(WHOLE)))[at(log, "GateState", **TAKEN)].time_ms


def aside(number: int, since_ms: int, **off: float) -> Change:
    """An aircraft is elsewhere at the first sample after an instant."""

    def change(log: Log) -> None:
        k = at(log, "TruthState", since_ms, VehicleID=number)
        body = log[k].body
        log[k] = other(log[k], **{key: getattr(body, key) + by for key, by in off.items()})

    return change


def no_beats(log: Log) -> None:
    log[:] = [
        one
        for one in log
        if not (
            one.topic.endswith(".Heartbeat")
            and one.time_ms == 10_000
            and one.body.Direction.name == "Down"
        )
    ]


def late_beat(log: Log) -> None:
    """The heartbeat of 10 s comes from ICAROUS at 12 s."""
    k = at(log, "Heartbeat", 10_000, Direction="Up")
    one = log.pop(k)
    m = at(log, "Heartbeat", 12_000, Direction="Up")
    log.insert(m, replace(other(one, Time=12_000), time_ms=12_000))


def bare(log: Log) -> None:
    k = at(log, "GatedCommand", 5000)
    command = copy.deepcopy(log[k].body.Command)
    topic = lmcp.full_names(command)[0]
    log.insert(k + 1, replace(log[k], topic=topic, body=command))


def sent(log: Log, since_ms: int, source: str, **data: Any) -> None:
    """A message of its own, before the first sample from an instant on."""
    k = at(log, "TruthState", since_ms)
    kind = data.pop("kind")
    body = lmcp.new(kind, **data)
    where = replace(log[k], source=source, topic=lmcp.full_names(body)[0], body=body)
    log.insert(k, where)


def while_suspended(log: Log) -> None:
    sent(log, 20_000, "uxas/ics", kind="cratous.TaskProgress", TaskID=1, VehicleID=1, Time=20_000,
         Phase="Suspended")  # fmt: skip
    sent(log, 21_000, "uxas/executive", kind="GatedCommand", VehicleID=1, Epoch=0, Sender="UxAS")


def not_taken(log: Log) -> None:
    """UxAS takes the offer five seconds after it was made."""
    k = at(log, "GateState", VehicleID=1, Offered=True)
    now_ms = log[k].time_ms
    later = [o for o in log[k + 1 :] if o.time_ms == now_ms and o.topic.endswith("GateState")]
    assert len(later) == 1
    log.remove(later[0])
    m = at(log, "TruthState", now_ms + 5000)
    log.insert(m, replace(other(later[0], Time=log[m].time_ms), time_ms=log[m].time_ms))


def told_late(log: Log) -> None:
    """UxAS sends a command in epoch 0 four seconds after ICAROUS has taken the vehicle."""
    sent(log, taken_ms() + 4000, "uxas/executive", kind="GatedCommand", VehicleID=1, Epoch=0,
         Sender="UxAS")  # fmt: skip


def flown_again(log: Log) -> None:
    k = at(log, "TaskProgress", Phase="Complete")
    log.insert(k + 1, other(log[k], Phase="Active"))


def seen_elsewhere(log: Log) -> None:
    sent(log, 20_000, "vehicle/1", kind="cratous.SensedState", ObserverID=1, TrackID=90, VehicleID=90,
         Time=20_000, HorizontalBound=9.0, VerticalBound=9.0)  # fmt: skip


def beats_of_icarous(log: Log) -> None:
    remove("GatedCommand", taken_ms() + 5000, **BY_ICAROUS)(log)


def taken_twice(log: Log) -> None:
    k = at(log, "AuthorityChange", **TAKEN)
    again = other(log[k], Time=log[k].time_ms + 250)
    log.insert(at(log, "TruthState", log[k].time_ms + 250), replace(again, time_ms=again.body.Time))


def still_away(log: Log) -> None:
    """The handback is taken out: the flight ended while ICAROUS had the vehicle."""
    remove("AuthorityChange", taken_ms() + 1, VehicleID=1, Owner="UxAS")(log)


def never_offered(log: Log) -> None:
    """ICAROUS keeps the vehicle up to the end."""
    for _ in range(2):
        remove("GateState", taken_ms() + 1, VehicleID=1)(log)


def overlooked(log: Log, at_ms: int = 10_000) -> None:
    """Another aircraft, which nobody has told ICAROUS of, flies straight through vehicle 1 at an instant."""
    there = log[at(log, "TruthState", at_ms, VehicleID=1)]
    found: Log = []
    for one in log:
        if one.topic.endswith("TruthState") and one.body.VehicleID == 1:
            s = (one.time_ms - there.time_ms) / 1000
            place = {"North": there.body.North + 50.0 * s, "East": there.body.East - 40.0 * s}
            speed = {"VelocityNorth": 50.0, "VelocityEast": -40.0, "VelocityDown": 0.0}
            body = {"VehicleID": 91, "Altitude": there.body.Altitude, **place, **speed}
            found.append(other(one, **body))
        found.append(one)
    log[:] = found


def taken_often(log: Log) -> None:
    """ICAROUS has taken vehicle 1 over once more than is allowed before it takes it over."""
    one = log[at(log, "GateState", **TAKEN)]
    for k in range(MOST_TAKEOVERS + 1):
        for owner, at_ms in (("ICAROUS", 1000 * (k + 1)), ("UxAS", 1000 * (k + 1) + 500)):
            m = at(log, "TruthState", at_ms)
            told = other(one, Owner=owner, Time=log[m].time_ms)
            log.insert(m, replace(told, time_ms=log[m].time_ms))


def late_complete(log: Log) -> None:
    """The task is complete a second before the limit."""
    one = log.pop(at(log, "TaskProgress", Phase="Complete"))
    late_ms = LIMIT_MS - 1000
    log.insert(at(log, "MissionEnd"), replace(other(one, Time=late_ms), time_ms=late_ms))


def failed_otherwise(log: Log) -> None:
    k = at(log, "TaskProgress", Phase="Complete")
    log[k] = other(log[k], Phase="Failed", Note="no way keeps the zones")


OFFERED = {"VehicleID": 1, "Offered": True}
BREAKS: dict[str, tuple[Change, str]] = {
    "first command": (alter({"Sender": "ICAROUS"}, "GatedCommand"), "one of ICAROUS in epoch 0"),
    "reports of the gate": (send_as("icarous/1", "GateState", **TAKEN), "by icarous/1"),
    "epochs told": (copy_to(5000, {"Epoch": 9}, "GatedCommand"), "in epoch 9; the gate is in 0"),
    "epochs kept": (alter({"Epoch": 0}, "GateState", **OFFERED), "from epoch 1 to 0"),
    "commands by the gate alone": (bare, "Command to vehicle 1 outside of its gate"),
    "ICAROUS at each heartbeat": (beats_of_icarous, "no command of ICAROUS between"),
    "suspended": (while_suspended, "while its flying of the vehicle was suspended"),
    "clock": (time_goes_back, "a GatedCommand of 20.00 s after a message of"),
    "heartbeat period": (no_beats, "no heartbeat to the ICAROUS of 1 from 9.50 s to 10."),
    "delivery from ICAROUS": (late_beat, "heartbeat 21 of 10.00 s had not come by 11."),
    "delivery to ICAROUS": (
        lambda log: sent(
            log,
            20_000,
            "icarous/1",
            kind="UxasHeard",
            VehicleID=1,
            Time=20_000,
            Heard=False,
            Last=17_500,
        ),
        "no line of UxAS reached the ICAROUS of 1 from 17.50 s to 20.00 s",
    ),
    "way back free": (never_offered, "heard UxAS, and offered nothing"),
    "permitted as offered": (overlooked, "above or below aircraft 91, though at the heartbeat of"),
    "offers taken": (not_taken, "had not been taken by"),
    "takeovers told": (told_late, "a command of UxAS in epoch 0; epoch 1 began at"),
    "end of the flight": (days_later, "a MissionEnd at"),
    "vehicles away counted": (still_away, "ended as complete while vehicle 1 was under ICAROUS"),
    "items given up": (taken_twice, "vehicle 1 was taken over twice between two heartbeats"),
    "stays bounded": (taken_often, "was taken over 13 times on its way to task 1"),
    "flown in time": (late_complete, "UxAS flew the chain of vehicle 1 for"),
    "no other failure": (failed_otherwise, "task 1 failed: no way keeps the zones"),
    "settled tasks": (flown_again, "task 1 is active after it was complete"),
    "intruder in its tube": (
        lambda log: aside(90, taken_ms() + 3000, East=20.0)(log),
        "aircraft 90, which 1 avoids, is 20 m beside",
    ),
    "tracking": (
        lambda log: aside(1, taken_ms() + 3000, Altitude=5.0)(log),
        "m beside and 5 m above or below the path",
    ),
    "flown as looked at": (aside(90, 10_000, East=20.0), "if it had flown straight on from"),
    "sensed within its bound": (seen_elsewhere, "what 1 sensed of aircraft 90 is"),
}
