"""That a vehicle is clear, whoever commands it: by what was looked at, or by the certificate in hand. Milliseconds.

Said of one arbitrary instant `at` and of one arbitrary intruder, track or zone. No part of the system keeps a `Sure`: it
is what is so out there, event by event, beside the states that the kernels keep.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority import cycle, gate
from cratous.spec.permit.encounter import Encounter


class Sure(NamedTuple):
    """counted: no number has grown too large to be counted on; in_order: no event came earlier than the one before, the
    last at now_ms [ms].

    looked: the instant lies in the time for which the last heartbeat has looked at the way that UxAS flies; way: flying
    on so, the vehicle is clear at the instant; permit: so it is if it flies the way that was permitted last, until_ms
    [ms]; hand: so it is if it flies the certificate in hand.
    """

    counted: bool
    in_order: bool
    now_ms: int
    looked: bool
    way: bool
    permit: bool
    until_ms: int
    hand: bool


def understood(instance: cycle.Instance, state: gate.State) -> bool:
    """The instance agrees with its gate, or UxAS has taken its offer since its last heartbeat."""
    mine = instance.mode == cycle.HANDBACK and gate.may_command(state, 0)
    taken = mine and not gate.may_command(state, 1)
    return gate.well_formed(state) and (cycle.agree(instance, state) or taken)


def quiet(instance: cycle.Instance, met: Encounter) -> bool:
    """While UxAS flies, as far as the instance knows, no takeover because of the intruder is open."""
    return cycle.steers(instance) or not met.avoiding


def predicted(loss: bool, first_s: float, ahead_s: float, clear: bool, t_s: float) -> bool:
    """What a prediction says of the instant t_s seconds later: clear for as long as was looked, up to the first loss of
    the volume if one is predicted. FOR ALL t_s."""
    before = t_s < ahead_s and not (loss and t_s >= first_s)
    return clear or t_s < 0 or not before


def is_clear(state: gate.State, sure: Sure, knows: bool, expiry: int, at: int) -> bool:
    """Whoever may command, the vehicle is clear at the instant: UxAS, if it lies in the time that was looked at; ICAROUS,
    if what is in hand knows of the intruder, from the last event until it expires."""
    by_uxas = sure.way or not sure.looked or not gate.may_command(state, 0)
    in_hand = knows and sure.now_ms <= at and at < expiry
    return by_uxas and (sure.hand or not in_hand or not gate.may_command(state, 1))
