"""That a vehicle respects a zone, whoever flies it: by the legs that UxAS commanded, or by the certificate in hand.
Milliseconds.

Stated for one arbitrary zone and one arbitrary instant `at`. The vehicle is flown by whoever commanded last among
those that the gate let through: an open offer changes nothing until it is taken.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority import gate


class Way(NamedTuple):
    """What UxAS commands, at the instant. kept: the leg near which the vehicle is flown was checked against the zone,
    with a margin, and accepted; near: the vehicle is within the margin of that leg; obeys: it respects the zone.
    """

    kept: bool
    near: bool
    obeys: bool


class Fenced(NamedTuple):
    """counted: no counter has overflowed its limit; in_order: no event was earlier than the one before, the last at
    now_ms [ms]; way: the last UxAS command that the gate let through; hand: at the instant a vehicle that flies the
    certificate in hand respects the zone.
    """

    counted: bool
    in_order: bool
    now_ms: int
    way: Way
    hand: bool


def checked(way: Way) -> bool:
    """What the check of a leg implies: near it, the zone is respected."""
    return way.obeys or not (way.kept and way.near)


def flown_by_uxas(state: gate.State) -> bool:
    """UxAS alone may command, so its last command is flown."""
    return gate.may_command(state, 0) and not gate.may_command(state, 1)


def is_fenced(state: gate.State, known: Fenced, knows: bool, expiry: int, at: int) -> bool:
    """Whoever flies, the zone is respected at the instant, if it is not before the last event: under UxAS, if its leg
    was checked and the vehicle is near it; under ICAROUS, if the certificate in hand covers the zone, until it
    expires.
    """
    to_come = known.now_ms <= at
    on_legs = flown_by_uxas(state) and known.way.kept and known.way.near
    in_hand = gate.may_command(state, 1) and knows and at < expiry
    by_uxas = known.way.obeys or not (to_come and on_legs)
    return by_uxas and (known.hand or not (to_come and in_hand))
