"""Missions in the formats of AMASE and UxAS: what comes back, what is not said, and what stays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from cratous.services.exporting.exported import AMASE, FORMATS, UXAS, exported
from cratous.services.loading import count_requests, load
from cratous.services.mission.frames import Projection
from cratous.services.simulator.scenario import read as read_scenario
from cratous.services.simulator.world import World
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    Mission,
    Pattern,
    Position,
    TaskKind,
    Traffic,
    Velocity,
    Zone,
    ZoneKind,
)

NEVER = {AMASE: {"relations"}, UXAS: {"simulation.limit_ms"}}
"""What these formats cannot say of any of the examples."""

HIGH = Traffic(91, Position(9000.0, 0.0, 400.0), Velocity(-30.0, 40.0, 0.0))


def example(root: Path, name: str) -> Mission:
    return load(root / f"examples/{name}/mission.yaml")


def again(mission: Mission, form: str, folder: Path) -> Mission:
    """The mission after it was written and read."""
    place = folder / mission.name
    place.mkdir()
    files = exported(mission, form).files
    for name, text in files.items():
        (place / name).write_text(text, encoding="utf-8")
    return load(place if form == UXAS else place / f"{mission.name}.xml")


def items(texts: tuple[str, ...]) -> set[str]:
    return {text.partition(":")[0] for text in texts}


@pytest.mark.parametrize("form", [AMASE, UXAS])
@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("crossing", {}),
        ("relations", {UXAS: {"traffic"}}),
        ("popup", {form: {"changes", "tasks[0].views"} for form in (AMASE, UXAS)}),
        ("partial", {form: {"changes"} for form in (AMASE, UXAS)}),
    ],
)
def test_a_mission_comes_back(
    root: Path, tmp_path: Path, name: str, more: dict[str, set[str]], form: str
) -> None:
    mission = example(root, name)
    unsaid = items(exported(mission, form).unsaid)
    assert unsaid == NEVER[form] | more.get(form, set())
    read = again(mission, form, tmp_path)
    assert (read.name, read.instances) == (mission.name, mission.instances)
    assert [(t.id, t.kind, t.eligible, t.duration_ms) for t in read.tasks] == [
        (t.id, t.kind, t.eligible, t.duration_ms) for t in mission.tasks
    ]
    assert read.relations == (mission.relations if form == UXAS else "")
    # on the earth, as the frame of what is read is another one
    here, there = Projection(mission.frame), Projection(read.frame)

    def near(a: Position, b: Position) -> None:
        places = here.to_geodetic(a.north_m, a.east_m), there.to_geodetic(b.north_m, b.east_m)
        assert here.geodesic_m(*places) < 1e-3
        assert a.alt_m == pytest.approx(b.alt_m, abs=1e-3)

    for vehicle, other in zip(mission.vehicles, read.vehicles, strict=True):
        near(vehicle.position, other.position)
        assert other.heading_rad == pytest.approx(vehicle.heading_rad, abs=1e-6)
    for task, other_task in zip(mission.tasks, read.tasks, strict=True):
        for point, other_point in zip(task.points, other_task.points, strict=True):
            near(point, other_point)
    for zone, other_zone in zip(mission.zones, read.zones, strict=True):
        assert (zone.id, zone.kind) == (other_zone.id, other_zone.kind)
        for corner, other_corner in zip(zone.vertices, other_zone.vertices, strict=True):
            near(Position(*corner, 0.0), Position(*other_corner, 0.0))


def test_traffic_of_a_scenario_is_traffic_again(root: Path, tmp_path: Path) -> None:
    """AMASE makes no difference between aircraft: who is not commanded is told beside."""
    gone = Traffic(91, Position(9000.0, 0.0, 400.0), Velocity(-30.0, 40.0, 0.0), 2000, 9000)
    climbs = Traffic(92, Position(9500.0, 0.0, 400.0), Velocity(-30.0, 40.0, -2.0))
    mission = replace(example(root, "crossing"), traffic=(gone, climbs))
    made = exported(mission, AMASE)
    assert items(made.unsaid) == {"relations", "traffic[1].velocity.down_m_s"}
    read = again(mission, AMASE, tmp_path)
    assert [(t.id, t.appears_ms, t.vanishes_ms) for t in read.traffic] == [
        (91, 2000, 9000), (92, 0, None),
    ]  # fmt: skip
    assert read.traffic[0].velocity == pytest.approx(gone.velocity, abs=1e-3)
    assert [v.id for v in read.vehicles] == [1, 2]
    assert read.simulation.limit_ms == mission.simulation.limit_ms


@pytest.mark.parametrize("got", ["none", "another one"])
def test_traffic_of_a_scenario_has_one_state(root: Path, tmp_path: Path, got: str) -> None:
    mission = replace(example(root, "crossing"), traffic=(HIGH,))
    text = exported(mission, AMASE).files["crossing.xml"]
    begin, end = text.rindex("<AirVehicleState "), text.rindex("</AirVehicleState>\n") + 19
    state = text[begin:end]
    assert "<ID>91</ID>" in state
    path = tmp_path / "s.xml"
    path.write_text(text.replace(state, "" if got == "none" else 2 * state), encoding="utf-8")
    with pytest.raises(BadInput) as found:
        load(path)
    assert (found.value.item, found.value.got) == ("AirVehicleState of 91", got)


def test_traffic_of_a_scenario_vanishes_in_the_order_of_time(root: Path, tmp_path: Path) -> None:
    mission = replace(example(root, "crossing"), traffic=(replace(HIGH, vanishes_ms=9000),))
    text = exported(mission, AMASE).files["crossing.xml"]
    begin, end = text.index("<RemoveEntities "), text.index("</RemoveEntities>\n") + 18
    gone, first = text[begin:end], "<ScenarioEventList>\n"
    path = tmp_path / "s.xml"
    path.write_text(text.replace(gone, "").replace(first, first + gone), encoding="utf-8")
    assert load(path).traffic[0].vanishes_ms == 9000


def test_the_simulator_plays_the_scenario(root: Path, tmp_path: Path) -> None:
    path = tmp_path / "s.xml"
    path.write_text(next(iter(exported(example(root, "relations"), AMASE).files.values())))
    scenario = read_scenario(path)
    assert scenario.notes == []
    World(scenario.events, scenario.duration_s)
    assert {type(e.body).__name__ for e in scenario.events} >= {"AirVehicleState", "KeepOutZone"}


def test_what_a_format_has_no_word_for_is_told_or_refused(root: Path) -> None:
    mission = example(root, "crossing")
    vehicle = replace(mission.vehicles[0], protected=False)
    bare = replace(mission, vehicles=(vehicle, mission.vehicles[1]), instances=(2,))
    for form in (AMASE, UXAS):
        unsaid = {item.partition("[0]")[0] for item in items(exported(bare, form).unsaid)}
        assert unsaid == {"instances", "vehicles"} | {n.partition("[0]")[0] for n in NEVER[form]}
    square = replace(mission.tasks[0], kind=TaskKind.PATTERN_SEARCH, pattern=Pattern.SQUARE)
    with pytest.raises(BadInput, match="pattern square") as caught:
        exported(replace(mission, tasks=(square, mission.tasks[1])), UXAS)
    assert caught.value.where == mission.source
    spiral = replace(square, pattern=Pattern.SPIRAL, extent_m=200.0, points=square.points[:1])
    asked = replace(mission, tasks=(replace(spiral, view=None), mission.tasks[1]))
    assert items(exported(asked, UXAS).unsaid) == NEVER[UXAS]


def test_names_with_markup_come_back(root: Path, tmp_path: Path) -> None:
    mission = example(root, "crossing")
    label = """<&"'> é"""
    zone = Zone(9, ZoneKind.KEEP_OUT, ((5e3, 0.0), (5e3, 9.0), (5009.0, 0.0)), 0.0, 900.0, 0, label)
    vehicles = (replace(mission.vehicles[0], label=label), mission.vehicles[1])
    mission = replace(mission, zones=(zone,), vehicles=vehicles)
    for form in (AMASE, UXAS):
        (tmp_path / form).mkdir()
        read = again(mission, form, tmp_path / form)
        assert (read.vehicles[0].label, read.zones[0].label) == (label, label)


def test_a_scenario_with_a_request_is_that_request(root: Path, tmp_path: Path) -> None:
    text = next(iter(exported(example(root, "crossing"), AMASE).files.values()))
    request = (
        '<AutomationRequest Series="CMASI" Time="1.0"><EntityList><int64>1</int64></EntityList>'
        "<TaskList><int64>1</int64></TaskList></AutomationRequest>"
    )
    path = tmp_path / "s.xml"
    path.write_text(text.replace("</ScenarioEventList>", request + "</ScenarioEventList>"))
    read = load(path)
    assert ([v.id for v in read.vehicles], [t.id for t in read.tasks]) == ([1], [1])
    assert any("later than 0 s" in note and "AutomationRequest" in note for note in read.notes)
    assert count_requests(path) == 1
    with pytest.raises(BadInput, match="no such request"):
        load(path, 0, 2)
    with pytest.raises(BadInput, match="no variants"):
        load(path, 1)


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("<ScenarioDuration>7200.000", "<ScenarioDuration>0.0001", "not a duration"),
        ("<ScenarioDuration>7200.000", "<ScenarioDuration>1e300", "not a duration"),
        ("</AMASE>", "", "XML"),
        ("<Latitude>", "<Latitude>1", "not a place"),
    ],
)
def test_bad_scenarios_are_refused(
    root: Path, tmp_path: Path, old: str, new: str, what: str
) -> None:
    text = next(iter(exported(example(root, "crossing"), AMASE).files.values()))
    assert old in text
    path = tmp_path / "s.xml"
    path.write_text(text.replace(old, new))
    with pytest.raises(BadInput, match=what) as caught:
        load(path)
    assert str(path) in caught.value.where


# the command ------------------------------------------------------------------------------------

Run = Callable[..., tuple[int, str, str]]


@pytest.mark.parametrize("form", FORMATS)
def test_strict_writes_nothing(root: Path, tmp_path: Path, run: Run, form: str) -> None:
    crossing, out = root / "examples/crossing/mission.yaml", tmp_path / "crossing"
    words = ("export", crossing, "--format", form, "-o", out)
    code, said, told = run(*words, "--strict")
    assert (code, said) == (2, "")
    assert "variation" in told
    assert list(tmp_path.iterdir()) == []
    code, said, told = run(*words)
    assert (code, said) == (0, "")
    assert all(line.startswith(f"not said in {form}: ") for line in told.splitlines())
    assert "variation: a section of the mission file" in told
    assert [path.name for path in tmp_path.iterdir()] == ["crossing"]
    if form == UXAS:
        assert {path.name for path in out.iterdir()} == {"cfg.xml", "messages.xml"}
        # with the wrong name the mission would be another one, and that is told
        other = run(*words[:-1], tmp_path / "other")
        assert "not said in uxas: name: crossing; read again it would be other" in other[2]
    else:
        assert run(*words[:-2])[1] == out.read_text(encoding="utf-8")


def test_strict_writes_what_is_said_whole(root: Path, tmp_path: Path, run: Run) -> None:
    mission = tmp_path / "mission.yaml"
    text = (root / "examples/crossing/mission.yaml").read_text(encoding="utf-8")
    mission.write_text(text.partition("variation:")[0].partition("expect:")[0]
                       .replace('relations: "|(p1 p2)"', ""))  # fmt: skip
    assert run("export", mission, "--format", "amase", "--strict", "-o", tmp_path / "s.xml") == (
        0, "", "",
    )  # fmt: skip
    assert run("check", tmp_path / "s.xml")[0] == 0


def test_what_is_there_stays(root: Path, tmp_path: Path, run: Run) -> None:
    crossing = root / "examples/crossing/mission.yaml"
    words = ("export", crossing, "--format", "uxas", "-o")
    kept = tmp_path / "kept"
    kept.mkdir()
    assert run(*words, kept)[0] == 0, "an empty folder is taken"
    before = {path.name: path.read_bytes() for path in kept.iterdir()}
    (kept / "mine").write_text("mine")
    file = tmp_path / "file"
    file.write_text("file")
    for place in (kept, file):
        code, _, told = run(*words, place)
        assert (code, "something is there already" in told) == (2, True)
    assert {p.name: p.read_bytes() for p in kept.iterdir()} == {**before, "mine": b"mine"}
    assert file.read_text() == "file"
    assert run(*words, tmp_path / "no" / "folder")[0] == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "kept"]


def test_words_that_do_not_go_together(root: Path, tmp_path: Path, run: Run) -> None:
    crossing = root / "examples/crossing/mission.yaml"
    assert run("export", crossing, "--format", "uxas")[0] == 2
    assert run("export", crossing, "--format", "amase", "--plan")[0] == 2
    assert run("export", crossing)[0] == 2
    assert run("export", tmp_path / "none.yaml", "--format", "kml")[0] == 2
