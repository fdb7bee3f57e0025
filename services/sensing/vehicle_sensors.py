"""The sensors on one vehicle: measurements in transit, and the own state derived from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.services.sensing import own_state as own_state
from cratous.services.sensing.filter import Flown
from cratous.services.sensing.own_state import Own
from cratous.services.sensing.sensors import Detection, detections
from cratous.spec.mission.sensing import Sensing


class Sensors(NamedTuple):
    """Sensors of one vehicle. seed: of the mission's variant, in addition to their own; step_ms: time since
    the previous step [ms].
    """

    own_id: int
    sensing: Sensing
    seed: int
    step_ms: int


class Carried(NamedTuple):
    """under_way: measurements that have not arrived yet; own: None before the first step, or without a GPS."""

    under_way: tuple[Detection, ...] = ()
    own: Own | None = None


def stepped(
    sensors: Sensors, before: Carried, now_ms: int, aircraft: Mapping[int, Flown]
) -> Carried:
    """The state after a simulation step: new measurements are in transit, and the own state has moved on."""
    sensing, air, own = sensors.sensing, aircraft[sensors.own_id], before.own
    if sensing.gps is not None and own is None:
        own = own_state.first(sensing.gps, now_ms, air)
    elif own is not None:
        fixes = (one.seen.at_ms for one in before.under_way if one.source == sensors.own_id)
        own = own_state.moved(own, now_ms, air, min(fixes, default=now_ms))
    new = detections(sensing, sensors.seed, sensors.own_id, now_ms, sensors.step_ms, aircraft)
    return Carried((*before.under_way, *new), own)


def came(own_id: int, before: Carried, now_ms: int) -> tuple[Carried, tuple[Detection, ...]]:
    """The state after the measurements due by now: fixes correct the own state. Returns also those of others."""
    there, left = list[Detection](), list[Detection]()
    for one in before.under_way:
        (there if lasted(one.due_ms, now_ms, 0) else left).append(one)
    own = before.own
    for one in there:
        if one.source == own_id and own is not None:
            own = own_state.fixed(own, one.seen)
    return Carried(tuple(left), own), tuple(one for one in there if one.source != own_id)
