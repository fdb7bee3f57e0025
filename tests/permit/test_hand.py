"""The certificate in hand under loss, doubling, delay and reordering: clear as long as it says."""

from __future__ import annotations

import random

import pytest

from cratous.core.permit.hand import Hand, Offer, accepts, hand_offered, hand_told

HAND = Hand(7, 3, 10_000, 0)
GOOD = Offer(8, 7, 1_500, 3, 12_000)


@pytest.mark.parametrize(
    ("offer", "accepted"),
    [
        (GOOD, True),
        (GOOD._replace(base=6), False),  # begins on another one: it was overtaken
        (GOOD._replace(knowledge=2), False),  # does not know the newcomer
        (GOOD._replace(sigma_ms=999), False),  # begins in the past
        (GOOD._replace(sigma_ms=1_000), True),
        (GOOD._replace(sigma_ms=10_000), True),
        (GOOD._replace(sigma_ms=10_001), False),  # begins when the hand has expired
        (GOOD._replace(expiry_ms=6_000), True),  # shorter, but the reserve is left
        (GOOD._replace(expiry_ms=5_999), False),
    ],
)
def test_which_offers_are_accepted(offer: Offer, accepted: bool) -> None:
    assert accepts(HAND, offer, 1_000, 5_000) is accepted
    after = hand_offered(HAND, offer, 1_000, 5_000)
    assert after == (Hand(8, 3, offer.expiry_ms, 0) if accepted else HAND)


def test_what_becomes_known() -> None:
    assert hand_told(HAND, True, 2_000) == Hand(7, 4, 10_000, 0)
    assert hand_told(HAND, False, 2_000) == Hand(7, 4, 2_000, 1)
    assert not accepts(hand_told(HAND, True, 2_000), GOOD, 1_000, 5_000)


def test_a_channel_that_does_what_it_likes() -> None:
    """Each certificate is clear until it expires, and not after; the vehicle is never where it is not."""
    draw = random.Random(5)
    accepted = 0
    for _ in range(200):
        # the instants up to which each trajectory is clear, if it is flown from its begin on
        trajectories: dict[int, list[tuple[int, int]]] = {0: [(0, 0)]}
        expiry = {0: 5_000}
        hand, sent, now, number = Hand(0, 0, 5_000, 0), list[Offer](), 0, 0
        while now < 60_000 and now < hand.expiry_ms:
            number += 1
            sigma = now + draw.choice([0, 500, 1_000, 30_000, -500])
            offer = Offer(number, hand.id, sigma, 0, now + draw.choice([500, 4_000, 8_000]))
            trajectories[number] = [*trajectories[hand.id], (sigma, number)]
            expiry[number] = offer.expiry_ms
            sent.append(offer)
            for _ in range(draw.randrange(3)):
                came = draw.choice(sent)  # late, twice, or never
                after = hand_offered(hand, came, now, 2_000)
                accepted += after != hand
                assert after.expiry_ms >= min(hand.expiry_ms, now + 2_000)
                hand = after
            flown = [k for begin, k in trajectories[hand.id] if begin <= now][-1]
            assert now < expiry[flown]
            now += 500
    assert accepted > 100
