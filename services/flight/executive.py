"""Flies a plan: transit, wait while the gate in time is closed, task; for all vehicles at once.

A task starts when its vehicle passes the start pose and every lower bound of the plan's rows
holds for the REAL times of the others; until then the vehicle circles on its hold. While it
comes near, it adapts its speed a little so as to pass the start pose just when it may. Events of
all vehicles are handled in the order of their instants within a step. A delay that breaks an
upper bound leads to a new plan for the tasks that are left, and if there is none to a named
failure of the task.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from cratous.core.authority.gate import UXAS
from cratous.core.authority.link_end import suspended_after, track_is_told
from cratous.core.authority.timeliness import too_early
from cratous.core.executive.steps import end_passed, late_act, may_begin
from cratous.core.routing.polylines import Track
from cratous.services.flight import chain as chains
from cratous.services.flight.ahead import last_lap, leaving_m, points_ahead, points_left
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.commands import gated, path_command, task_progress
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.expectation import expected_times
from cratous.services.flight.left_out import leave_out, nothing_of
from cratous.services.flight.lives import life
from cratous.services.flight.messages import Flown, Route
from cratous.services.flight.pace import FASTEST, broken_rows, trimmed_speed_m_s
from cratous.services.flight.timing import closed_by, opens_ms
from cratous.services.flight.ways import Ways
from cratous.services.mission.frames import Projection
from cratous.spec.algebra.partial import waits_for
from cratous.spec.constraint_rows import Row
from cratous.spec.executive import GO_ON, LAP, LAST_LAP, PLAN_ANEW, STANDS_BY, START
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Plan, PlanItem, left_out_of

AHEAD_S = 30
"""Waypoints are told at least this much farther than the look-ahead [s]."""
EARLY_MS = 500
"""A planned wait may end this much early; the rows themselves are never bent."""
OPEN_MARGIN_MS = 60
"""Aim this much later than the predicted opening, so that rounding never costs a lap."""

Replan = Callable[[dict[int, AirState], frozenset[int], int], Plan | None]


@dataclass
class Executive:
    """The UxAS side of the flight: chains by vehicle, real times, and the rows in force.

    zones: the mission's, with their padding already turned into vertices.
    """

    mission: Mission
    zones: tuple[Zone, ...]
    plan: Plan
    projection: Projection
    dt_s: float
    replan: Replan | None = None
    chains: dict[int, Chain] = field(default_factory=dict)
    starts: dict[int, int] = field(default_factory=dict)
    ends: dict[int, int] = field(default_factory=dict)
    failed: dict[int, str] = field(default_factory=dict)
    left_out: dict[int, str] = field(default_factory=dict)
    commands: int = 0
    replans: int = 0
    finished: int = 0
    hurry: bool = False

    def __post_init__(self) -> None:
        self.ways = Ways(self.zones, self.dt_s)

    def begin(self, states: dict[int, AirState], now_ms: int = 0) -> list[Any]:
        """Set every vehicle on its way; the first messages. What the plan leaves out fails."""
        settled = (self.starts, self.ends, self.failed)
        self.left_out, out = leave_out(self.plan, settled, self.left_out, self.chains, now_ms)
        for vehicle in self.mission.vehicles:
            state = states[vehicle.id]
            items = self._items(vehicle.id)
            track = Track((state.position,), state.heading_rad)
            chain = Chain(vehicle, items, -1, Phase.DONE, track, state.speed_m_s)
            old = self.chains.get(vehicle.id)
            if old is not None:
                chain = replace(chain, version=old.version, suspended=old.suspended)
            self._next_item(self._put(chain), now_ms, state, out)
        self._settle(states, now_ms, out)
        return out

    def _put(self, chain: Chain) -> Chain:
        """From now on this is the chain of its vehicle."""
        self.chains[chain.vehicle.id] = chain
        return chain

    def _items(self, vehicle_id: int) -> tuple[Any, ...]:
        vehicle = self.mission.vehicle(vehicle_id)
        radius = chains.ROUTE_MARGIN * turn_radius_m(vehicle.speed_m_s, vehicle.max_bank_rad)
        return tuple(
            chains.with_hold(item, radius, self.zones) for item in self.plan.chain(vehicle_id)
        )

    def step(self, states: dict[int, AirState], epochs: dict[int, int], now_ms: int) -> list[Any]:
        """One step: events since the last one, in time order, then commands for changed tracks."""
        out: list[Any] = []
        before = {vid: chain.version for vid, chain in self.chains.items()}
        self._settle(states, now_ms, out)
        if now_ms % self.mission.simulation.heartbeat_ms == 0:
            self._watch_deadlines(states, now_ms, out)
            for chain in tuple(self.chains.values()):
                self._adapt_speed(chain, now_ms)
        for vid, chain in tuple(self.chains.items()):
            if chain.away and not chain.suspended and chain.s_m >= chain.join_m:
                self._put(replace(chain, away=False))
                note = "back on the path"
                out.append(self._progress(chain, now_ms, "Active", chain.served(), note))
            if track_is_told(chain.suspended, chain.version != before[vid]):
                out.append(self.command(vid, epochs[vid]))
        return out

    def command(self, vehicle_id: int, epoch: int) -> Any:
        """The present track from here on, for the vehicle's gate."""
        chain = self.chains[vehicle_id]
        self.commands += 1
        tasks = (chain.item.task_id,) if chain.item and chain.phase is Phase.TASK else ()
        points, speed = points_left(chain), chain.speed_m_s
        body = path_command(self.projection, vehicle_id, self.commands, points, speed, tasks)
        return gated(vehicle_id, epoch, UXAS, body)

    # events -------------------------------------------------------------------------------

    def _settle(self, states: dict[int, AirState], now_ms: int, out: list[Any]) -> None:
        """Handle every passing of an end up to now, the earliest first."""
        passed: dict[int, int | None] = {}
        for vid in sorted(self.chains):
            if not self.chains[vid].suspended:
                passed[vid] = self._measure(vid, states[vid], now_ms)
        while True:
            due = [(at, vid) for vid, at in passed.items() if at is not None]
            if not due:
                return
            at, vid = min(due)
            self._on_end(self.chains[vid], at, states[vid], out)
            passed[vid] = self._measure(vid, states[vid], now_ms)

    def _measure(self, vehicle_id: int, state: AirState, now_ms: int) -> int | None:
        """The instant at which the end of a track was passed, if it was; the progress is noted."""
        chain, at_ms = self.chains[vehicle_id].measure(state, now_ms, self.dt_s)
        self._put(chain)
        return at_ms

    def _on_end(self, chain: Chain, at_ms: int, state: AirState, out: list[Any]) -> None:
        """The end of the present track has been passed: what the kernel `end_passed` answers."""
        item = chain.item
        row, opens = self._may_begin(chain, at_ms)
        more = chain.next_k(self.failed) < len(chain.items)
        moved = end_passed(chain.phase, chain.suspended, opens, more)
        if item is None or moved.act == LAST_LAP:
            self._put(chain.enter(Phase(moved.phase), Track(last_lap(chain)), at_ms))
        elif moved.act == GO_ON:
            self.ends[item.task_id] = at_ms
            out.append(self._progress(chain, at_ms, "Complete", 1.0, ""))
            self._next_item(chain, at_ms, state, out)
        elif moved.act == START:
            self._start(chain, item, at_ms, out)
        elif moved.act == LAP:
            self._lap(chain, item, at_ms, row, out)

    def _next_item(self, chain: Chain, at_ms: int, state: AirState, out: list[Any]) -> None:
        chain = self._put(replace(chain, k=chain.next_k(self.failed)))
        item = chain.item
        if item is None:
            self._loiter(chain, at_ms, state)
            return
        chain = replace(chain, speed_m_s=item.speed_m_s)
        chain = self._put(chain.enter(Phase.TRANSIT, self.ways.transit(chain, state), at_ms))
        out.append(self._progress(chain, at_ms, "Transit", 0.0, ""))

    def _loiter(self, chain: Chain, at_ms: int, state: AirState) -> None:
        """Circle at the end of the chain; raised to a layer of its own while others still fly.

        The layer is one and a half buffered vertical thresholds per vehicle, in the order of
        finishing, so that one who has finished is in nobody's way.
        """
        self.finished += 1
        others = any(c.item is not None for c in self.chains.values() if c is not chain)
        daa = self.mission.daa
        layer = 1.5 * daa.buffer * daa.well_clear.zthr_m * self.finished
        track = self.ways.last(chain, state, layer if others else 0.0)
        self._put(chain.enter(Phase.DONE, track, at_ms))

    def _may_begin(self, chain: Chain, at_ms: int) -> tuple[Row | None, bool]:
        """Whether the task of a vehicle at its start pose may begin, and a row that forbids it."""
        item = chain.item
        if item is None or chain.phase is Phase.TASK:
            return None, False
        row = closed_by(item.task_id, at_ms, self.plan.rows, self.starts, self.ends)
        early = item.wait_ms != 0 and too_early(at_ms, item.start_ms, EARLY_MS)
        now = life(item.task_id, self.starts, self.ends, self.failed)
        return row, may_begin(now, row is None, early)

    def _start(self, chain: Chain, item: PlanItem, at_ms: int, out: list[Any]) -> None:
        """At the start pose: begin the task."""
        self.starts[item.task_id] = at_ms
        track = Track(item.path, chains.start_pose(item).heading_rad)
        chain = replace(chain, speed_m_s=item.speed_m_s).enter(Phase.TASK, track, at_ms)
        self._put(chain)
        out.append(self._progress(chain, at_ms, "Active", 0.0, ""))

    def _lap(
        self, chain: Chain, item: PlanItem, at_ms: int, row: Row | None, out: list[Any]
    ) -> None:
        """At the start pose: fly a lap of the hold. row: one that forbids to begin, if one does."""
        first = chain.phase is not Phase.WAIT
        chain = self._put(chain.enter(Phase.WAIT, self.ways.lap(chain, item), at_ms))
        if first:
            note = row.text if row is not None else f"planned start at {item.start_ms} ms"
            out.append(self._progress(chain, at_ms, "Waiting", 0.0, note))

    # interruption ---------------------------------------------------------------------------

    def suspend(self, vehicle_id: int, now_ms: int, act: int) -> tuple[list[Any], Position | None]:
        """ICAROUS has taken over: messages, and the resume point if a task was active."""
        chain = self.chains[vehicle_id]
        if chain.suspended:
            return [], self.resume_point(vehicle_id)
        chain = self._put(replace(chain, suspended=suspended_after(chain.suspended, act)))
        if chain.phase is not Phase.TASK:
            return [], None
        if chain.away:
            return [], self.resume_point(vehicle_id)
        note = f"left the path at {chain.path_flown_m():.0f} m"
        return [
            self._progress(chain, now_ms, "Suspended", chain.served(), note)
        ], self.resume_point(vehicle_id)

    def resume_point(self, vehicle_id: int) -> Position | None:
        """Where the path was left, if a task was active: the sensor misses nothing."""
        chain = self.chains[vehicle_id]
        if chain.phase is not Phase.TASK:
            return None
        return chain.track.at(leaving_m(chain))

    def resume(self, vehicle_id: int, state: AirState, now_ms: int, act: int) -> None:
        """ICAROUS hands back: route to the resume point, then along the rest of the path."""
        chain = self.chains[vehicle_id]
        chain = replace(chain, suspended=suspended_after(chain.suspended, act))
        back = self.ways.back(chain, state)
        chain = chain.enter(chain.phase, back.track, now_ms)
        if chain.phase is Phase.TASK:
            chain = replace(chain, join_m=back.join_m, base_m=back.flown_m, away=True)
        self._put(chain)

    # timing -----------------------------------------------------------------------------------

    def expected(self, factor: float, now_ms: int) -> tuple[dict[int, int], dict[int, int]]:
        """Expected starts and ends of all tasks, ways flown at `factor` times the planned speed."""
        return expected_times(
            self.chains, self.plan.rows, self.starts, self.ends, self.failed, factor, now_ms
        )

    def _adapt_speed(self, chain: Chain, now_ms: int) -> None:
        """Slow down or speed up so as to pass the start pose when the task may begin."""
        item = chain.item
        if item is None or chain.suspended or chain.phase not in (Phase.TRANSIT, Phase.WAIT):
            return
        target, left = self._opens_ms(item, now_ms, OPEN_MARGIN_MS), chain.left_m()
        speed = trimmed_speed_m_s(item, chain.vehicle, left, target - now_ms, self.hurry)
        if abs(speed - chain.speed_m_s) > 0.02 * item.speed_m_s or (
            left < 10 * item.speed_m_s and abs(speed - chain.speed_m_s) > 0.002 * item.speed_m_s
        ):
            self._put(replace(chain, speed_m_s=speed, version=chain.version + 1))

    def _watch_deadlines(self, states: dict[int, AirState], now_ms: int, out: list[Any]) -> None:
        """Find an upper bound that not even the fastest flight can keep; plan anew or fail."""
        self.hurry = bool(self._broken(1.0, now_ms))
        if not self.hurry:
            return
        for task_id, row in self._broken(FASTEST, now_ms):
            under_way = any(
                c.phase is Phase.TASK and c.item is not None and c.item.task_id == task_id
                for c in self.chains.values()
            )
            torn = any(c.suspended or c.phase is Phase.TASK for c in self.chains.values())
            act = late_act(under_way, self.replan is not None, torn)
            if act == STANDS_BY:
                continue
            if act == PLAN_ANEW and self.plan_anew(states, now_ms, row.text, out):
                return
            self._fail(task_id, now_ms, f"{row.text}: cannot be met any more", states, out)

    def _broken(self, factor: float, now_ms: int) -> list[tuple[int, Row]]:
        """The tasks that are left whose upper bounds break at this pace, with the first row."""
        settled = self.ends.keys() | self.failed.keys()
        return broken_rows(self.plan.rows, *self.expected(factor, now_ms), settled)

    def plan_anew(self, states: dict[int, AirState], now_ms: int, why: str, out: list[Any]) -> bool:
        """A new plan for what is left, from where all are; False if there is none."""
        if self.replan is None:
            return False
        made = self.replan(states, frozenset(self.ends), now_ms)
        if made is None:
            return False
        self.plan = made
        self.replans += 1
        gone = {one.task_id for one in left_out_of(made)}
        for chain in self.chains.values():
            if chain.item is not None and chain.item.task_id not in gone:
                note = f"planned anew, because of {why}"
                out.append(self._progress(chain, now_ms, "Planned", 0.0, note))
        out.extend(self.begin(states, now_ms))
        return True

    def know(self, zones: tuple[Zone, ...]) -> None:
        """These zones bind from now on."""
        self.zones, self.ways = zones, Ways(zones, self.dt_s)
        for chain in tuple(self.chains.values()):
            self._put(replace(chain, told_version=-1))

    def commands_now(self, epochs: dict[int, int]) -> list[Any]:
        """The present tracks, for all that UxAS commands."""
        free = [vid for vid, chain in self.chains.items() if not chain.suspended]
        return [self.command(vid, epochs[vid]) for vid in free]

    def give_up(
        self,
        now_ms: int,
        why: str,
        states: dict[int, AirState],
        asked: Iterable[int],
        out: list[Any],
    ) -> None:
        """Nothing that is left can be done: nobody flies any of it, and all that is asked for fails by
        name."""
        self.plan = nothing_of(self.plan, asked, why)
        out.extend(self.begin(states, now_ms))

    def _fail(
        self, task_id: int, now_ms: int, why: str, states: dict[int, AirState], out: list[Any]
    ) -> None:
        """Name the failure of a task, and of those that can now never begin."""
        self.failed[task_id] = why
        for vid in sorted(self.chains):
            chain = self.chains[vid]
            item = chain.item
            ids = [i.task_id for i in chain.items]
            if task_id not in ids:
                continue
            served = chain.served() if item and item.task_id == task_id else 0.0
            out.append(task_progress(task_id, vid, now_ms, "Failed", served, why))
            if item is not None and item.task_id == task_id:
                self._next_item(chain, now_ms, states[vid], out)
        for row in self.plan.rows:
            waits = task_id in row.group and waits_for(row, set(row.group) - self.failed.keys())
            if waits and row.i not in self.failed and row.i not in self.starts:
                self._fail(row.i, now_ms, f"{row.text}: task {task_id} failed", states, out)

    # reading ----------------------------------------------------------------------------------

    def flying(self) -> int:
        """How many vehicles have items of their chains left."""
        return sum(chain.item is not None for chain in self.chains.values())

    def report(self, vehicle_id: int) -> list[Route | Flown]:
        """How far a vehicle is on the way that UxAS flies it, and the way if it has not been told."""
        chain = self.chains[vehicle_id]
        new = track_is_told(chain.suspended, chain.route_version != chain.told_version)
        out: list[Route | Flown] = [self.route(vehicle_id)] if new else []
        return out if chain.suspended else [*out, Flown(vehicle_id, chain.s_m)]

    def route(self, vehicle_id: int) -> Route:
        """The way ahead: the present track, and what follows for as far as ICAROUS looks."""
        chain = self.chains[vehicle_id]
        chain = self._put(replace(chain, told_version=chain.route_version))
        opens = self._opens_ms(chain.item, chain.since_ms) if chain.item is not None else 0
        ahead_m = chain.vehicle.max_speed_m_s * (self.mission.daa.lookahead_s + AHEAD_S)
        speed = chain.item.speed_m_s if chain.item else chain.speed_m_s
        return Route(vehicle_id, points_ahead(chain, opens, ahead_m), speed, chain.s_m)

    def _opens_ms(self, item: PlanItem, now_ms: int, margin_ms: int = 0) -> int:
        """When an item's task is expected to be allowed to begin, and a margin if it must wait."""
        starts, ends = self.expected(1.0, now_ms)
        starts.pop(item.task_id, None)
        opens = opens_ms(item.task_id, self.plan.rows, starts, ends)
        if opens > 0:
            opens += margin_ms
        return max(opens, item.start_ms) if item.wait_ms > 0 else opens

    def _progress(self, chain: Chain, at_ms: int, phase: str, served: float, note: str) -> Any:
        item = chain.item
        assert item is not None
        return task_progress(item.task_id, chain.vehicle.id, at_ms, phase, served, note)
