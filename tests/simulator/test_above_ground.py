"""Altitudes above ground in the simulator: each above the terrain at its own place."""

from __future__ import annotations

import math
from typing import Any

import pytest
from simulator_tools import CAMERA, DIRECTOR, LOITER, STARE, mission, ordered, scenario, waypoint
from terrain_tools import dted

from cratous.bridge import lmcp
from cratous.services.simulator.above_ground import above_sea
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.terrain import Terrain
from cratous.services.simulator.world import World

AGL = "<AltitudeType>AGL</AltitudeType></"


def slope(lat: float, lon: float) -> int:
    """Rises to the north: by 12 m in a hundredth of a degree, from 300 m on."""
    return round(300 + 1200 * (lat - 45))


@pytest.fixture(scope="module")
def hill(tmp_path_factory: pytest.TempPathFactory) -> Terrain:
    return Terrain([dted(tmp_path_factory.mktemp("dted"), 45, -120, slope)])


def above(text: str, *ends: str) -> str:
    """With the altitudes before these ends of elements above ground."""
    for end in ends:
        assert f"</Altitude></{end}>" in text
        text = text.replace(f"</Altitude></{end}>", f"</Altitude>{AGL}{end}>")
    return text.replace("<Longitude>-120<", "<Longitude>-119.5<")


def told(text: str, seconds: float, terrain: Terrain | None, compatible: bool = False) -> list[Any]:
    plan = of_text(text, "test")
    world = World(plan.events, plan.duration_s, terrain=terrain, compatible=compatible)
    found = []
    while world.time_s < seconds:
        found += [b for b in world.tick() if type(b).__name__ == "AirVehicleState" and b.Time > 0]
    return found


def test_a_state_is_above_the_ground_where_it_puts_the_vehicle(hill: Terrain) -> None:
    text = above(scenario(), "Location3D")
    first = told(text, 2, hill)[0].Location
    assert first.Altitude == pytest.approx(700, abs=0.01)
    assert first.AltitudeType.name == "MSL"  # what is told is so as ever
    assert told(text, 2, None)[0].Location.Altitude == 400
    assert told(text, 2, hill, compatible=True)[0].Location.Altitude == 400


def test_a_waypoint_is_above_the_ground_at_its_place(hill: Terrain) -> None:
    route = mission(waypoint(1, 2, 45.02), waypoint(2, 2, 45.06))
    states = told(above(scenario(route), "Location3D", "Waypoint"), 320, hill)
    for lat in (45.02, 45.06):
        near = min((one.Location for one in states), key=lambda at: abs(at.Latitude - lat))
        assert near.Altitude == pytest.approx(400 + slope(lat, -119.5), abs=2)


def test_a_loiter_and_a_flight_director_are_above_the_ground(hill: Terrain) -> None:
    loiter = ordered(1, LOITER.format("Circular", 0))
    last = told(above(scenario(loiter), "Location3D"), 240, hill)[-1].Location
    assert last.Altitude == pytest.approx(400 + slope(45.02, -119.5), abs=0.5)
    director = DIRECTOR.replace("</Altitude>", "</Altitude><AltitudeType>AGL</AltitudeType>")
    text = above(scenario(ordered(1, director)), "Location3D")
    # it flies east, along the contour on which it was told so
    assert told(text, 120, hill)[-1].Location.Altitude == pytest.approx(900, abs=1)


def test_a_point_of_a_stare_is_on_the_ground(hill: Terrain) -> None:
    look = STARE.replace("-119.995", "-119.495")
    sea = scenario(ordered(1, look), payloads=CAMERA)
    ground = sea.replace(
        "</Longitude></Location3D>\n</Starepoint>",
        "</Longitude><Altitude>0</Altitude><AltitudeType>AGL</AltitudeType></Location3D></Starepoint>",
    )
    assert ground != sea
    seen = [
        told(above(text, "Location3D"), 20, hill)[-1].PayloadStateList[1].Centerpoint
        for text in (sea, ground)
    ]
    wanted = (45.01, -119.495, slope(45.01, -119.495))
    assert (seen[1].Latitude, seen[1].Longitude) == pytest.approx(wanted[:2], abs=2e-5)
    assert seen[1].Altitude == pytest.approx(wanted[2], abs=0.5)
    # through the point at the height of the sea the picture's middle lies before the place
    assert math.dist((seen[0].Latitude, seen[0].Longitude), wanted[:2]) > 1e-3


def test_what_is_above_the_sea_stays_as_it_is(hill: Terrain) -> None:
    state = lmcp.new(
        "AirVehicleState", Location=lmcp.new("Location3D", Latitude=45.5, Altitude=7.0)
    )
    assert above_sea(state, hill, (0.0, 0.0)) is state
    keeps = lmcp.new("FlightDirectorAction", Altitude=0.0, AltitudeType="AGL")
    assert above_sea(keeps, hill, (math.radians(45.5), math.radians(-119.5))) is keeps
    nowhere = lmcp.new("Location3D", Latitude=math.nan, Altitude=7.0, AltitudeType="AGL")
    assert above_sea(nowhere, hill, (0.0, 0.0)).Altitude == pytest.approx(7.0)
