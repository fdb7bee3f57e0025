"""Authority over one vehicle as one system: its gate, its ICAROUS, the UxAS end, and messages between them.

A channel is the set of all messages ever sent: one may be delivered late, twice, in any order, or never. So
what is kept is said of the state (`holds`) and of any one message that was ever sent (`report_holds`,
`uxas_command_holds`, `icarous_command_holds`). Nothing is asked of SETMOD lines: any line may arrive,
a forged one too. The clock enters only where silence is judged (`spec.authority.link_end.too_old`).
"""

from __future__ import annotations

from cratous.spec.authority.cycle import Instance, agree
from cratous.spec.authority.gate import State, may_command, was_given, well_formed
from cratous.spec.authority.link_end import End


def end_holds(gate: State, end: End, suspended: bool) -> bool:
    """UxAS has heard of no epoch that has not begun; of the present one, if it has heard of it, it believes
    what is so; and its own flying is suspended exactly while it believes that ICAROUS commands."""
    known = was_given(gate, end.epoch)
    right = end.epoch != gate.epoch or end.active != may_command(gate, 0)
    return known and right and suspended == end.active


def holds(gate: State, cycle: Instance, end: End, suspended: bool) -> bool:
    """What is so at the start and after each step: the gate is well formed, ICAROUS agrees with it, and
    the UxAS end lags behind it at most; in the first epoch ICAROUS has not commanded."""
    first = gate.epoch > 0 or not may_command(gate, 1)
    return well_formed(gate) and first and agree(cycle, gate) and end_holds(gate, end, suspended)


def report_holds(gate: State, report: State) -> bool:
    """A gate that the vehicle has ever reported: it was so in an epoch that was given, and who began that
    epoch has not changed since."""
    known = well_formed(report) and was_given(gate, report.epoch)
    same = may_command(report, 0) == may_command(gate, 0)
    return known and (report.epoch != gate.epoch or same)


def uxas_command_holds(gate: State, end: End, epoch: int) -> bool:
    """A command that UxAS has ever sent: of an epoch that was given, and that UxAS had heard of."""
    return was_given(gate, epoch) and epoch <= end.epoch


def icarous_command_holds(gate: State, epoch: int) -> bool:
    """A command that ICAROUS has ever sent: of an epoch that was given, and not the first, which is UxAS's."""
    return was_given(gate, epoch) and epoch > 0


def takes_only_what_it_heard(gate: State, end: End, sender: int, accepted: bool) -> bool:
    """A command of UxAS that completes a handback comes from an end that has heard the offer."""
    completes = accepted and sender == 0 and gate.offered
    return not completes or (not end.active and end.epoch == gate.epoch)
