"""Designs of authority with one seeded fault each, to check that the search finds it."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.authority import cycle as cycles
from cratous.core.authority.cycle import Cycle, Cycled, gate_wished
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts, gate_after
from cratous.core.authority.link_end import Linked, LinkEnd, link_mode, suspended_after
from cratous.proofs.system_search.authority import Design, State
from cratous.spec.authority.cycle import OFFER, TAKE_OVER, WITHDRAW
from cratous.spec.authority.link_end import SUSPEND, TAKE_BACK


class Fault(NamedTuple):
    """says: what is wrong in the design; design: its steps."""

    says: str
    design: Design


def _any_epoch(gate: Gate, sender: int, epoch: int) -> bool:
    return gate_accepts(gate, sender, gate.epoch)


def _older_epochs(gate: Gate, sender: int, epoch: int) -> bool:
    return epoch <= gate.epoch and gate_accepts(gate, sender, gate.epoch)


def _any_sender(gate: Gate, sender: int, epoch: int) -> bool:
    return epoch == gate.epoch


def _uxas_always(gate: Gate, sender: int, epoch: int) -> bool:
    return gate_accepts(gate, sender, epoch) or (sender == UXAS and epoch == gate.epoch)


def _icarous_always(gate: Gate, sender: int, epoch: int) -> bool:
    return gate_accepts(gate, sender, epoch) or (sender == ICAROUS and epoch == gate.epoch)


def _no_acknowledgement(gate: Gate, sender: int, epoch: int) -> Gate:
    return gate


def _offer_stays(gate: Gate, sender: int, epoch: int) -> Gate:
    return gate_after(gate, sender, epoch)._replace(offered=gate.offered)


def _any_command_takes(gate: Gate, sender: int, epoch: int) -> Gate:
    return Gate(UXAS, gate.epoch, False) if sender == UXAS and gate.offered else gate


def _same_epoch(of: int) -> Design:
    """A design in which the gate begins no new epoch on this change of authority."""

    def wished(gate: Gate, act: int) -> Gate:
        after = gate_wished(gate, act)
        return after._replace(epoch=gate.epoch) if act == of else after

    return Design(wished=wished)


def _offer_lets_go(gate: Gate, act: int) -> Gate:
    return Gate(UXAS, gate.epoch + 1, False) if act == OFFER else gate_wished(gate, act)


def _takeover_offers(gate: Gate, act: int) -> Gate:
    after = gate_wished(gate, act)
    return after._replace(offered=gate.offered or act == TAKE_OVER)


def _takeover_lost(gate: Gate, act: int) -> Gate:
    return gate if act == TAKE_OVER else gate_wished(gate, act)


def _not_noticed(cycle: Cycle, commands: bool, now: int) -> Cycle:
    return cycle


def _not_withdrawn(
    cycle: Cycle, free: bool, heard: int, now: int, bound: int, least: int
) -> Cycled:
    does = cycles.cycle_flown(cycle, free, heard, now, bound, least)
    return Cycled(cycle, 0) if does.act == WITHDRAW else does


def _offers_at_once(
    cycle: Cycle, free: bool, heard: int, now: int, bound: int, least: int
) -> Cycled:
    return cycles.cycle_flown(cycle, cycle.mode == 1 or free, heard, now, bound, least)


def _watches_only(cycle: Cycle, foreseen: bool, now: int, soon: int) -> Cycled:
    return cycles.cycle_watched(cycle, foreseen, now, soon)._replace(cycle=cycle)


def _believes_all(end: LinkEnd, gate: Gate, active: bool, epoch: int) -> Linked:
    act = SUSPEND if active else TAKE_BACK if end.active else 0
    return Linked(LinkEnd(active, epoch, end.alive), act)


def _believes_what_never_was(end: LinkEnd, gate: Gate, active: bool, epoch: int) -> Linked:
    if epoch > gate.epoch:
        return _believes_all(end, gate, active, epoch)
    return link_mode(end, gate, active, epoch)


def _believes_older(end: LinkEnd, gate: Gate, active: bool, epoch: int) -> Linked:
    if epoch < end.epoch:
        return _believes_all(end, gate, active, epoch)
    return link_mode(end, gate, active, epoch)


def _does_not_ask_the_gate(end: LinkEnd, gate: Gate, active: bool, epoch: int) -> Linked:
    if epoch == gate.epoch:
        return _believes_all(end, gate, active, epoch)
    return link_mode(end, gate, active, epoch)


def _never_suspended(suspended: bool, act: int) -> bool:
    return False


def _suspended_for_ever(suspended: bool, act: int) -> bool:
    return suspended or suspended_after(suspended, act)


def _tells_always(suspended: bool, changed: bool) -> bool:
    return changed


def _reported_epoch(state: State) -> int:
    return state.known.epoch


FAULTS = {
    "no-epoch-check": Fault("the gate takes no notice of epochs", Design(_any_epoch)),
    "older-epochs": Fault("the gate takes commands of older epochs too", Design(_older_epochs)),
    "no-sender-check": Fault("whoever names the present epoch commands", Design(_any_sender)),
    "uxas-always": Fault(
        "UxAS may command at any time, in whatever epoch the vehicle reports",
        Design(_uxas_always, names=_reported_epoch),
    ),
    "icarous-always": Fault(
        "ICAROUS may command without a takeover, as one left running by a handback does",
        Design(_icarous_always),
    ),
    "no-acknowledgement": Fault(
        "a command of UxAS acts and ends no offer", Design(commanded=_no_acknowledgement)
    ),
    "offer-not-closed": Fault(
        "UxAS takes an offer, and it stays open", Design(commanded=_offer_stays)
    ),
    "late-command-takes": Fault(
        "a command that is dropped ends the offer all the same",
        Design(commanded=_any_command_takes),
    ),
    "takeover-in-same-epoch": Fault("a takeover begins no epoch", _same_epoch(TAKE_OVER)),
    "offer-in-same-epoch": Fault("an offer begins no epoch", _same_epoch(OFFER)),
    "withdrawal-in-same-epoch": Fault("a withdrawal begins no epoch", _same_epoch(WITHDRAW)),
    "lets-go-before-answer": Fault(
        "ICAROUS lets go when it offers, before UxAS commands", Design(wished=_offer_lets_go)
    ),
    "takeover-shared": Fault(
        "a takeover leaves UxAS in command as well", Design(wished=_takeover_offers)
    ),
    "takeover-lost": Fault("a takeover does not reach the gate", Design(wished=_takeover_lost)),
    "handback-not-noticed": Fault(
        "ICAROUS does not notice that UxAS has taken its offer", Design(begun=_not_noticed)
    ),
    "offer-without-withdrawal": Fault(
        "an offer is not withdrawn when a conflict is foreseen", Design(flown=_not_withdrawn)
    ),
    "offer-in-conflict": Fault(
        "ICAROUS offers control though a conflict is foreseen", Design(flown=_offers_at_once)
    ),
    "takeover-not-remembered": Fault(
        "ICAROUS takes over and does not remember it", Design(watched=_watches_only)
    ),
    "any-mode-believed": Fault("UxAS believes any SETMOD line", Design(mode=_believes_all)),
    "future-mode-believed": Fault(
        "UxAS believes a line of an epoch that never was", Design(mode=_believes_what_never_was)
    ),
    "older-mode-believed": Fault(
        "UxAS believes a line older than the last", Design(mode=_believes_older)
    ),
    "mode-without-gate": Fault(
        "UxAS believes a line of the present epoch that the gate contradicts",
        Design(mode=_does_not_ask_the_gate),
    ),
    "not-suspended": Fault(
        "UxAS flies on when ICAROUS has taken over", Design(suspends=_never_suspended)
    ),
    "suspended-for-ever": Fault(
        "UxAS does not fly on after a handback", Design(suspends=_suspended_for_ever)
    ),
    "tells-while-suspended": Fault(
        "UxAS commands new tracks while it is suspended", Design(tells=_tells_always)
    ),
    "epoch-forgotten": Fault(
        "the gate starts again in epoch 0", Design(restarted=lambda gate: Gate(UXAS, 0, False))
    ),
    "owner-forgotten": Fault(
        "the gate starts again under UxAS, in the same epoch",
        Design(restarted=lambda gate: Gate(UXAS, gate.epoch, False)),
    ),
    "offer-taken-unheard": Fault(
        "UxAS names the epoch that the vehicle reports, also where the SETMOD lines were lost, and so "
        "takes an offer that it has not heard of",
        Design(names=_reported_epoch),
    ),
}
"""The faults by name."""
