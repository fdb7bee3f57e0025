"""How the vehicles that merge at a fix, its members, agree on slots; pure functions on a member's state.

At each heartbeat a member sends its whole state to the others: its term and vote, its request, its grants, and, as
leader, its proposals. So the next message makes up for a lost one, and an overtaken or duplicate one is ignored.
Members elect a leader by terms; the leader proposes slots; a slot is valid once a majority of the members has granted
it for the vehicle's present request. Kernels (`core.merging`) decide what a member grants, so valid slots are apart even if
several members take themselves for the leader.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.merging.grants import Grant, grant_asked, has_room
from cratous.core.merging.slots import Wanted, slots_of
from cratous.core.merging.votes import Seat, is_majority, seat_asked, seat_stands, tally
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position

FOLLOWS, STANDS, LEADS = 0, 1, 2
LOST_MS = 2000
"""Silence after which the first member takes the leader for lost [ms]."""
LATER_MS = 1000
"""Each member takes it for lost this much later than the one before it, so that not all stand at once [ms]."""
WAITS_MS = 6000
"""Time after which a request without a slot is replaced by a new one [ms]."""
STALE_MS = 3000
"""Age from which a member's request is no longer scheduled [ms]."""
NOTHING = Grant(0, 0)


class Slot(NamedTuple):
    """A time at the fix [ms] for one request of a vehicle; request: its number."""

    vehicle_id: int
    request: int
    time: int


class Wish(NamedTuple):
    """A vehicle's request and its window at the fix [ms]. request: its number, 0 for none."""

    request: int = 0
    earliest: int = 0
    latest: int = 0


class Said(NamedTuple):
    """A member's message at a heartbeat.

    at_ms: when it was sent [ms]; term, voted, role: of the election; book: its last grant to each vehicle; proposed:
    slots it proposes as leader; flies: the route flown by its ICAROUS, () if UxAS flies.
    """

    member: int
    at_ms: int
    term: int
    voted: int
    role: int
    wish: Wish
    book: tuple[Slot, ...]
    proposed: tuple[Slot, ...] = ()
    flies: tuple[Position, ...] = ()


class Talks(NamedTuple):
    """Fixed configuration: the members in order of their ids, this member's id, and the time between slots [ms]."""

    members: tuple[int, ...]
    me: int
    apart_ms: int


class Merger(NamedTuple):
    """State of a member.

    seat, role: of the election; led_ms: when it last heard a leader or candidate, led or stood [ms]; book, proposed: as
    in `Said`; heard: the last message of each other member; wish, asked_ms: its request, and when it was made [ms];
    requests: number of requests so far.
    """

    seat: Seat = Seat(0, 0)
    role: int = FOLLOWS
    led_ms: int = 0
    book: tuple[Slot, ...] = ()
    proposed: tuple[Slot, ...] = ()
    heard: tuple[Said, ...] = ()
    wish: Wish = Wish()
    asked_ms: int = 0
    requests: int = 0


def hear(talks: Talks, merger: Merger, said: Said, now_ms: int) -> Merger:
    """The state after another member's message. BadInput if the sender is not another member."""
    if said.member not in talks.members or said.member == talks.me:
        members = ", ".join(map(str, talks.members))
        raise BadInput(
            "not of this fix", item="member", expected=f"another of {members}", got=str(said.member)
        )
    before = _last(merger, said.member)
    if before is not None and not lasted(before.at_ms, said.at_ms, 1):
        return merger  # overtaken by a newer message, which contains its content
    others = tuple(one for one in merger.heard if one.member != said.member)
    merger = merger._replace(heard=(*others, said))
    # a vote in a newer term shows that there is one
    whom = said.member if said.role != FOLLOWS else said.voted
    newer = said.term > merger.seat.latest
    if whom and (newer or said.role != FOLLOWS):
        vote = seat_asked(merger.seat, said.term, whom)
        if newer or (vote.yes and whom != talks.me):
            merger = merger._replace(role=FOLLOWS, proposed=())
        merger = merger._replace(seat=vote.seat)
        if vote.yes and said.role != FOLLOWS:
            merger = merger._replace(led_ms=now_ms)
        if vote.yes and said.role == LEADS:
            merger = _granted(talks, merger, said.proposed)
    return merger


def beat(
    talks: Talks, merger: Merger, flies: tuple[Position, ...], now_ms: int
) -> tuple[Merger, Said]:
    """The state after a heartbeat, in which the member may stand or lead, and its message to the others.

    merger: with its present request; flies: as in `Said`.
    """
    if merger.role == STANDS and _elected(talks, merger):
        merger = merger._replace(role=LEADS, proposed=())
    if merger.role != LEADS:
        waits_ms = LOST_MS + LATER_MS * talks.members.index(talks.me)
        if not in_time(merger.led_ms, now_ms, waits_ms):
            standing = seat_stands(merger.seat, talks.me)
            role = STANDS if standing.stands else FOLLOWS
            merger = merger._replace(seat=standing.seat, role=role, led_ms=now_ms, proposed=())
    if merger.role == LEADS:
        merger = merger._replace(proposed=_proposals(talks, merger, now_ms), led_ms=now_ms)
        merger = _granted(talks, merger, merger.proposed)
    seat = merger.seat
    said = (talks.me, now_ms, seat.latest, seat.voted, merger.role)
    return merger, Said(*said, merger.wish, merger.book, merger.proposed, flies)


def asked(merger: Merger, wants: bool, anew: bool, now_ms: int) -> tuple[Merger, int]:
    """The number of the vehicle's request, 0 if it needs no slot.

    wants: whether it needs a slot; anew: whether it gives up its present request, with the slot that it has or may
    get, for a new one.
    """
    request = merger.wish.request
    if not wants or (request and not anew):
        return merger, request if wants else 0
    number = merger.requests + 1
    return merger._replace(asked_ms=now_ms, requests=number), number


def waited(merger: Merger, now_ms: int) -> bool:
    """Whether the present request is so old that it is replaced if it has no slot."""
    return not in_time(merger.asked_ms, now_ms, WAITS_MS)


def slot_of(talks: Talks, merger: Merger, vehicle_id: int, request: int) -> int | None:
    """The time [ms] that a majority has granted for a request of a vehicle; None if there is none."""
    if not request:
        return None
    books = [merger.book, *(one.book for one in merger.heard)]
    found = [s.time for b in books for s in b if (s.vehicle_id, s.request) == (vehicle_id, request)]
    for time in sorted(set(found)):
        count = tally((one == time,) for one in found)
        if is_majority(count, len(talks.members)):
            return time
    return None


def leader_of(merger: Merger, me: int) -> int:
    """Id of the leader of the member's term, as far as the member knows; 0 for none."""
    if merger.role == LEADS:
        return me
    term = merger.seat.latest
    leads = (one.member for one in merger.heard if one.role == LEADS and one.term == term)
    return next(leads, 0)


def _last(merger: Merger, member: int) -> Said | None:
    return next((one for one in merger.heard if one.member == member), None)


def _elected(talks: Talks, merger: Merger) -> bool:
    mine = (merger.seat.latest, talks.me)
    votes = [
        (merger.seat.latest, merger.seat.voted),
        *((one.term, one.voted) for one in merger.heard),
    ]
    return is_majority(tally((vote == mine,) for vote in votes), len(talks.members))


def _granted(talks: Talks, merger: Merger, proposed: tuple[Slot, ...]) -> Merger:
    """The state after this member's answers to the proposed slots."""
    book = {one.vehicle_id: Grant(one.request, one.time) for one in merger.book}
    for vehicle_id, request, time in proposed:
        others = [grant for number, grant in book.items() if number != vehicle_id]
        room = has_room(others, time, talks.apart_ms)
        answer = grant_asked(book.get(vehicle_id, NOTHING), Grant(request, time), room)
        book[vehicle_id] = answer.grant
    kept = tuple(Slot(number, *grant) for number, grant in sorted(book.items()) if grant.request)
    return merger._replace(book=kept)


def _wishes(talks: Talks, merger: Merger, now_ms: int) -> Iterator[tuple[int, Wish]]:
    """The known requests that are not stale, by vehicle."""
    yield talks.me, merger.wish
    for one in merger.heard:
        if in_time(one.at_ms, now_ms, STALE_MS):
            yield one.member, one.wish


def _proposals(talks: Talks, merger: Merger, now_ms: int) -> tuple[Slot, ...]:
    """The leader's proposals: slots already proposed or granted stay; each other request gets one if possible."""
    wishes = {who: wish for who, wish in _wishes(talks, merger, now_ms) if wish.request}
    books = [merger.proposed, merger.book, *(one.book for one in merger.heard)]
    taken = dict[int, Slot]()
    for who in talks.members:
        slots = [slot for book in books for slot in book if slot.vehicle_id == who]
        request = (
            wishes[who].request if who in wishes else max((s.request for s in slots), default=0)
        )
        now = [slot for slot in slots if slot.request == request]
        if now:
            # its own proposal, else the one with the most grants
            ours = [slot for slot in merger.proposed if slot in now]
            taken[who] = (
                ours[0] if ours else max(now, key=lambda slot: (now.count(slot), -slot.time))
            )
    new = {who: wish for who, wish in wishes.items() if who not in taken}
    fixed = [Wanted(who, slot.time, slot.time) for who, slot in taken.items()]
    fixed = [one for one in fixed if not lasted(one.latest, now_ms, talks.apart_ms)]
    windows = [Wanted(who, wish.earliest, wish.latest) for who, wish in new.items()]
    if (all_of := slots_of([*fixed, *windows], talks.apart_ms)) is not None:
        times = dict(all_of)
        taken |= {who: Slot(who, wish.request, times[who]) for who, wish in new.items()}
        return tuple(taken[who] for who in sorted(taken))
    # there is no slot for all: the first to arrive get theirs
    for who in sorted(new, key=lambda number: (new[number].earliest, number)):
        window = Wanted(who, new[who].earliest, new[who].latest)
        found = slots_of([*fixed, window], talks.apart_ms)
        if found is not None:
            time = dict(found)[who]
            taken[who] = Slot(who, new[who].request, time)
            fixed.append(Wanted(who, time, time))
    return tuple(taken[who] for who in sorted(taken))
