"""Terrain in the simulator: tiles that are read and refused, heights, footprints, flights into it, drives over it."""

from __future__ import annotations

import math
import os
import random
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest
from driving_tools import mission, vehicle
from simulator_tools import CAMERA, DIRECTOR, DOWN, ordered, scenario
from terrain_tools import dted, srtm

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.simulator import terrain as terrain_module
from cratous.services.simulator.earth import EQUATOR_M
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.sight import in_sight, meets
from cratous.services.simulator.terrain import Terrain
from cratous.services.simulator.world import Event, World
from cratous.spec.errors import BadInput


def slope(lat: float, lon: float) -> int:
    """Rises to the north and falls to the east; below the sea in the south-east."""
    return round(1200 * (lat - 45) - 240 * (lon + 120))


def height(terrain: Terrain, lat: float, lon: float) -> float:
    return terrain.elevation(math.radians(lat), math.radians(lon))


@pytest.fixture(scope="module")
def north(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tile about 45.5 N, 119.5 W that slopes, in a folder."""
    folder = tmp_path_factory.mktemp("dted")
    (folder / "w120").mkdir()
    dted(folder / "w120", 45, -120, slope)
    return folder


def test_heights_are_those_between_the_posts(north: Path, tmp_path: Path) -> None:
    grid = np.add.outer(np.arange(1201) * 2, np.arange(1201)).astype(int)
    srtm(tmp_path, "S01w001.hgt", grid)
    terrain = Terrain([north, tmp_path / "S01w001.hgt"])
    assert len(terrain) == 2
    assert terrain.step_m == pytest.approx(EQUATOR_M * math.radians(1) / 2400)
    assert height(terrain, 45.25, -119.75) == pytest.approx(300 - 60)
    assert height(terrain, 45.0, -119.5) == pytest.approx(-120), "sign and magnitude"
    assert height(terrain, -0.75 + 0.3 / 1200, -0.5 + 0.6 / 1200) == pytest.approx(600 + 600 + 1.2)
    chosen = random.Random(7)
    places = [(chosen.uniform(-1, 0.2), chosen.uniform(-1, 0.2)) for _ in range(300)]
    lats, lons = (np.radians(np.array(side)) for side in zip(*places, strict=True))
    each = [terrain.elevation(*p) for p in zip(lats, lons, strict=True)]
    assert terrain.elevations(lats, lons) == pytest.approx(each, abs=1e-9)
    assert 20 < each.count(0.0) < 200
    for lat, lon in ((46.0, -119.5), (45.5, -119.0), (46.0, -120.0)):
        assert height(terrain, lat, lon) == pytest.approx(slope(lat, lon)), "on an edge"
    said = [text for text in terrain.said if "no tile" in text]
    assert len(said) == 1, "what lies outside is said once"


def test_a_void_is_left_out_and_said_and_a_place_without_a_post_is_at_the_sea(
    tmp_path: Path,
) -> None:
    def holed(lat: float, lon: float) -> int:
        if lat > 10.5:
            return -32767
        return -32767 if (lat, lon) == (10.25, 20.25) else 100

    terrain = Terrain([dted(tmp_path, 10, 20, holed)])
    assert height(terrain, 10.2501, 20.2501) == pytest.approx(100)
    assert height(terrain, 10.8, 20.8) == 0
    lats, lons = np.radians([10.2501, 10.8]), np.radians([20.2501, 20.8])
    assert terrain.elevations(lats, lons) == pytest.approx([100, 0])
    (voids, empty) = terrain.said
    assert f"{60 * 121 + 1} of {121 * 121} posts are void" in voids
    assert "all posts about 10.80000, 20.80000 are void" in empty


def test_of_two_tiles_the_finer_one_counts_and_few_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terrain_module, "KEPT", 2)
    paths = [dted(tmp_path, k, 5, lambda lat, _: int(lat) * 10) for k in range(1, 5)]
    fine = srtm(tmp_path, "N02E005.hgt", np.full((1201, 1201), 77))
    terrain = Terrain([*paths, fine])
    for lat, wanted in ((1.5, 10), (2.5, 77), (3.5, 30), (4.5, 40), (1.5, 10)):
        assert height(terrain, lat, 5.5) == wanted
        assert len(terrain._kept) <= 2


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda data: data[:-7], "wrong size, or cut"),
        (lambda data: b"", "no such header"),
        (lambda data: data.replace(b"UHL1", b"UHL2", 1), "no such header"),
        (lambda data: data.replace(b"1200000W", b"2000000W", 1), "not on the earth"),
        (lambda data: data.replace(b"03000300", b"03000200", 1), "wrong posts of latitude"),
        (lambda data: data[:9000] + b"\x55" + data[9001:], r"record 21 of 121"),
        (lambda data: data[: 3428 + 254 * 3] + data[3428 : 3428 + 254] + data[3428 + 254 * 4 :],
         r"record 3 of 121"),
    ],
)  # fmt: skip
def test_a_corrupt_tile_is_refused_by_its_place(
    north: Path, tmp_path: Path, change: Any, text: str
) -> None:
    bad = tmp_path / "n45.dt0"
    bad.write_bytes(change((north / "w120/n45.dt0").read_bytes()))
    with pytest.raises(BadInput, match=text) as error:
        height(Terrain([bad]), 45.5, -119.5)
    assert "n45.dt0" in str(error.value)


@pytest.mark.parametrize(
    ("name", "size", "text"),
    [
        ("N45W121.hgt", 1000, "wrong size, or cut"),
        ("mountain.hgt", 2 * 1201**2, "not the name of an SRTM tile"),
        ("N95W121.hgt", 2 * 1201**2, "not on the earth"),
        ("a.tif", 10, "not a tile of terrain"),
        ("none/", 0, "a folder without tiles"),
        ("gone.dt1", None, "cannot read"),
    ],
)
def test_what_is_no_tile_is_refused(
    tmp_path: Path, name: str, size: int | None, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    if name.endswith("/"):
        path.mkdir()
    elif size is not None:
        with path.open("wb") as file:
            file.truncate(size)
    (tmp_path / "s.xml").write_text(scenario())
    assert main(["sim", str(tmp_path / "s.xml"), "--terrain", str(path)]) == 2
    assert text in capsys.readouterr().err


def test_a_pipe_and_a_folder_that_cannot_be_listed_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pipe = tmp_path / "N45W121.hgt"
    os.mkfifo(pipe)
    handle = os.open(pipe, os.O_RDWR)  # so that nothing waits
    os.write(handle, b" " * 80)
    with pytest.raises(BadInput, match="not a file"):
        Terrain([pipe])
    os.close(handle)

    def locked(folder: Path) -> NoReturn:
        raise PermissionError(13, "Permission denied", str(folder))

    monkeypatch.setattr(os, "scandir", locked)
    with pytest.raises(BadInput, match=r"cannot read.*Permission denied"):
        Terrain([tmp_path])


def test_a_height_that_no_place_has_and_a_tile_that_changes_are_refused(tmp_path: Path) -> None:
    grid = np.zeros((1201, 1201), int)
    grid[2, 3] = 9500
    path = srtm(tmp_path, "N45W121.hgt", grid)
    terrain = Terrain([path])
    with pytest.raises(BadInput, match=r"post 2 from the south, 3 from the west.*9500"):
        height(terrain, 45.5, -120.5)
    path.write_bytes(b"")
    with pytest.raises(BadInput, match="wrong size"):
        height(terrain, 45.5, -120.5)


def over(lat: float, lon: float, alt_m: float) -> Motion:
    return Motion(math.radians(lat), math.radians(lon), alt_m, *[0.0] * 9)


def test_a_ray_meets_the_first_ridge_and_what_lies_behind_it_is_hidden(tmp_path: Path) -> None:
    """A wall of 500 m along 45.5 N, 5 km wide, with a plain of 100 m about it."""
    wall = dted(tmp_path, 45, 7, lambda lat, _: 500 if abs(lat - 45.5) < 0.02 else 100)
    terrain, m = Terrain([wall]), over(45.3, 7.5, 450.0)
    lat, lon, alt = meets(terrain, m, (1.0, 0.0, 0.001))
    assert (lon, alt) == pytest.approx((m.lon_rad, 450 - (lat - m.lat_rad) * EQUATOR_M / 1000))
    assert 45.4833 - 1 / 120 < math.degrees(lat) < 45.4834, "on the slope of its first post"
    plain = meets(terrain, m, (0.1, 0.1, 0.1))
    assert plain[2] == pytest.approx(100)
    assert (plain[0] - m.lat_rad) * EQUATOR_M == pytest.approx(350, abs=0.1)
    assert meets(terrain, m, (0.0, 0.0, 1.0)) == (m.lat_rad, m.lon_rad, pytest.approx(100))
    far = meets(terrain, m, (1.0, 0.0, -0.2))
    horizon = math.sqrt(2 * EQUATOR_M * 450 + 450**2)
    assert (far[0] - m.lat_rad) * EQUATOR_M == pytest.approx(horizon, rel=1e-6), "over the wall"
    for lat_deg, alt_m, seen in ((45.4, 100, True), (45.6, 100, False), (45.6, 700, True),
                                 (45.3001, 100, True)):  # fmt: skip
        place = math.radians(lat_deg), m.lon_rad, float(alt_m)
        assert in_sight(terrain, m, place) is seen
        assert in_sight(terrain, over(lat_deg, 7.5, alt_m), (m.lat_rad, m.lon_rad, 450.0)) is seen


def flown(text: str, seconds: float, terrain: Terrain | None) -> tuple[World, list[Any]]:
    """A world, and the states of its aircraft, which begins in the middle of the degree."""
    plan = of_text(text.replace("<Longitude>-120<", "<Longitude>-119.5<"), "test")
    world = World(plan.events, plan.duration_s, terrain=terrain)
    told = []
    while world.time_s < seconds:
        told += [b for b in world.tick() if type(b).__name__ == "AirVehicleState" and b.Time > 0]
    return world, told


def test_a_footprint_lies_on_the_terrain(north: Path, tmp_path: Path) -> None:
    text = scenario(ordered(1, DOWN), payloads=CAMERA)
    flat = Terrain([dted(tmp_path, 45, -120, lambda *_: 0)])
    (_, sea), (_, on_zero), (world, on_slope) = (
        flown(text, 20, terrain) for terrain in (None, flat, Terrain([north]))
    )
    for one, two in zip(sea, on_zero, strict=True):
        ours, theirs = one.PayloadStateList[1], two.PayloadStateList[1]
        for a, b in zip(ours.Footprint, theirs.Footprint, strict=True):
            assert (a.Latitude, a.Longitude) == pytest.approx((b.Latitude, b.Longitude), abs=2e-7)
    last = on_slope[-1].PayloadStateList[1]
    for place in (*last.Footprint, last.Centerpoint):
        wanted = height(world.terrain, place.Latitude, place.Longitude)  # type: ignore[arg-type]
        assert place.Altitude == pytest.approx(wanted, abs=0.01)
    high = last.Footprint[0].Latitude - last.Footprint[3].Latitude
    plain = on_zero[-1].PayloadStateList[1].Footprint
    assert high > plain[0].Latitude - plain[3].Latitude + 1e-4, "the ground is farther below"


def test_an_aircraft_that_meets_the_terrain_stands_and_it_is_said_once(north: Path) -> None:
    text = scenario().replace("<Latitude>45<", "<Latitude>45.425<")
    world, told = flown(text, 60, Terrain([north]))
    said = world.warnings()
    assert len(said) == 1
    assert "vehicle 1 has met the terrain at 45.43" in said[0]
    assert told[-1].Groundspeed == 0
    assert told[-1].Location == told[-20].Location
    assert told[-1].Location.Latitude == pytest.approx(45.4333, abs=1e-4), "where it is 400 m high"
    assert flown(text, 60, None)[1][-1].Groundspeed > 20
    assert world.warnings() == []


def test_what_drives_goes_up_and_down_and_what_sails_does_not(tmp_path: Path) -> None:
    hill = Terrain([dted(tmp_path, 30, -87, lambda lat, _: round(8_000 * (lat - 30)))])
    for kind, rises in (("Ground", True), ("Surface", False)):
        bodies = [*vehicle(kind), mission((300.0, 0.0))]
        world = World([Event(0.0, body, "") for body in bodies], 60, terrain=hill)
        told = []
        while not world.over:
            told += [b for b in world.tick() if type(b).__name__ == f"{kind}VehicleState"]
        place = told[-1].Location
        wanted = height(hill, place.Latitude, place.Longitude) if rises else 0.0
        assert place.Altitude == pytest.approx(wanted, abs=0.01)
        assert (place.Altitude > 20) is rises


def test_a_state_over_a_corrupt_tile_is_refused_and_the_others_go_on(
    tmp_path: Path, north: Path
) -> None:
    """Also a client's own: the tile is read when the state is taken, not in the next step."""
    bad = dted(tmp_path, 30, -87, slope)
    bad.write_bytes(bad.read_bytes()[:-1] + b"\xff")
    world, _ = flown(scenario(), 2, Terrain([north, bad]))
    flies = lmcp.new("Location3D", Latitude=30.5, Longitude=-86.5, Altitude=900.0)
    before = world.aircraft[1].motion
    configuration, state = vehicle(ID=2)
    world.receive(configuration)
    for body in (lmcp.new("AirVehicleState", ID=1, Location=flies), state.copy(ID=2)):
        with pytest.raises(BadInput, match="record 120 of 121"):
            world.receive(body, "client")
    world.tick()
    assert world.aircraft[1].motion.lat_rad == pytest.approx(before.lat_rad, abs=1e-6)
    assert 2 not in world.drivers.there


def test_the_command_takes_terrain_and_warns(
    tmp_path: Path, north: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "s.xml").write_text(scenario(ordered(5, DIRECTOR)))
    tile = north / "w120/n45.dt0"
    both = ["--terrain", str(tile), "--terrain", str(north)]
    assert main(["sim", str(tmp_path / "s.xml"), "--until", "20", *both]) == 0
    assert capsys.readouterr().err == ""
    only = dted(tmp_path, 46, -120, slope)
    arguments = ["sim", str(tmp_path / "s.xml"), "--until", "20", "--terrain", str(only)]
    assert main(arguments) == 0
    assert capsys.readouterr().err.count("WARN: the terrain has no tile for 45.00") == 1
    bad = tmp_path / "bad.dt0"
    bad.write_bytes(tile.read_bytes()[:-1] + b"\xff")
    out = tmp_path / "told.bin"
    arguments = ["sim", str(tmp_path / "s.xml"), "--terrain", str(bad), "-o", str(out)]
    assert main(arguments) == 2
    assert "bad.dt0: record 120 of 121" in capsys.readouterr().err
    assert not out.exists(), "nothing half told"
