"""The UxAS end of the bridge as a step: pure, each vehicle by itself, decided by its kernels."""

from __future__ import annotations

import itertools
import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import flown, meeting, of_type, plain_steps, told_to_icarous, with_deadline

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent
from cratous.bridge.loopback import Bridge
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.core.authority.link_end import Linked
from cratous.services.bus import Bus
from cratous.services.flight import link_end, messages
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.link_end import UxasEnd
from cratous.services.flight.link_peers import State
from cratous.services.flight.loop import FlightResult, fly
from cratous.services.icarous import inbox
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.frames import Projection
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.authority.link_end import SUSPEND, TAKE_BACK
from cratous.spec.mission import Change, Frame, Position, Simulation, Zone, ZoneKind
from cratous.spec.mission.changes import ZONE as ZONE_APPEARS
from cratous.spec.mission.guarantees import Outcome

END = UxasEnd(Projection(Frame(45.0, -121.0, 0.0)))
ZONE = Zone(4, ZoneKind.KEEP_OUT, ((0.0, 0.0), (0.0, 90.0), (90.0, 90.0)), 0.0, 500.0)
WAY = (Position(0.0, 0.0, 300.0), Position(100.0, 0.0, 300.0), Position(300.0, 0.0, 300.0))
AIRCRAFT = tuple((k, AirState(Position(10.0 * k, 0.0, 300.0), 0.0, 20.0, 1.0)) for k in (1, 2, 90))
ALL: tuple[messages.ToLinkEnd, ...] = (
    messages.ZonesKnown((ZONE,)),
    messages.Connected(0, (1, 2)),
    messages.Route(1, WAY, 22.0, 5.0),
    messages.Flown(1, 110.0),
    messages.Beat(0, AIRCRAFT),
    messages.GateIs(1, Gate(ICAROUS, 1, False)),
    messages.Heard(1, 500, tp.SetMode("ACTIVE", 1)),
    messages.Left(1, WAY[1]),
    messages.Heard(1, 500, tp.Heartbeat(sequence=1, time_s=0.5)),
    messages.GateIs(1, Gate(ICAROUS, 2, True)),
    messages.Heard(1, 900, tp.SetMode("PASSIVE", 2)),
    messages.Unreadable(2, 900, "what?"),
    messages.ZonesKnown((ZONE, replace(ZONE, id=5))),
    messages.Watch(2500),
    messages.Lost(1, 3000, LinkEvent("eof")),
    messages.Beat(3000, AIRCRAFT),
    messages.Watch(3000),
)


def after(*sent: messages.ToLinkEnd, state: State = State()) -> tuple[State, list[Any]]:
    """The state after some messages, and what the last one led to."""
    out: tuple[Any, ...] = ()
    for message in sent:
        state, out = END.handle(state, message)
    return state, list(out)


def test_a_step_changes_nothing_but_its_answer() -> None:
    for state in plain_steps(END, State(), ALL):
        assert from_data(State, to_data(state)) == state


def test_handling_one_vehicle_leaves_the_others_alone() -> None:
    state, _ = after(*ALL[:3])
    for message in ALL:
        if getattr(message, "vehicle_id", 0) == 1:
            moved, out = END.handle(state, message)
            assert moved.peer(2) == state.peer(2)
            assert {m.vehicle_id for m in out if not isinstance(m, messages.Say)} <= {1}


def test_a_vehicle_without_an_instance_is_told_nothing() -> None:
    state, _ = after(*ALL[:2])
    assert END.handle(state, messages.Route(7, WAY, 22.0, 0.0)) == (state, ())


TAKEN, OFFERED = Gate(ICAROUS, 1, False), Gate(ICAROUS, 2, True)
TAKEOVER = (messages.GateIs(1, TAKEN), messages.Heard(1, 500, tp.SetMode("ACTIVE", 1)))
OFFER = (messages.GateIs(1, OFFERED), messages.Heard(1, 900, tp.SetMode("PASSIVE", 2)))


def test_a_takeover_suspends_and_an_offer_is_taken_once() -> None:
    state, out = after(*ALL[:2], *TAKEOVER)
    assert out == [messages.Suspend(1, 500, SUSPEND)]
    assert after(TAKEOVER[1], state=state) == (state, [])
    state, out = after(*OFFER, state=state)
    assert out == [messages.TakeBack(1, 900, TAKE_BACK, 2)]
    assert after(OFFER[1], state=state) == (state, [])
    before = state.peer(1)
    state, out = after(messages.Heard(1, 900, tp.SetMode("ACTIVE", 1)), state=state)
    (said,) = out
    assert "epoch 1 is overtaken by one of epoch 2" in said.body.Note
    assert state.peer(1) == before


def test_an_offer_is_taken_also_where_the_takeover_was_not_heard() -> None:
    """Every SETMOD of the takeover was lost: UxAS takes the offer because it hears of it, not unheard."""
    state, _ = END.handle(State(), messages.Connected(0, (1,)))
    state, _ = END.handle(state, messages.GateIs(1, Gate(ICAROUS, 2, True)))
    state, out = END.handle(state, messages.Heard(1, 500, tp.SetMode("PASSIVE", 2)))
    assert [(m.vehicle_id, m.epoch, m.act) for m in out if isinstance(m, messages.TakeBack)] == [
        (1, 2, TAKE_BACK)
    ]
    _, out = END.handle(state, messages.Heard(1, 1000, tp.SetMode("PASSIVE", 2)))
    assert not [m for m in out if isinstance(m, messages.TakeBack)]
    # where nothing is offered there is nothing to take
    state, _ = END.handle(State(), messages.Connected(0, (1,)))
    state, _ = END.handle(state, messages.GateIs(1, Gate(UXAS, 2, False)))
    _, out = END.handle(state, messages.Heard(1, 500, tp.SetMode("PASSIVE", 2)))
    assert not [m for m in out if isinstance(m, messages.TakeBack)]


def test_a_mode_without_an_epoch_is_of_the_present_one() -> None:
    state, out = after(
        *ALL[:2], messages.GateIs(1, TAKEN), messages.Heard(1, 500, tp.SetMode("ACTIVE", None))
    )
    assert out == [messages.Suspend(1, 500, SUSPEND)]
    _, out = after(
        messages.GateIs(1, OFFERED),
        messages.Heard(1, 900, tp.SetMode("PASSIVE", None)),
        state=state,
    )
    assert out == [messages.TakeBack(1, 900, TAKE_BACK, 2)]


@pytest.mark.parametrize(
    ("mode", "epoch", "reason"),
    [
        ("ACTIVE", 9_000_000_000, "never given"),
        ("ACTIVE", 3, "never given"),
        ("ACTIVE", -1, "never given"),
        ("PASSIVE", 3, "never given"),
        ("ACTIVE", 2, "began otherwise"),
        ("ACTIVE", None, "began otherwise"),
    ],
)
def test_a_mode_that_cannot_be_true_is_refused(mode: str, epoch: int | None, reason: str) -> None:
    state, _ = after(*ALL[:2], *TAKEOVER, *OFFER)
    again, (said,) = after(messages.Heard(1, 1000, tp.SetMode(mode, epoch)), state=state)
    assert type(said.body).__name__ == "ModeRefused"
    assert (said.body.Epoch, said.body.GateEpoch) == (2 if epoch is None else epoch, 2)
    assert reason in said.body.Reason
    assert again.peer(1) == state.peer(1)


@pytest.mark.parametrize(
    ("mode", "epoch", "alive"), [("ACTIVE", 7, False), ("PASSIVE", 0, False), ("ACTIVE", 1, True)]
)
def test_a_mode_that_is_refused_or_says_nothing_new_is_no_sign_of_life(
    mode: str, epoch: int, alive: bool
) -> None:
    """Whoever is no instance could keep a silent one alive by it; G5 would not be told."""
    state, _ = after(messages.Connected(0, (1,)))
    if alive:
        state, _ = after(messages.GateIs(1, Gate(ICAROUS, 1, False)), state=state)
    state, _ = after(messages.Heard(1, 2000, tp.SetMode(mode, epoch)), state=state)
    _, out = after(messages.Watch(2500), state=state)
    told = [m.body.Note for m in out if isinstance(m, messages.Say)]
    assert told == ([] if alive else ["silent since 0 ms"])


def test_waypoints_are_told_and_reached_once() -> None:
    state, out = after(*ALL[:3])
    to_other, down = out
    assert [type(line) for line in to_other.lines] == [tp.WayOfAnother] * len(WAY)
    assert isinstance(down.lines[0], tp.SoftReset)
    assert isinstance(down.lines[-1], tp.StartMission)
    state, out = after(messages.Flown(1, 110.0), state=state)
    assert out == [messages.Down(1, (tp.WaypointReached(0), tp.WaypointReached(1)))]
    assert after(messages.Flown(1, 110.0), state=state) == (state, [])
    # a place before those that are told to be reached takes nothing back
    assert after(messages.Flown(1, 20.0), state=state) == (state, [])


def test_how_a_vehicle_flies_is_told_to_the_others() -> None:
    """Its way; that it is over, as ICAROUS takes it; to which velocity it is steered; that this is over; its way again."""
    steers = messages.Heard(1, 500, tp.SetVelocity(20.0, -5.0, 0.0))
    state, _ = after(*ALL[:2])
    heard = list[tp.Message]()
    for message in (*ALL[2:7], steers, steers, *ALL[9:11], ALL[2]):
        state, out = END.handle(state, message)
        heard += [
            x for m in out if isinstance(m, messages.Down) and m.vehicle_id == 2 for x in m.lines
        ]
    others = [line for line in heard if isinstance(line, tp.WayOfAnother | tp.VelocityOfAnother)]
    assert {line.vehicle_id for line in others} == {1}
    told = [line.total if isinstance(line, tp.WayOfAnother) else line for line in others]
    assert told == [3, 3, 3, 0, tp.VelocityOfAnother(1, 20.0, -5.0, 0.0), 0, 3, 3, 3]
    _, out = END.handle(state, messages.Connected(900, (2,)))
    assert (
        sum(
            isinstance(x, tp.WayOfAnother)
            for m in out
            if isinstance(m, messages.Down)
            for x in m.lines
        )
        == 3
    )


def test_nothing_goes_down_an_ended_connection() -> None:
    state, _ = after(*ALL[:2], messages.Lost(1, 500, LinkEvent("eof")))
    for message in (*ALL[2:5], messages.Left(1, WAY[1]), messages.ZonesKnown((ZONE, ZONE))):
        state, out = END.handle(state, message)
        assert not [m for m in out if isinstance(m, messages.Down) and m.vehicle_id == 1]


# ---- in flight -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def undisturbed() -> tuple[FlightResult, list[Any]]:
    """The meeting, flown without anything of the tests' in its way."""
    return flown(meeting())


def test_the_kernel_of_modes_decides_what_is_flown(
    undisturbed: tuple[FlightResult, list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a kernel that believes no takeover UxAS never takes the vehicle back in its way."""
    _, log = undisturbed
    right, states = link_end.link_mode, repr(of_type(log, "TruthState"))
    monkeypatch.setattr(link_end, "link_mode", lambda end, *_: Linked(end, 0))
    _, log = flown(meeting())
    assert repr(of_type(log, "TruthState")) != states
    untouched = Gate(UXAS, 7, False)
    monkeypatch.setattr(link_end, "link_mode", lambda end, _, *mode: right(end, untouched, *mode))
    _, log = flown(meeting())
    assert "overtaken" in of_type(log, "BridgeStatus")[-1].Note


def test_the_kernel_of_signs_decides_who_is_alive(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_end, "link_sign", lambda end, *_: Linked(end._replace(alive=False), 3))
    _, log = flown(meeting())
    assert not any(s.Alive for s in of_type(log, "BridgeStatus")[1:])


def sending(
    monkeypatch: pytest.MonkeyPatch, change: Callable[[int, tp.Message], tuple[tp.Message, ...]]
) -> None:
    """Put in the place of each line that goes up what `change` makes of it, by its number."""
    send, count = Bridge.to_uxas, itertools.count()

    def changed(bridge: Bridge, vehicle_id: int, message: tp.Message) -> bool:
        return all(send(bridge, vehicle_id, m) for m in change(next(count), message))

    monkeypatch.setattr(Bridge, "to_uxas", changed)


def test_a_forged_mode_takes_no_authority(
    undisturbed: tuple[FlightResult, list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At every heartbeat somebody claims a huge epoch: the flight is the same; each claim is refused,
    counted, and told with the verdict of G4."""
    right, log = undisturbed
    states = repr(of_type(log, "TruthState"))
    forged = (tp.SetMode("ACTIVE", 10**14), tp.SetMode("PASSIVE", 10**14))
    sending(monkeypatch, lambda _, m: (*forged, m) if isinstance(m, tp.Heartbeat) else (m,))
    mission = meeting()
    plan, bus, log = make_plan(mission), Bus(lmcp.full_names), list[Any]()
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)
    bus.tap(lambda envelope: log.append(envelope.body))
    result = fly(mission, plan, bus)
    assert (result.outcome, result.takeovers) == (right.outcome, right.takeovers)
    assert repr(of_type(log, "TruthState")) == states
    refused = of_type(log, "ModeRefused", Epoch=10**14)
    beats = of_type(log, "Heartbeat", Direction=lmcp.enums["Direction"].Up)
    assert len(refused) == 2 * len(beats)
    (g4,) = [v for v in monitor.details() if v.requirement == "G4"]
    assert g4.outcome is Outcome.HOLDS
    assert f"{len(refused)} modes refused" in g4.note


@pytest.mark.parametrize("lost", ["ACTIVE", "PASSIVE"])
def test_a_mode_that_is_lost_is_said_again(monkeypatch: pytest.MonkeyPatch, lost: str) -> None:
    """The first line of a takeover, or of an offer, never arrives: UxAS acts a heartbeat later."""
    dropped = list[tp.Message]()

    def losing(_: int, message: tp.Message) -> tuple[tp.Message, ...]:
        if isinstance(message, tp.SetMode) and message.mode == lost and not dropped:
            dropped.append(message)
            return ()
        return (message,)

    sending(monkeypatch, losing)
    result, log = flown(meeting())
    assert (len(dropped), result.outcome) == (1, "complete")
    began = of_type(log, "GateState", Epoch=dropped[0].epoch)[0]
    back = next(g for g in of_type(log, "GateState", Offered=False) if g.Owner.name == "UxAS")
    assert back.Time >= began.Time
    if lost == "PASSIVE":
        assert back.Time - began.Time == 500


@pytest.mark.parametrize("when", [40, 41])
def test_what_came_before_the_end_of_a_link_is_heard_before_it(
    monkeypatch: pytest.MonkeyPatch, when: int
) -> None:
    """Cut before or after ICAROUS has answered: the last thing said is that the link is lost."""
    exchange, count = Bridge.exchange, itertools.count()

    def cutting(bridge: Bridge) -> list[Any]:
        if next(count) == when:
            bridge.cut(1)
        return exchange(bridge)

    monkeypatch.setattr(Bridge, "exchange", cutting)
    _, log = flown(meeting())
    notes = [s.Note for s in of_type(log, "BridgeStatus")]
    assert len(notes) == 2
    assert notes[1].startswith("link lost")
    up = [b.Time for b in of_type(log, "Heartbeat") if b.Direction.name == "Up"]
    assert max(up) == 9500 + 500 * (when - 40)


def test_icarous_is_told_the_way_of_another_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plan that is made for a deadline, before anything was flown, is told as any other."""
    heard = told_to_icarous(monkeypatch)
    mission, plan = with_deadline()
    result, _ = flown(mission, plan)
    assert result.replans == 1
    told = [message for vehicle, message in heard if vehicle == 1]
    first = next(k for k, m in enumerate(told) if isinstance(m, tp.WaypointReached))
    assert sum(isinstance(m, tp.StartMission) for m in told[:first]) == 2


def test_a_zone_that_is_known_from_the_start_binds_everybody(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A change at 0 ms is told to ICAROUS as the mission's own zones are."""
    told = told_to_icarous(monkeypatch)
    far = replace(ZONE, vertices=((0.0, 5000.0), (0.0, 5090.0), (90.0, 5090.0)))
    later, there = replace(far, id=5), Simulation(limit_ms=2000)
    both = (Change(0, ZONE_APPEARS, zone=far), Change(1000, ZONE_APPEARS, zone=later))
    flown(replace(meeting(), traffic=(), changes=both, simulation=there))
    assert [m.zone for _, m in told if isinstance(m, tp.FenceDone)] == [1, 2]


def test_a_state_survives_a_restart() -> None:
    state, _ = after(*ALL)
    assert pickle.loads(pickle.dumps(state)) == state


@pytest.mark.parametrize(
    "event", [messages.Lost(1, 900, LinkEvent("closed", "")), messages.Watch(9000)]
)
def test_that_a_vehicle_is_steered_is_over_for_the_others_as_its_icarous_is_not_heard(
    event: messages.ToLinkEnd,
) -> None:
    """Nobody steers it there any more, or nobody knows."""
    steers = messages.Heard(1, 500, tp.SetVelocity(20.0, -5.0, 0.0))
    state, _ = after(*ALL[:2], *ALL[2:7], steers)
    state, out = END.handle(state, event)
    told = [x for m in out if isinstance(m, messages.Down) and m.vehicle_id == 2 for x in m.lines]
    assert told == [tp.WayOfAnother(1, 0, 0.0, 0.0, 0.0, 0)]
    again = END.handle(state, messages.Connected(9500, (2,)))[1]
    lines = [x for m in again if isinstance(m, messages.Down) for x in m.lines]
    assert not [x for x in lines if isinstance(x, tp.VelocityOfAnother | tp.WayOfAnother)]


def test_a_zone_that_was_removed_while_an_instance_was_away_is_forgotten_as_it_comes_back() -> None:
    """It kept the zone for ever; one that stayed is told again, and who was not away is told no more than before."""
    stays = replace(ZONE, id=5)
    zones, left = messages.ZonesKnown((ZONE, stays)), messages.ZonesKnown((stays,))
    cut = messages.Lost(1, 900, LinkEvent("closed", ""))
    there = tuple(messages.Connected(at_ms, (1,)) for at_ms in (0, 2000))
    state, out = after(zones, there[0], cut, left, there[1])
    told = inbox.Told()
    for line in _lines(after(zones, there[0])[1]) + _lines(out):
        told = inbox.hear(told, line, END.projection, 0)
    assert [zone.vertices[1] for zone in told.zones] == [pytest.approx((0.0, 90.0), abs=1e-3)]
    assert len(told.zones) == 1
    # removed before the break was noticed: its message may not have arrived
    unnoticed = after(zones, there[0], left, cut, there[1])[1]
    assert tp.ForgetFences() in _lines(unnoticed[-len(out) :])
    again = _lines(after(cut, there[1], state=state)[1])
    usual = _lines(after(zones, there[0], cut, there[1])[1])
    assert tp.ForgetFences() not in (*again, *usual)


def _lines(out: list[Any]) -> list[Any]:
    return [line for m in out if isinstance(m, messages.Down) for line in m.lines]
