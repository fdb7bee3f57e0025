"""Requirements on the certificate in hand, behind the actuator gate, and on its replacement.

A certificate says: flown from now on, its trajectory is clear, at every instant until it expires, of everything that
its tracks may do. It names the trajectory that it branches off, with which it agrees until it begins. Whatever
messages are lost, duplicated, delayed or reordered, only such a certificate may replace it. Milliseconds of one
clock.
"""

from __future__ import annotations

from typing import NamedTuple


class Hand(NamedTuple):
    """The certificate in hand. id: its number; knowledge: how many changes of the set of tracks and zones it covers;
    expiry_ms: until when it is clear; surprises: number of changes that it did not allow for.
    """

    id: int
    knowledge: int
    expiry_ms: int
    surprises: int


class Offer(NamedTuple):
    """An offered certificate. base: the certificate that it branches off, at sigma_ms; the rest as in `Hand`."""

    id: int
    base: int
    sigma_ms: int
    knowledge: int
    expiry_ms: int


def certified(expiry: int, clear: bool, now: int, at: int) -> bool:
    """The vehicle is clear at the instant `at`, if that lies from now until the expiry. FOR ALL at. clear: the
    vehicle is clear at this instant if it flies the trajectory.
    """
    return clear or at < now or at >= expiry


def agrees(sigma: int, clear: bool, base_clear: bool, at: int) -> bool:
    """Before it begins, a trajectory coincides with its base: both are clear, or neither. FOR ALL at."""
    return at >= sigma or clear == base_clear


def lasts(before: int, after: int, now: int, reserve: int) -> bool:
    """The expiry is not reduced below now plus the reserve; it may stay lower, to fly on near an intruder that
    hovers.
    """
    return after >= before or after >= now + reserve


def may_take_over(hand: Hand, offer: Offer, now: int, reserve: int) -> bool:
    """An offer may replace the certificate in hand: it branches off it, neither in the past nor after its expiry, has
    a later number, covers all known changes, and does not reduce the expiry below the reserve.
    """
    later = not offer.id <= hand.id
    in_time = not (offer.sigma_ms < now or offer.sigma_ms > hand.expiry_ms)
    knows = offer.base == hand.id and offer.knowledge == hand.knowledge
    return later and knows and in_time and lasts(hand.expiry_ms, offer.expiry_ms, now, reserve)


def is_after_offer(before: Hand, offer: Offer, now: int, reserve: int, after: Hand) -> bool:
    """The certificate in hand is the offered one if that may replace it; otherwise nothing changes."""
    if not may_take_over(before, offer, now, reserve):
        return after == before
    same = after.knowledge == before.knowledge and after.surprises == before.surprises
    return after.id == offer.id and after.expiry_ms == offer.expiry_ms and same


def is_over(before: Hand, now: int, after: Hand) -> bool:
    """Nothing is guaranteed any more: what had not expired expires now, and what had keeps its expiry."""
    if before.expiry_ms < now:
        return after.expiry_ms == before.expiry_ms
    return after.expiry_ms == now


def is_after_news(before: Hand, permitted: bool, now: int, after: Hand) -> bool:
    """A track or zone has become known. Either the certificate in hand is permitted against it too, and its expiry
    stays; or this is counted as a surprise, and nothing is guaranteed any more. Offers that do not cover the change
    are not accepted.
    """
    known = after.id == before.id and after.knowledge == before.knowledge + 1
    if permitted:
        return known and after.expiry_ms == before.expiry_ms and after.surprises == before.surprises
    return known and is_over(before, now, after) and after.surprises == before.surprises + 1


OFFERED, KNOWN, LEFT = 0, 1, 2


def is_after_time(before: Hand, now: int, after: Hand) -> bool:
    """Time has passed: a certificate that has not expired stays as it is; one that has guarantees nothing from this
    instant on.
    """
    same = after.id == before.id and after.knowledge == before.knowledge
    kept = same and after.surprises == before.surprises
    if before.expiry_ms < now:
        return kept and after.expiry_ms == now
    return kept and after.expiry_ms == before.expiry_ms


def is_after_leaving(before: Hand, now: int, after: Hand) -> bool:
    """Another trajectory is flown: nothing is guaranteed any more, and it has the next id, so that no earlier offer
    branches off it. Nothing has become known.
    """
    other = after.id == before.id + 1 and is_over(before, now, after)
    return other and after.knowledge == before.knowledge and after.surprises == before.surprises


def is_news_for(hand: Hand, news: Offer) -> bool:
    """The answer refers to the certificate in hand, covers it up to its expiry, and refers to the next change."""
    later = news.expiry_ms >= hand.expiry_ms
    return news.id == hand.id and news.knowledge == hand.knowledge + 1 and later


MOST = 1 << 60
"""The greatest count; beyond it nothing is guaranteed."""


def is_worn(hand: Hand) -> bool:
    """One of its counts has reached the greatest value."""
    return hand.id >= MOST or hand.knowledge >= MOST or hand.surprises >= MOST


class Clock(NamedTuple):
    """The time of the last event [ms], and whether no event so far was earlier than the one before."""

    now_ms: int
    in_order: bool


def clock_step(
    clock: Clock, kind: int, offer: Offer, permitted: bool, now: int, reserve: int
) -> Clock:
    """One more event."""
    return Clock(now, clock.in_order and not now < clock.now_ms)


def is_after_event(
    before: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int, after: Hand
) -> bool:
    """Time has passed up to the event, and then the event has taken effect on the certificate in hand."""
    present = Hand(before.id, before.knowledge, max(before.expiry_ms, now), before.surprises)
    if is_worn(present):
        same = after.id == present.id and after.knowledge == present.knowledge
        return same and after.surprises == present.surprises and after.expiry_ms == now
    if kind == OFFERED:
        return is_after_offer(present, offer, now, reserve, after)
    if kind == KNOWN:
        return is_after_news(present, permitted and is_news_for(present, offer), now, after)
    if kind == LEFT:
        return is_after_leaving(present, now, after)
    return after == present
