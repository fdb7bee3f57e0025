"""A cordon: vehicles that drive block every road that crosses the circle about a place."""

from __future__ import annotations

import itertools
import math
import random
import shutil
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, must_fly, request, vehicle
from road_tools import EXAMPLE, MIDDLE, at, car, driven, map_text
from uxas_tools import process

from cratous.bridge import lmcp
from cratous.services.following import blocking
from cratous.services.following.blocking import in_turn, soonest
from cratous.services.loading.uxas import load_uxas
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

SHIPPED = Path(__file__).parents[3] / "shared/examples/openuxas-shipped/99_Tasks/CordonTask"
TASKS = "Task services"


def cordon(**more: Any) -> Any:
    values = {"TaskID": 100, "CordonLocation": at(*MIDDLE), "StandoffDistance": 100.0}
    return lmcp.new("CordonTask", **{**values, **more})


def cars(count: int) -> list[Any]:
    """Vehicles on the street through the middle, north of it."""
    return [body for k in range(count) for body in car(k + 1, MIDDLE[0] + 0.003 * k, MIDDLE[1])]


def asked(folder: Path, task: Any, *others: Any, count: int = 4, tasks: Any = (100,)) -> Rig:
    """What is said of a request with this task."""
    rig = driven(folder)
    rig.tell(*cars(count), *others, task, request(*tasks, vehicles=tuple(range(1, count + 1))))
    return rig


def ends(rig: Rig) -> dict[int, Any]:
    """By vehicle the last waypoint of its plan that bears the task."""
    commands = rig.got("AutomationResponse")[-1].MissionCommandList
    return {c.VehicleID: [w for w in c.WaypointList if w.AssociatedTasks][-1] for c in commands}


def standing(rig: Rig, number: int, time_ms: int, off_deg: float = 0.0, **more: Any) -> Any:
    """The state of a vehicle that stands at its place, or so far north of it."""
    end = ends(rig)[number]
    _, state = car(number, end.Latitude + off_deg, end.Longitude)
    return state.copy(Time=time_ms, Mode="Waypoint", **more)


@pytest.mark.shows(TASKS, "TaskPlanOptions", "TaskImplementationResponse")
def test_each_road_gets_a_vehicle_of_its_own_at_the_standoff_distance(tmp_path: Path) -> None:
    rig = asked(tmp_path, cordon())
    (options,) = rig.got("TaskPlanOptions")
    assert len(options.Options) == 16
    assert options.Composition.count("|(") == math.factorial(4)
    plane = Projection(Frame(*MIDDLE))
    places = [plane.to_local(w.Latitude, w.Longitude) for w in ends(rig).values()]
    assert len(places) == 4
    for k, (north, east) in enumerate(places):
        assert math.hypot(north, east) == pytest.approx(100.0, abs=0.01)
        assert min(abs(north), abs(east)) < 0.1, "on a street, which lead north and east"
        assert all(math.dist((north, east), other) > 100 for other in places[:k])
    assert not rig.reasons()
    assert not rig.reasons("Warning")


def test_with_more_vehicles_than_roads_the_last_is_there_as_soon_as_can_be(tmp_path: Path) -> None:
    rig = asked(tmp_path, cordon(), count=5)
    assert sorted(ends(rig)) == [1, 2, 3, 4], "the farthest has nothing to do"


def test_of_too_many_ways_those_are_offered_of_which_the_last_is_there_soonest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blocking, "WAYS_MOST", 20)
    rig = asked(tmp_path, cordon(), count=5)
    assert rig.got("TaskPlanOptions")[0].Composition.count("|(") == 20
    assert sorted(ends(rig)) == [1, 2, 3, 4], "who are nearest"
    assert "any way but 20 of 120" in rig.reasons("Warning")[0]
    rig.tell(*car(1, *MIDDLE, speed=0.5), request(100, vehicles=(1, 2, 3, 4, 5)))
    assert sorted(ends(rig)) == [2, 3, 4, 5], "one that is near and slow is there last"


def test_ways_come_in_their_order_or_there_is_none() -> None:
    rng = random.Random(3)
    for _ in range(20):
        places, count = rng.randint(1, 4), rng.randint(4, 5)
        times = [[rng.uniform(0, 100) for _ in range(count)] for _ in range(places)]
        every = {w: [row[v] for row, v in zip(times, w, strict=True)]
                 for w in itertools.permutations(range(count), places)}  # fmt: skip
        found = soonest(times, 720)
        assert found == sorted(every, key=lambda w: (max(every[w]), sum(every[w])))
        assert soonest(times, 2) == found[:2]
    eight = [[rng.uniform(0, 100) for _ in range(8)] for _ in range(8)]
    assert len(soonest(eight, 720)) == 720, "eight vehicles at eight roads"


def test_where_the_soonest_ways_are_not_found_one_is_offered_and_not_called_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blocking, "LOOKED_MOST", 1)
    assert soonest([[3.0, 1.0, 2.0], [9.0, 1.0, 8.0], [1.0, 1.0, 1.0]], 720) == []
    assert in_turn([[3.0, 1.0, 2.0], [9.0, 1.0, 8.0], [1.0, 1.0, 1.0]]) == (1, 2, 0)
    rig = asked(tmp_path, cordon())
    assert len(ends(rig)) == 4
    assert "any way but 1 of 24, by which each road in turn" in rig.reasons("Warning")[0]


@pytest.mark.shows(TASKS, "TaskActive", "TaskComplete")
def test_it_is_complete_when_all_stand_at_one_time_for_as_long_as_is_asked(tmp_path: Path) -> None:
    pair = lmcp.new("KeyValuePair", Key="Duration_ms", Value="3000")
    rig = asked(tmp_path, cordon(Parameters=[pair]))
    (stand,) = ends(rig)[1].VehicleActionList
    assert (stand.LoiterType.name, stand.Duration) == ("Hover", 6000), "so that it is told to stay"
    rig.tell(*(standing(rig, n, 1000, 0.01) for n in range(1, 5)))
    assert not rig.got("TaskActive"), "they are on their ways"
    rig.tell(standing(rig, 1, 2000, 0.001, AssociatedTasks=[100]))
    assert [body.EntityID for body in rig.got("TaskActive")] == [1], "on its last leg"
    for time_ms in (3000, 6000):
        rig.tell(*(standing(rig, n, time_ms) for n in (1, 2, 3)))
    rig.tell(*(standing(rig, n, time_ms) for time_ms in (7000, 8000) for n in range(1, 5)))
    rig.tell(standing(rig, 2, 8500, 0.001))
    assert "vehicle 2 has left the road that it blocks" in rig.reasons("Warning")[0]
    rig.tell(*(standing(rig, n, time_ms) for time_ms in (9000, 11000) for n in range(1, 5)))
    assert not rig.got("TaskComplete"), "the time counts anew"
    rig.tell(*(standing(rig, n, 12_000) for n in range(1, 5)))
    (complete,) = rig.got("TaskComplete")
    assert complete.EntitiesInvolved == [1, 2, 3, 4]
    assert complete.TimeTaskCompleted == 12_000
    assert sorted(body.EntityID for body in rig.got("TaskActive")) == [1, 2, 3, 4]
    assert len(rig.reasons("Warning")) == 1


def test_who_is_silent_or_tells_no_place_is_not_there(tmp_path: Path) -> None:
    rig = asked(tmp_path, cordon())
    rig.tell(*(standing(rig, n, 1000) for n in range(1, 5)))
    for time_ms in range(2000, 9000, 1000):
        rig.tell(standing(rig, 4, time_ms).copy(Location=at(math.nan, 0.0)))
        rig.tell(*(standing(rig, n, time_ms) for n in (2, 3)))
    assert not rig.got("TaskComplete")
    assert len(rig.reasons("Warning")) == 1
    assert "vehicle 4 is not at its place: " in rig.reasons("Warning")[0]


def test_who_passes_its_place_does_not_stand_there(tmp_path: Path) -> None:
    rig = asked(tmp_path, cordon())
    for time_ms in (1000, 2000, 3000):
        rig.tell(*(standing(rig, n, time_ms) for n in (1, 2, 3)))
        rig.tell(standing(rig, 4, time_ms, Groundspeed=3.0))
    assert not rig.got("TaskComplete")
    rig.tell(standing(rig, 4, 4000, Groundspeed=math.nan))
    assert "vehicle 4 is not at its place: its Groundspeed" in rig.reasons("Warning")[0]
    rig.tell(*(standing(rig, n, time_ms) for time_ms in (4500, 5500) for n in range(1, 5)))
    assert rig.got("TaskComplete")[0].TimeTaskCompleted == 5500


def test_one_alone_does_not_count_while_it_is_silent(tmp_path: Path) -> None:
    out = map_text({1: MIDDLE, 2: (MIDDLE[0] + 0.01, MIDDLE[1])}, [1, 2])
    rig = driven(tmp_path, roads=out)
    pair = lmcp.new("KeyValuePair", Key="Duration_ms", Value="3000")
    rig.tell(*cars(1), cordon(Parameters=[pair]), request(100))
    rig.tell(*(standing(rig, 1, time_ms) for time_ms in (1000, 9000, 11_000)))
    assert not rig.got("TaskComplete")
    rig.tell(standing(rig, 1, 12_000))
    assert len(rig.got("TaskComplete")) == 1


def test_another_request_with_it_and_a_plan_without_it_end_it(tmp_path: Path) -> None:
    rig = asked(tmp_path, cordon())
    rig.tell(*(standing(rig, n, 1000) for n in range(1, 5)))
    rig.tell(request(100, vehicles=(1, 2, 3, 4)))
    assert len(rig.got("AutomationResponse")[-1].MissionCommandList) == 4
    rig.tell(*(standing(rig, n, t) for t in (2000, 4000) for n in range(1, 5)))
    assert len(rig.got("TaskComplete")) == 1, "of the second request"
    assert [text for text in rig.reasons("Warning") if "ends undone" in text], "the first"


@pytest.mark.parametrize(
    ("task", "count", "reason"),
    [
        ({}, 3, "4 roads cross the circle of 100 m, and 3 vehicles may block one"),
        ({"EligibleEntities": [1, 2, 3]}, 4, "4 roads cross the circle of 100 m, and 3 vehicles"),
        ({"CordonLocation": at(MIDDLE[0] + 0.003, MIDDLE[1] + 0.0025)}, 4,
         "OsmPlannerService has told of no road that crosses the circle of 100 m"),
        ({"StandoffDistance": 0.0}, 4, "StandoffDistance: out of range"),
        ({"StandoffDistance": 1e6}, 4, "StandoffDistance: out of range"),
        ({"CordonLocation": at(95.0, 0.0)}, 4, "CordonLocation: not a place"),
        ({"Parameters": [lmcp.new("KeyValuePair", Key="Duration_ms", Value="0")]}, 4,
         "Duration_ms: out of range"),
    ],
)  # fmt: skip
def test_what_cannot_be_cordoned_is_answered_with_the_reason(
    tmp_path: Path, task: Any, count: int, reason: str
) -> None:
    rig = asked(tmp_path, cordon(**task), count=count)
    assert rig.got("AutomationResponse")[-1].MissionCommandList == []
    assert reason in "\n".join(rig.reasons())


@pytest.mark.parametrize("alt_m", [None, 1000.0])
def test_a_place_within_a_zone_is_not_blocked(tmp_path: Path, alt_m: float | None) -> None:
    """A road is on the ground, at whatever altitude another tells of it."""
    place = at(MIDDLE[0] - 0.0009, MIDDLE[1])
    zone = lmcp.new(
        "KeepOutZone", ZoneID=7, MinAltitude=-10.0, MaxAltitude=500.0,
        Boundary=lmcp.new("Circle", CenterPoint=place, Radius=20.0),
    )  # fmt: skip
    rig = driven(tmp_path)
    if alt_m is not None:
        places = [place.copy(Altitude=alt_m)]
        rig.bus.remove("OsmPlannerService")
        rig.bus.add(Other(lmcp.new("EgressRouteResponse", NodeLocations=places, Headings=[0.0])))
    rig.tell(*cars(4), zone, lmcp.new("OperatingRegion", ID=9, KeepOutAreas=[7]), cordon())
    rig.tell(request(100, vehicles=(1, 2, 3, 4), OperatingRegion=9))
    which = "3 of 4" if alt_m is None else "1 of 1"
    assert f"road {which} would be blocked in breach of" in "\n".join(rig.reasons())


def test_without_a_planner_on_roads_nobody_waits(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*cars(4), cordon(), request(100, vehicles=(1, 2, 3, 4)))
    assert "no OsmPlannerService is here, which knows the roads" in "\n".join(rig.reasons())


@pytest.mark.parametrize(
    ("places", "headings", "reason"),
    [
        ([at(*MIDDLE)] * 9, [], "9 roads cross the circle of 100 m, and at most 8 are blocked"),
        ([at(math.nan, 0.0)], [], "NodeLocations[0]: not a place"),
        ([at(*MIDDLE)], [math.nan], "not a heading"),
    ],
)
def test_rubbish_of_who_tells_the_roads_is_answered(
    tmp_path: Path, places: Any, headings: Any, reason: str
) -> None:
    rig = driven(tmp_path)
    rig.bus.remove("OsmPlannerService")
    rig.bus.add(Other(lmcp.new("EgressRouteResponse", NodeLocations=places, Headings=headings)))
    rig.tell(*cars(1), cordon(), request(100))
    assert rig.got("AutomationResponse")[-1].MissionCommandList == []
    assert reason in "\n".join(rig.reasons())


class Other:
    """A planner on roads that is another's, and answers the same whatever it is asked."""

    name = "OsmPlannerService"
    subscribes = ("uxas.messages.route.EgressRouteRequest",)

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Any, now_ms: int) -> Any:
        return None, [self.answer.copy(ResponseID=envelope.body.RequestID)]


def test_what_flies_blocks_no_road_and_what_drives_flies_no_task(tmp_path: Path) -> None:
    aircraft = vehicle(9)[0], vehicle(9)[1].copy(Location=at(*MIDDLE).copy(Altitude=300.0))
    fly = must_fly(5, MIDDLE[0] + 0.02, MIDDLE[1])
    rig = driven(tmp_path)
    rig.tell(*cars(4), *aircraft, fly, cordon(), request(5, 100, vehicles=(1, 2, 3, 4, 9)))
    assert sorted(ends(rig)) == [1, 2, 3, 4, 9]
    assert ends(rig)[9].AssociatedTasks == [5]
    assert "vehicle 9 is not offered for task 100: it does not drive" in rig.reasons("Warning")[0]
    blockade = lmcp.new("BlockadeTask", TaskID=6, BlockedEntityID=9)
    for number in (5, 6):
        rig.all.clear()
        rig.tell(blockade, request(number, vehicles=(1, 2)))
        assert "it drives, and the task is flown" in "\n".join(rig.reasons())


def test_the_example_is_planned(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLE, tmp_path / "cordon")
    one, said = process(folder / "cfg.xml", data=tmp_path, virtual=True)
    commands: list[Any] = []
    one.bus.tap(lambda e: commands.extend(getattr(e.body, "MissionCommandList", ())))
    one.run(3.0)
    assert sorted(c.VehicleID for c in commands) == [13, 14, 15, 16]
    assert not said.has("WARN")


@pytest.mark.skipif(not SHIPPED.is_dir(), reason="no ../shared/examples")
def test_the_example_of_openuxas_is_planned_on_roads_of_ours(tmp_path: Path) -> None:
    """Its map is in no copy that there is; without one the task is answered with the reason."""
    folder = shutil.copytree(SHIPPED, tmp_path / "cordon")
    path, sent = folder / "cfg_CordonTask.xml", folder / "MessagesToSend"
    for roads in (False, True):
        if roads:
            shutil.copy(EXAMPLE / "roads.osm", sent / "Pensacola_Map.xml")
        text = path.read_text().replace("../MessagesToSend/", "MessagesToSend/")
        path.write_text(text)
        one, said = process(path, data=tmp_path, virtual=True)
        commands: list[Any] = []
        one.bus.tap(lambda e, to=commands: to.extend(getattr(e.body, "MissionCommandList", ())))
        one.run(10.0)
        assert sorted(c.VehicleID for c in commands) == ([13, 14, 15, 16] if roads else [])
        assert said.has("its map MessagesToSend/Pensacola_Map.xml is missing") != roads


def test_a_folder_of_what_drives_is_refused_by_name_elsewhere(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLE, tmp_path / "cordon")
    with pytest.raises(BadInput, match="tasks of type CordonTask are not covered"):
        load_uxas(folder)
    text = (folder / "Cordon.xml").read_text()
    (folder / "Cordon.xml").write_text(
        text.replace("<TaskList>", "<EntityList><int64>13</int64></EntityList><TaskList>")
    )
    with pytest.raises(BadInput, match="vehicle 13 drives, and only `cratous uxas` plans"):
        load_uxas(folder)


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        (lambda c, s: (c.copy(NominalSpeed=0.0), s), "vehicle 1 does not drive"),
        (lambda c, s: (c.copy(NominalSpeed=math.nan), s), "vehicle 1 does not drive"),
        (lambda c, s: (c.copy(MaximumSpeed=1.0), s), "cannot fly at its cruise speed"),
        (lambda c, s: (c, vehicle(1)[1]), "the state of vehicle 1 is of another kind"),
        (lambda c, s: (vehicle(1)[0], s), "the state of vehicle 1 is of another kind"),
        (lambda c, s: (c, s.copy(Location=at(math.nan, 0.0))), "Location: not a place"),
        (
            lambda c, s: (c, s.copy(Location=at(MIDDLE[0] - 0.05, 0.0 + MIDDLE[1]))),
            "vehicle 1: no road is within 1000 m",
        ),
    ],
)
def test_a_vehicle_that_is_none_is_named(tmp_path: Path, changed: Any, reason: str) -> None:
    rig = driven(tmp_path)
    rig.tell(*cars(4), *changed(*car(1, *MIDDLE)), cordon(), request(100, vehicles=(1, 2, 3, 4)))
    assert rig.got("AutomationResponse")[-1].MissionCommandList == []
    assert reason in "\n".join([*rig.reasons(), *rig.reasons("Warning")])
