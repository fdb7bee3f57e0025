"""The certificate in hand of one vehicle, offers of ICAROUS in transit, and what is really flown and clear.

The steps are those of the kernel `hand_step`. Offers may arrive late, twice or never; new tracks are detected on
board, so each answer arrives once, at once or later. Beside the hand the search keeps the true situation: which
trajectory is flown, and until when it is clear of all that is known, according to what each offer was permitted for.
A certificate is wrong when the hand claims more than that. Times are in heartbeats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from cratous.core.permit import hand as hands
from cratous.core.permit.hand import KNOWN, LEFT, OFFERED, Hand, Offer
from cratous.spec.system import hand_trace

RESERVE = 2
"""The least number of heartbeats that remain certain after an offer, if more than that was certain before."""
LONG, SHORT, LATER = 4, 1, 5
"""How long an offered manoeuvre is permitted (long, short), and after how many heartbeats a later one begins."""
MOST_OFFERS, MOST_NEWS, MOST_LEFT, LAST = 2, 2, 1, 5
"""Bounds of the search: offers, tracks that become known, trajectories left, and the last heartbeat."""
TIME = 3
"""An event of `hand_step`: only time passes."""
NO_OFFER = Offer(0, 0, 0, 0, 0)
HandStep = Callable[[Hand, int, Offer, bool, int, int], Hand]


class Sent(NamedTuple):
    """offer: as the hand receives it; flies: number of its trajectory; begins_on: the trajectory flown when it was
    made; knows: the number of tracks known then."""

    offer: Offer
    flies: int
    begins_on: int
    knows: int


class Answer(NamedTuple):
    """asked: the certificate that was asked about; flies: its trajectory; permitted: whether it is, against the new
    track."""

    asked: Offer
    flies: int
    permitted: bool


class Held(NamedTuple):
    """hand: the state of the kernel; flies, clear_until: the trajectory flown, and until when it is clear of all that
    is known; known: number of known tracks; made: number of trajectories so far; lost: at some time nothing was
    certain; returned: something was certain again afterwards."""

    now: int = 0
    hand: Hand = Hand(0, 0, 0, 0)
    flies: int = 0
    clear_until: int = 0
    known: int = 0
    made: int = 0
    offers: frozenset[Sent] = frozenset()
    answers: frozenset[Answer] = frozenset()
    left: int = 0
    lost: bool = False
    returned: bool = False


class HandEvent(NamedTuple):
    """One event: its description, the state afterwards, the fault, if any, and the event as data."""

    text: str
    after: Held
    wrong: str = ""
    event: hand_trace.Event = hand_trace.Event("")

    @property
    def entry(self) -> hand_trace.Entry:
        """The step as an entry of a trace."""
        now, hand = self.after.now, self.after.hand
        return hand_trace.Entry(
            self.text, self.event, hand_trace.InHand(now, max(now, hand.expiry_ms))
        )


@dataclass(frozen=True)
class HandDesign:
    """The steps: by default the kernel that runs; a seeded fault replaces it. unnoticed: the hand is not told that
    UxAS flies another trajectory after a handback."""

    step: HandStep = hands.hand_step
    unnoticed: bool = False

    def first(self) -> Held:
        """The initial state: nothing is in hand."""
        return Held()

    def steps(self, state: Held) -> Iterator[HandEvent]:
        """All possible next steps."""
        if len(state.offers) < MOST_OFFERS:
            for begins in (0, LATER):
                for lasts in (SHORT, LONG):
                    yield _offers(state, begins, lasts)
        for sent in sorted(state.offers):
            arrives = hand_trace.Event(hand_trace.ARRIVES, sent.flies)
            yield self._arrives(state, sent)._replace(event=arrives)
        if state.known < MOST_NEWS:
            known = hand_trace.Event(hand_trace.KNOWN, state.flies)
            yield _becomes_known(state, True)._replace(event=known)
            yield _becomes_known(state, False)._replace(event=known)
        for answer in sorted(state.answers):
            told = hand_trace.Event(hand_trace.ANSWER, answer.flies, permitted=answer.permitted)
            yield self._told(state, answer)._replace(event=told)
        if state.left < MOST_LEFT:
            left = hand_trace.Event(hand_trace.LEFT, state.made + 1)
            yield self._leaves(state)._replace(event=left)
        if state.now < LAST:
            yield self._passes(state)._replace(event=hand_trace.Event(hand_trace.TIME))

    def _arrives(self, state: Held, sent: Sent) -> HandEvent:
        offer, now, before = sent.offer, state.now, state.hand
        hand = self.step(before, OFFERED, offer, False, now, RESERVE)
        text = f"{_named(sent)} arrives"
        taken = hand.id == offer.id and hand != self.step(
            before, TIME, NO_OFFER, False, now, RESERVE
        )
        if not taken:
            return _judged(f"{text}: refused", state, state._replace(hand=hand))
        fits = (
            sent.begins_on == state.flies
            and now <= offer.sigma_ms <= max(state.clear_until, now)
            and sent.knows == state.known
        )
        until = offer.expiry_ms if fits else now
        after = state._replace(hand=hand, flies=sent.flies, clear_until=until)
        sooner = hand.expiry_ms < min(before.expiry_ms, now + RESERVE)
        wrong = "what is certain ends sooner than it has to" if sooner else ""
        return _judged(f"{text}: TAKEN", state, after, wrong)

    def _told(self, state: Held, answer: Answer) -> HandEvent:
        hand = self.step(state.hand, KNOWN, answer.asked, answer.permitted, state.now, RESERVE)
        says = "permitted" if answer.permitted else "not permitted"
        text = f"the answer arrives: trajectory {answer.flies} is {says} against the new track"
        after = state._replace(hand=hand, answers=state.answers - {answer})
        return _judged(text, state, after)

    def _leaves(self, state: Held) -> HandEvent:
        hand = state.hand
        if not self.unnoticed:
            hand = self.step(hand, LEFT, NO_OFFER, False, state.now, RESERVE)
        made = state.made + 1
        after = state._replace(
            hand=hand, flies=made, made=made, clear_until=state.now, left=state.left + 1
        )
        return _judged(
            f"after a handback UxAS flies trajectory {made}, which is another", state, after
        )

    def _passes(self, state: Held) -> HandEvent:
        now = state.now + 1
        hand = self.step(state.hand, TIME, NO_OFFER, False, now, RESERVE)
        return _judged(f"heartbeat {now}", state, state._replace(now=now, hand=hand))


def _named(sent: Sent) -> str:
    offer = sent.offer
    return (
        f"the offer of trajectory {sent.flies} (begins on {sent.begins_on} at heartbeat {offer.sigma_ms}, "
        f"knows {sent.knows} tracks, permitted until {offer.expiry_ms})"
    )


def _offers(state: Held, begins: int, lasts: int) -> HandEvent:
    """ICAROUS makes an offer on the basis of the present hand, for all that it knows."""
    hand, made = state.hand, state.made + 1
    sigma = state.now + begins
    offer = Offer(hand.id + 1, hand.id, sigma, hand.knowledge, sigma + lasts)
    sent = Sent(offer, made, state.flies, state.known)
    after = state._replace(made=made, offers=state.offers | {sent})
    event = hand_trace.Event(hand_trace.OFFER, made, sigma, offer.expiry_ms)
    return HandEvent(f"ICAROUS makes {_named(sent)}", after, event=event)


def _becomes_known(state: Held, permitted: bool) -> HandEvent:
    """A track becomes known; the trajectory in hand is checked against it, and the hand is told at once or later."""
    hand, known = state.hand, state.known + 1
    asked = Offer(hand.id, hand.id, state.now, hand.knowledge + 1, hand.expiry_ms)
    answer = Answer(asked, state.flies, permitted)
    until = state.clear_until if permitted else min(state.clear_until, state.now)
    after = state._replace(known=known, clear_until=until, answers=state.answers | {answer})
    return HandEvent(
        f"track {known} becomes known, and trajectory {state.flies} is asked about", after
    )


def _judged(text: str, before: Held, after: Held, wrong: str = "") -> HandEvent:
    """The step, with a fault if the hand, once told of all tracks, claims a clear time beyond the true one."""
    hand, now = after.hand, after.now
    says = f"{text}; in hand until {hand.expiry_ms}, {hand.knowledge} tracks"
    told = hand.knowledge >= after.known
    more = told and hand.expiry_ms > max(now, after.clear_until)
    if more and not wrong:
        wrong = (
            f"the hand says that what is flown is clear until {hand.expiry_ms}; trajectory {after.flies} is so only "
            f"until {max(now, after.clear_until)}"
        )
    certain = hand.expiry_ms > now and told
    lost = after.lost or (before.hand.expiry_ms > before.now and hand.expiry_ms <= now)
    returned = after.returned or (after.lost and certain)
    return HandEvent(says, after._replace(lost=lost, returned=returned), wrong)
