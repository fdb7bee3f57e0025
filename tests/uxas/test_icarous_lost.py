"""What a vehicle flies while UxAS does not hear its ICAROUS: a hold, what was asked for, and how it comes back."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bridge_flight import PLANE, Aircraft, way
from icarous_rig import Rig, state

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.core.authority.link_loss import FINISH, LOITER, RETURN
from cratous.services.flight.messages import Lost, Say
from cratous.services.icarous_communication import holding
from cratous.services.icarous_communication.listeners import Dialects
from cratous.services.icarous_communication.settings import ATTRIBUTES, Settings, settings_of
from cratous.services.icarous_communication.state import Note, State
from cratous.services.icarous_communication.step import Communication
from cratous.services.icarous_communication.unheard import IN_HAND, LostLink
from cratous.services.loading.lost_link_attributes import Place
from cratous.services.loading.uxas_settings import Entry, values_of
from cratous.services.mission.zones import exact_leg_ok
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Zone, ZoneKind

SERVICE, TASK = "IcarousCommunicationService", 1000
ASKED = LostLink(LOITER, 5_000, in_hand=False)


class Flight:
    """UxAS's end of the bridge for one vehicle, step by step, and what it publishes."""

    def __init__(self, lost: LostLink, dialect: Dialect = Dialect.CRATOUS) -> None:
        self.step = Communication("ics", 0.0, Dialects(dialect, {}), lost)
        self.state, self.now_ms, self.sent = State(), 1000, list[Any]()
        self.do(self.step.connected(self.state, 1, self.now_ms))
        self.do(self.step.configured(self.state, configured(30.0)))
        self.fly(-300.0)
        self.do(self.step.mission(self.state, way((0.0, 0.0), (9000.0, 0.0)), self.now_ms))
        self.fly(-200.0)

    def do(self, done: Any) -> None:
        self.state, out = done
        self.sent += [one.body for one in out if isinstance(one, Say)]

    def fly(
        self, north_m: float, waypoint: int = 1, tasks: tuple[int, ...] = (), east_m: float = 0.0
    ) -> None:
        craft = Aircraft(1, north_m, east_m, 0.0)
        craft.waypoint = waypoint
        body = craft.state(self.now_ms).copy(AssociatedTasks=list(tasks))
        self.do(self.step.flown(self.state, body, self.now_ms))

    def say(self, line: tp.Message) -> None:
        self.do(self.step.heard(self.state, 1, line, self.now_ms))

    def wait(self, until_ms: int) -> None:
        while self.now_ms < until_ms:
            self.now_ms += 500
            self.do(self.step.watch(self.state, self.now_ms))

    def got(self, kind: str) -> list[Any]:
        return [body for body in self.sent if type(body).__name__ == kind]

    @property
    def modes(self) -> list[tuple[int, str, str, int]]:
        said = self.got("LinkLossState")
        return [(one.Time, one.Mode.name, one.Chosen.name, one.Heard) for one in said]

    @property
    def holds(self) -> list[Any]:
        actions = [body.VehicleActionList[0] for body in self.got("VehicleActionCommand")]
        return [one for one in actions if type(one).__name__ == "LoiterAction"]


def configured(bank_deg: float) -> Any:
    profile = lmcp.new("FlightProfile", MaxBankAngle=bank_deg)
    return lmcp.new("AirVehicleConfiguration", ID=1, NominalFlightProfile=profile)


def test_one_that_icarous_has_holds_at_once_and_is_without_the_link_after_the_silence() -> None:
    flight = Flight(IN_HAND)
    flight.say(tp.SetMode("ACTIVE", 1))
    flight.fly(500.0)
    flight.wait(3000)
    assert flight.holds == [], "2 s, not more"
    flight.wait(3500)
    assert len(flight.holds) == 1, "within a heartbeat of 2 s"
    assert flight.modes == []
    flight.wait(31_000)
    assert flight.modes == []
    flight.wait(90_000)
    assert flight.modes == [(31_500, "Loiter", "Finish", 1000)]
    assert len(flight.holds) == 1, "it is told once"
    flight.say(tp.SetMode("ACTIVE", 1))
    assert flight.modes[1:] == [(90_000, "Linked", "Finish", 90_000)]
    assert flight.got("MissionCommand") == [], "ICAROUS has it"
    flight.say(tp.SetMode("PASSIVE", 2))
    assert len(flight.got("MissionCommand")) == 1
    assert len(flight.modes) == 2


def test_the_hold_is_a_circle_that_its_bank_allows_and_that_begins_on_its_course() -> None:
    flight = Flight(IN_HAND)
    flight.say(tp.SetMode("ACTIVE", 1))
    flight.fly(500.0)
    flight.do(flight.step.lost(flight.state, Lost(1, 2000, LinkEvent("eof", ""))))
    (hold,) = flight.holds
    speed_m_s = flight.state.craft(1).air.speed_m_s  # type: ignore[union-attr]
    tightest_m = speed_m_s**2 / (9.80665 * math.tan(math.radians(30.0)))
    assert hold.Radius == pytest.approx(1.1 * tightest_m)
    centre = PLANE.to_local(hold.Location.Latitude, hold.Location.Longitude)
    assert centre == pytest.approx((500.0, hold.Radius), abs=0.1), "to the right of its course"
    assert hold.Direction.name == "Clockwise"


@pytest.mark.parametrize(
    ("east_m", "roll_deg", "turn"),
    [
        (188.0, 20.0, "CounterClockwise"),
        (-188.0, -20.0, "Clockwise"),
        (0.0, 0.0, "Clockwise"),
        (0.0, -20.0, "CounterClockwise"),
        (5000.0, -20.0, "CounterClockwise"),
        (5000.0, 20.0, "Clockwise"),
    ],
)
def test_the_circle_goes_on_with_the_turn_unless_only_the_other_keeps_the_zones(
    east_m: float, roll_deg: float, turn: str
) -> None:
    flight = Flight(IN_HAND)
    flight.say(tp.SetMode("ACTIVE", 1))
    flight.fly(500.0)
    body = flight.state.craft(1).body.copy(Roll=roll_deg)
    flight.do(flight.step.flown(flight.state, body, flight.now_ms))
    half_m = 20.0 if east_m else 5.0
    ring = tuple(
        (500.0 + a * half_m, east_m + b * half_m) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    )
    zone = Zone(3, ZoneKind.KEEP_OUT, ring, 0.0, 1000.0)
    link = replace(flight.state.link, zones=(zone,))
    flight.state = replace(flight.state, link=link)
    flight.do(flight.step.lost(flight.state, Lost(1, 2000, LinkEvent("eof", ""))))
    assert [one.Direction.name for one in flight.holds] == [turn]


def test_a_circle_leaves_no_zone_between_the_corners_that_are_compared() -> None:
    """The polygon contains the circle."""
    radius_m = 100.0
    rad = math.pi / holding.CORNERS
    at = Position(radius_m * math.cos(rad), radius_m * math.sin(rad), 300.0)
    ring = tuple((at[0] + a, at[1] + b) for a, b in ((-2, -2), (2, -2), (2, 2), (-2, 2)))
    zone = Zone(3, ZoneKind.KEEP_OUT, ring, 0.0, 1000.0)
    assert not holding._keeps(Position(0.0, 0.0, 300.0), radius_m, (zone,))


def test_without_a_choice_one_that_uxas_has_goes_on_unreported() -> None:
    flight = Flight(IN_HAND)
    flight.wait(90_000)
    assert (flight.modes, flight.holds) == ([], [])


def test_finish_is_reported_and_the_mission_goes_on() -> None:
    flight = Flight(LostLink(FINISH, 5_000, in_hand=False))
    flight.say(tp.Heartbeat(1, 1.0))
    flight.wait(20_000)
    assert flight.modes == [(6500, "Finish", "Finish", 1000)]
    assert flight.holds == []
    flight.say(tp.Heartbeat(2, 20.0))
    assert flight.modes[1:] == [(20_000, "Linked", "Finish", 20_000)]
    assert flight.got("MissionCommand") == []


def test_loiter_holds_one_that_uxas_has_until_its_icarous_is_heard_again() -> None:
    flight = Flight(ASKED)
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(500.0, 2, (TASK,))
    flight.wait(30_000)
    assert flight.modes == [(6500, "Loiter", "Loiter", 1000)]
    assert len(flight.holds) == 1
    assert [p.TaskID for p in flight.got("TaskPause")] == [TASK]
    assert flight.got("GatedCommand")[-1].Sender.name == "UxAS", "under its own authority"
    assert flight.got("AuthorityChange") == []
    flight.fly(700.0, 2, (TASK,))
    flight.say(tp.Heartbeat(2, 30.0))
    assert flight.modes[1:] == [(30_000, "Linked", "Loiter", 30_000)]
    (command,) = flight.got("MissionCommand")
    added = [w for w in command.WaypointList if w.Number > 2]
    places = [PLANE.to_local(w.Latitude, w.Longitude) for w in added]
    assert any(math.dist(place, (500.0, 0.0)) < 20.0 for place in places), places
    assert [p.TaskID for p in flight.got("TaskResume")] == [TASK]
    flight.wait(60_000)
    assert len(flight.holds) == 2, "silent again"


def test_one_that_is_held_may_be_taken_over_and_comes_back_to_where_it_left_its_way() -> None:
    flight = Flight(ASKED)
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(500.0, 2, (TASK,))
    flight.wait(30_000)
    flight.fly(700.0, 2, (TASK,))
    flight.say(tp.SetMode("ACTIVE", 1))
    assert flight.modes[-1][1] == "Linked"
    assert flight.got("MissionCommand") == []
    flight.say(tp.SetMode("PASSIVE", 2))
    (command,) = flight.got("MissionCommand")
    places = [PLANE.to_local(w.Latitude, w.Longitude) for w in command.WaypointList]
    assert any(math.dist(place, (500.0, 0.0)) < 20.0 for place in places), places


def test_a_mission_that_comes_while_it_is_held_waits_and_is_then_flown() -> None:
    flight = Flight(ASKED)
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(500.0, 2)
    flight.wait(30_000)
    later = way((500.0, 0.0), (0.0, 5000.0))
    state, out = flight.step.mission(flight.state, later, flight.now_ms)
    (note,) = (one.text for one in out if isinstance(one, Note))
    assert note == (
        "vehicle 1: a mission has come while its ICAROUS is not heard, and waits until it is"
    )
    flight.state = state
    assert flight.got("MissionCommand") == []
    flight.say(tp.Heartbeat(2, 30.0))
    assert flight.got("MissionCommand") == [later]


PLACE = Position(1500.0, 2500.0, 350.0)
RETURNS = LostLink(RETURN, 5_000, False, Place(*PLANE.to_geodetic(*PLACE[:2]), PLACE.alt_m))


def points_of(command: Any) -> list[Position]:
    return [
        Position(*PLANE.to_local(w.Latitude, w.Longitude), w.Altitude) for w in command.WaypointList
    ]


@pytest.mark.parametrize("blocked", [False, True])
def test_return_leads_around_the_zones_to_the_place_and_holds_there(blocked: bool) -> None:
    flight = Flight(RETURNS)
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(500.0, 2, (TASK,))
    ring = [(900.0, 700.0), (900.0, 1700.0), (1100.0, 1700.0), (1100.0, 700.0)]
    corners = [PLANE.to_geodetic(*corner) for corner in ring]
    if blocked:
        flight.do(flight.step.zone(flight.state, keep_out(corners)))
    flight.wait(20_000)
    assert flight.modes == [(6500, "Return", "Return", 1000)]
    assert flight.holds == [], "it flies there"
    assert [p.TaskID for p in flight.got("TaskPause")] == [TASK]
    (command,) = flight.got("MissionCommand")
    points = points_of(command)
    assert points[-1] == pytest.approx(PLACE, abs=0.1)
    zone = Zone(3, ZoneKind.KEEP_OUT, tuple(ring), 0.0, 1000.0)
    legs = list(itertools.pairwise([Position(500.0, 0.0, 300.0), *points]))
    assert all(exact_leg_ok(a, b, zone) for a, b in legs) or not blocked
    assert not any(w.AssociatedTasks for w in command.WaypointList)
    assert flight.got("GatedCommand")[-1].Sender.name == "UxAS"
    # a waypoint manager sends it on as its own: that is no new mission
    flight.do(flight.step.mission(flight.state, command.copy(CommandID=77), flight.now_ms))
    assert flight.state.craft(1).waiting is None
    flight.fly(900.0, 2, east_m=1900.0)
    flight.wait(20_500)
    assert flight.holds == []
    flight.fly(1500.0, 2, east_m=2480.0)
    flight.wait(21_000)
    assert [mode[1] for mode in flight.modes] == ["Return", "Over"]
    assert len(flight.holds) == 1
    flight.say(tp.Heartbeat(2, 30.0))
    assert [mode[1] for mode in flight.modes] == ["Return", "Over", "Linked"]
    places = points_of(flight.got("MissionCommand")[-1])
    assert any(math.dist(place[:2], (500.0, 0.0)) < 20.0 for place in places), places


def test_return_without_a_place_leads_to_where_it_was_first_seen() -> None:
    flight = Flight(RETURNS._replace(to=None))
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(2500.0, 2)
    flight.wait(20_000)
    (command,) = flight.got("MissionCommand")
    assert points_of(command)[-1] == pytest.approx((-300.0, 0.0, 300.0), abs=0.1)


def test_where_no_way_leads_to_the_place_it_holds() -> None:
    flight = Flight(RETURNS)
    flight.say(tp.SetMode("PASSIVE", 0))
    flight.fly(500.0, 2)
    north, east = PLACE[:2]
    ring = [(north + a, east + b) for a, b in ((-300, -300), (-300, 300), (300, 300), (300, -300))]
    flight.do(flight.step.zone(flight.state, keep_out([PLANE.to_geodetic(*c) for c in ring])))
    flight.wait(20_000)
    assert [mode[1] for mode in flight.modes] == ["Loiter"]
    assert (flight.got("MissionCommand"), len(flight.holds)) == ([], 1)


def test_one_that_icarous_has_does_not_return() -> None:
    flight = Flight(RETURNS)
    flight.say(tp.SetMode("ACTIVE", 1))
    flight.fly(500.0, 2)
    flight.wait(20_000)
    assert [mode[1] for mode in flight.modes] == ["Loiter"]
    assert (flight.got("MissionCommand"), len(flight.holds)) == ([], 1)


@pytest.mark.parametrize(
    "given",
    [
        {"LostLink": "return", "LostLinkTo": "45.0 -121.0"},
        {"LostLink": "return", "LostLinkTo": "45.0 -121.0 high"},
        {"LostLink": "return", "LostLinkTo": "95.0 -121.0 300"},
        {"LostLink": "return", "LostLinkTo": "45.0 -121.0 inf"},
        {"LostLink": "loiter", "LostLinkTo": "45.0 -121.0 300"},
    ],
)
def test_a_place_that_is_none_is_refused(given: dict[str, str]) -> None:
    with pytest.raises(BadInput, match="no place to return to") as wrong:
        settings({**given})
    assert "LostLinkTo" in str(wrong.value)


@pytest.mark.shows(SERVICE, "LostLinkTo")
def test_a_place_is_read() -> None:
    lost = settings({"LostLink": "return", "LostLinkTo": "45.5 -121.25 350"}).lost
    assert lost == LostLink(RETURN, 30_000, False, Place(45.5, -121.25, 350.0))


def settings(given: dict[str, str]) -> Settings:
    given = {"NumberOfUAVs": "1", "Dialect": "cratous", **given}
    problems = list[BadInput]()
    values = values_of(ATTRIBUTES, given, "cfg.xml", SERVICE, problems)
    assert problems == []
    return settings_of(Entry("Service", SERVICE, given, (), "cfg.xml"), values)


def keep_out(corners: list[tuple[float, float]]) -> Any:
    points = [lmcp.new("Location3D", Latitude=a, Longitude=b) for a, b in corners]
    return lmcp.new(
        "KeepOutZone", ZoneID=3, MaxAltitude=1000.0, MaxAltitudeType="MSL", MinAltitudeType="MSL",
        Boundary=lmcp.new("Polygon", BoundaryPoints=points),
    )  # fmt: skip


def test_peers_without_heartbeats_are_lost_with_their_connection_only() -> None:
    flight = Flight(IN_HAND, Dialect.THESIS)
    flight.say(tp.SetMode("ACTIVE"))
    flight.fly(500.0)
    flight.wait(60_000)
    assert (flight.modes, flight.holds) == ([], [])
    flight.do(flight.step.lost(flight.state, Lost(1, 60_000, LinkEvent("eof", ""))))
    flight.wait(61_000)
    assert [mode[1] for mode in flight.modes] == ["Loiter"]


@pytest.mark.shows(SERVICE, "LostLink", "LostLinkAfter_s", "LinkLossState")
def test_the_configuration_says_what_is_flown_and_after_which_silence(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1" LostLink="loiter" LostLinkAfter_s="1.5"', opened)
    one = rig.fake(hello=1)
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)))
    one.say(tp.SetMode("PASSIVE", 0))
    rig.until(lambda: rig.got("LinkLossState"))
    (said,) = rig.got("LinkLossState")
    assert said.Time - said.Heard in range(1501, 4000)
    assert [type(c.VehicleActionList[0]).__name__ for c in rig.got("VehicleActionCommand")] == [
        "LoiterAction"
    ]


@pytest.mark.parametrize(("name", "value"), [("LostLink", "land"), ("LostLinkAfter_s", "0.5")])
def test_what_cannot_be_flown_is_refused(name: str, value: str) -> None:
    given = {"NumberOfUAVs": "1", "Dialect": "cratous", name: value}
    problems = list[BadInput]()
    values_of(ATTRIBUTES, given, "cfg.xml", SERVICE, problems)
    assert [problem.item for problem in problems] == [f"{SERVICE}.{name}"]
