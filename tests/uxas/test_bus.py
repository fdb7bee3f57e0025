"""The bus: who gets what, in which order, at which virtual time."""

from __future__ import annotations

import pytest

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope, Identity, Send, Wake


class Listener:
    """Keeps what it gets; answers with what `answers` says."""

    def __init__(self, name, *subscribes, prefixes=(), answers=(), begin=()):
        self.name, self.subscribes, self.prefixes = name, subscribes, prefixes
        self.answers, self.got, self.woken, self.stopped = list(answers), [], [], False
        self._begin = begin

    def start(self):
        return 0

    def begin(self, state):
        return state, self._begin

    def handle(self, state, envelope, now_ms):
        self.got.append((envelope.topic.rpartition(".")[2], envelope.source, now_ms))
        return state + 1, self.answers.pop(0) if self.answers else ()

    def wake(self, state, key, now_ms):
        self.woken.append((key, now_ms))
        return state, [Wake(100, key)] if len(self.woken) < 3 else ()

    def stop(self, state):
        self.stopped = True


def kinds(listener):
    return [topic for topic, _, _ in listener.got]


STATE = "afrl.cmasi.AirVehicleState"


def make(*listeners, **options):
    bus = Bus(lmcp.full_names, **options)
    for k, listener in enumerate(listeners):
        bus.add(listener, Identity(100, 51 + k))
    return bus


def test_a_type_reaches_its_own_and_base_subscribers_and_prefixes():
    own, base = Listener("own", STATE), Listener("base", "afrl.cmasi.EntityState")
    series, other = Listener("series", prefixes=("afrl.cm",)), Listener("other", "afrl.cmasi.Task")
    bus = make(own, base, series, other)
    bus.publish(lmcp.new("AirVehicleState"), "x")
    bus.publish(lmcp.new("EntityState"), "x")
    bus.publish(lmcp.new("CreateNewService"), "x")
    bus.run()
    assert kinds(own) == ["AirVehicleState"]
    assert kinds(base) == ["AirVehicleState", "EntityState"]
    assert kinds(series) == ["AirVehicleState", "EntityState"]
    assert kinds(other) == []


def test_what_sends_out_receives_before_the_services_that_came_earlier():
    order = []

    class Noting(Listener):
        def handle(self, state, envelope, now_ms):
            order.append((self.name, envelope.packed))
            return state, ()

    first, out, other = (Noting(name, STATE) for name in ("first", "out", "other"))
    out.outlet = True
    bus = make(first, out, other)
    state = lmcp.new("AirVehicleState", ID=7)
    bus.publish(state, "x")
    bus.run()
    assert [name for name, _ in order] == ["out", "first", "other"]
    assert {id(packed) for _, packed in order} == {id(order[0][1])}  # encoded once
    assert order[0][1] == lmcp.binary.pack(state)


def test_a_subscription_to_a_type_is_no_prefix():
    listener = Listener("a", "afrl.cmasi.Task")
    bus = make(listener)
    bus.publish(lmcp.new("TaskInitialized"), "x")
    bus.publish(lmcp.new("LineSearchTask"), "x")
    bus.run()
    assert kinds(listener) == ["LineSearchTask"]


def test_unicast_cast_to_all_and_groups():
    first, second = Listener("a", STATE), Listener("b", STATE, "fusion")
    far = Listener("c", prefixes=("eid200",))
    bus = make(first, second, far)
    body = lmcp.new("AirVehicleState")
    for address in ("eid100.sid51", "eid100.sid5", "eid100.sidall", "fusion", "eid200.sid51"):
        bus.publish(body, "x", address)
    bus.run()
    # eid100.sid5 is nobody's: a service's address is exact, not a prefix of sid51
    assert (len(first.got), len(second.got), len(far.got)) == (2, 2, 1)
    bus.publish(lmcp.new("TaskInitialized"), "x", "eid100.sid51")
    bus.run()
    assert kinds(first)[2:] == [], "its own address does not bring it what it does not know"


def test_a_group_is_reached_by_its_name():
    one, two, other = Listener("a", STATE), Listener("b", STATE), Listener("c", STATE)
    bus = Bus(lmcp.full_names)
    for k, (listener, group) in enumerate(((one, "uavs"), (two, "uavs"), (other, ""))):
        bus.add(listener, Identity(100, 51 + k, group))
    seen: list[Envelope] = []
    bus.tap(seen.append)
    bus.publish(lmcp.new("AirVehicleState"), "a", "uavs")
    bus.run()
    assert (len(one.got), len(two.got), len(other.got)) == (1, 1, 0)
    assert seen[0].group == "uavs"


def test_sends_carry_address_and_group_and_the_senders_identity():
    sender = Listener("s", STATE, answers=[[Send(lmcp.new("KeyValuePair"), "fusion", "g")]])
    bus = make(sender)
    seen: list[Envelope] = []
    bus.tap(seen.append)
    bus.publish(lmcp.new("AirVehicleState"), "x")
    bus.run()
    last = seen[-1]
    assert (last.address, last.to, last.group) == ("fusion", "fusion", "g")
    assert (last.source, last.entity_id, last.service_id) == ("s", 100, 51)
    assert seen[0].to == STATE


def test_without_echo_a_service_does_not_hear_itself():
    body = lmcp.new("AirVehicleState")
    for echo, count in ((True, 2), (False, 1)):
        listener = Listener("a", STATE, answers=[[body]])
        bus = make(listener, echo=echo)
        bus.publish(body, "x")
        bus.run()
        assert len(listener.got) == count


def test_wakes_come_at_their_own_times_in_order():
    first, second = Listener("a", begin=[Wake(100, "a")]), Listener("b", begin=[Wake(100, "b")])
    bus = make(first, second)
    assert bus.next_wake_ms() == 100
    bus.run_until(1000)
    assert first.woken == [("a", 100), ("a", 200), ("a", 300)]
    assert second.woken == [("b", 100), ("b", 200), ("b", 300)]
    assert bus.now_ms == 1000
    assert bus.next_wake_ms() is None


def test_messages_are_stamped_when_they_are_delivered():
    bus = make()
    seen: list[Envelope] = []
    bus.tap(seen.append)
    bus.publish(lmcp.new("KeyValuePair"), "x")
    bus.now_ms = 7
    bus.run()
    assert seen[0].time_ms == 7


def test_a_service_that_leaves_is_stopped_and_gets_nothing_more():
    listener = Listener("a", STATE, begin=[Wake(50, "a")])
    bus = make(listener)
    bus.publish(lmcp.new("AirVehicleState"), "x")
    bus.remove("a")
    bus.run_until(1000)
    assert listener.stopped
    assert (listener.got, listener.woken, bus.names()) == ([], [], ())
    bus.add(Listener("a", STATE))  # its name is free again
    with pytest.raises(ValueError, match="already"):
        bus.add(Listener("a", STATE))


def test_a_service_that_leaves_during_a_delivery_misses_that_message():
    class Killer(Listener):
        def handle(self, state, envelope, now_ms):
            self.bus.remove("b")
            return state, ()

    killer, victim = Killer("k", STATE), Listener("b", STATE)
    killer.bus = bus = make(killer, victim)
    bus.publish(lmcp.new("AirVehicleState"), "x")
    bus.run()
    assert victim.got == []


def test_a_fault_keeps_the_state_and_the_others_go_on():
    class Bad(Listener):
        def handle(self, state, envelope, now_ms):
            raise ZeroDivisionError

    faults = []
    good = Listener("good", STATE)
    bus = make(Bad("bad", STATE), good, on_fault=lambda *found: faults.append(found))
    bus.publish(lmcp.new("AirVehicleState"), "x")
    bus.run()
    assert (faults[0][0], type(faults[0][2]), bus.state("bad")) == ("bad", ZeroDivisionError, 0)
    assert len(good.got) == 1
    loud = make(Bad("bad", STATE))
    loud.publish(lmcp.new("AirVehicleState"), "x")
    with pytest.raises(ZeroDivisionError):
        loud.run()


def test_messages_from_outside_keep_their_sender_and_get_the_next_number():
    bus = make()
    seen: list[Envelope] = []
    bus.tap(seen.append)
    bus.publish(lmcp.new("KeyValuePair"), "x")
    body = lmcp.new("AirVehicleState")
    bus.put(Envelope(99, 5, "tcp", STATE, body, "", "g", 400, 7, b"raw"))
    bus.run()
    assert [e.seq for e in seen] == [0, 1]
    last = seen[1]
    assert (last.entity_id, last.service_id, last.group, last.raw) == (400, 7, "g", b"raw")
