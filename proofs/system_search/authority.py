"""Authority over one vehicle as a transition system: the kernels that run, and messages that may be lost.

A message once sent stays in the channel, so it may arrive late, twice, in any order or never; SETMOD lines may even
be forged. Time is not searched: every wait is over and every peer is heard (`proofs/theorems/system` has the clocks).
`changes` counts the actual changes of authority; no design reads it. The properties checked are those of
`spec.system.authority` and `spec.authority`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from cratous.core.authority import cycle as cycles
from cratous.core.authority import gate as gates
from cratous.core.authority import link_end as ends
from cratous.core.authority.cycle import Cycle, Cycled
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.core.authority.link_end import Linked, LinkEnd
from cratous.spec.authority import cycle as instance
from cratous.spec.authority import gate as authority
from cratous.spec.authority.link_end import TAKE_BACK, End, believes_uxas
from cratous.spec.system import authority as system
from cratous.spec.system import trace

NAMES = ("UxAS", "ICAROUS")


class Command(NamedTuple):
    """A command in the channel; changes: the number of changes of authority when it was made."""

    sender: int
    epoch: int
    changes: int


class State(NamedTuple):
    """One state: the parts, the last report of the gate to UxAS, and everything sent so far.

    taken: the epoch in which UxAS last took the vehicle, 0 at first, as its executive remembers it; commanded: who
    last had a command accepted; returned: UxAS has flown again after ICAROUS had.
    """

    gate: Gate = Gate(0, 0, False)
    cycle: Cycle = Cycle(0, 0, False, 0, False, 0)
    end: LinkEnd = LinkEnd(False, 0, True)
    suspended: bool = False
    taken: int = 0
    known: Gate = Gate(0, 0, False)
    reports: frozenset[Gate] = frozenset({Gate(0, 0, False)})
    commands: frozenset[Command] = frozenset()
    changes: int = 0
    commanded: int = UXAS
    returned: bool = False


class Step(NamedTuple):
    """One step: its description, the state afterwards, and the fault, if any.

    event: the same as data; accepted: the arriving command takes effect; sent: the epoch of a command that UxAS
    sends, or NOTHING.
    """

    text: str
    after: State
    wrong: str = ""
    event: trace.Event = trace.Event("")
    accepted: bool = False
    sent: int = trace.NOTHING

    @property
    def entry(self) -> trace.Entry:
        """The step as an entry of a trace."""
        gate, end, mode = self.after.gate, self.after.end, self.after.cycle.mode
        stands = trace.Standing(
            *gate, mode, end.active, end.epoch, self.after.suspended, self.accepted, self.sent
        )
        return trace.Entry(self.text, self.event, stands)


def taken_epoch(state: State) -> int:
    """The epoch that a new track of UxAS carries: the one in which UxAS took the vehicle."""
    return state.taken


@dataclass(frozen=True)
class Design:
    """The steps of the composition: by default the kernels that run; a seeded fault replaces some."""

    accepts: Callable[[Gate, int, int], bool] = gates.gate_accepts
    commanded: Callable[[Gate, int, int], Gate] = gates.gate_after
    wished: Callable[[Gate, int], Gate] = cycles.gate_wished
    begun: Callable[[Cycle, bool, int], Cycle] = cycles.cycle_begun
    watched: Callable[[Cycle, bool, int, int], Cycled] = cycles.cycle_watched
    flown: Callable[[Cycle, bool, int, int, int, int], Cycled] = cycles.cycle_flown
    mode: Callable[[LinkEnd, Gate, bool, int], Linked] = ends.link_mode
    suspends: Callable[[bool, int], bool] = ends.suspended_after
    tells: Callable[[bool, bool], bool] = ends.track_is_told
    restarted: Callable[[Gate], Gate] | None = None
    names: Callable[[State], int] = taken_epoch

    def first(self) -> State:
        """The initial state: UxAS flies."""
        return State()

    def steps(self, state: State) -> Iterator[Step]:
        """All possible next steps."""
        return steps(self, state)


def steps(design: Design, state: State) -> Iterator[Step]:
    """All possible next steps."""
    for free in (False, True):
        yield _heartbeat(design, state, free)._replace(event=trace.Event(trace.HEARTBEAT, free))
    for report in sorted(state.reports):
        if report != state.known:
            event = trace.Event(trace.REPORT, report.offered, report.owner, report.epoch)
            text = f"UxAS is told that {_gate(report)}"
            yield Step(text, state._replace(known=report), event=event)
    for active in (False, True):
        for epoch in range(state.gate.epoch + 2):
            yield _mode(design, state, active, epoch)._replace(
                event=trace.Event(trace.MODE, active, 0, epoch)
            )
    if design.tells(state.suspended, True):
        told = _uxas_commands(state, design.names(state), "UxAS commands a new track")
        yield told._replace(event=trace.Event(trace.TRACK))
    for command in sorted(state.commands):
        yield _arrives(design, state, command)._replace(
            event=trace.Event(trace.COMMAND, False, *command),
            accepted=design.accepts(state.gate, command.sender, command.epoch),
        )
    if design.restarted is not None:
        after = _changed(state, design.restarted(state.gate))
        yield _checked("the gate restarts", state, after)._replace(event=trace.Event(trace.RESTART))


def _heartbeat(design: Design, state: State, free: bool) -> Step:
    """One heartbeat of ICAROUS; free: no conflict is predicted and the way back is free."""
    gate = state.gate
    cycle = design.begun(state.cycle, design.accepts(gate, ICAROUS, gate.epoch), 0)
    flies = instance.steers(_cycle_of(cycle))
    does = design.flown(cycle, free, 0, 0, 0, 0) if flies else design.watched(cycle, not free, 0, 0)
    after = _changed(state._replace(cycle=does.cycle), design.wished(gate, does.act))
    if instance.steers(_cycle_of(does.cycle)):
        sent = Command(ICAROUS, after.gate.epoch, after.changes)
        after = after._replace(commands=after.commands | {sent})
    seen = "the way is free" if free else "a conflict is foreseen"
    act = ("nothing changes", "it offers control", "it withdraws its offer", "it takes over")
    text = f"ICAROUS heartbeat, {seen}: {act[does.act]}; {_gate(after.gate)}"
    if not free and after.gate.offered:
        return Step(text, after, "an offer stays open though a conflict is foreseen")
    if (
        not authority.is_takeover(_gate_of(gate), _gate_of(after.gate))
        and does.act == instance.TAKE_OVER
    ):
        return Step(text, after, "ICAROUS has not taken over in an epoch of its own")
    if not instance.is_after_wish(_gate_of(gate), does.act, _gate_of(after.gate)):
        return Step(text, after, "the gate did not do what ICAROUS wants in an epoch of its own")
    if not instance.agree(_cycle_of(does.cycle), _gate_of(after.gate)):
        return Step(
            text, after, "after its heartbeat ICAROUS and the gate disagree on who commands"
        )
    return _checked(text, state, after)


def _mode(design: Design, state: State, active: bool, epoch: int) -> Step:
    """A SETMOD line, genuine or forged, arrives at the UxAS end."""
    linked = design.mode(state.end, state.known, active, epoch)
    held = design.suspends(state.suspended, linked.act)
    after = state._replace(end=linked.end, suspended=held)
    says = "ICAROUS commands" if active else "UxAS may command"
    answers = ("changes nothing", "lets go", "takes the vehicle back", "is overtaken", "is refused")
    text = f"a SETMOD line arrives at UxAS ({says}, epoch {epoch}): {answers[linked.act]}"
    if linked.act == TAKE_BACK:
        sent = _uxas_commands(after._replace(taken=epoch), epoch, text)
        if sent.wrong:
            return sent
        return _checked(text, state, sent.after)._replace(sent=epoch)
    return _checked(text, state, after)


def _uxas_commands(state: State, epoch: int, text: str) -> Step:
    sent = Command(UXAS, epoch, state.changes)
    after = state._replace(commands=state.commands | {sent})
    if not believes_uxas(_end_of(state.end)):
        wrong = "UxAS commands a vehicle that it believes ICAROUS to command"
        return Step(text, after, wrong, sent=epoch)
    return Step(f"{text}, epoch {epoch}", after, sent=epoch)


def _arrives(design: Design, state: State, command: Command) -> Step:
    """A command arrives at the gate."""
    gate, sender = state.gate, command.sender
    accepted = design.accepts(gate, sender, command.epoch)
    after = state._replace(gate=design.commanded(gate, sender, command.epoch))
    after = after._replace(reports=after.reports | {after.gate})
    text = f"a command of {NAMES[sender]}, epoch {command.epoch}, arrives: "
    if not accepted and after.gate != gate:
        return Step(text + "dropped", after, "a command that is dropped changes the gate")
    if not accepted:
        return _checked(text + "dropped", state, after)
    text += f"ACTS; {_gate(after.gate)}"
    back = state.returned or (state.commanded == ICAROUS and sender == UXAS)
    after = after._replace(commanded=sender, returned=back)
    if command.changes != state.changes:
        return Step(text, after, "a command that was made before a change of authority acts")
    if not authority.may_act(_gate_of(gate), sender, command.epoch):
        return Step(text, after, f"{NAMES[sender]} may not command in this epoch")
    if sender == UXAS and authority.may_command(_gate_of(after.gate), ICAROUS):
        return Step(text, after, "two command in one epoch: UxAS has, and ICAROUS still may")
    heard = system.takes_only_what_it_heard(_gate_of(gate), _end_of(state.end), sender, accepted)
    if not heard:
        return Step(text, after, "UxAS takes an offer that it has not heard of")
    return _checked(text, state, after)


def _changed(state: State, gate: Gate) -> State:
    """The state with another gate, which is reported to UxAS."""
    if gate == state.gate:
        return state
    return state._replace(gate=gate, reports=state.reports | {gate}, changes=state.changes + 1)


def _checked(text: str, before: State, after: State) -> Step:
    """The step, with the fault in the state afterwards, if any."""
    if after.gate.epoch < before.gate.epoch:
        return Step(text, after, "the gate's epoch goes back")
    if after.end.epoch < before.end.epoch:
        return Step(text, after, "the epoch that UxAS believes in goes back")
    gate, end = _gate_of(after.gate), _end_of(after.end)
    if not system.end_holds(gate, end, after.suspended):
        return Step(text, after, "UxAS believes of the present epoch, or does, what is not so")
    # ICAROUS notices at its next heartbeat; at a heartbeat `_heartbeat` has checked already
    cycle = cycles.cycle_begun(after.cycle, authority.may_command(gate, ICAROUS), 0)
    if not system.holds(gate, _cycle_of(cycle), end, after.suspended):
        return Step(text, after, "ICAROUS and the gate disagree on who commands")
    if not all(system.report_holds(gate, _gate_of(one)) for one in after.reports):
        return Step(text, after, "in one epoch the gate is reported both ways")
    return Step(text, after)


def _gate_of(gate: Gate) -> authority.State:
    """The gate as a state of the definitions."""
    return authority.State(*gate)


def _cycle_of(cycle: Cycle) -> instance.Instance:
    return instance.Instance(*cycle)


def _end_of(end: LinkEnd) -> End:
    return End(*end)


def _gate(gate: Gate) -> str:
    who = "UxAS commands" if gate.owner == UXAS else "ICAROUS commands"
    return f"{who}{', control is offered' if gate.offered else ''} (epoch {gate.epoch})"
