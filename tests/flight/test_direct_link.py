"""ICAROUS of two vehicles when UxAS is gone: by the direct link they keep well clear of each other, without it they do not;
and what is taken of what a vehicle says of itself."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from icarous_tools import PROJECTION, VOLUME
from uxas_tools import free_port

from cratous.bridge import text_protocol as tp
from cratous.bridge.port import Address, address
from cratous.bridge.text_port import TextPort
from cratous.bridge.text_protocol.datagrams import MOST_VEHICLES, NOT_HEARD, REPEATED, Datagrams
from cratous.bridge.text_protocol.keys import Keys
from cratous.core.authority.gate import ICAROUS
from cratous.core.avoidance.manoeuvre import Ability, Motion, fly_to
from cratous.core.avoidance.prediction import EXACT
from cratous.services.flight.dynamics import Limits
from cratous.services.icarous.other_vehicles import LINK_LOST_MS
from cratous.services.icarous.state import Config
from cratous.services.icarous_program.direct import NO_STATE, DirectLink
from cratous.services.icarous_program.program import Besides, Program
from cratous.services.icarous_program.step import Craft, IcarousEnd, Note, Refuse, State, Tell
from cratous.services.icarous_program.traffic import TRAFFIC_KEPT_MS, spread_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa, Position, Velocity

LIMITS = Limits(15.0, 33.0, math.radians(30.0), 5.0)
ABILITY = Ability(0.257, 15.0, 33.0, 5.0, 1.0, 60.0)
KEYS = {1: b"a" * 32, 2: b"b" * 32}
HEADINGS = {1: 0.0, 2: math.pi / 2}
STARTS = {1: Position(-2200.0, 0.0, 300.0), 2: Position(0.0, -2200.0, 300.0)}
ENDS = {1: Position(3000.0, 0.0, 300.0), 2: Position(0.0, 3000.0, 300.0)}


def end_of(vid: int) -> IcarousEnd:
    config = Config(vid, Daa(VOLUME), PROJECTION, 500)
    return IcarousEnd(Craft(config, LIMITS, 60.0, frozenset({1, 2})))


def own(vid: int, now_s: float, m: Motion) -> tp.OwnPosition:
    lat, lon = PROJECTION.to_geodetic(m.position.north_m, m.position.east_m)
    north, east = m.speed_m_s * math.cos(m.heading_rad), m.speed_m_s * math.sin(m.heading_rad)
    alt = m.position.alt_m
    return tp.OwnPosition(now_s, lat, lon, alt, alt, north, east, -m.climb_m_s, vehicle_id=vid)


def seen(vid: int, m: Motion) -> tp.Traffic:
    line = own(vid, 0.0, m)
    return tp.Traffic(
        "TRAFFIC", line.lat_deg, line.long_deg, line.alt_abs_m, line.north_mps, line.east_mps,
        line.down_mps, vid,
    )  # fmt: skip


def plan(vid: int) -> list[tp.Message]:
    out: list[tp.Message] = [tp.SoftReset()]
    for k, place in enumerate((STARTS[vid], ENDS[vid])):
        lat, lon = PROJECTION.to_geodetic(place.north_m, place.east_m)
        out.append(tp.Waypoint(2, 22.0, lat, lon, place.alt_m, k))
    return [*out, tp.StartMission(), tp.WaypointReached(0)]


class Vehicle:
    """One vehicle, its ICAROUS, and its end of the direct link."""

    def __init__(self, vid: int) -> None:
        self.vid, self.end, self.state = vid, end_of(vid), State()
        self.link = Datagrams(vid, KEYS)
        self.motion = Motion(STARTS[vid], HEADINGS[vid], 22.0, 0.0)
        self.wanted: tp.SetVelocity | None = None
        self.answers = list[Any]()
        for line in plan(vid):
            self.take(self.end.handle(self.state, line))

    def take(self, step: Any) -> None:
        self.state, answers = step
        self.answers += answers
        for answer in answers:
            if isinstance(answer, Tell) and isinstance(answer.line, tp.SetVelocity):
                self.wanted = answer.line

    def hear(self, data: bytes) -> Any:
        said = self.link.open(data)
        line = getattr(said, "line", None)
        if line is not None:
            (one,) = tp.StreamParser(tp.Direction.DOWN).feed(line)
            assert isinstance(one, tp.OwnPosition)
            self.take(self.end.peer(self.state, 3 - self.vid, one))
        return said

    def fly(self) -> None:
        """Half a second."""
        m = self.motion
        heading, speed, climb = m.heading_rad, m.speed_m_s, 0.0
        if self.wanted is not None and self.state.gate.owner == ICAROUS:
            w = self.wanted
            heading, speed, climb = (
                math.atan2(w.east_mps, w.north_mps), math.hypot(w.north_mps, w.east_mps), -w.down_mps,
            )  # fmt: skip
        pieces = fly_to(m, ABILITY, heading, speed, climb, 0.5, 0.5)
        last = pieces[-1]
        t = 0.5 - last.start_s
        v, p = last.velocity, last.position
        place = Position(
            p.north_m + v.north_m_s * t, p.east_m + v.east_m_s * t, p.alt_m - v.down_m_s * t
        )
        course = math.atan2(v.east_m_s, v.north_m_s)
        self.motion = Motion(place, course, math.hypot(v.north_m_s, v.east_m_s), -v.down_m_s)


def nearest_m(wire: Callable[[float, bytes], list[bytes]], gone_s: float = 15.0) -> Any:
    """Both fly towards one point; UxAS is gone from then on. wire: what comes of a datagram that is sent."""
    both = Vehicle(1), Vehicle(2)
    nearest = math.inf
    for k in range(300):
        now_s = k / 2
        for one, other in (both, both[::-1]):
            line = own(one.vid, now_s, one.motion)
            if now_s < gone_s:
                one.take(one.end.handle(one.state, line))
                one.take(one.end.handle(one.state, seen(other.vid, other.motion)))
            elif now_s >= gone_s + LINK_LOST_MS / 1000:
                one.take(one.end.alone(one.state, line, 0))
            for data in wire(now_s, one.link.wrap(tp.encode(line), round(1000 * now_s))):
                other.hear(data)
        for one in both:
            one.fly()
        a, b = both[0].motion.position, both[1].motion.position
        if abs(a.alt_m - b.alt_m) < VOLUME.zthr_m:
            nearest = min(nearest, math.hypot(a.north_m - b.north_m, a.east_m - b.east_m))
    return nearest, both


def test_when_uxas_is_gone_the_direct_link_keeps_them_apart_and_nothing_else_does() -> None:
    apart_m, both = nearest_m(lambda _now_s, data: [data])
    assert apart_m > VOLUME.dthr_m
    notes = [a.text for v in both for a in v.answers if isinstance(a, Note)]
    assert any("UxAS does not tell it; avoided by its own word" in text for text in notes)
    assert any("ICAROUS takes over: traffic" in text for text in notes)
    alone_m, both = nearest_m(lambda _now_s, _data: [])
    assert alone_m < VOLUME.dthr_m
    notes = [a.text for v in both for a in v.answers if isinstance(a, Note)]
    assert any("not heard of for 5000 ms, no longer avoided" in text for text in notes)


def test_a_direct_link_that_repeats_and_overtakes_is_as_good() -> None:
    by_sender: dict[bytes, list[bytes]] = {}

    def wire(_now_s: float, data: bytes) -> list[bytes]:
        held = by_sender.setdefault(data.split(b",")[4], [])
        held.append(data)
        if len(held) < 3:
            return []
        later = held[::-1]
        held.clear()
        return [*later, *later]

    apart_m, _ = nearest_m(wire)
    assert apart_m > VOLUME.dthr_m


def test_recorded_states_of_another_place_are_not_taken_as_traffic() -> None:
    """A stranger who sends all that he has recorded, again and again, changes nothing."""
    recorded = list[bytes]()

    def wire(_now_s: float, data: bytes) -> list[bytes]:
        again = recorded[-40:-2]
        recorded.append(data)
        return [*again, data, *again]

    assert nearest_m(wire)[0] == nearest_m(lambda _now_s, data: [data])[0]


def test_objct_counts_as_long_as_it_comes_and_then_the_own_word_with_what_its_age_leaves_open() -> (
    None
):
    end, here = end_of(1), Motion(STARTS[1], 0.0, 22.0, 0.0)
    state, _ = end.handle(State(), own(1, 1.0, here))
    there = Motion(STARTS[2], HEADINGS[2], 22.0, 0.0)
    elsewhere = Motion(Position(5000.0, 5000.0, 300.0), 0.0, 22.0, 0.0)
    state, _ = end.handle(state, seen(2, there))
    state, _ = end.peer(state, 2, own(2, 1.0, elsewhere))
    state, _ = end.handle(state, own(1, 2.0, here))
    assert (state.selves, set(state.seen)) == (frozenset(), {2})
    state, answers = end.alone(state, own(1, 3.0, here), 0)  # OBJCT is 2 s old now
    assert state.selves == {2}
    assert [a.severity for a in answers if isinstance(a, Note)] == ["WARN"]
    assert spread_of(0.0, Velocity(22.0, 0.0, 0.0), ABILITY) == EXACT
    young, old = (spread_of(age, Velocity(22.0, 0.0, 0.0), ABILITY) for age in (0.5, 2.0))
    assert 0 < young.wide_m < old.wide_m
    # within what a turn at full bank makes of 2 s: v (1 - cos wt) / w
    assert old.wide_m >= 22.0 * (1 - math.cos(0.257 * 2)) / 0.257
    assert old.high_m >= 5.0 * 2
    state, answers = end.alone(state, own(1, 6.5, here), 0)
    assert not state.direct
    assert any("no longer avoided" in a.text for a in answers if isinstance(a, Note))


@pytest.mark.parametrize(
    ("sender", "line", "why"),
    [
        (2, own(3, 10.0, Motion(STARTS[2], 0.0, 22.0, 0.0)), "another vehicle than the sender"),
        (1, own(1, 10.0, Motion(STARTS[2], 0.0, 22.0, 0.0)), "another vehicle than the sender"),
        (2, own(2, 12.001, Motion(STARTS[2], 0.0, 22.0, 0.0)), "of another time"),
        (2, own(2, 10 - TRAFFIC_KEPT_MS / 1000, Motion(STARTS[2], 0.0, 22.0, 0.0)), "of another time"),
    ],
)  # fmt: skip
def test_what_cannot_be_a_state_of_the_sender_now_is_refused(
    sender: int, line: tp.OwnPosition, why: str
) -> None:
    end = end_of(1)
    state, _ = end.handle(State(), own(1, 10.0, Motion(STARTS[1], 0.0, 22.0, 0.0)))
    after, answers = end.peer(state, sender, line)
    assert after == state
    assert [why in a.why for a in answers if isinstance(a, Refuse)] == [True]


def test_one_that_was_overtaken_does_not_bring_back_an_older_state() -> None:
    end, there = end_of(1), Motion(STARTS[2], HEADINGS[2], 22.0, 0.0)
    state, _ = end.handle(State(), own(1, 10.0, Motion(STARTS[1], 0.0, 22.0, 0.0)))
    state, _ = end.peer(state, 2, own(2, 10.0, there))
    assert end.peer(state, 2, own(2, 9.5, there)) == (state, ())


def test_waypoints_that_the_autopilot_passes_alone_are_behind() -> None:
    one = Vehicle(1)
    one.take(one.end.handle(one.state, own(1, 1.0, one.motion)))
    one.take(one.end.alone(one.state, own(1, 4.0, one.motion), 7))
    assert one.state.instance.told.next_index == 2
    assert one.state.instance.told.heard_ms == 1000, "UxAS has said nothing"


GROUP = f"udp://239.255.77.2:{free_port()}"


def links(count: int, said: list[str]) -> list[DirectLink]:
    keys = Keys(KEYS)
    where = address(GROUP, ("udp",))
    return [
        DirectLink(k + 1, keys, where, lambda _s, text: said.append(text)) for k in range(count)
    ]


def until(done: Callable[[], object]) -> None:
    limit_s = time.monotonic() + 60
    while not done():
        assert time.monotonic() < limit_s, "it does not come"


def test_two_ends_hear_each_other_and_count_what_they_drop(opened: list[Any]) -> None:
    said = list[str]()
    one, two = links(2, said)
    opened += [one, two]
    state = own(1, 1.0, Motion(STARTS[1], 0.0, 22.0, 0.0))
    one.say(state)
    until(lambda: two.step() or two.counts.refused[NOT_HEARD])
    two.say(replace(state, vehicle_id=2))
    found = list[Any]()
    until(lambda: found.extend(one.step()) or found)
    assert (found[0].vehicle_id, found[0].line.vehicle_id) == (2, 2)
    # the others are told nothing but states
    data = one._datagrams.wrap(tp.encode(tp.WaypointReached(3)), 1000)
    one._port.send(data)
    one._port.send(data)
    until(lambda: two.step() or two.counts.refused[REPEATED])
    assert two.counts.refused[NO_STATE] == 1
    assert any(REPEATED in text for text in said)
    many = Keys(dict.fromkeys(range(MOST_VEHICLES + 1), b"k" * 32))
    with pytest.raises(BadInput, match="too many vehicles"):
        DirectLink(1, many, address(GROUP, ("udp",)), lambda _s, _t: None)


def test_a_program_tells_its_state_directly_at_each_that_it_believes(opened: list[Any]) -> None:
    one, two = links(2, [])
    opened.append(two)
    where = Address("tcp", "127.0.0.1", free_port(), "tcp://127.0.0.1")
    port = TextPort(where, server=False)
    program = Program(end_of(1), port, lambda _s, _t: None, besides=Besides(one))
    opened += [port, one]
    here = Motion(STARTS[1], 0.0, 22.0, 0.0)
    for line in (own(1, 1.0, here), own(1, 0.5, here), own(1, 2.0, here)):
        program._line(line)
    assert one.counts.sent == 2, "that of an earlier time is not believed"
    until(lambda: two.step() or two.counts.refused[NOT_HEARD] == 2)
