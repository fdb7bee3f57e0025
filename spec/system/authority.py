"""Authority over one vehicle as one system: its gate, its ICAROUS, the UxAS end, and the messages between them.

A channel is the set of all messages ever sent: one may be delivered late, twice, in any order, or never. So the
invariants refer to the state (`holds`) and to any one message that was ever sent (`report_holds`,
`uxas_command_holds`, `icarous_command_holds`). Nothing is assumed of SETMOD lines: any line may arrive, including a
forged one. The clock matters only where silence is judged (`spec.authority.link_end.too_old`).
"""

from __future__ import annotations

from cratous.spec.authority.cycle import Instance, agree
from cratous.spec.authority.gate import State, may_command, was_given, well_formed
from cratous.spec.authority.link_end import End


def end_holds(gate: State, end: End, suspended: bool) -> bool:
    """UxAS has heard of no epoch that has not begun; if it has heard of the present one, what it believes of it is
    true; and its own flying is suspended exactly while it believes that ICAROUS commands.
    """
    known = was_given(gate, end.epoch)
    right = end.epoch != gate.epoch or end.active != may_command(gate, 0)
    return known and right and suspended == end.active


def holds(gate: State, cycle: Instance, end: End, suspended: bool) -> bool:
    """The invariant, at the start and after each step: the gate is well formed, ICAROUS agrees with it, and the UxAS
    end at most lags behind it; in the first epoch ICAROUS has not commanded.
    """
    first = gate.epoch > 0 or not may_command(gate, 1)
    return well_formed(gate) and first and agree(cycle, gate) and end_holds(gate, end, suspended)


def report_holds(gate: State, report: State) -> bool:
    """Any gate state that the vehicle has ever reported: it was true in an epoch that has begun, and the owner who
    began that epoch has not changed since.
    """
    known = well_formed(report) and was_given(gate, report.epoch)
    same = may_command(report, 0) == may_command(gate, 0)
    return known and (report.epoch != gate.epoch or same)


def uxas_command_holds(gate: State, end: End, epoch: int) -> bool:
    """Any command that UxAS has ever sent: its epoch has begun, and UxAS had heard of it."""
    return was_given(gate, epoch) and epoch <= end.epoch


def icarous_command_holds(gate: State, epoch: int) -> bool:
    """Any command that ICAROUS has ever sent: its epoch has begun and is not the first, which belongs to UxAS."""
    return was_given(gate, epoch) and epoch > 0


def takes_only_what_it_heard(gate: State, end: End, sender: int, accepted: bool) -> bool:
    """A command of UxAS that completes a handback comes from a UxAS end that has heard the offer."""
    completes = accepted and sender == 0 and gate.offered
    return not completes or (not end.active and end.epoch == gate.epoch)
