"""Mission features that separate processes do not support: refused before anything starts, with the field's
name.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.core.authority.timeliness import lasted
from cratous.services.exporting.differences import apart, spelt_out
from cratous.services.exporting.messages import Told, messages_of
from cratous.services.icarous_communication.unheard import CHOICES, WATCH_MS
from cratous.services.loading import uxas_parts
from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_tasks import Interests
from cratous.services.loading.uxas_tasks import task as read_task
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.merging import merging_of
from cratous.services.mission.moving_zones import moving_zones
from cratous.services.mission.take_off import grounded
from cratous.spec.errors import BadInput
from cratous.spec.mission import FaultySimulation, Mission, TaskKind

COSTS = ("MINMAX", "CUMULATIVE")
UNSAID = frozenset({"protected", "power_w", "camera_id", "cruise_m", "notes"})
"""Fields without a message, or filled in by the reader, that do not affect the flight."""


def told_of(mission: Mission, original: bool = False) -> Told:
    """The messages of a mission; BadInput, which names the field, for what messages or processes do not
    support.

    original: ICAROUS runs behind clients of the original's, which the user starts.
    """
    for item, wrong, what, expected in _asked(mission, original):
        if wrong:
            raise BadInput(
                f"{what}, which separate processes cannot fly",
                where=mission.source,
                item=item,
                expected=f"{expected}, or a run without --processes",
            )
    told = messages_of(mission)
    for item, wanted, got in _differences(mission, told):
        raise BadInput(
            "the messages of UxAS cannot say this",
            where=mission.source,
            item=item,
            expected="what can be told, or a run without --processes",
            got=f"{wanted!r} (told, it would be {got!r})"[:200],
        )
    return told


def refuse_for_amase(mission: Mission) -> None:
    """BadInput for what AMASE cannot be commanded to do over the network; it names the field."""
    asked = [
        (f"vehicles[{k}].min_speed_m_s", not one.min_speed_m_s, "an aircraft that can hover")
        for k, one in enumerate(mission.vehicles)
    ] + [
        (f"traffic[{k}]", bool(one.appears_ms) or one.vanishes_ms is not None,
         "traffic that comes or goes in flight")
        for k, one in enumerate(mission.traffic)
    ]  # fmt: skip
    for item, wrong, what in asked:
        if wrong:
            raise BadInput(
                f"{what}, which AMASE cannot be made to fly over the network",
                where=mission.source,
                item=item,
                expected="a mission without it, or a run without --simulator",
            )


def _asked(mission: Mission, original: bool) -> Iterator[tuple[str, bool, str, str]]:
    """Field, whether it is unsupported, what it requests, and what is supported."""
    moves = bool(moving_zones(mission))
    yield "zones", moves, "a zone moves, which no message of UxAS says", "zones that stand"
    alone = not mission.instances
    yield "vehicles", alone, "no vehicle has an ICAROUS instance", "a protected vehicle"
    changes = mission.changes
    yield "changes", bool(changes), "something becomes known in flight", "no changes"
    faulty = isinstance(mission.simulation, FaultySimulation)
    fails = "the bridge to the original's clients is made to fail"
    yield "simulation.bridge_faults", faulty and original, fails, "no bridge_faults"
    sensed = mission.sensing is not None
    yield "sensing", sensed, "ICAROUS is given what sensors see", "no sensing"
    loss = mission.link_loss
    unflown = loss is not None and loss.choice.value not in CHOICES
    what = "UxAS's end of the bridge flies no landing without the link"
    yield "link_loss.choice", unflown, what, " or ".join(CHOICES)
    deaf = loss is not None and original
    what = "the original's clients have no heartbeat, so their silence does not show"
    yield "link_loss", deaf, what, "no link_loss"
    often = loss is not None and not lasted(0, mission.simulation.heartbeat_ms, WATCH_MS)
    what = f"UxAS's end looks only every {WATCH_MS / 1000:g} s whether it hears an ICAROUS"
    yield "simulation.heartbeat_ms", often, what, f"at least {WATCH_MS}"
    after = on_failure_of(mission) is not None
    yield "on_failure", after, "the mission says what is flown after a failure", "no on_failure"
    merges = merging_of(mission) is not None
    yield "merging", merges, "vehicles merge at a fix", "no merging"
    waits = bool(grounded(mission))
    yield "vehicles.start", waits, "a vehicle starts on the ground", "vehicles in the air"
    high = mission.frame.terrain_m != 0
    yield "frame.terrain_m", high, "the ground is not at mean sea level", "0"
    other = mission.cost not in COSTS
    yield "cost", other, f"the cost {mission.cost} is asked for", " or ".join(COSTS)
    yield "gap", mission.gap != 0, "the search may stop at a gap", "0"
    for k, task in enumerate(mission.tasks):
        pattern = task.kind is TaskKind.PATTERN_SEARCH
        yield f"tasks[{k}].kind", pattern, "a pattern search", "another kind of task"
    for k, one in enumerate(mission.traffic):
        item = f"traffic[{k}]"
        tracked = type(one).__name__ != "Traffic"
        yield f"{item}.waypoints", tracked, "traffic along waypoints", "straight flight"
        climbs = one.velocity.down_m_s != 0
        yield f"{item}.velocity", climbs, "traffic that climbs or descends", "level flight"
        still = not (one.velocity.north_m_s or one.velocity.east_m_s)
        yield f"{item}.velocity", still, "traffic that stands still", "a speed above 0"


def _differences(mission: Mission, told: Told) -> Iterator[tuple[str, Any, Any]]:
    """Fields of vehicles, zones and tasks that change when the messages are read back."""
    places, notes = Places(mission.frame), list[str]()

    def sent(body: Any) -> Sent:
        return Sent(body, "the messages", 0)

    pairs = zip(told.configurations, told.states, strict=True)
    vehicles = tuple(uxas_parts.vehicle(sent(c), sent(s), places, notes) for c, s in pairs)
    zones = [uxas_parts.zone(sent(z), places, mission.frame.terrain_m, notes) for z in told.zones]
    tasks = [read_task(sent(t), places, vehicles, notes, Interests()) for t in told.tasks]
    for name, wanted, got in (
        ("vehicles", mission.vehicles, vehicles),
        ("zones", mission.zones, zones),
        ("tasks", [spelt_out(task) for task in mission.tasks], tasks),
    ):
        for k, (one, other) in enumerate(zip(wanted, got, strict=True)):
            yield from apart(f"{name}[{k}]", one, other, UNSAID)
