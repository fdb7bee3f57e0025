"""Flies a plan: transit, wait while the task may not begin yet, task; for all vehicles.

`handle(state, message) -> (state, messages)`. A task starts when its vehicle passes the start pose and every
lower bound of the plan's rows holds for the actual times of the other tasks; until then the vehicle circles
on its hold. While it approaches, it adapts its speed so as to pass the start pose when the task may begin.
Within a step, the events of all vehicles are handled in order of time. A delay that breaks an upper bound, or
a change that affects the plan, requests a new plan for the remaining tasks; the step continues with the
answer. If there is no plan, the tasks fail, each by name.
"""

from __future__ import annotations

from dataclasses import dataclass

from cratous.core.authority.gate import UXAS
from cratous.core.authority.link_end import track_is_told
from cratous.core.authority.timeliness import lasted
from cratous.core.executive.steps import answered, ends_in_safe_state, flight_outcome, rejoined
from cratous.services.flight import (
    changes,
    deadlines,
    direct_commands,
    executive_outputs,
    failing,
    interruption,
    legs,
    omitted_tasks,
    task_transitions,
)
from cratous.services.flight.dynamics import stands_at_start
from cratous.services.flight.executive_state import Asked, Config, Out, State
from cratous.services.flight.messages import (
    Because,
    Begin,
    Closing,
    FromExecutive,
    HeardAgain,
    NotHeard,
    NotPlanned,
    Over,
    Planned,
    Report,
    RouteAsked,
    Say,
    SetOut,
    Stands,
    Suspend,
    TakeBack,
    Tick,
    ToExecutive,
    ZonesKnown,
)
from cratous.services.flight.notices import mission_end
from cratous.services.icarous.messages import Fails, WithoutLink
from cratous.spec.authority.link_end import SUSPEND
from cratous.spec.executive import (
    COMPLETE,
    DROP_LATE,
    DROP_LEFT,
    FAILED_FLIGHT,
    FLY_PLAN,
    FOR_CHANGE,
    FOR_NOTHING,
    GOES_ON,
    LIMIT,
)
from cratous.spec.mission.changes import DIRECT, TASK_ADDED, VEHICLE_JOINS, WIND, ZONE_ENDS, split
from cratous.spec.records import replace

OUTCOMES = {GOES_ON: "", COMPLETE: "complete", FAILED_FLIGHT: "failed", LIMIT: "limit"}
BELIEVED_MS = 10_000
"""A vehicle that has reported for this long that ICAROUS has it is suspended, though ICAROUS did not say so [ms]."""
SAFE_STATE = "safe state"
"""Outcome of a flight that ends with every vehicle that UxAS does not have in the declared safe state."""
BRINGS_WORK = (TASK_ADDED, VEHICLE_JOINS)
"""Kinds of change for which the end of the mission waits."""
MAY_FREE_WORK = (WIND, ZONE_ENDS)
"""Further kinds for which it waits if a task is left out."""

Step = tuple[State, tuple[FromExecutive, ...]]
Versions = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Executive:
    """The UxAS side of a flight. config: what does not change during the flight."""

    config: Config

    def handle(self, state: State, message: ToExecutive) -> Step:
        """One step: the state that results, and the messages to send, in order."""
        out: Out = []
        match message:
            case Begin():
                state = self._begin(state, message, out)
            case SetOut():
                state = self._set_out(state, out)
            case Tick():
                state = self._tick(state, message, out)
            case Planned() | NotPlanned():
                state = self._answered(state, message, out)
            case Suspend():
                state = interruption.suspend(state, message, out)
            case Because():
                state = interruption.because(state, message)
            case RouteAsked():
                interruption.propose(self.config, state, message, out)
            case TakeBack():
                state = interruption.take_back(self.config, state, message, out)
            case NotHeard():
                state = interruption.unlinked(state, message)
            case HeardAgain():
                state = interruption.linked(self.config, state, message, out)
            case Stands():
                state = interruption.landed(state, message)
            case Fails():
                state = failing.declared(state, message)
            case WithoutLink():
                state = failing.flies(state, message)
            case Report(now_ms):
                state = self._report(state, now_ms, out)
            case Closing():
                state = self._close(state, message, out)
        return state, tuple(out)

    def _begin(self, state: State, message: Begin, out: Out) -> State:
        """Start every vehicle on its route; ICAROUS is told and commands are sent at `SetOut`."""
        now_ms, aircraft = message
        state = replace(state, now_ms=now_ms, aircraft=aircraft)
        state = changes.known_from_the_start(self.config, state, out)
        state = task_transitions.begin(self.config, state, out)
        out.append(ZonesKnown(state.zones))
        return state

    def _set_out(self, state: State, out: Out) -> State:
        """Send the first routes and the first commands: every gate is still in epoch 0."""
        for vid in self.config.instances:
            state = executive_outputs.route(state, vid, out)
        for vid, _ in state.aircraft:
            state = executive_outputs.command(self.config, state, vid, 0, out)
        return state

    # a step of the flight ----------------------------------------------------------------------

    def _tick(self, state: State, tick: Tick, out: Out) -> State:
        """Apply changes that have become known; then handle events since the last step, in order of time."""
        due, to_come = split(state.to_come, tick.now_ms)
        state = replace(
            state,
            now_ms=tick.now_ms,
            aircraft=tick.aircraft,
            to_come=tuple(to_come),
        )
        direct = [change for change in due if change.kind in DIRECT]
        state = direct_commands.obey(self.config, state, direct, out)
        if due := [change for change in due if change.kind not in DIRECT]:
            state = changes.change(self.config, state, due, out)
        return self._asking(state, out) if state.asked else self._events(state, out)

    def _events(self, state: State, out: Out) -> State:
        """Ends of tracks, then deadlines; then the rest of the step, unless a plan is requested."""
        versions = tuple((chain.vehicle.id, chain.version) for chain in state.chains)
        state = task_transitions.settle(self.config, state, out)
        if not self._beats(state):
            return self._commands(state, versions, out)
        state = legs.give_up(self.config, state, out)
        state, late = deadlines.watch(state)
        return self._deadlines(state, late, versions, out)

    def _deadlines(self, state: State, late: deadlines.Late, versions: Versions, out: Out) -> State:
        state = deadlines.act_on(self.config, state, late, versions, out)
        return self._asking(state, out) if state.asked else self._commands(state, versions, out)

    def _commands(self, state: State, versions: Versions, out: Out) -> State:
        """End of a step: adapt speeds, command tracks that have changed."""
        if self._beats(state):
            for chain in state.chains:
                state = state.put(deadlines.adapted(state, state.chain(chain.vehicle.id)))
        before = dict(versions)
        for vid in [chain.vehicle.id for chain in state.chains]:
            chain = state.chain(vid)
            if rejoined(chain.away, chain.suspended, chain.s_m, chain.join_m):
                note = "back on the path"
                out.append(
                    task_transitions.progress(chain, state.now_ms, "Active", note, chain.served())
                )
                state = state.put(replace(chain, away=False))
            if track_is_told(chain.suspended, chain.version != before[vid]):
                state = executive_outputs.command(self.config, state, vid, state.epoch(vid), out)
        return state

    def _beats(self, state: State) -> bool:
        """Whether a heartbeat is due in this step."""
        return state.now_ms % self.config.mission.simulation.heartbeat_ms == 0

    # another plan ------------------------------------------------------------------------------

    def _asking(self, state: State, out: Out) -> State:
        out.append(changes.ask(self.config, state))
        return state

    def _answered(self, state: State, message: Planned | NotPlanned, out: Out) -> State:
        """Act on the planner's answer as the kernel `answered` decides, and finish the step."""
        asked = state.asked or Asked(FOR_NOTHING, "", "")
        waits, act = answered(asked.kind, isinstance(message, Planned))
        state = replace(state, asked=state.asked if waits else None)
        if act == FLY_PLAN and isinstance(message, Planned):
            state = changes.planned(self.config, state, message.plan, asked, out)
            if asked.kind == FOR_CHANGE:
                state = executive_outputs.command_all(self.config, state, out)
                return self._events(state, out)
            return self._commands(state, asked.versions, out)
        if act == DROP_LEFT and isinstance(message, NotPlanned):
            state = changes.unplanned(self.config, state, message, asked, out)
            return self._events(state, out)
        if act == DROP_LATE:
            state = deadlines.give_up_first(self.config, state, asked.late, out)
            return self._deadlines(state, asked.late[1:], asked.versions, out)
        return state

    # heartbeats, and the end -------------------------------------------------------------------

    def _report(self, state: State, now_ms: int, out: Out) -> State:
        """Report where the cameras point, and the progress of each vehicle with an instance."""
        out.extend(
            executive_outputs.look(self.config, state, vid, now_ms) for vid, _ in state.aircraft
        )
        for vid in self.config.instances:
            state = executive_outputs.report(state, vid, out)
        failing.repeated(state, out)
        return state

    def _close(self, state: State, message: Closing, out: Out) -> State:
        """Whether and how the flight has ended, as the kernels `flight_outcome` and `ends_in_safe_state` decide.

        At the end every task that is asked for gets a final status.
        """
        now_ms, limit_ms = message.now_ms, self.config.mission.simulation.limit_ms
        since = dict(state.circling)
        since = {
            vid: since.get(vid, now_ms)
            for vid in message.circling
            if vid not in dict(state.declared)
        }
        under = dict(state.under_icarous)
        under = {vid: under.get(vid, now_ms) for vid, gate in message.gates if gate.owner != UXAS}
        state = replace(state, circling=tuple(since.items()), under_icarous=tuple(under.items()))
        for vid, from_ms in under.items():
            chain = state.find(vid)
            untold = chain is not None and not chain.suspended
            if untold and lasted(from_ms, now_ms, BELIEVED_MS):
                state = interruption.suspend(state, Suspend(vid, now_ms, SUSPEND), out)
        flying = sum(chain.item is not None for chain in state.chains)
        down = dict(state.landed)
        stays = {
            chain.vehicle.id
            for chain in state.chains
            if chain.item is None and stands_at_start(chain.vehicle, state.air(chain.vehicle.id))
        }
        gates = [(vid, gate) for vid, gate in message.gates if vid not in stays]
        busy, safe_ms = failing.busy(state), self.config.mission.bridge_times.safe_state_after_ms
        away = [v for v, gate in gates if v in busy or (gate.owner != UXAS and v not in down)]
        kinds = (*BRINGS_WORK, *(MAY_FREE_WORK if state.left_out else ()))
        expected = sum(c.kind in kinds for c in state.to_come)
        # not needed while some still fly; a search flown only in part counts as not served
        todo = len(changes.unserved(state)) if not flying else 0
        how = OUTCOMES[flight_outcome(flying, len(away), expected, todo, now_ms, limit_ms)]
        if how == OUTCOMES[FAILED_FLIGHT]:
            stopping, state = state.stopping, failing.at_the_end(self.config, state)
            how = how if state.stopping == stopping else ""
        safe = [v for v in away if v in since and lasted(since[v], now_ms, safe_ms)]
        working = sum(c.item is not None for c in state.chains if c.vehicle.id not in safe)
        if not how and ends_in_safe_state(working, len(away), len(safe), expected):
            how = SAFE_STATE
        if not how:
            return state
        why = "not served when the mission ended"
        if how == OUTCOMES[LIMIT]:
            why = f"not served when the flight ended at its limit of {limit_ms / 1000:g} s"
        elif how == SAFE_STATE:
            why = "not served when the flight ended in the declared safe state"
        for vid in safe:
            why += f"; vehicle {vid} circles without the link since {since[vid] / 1000:.2f} s"
        for vid in away:
            why += f"; vehicle {vid} was still under ICAROUS"
        settled = (
            dict(state.starts),
            dict(state.ends),
            {**dict(state.left_out), **dict(state.failed)},
        )
        chains = {chain.vehicle.id: chain for chain in state.chains}
        waited, told = omitted_tasks.no_longer_awaited(dict(state.left_out), chains, now_ms)
        state = replace(state, left_out=tuple({**dict(state.left_out), **waited}.items()))
        tasks, said = omitted_tasks.unfinished(changes.left(state), settled, chains, now_ms, why)
        for task in tasks:
            state = state.has_failed(task, why)
        out += [Say(one, task_transitions.NAME) for one in (*told, *said)]
        out += [Say(mission_end(now_ms, how), task_transitions.NAME), Over(how)]
        return state
