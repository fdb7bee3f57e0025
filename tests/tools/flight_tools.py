"""Missions that are flown in tests, and what every actor of a flight must hold to."""

from __future__ import annotations

import math
import pickle
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from mission_tools import must_fly, plain_mission

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.bridge.text_protocol import Message
from cratous.services.bus import Bus
from cratous.services.flight.loop import FlightResult, fly
from cratous.services.pipeline.plan import make_plan
from cratous.spec.constraint_rows import NOT_AFTER, Row
from cratous.spec.mission import (
    Daa,
    Mission,
    Position,
    Simulation,
    Task,
    Traffic,
    Vehicle,
    Velocity,
    WellClear,
)
from cratous.spec.mission.plan import Plan

VOLUME = WellClear(150.0, 30.0, 15.0, 0.0)


def vehicle(
    vid: int, north: float, east: float, heading: float = 0.0, speed: float = 22.0
) -> Vehicle:
    """A vehicle 300 m high, with its heading [rad] and speed [m/s]; told nothing, north at 22 m/s."""
    where, bank = Position(north, east, 300.0), math.radians(35)
    return Vehicle(vid, f"UAV {vid}", where, heading, speed, 15.0, 32.0, bank, 3.0, True)


def traffic(north: float, east: float, velocity: Velocity = Velocity(0.0, 22.0, 0.0)) -> Traffic:
    """An intruder, number 90, 300 m high; told nothing else, it flies east at 22 m/s."""
    return Traffic(90, Position(north, east, 300.0), velocity)


def mission_within(
    limit_ms: int, vehicles: tuple[Vehicle, ...], tasks: tuple[Task, ...], **more: Any
) -> Mission:
    """A mission with our volume of well clear and an ICAROUS for each vehicle, flown up to a time [ms]."""
    fields: dict[str, Any] = {
        "daa": Daa(VOLUME),
        "instances": tuple(one.id for one in vehicles),
        "simulation": Simulation(limit_ms=limit_ms),
    }
    return plain_mission(vehicles, tasks, **{**fields, **more})


def meeting() -> Mission:
    """One vehicle flies north to a point; traffic crosses its path at the same time and height."""
    task = must_fly(1, (6000.0, 0.0, 300.0), label="far")
    other = traffic(2640.0, -2640.0)
    return mission_within(400_000, (vehicle(1, 0.0, 0.0),), (task,), name="link", traffic=(other,))


def with_deadline() -> tuple[Mission, Plan]:
    """The same without traffic, and a plan with a row that it cannot keep."""
    mission = replace(meeting(), traffic=())
    plan = make_plan(mission)
    (item,) = plan.items
    row = Row(NOT_AFTER, 1, (), 0, item.end_ms - 60_000, "p1 ends a minute sooner")
    return mission, replace(plan, rows=(*plan.rows, row))


def flown(
    mission: Mission, plan: Plan | None = None, **options: Any
) -> tuple[FlightResult, list[Any]]:
    """The result of a flight, and all bodies that were published."""
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(lambda envelope: log.append(envelope.body))
    return fly(mission, plan or make_plan(mission), bus, **options), log


def told_to_icarous(patch: pytest.MonkeyPatch) -> list[tuple[int, Message]]:
    """What the bridge tells ICAROUS from now on, with the vehicle whose it is."""
    told, send = list[tuple[int, Message]](), Bridge.to_icarous

    def listening(bridge: Bridge, vehicle_id: int, message: Message) -> bool:
        told.append((vehicle_id, message))
        return send(bridge, vehicle_id, message)

    patch.setattr(Bridge, "to_icarous", listening)
    return told


def of_type(log: list[Any], name: str, **fields: Any) -> list[Any]:
    """The bodies of one type, with these values."""
    return [
        body
        for body in log
        if type(body).__name__ == name and all(getattr(body, k) == v for k, v in fields.items())
    ]


def plain_steps(actor: Any, state: Any, messages: Iterable[Any]) -> Iterator[Any]:
    """The state after each message; each step is taken twice and must give the same, and must leave
    the state that it was given as it was."""
    for message in messages:
        before = pickle.dumps(state)
        after, out = actor.handle(state, message)
        assert pickle.dumps(state) == before, f"{type(message).__name__} changes the state"
        again, same = actor.handle(pickle.loads(before), message)
        assert again == after
        assert repr(same) == repr(out)
        assert isinstance(out, tuple)
        state = after
        yield state
