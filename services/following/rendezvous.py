"""The service of a rendezvous: its vehicles pass their states at the same time.

Options, choices and task states work as for a task that follows an entity. A vehicle that reaches its gate
waits in laps beside it until all have begun their routes. Then the common time is set (`common_time`): the
first that all can meet at usual speeds. Each leaves its circle when `pace` and `another_lap` say so, and with
each of its states is commanded the speed for arriving in time (SpeedOverrideAction). A late vehicle shifts
the common time, if the others can wait. The task is complete when all have passed, each within the tolerance.
"""

from __future__ import annotations

import math
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import Vec2
from cratous.core.tasks.rendezvous import (
    Meeting,
    Pace,
    another_lap,
    common_time,
    in_company,
    meeting_step,
    pace,
)
from cratous.core.tasks.stations import in_ring
from cratous.services.bus import Envelope
from cratous.services.following import vehicle_part as parts_of
from cratous.services.following.progress import (
    Progress,
    Way,
    at_gate,
    course_of,
    heard,
    place_of,
    turn_left,
    way_left,
)
from cratous.services.following.rendezvous_options import (
    WAIT,
    Met,
    at_speed,
    is_direct,
    meeting_of,
    offered,
    options_of,
    planned_m_s,
    usual_m_s,
    waiting_circle,
    waits_as,
    ways_of,
)
from cratous.services.following.service import (
    SELECTED,
    SILENT_MS,
    Following,
    FollowingTaskService,
    Step,
)
from cratous.services.following.speeds import Limits, limits_of, wind_of
from cratous.services.following.stations import EARLY, FLY, LATE
from cratous.services.following.vehicle_part import Part
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.off_plan import HANDED_BACK, WITH_UXAS
from cratous.services.pipeline.status import status
from cratous.services.pipeline.task_state import State
from cratous.services.pipeline.tasks import (
    ACTIVE,
    LISTED,
    PUBLISH_OPTIONS,
    UNLISTED,
    WITHDRAWN,
)
from cratous.services.planning.options import Dropped, Option
from cratous.spec.errors import BadInput

NO_END = -1
"""No limit of waiting, as the kernels have it."""
VANISHED_MS = 30_000
"""The others do not wait for a vehicle that is silent for longer [ms]."""
GATE_S = 4.0
"""On a direct route, waiting is commanded no sooner than this before the gate [s]."""


class RendezvousTaskService(FollowingTaskService):
    """One rendezvous."""

    def _found(self, context: Context) -> tuple[list[Option], list[Dropped]]:
        if self._made is None or self._made[0] is not context:
            met, world = self._met(context), self._contexts.world
            task = self._task_in(context)
            found, dropped, self._notes = options_of(context, task, met, world)
            ways = ways_of(met, found)
            if not ways:
                text = f"no {met.needed} vehicles have a state each"
                dropped.append(Dropped(self._task_id, (), "a rendezvous", text))
            self._ways = ways
            self._made = (context, [option for option, _ in found], dropped)
        return self._made[1], self._made[2]

    def _offer(self, context: Context, options: list[Option]) -> Any:
        self._found(context)
        return offered(context, self._task_id, options, self._ways)

    def _do(self, state: State, act: int, body: Any, out: list[Any]) -> tuple[State, int]:
        if act == PUBLISH_OPTIONS:
            self._found(self._context)
            said = [[("reason", text)] for text in self._notes]
            out += [status(self._request, "Warning", facts) for facts in said]
        return super()._do(state, act, body, out)

    def _met(self, context: Context) -> Met:
        return meeting_of(self._body, context.places)

    def _limits(self, part: Part) -> Limits:
        vehicles = part.context.inputs.mission.vehicles
        return limits_of(next(v for v in vehicles if v.id == part.vehicle))

    def _plan(self, request: Any, response: Any) -> list[Any]:
        made, *more = super()._plan(request, response)
        return [at_speed(made, planned_m_s(self._option(request))), *more]

    # what is flown

    def _asked_for(self, state: Following, envelope: Envelope, now_ms: int) -> Step:
        """Process a request that ends the rendezvous: waiting vehicles continue their plans."""
        after, out = super()._asked_for(state, envelope, now_ms)
        return after, out if after is state else [*out, *self._sent(state)]

    def _planned(self, state: Following, response: Any) -> Step:
        before = len(state.parts)
        state, out = super()._planned(state, response)
        if state.meeting is not None and len(state.parts) < before:
            return self._undone(state, "a plan without it came", out)
        return state, out

    def _told(self, state: Following, body: Any) -> Step:
        """Process a vehicle's state: its task state, its progress, and whether all have met."""
        now_ms = max(state.now_ms, body.Time, 0)
        state = heard(state, body.ID, now_ms)
        part = next((p for p in state.parts if p.vehicle == body.ID), None)
        if part is None or part.state.task.state < SELECTED:
            return state, []
        silent = self._silent(state)
        if silent is not None:
            text = f"vehicle {silent.vehicle} was not heard for {VANISHED_MS // 1000} s"
            return self._undone(state, text, [])
        tired = self._tired(state)
        if tired:
            return self._undone(state, tired, [])
        if part.state.away == HANDED_BACK and body.Mode.name == "Waypoint":
            part = part._replace(state=part.state._replace(away=WITH_UXAS))
        if part.state.away:
            return state, []
        lists, out = self._task_id in body.AssociatedTasks, list[Any]()
        if lists and part.state.task.state < ACTIVE:
            own, more = self._advance(part.state, LISTED, 0, body)
            part, out = part._replace(state=own), list(more)
        if part.state.task.state < ACTIVE:
            return state, out
        progress = state.meeting or Progress()
        number = parts_of.command_id(self._task_id, part.state.task.request)
        laps = parts_of.follows(part, body, number)
        way = progress.ways.get(part.vehicle)
        if way is not None and way.arrived is not None:
            return state, out
        if not (lists or laps):
            return self._undone(state, f"vehicle {part.vehicle} flies it no more", out)
        try:
            before = way.told if way else 0
            way = self._way(state, part, body, laps)._replace(before=before)
        except BadInput as error:
            if not part.blocked:
                out.append(self._warning(f"vehicle {part.vehicle} is not steered: {error}"))
            return state.with_part(part._replace(blocked="its state")), out
        part = part._replace(blocked="")
        state = state.with_part(part)._replace(meeting=progress.with_way(part.vehicle, way))
        if way.passed:
            return self._passed(state, part, body, out)
        return self._steered(state, part, body, out)

    def _silent(self, state: Following) -> Part | None:
        """A vehicle that has not arrived yet and has been silent for too long; None if there is none."""
        ways = (state.meeting or Progress()).ways
        for part in state.parts:
            way = ways.get(part.vehicle)
            comes = way is None or way.arrived is None
            if comes and not in_time(part.seen_ms, state.now_ms, VANISHED_MS):
                return part
        return None

    def _tired(self, state: Following) -> str:
        """Which vehicle has waited too long, and which have not come, in words; "" if none has."""
        progress = state.meeting or Progress()
        for part in state.parts:
            since, met = progress.since.get(part.vehicle), self._met(part.context)
            if since is None or in_time(since, state.now_ms, met.wait_ms):
                continue
            late = sorted(
                p.vehicle
                for p in state.parts
                if p.vehicle not in progress.ways or p.blocked or p.state.away
            )
            text = f"vehicle {part.vehicle} has waited for {met.wait_ms / 1000:g} s ({WAIT})"
            return f"{text}, and {', '.join(map(str, late))} has not come" if late else text
        return ""

    def _way(self, state: Following, part: Part, body: Any, laps: bool) -> Way:
        """The rest of a vehicle's route according to its state."""
        progress = state.meeting or Progress()
        gone = part.vehicle in progress.gone or body.CurrentWaypoint > part.begins
        here, plan = self._here(part, body), state.plans.get(part.vehicle, {})
        way = way_left(part, here, body.CurrentWaypoint, laps, gone, plan)
        share = turn_left(part, body) if part.vehicle in progress.slow else 1.0
        wind = wind_of(body, course_of(part, here))
        return way._replace(turn=share if laps else 0.0, wind=wind, told=body.Time)

    def _here(self, part: Part, body: Any) -> Vec2:
        where = f"state of vehicle {part.vehicle}"
        pose = part.context.places.pose(body.Location, body.Heading, where, "Location")
        return Vec2(pose.north_m, pose.east_m)

    def _passed(self, state: Following, part: Part, body: Any, out: list[Any]) -> Step:
        """The vehicle has passed its state: check place and time, and complete the task after the last one."""
        here, at = self._here(part, body), place_of(part)
        if not in_ring(at, here, 0, 2 * part.option.flyer.radius_m):
            text = f"vehicle {part.vehicle} passed its place {math.dist(here, at):.0f} m aside"
            return self._undone(state, text, out)
        way = state.meeting.ways[part.vehicle]
        progress = state.meeting.with_way(part.vehicle, way._replace(arrived=way.told))
        if progress.common is None:
            text = f"vehicle {part.vehicle} passed its place before all were on their ways"
            return self._undone(state, text, out)
        state = state._replace(meeting=progress)
        out.append(self._speed(part, part.option.flyer.speed_m_s))
        met = self._met(part.context)
        arrived = {v: w for v, w in progress.ways.items() if w.arrived is not None}
        for vehicle, way in sorted(arrived.items()):
            # it passed at an unknown time between two states, so both must be in time
            ends = (way.before, way.told)
            if not all(in_company(t, progress.common, met.tolerance_ms) for t in ends):
                off = " to ".join(f"{(t - progress.common) / 1000:.1f}" for t in ends)
                text = f"vehicle {vehicle} arrived {off} s after the common time"
                return self._undone(state, text, out)
        if len(arrived) < met.needed:
            return state, out
        out.append(
            lmcp.new(
                "TaskComplete",
                TaskID=self._task_id,
                EntitiesInvolved=sorted(arrived),
                TimeTaskCompleted=body.Time,
            )
        )
        for one in state.parts:
            _, more = self._advance(one.state, UNLISTED, 0, body)
            out += [said for said in more if type(said).__name__ != "TaskComplete"]
        return state._replace(parts=(), meeting=None), out

    def _steered(self, state: Following, part: Part, body: Any, out: list[Any]) -> Step:
        """Let the vehicle wait, leave its circle, or fly at the speed for arriving in time."""
        met, progress = self._met(part.context), state.meeting
        if progress.common is None:
            told = all(in_time(p.seen_ms, state.now_ms, SILENT_MS) for p in state.parts)
            ready = all(p.vehicle in progress.ways for p in state.parts)
            if not (told and ready and len(state.parts) == met.needed):
                return self._waits(state, part, out)
            progress = self._set(state)
        limits, way = self._limits(part), progress.ways[part.vehicle]
        ground = way.over_ground(limits)
        if self._late(state.now_ms, progress, part, met):
            progress = self._set(state)
        if progress.common is None or self._late(state.now_ms, progress, part, met):
            text = f"there is no common time any more: vehicle {part.vehicle} would be late"
            return self._undone(state, text, out)
        said = self._pace(state.now_ms, progress.common, part, way, met)
        speed_m_s = way.airspeed(said.speed_m_s, limits)
        state = state._replace(meeting=progress)
        if way.laps:
            left_s = (progress.common - state.now_ms) / 1000
            again = another_lap(
                way.left_m, left_s, way.lap_s(waits_as(part.option)), ground.nominal_m_s
            )
            if (
                said.act == FLY
                and not again
                and at_gate(part, self._here(part, body), body.Heading)
            ):
                return self._leaves(state, part, speed_m_s, out)
            return self._waits(state, part, out)
        if said.act == EARLY and way.waits:
            return self._waits(state, part, out)
        out.append(self._speed(part, speed_m_s))
        return state, out

    def _late(self, now_ms: int, progress: Progress, part: Part, met: Met) -> bool:
        """Whether a vehicle can no longer arrive in time, or no common time is set."""
        if progress.common is None:
            return True
        way = progress.ways[part.vehicle]
        said = self._pace(now_ms, progress.common, part, way, met)
        return bool(said.act == LATE)

    def _pace(self, now_ms: int, common: int, part: Part, way: Way, met: Met) -> Pace:
        limits = way.over_ground(self._limits(part))
        # half of the tolerance is reserved for turns and for the time between states
        return pace(
            way.left_m,
            (common - now_ms) / 1000,
            limits.slowest_m_s,
            limits.fastest_m_s,
            met.tolerance_ms / 2000,
        )

    def _set(self, state: Following) -> Progress:
        """Set the common time: at usual speeds, else at the fastest; None if there is none."""
        progress, now_ms = state.meeting, state.now_ms
        for fast in (False, True):
            meeting = Meeting(0, NO_END)
            for part in state.parts:
                way = progress.ways[part.vehicle]
                limits = way.over_ground(self._limits(part))
                soonest, latest = way.arrived, way.arrived
                if way.arrived is None:
                    speed = limits.fastest_m_s if fast else usual_m_s(part.option, limits)
                    lap = way.turn * way.lap_s(waits_as(part.option))
                    soonest = now_ms + math.ceil(1000 * (lap + way.left_m / speed))
                    latest = now_ms + math.floor(1000 * way.left_m / limits.slowest_m_s)
                meeting = meeting_step(meeting, soonest, NO_END if way.waits else latest)
            common = common_time(meeting)
            if common.found:
                break
        return progress._replace(common=common.time if common.found else None)

    def _waits(self, state: Following, part: Part, out: list[Any]) -> Step:
        """Command waiting laps beside the gate, at low speed once the vehicle is on the circle."""
        progress, way = state.meeting, state.meeting.ways[part.vehicle]
        circle, clockwise = waiting_circle(part.option)
        flyer, gate = part.option.flyer, Vec2(*part.option.start[:2])
        if is_direct(part.option) and not (
            way.laps or in_ring(gate, way.here, 0, GATE_S * flyer.speed_m_s)
        ):
            return state, out  # the others may still be heard in time
        slow = way.laps and in_ring(circle.at, way.here, 0, 3 * flyer.radius_m)
        if way.laps != slow or part.vehicle in progress.slow or not way.waits:
            return state, out
        part = part._replace(held=circle)
        turn = "Clockwise" if clockwise else "CounterClockwise"
        speed = (waits_as(part.option) if slow else flyer).speed_m_s
        action = parts_of.loiter(part, self._task_id).copy(Direction=turn, Airspeed=speed)
        out.append(self._command(part, [action]))
        since = {part.vehicle: state.now_ms, **progress.since}
        slower = progress.slow | {part.vehicle} if slow else progress.slow
        progress = progress._replace(since=since, slow=slower)
        return state.with_part(part)._replace(meeting=progress), out

    def _leaves(self, state: Following, part: Part, speed_m_s: float, out: list[Any]) -> Step:
        """Send a vehicle from its circle along its run-in."""
        number = parts_of.command_id(self._task_id, part.state.task.request)
        points = state.plans.get(part.vehicle, {})
        along = part._replace(then=part.begins + 1 if is_direct(part.option) else part.then - 1)
        command, why = parts_of.released(along, self._task_id, number, points)
        if command is None:
            text = f"vehicle {part.vehicle} cannot leave its circle: {why}"
            return self._undone(state, text, out)
        out += [command, self._speed(part, speed_m_s)]
        gone = state.meeting.gone | {part.vehicle}
        since = {v: t for v, t in state.meeting.since.items() if v != part.vehicle}
        return state._replace(meeting=state.meeting._replace(gone=gone, since=since)), out

    def _speed(self, part: Part, speed_m_s: float) -> Any:
        """The command to fly at another speed; separate, since not every autopilot supports it."""
        of = {"AssociatedTaskList": [self._task_id], "VehicleID": part.vehicle}
        action = lmcp.new("SpeedOverrideAction", Speed=speed_m_s, **of)
        return self._command(part, [action])

    def _command(self, part: Part, actions: list[Any]) -> Any:
        return lmcp.new(
            "VehicleActionCommand",
            CommandID=parts_of.command_id(self._task_id, part.state.task.request),
            VehicleID=part.vehicle,
            VehicleActionList=actions,
        )

    def _undone(self, state: Following, why: str, out: list[Any]) -> Step:
        """The rendezvous fails: report the reason and send waiting vehicles on with their plans."""
        out.append(self._warning(f"its vehicles do not meet: {why}"))
        for part in state.parts:
            _, more = self._advance(part.state, WITHDRAWN, 0, None)
            out += more
        return state._replace(parts=(), meeting=None), [*out, *self._sent(state)]

    def _sent(self, state: Following) -> list[Any]:
        """Waiting vehicles continue their plans."""
        waiting = (state.meeting or Progress()).since
        return [self._sent_on(state, part) for part in state.parts if part.vehicle in waiting]
