"""Roads of a map of OpenStreetMap, ways along them, and the OsmPlannerService that answers with these."""

from __future__ import annotations

import math
import random
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, vehicle
from road_tools import EXAMPLE, MIDDLE, at, car, driven, map_text
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.services.loading.uxas_settings import read
from cratous.services.roads import files, osm
from cratous.services.roads.network import Network, length_m
from cratous.services.uxas.logs import Logs
from cratous.services.uxas.process import Process
from cratous.spec.errors import BadInput

ROADS = "OsmPlannerService"
ORIGIN = {1: (0.0, 0.0), 2: (0.0, 0.001)}


def network(text: str) -> Network:
    return Network(osm.map_of(text, "roads.osm"), "roads.osm")


def test_the_example_is_read() -> None:
    roads = osm.read_map(EXAMPLE / "roads.osm")
    assert (len(roads.nodes), len(roads.roads), roads.notes) == (49, 14, ())
    assert len(Network(roads, "").legs) == 2 * 7 * 6


def test_a_road_is_a_way_with_a_tag_highway_cut_where_the_map_ends() -> None:
    text = map_text({**ORIGIN, 3: (0.0, 0.002), 4: (0.0, 0.003)}, [1, 1, 2, 77, 3, 4], [77, 4])
    text = text.replace("</osm>", '<way id="9"><nd ref="1"/><nd ref="4"/></way></osm>')
    roads = osm.map_of(text, "roads.osm")
    assert roads.roads == ((1, 2), (3, 4))
    assert "2 roads lead over nodes that the map does not have" in roads.notes[0]


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("<osm>", "not well-formed XML"),
        ("<gpx/>", "not a map.*<osm>.*<gpx>"),
        ('<!DOCTYPE osm [<!ENTITY a "b">]><osm>&a;</osm>', "entity in XML"),
        ("<osm/>", "a map without a road"),
        (map_text(ORIGIN, [1]), "a map without a road"),
        (map_text(ORIGIN, [1, 2]).replace('ref="1"', 'ref="x"'), "<nd> without a number"),
        (map_text(ORIGIN, [1, 2]).replace('id="2" lat', f'id="{"9" * 400}" lat'), "<node> without"),
        (map_text(ORIGIN, [1, 2]).replace('lon="0.0010', 'lon="1e999'), "node 2 is at no place"),
        (map_text(ORIGIN, [1, 2]).replace('lon="0.0010', 'long="'), "node 2 is at no place"),
        (map_text({1: (0.0, 0.0), 2: (91.0, 0.0)}, [1, 2]), "node 2 is at no place"),
        (
            map_text(ORIGIN, [1, 2]).replace("<way", '<node id="2" lat="0.5" lon="0"/><way'),
            "node 2 is at two places",
        ),
        (map_text({1: (0.0, 0.0), 2: (0.0, 5.0)}, [1, 2]), "a map that is too wide.*200 km"),
    ],
)
def test_what_is_no_map_is_refused_by_name(text: str, error: str) -> None:
    with pytest.raises(BadInput, match=error):
        network(text)


def test_a_map_with_too_many_roads_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(osm, "NODES_MOST", 1)
    with pytest.raises(BadInput, match=r"too many roads.*at most 1 nodes.*2"):
        network(map_text(ORIGIN, [1, 2]))
    monkeypatch.setattr(osm, "NODES_MOST", 2)
    monkeypatch.setattr(osm, "LEGS_MOST", 1)
    with pytest.raises(BadInput, match=r"too many roads.*at most 1 legs.*2"):
        network(map_text(ORIGIN, [1, 2], [2, 1]))


def all_lengths(roads: Network) -> list[list[float]]:
    """Shortest lengths between all nodes, by relaxing until nothing changes."""
    count = len(roads.nodes)
    found = [[0.0 if a == b else math.inf for b in range(count)] for a in range(count)]
    for _ in range(count):
        for row in found:
            for a, b in roads.legs:
                leg = math.dist(roads.nodes[a], roads.nodes[b])
                row[a], row[b] = min(row[a], row[b] + leg), min(row[b], row[a] + leg)
    return found


def test_ways_are_the_shortest_and_along_roads() -> None:
    rng = random.Random(5)
    for _ in range(6):
        nodes = {n: (rng.uniform(0, 0.01), rng.uniform(0, 0.01)) for n in range(1, 13)}
        ways = [rng.sample(sorted(nodes), 2) for _ in range(16)]
        roads = network(map_text(nodes, *ways))
        least = all_lengths(roads)
        legs = {frozenset((roads.nodes[a], roads.nodes[b])) for a, b in roads.legs}
        for a, here in enumerate(roads.nodes):
            for b, there in enumerate(roads.nodes):
                feet = roads.foot(here), roads.foot(there)
                assert feet[0] is not None
                assert feet[1] is not None
                way = roads.way(*feet)
                if math.isinf(least[a][b]):
                    assert way == ()
                    continue
                assert length_m(way) == pytest.approx(least[a][b], abs=1e-6)
                for p, q in pairwise(way):  # feet stand on nodes to within a rounding
                    near = [min(roads.nodes, key=lambda n, x=x: math.dist(n, x)) for x in (p, q)]
                    assert len(set(near)) == 1 or frozenset(near) in legs


def test_a_way_begins_and_ends_within_a_leg_and_takes_no_detour_over_its_end() -> None:
    roads = network(map_text(ORIGIN, [1, 2]))
    feet = [roads.foot(Vec2(30.0, east)) for east in (-20.0, 25.0)]
    assert feet[0] is not None
    assert feet[1] is not None
    for way in (roads.way(*feet), roads.way(*reversed(feet))):
        assert length_m(way) == pytest.approx(45.0)
        assert len(way) == 2
    assert roads.foot(Vec2(1000.5, 0.0)) is None
    assert roads.foot(Vec2(999.5, 0.0)) is not None


def test_every_crossing_is_on_the_circle_and_on_a_road_and_none_is_left_out() -> None:
    rng = random.Random(7)
    several = 0
    for _ in range(60):
        nodes = {n: (rng.uniform(0, 0.004), rng.uniform(0, 0.004)) for n in range(1, 9)}
        ways = [rng.sample(sorted(nodes), 2) for _ in range(5)]
        roads = network(map_text(nodes, *ways))
        middle, radius = Vec2(rng.uniform(-50, 50), rng.uniform(-50, 50)), rng.uniform(30, 150)
        found = roads.crossings(middle, radius)
        several += len(found) > 2
        for one in found:
            assert math.dist(one.at, middle) == pytest.approx(radius, abs=1e-6)
            out = (one.at.x + math.cos(one.heading_rad), one.at.y + math.sin(one.heading_rad))
            assert math.dist(out, middle) > radius, "its heading leads outwards"
        for a, b in roads.legs:
            p, q = roads.nodes[a], roads.nodes[b]
            steps = [
                Vec2(p.x + k / 400 * (q.x - p.x), p.y + k / 400 * (q.y - p.y)) for k in range(401)
            ]
            for s, t in pairwise(steps):
                if (math.dist(s, middle) < radius) != (math.dist(t, middle) < radius):
                    assert min(math.dist(one.at, s) for one in found) < math.dist(s, t) + 1.1
    assert several > 10


def test_a_long_leg_crosses_twice_and_roads_that_meet_on_the_circle_once() -> None:
    long = network(map_text({1: (-0.01, 0.0005), 2: (0.01, 0.0005)}, [1, 2]))
    middle = long.local(0.0, 0.0)
    assert len(long.crossings(middle, 100.0)) == 2
    assert long.crossings(middle, 50.0) == ()
    star = network(
        map_text({1: (0, 0), 2: (0, 0.001), 3: (0.001, 0.002), 4: (-0.001, 0.002)},
                 [1, 2], [2, 3], [2, 4])
    )  # fmt: skip
    middle = star.local(0.0, 0.0)
    assert len(star.crossings(middle, math.dist(middle, star.local(0.0, 0.001)))) == 1


# the service


def routes(*ends: tuple[tuple[float, float], tuple[float, float]], **more: Any) -> Any:
    asked = [
        lmcp.new("RouteConstraints", RouteID=k, StartLocation=at(*a), EndLocation=at(*b))
        for k, (a, b) in enumerate(ends)
    ]
    return lmcp.new("RoutePlanRequest", RequestID=3, VehicleID=1, RouteRequests=asked, **more)


def planned(rig: Rig, *ends: Any, **more: Any) -> Any:
    rig.tell(routes(*ends, **more))
    return rig.got("RoutePlanResponse")[-1].RouteResponses


@pytest.mark.shows(ROADS, "RoutePlanRequest", "RoutePlanResponse", "EntityConfiguration", "OsmFile")
def test_what_drives_is_routed_along_roads_and_what_flies_is_not(tmp_path: Path) -> None:
    rig = driven(tmp_path, ROADS)
    rig.tell(*car(1, *MIDDLE), *vehicle(2))
    corner = (MIDDLE[0] + 0.006, MIDDLE[1] + 0.0055)
    (plan,) = planned(rig, (MIDDLE, corner), IsCostOnlyRequest=False)
    roads = Network(osm.read_map(EXAMPLE / "roads.osm"), "")
    here, there = roads.local(*MIDDLE), roads.local(*corner)
    around_m = abs(here.x - there.x) + abs(here.y - there.y)
    assert plan.RouteCost == pytest.approx(1000 * around_m / 8.0, rel=1e-3)
    points = [(w.Latitude, w.Longitude) for w in plan.Waypoints]
    assert points[0] == pytest.approx(MIDDLE)
    assert points[-1] == pytest.approx(corner)
    assert len(points) == 3, "over the corner of two streets"
    assert {w.Speed for w in plan.Waypoints} == {8.0}
    (cost,) = planned(rig, (MIDDLE, corner), IsCostOnlyRequest=True)
    assert (cost.RouteCost, cost.Waypoints) == (plan.RouteCost, [])
    rig.tell(routes((MIDDLE, corner)).copy(VehicleID=2))
    assert len(rig.got("RoutePlanResponse")) == 2


@pytest.mark.shows(ROADS, "GroundPathPlanner")
def test_a_request_for_the_group_of_ground_planners_is_answered(tmp_path: Path) -> None:
    rig = driven(tmp_path, ROADS)
    rig.tell(*car(1, *MIDDLE))
    rig.bus.publish(routes((MIDDLE, MIDDLE)), "test", "GroundPathPlanner")
    rig.bus.run()
    (answer,) = rig.got("RoutePlanResponse")
    assert [plan.RouteCost for plan in answer.RouteResponses] == [0]


def test_without_a_planner_on_roads_there_is_no_way_for_what_drives(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "RoutePlannerVisibilityService")
    rig.tell(*car(1, *MIDDLE))
    (plan,) = planned(rig, (MIDDLE, MIDDLE))
    assert plan.RouteCost == -1
    assert plan.RouteError[0].Value == "vehicle 1 drives, and no OsmPlannerService is here"


def test_a_way_keeps_the_zones_and_what_there_is_no_way_to_says_why(tmp_path: Path) -> None:
    apart = map_text(
        {1: (0, 0), 2: (0, 0.01), 3: (0.01, 0.01), 4: (0.01, 0), 5: (0.02, 0), 6: (0.02, 0.01)},
        [1, 2, 3, 4, 1], [5, 6],
    )  # fmt: skip
    rig = driven(tmp_path, ROADS, roads=apart)
    there = ((0.0, 0.0), (0.0, 0.01))
    rig.tell(*car(1, 0.0, 0.0))
    assert len(planned(rig, there, IsCostOnlyRequest=False)[0].Waypoints) == 2
    circle = lmcp.new("Circle", CenterPoint=at(0.0, 0.005), Radius=100.0)
    beside = lmcp.new("Circle", CenterPoint=at(0.004, 0.0015), Radius=50.0)
    rig.tell(
        lmcp.new("KeepOutZone", ZoneID=7, Boundary=circle, MinAltitude=0.0, MaxAltitude=500.0),
        lmcp.new("KeepOutZone", ZoneID=8, Boundary=beside, MinAltitude=0.0, MaxAltitude=500.0),
        lmcp.new("OperatingRegion", ID=9, KeepOutAreas=[7, 8]),
    )
    ends = (there, ((0.0, 0.0), (0.02, 0.005)), (there[0], (0.5, 0.0)), (there[0], (200.0, 0.0)),
            (there[0], (0.0006, 0.005)), (there[0], (0.004, 0.003)))  # fmt: skip
    plans = planned(rig, *ends, OperatingRegion=9, IsCostOnlyRequest=False)
    assert len(plans[0].Waypoints) == 4, "around the zone"
    assert [plan.RouteCost for plan in plans[1:]] == [-1] * 5
    reasons = [plan.RouteError[0].Value for plan in plans[1:]]
    assert "no road leads there" in reasons[0]
    assert "no road is within 1000 m of EndLocation" in reasons[1]
    assert "not a place" in reasons[2]
    assert "no road leads there that keeps the zones" in reasons[3]
    assert "its way to the road, or from it, breaks" in reasons[4]


@pytest.mark.shows(ROADS, "EgressRouteRequest", "EgressRouteResponse", "ServiceStatus")
def test_roads_that_cross_a_circle_are_told(tmp_path: Path) -> None:
    rig = driven(tmp_path, ROADS)
    asked = lmcp.new("EgressRouteRequest", RequestID=4, StartLocation=at(*MIDDLE), Radius=100.0)
    wrong = asked.copy(Radius=0.5), asked.copy(Radius=-100.0), asked.copy(Radius=math.nan)
    rig.tell(asked, *wrong, asked.copy(StartLocation=at(95.0, 0.0)))
    found, *none = rig.got("EgressRouteResponse")
    assert found.ResponseID == 4
    assert [round(h) % 360 for h in found.Headings] == [0, 90, 180, 270]
    assert [len(one.NodeLocations) for one in (found, *none)] == [4, 0, 0, 0, 0]
    *radius, place = rig.reasons("Warning")
    assert all("Radius: out of range" in text for text in radius)
    assert len(radius) == 3
    assert "not a place" in place


def test_more_crossings_than_a_message_has_room_for_are_not_told(tmp_path: Path) -> None:
    nodes = {n: (0.01 * math.cos(n), 0.01 * math.sin(n)) for n in range(1, 34)}
    rig = driven(tmp_path, ROADS, roads=map_text({0: (0, 0), **nodes}, *([0, n] for n in nodes)))
    rig.tell(lmcp.new("EgressRouteRequest", StartLocation=at(0, 0), Radius=500.0))
    (answer,) = rig.got("EgressRouteResponse")
    assert answer.NodeLocations == []
    assert "at most 32 crossings" in rig.reasons("Warning")[0]


@pytest.mark.shows(ROADS, "RoadPointsRequest", "RoadPointsResponse")
def test_the_places_along_a_road_are_told(tmp_path: Path) -> None:
    rig = driven(tmp_path, ROADS)
    ends = ((MIDDLE[0] + 0.001, MIDDLE[1]), (MIDDLE[0], MIDDLE[1] + 0.001))
    asked = [
        lmcp.new("RoadPointsConstraints", RoadPointsID=n, StartLocation=at(*ends[0]), EndLocation=at(*b))
        for n, b in ((5, ends[1]), (6, (0.0, 0.0)))
    ]  # fmt: skip
    rig.tell(lmcp.new("RoadPointsRequest", RequestID=8, RoadPointsRequests=asked))
    (answer,) = rig.got("RoadPointsResponse")
    assert answer.ResponseID == 8
    (line,) = answer.RoadPointsResponses
    assert line.LineID == 5
    told = [x for p in line.Line for x in (p.Latitude, p.Longitude)]
    assert told == pytest.approx([x for p in (ends[0], MIDDLE, ends[1]) for x in p], abs=1e-7)
    assert "RoadPointsConstraints 6: no road is within 1000 m" in rig.reasons("Warning")[0]


def test_a_map_that_is_missing_is_said_and_one_that_is_none_is_refused(tmp_path: Path) -> None:
    for name, said in (("", "it names no map"), ("x" * 5000, "xxx is missing: no road is known")):
        rig = Rig(tmp_path, ROADS, OsmPlannerService=f'OsmFile="{name}"')
        assert rig.said.has(said)
    rig = Rig(tmp_path, ROADS, OsmPlannerService='OsmFile="nowhere.osm"')
    assert rig.said.has("its map nowhere.osm is missing: no road is known")
    rig.tell(*car(1, *MIDDLE))
    (plan,) = planned(rig, (MIDDLE, MIDDLE))
    assert plan.RouteCost == -1
    assert "its map nowhere.osm is missing" in plan.RouteError[0].Value
    path = write_cfg(tmp_path, f'<Service Type="{ROADS}" OsmFile="nowhere.osm"/>')
    with pytest.raises(BadInput, match=r"OsmFile: its map nowhere.osm is missing"):
        Process(read(path, strict=True), Logs("DEBUG", echo=str), virtual=True)
    with pytest.raises(BadInput, match="not a map"):
        driven(tmp_path, ROADS, roads="<gpx/>")


@pytest.mark.shows(ROADS, "MapEdgesFile", "ShortestPathFile", "MetricsFile")
def test_roads_and_ways_are_written_down(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = 'MapEdgesFile="edges.csv" ShortestPathFile="way.csv" MetricsFile="metrics.csv"'
    osm_file = f'OsmFile="{EXAMPLE / "roads.osm"}"'
    path = write_cfg(tmp_path, f'<Service Type="{ROADS}" {osm_file} {names}/>')
    data = tmp_path / "data"
    one = Process(read(path), Logs("DEBUG", echo=str), data=data, virtual=True)
    corner = (MIDDLE[0] + 0.006, MIDDLE[1] + 0.0055)
    points = lmcp.new(
        "RoadPointsConstraints", RoadPointsID=7, StartLocation=at(*MIDDLE), EndLocation=at(*corner)
    )
    for body in (
        *car(1, *MIDDLE),
        routes((MIDDLE, corner), IsCostOnlyRequest=False),
        lmcp.new("RoadPointsRequest", RequestID=2, RoadPointsRequests=[points]),
    ):
        one.bus.publish(body, "test")
    one.bus.run()
    folder = data / ROADS
    tables = {
        p.name: [row.split(",") for row in p.read_text().splitlines()] for p in folder.iterdir()
    }
    assert set(tables) == {"edges.csv", "metrics.csv", "way_0001.csv", "way_0002.csv"}
    assert len(tables["edges.csv"]) == 1 + 2 * 7 * 6
    way, (head, driven_way, _) = tables["way_0001.csv"], tables["metrics.csv"]
    length = sum(float(row[4]) for row in way[1:])
    assert dict(zip(head, driven_way, strict=True))["way_length_m"] == f"{length:.1f}"
    assert driven_way[:2] == ["49", "84"]
    assert [float(x) for x in way[1][:2]] == pytest.approx(MIDDLE)
    assert [float(x) for x in way[-1][2:4]] == pytest.approx(corner)
    monkeypatch.setattr(files, "FILES_MOST", 2)
    monkeypatch.setattr(files, "ROWS_MOST", 2)
    one.bus.publish(routes((MIDDLE, corner)), "test")
    one.bus.run()
    assert len(list(folder.iterdir())) == 4
    for text in ("../edges.csv", "/edges.csv", "a\\b"):
        path = write_cfg(tmp_path, f'<Service Type="{ROADS}" {osm_file} MetricsFile="{text}"/>')
        with pytest.raises(BadInput, match=r"MetricsFile: a file elsewhere"):
            Process(read(path), Logs("DEBUG", echo=str), data=data, virtual=True)
    path = write_cfg(tmp_path, f'<Service Type="{ROADS}" {osm_file} MetricsFile="m"/>')
    with pytest.raises(BadInput, match="no folder to write to"):
        Process(read(path), Logs("DEBUG", echo=str), virtual=True)
