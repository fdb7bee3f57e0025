"""The runtime safety monitor: checks G1 to G5 from the messages alone, as they are published.

It imports no planner and no flight code (ASTM F3269: the monitor is independent of what it
monitors). An aircraft is assumed to fly straight between two samples, which is exactly what the
simulator does; for any other source this is an assumption, and the report says so. Every decision
is made by a proved kernel on rational numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cratous.services.assumptions.watch import AssumptionWatch
from cratous.services.monitor.authority import AuthorityWatch
from cratous.services.monitor.bridge import BridgeWatch
from cratous.services.monitor.completion import CompletionWatch
from cratous.services.monitor.constraints import ConstraintWatch
from cratous.services.monitor.failure import FailureWatch
from cratous.services.monitor.failure_due import FailureDueWatch
from cratous.services.monitor.hand import HandWatch
from cratous.services.monitor.landing import LandingWatch
from cratous.services.monitor.link_loss import LinkLossWatch
from cratous.services.monitor.merging import MergeWatch
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.required_rows import END, missing, promised, watched
from cratous.services.monitor.safe_state import SafeStateWatch
from cratous.services.monitor.samples import Sample, Sampler
from cratous.services.monitor.separation import SeparationWatch
from cratous.services.monitor.take_off import TakeOffWatch
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import REQUIREMENTS, Kind, Verdict, worst
from cratous.spec.mission.plan import Plan

__all__ = ["Monitor"]


class Monitor:
    """Monitors one mission: feed it envelopes with `tap`, ask for `verdicts` and `assumptions` at
    the end.

    on_violation is called once for each new violation, when it is detected; on_broken likewise with
    the row of each theorem assumption that breaks. says_beats: whether the ICAROUS protocol has
    heartbeats; on_board: whether each ICAROUS reports if it hears UxAS, as in a flight in one
    process.
    """

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        on_violation: Callable[[Verdict], None] | None = None,
        on_broken: Callable[[dict[str, Any]], None] | None = None,
        says_beats: bool = True,
        on_board: bool = True,
    ) -> None:
        self.mission = mission
        self.not_covered = tuple(v.id for v in mission.vehicles if not v.protected)
        self._sampler = Sampler(frozenset(v.id for v in mission.vehicles))
        self.presence = Presence(mission.simulation.step_ms)
        self.constraints = ConstraintWatch(mission, self.presence)
        self.separation = SeparationWatch(mission, self.presence)
        self.landing = LandingWatch(mission)
        self.completion = CompletionWatch(mission, plan, self.presence, self.landing.down)
        self.authority = AuthorityWatch(mission)
        self.bridge = BridgeWatch(mission, says_beats)
        self.hand = HandWatch.of(mission)
        self.link_loss = LinkLossWatch(mission, self.landing.down, self.presence)
        self.failure = FailureWatch(mission, self.landing.down, self.presence)
        self.failure_due = FailureDueWatch(mission)
        self.safe_state = SafeStateWatch(mission, self.presence)
        self.take_off = TakeOffWatch(mission, self.presence)
        self.merging = MergeWatch(mission, self.presence)
        self._assumed = AssumptionWatch(mission, on_board)
        self._last_ms, self._over = 0, False
        self._tell, self._tell_broken = on_violation, on_broken
        self._told = [0, 0]

    def tap(self, envelope: Any) -> None:
        """Process one message of the bus or of a log: any object with `topic`, `time_ms` and `body`."""
        short = envelope.topic.rpartition(".")[2]
        body = envelope.body
        if not self._over:
            self._last_ms = max(self._last_ms, envelope.time_ms)
        if short == "TruthState":
            for step in self._sampler.add(body):
                self._step(*step)
        elif short == "AirVehicleState":
            self.completion.state(body)
        elif short == "PlanAccepted" and body.Tasks:
            self.completion.accept(frozenset(body.Tasks))
        elif short == "TaskProgress":
            self.constraints.progress(body)
            self.completion.progress(body)
            self.failure.progress(body)
        elif short in ("GateState", "GatedCommand", "CommandDropped", "ModeRefused"):
            self.authority.message(short, body, envelope.time_ms)
            if short == "GateState":
                self.take_off.gate(body)
                self.failure.gate(body)
                self.safe_state.gate(body)
                self.hand.gate(body, envelope.time_ms)
        elif short == "HandState":
            self.hand.hand(body, envelope.time_ms)
            self.failure.hand(body)
        elif short == "Heartbeat":
            self.bridge.heartbeat(body)
        elif short == "BridgeStatus":
            self.bridge.status(body)
            self.authority.status(body)
            self.link_loss.status(body)
        elif short == "LinkLossState":
            self.link_loss.state(body)
            self.failure.state(body)
            self.safe_state.state(body)
        elif short == "FailureState":
            self.failure.declared(body)
            self.link_loss.declared(body)
            self.authority.declared(body)
            self.safe_state.declared(body)
        elif short == "TakeOffState":
            self.take_off.state(body)
        elif short == "MissionEnd":
            for step in self._sampler.flush():
                self._step(*step)
            self._last_ms, self._over = body.Time, True
            self.completion.end(body)
            at_rest = self.landing.at_rest(self._all_seen)
            self.authority.end(body, at_rest)
            self.safe_state.end(body, at_rest)
            self.bridge.end(body)
            self.link_loss.end(body)
            self.failure.end(body)
            self.take_off.end(body)
            self.hand.end(body.Time)
        if short in self.failure_due.kinds:
            self.failure_due.message(short, body)
        if self._tell is not None:
            for k, events in enumerate((self.separation.violations, self.constraints.violations)):
                for verdict in events[self._told[k] :]:
                    self._tell(verdict)
                self._told[k] = len(events)
        for row in self._assumed.tap(short, envelope):
            if self._tell_broken is not None:
                self._tell_broken(row)

    def _all_seen(self, number: int) -> bool:
        """Whether an aircraft was observed from the start to the end of the mission."""
        return not self.presence.unseen(number, (0, self._last_ms), Ending(self._last_ms, True))

    def _step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        self.presence.step(before, after)
        self.constraints.step(before, after)
        self.take_off.step(before, after)
        self.merging.step(before, after)
        self.safe_state.step(before, after)
        flown = self.landing.step(before, after)
        if all(flown):
            self.separation.step(*flown)
        self.completion.step(before, after)

    def assumptions(self) -> list[dict[str, Any]]:
        """One row for each assumption of the system theorems: held, broken, or not observed with
        the reason.

        The verdicts do not depend on them.
        """
        return self._assumed.rows(self._last_ms, self._over)

    @property
    def end_ms(self) -> int:
        """Time of the mission end, or of the last message so far [ms]."""
        return self._last_ms

    def commands(self) -> dict[int, list[tuple[int, str]]]:
        """Changes of commander of each protected vehicle, as its gate reports them: (time [ms], commander)."""
        return {number: list(seen.had) for number, seen in self.authority.vehicles.items()}

    def details(self) -> list[Verdict]:
        """One verdict for each constraint, pair, task and vehicle, including every promised row."""
        done, accepted = self.completion.done(), self.completion.accepted
        seen = watched(self.mission, self._last_ms, done, accepted)
        ending = Ending(self._last_ms, self._over)
        found = [
            *self.constraints.verdicts(seen, ending),
            *self.merging.verdicts(ending),
            *self.separation.verdicts(seen, ending),
            *self.completion.verdicts(seen),
            *self.authority.verdicts(),
            *self.take_off.verdicts(),
            *self.bridge.verdicts(),
            *self.link_loss.verdicts(),
            *self.failure.verdicts(),
            *self.failure_due.verdicts(),
            *self.safe_state.verdicts(),
        ]
        there = {v.item for v in found if v.requirement == "G1"}
        return found + missing(promised(seen, there), ((v.requirement, v.item) for v in found))

    def verdicts(self) -> list[Verdict]:
        """One verdict for each of G1 to G5, followed by all details."""
        details = self.details()
        return [
            self.hand.beside(_whole(r.id, [v for v in details if v.requirement == r.id]))
            for r in REQUIREMENTS
        ] + details


def _whole(requirement: str, parts: list[Verdict]) -> Verdict:
    """Verdict on a requirement from the verdicts on its parts: the worst outcome and the least margin."""
    outcome = worst([v.outcome for v in parts])
    telling = [v for v in parts if v.outcome is outcome]
    measured = [v for v in telling if v.margin is not None]
    # without a margin, prefer a row that names a task to the row on the mission's end
    first = next((v for v in telling if v.item != END), telling[0] if telling else None)
    chosen = min(measured, key=lambda v: v.margin or 0.0, default=first)
    if chosen is None:
        return Verdict(requirement, "", outcome, Kind.OBSERVED, "nothing was observed")
    kinds = {v.kind for v in parts}
    kind = Kind.EXACT if kinds == {Kind.EXACT} else Kind.OBSERVED
    return Verdict(
        requirement,
        "",
        outcome,
        kind,
        f"{chosen.item}: {chosen.note}" if chosen.item else chosen.note,
        time_ms=chosen.time_ms,
        vehicles=chosen.vehicles,
        margin=chosen.margin,
        unit=chosen.unit,
        checks=sum(v.checks for v in parts),
        method=", ".join(sorted({v.method for v in parts if v.method})),
        kernels=tuple(sorted({kernel for v in parts for kernel in v.kernels})),
    )
