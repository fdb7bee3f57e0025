"""UxAS configurations as they are: what becomes of them, and what is refused by name."""

from __future__ import annotations

import re
import shutil
from math import degrees
from pathlib import Path

import pytest

from cratous.services.loading import load
from cratous.spec.errors import BadInput
from cratous.spec.mission import LivePlanningMission, Mission, TaskKind, ZoneKind

SHARED = Path(__file__).resolve().parents[3] / "shared" / "examples" / "openuxas"
pytestmark = pytest.mark.skipif(
    not SHARED.is_dir(), reason="the OpenUxAS examples are not beside the repository"
)


@pytest.fixture(scope="module")
def waterway() -> Mission:
    return load(SHARED / "waterway")


def copied(tmp_path: Path, name: str) -> Path:
    folder = tmp_path / name
    shutil.copytree(SHARED / name, folder)
    for path in [folder, *folder.rglob("*")]:
        path.chmod(0o755)
    return folder


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def small_assign(tmp_path: Path) -> Path:
    """The second example without its area searches."""
    folder = copied(tmp_path, "assigntasks")
    request = folder / "inputs" / "AutomationRequest_All.xml"
    edit(request, "|(.(p1 +(p3 p5)) .(p2 p4 p6))", "|(.(p1 p3) .(p2 p4))")
    edit(request, "<int64>5</int64>", "")
    edit(request, "<int64>6</int64>", "")
    return folder


def changed(tmp_path: Path, file: str, old: str, new: str) -> Path:
    """The same with one file changed."""
    folder = small_assign(tmp_path)
    edit(folder / file, old, new)
    return folder


def test_waterway(waterway: Mission) -> None:
    assert waterway.name == "waterway"
    assert [vehicle.id for vehicle in waterway.vehicles] == [400, 500]
    assert waterway.instances == (400, 500)
    one = waterway.vehicles[0]
    assert (one.speed_m_s, one.position.alt_m) == (22.0, 700.0)
    assert degrees(one.heading_rad) == pytest.approx(90)
    assert degrees(one.max_bank_rad) == pytest.approx(20)
    assert degrees(one.cameras[0].hfov_rad) == pytest.approx(45)
    (task,) = waterway.tasks
    assert task.kind == TaskKind.LINE_SEARCH
    assert len(task.points) > 50
    assert task.view is not None
    assert degrees(task.view.azimuth_rad) == pytest.approx(35)
    assert degrees(task.view.elevation_rad) == pytest.approx(-60)
    assert waterway.cost == "MINMAX"


def test_the_priority_of_a_task_is_taken_over(tmp_path: Path, waterway: Mission) -> None:
    folder = copied(tmp_path, "waterway")
    (file,) = (folder / "inputs" / "tasks").glob("1000_*.xml")
    edit(file, "<Priority>0</Priority>", "<Priority>80</Priority>")
    assert (waterway.tasks[0].priority, load(folder).tasks[0].priority) == (0, 80)


def test_what_is_not_used_is_noted(waterway: Mission) -> None:
    notes = "\n".join(waterway.notes)
    for words in ("inputs/", "AutomationDiagramDataService", "<Bridge>", "well-clear", "terrain"):
        assert words in notes


def test_a_cfg_file_is_the_same_as_its_folder(waterway: Mission) -> None:
    again = load(SHARED / "waterway" / "cfg_run.xml")
    assert (again.vehicles, again.tasks) == (waterway.vehicles, waterway.tasks)


def test_area_searches_of_an_example_are_read() -> None:
    mission = load(SHARED / "assigntasks")
    areas = [task for task in mission.tasks if task.kind is TaskKind.AREA_SEARCH]
    assert [task.id for task in areas] == [5, 6]
    assert all(len(task.points) >= 3 for task in areas)


def test_a_task_type_that_is_not_covered(tmp_path: Path) -> None:
    folder = copied(tmp_path, "assigntasks")
    file = folder / "inputs" / "AreaSearchTask_5.xml"
    edit(file, "AreaSearchTask", "CommRelayTask")
    text = file.read_text(encoding="utf-8").replace('Series="CMASI"', 'Series="IMPACT"', 1)
    file.write_text(re.sub("(?s)<SearchArea>.*?</SearchArea>", "", text), encoding="utf-8")
    with pytest.raises(BadInput) as caught:
        load(folder)
    assert "AreaSearchTask_5.xml" in str(caught.value)


def test_zones_of_the_operating_region(tmp_path: Path) -> None:
    mission = load(small_assign(tmp_path))
    assert [(zone.id, zone.kind) for zone in mission.zones] == [
        (3, ZoneKind.KEEP_IN),
        (1, ZoneKind.KEEP_OUT),
        (2, ZoneKind.KEEP_OUT),
    ]
    assert [len(zone.vertices) for zone in mission.zones] == [4, 4, 6]
    assert mission.relations == "|(.(p1 p3) .(p2 p4))"


def test_zones_outside_the_region_do_not_bind(tmp_path: Path) -> None:
    mission = load(changed(tmp_path, "inputs/OperatingRegion_10.xml", "<int64>2</int64>", ""))
    assert [zone.id for zone in mission.zones] == [3, 1]
    assert any("not binding: 2" in note for note in mission.notes)


def test_tasks_without_a_place_in_the_relations_are_noted(tmp_path: Path) -> None:
    request = "inputs/AutomationRequest_All.xml"
    mission = load(changed(tmp_path, request, "|(.(p1 p3) .(p2 p4))", ".(p1 p3)"))
    assert [task.id for task in mission.tasks] == [1, 3]
    assert any("not done: 2, 4" in note for note in mission.notes)


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("inputs/AutomationRequest_All.xml", "p1 p3", "p1 p8", "unknown task p8"),
        ("inputs/AutomationRequest_All.xml", "<int64>3</int64>", "<int64>9</int64>", "task 9"),
        ("inputs/AutomationRequest_All.xml", ">10<", ">11<", "region 11 does not exist"),
        ("inputs/OperatingRegion_10.xml", "<int64>2</int64>", "<int64>7</int64>", "zone 7"),
        ("inputs/PointSearchTask_1.xml", "<EligibleEntities/>",
         "<EligibleEntities><int64>77</int64></EligibleEntities>", "does not exist"),
        ("cfg_run.xml", "PointSearchTask_1.xml", "Absent.xml", "message file is missing"),
        ("cfg_run.xml", '"MINMAX"', '"FASTEST"', "unknown cost function"),
        ("cfg_run.xml", '<Service Type="SensorManagerService"/>',
         '<Service Type="IcarousCommunicationService" NumberOfUAVs="3"/>',
         "more ICAROUS instances than vehicles"),
        ("cfg_run.xml", "<UxAS ", "<UxAS <", ""),
    ],
)  # fmt: skip
def test_refusals(tmp_path: Path, file: str, old: str, new: str, words: str) -> None:
    folder = changed(tmp_path, file, old, new)
    with pytest.raises(BadInput) as caught:
        load(folder)
    assert words in str(caught.value)
    assert str(folder) in caught.value.where


def test_fewer_instances_than_vehicles(tmp_path: Path) -> None:
    service = '<Service Type="IcarousCommunicationService" NumberOfUAVs="1"/>'
    folder = changed(tmp_path, "cfg_run.xml", '<Service Type="SensorManagerService"/>', service)
    mission = load(folder)
    assert mission.instances == (1,)
    assert all(vehicle.protected for vehicle in mission.vehicles)
    assert not isinstance(mission, LivePlanningMission)
    cfg = folder / "cfg_run.xml"
    asks = cfg.read_text().replace(
        ' NumberOfUAVs="1"', ' NumberOfUAVs="1" UseUxasRoutePlanner="true"'
    )
    cfg.write_text(asks)
    assert isinstance(load(folder), LivePlanningMission)


def test_a_folder_without_a_configuration(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no single UxAS configuration"):
        load(tmp_path)


def test_no_variants_of_a_configuration() -> None:
    with pytest.raises(BadInput, match="no variants"):
        load(SHARED / "waterway", seed=2)


# ---- what the examples of OpenUxAS ask for beyond a single cfg.xml ----------------------------


def test_vehicles_fly_at_their_nominal_altitude(tmp_path: Path) -> None:
    mission = load(small_assign(tmp_path))
    assert {(v.position.alt_m, v.cruise_alt_m) for v in mission.vehicles} == {(100.0, 500.0)}
    assert any("to its nominal 500 m" in note for note in mission.notes)
    assert mission.vehicles[0].cameras[0].zoom_rad


def test_a_configuration_of_another_name_and_one_of_two_processes(tmp_path: Path) -> None:
    folder = small_assign(tmp_path)
    (folder / "cfg_run.xml").rename(folder / "AssignTasks_cfg.xml")
    (folder / "Stub.xml").write_text("<Service Type='SendMessagesService'/>", encoding="utf-8")
    one = load(folder)
    text = (folder / "AssignTasks_cfg.xml").read_text(encoding="utf-8")
    (folder / "Second_cfg.xml").write_text(text, encoding="utf-8")
    both = load(folder)
    assert both.tasks == one.tasks
    assert both.vehicles == one.vehicles
    assert any("processes of one system" in note for note in both.notes)
    edit(folder / "Second_cfg.xml", 'CostFunction="MINMAX"', 'CostFunction="CUMULATIVE"')
    with pytest.raises(BadInput, match="no single UxAS configuration"):
        load(folder)


def test_what_is_no_request_for_a_plan_makes_no_second_request_of_a_folder(tmp_path: Path) -> None:
    folder = small_assign(tmp_path)
    one, text = load(folder), (folder / "cfg_run.xml").read_text(encoding="utf-8")
    request = (folder / "inputs" / "AutomationRequest_All.xml").read_text(encoding="utf-8")
    inner = re.sub(r"<\?xml[^>]*\?>", "", request)
    (folder / "inputs" / "Unique.xml").write_text(
        '<UniqueAutomationRequest Series="UXTASK"><OriginalRequest>'
        f"{inner}</OriginalRequest><RequestID>1</RequestID></UniqueAutomationRequest>",
        encoding="utf-8",
    )
    line = '<Message MessageFileName="AirVehicleState_V2.xml" SendTime_ms="180"/>'
    (folder / "cfg_second.xml").write_text(
        text.replace(line, line + line.replace("AirVehicleState_V2", "Unique")), encoding="utf-8"
    )
    both = load(folder)
    assert (both.tasks, both.vehicles) == (one.tasks, one.vehicles)
    assert any("messages not used: UniqueAutomationRequest" in note for note in both.notes)


def test_states_may_stand_in_the_scenario_of_the_simulator(tmp_path: Path) -> None:
    folder = small_assign(tmp_path)
    state = (folder / "inputs" / "AirVehicleState_V2.xml").read_text(encoding="utf-8")
    state = re.sub(r"<\?xml[^>]*\?>", "", state)
    line = '<Message MessageFileName="AirVehicleState_V2.xml" SendTime_ms="180"/>'
    expected = load(folder)
    edit(folder / "cfg_run.xml", line, "")
    with pytest.raises(BadInput, match="vehicle 2 has no AirVehicleState"):
        load(folder)
    scenario = f"<AMASE><ScenarioEventList>{state}</ScenarioEventList></AMASE>"
    (folder / "Scenario.xml").write_text(scenario, encoding="utf-8")
    mission = load(folder)
    assert mission.vehicles == expected.vehicles
    assert any("is read from" in note and "Scenario.xml" in note for note in mission.notes)


def test_message_files_are_read_as_uxas_reads_them(tmp_path: Path) -> None:
    folder = small_assign(tmp_path)
    expected = load(folder)
    request = folder / "inputs" / "AutomationRequest_All.xml"
    edit(request, "<RedoAllTasks>false</RedoAllTasks>", "<RedoAllTasks/>")
    task = folder / "inputs" / "PointSearchTask_1.xml"
    text = task.read_text(encoding="utf-8")
    task.write_text(text + "\n" + text.replace("<TaskID>1<", "<TaskID>91<"), encoding="utf-8")
    mission = load(folder)
    assert mission.tasks == expected.tasks
    notes = "\n".join(mission.notes)
    assert "RedoAllTasks is empty: its default is taken" in notes
    assert "2 objects one after the other" in notes
    edit(request, "<int64>1</int64>", "<int64>1<int64>")
    with pytest.raises(BadInput, match="well-formed"):
        load(folder)


def test_keep_in_zones_of_a_region_make_one_region(tmp_path: Path) -> None:
    folder = small_assign(tmp_path)
    inputs = folder / "inputs"
    zone = (inputs / "KeepInZone_3.xml").read_text(encoding="utf-8")
    edit(inputs / "OperatingRegion_10.xml", "<int64>3<", "<int64>3</int64><int64>4<")
    line = '<Message MessageFileName="KeepInZone_3.xml" SendTime_ms="220"/>'
    edit(folder / "cfg_run.xml", line, line + line.replace("_3", "_4"))

    def other(longitude: str) -> Mission:
        shifted = zone.replace("<ZoneID>3<", "<ZoneID>4<").replace("-80.68928178150387", longitude)
        (inputs / "KeepInZone_4.xml").write_text(shifted, encoding="utf-8")
        return load(folder)

    mission = other("-80.5")
    (whole,) = [z for z in mission.zones if z.kind is ZoneKind.KEEP_IN]
    easts = [east for _, east in whole.vertices]
    assert max(easts) - min(easts) == pytest.approx(54229.61 + 19_000, rel=0.01)
    assert any("make one region" in note for note in mission.notes)
    with pytest.raises(BadInput, match="do not make one region"):
        other("-79.9")
