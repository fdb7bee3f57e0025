"""Events of the chains: start of a plan, end of a track, failure of a task.

Each function returns the executive's state that results, and appends the messages to send to `out`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from cratous.core.authority.timeliness import too_early
from cratous.core.executive.steps import end_passed, falls_with, may_begin, way_act
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.polylines import Track
from cratous.core.routing.visibility import name_of
from cratous.services.flight import chain as chains
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.commands import task_progress
from cratous.services.flight.dynamics import turn_radius_m
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.messages import Say
from cratous.services.flight.notices import mission_change
from cratous.services.flight.omitted_tasks import awaited, leave_out, nothing_of
from cratous.services.flight.remaining_path import last_lap
from cratous.services.flight.task_states import life
from cratous.services.flight.timing import closed_by
from cratous.spec.algebra.partial import waits_for
from cratous.spec.constraint_rows import Row
from cratous.spec.executive import FAIL_TASK, GO_ON, LAP, LAST_LAP, START
from cratous.spec.mission import TaskKind, Vehicle
from cratous.spec.mission.plan import PlanItem, in_part_of
from cratous.spec.records import replace

EARLY_MS = 500
"""A planned wait may end this much early [ms]; the rows themselves are not relaxed."""
NO_WAY = "no way there keeps the zones"
NO_HOLD = "it would have to wait, and no circle at its start keeps the zones"
NO_CIRCLE = "no circle there or near keeps the zones: it circles across them"
NO_WAY_OUT = (
    "no way that keeps the zones was found to a circle that does: it crosses them on the way there"
)
NAME = "uxas/executive"
"""Sender of the executive's own messages."""


def progress(chain: Chain, at_ms: int, phase: str, note: str = "", served: float = 0.0) -> Say:
    """State of a chain's present task as a `TaskProgress`. served: flown fraction of its path."""
    assert chain.item is not None
    task, vid = chain.item.task_id, chain.vehicle.id
    return Say(task_progress(task, vid, at_ms, phase, served, note), NAME)


def begin(config: Config, state: State, out: Out) -> State:
    """Start every vehicle on the plan in force. Tasks that the plan leaves out fail by name, or wait."""
    settled = (dict(state.starts), dict(state.ends), dict(state.failed))
    before, chains = dict(state.left_out), state.by_vehicle()
    until = awaited(state.to_come)
    left, said = leave_out(state.plan, settled, before, chains, state.now_ms, until)
    out.extend(Say(body, NAME) for body in said)
    state = replace(state, left_out=tuple(left.items()))
    for vehicle in state.mission.vehicles:
        air, items = state.from_where(vehicle.id), _items(state, vehicle)
        track = Track((air.position,), air.heading_rad)
        chain = Chain(vehicle, items, -1, Phase.DONE, track, air.speed_m_s)
        old = state.find(vehicle.id)
        if old is not None:
            chain = replace(chain, version=old.version, suspended=old.suspended, leg=old.leg)
            chain = replace(chain, unlinked=old.unlinked)
            if old.holds is not None:
                state, kept = held_on(state, old, chain, out)
                if kept:
                    continue
        state = next_item(config, state.put(chain), chain, state.now_ms, out)
    return settle(config, state, out)


def held_on(state: State, old: Chain, chain: Chain, out: Out) -> tuple[State, bool]:
    """The state, and whether a vehicle that holds keeps holding under a new plan.

    It does not if a zone in force breaks its way or its circle, or if it is on the ground. chain: its chain
    in the new plan.
    """
    vid, failed = old.vehicle.id, dict(state.failed)
    if vid in dict(state.landed):
        return state, False
    bad = first_bad_leg((state.air(vid).position, *old.track.rest(old.s_m)), state.zones)
    if bad is not None:
        why = f"its way or its circle breaks {name_of(bad[1])}: it flies by the plan"
        out.append(Say(mission_change(state.now_ms, f"vehicle {vid} holds no longer", why), NAME))
        return state, False
    k = chain.next_k(failed)
    number = chain.items[k].task_id if k < len(chain.items) else None
    on = replace(
        old, vehicle=chain.vehicle, items=chain.items, k=k, left=None,
        route_version=old.route_version + 1, leg=old.leg.to(number, state.now_ms),
    )  # fmt: skip
    return state.put(on), True


def _items(state: State, vehicle: Vehicle) -> tuple[PlanItem, ...]:
    radius = chains.ROUTE_MARGIN * turn_radius_m(vehicle.speed_m_s, vehicle.max_bank_rad)
    items = state.plan.chain(vehicle.id)
    return tuple(chains.with_hold(item, radius, state.zones) for item in items)


def settle(config: Config, state: State, out: Out) -> State:
    """Handle all ends of tracks passed up to now, the earliest first."""
    passed, tracks = dict[int, int | None](), dict[int, int]()
    new = sorted(c.vehicle.id for c in state.chains)
    # a vehicle on the ground passes no more ends, nor does one whose takeover UxAS was not told
    others = {*dict(state.landed), *dict(state.under_icarous)}
    while True:
        for vid in new:
            if not state.chain(vid).suspended and vid not in others:
                state, passed[vid] = _measure(config, state, vid)
                tracks[vid] = state.chain(vid).version
        due = [(at, vid) for vid, at in passed.items() if at is not None]
        if not due:
            return state
        at, vid = min(due)
        state = _on_end(config, state, state.chain(vid), at, out)
        # a failure may put other vehicles on new tracks, whose ends are checked again
        new = [v for v in tracks if v == vid or state.chain(v).version != tracks[v]]


def _measure(config: Config, state: State, vehicle_id: int) -> tuple[State, int | None]:
    """The state with a vehicle's progress updated, and when the end of its track was passed [ms]; None if it
    was not.
    """
    air = state.air(vehicle_id)
    chain, at_ms = state.chain(vehicle_id).measure(air, state.now_ms, config.dt_s)
    return state.put(chain), None if at_ms is None else _at_its_end(state, chain, at_ms)


def _at_its_end(state: State, chain: Chain, at_ms: int) -> int | None:
    """When the end of a track counts as passed [ms]; None: not in this step.

    A circle is flown slightly inside, so its end comes slightly early: a loiter that would end in this step
    or the next is extended to its full duration.
    """
    item = chain.item
    if item is None or chain.phase is not Phase.TASK:
        return at_ms
    task = state.mission.task(item.task_id)
    if task.kind is not TaskKind.LOITER:
        return at_ms
    until_ms = dict(state.starts)[task.id] + task.duration_ms
    if too_early(state.now_ms, until_ms, state.mission.simulation.step_ms):
        return at_ms
    return None if too_early(state.now_ms, until_ms, 0) else max(at_ms, until_ms)


def _on_end(config: Config, state: State, chain: Chain, at_ms: int, out: Out) -> State:
    """Act on the passed end of the present track as the kernel `end_passed` decides."""
    item = chain.item
    row, opens = _may_begin(state, chain, at_ms)
    more = chain.next_k(dict(state.failed)) < len(chain.items)
    moved = end_passed(chain.phase, chain.suspended, opens, more)
    if item is None or moved.act == LAST_LAP:
        return state.put(chain.enter(Phase(moved.phase), Track(last_lap(chain)), at_ms))
    if moved.act == GO_ON:
        part = next((p for p in in_part_of(state.plan) if p.task_id == item.task_id), None)
        share = 1.0 if part is None else math.floor(1000 * part.share) / 1000
        told = "" if part is None else f"in part: {part.text}"
        out.append(progress(chain, at_ms, "Complete", told, share))
        state = state.ended(item.task_id, at_ms, whole=part is None)
        return next_item(config, state, chain, at_ms, out)
    if moved.act == START:
        return _start(state, chain, item, at_ms, out)
    if moved.act == LAP:
        lap = config.ways(state.zones).lap(chain, item)
        if lap is None:
            return fail(config, state, item.task_id, NO_HOLD, out)
        entered = chain.enter(Phase.WAIT, lap, at_ms)
        if chain.phase is not Phase.WAIT:
            note = row.text if row is not None else f"planned start at {item.start_ms} ms"
            out.append(progress(entered, at_ms, "Waiting", note))
        return state.put(entered)
    return state


def _may_begin(state: State, chain: Chain, at_ms: int) -> tuple[Row | None, bool]:
    """Whether the task of a vehicle at its start pose may begin, and a row that forbids it."""
    item = chain.item
    if item is None or chain.phase is Phase.TASK:
        return None, False
    starts, ends, failed = dict(state.starts), dict(state.ends), dict(state.failed)
    row = closed_by(item.task_id, at_ms, state.plan.rows, state.counted_starts(), ends)
    early = item.wait_ms != 0 and too_early(at_ms, item.start_ms, EARLY_MS)
    return row, may_begin(life(item.task_id, starts, ends, failed), row is None, early)


def _start(state: State, chain: Chain, item: PlanItem, at_ms: int, out: Out) -> State:
    """Begin the task at its start pose."""
    track = Track(item.path, chains.start_pose(item).heading_rad)
    chain = replace(chain, speed_m_s=item.speed_m_s).enter(Phase.TASK, track, at_ms)
    out.append(progress(chain, at_ms, "Active"))
    return state.begun(item.task_id, at_ms).put(chain)


def next_item(config: Config, state: State, chain: Chain, at_ms: int, out: Out) -> State:
    """Start towards the next item that has not failed; circle where there is none.

    An item that no route reaches within the zones fails.
    """
    chain = replace(chain, k=chain.next_k(dict(state.failed)))
    item, air = chain.item, state.from_where(chain.vehicle.id)
    chain = replace(chain, leg=chain.leg.to(item.task_id if item else None, at_ms))
    state = state.put(chain)
    if item is None:
        return _loiter(config, state, chain, at_ms, out)
    chain = replace(chain, speed_m_s=item.speed_m_s)
    way = config.ways(state.zones).transit(chain, air)
    if way is None or way_act(way is not None, True) == FAIL_TASK:
        state = state.put(replace(chain, phase=Phase.TRANSIT))
        return fail(config, state, item.task_id, NO_WAY, out)
    chain = chain.enter(Phase.TRANSIT, way, at_ms)
    out.append(progress(chain, at_ms, "Transit"))
    return state.put(chain)


def _loiter(config: Config, state: State, chain: Chain, at_ms: int, out: Out) -> State:
    """Circle at the end of the chain, in a layer of its own while others still fly.

    The layer is one and a half buffered vertical thresholds per finished vehicle, in order of finishing, so
    that a finished vehicle stays clear of the others.
    """
    finished, vid = state.finished + 1, chain.vehicle.id
    if vid in dict(state.landed):
        air = state.air(vid)
        return state.put(chain.enter(Phase.DONE, Track((air.position,), air.heading_rad), at_ms))
    others = any(c.item is not None for c in state.chains if c.vehicle.id != vid)
    daa = state.mission.daa
    layer = 1.5 * daa.buffer * daa.well_clear.zthr_m * finished
    chain, track = circling(config, state, chain, layer if others else 0.0, out)
    return replace(state.put(chain.enter(Phase.DONE, track, at_ms)), finished=finished)


def circling(
    config: Config, state: State, chain: Chain, layer_m: float, out: Out
) -> tuple[Chain, Track]:
    """The circle of a vehicle with nothing left to fly, raised by layer_m [m], and its chain at the speed for
    it. A violation of a zone is reported.
    """
    vid = chain.vehicle.id
    last = config.ways(state.zones).last(chain, state.from_where(vid), layer_m)
    if not (last.kept and last.way_kept):
        what = f"vehicle {vid} has nothing left to fly"
        told = NO_WAY_OUT if last.kept else NO_CIRCLE
        out.append(Say(mission_change(state.now_ms, what, told), NAME))
    if last.speed_m_s is None:
        return chain, last.track
    return replace(chain, speed_m_s=last.speed_m_s), last.track


def fail(config: Config, state: State, task_id: int, why: str, out: Out) -> State:
    """Fail a task by name, and with it the tasks that can then never begin."""
    state, now_ms = state.has_failed(task_id, why), state.now_ms
    for vid in sorted(c.vehicle.id for c in state.chains):
        chain = state.chain(vid)
        item = chain.item
        if task_id not in [i.task_id for i in chain.items]:
            continue
        served = chain.by_plan().served() if item and item.task_id == task_id else 0.0
        out.append(Say(task_progress(task_id, vid, now_ms, "Failed", served, why), NAME))
        if item is not None and item.task_id == task_id:
            if chain.holds is not None:
                state = state.put(replace(chain, k=chain.next_k(dict(state.failed)), left=None))
                continue
            state = next_item(config, state, chain, now_ms, out)
    for row in state.plan.rows:
        failed = dict(state.failed)
        lived = life(row.i, dict(state.starts), dict(state.ends), failed)
        waits = task_id in row.group and waits_for(row, set(row.group) - failed.keys())
        if falls_with(row.kind, waits, lived):
            state = fail(config, state, row.i, f"{row.text}: task {task_id} failed", out)
    return state


def give_up(config: Config, state: State, asked: Iterable[tuple[int, str]], out: Out) -> State:
    """No remaining task can be done: each task asked for fails by name, with its reason."""
    return begin(config, replace(state, plan=nothing_of(state.plan, asked)), out)
