"""The judge on tasks: which are served, and which only said to be."""

from __future__ import annotations

import math
from pathlib import Path

from judge_tools import Scene, changed, task, vehicle, verdicts

NORTH = (20.0, 0.0, 0.0)


def one(folder: Path, scene: Scene, item: str) -> str:
    """The verdict on one item."""
    return verdicts(scene.judged(folder))[item]


# ---- G3 -----------------------------------------------------------------------------------------


def served(
    folder: Path, asked: dict, start: int = 2000, end: int | None = 8000, looks=(), **more
) -> str:
    scene = Scene(tasks=[asked], **more).straight(1, (0, 0, 300), NORTH).does(1, 1, start, end)
    for time_ms, corners in looks:
        see(scene, time_ms, corners)
    return one(folder, scene, "task 1 served")


def see(scene: Scene, time_ms: int, corners: list[tuple[float, float]], payload: int = 1) -> None:
    """A footprint (metres), said by vehicle 1 from where it is."""
    import pyproj

    frame = scene.mission["frame"]
    projection = pyproj.Proj(
        proj="aeqd", ellps="WGS84", lat_0=frame["latitude_deg"], lon_0=frame["longitude_deg"]
    )

    def place(north: float, east: float, alt: float = 0.0) -> dict[str, float]:
        lon, lat = projection(east, north, inverse=True)
        return {"Latitude": lat, "Longitude": lon, "Altitude": alt}

    camera = {
        "PayloadID": payload, "HorizontalFieldOfView": 45.0, "Centerpoint": place(*corners[0]),
        "Footprint": [place(*corner) for corner in corners],
    }  # fmt: skip
    scene.say(
        time_ms, "AirVehicleState", ID=1, Time=time_ms, Location=place(20.0 * time_ms / 1000, 0.0, 300.0),
        PayloadStateList=[camera],
    )  # fmt: skip


def box(n0: float, n1: float, e0: float = -50, e1: float = 50) -> list[tuple[float, float]]:
    return [(n0, e0), (n0, e1), (n1, e1), (n1, e0)]


def test_a_point_is_flown_through(tmp_path: Path) -> None:
    assert served(tmp_path, task(1, "must_fly", (100, 49.9))) == "holds"
    assert served(tmp_path, task(1, "must_fly", (100, 50.1))) == "violated"
    assert served(tmp_path, task(1, "must_fly", (100, 0)), 6500) == "holds"
    assert served(tmp_path, task(1, "must_fly", (100, 0)), 7600) == "violated"  # 52 m beyond it
    assert served(tmp_path, task(1, "must_fly", (100, 0)), end=None) == "violated"


def test_a_loiter_lasts(tmp_path: Path) -> None:
    asked = task(1, "loiter", (100, 0), radius_m=50.0, duration_ms=6000)
    assert served(tmp_path, asked) == "holds"
    assert served(tmp_path, asked | {"duration_ms": 6500}) == "unknown"  # less than a step lacks
    assert served(tmp_path, asked | {"duration_ms": 7100}) == "violated"
    assert served(tmp_path, task(1, "loiter", (100, 400), radius_m=50.0)) == "violated"
    shape = {"centre": {"north_m": 100.0, "east_m": 240.0}, "radius_m": 50.0, "length_m": 300.0}
    race = asked | {"loiter": shape | {"shape": "racetrack"}, "duration_ms": 1000}
    assert served(tmp_path, race) == "holds"
    assert served(tmp_path, race | {"loiter": shape | {"shape": "circular"}}) == "violated"


def test_lines_are_seen(tmp_path: Path) -> None:
    asked = task(1, "line_search", (0, 0), (1000, 0))
    first, last = (3000, box(-1, 500)), (5000, box(499, 1001))
    assert served(tmp_path, asked, looks=[first, last]) == "holds"
    assert served(tmp_path, asked, looks=[first]) == "violated"
    assert served(tmp_path, asked, looks=[first, (8500, last[1])]) == "violated"  # too late
    assert served(tmp_path, asked, looks=[first, (5000, box(502, 1001))]) == "holds"  # 2 m lack
    assert served(tmp_path, asked, looks=[first, (5000, box(510, 1001))]) == "unknown"  # 1 %
    assert served(tmp_path, asked, looks=[first, (5000, box(516, 1001))]) == "violated"
    assert served(tmp_path, asked | {"wavelength": "LWIR"}, looks=[first, last]) == "holds"
    blind = vehicle(1, cameras=[{"payload_id": 1, "wavelength": "EO", "pixels": 100}])
    infrared = asked | {"wavelength": "LWIR"}
    assert served(tmp_path, infrared, looks=[first, last], vehicles=[blind]) == "violated"
    coarse = asked | {"gsd_m": 0.5, "wavelength": "EO"}
    assert served(tmp_path, coarse, looks=[first, last], vehicles=[blind]) == "violated"
    assert (
        served(tmp_path, coarse | {"gsd_m": 9.0}, looks=[first, last], vehicles=[blind]) == "holds"
    )
    assert served(tmp_path, asked | {"gsd_m": 0.5}, looks=[first, last]) == "unknown"


def test_a_look_counts_where_the_view_asked_for_looks_and_not_near_the_horizon(
    tmp_path: Path,
) -> None:
    asked = task(1, "line_search", (0, 0), (1000, 0))
    down = {"azimuth_rad": 0.0, "elevation_rad": math.radians(-90)}
    ahead = down | {"elevation_rad": math.radians(-45)}
    # from 60 m north at 300 m; the second to the horizon, as a camera that looks ahead has it
    near, far = (3000, box(-1, 600, -150, 150)), (3000, box(-1, 57_000, -150, 150))
    second = (5000, box(499, 1001, -150, 150))
    assert served(tmp_path, asked, looks=[far]) == "violated"
    assert served(tmp_path, asked | {"view": down}, looks=[far]) == "violated"
    assert served(tmp_path, asked, looks=[near, second]) == "holds"
    assert served(tmp_path, asked | {"view": ahead}, looks=[near, second]) == "holds"
    # their middles lie about 30 and 60 degrees off straight down
    assert served(tmp_path, asked | {"view": down}, looks=[near, second]) == "violated"
    both = {"view": down, "views": [ahead]}
    assert served(tmp_path, asked | both, looks=[near, second]) == "holds"
    below = [(t, box(n - 130, n + 130)) for t, n in ((3000, 60), (5000, 100))]
    short = task(1, "line_search", (0, 0), (200, 0), view=down)
    assert served(tmp_path, short, looks=below) == "holds"


def test_areas_are_seen(tmp_path: Path) -> None:
    asked = task(1, "area_search", (0, 0), (0, 200), (200, 200), (200, 0))
    halves = [(3000, box(-1, 100, -1, 201)), (5000, box(99, 201, -1, 201))]
    assert served(tmp_path, asked, looks=halves) == "holds"
    assert served(tmp_path, asked, looks=halves[:1]) == "violated"
    disc = task(1, "pattern_search", (100, 100), pattern="spiral", extent_m=99.0)
    assert served(tmp_path, disc, looks=halves) == "holds"
    assert served(tmp_path, disc | {"extent_m": 130.0}, looks=halves) == "violated"
    assert (
        served(tmp_path, disc | {"pattern": "square", "extent_m": 100.0}, looks=halves) == "holds"
    )
    missing = [(3000, box(-1, 100, -1, 201)), (5000, box(103, 201, -1, 201))]
    assert served(tmp_path, asked, looks=missing) == "violated"


def test_points_are_seen_for_as_long_as_asked(tmp_path: Path) -> None:
    asked = task(1, "point_search", (100, 30))
    looks = [(ms, box(0, 200)) for ms in range(3000, 6500, 500)]
    assert served(tmp_path, asked, looks=looks[:1]) == "holds"
    assert served(tmp_path, asked, looks=[]) == "violated"
    assert served(tmp_path, asked, looks=[(3000, box(0, 200, 31, 50))]) == "violated"
    assert served(tmp_path, asked, looks=[(3000, box(0, 200, 30, 50))]) == "unknown"  # on its edge
    assert served(tmp_path, asked | {"duration_ms": 4000}, looks=looks) == "holds"
    assert served(tmp_path, asked | {"duration_ms": 4500}, looks=looks) == "violated"
    assert served(tmp_path, asked | {"duration_ms": 4000}, looks=looks[::2]) == "violated"
    assert served(tmp_path, asked | {"standoff_m": 29.0}, looks=looks) == "holds"
    assert served(tmp_path, asked | {"standoff_m": 31.0}, looks=looks) == "violated"


def test_who_says_to_be_elsewhere_is_not_believed(tmp_path: Path) -> None:
    scene = Scene(tasks=[task(1, "point_search", (100, 30))])
    scene.straight(1, (0, 5, 300), NORTH).does(1, 1, 2000, 8000)
    see(scene, 3000, box(0, 200))
    assert one(tmp_path, scene, "task 1 served") == "unknown"


def test_what_is_asked_for_and_not_done_is_a_row(tmp_path: Path) -> None:
    asked = [task(1, "must_fly", (100, 0)), task(2, "must_fly", (120, 0))]

    def rows(**more) -> dict[str, str]:
        scene = Scene(tasks=asked, **more).straight(1, (0, 0, 300), NORTH).does(1, 1, 4000, 6000)
        return {k: v for k, v in verdicts(scene.judged(tmp_path)).items() if "served" in k}

    undone = {"task 1 served": "holds", "task 2 served": "violated"}
    assert rows() == undone
    assert rows(relations="+(p1 p2)") == {"task 1 served": "holds"}
    assert rows(changes=[changed(500, "task_added", 2)]) == undone
    assert rows(changes=[changed(99_000, "task_added", 2)]) == undone
    assert rows(changes=[changed(500, "task_removed", 2)]) == {"task 1 served": "holds"}
    # done before it was removed: it stays; a removal after that changes nothing
    assert rows(changes=[changed(7000, "task_removed", 1)]) == undone
    assert rows(changes=[changed(5000, "task_removed", 1)]) == {"task 2 served": "violated"}
