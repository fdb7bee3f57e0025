"""Missions as messages: what is told comes back, and what cannot be told or flown is refused by its field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.loading import load
from cratous.services.loading.uxas import load_uxas
from cratous.services.loading.uxas_settings import read as read_cfg
from cratous.services.mission.frames import Projection
from cratous.services.processes.agreement import agrees
from cratous.services.processes.coverage import told_of
from cratous.services.processes.files import (
    Ports,
    write_configuration,
    write_messages,
    write_scenario,
)
from cratous.services.simulator.scenario import read as read_scenario
from cratous.services.simulator.world import World
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    Daa,
    FaultySimulation,
    LinkLoss,
    LinkLossDaa,
    Mission,
    Position,
    Simulation,
    TaskKind,
    TimedBridgeMission,
    Traffic,
    Velocity,
)
from cratous.spec.mission.bridge_times import BridgeTimes
from cratous.spec.mission.link_loss import WithoutLink


def crossing(root: Path) -> Mission:
    return load(root / "examples/crossing/mission.yaml", 0)


@pytest.mark.parametrize("name", ["crossing", "relations"])
def test_a_mission_comes_back_from_its_messages(root: Path, tmp_path: Path, name: str) -> None:
    """The loader of UxAS folders reads the same mission, in a frame of its own."""
    mission = load(root / f"examples/{name}/mission.yaml", 0)
    told = told_of(mission)
    write_messages(told, tmp_path)
    ports = Ports(1001, 1002, 1003)
    cfg = write_configuration(mission, mission.instances, ports, tmp_path)
    again = load_uxas(cfg)
    assert [v.id for v in again.vehicles] == [v.id for v in mission.vehicles]
    assert [(t.id, t.kind, t.eligible, t.duration_ms) for t in again.tasks] == [
        (t.id, t.kind, t.eligible, t.duration_ms) for t in mission.tasks
    ]
    assert [(z.id, z.kind, len(z.vertices)) for z in again.zones] == [
        (z.id, z.kind, len(z.vertices)) for z in mission.zones
    ]
    assert (again.relations, again.cost, again.order) == (
        mission.relations, mission.cost, mission.order,
    )  # fmt: skip
    bridges = [e for e in read_cfg(cfg).entries if "Bridge" in e.type]
    assert len(bridges) == 2


def aircraft(**more: Any) -> Traffic:
    values = {"velocity": Velocity(0.0, -20.0, 0.0), "appears_ms": 2000, "vanishes_ms": 5000}
    return Traffic(90, Position(500.0, 3000.0, 300.0), **{**values, **more})


CHANGES: list[tuple[str, Callable[[Mission], Mission]]] = [
    ("frame.terrain_m", lambda m: replace(m, frame=replace(m.frame, terrain_m=20.0))),
    ("cost", lambda m: replace(m, cost="DISTANCE")),
    ("gap", lambda m: replace(m, gap=0.1)),
    ("vehicles", lambda m: replace(m, instances=())),
    (
        "tasks[0].kind",
        lambda m: replace(
            m, tasks=(replace(m.tasks[0], kind=TaskKind.PATTERN_SEARCH), *m.tasks[1:])
        ),
    ),
    (
        "traffic[0].velocity",
        lambda m: replace(m, traffic=(aircraft(velocity=Velocity(0.0, 20.0, 1.0)),)),
    ),
    (
        "traffic[0].velocity",
        lambda m: replace(m, traffic=(aircraft(velocity=Velocity(0.0, 0.0, 0.0)),)),
    ),
    (
        "vehicles[0].cameras[0].aspect",
        lambda m: replace(
            m,
            vehicles=(
                replace(m.vehicles[0], cameras=(replace(m.vehicles[0].cameras[0], aspect=1.0),)),
                m.vehicles[1],
            ),
        ),
    ),
    (
        "tasks[0].sweep_rad",
        lambda m: replace(m, tasks=(replace(m.tasks[0], sweep_rad=1.0), m.tasks[1])),
    ),
]


@pytest.mark.parametrize(("item", "change"), CHANGES, ids=[item for item, _ in CHANGES])
def test_what_cannot_be_flown_is_refused_by_its_field(
    root: Path, item: str, change: Callable[[Mission], Mission]
) -> None:
    with pytest.raises(BadInput) as wrong:
        told_of(change(crossing(root)))
    assert wrong.value.item == item
    assert "--processes" in wrong.value.expected


@pytest.mark.parametrize("choice", list(WithoutLink))
def test_without_the_link_uxas_flies_all_but_a_landing(
    root: Path, tmp_path: Path, choice: WithoutLink
) -> None:
    plain = crossing(root)
    to = Position(300.0, 900.0, 250.0) if choice is WithoutLink.RETURN else None
    kept = {f.name: getattr(plain.daa, f.name) for f in fields(Daa)}
    mission = replace(plain, daa=LinkLossDaa(**kept, link_loss=LinkLoss(choice, 7000, to)))
    with pytest.raises(BadInput) as wrong:
        told_of(mission, original=choice is not WithoutLink.LAND)
    if choice is WithoutLink.LAND:
        assert wrong.value.item == "link_loss.choice"
        assert wrong.value.expected.startswith("finish or loiter or return")
        return
    assert wrong.value.item == "link_loss"
    told_of(mission)
    cfg = write_configuration(mission, mission.instances, Ports(1001, 1002, 1003), tmp_path)
    given = next(
        e.attributes for e in read_cfg(cfg).entries if e.type == "IcarousCommunicationService"
    )
    assert (given["LostLink"], given["LostLinkAfter_s"]) == (choice.value, "7")
    if to is not None:
        lat, long, alt = map(float, given["LostLinkTo"].split())
        assert Projection(mission.frame).to_local(lat, long) == pytest.approx(to[:2], abs=0.001)
        assert alt == to.alt_m
    assert ("LostLinkTo" in given) == (to is not None)


def test_a_loss_is_not_noticed_within_a_shorter_heartbeat(root: Path) -> None:
    plain = crossing(root)
    kept = {f.name: getattr(plain.daa, f.name) for f in fields(Daa)}
    lost = LinkLossDaa(**kept, link_loss=LinkLoss(WithoutLink.LOITER, 7000))
    for daa, beat_ms, refused in ((lost, 499, True), (lost, 500, False), (plain.daa, 100, False)):
        simulation = replace(plain.simulation, heartbeat_ms=beat_ms)
        mission = replace(plain, daa=daa, simulation=simulation)
        if not refused:
            told_of(mission)
            continue
        with pytest.raises(BadInput) as wrong:
            told_of(mission)
        assert wrong.value.item == "simulation.heartbeat_ms"
        assert "looks only every 0.5 s" in wrong.value.what
        assert wrong.value.expected.startswith("at least 500")


def test_the_silence_of_the_mission_is_told(root: Path, tmp_path: Path) -> None:
    ports, plain = Ports(1001, 1002, 1003), crossing(root)
    kept = {f.name: getattr(plain, f.name) for f in fields(Mission)}
    timed = TimedBridgeMission(**kept, bridge=BridgeTimes(9500, 60_000))
    for mission, expected in ((plain, None), (timed, "9.5")):
        cfg = write_configuration(mission, mission.instances, ports, tmp_path)
        (entry,) = [e for e in read_cfg(cfg).entries if e.type == "IcarousCommunicationService"]
        assert entry.attributes.get("LostLinkAfter_s") == expected
        assert "LostLink" not in entry.attributes


def test_a_bridge_to_the_original_s_clients_is_not_made_to_fail(root: Path) -> None:
    mission = replace(crossing(root), simulation=FaultySimulation())
    assert told_of(mission).tasks
    with pytest.raises(BadInput) as wrong:
        told_of(mission, original=True)
    assert wrong.value.item == "simulation.bridge_faults"


@pytest.mark.parametrize(("example", "item"), [("popup", "changes"), ("search", "tasks[3].kind")])
def test_the_command_refuses_it_before_anything_starts(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], example: str, item: str
) -> None:
    mission = str(root / f"examples/{example}/mission.yaml")
    assert main(["run", mission, "--processes", "--out", str(tmp_path / "out")]) == 2
    assert item in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("more", [["--rate", "2"], ["--processes", "--seed", "3"]])
def test_options_that_do_not_go_together(
    root: Path, capsys: pytest.CaptureFixture[str], more: list[str]
) -> None:
    assert main(["run", str(root / "examples/crossing/mission.yaml"), *more]) == 2
    assert "--processes" in capsys.readouterr().err


def test_traffic_is_there_from_when_to_when_the_mission_says(root: Path, tmp_path: Path) -> None:
    mission = replace(crossing(root), traffic=(aircraft(),), simulation=Simulation(limit_ms=10_000))
    scenario = read_scenario(write_scenario(mission, told_of(mission), tmp_path))
    world, seen = World(scenario.events, 8.0), list[tuple[int, Any]]()
    while not world.over:
        told = [body for body in world.tick() if type(body).__name__ == "AirVehicleState"]
        seen += [(world.time_ms, body) for body in told if body.Time]
    assert {body.ID for _, body in seen} == {1, 2, 90}
    times = [at_ms for at_ms, body in seen if body.ID == 90]
    # after half a second of the simulator the mission begins
    assert min(times) in range(2450, 3100)
    assert max(times) in range(4900, 5500)
    first = min(at_ms for at_ms, _ in seen)
    assert first in range(490, 560)
    speeds = {round(body.Groundspeed, 6) for _, body in seen if body.ID == 90}
    assert speeds == {20.0}


def summary(*tasks: tuple[int, int, int, int]) -> Any:
    return lmcp.new(
        "TaskAssignmentSummary",
        TaskList=[
            lmcp.new(
                "TaskAssignment",
                TaskID=task, OptionID=option, AssignedVehicle=vehicle, TimeTaskCompleted=end,
            )
            for vehicle, task, option, end in tasks
        ],
    )  # fmt: skip


@pytest.mark.parametrize(
    ("tasks", "wrong"),
    [
        ([(1, 1, 1, 1000), (1, 2, 1, 2000)], ""),
        ([(1, 1, 1, 1400), (1, 2, 1, 2000)], ""),
        ([(1, 2, 1, 1000), (1, 1, 1, 2000)], "vehicle 1 has p2 (option 1) p1 (option 1)"),
        ([(1, 1, 1, 1000), (2, 2, 1, 2000)], "vehicle 1 has p1 (option 1), expected"),
        ([(1, 1, 2, 1000), (1, 2, 1, 2000)], "vehicle 1 has p1 (option 2)"),
        ([(1, 1, 1, 1000), (1, 2, 1, 2600)], "task 2 ends after 2.600 s, expected 2.000 s"),
        ([], "vehicle 1 has no task"),
    ],
)
def test_another_assignment_is_told_apart(tasks: list[Any], wrong: str) -> None:
    items = [
        SimpleNamespace(vehicle_id=1, task_id=task, option_id=1, end_ms=1000 * task)
        for task in (1, 2)
    ]
    plan: Any = SimpleNamespace(
        items=items, chain=lambda vehicle: [i for i in items if i.vehicle_id == vehicle]
    )
    said = agrees(plan, summary(*tasks))
    assert said.startswith(wrong)
    assert bool(said) == bool(wrong)
