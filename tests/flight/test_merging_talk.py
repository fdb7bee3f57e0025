"""Slots at a merge fix, and the agreement on them: with any leader, and lost, late or repeated messages."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations, pairwise, permutations
from random import Random

import pytest

from cratous.core.merging.slots import MOST, Wanted, in_line, slots_of
from cratous.services.icarous.merger import (
    LATER_MS,
    LEADS,
    LOST_MS,
    Merger,
    Said,
    Talks,
    Wish,
    asked,
    beat,
    hear,
    leader_of,
    slot_of,
    waited,
)
from cratous.spec.errors import BadInput

BEAT_MS, APART_MS = 500, 22_000
Lost = Callable[[int, int, int], bool]
"""Whether the message of one member at an instant [ms] to another one is lost."""


def nothing(one: int, other: int, now_ms: int) -> bool:
    """No message is lost."""
    return False


class Members:
    """Members that all arrive at the fix at about one time, and request a slot from an instant on."""

    def __init__(self, count: int, asks_ms: int = 5000, lost: Lost = nothing) -> None:
        ids = tuple(range(1, count + 1))
        self.talks = {n: Talks(ids, n, APART_MS) for n in ids}
        self.states = {n: Merger() for n in ids}
        self.lost, self.asks_ms = lost, asks_ms
        self.now_ms, self.said = 0, list[Said]()
        self.slots: dict[int, int | None] = {}
        self.led: dict[int, set[int]] = {}

    def step(self, anew: frozenset[int] = frozenset()) -> None:
        """A heartbeat of all. anew: members that give up their slots."""
        now, said, self.said = self.now_ms, self.said, []
        for one in said:
            for n in self.talks:
                if n != one.member and not self.lost(one.member, n, now):
                    self.states[n] = hear(self.talks[n], self.states[n], one, now)
        for n, talks in self.talks.items():
            state, wants = self.states[n], now >= self.asks_ms
            slot = slot_of(talks, state, n, state.wish.request)
            again = n in anew or (slot is None and waited(state, now))
            state, request = asked(state, wants, again, now)
            self.slots[n] = None if request != self.states[n].wish.request else slot
            soonest = now + 60_000 + 10 * n
            wish = Wish(request, soonest, soonest + 600_000) if request else Wish()
            state, told = beat(talks, state._replace(wish=wish), (), now)
            self.states[n] = state
            self.said.append(told)
            if state.role == LEADS:
                self.led.setdefault(state.seat.latest, set()).add(n)
        self.now_ms += BEAT_MS
        self.check()

    def check(self) -> None:
        """Invariants: one leader per term; slots apart."""
        assert all(len(leaders) == 1 for leaders in self.led.values()), self.led
        times = [time for time in self.slots.values() if time is not None]
        assert all(abs(a - b) >= APART_MS for a, b in combinations(times, 2)), self.slots

    def run(self, until_ms: int) -> None:
        while self.now_ms < until_ms:
            self.step()

    @property
    def all_have_one(self) -> bool:
        return None not in self.slots.values()


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6])
def test_all_get_a_slot_in_the_order_in_which_they_come(count: int) -> None:
    members = Members(count)
    members.run(9000)
    assert members.all_have_one
    assert sorted(members.slots, key=lambda n: members.slots[n] or 0) == sorted(members.slots)
    # no vehicle waits longer than for those before it
    times = [time for time in members.slots.values() if time is not None]
    assert max(times) - min(times) == APART_MS * (count - 1)
    assert {leader_of(state, n) for n, state in members.states.items()} == {1}


@pytest.mark.parametrize("count", [3, 4, 5, 6])
@pytest.mark.parametrize("lost_ms", [4500, 5500])
def test_a_leader_that_is_lost_is_followed_by_another_in_time(count: int, lost_ms: int) -> None:
    def lost(one: int, other: int, now_ms: int) -> bool:
        return 1 in (one, other) and now_ms >= lost_ms

    members = Members(count, lost=lost)
    members.run(lost_ms)
    assert {leader_of(state, n) for n, state in members.states.items()} == {1}
    term = members.states[1].seat.latest
    members.run(lost_ms + LOST_MS + LATER_MS * count + 4 * BEAT_MS)
    others = [n for n in members.states if n != 1]
    assert {leader_of(members.states[n], n) for n in others} == {2}
    members.run(members.now_ms + 8000)
    assert all(members.slots[n] is not None for n in others)
    assert all(members.states[n].seat.latest > term for n in others)


def test_without_a_majority_nobody_has_a_slot_and_afterwards_everybody() -> None:
    def lost(one: int, other: int, now_ms: int) -> bool:
        return now_ms < 20_000

    members = Members(4, lost=lost)
    members.run(20_000)
    assert set(members.slots.values()) == {None}
    assert not members.led
    members.run(40_000)
    assert members.all_have_one


@pytest.mark.parametrize("seed", range(12))
def test_whatever_is_lost_slots_are_apart_and_each_term_has_one_leader(seed: int) -> None:
    drawn = Random(seed)
    share, count = drawn.choice([0.1, 0.3, 0.6]), drawn.randint(2, 6)

    def lost(one: int, other: int, now_ms: int) -> bool:
        return now_ms < 60_000 and drawn.random() < share

    members = Members(count, lost=lost)
    while members.now_ms < 60_000:
        # now and then a member can no longer use its slot
        members.step(frozenset(n for n in members.states if drawn.random() < 0.02))
    members.run(80_000)
    assert members.all_have_one


@pytest.mark.parametrize("seed", range(8))
def test_late_twice_and_out_of_order_changes_nothing(seed: int) -> None:
    drawn, members = Random(seed), Members(4)
    said = list[Said]()
    for _ in range(160):
        said += members.said
        # any message ever sent, in any order, any number of times
        members.said = [one for one in said if drawn.random() < 0.05]
        drawn.shuffle(members.said)
        members.step()
        said = said[-200:]
    members.run(members.now_ms + 20_000)
    assert members.all_have_one


def test_who_asks_anew_gets_another_slot_and_what_it_had_counts_no_more() -> None:
    members = Members(3)
    members.run(9000)
    before = dict(members.slots)
    members.step(frozenset({2}))
    assert members.slots[2] is None
    members.run(members.now_ms + 4000)
    assert members.all_have_one
    assert members.slots[1] == before[1]
    assert members.slots[3] == before[3]
    assert members.states[2].wish.request == 2


def test_a_stranger_is_refused() -> None:
    talks, said = Talks((1, 2), 1, APART_MS), Said(3, 0, 1, 3, LEADS, Wish(), ())
    with pytest.raises(BadInput, match="not of this fix"):
        hear(talks, Merger(), said, 0)


@pytest.mark.parametrize("seed", range(20))
def test_slots_are_found_exactly_where_some_order_has_them(seed: int) -> None:
    drawn = Random(seed)
    for _ in range(20):
        count = drawn.randint(1, 5)
        wanted = list[Wanted]()
        for n in range(count):
            earliest = drawn.randrange(0, 60)
            wanted.append(Wanted(n, earliest, earliest + drawn.choice([0, 5, 20, 60])))
        windows = {n: (a, b) for n, a, b in wanted}
        possible = any(
            in_line(((a, b) for _, a, b in order), 10).fits for order in permutations(wanted)
        )
        found = slots_of(wanted, 10)
        assert (found is not None) == possible
        if found is not None:
            assert {n for n, _ in found} == set(windows)
            assert all(windows[n][0] <= time <= windows[n][1] for n, time in found)
            times = [time for _, time in found]
            assert all(b - a >= 10 for a, b in pairwise(times))


def test_who_comes_first_goes_first_where_that_is_possible() -> None:
    long = 1000
    wanted = [Wanted(1, 30, long), Wanted(2, 10, long), Wanted(3, 12, long)]
    assert slots_of(wanted, 10) == ((2, 10), (3, 20), (1, 30))
    # one that can be there at one time only goes before one that can wait
    assert slots_of([Wanted(1, 10, long), Wanted(2, 12, 12)], 10) == ((2, 12), (1, 22))
    assert slots_of([Wanted(1, 10, 15), Wanted(2, 12, 18)], 10) is None
    with pytest.raises(ValueError, match="at one fix"):
        slots_of([Wanted(n, 0, 0) for n in range(MOST + 1)], 10)
