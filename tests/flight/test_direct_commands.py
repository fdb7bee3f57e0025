"""An operator has a vehicle hold at a place and resume its plan: what it flies, what is refused, what is judged."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.core.routing.polylines import Track
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.hold_paths import Into, into
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.services.system_model.replay import replay
from cratous.spec.errors import BadInput
from cratous.spec.mission import Change, Mission, Position, Zone, ZoneKind
from cratous.spec.mission.changes import HoldCommand, known_at, words
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.plan import Pose

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CROSSING = load(EXAMPLES / "crossing" / "mission.yaml")
PLACE = (900.0, 900.0)
HOLD = HoldCommand(90_000, "vehicle_holds", vehicle=1, place=PLACE)
RESUME = Change(160_000, "vehicle_resumes", vehicle=1)


def _square(north_m: float, east_m: float, half_m: float, kind: ZoneKind) -> Zone:
    corners = ((-1, -1), (-1, 1), (1, 1), (1, -1))
    vertices = tuple((north_m + half_m * n, east_m + half_m * e) for n, e in corners)
    return Zone(9, kind, vertices, -1000.0, 10_000.0)


BESIDE = replace(CROSSING, zones=(_square(900, 3000, 200, ZoneKind.KEEP_OUT),))
"""With a keep-out that no way of the plan comes near."""


class Flown:
    """A flight, what its monitor says, and what was said."""

    def __init__(
        self,
        mission: Mission,
        daa: bool = False,
        directed: Callable[[int], tuple[Change, ...]] | None = None,
    ) -> None:
        if not daa:
            mission = replace(mission, instances=())
        bus, self.said = Bus(lmcp.full_names), list[Any]()
        plan, checks = plan_and_check(mission, bus)
        assert {check.outcome for check in checks} == {Outcome.HOLDS}
        self.monitor = Monitor(mission, plan)
        bus.tap(self.monitor.tap)
        self.log: list[Any] = []
        if daa:
            bus.tap(self.log.append)
        bus.tap(lambda e: self.said.append((e.time_ms, e.topic, lmcp.to_json(e.body))))
        self.result = fly(mission, plan, bus, daa=daa, directed=directed)
        self.outcomes = {
            (v.requirement, v.item): v.outcome for v in self.monitor.verdicts() if v.item
        }

    def of(self, topic: str) -> list[tuple[int, dict[str, Any]]]:
        return [
            (ms, json.loads(body)) for ms, name, body in self.said if name == f"cratous.{topic}"
        ]

    def answers(self) -> list[tuple[int, str]]:
        return [(ms, body["Consequence"]) for ms, body in self.of("MissionChange")]

    def phases(self, task: int) -> list[tuple[int, str]]:
        return [(ms, b["Phase"]) for ms, b in self.of("TaskProgress") if b["TaskID"] == task]


def until_s(mission: Mission, seconds: int) -> Mission:
    """The mission with another end of patience: one of whose vehicles holds for ever flies till then."""
    return replace(mission, simulation=replace(mission.simulation, limit_ms=seconds * 1000))


def with_(*changes: Change, base: Mission = CROSSING) -> Mission:
    return replace(base, changes=(*base.changes, *changes))


@pytest.fixture(scope="module")
def held() -> Flown:
    return Flown(with_(HOLD, RESUME))


@pytest.fixture(scope="module")
def plain() -> Flown:
    return Flown(BESIDE)


def test_it_leaves_its_task_holds_at_the_place_and_goes_on_where_it_left(held: Flown) -> None:
    (told, _), (again, answer) = held.answers()
    assert (told, again, answer) == (90_000, 160_000, "it goes on where it left")
    phases = held.phases(1)
    assert [phase for _, phase in phases] == [
        "Transit",
        "Active",
        "Suspended",
        "Active",
        "Complete",
    ]
    suspended, back = phases[2][0], phases[3][0]
    assert (suspended, back > 160_000) == (90_000, True)
    # on the circle through the place: never farther from it than the circle is wide
    near = [
        math.dist((t["North"], t["East"]), PLACE)
        for ms, t in held.of("TruthState")
        if t["VehicleID"] == 1 and 150_000 <= ms <= 160_000
    ]
    assert len(near) > 20
    assert max(near) < 2 * 1.5 * 1.1 * 22.0**2 / (9.80665 * math.tan(math.radians(30)))


def test_an_interrupted_task_is_served_whole(held: Flown, plain: Flown) -> None:
    assert held.result.outcome == "complete"
    assert held.outcomes["G3", "task 1 served"] is Outcome.HOLDS
    assert held.outcomes["G3", "task 2 served"] is Outcome.HOLDS
    # by so much later than it would have been
    assert held.result.ends[1] > plain.result.ends[1] + 70_000


def test_the_plan_is_the_same_and_nobody_plans_anew(held: Flown) -> None:
    assert held.result.replans == 0
    assert len(held.of("PlanAccepted")) == 1


def test_what_is_commanded_while_it_flies_gives_the_log_of_the_mission_that_says_it(
    held: Flown,
) -> None:
    now = {change.at_ms: (change,) for change in (HOLD, RESUME)}
    live = Flown(CROSSING, directed=lambda ms: now.get(ms, ()))
    assert live.said == held.said
    popup = until_s(load(EXAMPLES / "popup" / "mission.yaml"), 130)
    assert max(change.at_ms for change in popup.changes) == 100_000
    here = HoldCommand(20_000, "vehicle_holds", vehicle=1)
    changed = Flown(popup, directed=lambda ms: (here,) if ms == 20_000 else ())
    assert changed.said == Flown(with_(here, base=popup)).said


def test_who_never_resumes_leaves_its_task_unserved_and_that_is_said() -> None:
    flown = Flown(with_(HOLD, base=until_s(CROSSING, 230)))
    assert flown.result.outcome == "limit"
    assert flown.outcomes["G3", "task 1 served"] is Outcome.VIOLATED
    assert flown.outcomes["G3", "task 2 served"] is Outcome.HOLDS


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        # in a keep-out
        ((replace(HOLD, place=(900.0, 3000.0)),), "no circle there keeps the zones that bind at 300 m"),
        ((RESUME,), "it flies by its plan already"),
        (
            (Change(80_000, "vehicle_lost", vehicle=1), HOLD),
            "it was lost at 80.00 s",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_and_it_flies_on(
    changes: tuple[Change, ...], why: str, plain: Flown
) -> None:
    flown = Flown(with_(*changes, base=BESIDE))
    assert flown.answers()[-1][1].startswith(f"refused: {why}")
    if len(changes) == 1:
        assert flown.result.outcome == "complete"
        assert [one for one in flown.said if "MissionChange" not in one[1]] == [
            one for one in plain.said if "MissionChange" not in one[1]
        ]


class Straight(Ways):
    """Knows of no way but the straight one."""

    def way_to(self, chain: Chain, state: AirState, target: Pose) -> tuple[Position, ...]:
        return state.position, Position(*target[:3])


def test_it_climbs_no_faster_than_it_can() -> None:
    vehicle = CROSSING.vehicle(1)
    air = AirState(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    chain = Chain(vehicle, (), 0, Phase.DONE, Track((air.position,), 0.0), 22.0)

    def come_to(alt_m: float) -> Into:
        return into(Straight((), 0.25), chain, air, Pose(2200.0, 0.0, alt_m, 0.0))

    # a hundred seconds of 5 m/s
    high = come_to(790.0)
    assert high.track is not None
    assert (round(high.way_m), high.track.points[-1].alt_m) == (2200, 790.0)
    assert come_to(810.0).why.startswith("it cannot come to 810 m on a way of 22")


def test_a_zone_over_where_it_holds_ends_that() -> None:
    zone = Change(140_000, "zone", zone=_square(*PLACE, 300, ZoneKind.KEEP_OUT))
    flown = Flown(with_(HOLD, zone))
    said = [(ms, body["What"]) for ms, body in flown.of("MissionChange")]
    assert (140_000, "vehicle 1 holds no longer") in said
    assert flown.result.outcome == "complete"
    assert flown.outcomes["G3", "task 1 served"] is Outcome.HOLDS


def test_it_holds_on_by_another_plan_and_then_flies_that() -> None:
    """Another task is asked for: the one that is left has it too, and it begins its task again when it resumes."""
    crossing = load(EXAMPLES / "crossing" / "mission.yaml")
    task = replace(crossing.task(2), id=3, eligible=(1,), points=(Position(1200.0, -900.0, 300.0),))
    more = replace(crossing, tasks=(*crossing.tasks, task), relations="|(p1 p2 p3)")
    flown = Flown(with_(HOLD, Change(120_000, "task_added", task=3), RESUME, base=more))
    assert flown.result.replans == 1
    assert flown.answers()[-1] == (160_000, "it flies on by the plan that there is now")
    assert flown.result.outcome == "complete"
    assert {flown.outcomes["G3", f"task {k} served"] for k in (1, 2, 3)} == {Outcome.HOLDS}
    # it flew nothing of any task while it held
    between = [ms for k in (1, 3) for ms, phase in flown.phases(k) if phase == "Active"]
    assert not [ms for ms in between if 90_000 < ms < 160_000]


def test_icarous_keeps_what_it_has_and_gives_it_back_to_the_hold() -> None:
    early = replace(HOLD, at_ms=32_750, place=(300.0, -300.0))
    changes = (
        early,
        HoldCommand(43_250, "vehicle_holds", vehicle=2),
        replace(RESUME, at_ms=75_750),
    )
    flown = Flown(with_(*changes), daa=True)
    answers = [answer for _, answer in flown.answers()]
    assert answers[1] == "refused: ICAROUS has it"
    assert answers[2] == "it goes on where it left"
    assert flown.result.takeovers >= 2
    assert flown.result.outcome == "complete"
    assert set(flown.outcomes.values()) == {Outcome.HOLDS}
    # every command was one that UxAS might give then, in the epoch in which it had the vehicle
    found = replay(CROSSING, True, flown.log)
    assert found.finding is None, found.finding.text


def test_a_command_changes_nothing_of_what_is_known_of_the_mission() -> None:
    assert known_at(with_(HOLD, RESUME), 100_000) == CROSSING
    assert words(HOLD) == "vehicle 1 is commanded to hold at north 900 m, east 900 m"
    here = HoldCommand(0, "vehicle_holds", vehicle=1, alt_m=250.0)
    assert words(here) == "vehicle 1 is commanded to hold where it is, altitude 250 m"
    assert words(RESUME) == "vehicle 1 is commanded to resume its plan"


FILE = """
changes:
  - {at_s: 0, vehicle_holds: {vehicle: 2}}
  - {at_s: 90, vehicle_holds: {vehicle: 1, place: [900, 900], alt_m: 320}}
  - {at_s: 95, vehicle_holds: {vehicle: 1, place: {latitude_deg: 37.1, longitude_deg: -76.4}}}
  - {at_s: 160, vehicle_resumes: NUMBER}
"""


def _file(folder: Path, number: int) -> Path:
    text = (EXAMPLES / "crossing" / "mission.yaml").read_text(encoding="utf-8")
    (folder / "m.yaml").write_text(text + FILE.replace("NUMBER", str(number)), encoding="utf-8")
    return folder / "m.yaml"


def test_the_mission_file_says_them(tmp_path: Path) -> None:
    here, there, origin, resumes = load(_file(tmp_path, 1)).changes
    assert here == HoldCommand(0, "vehicle_holds", vehicle=2)
    assert there == replace(HOLD, alt_m=320.0)
    assert isinstance(origin, HoldCommand)
    assert origin.place == pytest.approx((0.0, 0.0), abs=1e-6)
    assert resumes == RESUME
    with pytest.raises(BadInput, match="vehicle 7 does not exist"):
        load(_file(tmp_path, 7))


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [("[900, 900]", "[900, 900000]", "too far"), ("alt_m: 320", "alt_m: 10", "goes so low")],
)
def test_a_place_where_nobody_can_hold_is_told(
    tmp_path: Path, old: str, new: str, why: str
) -> None:
    file = _file(tmp_path, 1)
    file.write_text(file.read_text("utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(BadInput, match=rf"vehicle_holds.*{why}") as caught:
        load(file)
    assert "m.yaml" in str(caught.value)


def test_a_command_at_the_start_is_obeyed(tmp_path: Path) -> None:
    flown = Flown(until_s(load(_file(tmp_path, 1)), 300))
    assert flown.answers()[0][0] == 0
    assert flown.result.outcome in ("limit", "failed")  # nobody has vehicle 2 resume
    assert flown.outcomes["G3", "task 2 served"] is Outcome.VIOLATED
