"""That a vehicle is clear, whoever commands it: by the path checked, or by the certificate in hand. Milliseconds.

Stated for one arbitrary instant `at` and one arbitrary intruder, track or zone. No component of the system stores a
`Sure`: it describes the real situation, event by event, beside the states that the kernels keep.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority import cycle, gate
from cratous.spec.permit.encounter import Encounter


class Sure(NamedTuple):
    """counted: no counter has overflowed its limit; in_order: no event was earlier than the one before, the last at
    now_ms [ms].

    looked: the instant lies in the time for which the last heartbeat checked the path that UxAS flies; way:
    continuing on it, the vehicle is clear at the instant; permit: it is clear if it flies the path permitted last,
    until until_ms [ms]; hand: it is clear if it flies the certificate in hand.
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
    """While UxAS flies, as far as the instance knows, no takeover because of the intruder is in progress."""
    return cycle.steers(instance) or not met.avoiding


def predicted(loss: bool, first_s: float, ahead_s: float, clear: bool, t_s: float) -> bool:
    """What a prediction implies for the instant t_s seconds later: clear within the look-ahead, up to the first
    predicted loss of the volume if there is one. FOR ALL t_s.
    """
    before = t_s < ahead_s and not (loss and t_s >= first_s)
    return clear or t_s < 0 or not before


def is_clear(state: gate.State, sure: Sure, knows: bool, expiry: int, at: int) -> bool:
    """Whoever may command, the vehicle is clear at the instant: under UxAS, if it lies in the time that was checked;
    under ICAROUS, if the certificate in hand covers the intruder, from the last event until it expires.
    """
    by_uxas = sure.way or not sure.looked or not gate.may_command(state, 0)
    in_hand = knows and sure.now_ms <= at and at < expiry
    return by_uxas and (sure.hand or not in_hand or not gate.may_command(state, 1))
