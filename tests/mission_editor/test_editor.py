"""`cratous serve MISSION --edit` over HTTP: changes, plans, saving, and who may."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from ground_station_tools import LIMIT_S, Served, ask

from cratous.services.exporting.exported import ALL, exported
from cratous.services.ground_station.access import Access
from cratous.services.ground_station.page_data import ReadAnew
from cratous.services.ground_station.server import Commands, GroundStation
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.logs.records import from_data
from cratous.spec.mission.plan import Plan


def opened(editor: Served) -> Any:
    return ask(editor.port, "/recording.json").data()


def plan(editor: Served, text: str) -> int:
    """The number of the plan that is begun."""
    begun = editor.edit("/plan", text=text)
    assert begun.status == 200
    return int(begun.data()["plan_number"])


def planned(editor: Served, *states: str) -> Any:
    until_s = time.monotonic() + LIMIT_S
    while (told := ask(editor.port, "/planned.json").data())["state"] not in states:
        assert time.monotonic() < until_s, told
        time.sleep(0.05)
    return told


def test_a_mission_is_changed_and_saved(editor: Served, mission: Path) -> None:
    first = opened(editor)
    asked = {"text": first["text"], "do": "add", "list": "zones"}
    item = {"kind": "keep_out", "vertices": [[900, 900], [900, 1200], [1200, 1200]]}
    text = editor.edit("/change", **asked, item=item).data()["text"]
    assert text.startswith(first["text"].rstrip())
    (zone,) = editor.edit("/sketch", text=text).data()["drawn"]["zones"]
    assert (zone["id"], zone["kind"]) == (1, "keep_out")
    saved = editor.edit("/save", text=text, digest=first["digest"])
    assert saved.status == 200
    assert mission.read_text(encoding="utf-8") == text
    # what began with the old text does not write over the new one
    old = editor.edit("/save", text=first["text"], digest=first["digest"])
    assert old.status == 409
    assert "changed since by something else" in old.data()["error"]
    assert mission.read_text(encoding="utf-8") == text


def test_bad_changes_are_refused_with_what_and_where(editor: Served, mission: Path) -> None:
    text = opened(editor)["text"]
    got = editor.edit("/change", text=text, do="move", key=["tasks", 9], north_m=0, east_m=0)
    assert got.status == 422
    assert got.data()["item"] == "tasks[9]"
    for asked in (
        {"do": "fly"}, {"do": "add", "list": "changes", "item": {}}, {"do": "add", "list": "vehicles", "item": {}},
        {"do": "add", "list": "vehicles", "item": {"position": {"north_m": 1}}},
        {"do": "add", "list": "vehicles", "item": {"position": {"north_m": 1, "east_m": 1}, "id": 7}},
        {"do": "move", "key": "tasks"},
        {"do": "move", "key": ["tasks"], "north_m": True, "east_m": 0},
        {"do": "move", "key": ["tasks"], "north_m": 1e300, "east_m": 0}, {"do": "put", "key": ["a"]},
        {"do": "number", "key": ["tasks"]}, {"do": "number", "key": ["tasks"], "value": "1"},
    ):  # fmt: skip
        assert editor.edit("/change", text=text, **asked).status == 400
    assert editor.edit("/change", do="put").status == 400
    for key in ([], ["tasks"]):
        got = editor.edit("/change", text=text, do="put", key=key, value="x")
        assert (got.status, got.data()["error"]) == (422, "this is no text")
    for no_mission in ("- 1\n", "x\n"):
        got = editor.edit("/change", text=no_mission, do="add", list="zones", item={})
        assert (got.status, got.data()["error"]) == (422, "this is no mission")
    for path in ("/sketch", "/change", "/relations", "/plan", "/save", "/export"):
        half = editor.edit(path, text="name: \ud800", tasks=[], format="kml", do="remove", key=[])
        assert (half.status, half.data()["error"]) == (422, "half a character")
    assert editor.edit("/relations", text="p1", tasks="all").status == 400
    assert editor.edit("/why", task=1, plan_number=1).status == 409
    assert editor.edit("/stop", plan_number=0).status == 409
    assert editor.edit("/stop").status == 400
    assert editor.edit("/why", task=1).status == 400
    assert mission.read_text(encoding="utf-8") == text


def test_only_the_page_with_the_token_may_edit(editor: Served, mission: Path) -> None:
    first = opened(editor)
    body = {"text": "name: x\n", "digest": first["digest"]}
    assert editor._replace(token="x").edit("/save", **body).status == 403
    named = editor._replace(path="/save")
    assert named.sent("a", b"{}", Origin="http://elsewhere.example").status == 403
    assert named.sent("a", b"{}", Host="elsewhere.example").status == 421
    assert named.sent("a", b"[]").status == 400
    for length in ("99000000", "0000000019900000000"):
        assert named.sent("a", b"{}", Content_Length=length).status == 413
    assert ask(editor.port, "/save").status == 404
    assert mission.read_text(encoding="utf-8") == first["text"]


@pytest.mark.parametrize("form", ALL)
def test_a_text_is_exported_as_it_stands(editor: Served, mission: Path, form: str) -> None:
    text = opened(editor)["text"].replace("east_m: 2500, alt_m", "east_m: 2600, alt_m")
    one: dict[str, int] = {"vehicle": 2} if form == "qgc" else {}
    if form == "geofence":
        assert editor.edit("/export", text=text, format=form).status == 422  # there are no zones
        corners = [[0, 9000], [500, 9000], [500, 9500]]
        zone = {"kind": "keep_out", "vertices": corners}
        added = editor.edit("/change", text=text, do="add", list="zones", item=zone)
        text = added.data()["text"]
    told = editor.edit("/export", text=text, format=form, **one).data()
    made = exported(loaded(parse_document(text, "typed")), form, **one)
    assert told["files"] == made.files
    assert told["unsaid"][: len(made.unsaid)] == list(made.unsaid)
    assert "variation: a section of the mission file" in told["unsaid"]
    assert "2600" not in mission.read_text(encoding="utf-8"), "nothing is saved"


def test_what_cannot_be_exported_is_refused(editor: Served) -> None:
    text = opened(editor)["text"]
    assert editor.edit("/export", text=text, format="pdf").status == 400
    assert editor.edit("/export", format="kml").status == 400
    assert editor._replace(token="x").edit("/export", text=text, format="kml").status == 403
    wrong = editor.edit(
        "/export", text=text.replace("eligible: [2]", "eligible: [7]"), format="kml"
    )
    assert (wrong.status, "7" in wrong.data()["got"]) == (422, True)


@pytest.mark.slow
def test_a_text_is_planned_as_cratous_plan_does_and_says_why(editor: Served) -> None:
    text = opened(editor)["text"].replace("east_m: 2500, alt_m", "east_m: 2600, alt_m")
    number = plan(editor, text)
    told = planned(editor, "planned", "failed")
    assert told["state"] == "planned", told
    assert {(i["task_id"], i["vehicle_id"]) for i in told["plan"]["items"]} == {(1, 1), (2, 2)}
    assert told["exit_code"] == 0
    assert any(row["item"] == "eligibility: task 1" for row in told["constraints"])
    assert editor.edit("/why", task=2, plan_number=number).status == 200
    until_s = time.monotonic() + LIMIT_S
    while "2" not in (why := ask(editor.port, "/planned.json").data()["why"]):
        assert time.monotonic() < until_s
        time.sleep(0.05)
    assert why["2"][0].startswith("task 2 is given to vehicle 2: the plan costs ")
    assert "vehicle 1: " in why["2"][1]
    made = from_data(Plan, told["plan"], "plan")
    routed: list[tuple[str, dict[str, int]]] = [("geojson", {}), ("qgc", {"vehicle": 2})]
    for form, one in routed:
        got = editor.edit("/export", text=text, format=form, plan_number=number, **one).data()
        assert got["files"] == exported(loaded(parse_document(text, "")), form, made, **one).files
    asked = {"text": text, "plan_number": number}
    refused: list[tuple[dict[str, Any], int]] = [
        ({"format": "qgc", "vehicle": 2, "text": text + "\n"}, 409),
        ({"format": "qgc", "vehicle": 2, "plan_number": number + 1}, 409),
        ({"format": "qgc", "vehicle": 9}, 422), ({"format": "qgc"}, 422),
        ({"format": "kml", "vehicle": 2}, 400), ({"format": "amase"}, 400),
    ]  # fmt: skip
    for wrong, status in refused:
        assert editor.edit("/export", **{**asked, **wrong}).status == status, wrong


@pytest.mark.slow
def test_a_text_that_is_wrong_or_impossible_says_so(editor: Served) -> None:
    text = opened(editor)["text"]
    plan(editor, text.replace("eligible: [2]", "eligible: [7]"))
    told = planned(editor, "failed")
    assert "7" in told["text"]
    late = text.replace('relations: "|(p1 p2)"', 'relations: "|(p1 p2)_[0-1000]"')
    plan(editor, late)
    told = planned(editor, "planned", "failed")
    assert told["state"] == "failed" or told["exit_code"] == 1
    assert "1.000 s" in str(told)


@pytest.mark.slow
def test_planning_is_stopped_and_a_planner_that_dies_is_told(editor: Served) -> None:
    text = opened(editor)["text"]
    assert editor.edit("/stop", plan_number=plan(editor, text)).status == 200
    assert planned(editor, "stopped")["text"] == "Planning was stopped."
    plan(editor, text)
    (child,) = editor.children()
    os.kill(child, signal.SIGKILL)
    assert "ended without a word (signal 9)" in planned(editor, "failed")["text"]


@pytest.mark.slow
def test_the_plan_of_another_page_is_told_apart(editor: Served) -> None:
    text = opened(editor)["text"]
    first, second = plan(editor, text), plan(editor, text.replace("east_m: 2500", "east_m: 2600"))
    assert planned(editor, "planned")["plan_number"] == second != first
    for path in ("/stop", "/why"):
        old = editor.edit(path, task=2, plan_number=first)
        assert (old.status, "no such plan any more" in old.data()["error"]) == (409, True)


@pytest.mark.slow
def test_who_asks_a_planner_that_dies_is_told(editor: Served) -> None:
    number = plan(editor, opened(editor)["text"])
    planned(editor, "planned")
    (child,) = editor.children()
    os.kill(child, signal.SIGSTOP)
    assert editor.edit("/why", task=2, plan_number=number).status == 200
    os.kill(child, signal.SIGKILL)
    until_s = time.monotonic() + LIMIT_S
    while "2" not in (told := ask(editor.port, "/planned.json").data())["why"]:
        assert time.monotonic() < until_s
        time.sleep(0.05)
    assert "ended without a word (signal 9)" in told["why"]["2"][0]
    assert editor.edit("/why", task=2, plan_number=number).status == 409


def test_a_search_ends_with_who_asked_for_it(mission: Path) -> None:
    asked = {"text": mission.read_text(encoding="utf-8"), "where": "typed", "allow_unproved": True}
    searching = """import sys, time
from cratous.services.cli import job, serve_plan
job.plan_and_check = lambda *_: (print("searching", file=sys.stderr, flush=True), time.sleep(600))
sys.exit(serve_plan.main())"""
    with subprocess.Popen(
        [sys.executable, "-c", searching], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE, text=True,
    ) as running:  # fmt: skip
        try:
            assert running.stdin is not None
            assert running.stderr is not None
            running.stdin.write(json.dumps(asked) + "\n")
            running.stdin.flush()
            assert any("searching" in line for line in running.stderr)
            running.stdin.close()
            assert running.wait(LIMIT_S) == 1
        finally:
            running.kill()


@pytest.mark.slow
def test_what_plans_ends_with_the_server(editor: Served) -> None:
    plan(editor, opened(editor)["text"])
    planned(editor, "planned")
    (child,) = editor.children()
    editor.process.kill()
    until_s = time.monotonic() + LIMIT_S
    with suppress(FileNotFoundError, ProcessLookupError):  # it is gone
        while Path(f"/proc/{child}/cmdline").read_bytes():
            assert time.monotonic() < until_s
            time.sleep(0.05)


@pytest.mark.parametrize(
    "words", [["out/none"], ["MISSION", "--seed", "1"], ["MISSION", "--out", "x"], ["MISSION", "MISSION"]]
)  # fmt: skip
def test_it_goes_with_a_mission_alone(words: list[str], mission: Path) -> None:
    told = [str(mission) if word == "MISSION" else word for word in words]
    done = subprocess.run(
        [sys.executable, "-m", "cratous", "serve", *told, "--edit", "--port", "0"],
        capture_output=True, text=True, timeout=LIMIT_S, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_an_error_of_ours_is_answered_as_one() -> None:
    def fails(token: str, page: str, asked: Any) -> dict[str, Any]:
        raise ZeroDivisionError("of no consequence")

    shown = ReadAnew(dict)
    with GroundStation(shown, 0, Access(), commands=Commands({"/change": fails})) as server:
        serving = threading.Thread(target=server.serve_forever)
        serving.start()
        try:
            own = server.url[:-1]
            headers = {"Origin": own, "Content_Type": "application/json", "Content_Length": "2"}
            got = ask(server.port, "/change", "POST", b"{}", **headers)
        finally:
            server.shutdown()
            serving.join(LIMIT_S)
    assert got.status == 500
    assert got.data()["error"] == "internal error of CRATOUS: ZeroDivisionError: of no consequence"
