"""Designs of the certificate in hand with one seeded fault each, to check that the search finds it."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.permit.hand import KNOWN, LEFT, OFFERED, Hand, Offer, hand_passed, hand_step
from cratous.proofs.system_search.certificates import HandDesign


class HandFault(NamedTuple):
    """says: what is wrong in the design; design: its steps."""

    says: str
    design: HandDesign


def _as_if(**changed: str) -> HandDesign:
    """A design that checks an offer with some of its fields replaced by those of the hand."""

    def step(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
        if kind == OFFERED:
            there = hand_passed(hand, now)
            offer = offer._replace(**{name: getattr(there, of) for name, of in changed.items()})
        return hand_step(hand, kind, offer, permitted, now, reserve)

    return HandDesign(step)


def _any_base(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    if kind != OFFERED:
        return hand_step(hand, kind, offer, permitted, now, reserve)
    based = offer._replace(base=hand.id, id=max(offer.id, hand.id + 1))
    after = hand_step(hand, kind, based, permitted, now, reserve)
    return after._replace(id=offer.id) if after.id == based.id else after


def _begun(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    if kind == OFFERED:
        offer = offer._replace(sigma_ms=max(offer.sigma_ms, now))
    return hand_step(hand, kind, offer, permitted, now, reserve)


def _too_late(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    if kind == OFFERED:
        last = max(now, hand.expiry_ms)
        offer = offer._replace(sigma_ms=min(offer.sigma_ms, last))
    return hand_step(hand, kind, offer, permitted, now, reserve)


def _shorter(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    after = (
        hand_step(
            hand,
            kind,
            offer._replace(expiry_ms=10 * (now + offer.expiry_ms + 1)),
            permitted,
            now,
            reserve,
        )
        if kind == OFFERED
        else hand_step(hand, kind, offer, permitted, now, reserve)
    )
    taken = kind == OFFERED and after.id == offer.id and after.expiry_ms > offer.expiry_ms
    return after._replace(expiry_ms=offer.expiry_ms) if taken else after


def _any_answer(
    hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int
) -> Hand:
    if kind == KNOWN:
        offer = Offer(hand.id, hand.id, now, hand.knowledge + 1, max(hand.expiry_ms, now))
    return hand_step(hand, kind, offer, permitted, now, reserve)


def _no_surprise(
    hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int
) -> Hand:
    after = hand_step(hand, kind, offer, permitted, now, reserve)
    return after._replace(expiry_ms=max(hand.expiry_ms, now)) if kind == KNOWN else after


def _same_id(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    after = hand_step(hand, kind, offer, permitted, now, reserve)
    return after._replace(id=hand.id) if kind == LEFT else after


def _kept(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    after = hand_step(hand, kind, offer, permitted, now, reserve)
    return after._replace(expiry_ms=max(hand.expiry_ms, now)) if kind == LEFT else after


HAND_FAULTS = {
    "certificate-without-base": HandFault(
        "a certificate is taken that begins on another trajectory than the one that is flown",
        HandDesign(_any_base),
    ),
    "certificate-for-other-tracks": HandFault(
        "a certificate is taken that was permitted before the newest track was known",
        _as_if(knowledge="knowledge"),
    ),
    "certificate-begun": HandFault("a certificate is taken after it has begun", HandDesign(_begun)),
    "certificate-too-late": HandFault(
        "a certificate is taken that begins after the one in hand has expired",
        HandDesign(_too_late),
    ),
    "certificate-shorter": HandFault(
        "a certificate is taken that ends at once in the place of one that lasts",
        HandDesign(_shorter),
    ),
    "answer-for-another": HandFault(
        "that one certificate is permitted against a new track is taken to be so of another",
        HandDesign(_any_answer),
    ),
    "no-surprise": HandFault(
        "a certificate that is not permitted against a new track is kept", HandDesign(_no_surprise)
    ),
    "same-id-when-left": HandFault(
        "an offer that begins on a trajectory that was left is taken", HandDesign(_same_id)
    ),
    "kept-when-left": HandFault(
        "the certificate stays in hand when another trajectory is flown", HandDesign(_kept)
    ),
    "handback-to-another": HandFault(
        "after a handback another trajectory is flown than the one that was permitted, and nobody says so",
        HandDesign(unnoticed=True),
    ),
}
"""The faults by name, as `cratous search-faults` takes it."""
