"""The judge on flights: agreement with the monitor on good ones, and faults that are put into their logs."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from judge_tools import Edit, Message, edited, read, verdicts, with_monitor, write

from cratous.judge import judge
from cratous.services.cli import main

ROOT = Path(__file__).resolve().parents[2]
MISSIONS = Path(__file__).resolve().parents[1] / "missions"
EXAMPLES = {name: ROOT / "examples" / name / "mission.yaml" for name in
            ("crossing", "popup", "relations", "search")}  # fmt: skip
Flown = Callable[[str], Path]


def fly(mission: Path, out: Path) -> Path:
    """The folder of a flight; what its exit code is, is not asked here."""
    main(["run", str(mission), "--out", str(out), "--allow-unproved", "--quiet"])
    return next(out.iterdir())


@pytest.fixture(scope="session")
def flown(fly_once: Callable[[Path], Path]) -> Flown:
    """Folders of flown examples, each flown when it is asked for first."""
    return lambda name: fly_once(EXAMPLES[name])


MARKS = {"popup": pytest.mark.slow, "relations": pytest.mark.slow, "search": pytest.mark.long}


@pytest.mark.parametrize(
    "name", ["crossing", *(pytest.param(n, marks=MARKS.get(n, ())) for n in list(EXAMPLES)[1:])]
)
def test_judge_and_monitor_agree_on_the_examples(flown: Flown, name: str) -> None:
    found = judge(flown(name))
    assert found.report
    assert [d.line() for d in found.differences] == []
    assert {row.verdict for row in found.rows} == {"holds"}
    assert found.exit_code == 0
    by_file = judge(flown(name), EXAMPLES[name])
    assert verdicts(by_file) == verdicts(found)
    assert not by_file.differences


def test_without_avoidance_both_see_the_loss(fly_once: Callable[..., Path]) -> None:
    found = judge(fly_once(EXAMPLES["crossing"], "--no-daa"))
    assert verdicts(found)["well clear of 1 and 2"] == "violated"
    assert "near mid-air collision" in next(r.note for r in found.rows if r.guarantee == "G2")
    assert not found.differences
    assert found.exit_code == 1


def test_the_task_of_a_lost_vehicle_is_asked_for(tmp_path: Path) -> None:
    """The monitor says so too."""
    found = judge(fly(MISSIONS / "lost_vehicle.yaml", tmp_path))
    assert verdicts(found)["task 2 served"] == "violated"
    assert found.of("G3") == "violated"
    assert found.disagreements == []


# ---- faults ---------------------------------------------------------------------------------------


def shifted(vehicle: int, at_ms: int, north_m: float, east_m: float, alt_m: float = 0.0) -> Edit:
    """One position moved; the velocities around it lead there and back."""

    def edit(messages: list[Message]) -> list[Message]:
        states = [m for m in messages if m.kind == "TruthState" and m.body["VehicleID"] == vehicle]
        k = next(k for k, m in enumerate(states) if m.body["Time"] == at_ms)
        for name, by in (("North", north_m), ("East", east_m), ("Altitude", alt_m)):
            states[k].body[name] += by
        for before, after in zip(states[k - 1 : k + 1], states[k : k + 2], strict=True):
            dt = (after.body["Time"] - before.body["Time"]) / 1000
            for name, rate, sign in (
                ("North", "VelocityNorth", 1), ("East", "VelocityEast", 1),
                ("Altitude", "VelocityDown", -1),
            ):  # fmt: skip
                before.body[rate] = sign * (after.body[name] - before.body[name]) / dt
        return messages

    return edit


def position(log: Path, vehicle: int, at_ms: int) -> dict[str, float]:
    return next(
        m.body for m in read(log)[1]
        if m.kind == "TruthState" and (m.body["VehicleID"], m.body["Time"]) == (vehicle, at_ms)
    )  # fmt: skip


def without(choose: Callable[[Message], bool]) -> Edit:
    return lambda messages: [m for m in messages if not choose(m)]


def said(kind: str, change: Callable[[dict], None], **match: object) -> Edit:
    """A change to the messages of a kind that match."""

    def edit(messages: list[Message]) -> list[Message]:
        found = [
            m for m in messages if m.kind == kind and all(m.body[k] == v for k, v in match.items())
        ]
        assert found
        for message in found:
            change(message.body)
        return messages

    return edit


def is_progress(message: Message, task: int, *phases: str) -> bool:
    return (
        message.kind == "TaskProgress"
        and message.body["TaskID"] == task
        and message.body["Phase"] in phases
    )


def handback(message: Message) -> bool:
    kind, body = message.kind, message.body
    return kind in ("GateState", "AuthorityChange") and body["Owner"] == "UxAS"


def beat(message: Message, first: int, last: int) -> bool:
    return message.kind == "Heartbeat" and first <= message.body["Time"] <= last


def blind(messages: list[Message]) -> list[Message]:
    """The cameras see nothing in the second half."""
    for message in messages:
        if message.kind == "AirVehicleState" and message.time_ms > 150_000:
            for payload in message.body["PayloadStateList"]:
                payload["Footprint"] = []
    return messages


def doubled(messages: list[Message]) -> list[Message]:
    """A command of ICAROUS in the epoch in which UxAS has control."""
    k = next(k for k, m in enumerate(messages) if m.kind == "GatedCommand" and m.time_ms > 150_000)
    wrong = messages[k]._replace(body={**messages[k].body, "Sender": "ICAROUS"})
    return [*messages[:k], wrong, *messages[k:]]


FAULTS: dict[str, tuple[Edit, str]] = {
    "leaves a task undone": (
        without(lambda m: is_progress(m, 2, "Active", "Complete")), "task 2 served"),
    "begins a task and does not end it": (
        without(lambda m: is_progress(m, 2, "Complete")), "task 2 served"),
    "sees only half of the line": (blind, "task 1 served"),
    "is flown by who may not": (
        said("TaskProgress", lambda b: b.update(VehicleID=1), TaskID=2),
        "eligibility: task 2 in flight"),
    "drops a handback": (without(handback), "authority over vehicle 2"),
    "drops a takeover": (
        without(lambda m: m.kind == "GateState" and m.body["Epoch"] == 1), "authority over vehicle 2"),
    "has two commanders": (doubled, "authority over vehicle 1"),
    "drops a command that has authority": (
        said("GateState", lambda b: b.update(Epoch=7), Epoch=1), "authority over vehicle 2"),
    "has no heartbeats for a while": (
        without(lambda m: beat(m, 50_000, 53_000)), "heartbeat to the ICAROUS instance of 1"),
    "has no heartbeats at the end": (
        without(lambda m: beat(m, 200_000, 900_000)), "heartbeat from the ICAROUS instance of 2"),
    "has no heartbeats at all": (
        without(lambda m: m.kind == "Heartbeat"), "heartbeat to the ICAROUS instance of 1"),
    "never hears of ICAROUS": (
        without(lambda m: m.kind == "Heartbeat" and m.body["Direction"] == "Up"),
        "heartbeat from the ICAROUS instance of 1"),
    "ends otherwise": (said("MissionEnd", lambda b: b.update(Outcome="failed")), "end of mission"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_noticed(flown: Flown, tmp_path: Path, fault: str) -> None:
    edit, item = FAULTS[fault]
    log = edited(flown("crossing") / "log.sqlite", tmp_path / "log.sqlite", edit)
    found = judge(with_monitor(log))
    assert verdicts(found)[item] == "violated"
    assert [d.line() for d in found.disagreements] == []


def test_where_it_was_is_not_known_nothing_was_served(flown: Flown, tmp_path: Path) -> None:
    """Footprints alone do not say that the vehicle was there: monitor and judge both say so."""
    log = edited(
        flown("crossing") / "log.sqlite",
        tmp_path / "log.sqlite",
        without(lambda m: m.kind == "TruthState" and 90_000 <= m.body["Time"] <= 110_000),
    )
    folder = with_monitor(log)
    found = judge(folder)
    rows = json.loads((folder / "report.json").read_text())["constraints"]
    (row,) = [r for r in rows if r["item"] == "task 1 served"]
    assert (row["verdict"], verdicts(found)["task 1 served"]) == ("unknown", "unknown")
    assert "aircraft 1 was not observed from 89." in row["note"]
    assert "covered 100.00 %" in row["note"]
    # the other one began later
    assert verdicts(found)["task 2 served"] == "holds"
    assert not found.differences


def test_of_a_protocol_without_heartbeats_both_say_unknown(flown: Flown, tmp_path: Path) -> None:
    meta, messages = read(flown("crossing") / "log.sqlite")
    meta["command"] += " --processes --original-clients"
    left = FAULTS["never hears of ICAROUS"][0](messages)
    found = judge(with_monitor(write(tmp_path / "log.sqlite", meta, left)))
    assert {k: v for k, v in verdicts(found).items() if v != "holds"} == {
        f"heartbeat from the ICAROUS instance of {k}": "unknown" for k in (1, 2)
    }
    assert not found.differences


def test_a_task_is_done_when_it_is_said_to_have_been(flown: Flown, tmp_path: Path) -> None:
    """The monitor goes by when it was told so, and does not hold that against the time that was told."""
    edit = said("TaskProgress", lambda b: b.update(Time=b["Time"] - 100_000), TaskID=2)
    log = edited(flown("crossing") / "log.sqlite", tmp_path / "log.sqlite", edit)
    assert verdicts(judge(with_monitor(log)))["task 2 served"] == "violated"


def test_two_aircraft_brought_together_are_noticed(flown: Flown, tmp_path: Path) -> None:
    log = flown("crossing") / "log.sqlite"
    at = 95_000
    one, two = position(log, 1, at), position(log, 2, at)
    apart = [two[k] - one[k] for k in ("North", "East", "Altitude")]
    near = edited(log, tmp_path / "log.sqlite", shifted(1, at, *apart))
    found = judge(with_monitor(near))
    assert verdicts(found)["well clear of 1 and 2"] == "violated"
    assert [d.line() for d in found.disagreements] == []


def test_a_sample_that_is_not_where_its_velocity_led_is_noticed(
    flown: Flown, tmp_path: Path
) -> None:
    """Where nothing is broken by it, nothing holds either."""
    move = said("TruthState", lambda b: b.update(North=b["North"] + 1.0), VehicleID=1, Time=50_000)
    log = edited(flown("crossing") / "log.sqlite", tmp_path / "log.sqlite", move)
    assert verdicts(judge(log))["well clear of 1 and 2"] == "unknown"


def into(zone: str) -> Edit:
    def edit(messages: list[Message]) -> list[Message]:
        here = next(
            m.body for m in messages
            if m.kind == "TruthState" and (m.body["VehicleID"], m.body["Time"]) == (1, 100_000)
        )  # fmt: skip
        to = {"keep_out 9": (2500.0, 0.0), "keep_in 1": (-9000.0, 0.0)}[zone]
        return shifted(1, 100_000, to[0] - here["North"], to[1] - here["East"])(messages)

    return edit


@pytest.mark.slow
@pytest.mark.parametrize("zone", ["keep_out 9", "keep_in 1"])
def test_a_sample_in_a_zone_is_noticed(flown: Flown, tmp_path: Path, zone: str) -> None:
    log = edited(flown("popup") / "log.sqlite", tmp_path / "log.sqlite", into(zone))
    found = judge(with_monitor(log))
    assert verdicts(found)[f"zone: {zone}, flight of vehicle 1"] == "violated"
    assert verdicts(found)[f"zone: {zone}, flight of vehicle 2"] == "holds"
    assert [d.line() for d in found.disagreements] == []


def moved(task: int, phase: str, by_ms: int) -> Edit:
    return said(
        "TaskProgress", lambda b: b.update(Time=b["Time"] + by_ms), TaskID=task, Phase=phase
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edit", "item"),
    [
        (moved(2, "Active", -100), "order: .(p1 p2)"),  # before the survey has ended
        pytest.param(
            moved(6, "Active", -186_400), "order: ~(p5 p6)-[20000-600000]", marks=pytest.mark.long
        ),
        pytest.param(
            moved(6, "Active", -180_000), "timing: ~(p5 p6)-[20000-600000]", marks=pytest.mark.long
        ),
        pytest.param(
            moved(3, "Active", -120_000), "timing: p3_[240000-1200000]", marks=pytest.mark.long
        ),
    ],
)
def test_a_task_at_another_time_is_noticed(
    flown: Flown, tmp_path: Path, edit: Edit, item: str
) -> None:
    log = edited(flown("relations") / "log.sqlite", tmp_path / "log.sqlite", edit)
    found = judge(with_monitor(log))
    assert verdicts(found)[item] == "violated"
    assert [d.line() for d in found.disagreements] == []


@pytest.mark.slow
def test_both_branches_of_an_alternative_are_noticed(flown: Flown, tmp_path: Path) -> None:
    def edit(messages: list[Message]) -> list[Message]:
        begun = next(m for m in messages if is_progress(m, 3, "Active"))
        k = messages.index(begun)
        other = begun._replace(body={**begun.body, "TaskID": 4})
        return [*messages[:k], other, *messages[k:]]

    log = edited(flown("relations") / "log.sqlite", tmp_path / "log.sqlite", edit)
    found = judge(log)
    assert verdicts(found)["choice: +(p3 p4)_[240000-1200000]"] == "violated"


@pytest.mark.long  # each judges the search flight again, and lets the monitor do so
@pytest.mark.parametrize("task", [1, 4, 8, 9, 10])
def test_a_search_without_its_second_half_is_noticed(
    flown: Flown, tmp_path: Path, task: int
) -> None:
    def edit(messages: list[Message]) -> list[Message]:
        looks = [
            m for m in messages
            if m.kind == "AirVehicleState" and m.body["AssociatedTasks"] == [task]
        ]  # fmt: skip
        kept = 0 if task == 9 else len(looks) // 2
        for message in looks[kept:]:
            for payload in message.body["PayloadStateList"]:
                payload["Footprint"] = []
        return messages

    log = edited(flown("search") / "log.sqlite", tmp_path / "log.sqlite", edit)
    found = judge(with_monitor(log))
    assert verdicts(found)[f"task {task} served"] == "violated"
    if task != 10:  # the monitor does not ask how long a point was seen
        assert [d.line() for d in found.disagreements] == []
