"""The certificate in hand behind the gate: what takes its place, what is flown when ICAROUS falls silent, what is said."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from flight_tools import meeting
from icarous_tools import ABILITY, NORTH, WIDE
from loading_tools import small

from cratous.bridge import lmcp
from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.drift import Off
from cratous.core.avoidance.resolution import Choice, Scene
from cratous.core.permit.hand import Hand
from cratous.services.bus import Bus
from cratous.services.flight import holding
from cratous.services.flight.autopilot import Circle, Fly
from cratous.services.flight.holding import Ground, InHand
from cratous.services.flight.loop import fly
from cratous.services.flight.vehicle import VehicleNode
from cratous.services.icarous.certificate import Certificate
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Offers, Sensed
from cratous.services.icarous.offers import Refused, certified
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.services.system_model.replay import replay
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    FaultySimulation,
    Mission,
    Position,
    Traffic,
    Velocity,
    Zone,
    ZoneKind,
)
from cratous.spec.mission.bridge_faults import BridgeFaults

SQUARE = ((1800.0, -2300.0), (2400.0, -2300.0), (2400.0, -1700.0), (1800.0, -1700.0))
FAR = Zone(7, ZoneKind.KEEP_OUT, SQUARE, 0.0, 1000.0)
"""Where the manoeuvre leads if it is flown on for ever; and one who is there then."""
LATER = Traffic(91, Position(-1281.0, -2231.0, 300.0), Velocity(22.0, 0.0, 0.0))


def silenced(again_ms: int | None = None) -> Mission:
    """ICAROUS avoids from 41.5 s on, and falls silent in the middle of it."""
    faults = BridgeFaults(1, silent_ms=43_000, speaks_again_ms=again_ms)
    simulation = FaultySimulation(limit_ms=220_000, bridge_faults=faults)
    both = (*meeting().traffic, LATER)
    return replace(meeting(), simulation=simulation, zones=(FAR,), traffic=both)


def flown(mission: Mission) -> list[Any]:
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    fly(mission, make_plan(mission), bus)
    return log


def judged(mission: Mission, log: list[Any]) -> dict[str, tuple[str, str]]:
    monitor = Monitor(mission, make_plan(mission))
    for envelope in log:
        monitor.tap(envelope)
    return {v.requirement: (str(v.outcome), v.note) for v in monitor.verdicts()[:5]}


def changes(log: list[Any]) -> list[Any]:
    return [one.body for one in log if one.topic.endswith("HandState")]


@pytest.fixture(scope="module")
def silent() -> tuple[Mission, list[Any]]:
    return silenced(), flown(silenced())


def test_the_hand_is_flown_on_where_icarous_falls_silent(
    silent: tuple[Mission, list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    mission, log = silent
    found = judged(mission, log)
    assert (found["G1"][0], found["G2"][0]) == ("holds", "holds")
    assert [one.Change.name for one in changes(log)] == ["Offered"] * 3 + ["Flown"]
    assert "flown on: vehicle 1 at 43.75 s: no command of ICAROUS" in found["G2"][1]
    assert "a certificate was in hand for 178.5 of 178.5 s under ICAROUS" in found["G1"][1]
    monkeypatch.setattr(VehicleNode, "_alone", lambda self, state, now_ms: (state, ()))
    found = judged(mission, flown(mission))
    assert (found["G1"][0], found["G2"][0]) == ("violated", "violated")


def test_icarous_goes_on_from_the_hand_when_it_speaks_again() -> None:
    mission = replace(silenced(70_000), zones=(), traffic=meeting().traffic)
    mission = replace(mission, simulation=replace(mission.simulation, limit_ms=400_000))
    log = flown(mission)
    kinds = [one.Change.name for one in changes(log)]
    assert kinds[3:5] == ["Flown", "Offered"]
    assert kinds[-1] == "Left"
    assert log[-1].body.Outcome == "complete"
    assert replay(mission, True, log).finding is None


def test_a_flight_with_a_command_at_each_heartbeat_is_as_it_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    mission = replace(meeting(), simulation=replace(meeting().simulation, limit_ms=70_000))

    def positions(log: list[Any]) -> list[Any]:
        return [repr(one.body) for one in log if one.topic.endswith("TruthState")]

    offered = flown(mission)
    assert len(changes(offered)) > 20
    monkeypatch.setattr(Instance, "_offer", lambda *_: ())
    without = flown(mission)
    assert not changes(without)
    assert positions(offered) == positions(without)


def test_a_log_with_another_hand_is_found(silent: tuple[Mission, list[Any]]) -> None:
    mission, log = silent
    assert replay(mission, True, log).finding is None
    places = [k for k, one in enumerate(log) if one.topic.endswith("HandState")]
    for field in ("ID", "Base", "BaseExpiry", "Knowledge", "Expiry", "Surprises", "Sigma"):
        tampered = list(log)
        values = {name: getattr(log[places[1]].body, name) for name in FIELDS}
        body = lmcp.new("HandState", **{**values, field: values[field] + 1000})
        tampered[places[1]] = replace(log[places[1]], body=body)
        finding = replay(mission, True, tampered).finding
        assert finding is not None, field
        assert "what is in hand" in finding.what, field


FIELDS = (
    "VehicleID", "Time", "Change", "Base", "BaseExpiry", "ID", "Sigma", "Knowledge", "Expiry", "Surprises",
    "Permitted", "IntruderID", "Reason",
)  # fmt: skip

GROUND = Ground(meeting().daa, 500)


@pytest.fixture(scope="module")
def certificate() -> Any:
    """The first that ICAROUS offers in the meeting, at 41.5 s."""
    offers = list[Any]()
    keep, mission = Instance._offer, replace(meeting(), traffic=meeting().traffic)

    def caught(self: Instance, *given: Any) -> Any:
        out = keep(self, *given)
        offers.extend(one for one in out if isinstance(one, Offers))
        return out

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Instance, "_offer", caught)
        flown(replace(mission, simulation=replace(mission.simulation, limit_ms=42_000)))
    return offers[0].certificate


def test_a_certificate_keeps_zones_from_all_places_where_the_vehicle_may_be() -> None:
    """A straight flight 100 m beside a zone, by a vehicle that is where it is taken to be, or up to 120 m off."""
    corners = ((-500.0, 100.0), (1500.0, 100.0), (1500.0, 400.0), (-500.0, 400.0))
    beside = Zone(7, ZoneKind.KEEP_OUT, corners, 0.0, 1000.0)
    straight = Choice("heading", 0.0, 22.0, 0.0, 0.0, True, None)
    for here, permitted in ((Off(0.0, 0.0), True), (Off(120.0, 0.0), False)):
        sensed = Sensed(0, NORTH, ABILITY, (), Gate(ICAROUS, 1, False), here)
        scene = Scene((), (beside,), WIDE, 40.0, here)
        found = certified(sensed, scene, straight, meeting().daa)
        assert isinstance(found, Certificate) is permitted
        assert permitted or found == Refused(0, "a zone is in the way of the manoeuvre")


def in_hand(certificate: Any) -> InHand:
    now_ms = certificate.offer.sigma_ms
    held, (change,) = holding.offered(InHand(), certificate, now_ms, GROUND)
    assert change.kind == "Offered"
    return held


def test_only_what_may_take_over_does(certificate: Any) -> None:
    held, offer = in_hand(certificate), certificate.offer
    now_ms = offer.sigma_ms + 500
    again, (change,) = holding.offered(held, certificate, now_ms, GROUND)
    assert (change.kind, again.hand, again.certificate) == ("Refused", held.hand, certificate)
    good = offer._replace(id=2, base=1, sigma_ms=now_ms)
    for wrong in (
        good._replace(base=0),
        good._replace(id=1),
        good._replace(sigma_ms=now_ms - 1),
        good._replace(knowledge=1),
        good._replace(expiry_ms=now_ms + 1999),
    ):
        refused, _ = holding.offered(held, certificate._replace(offer=wrong), now_ms, GROUND)
        assert refused.hand == held.hand
    taken, _ = holding.offered(held, certificate._replace(offer=good), now_ms, GROUND)
    assert taken.hand == Hand(2, 0, good.expiry_ms, 0)


def test_news_is_permitted_or_a_surprise(certificate: Any) -> None:
    held, now_ms = in_hand(certificate), certificate.offer.sigma_ms
    own = certificate.pieces[0].position
    (seen,) = (track.seen for track in certificate.tracks)
    calm, said = holding.seen(held, own, (seen,), now_ms, GROUND)
    assert (calm, said) == (held, ())
    far = seen._replace(id=92, position=Position(9000.0, 9000.0, 300.0))
    known, (change,) = holding.seen(held, own, (seen, far), now_ms, GROUND)
    assert (change.permitted, known.hand) == (True, held.hand._replace(knowledge=1))
    assert holding.seen(known, own, (seen, far), now_ms, GROUND) == (known, ())
    ahead = seen._replace(id=93, position=own._replace(north_m=own.north_m + 100.0))
    told, (change,) = holding.seen(held, own, (seen, ahead), now_ms, GROUND)
    assert (change.permitted, change.intruder_id) == (False, 93)
    assert told.hand == Hand(1, 1, now_ms, 1)
    off = own._replace(east_m=own.east_m + 200.0)
    told, (change,) = holding.seen(held, off, (seen,), now_ms, GROUND)
    assert (change.reason, told.hand.surprises) == ("the vehicle is off what was permitted", 1)


def test_what_is_flown_on_and_when_it_is_over(certificate: Any) -> None:
    held, offer = in_hand(certificate), certificate.offer
    assert not holding.silent(held._replace(heard_ms=5000), 6000, GROUND)
    assert holding.silent(held._replace(heard_ms=5000), 6001, GROUND)
    first, command, said = holding.flown_on(held, offer.sigma_ms + 1000, 22.0)
    assert isinstance(command, Fly)
    assert [change.kind for change in said] == ["Flown"]
    second, command, said = holding.flown_on(first, offer.sigma_ms + certificate.pieces_ms, 22.0)
    assert (command, said) == (Circle(certificate.hold, 22.0), ())
    _, command, said = holding.flown_on(second, offer.expiry_ms, 22.0)
    assert isinstance(command, Circle)
    assert [change.kind for change in said] == ["Expired"]
    _, command, said = holding.flown_on(InHand(), 9000, 22.0)
    assert command is None
    assert [change.kind for change in said] == ["Missing"]


def test_another_manoeuvre_leaves_the_hand_and_the_same_does_not(certificate: Any) -> None:
    held, now_ms = in_hand(certificate), certificate.offer.sigma_ms + 500
    held, said = holding.steered(held, Velocity(0.0, 1.0, 0.0), now_ms - 500, GROUND)
    assert said == (), "it was offered for this command"
    kept, said = holding.steered(held, certificate.velocity(now_ms), now_ms, GROUND)
    assert (kept.certificate, said) == (certificate, ())
    gone, (change,) = holding.steered(held, Velocity(0.0, 22.0, 0.0), now_ms, GROUND)
    assert (gone.certificate, change.kind) == (None, "Left")
    assert gone.hand == Hand(2, 0, now_ms, 0)


def test_a_handback_with_nothing_in_hand_ends_what_was_offered_before(certificate: Any) -> None:
    now_ms = certificate.offer.sigma_ms
    held, said = holding.left(InHand(), now_ms, GROUND, "handed back")
    assert (held.hand, said) == (Hand(1, 0, now_ms, 0), ())
    refused, (change,) = holding.offered(held, certificate, now_ms, GROUND)
    assert (change.kind, refused.certificate) == ("Refused", None)


def test_a_log_with_a_handback_with_nothing_in_hand_fits_the_model(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of two stays of ICAROUS the first has no certificate."""
    keep = VehicleNode._offered

    def later(self: VehicleNode, state: Any, message: Any) -> Any:
        return keep(self, state, message) if message.now_ms > 100_000 else (state, ())

    comes = Traffic(92, Position(5000.0, 0.0, 300.0), Velocity(-9.0, 0.0, 0.0), appears_ms=150_000)
    simulation = replace(meeting().simulation, limit_ms=220_000)
    mission = replace(meeting(), traffic=(*meeting().traffic, comes), simulation=simulation)
    monkeypatch.setattr(VehicleNode, "_offered", later)
    log = flown(mission)
    owners = [one.body.Owner.name for one in log if one.topic.endswith("AuthorityChange")]
    assert owners == ["ICAROUS", "UxAS", "ICAROUS", "UxAS"]
    first = changes(log)[0]
    assert (first.Change.name, first.Base, first.ID) == ("Offered", 1, 2)
    assert replay(mission, True, log).finding is None


def test_silence_is_asked_for_in_the_mission_file(tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(
        yaml.safe_dump(
            {**small(), "simulation": {"bridge_faults": {"silent_s": 4, "speaks_again_s": 9}}}
        )
    )
    mission = load(path)
    assert isinstance(mission.simulation, FaultySimulation)
    faults = mission.simulation.bridge_faults
    assert [faults.icarous_is_silent(t) for t in (3999, 4000, 8999, 9000)] == [
        False,
        True,
        True,
        False,
    ]
    assert mission.notes[-1].endswith("ICAROUS falls silent at 4 s, ICAROUS speaks again at 9 s")
    wrong = {"silent_s": 9, "speaks_again_s": 9}
    path.write_text(yaml.safe_dump({**small(), "simulation": {"bridge_faults": wrong}}))
    with pytest.raises(BadInput, match="speaks_again_s"):
        load(path)
