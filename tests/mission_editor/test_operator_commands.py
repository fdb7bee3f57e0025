"""What an operator commands in flight: a change of the mission's text, flown anew, and the same flown again."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import Page, browsing
from ground_station_tools import PAGE, Served, flying

from cratous.services.cli import main
from cratous.services.ground_station import live_session
from cratous.services.ground_station.direct_orders import Directed, DirectOrders
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.ground_station.server import LONGEST
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.mission_editor.operator_commands import (
    DIRECT,
    HEAD,
    MOST_CORNERS,
    commanded,
    directed,
)
from cratous.spec.errors import BadInput

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "examples" / "crossing" / "mission.yaml").read_text(encoding="utf-8")
SHORT = TEXT.replace("east_m: 2500", "east_m: -1500").replace("north_m: 2500", "north_m: -600")
"""Of a crossing that is over before the two meet."""
STATE = "document.getElementById('live-state')?.textContent"
STANDS = f"{STATE} === 'paused' && !document.getElementById('fly').disabled"


def _command(text: str = TEXT, now_ms: int = 24_000, **asked: Any) -> Any:
    found = commanded(text, "m.yaml", 0, now_ms, asked)
    return found, loaded(parse_document(found.text, "m.yaml"))


def test_a_place_is_a_task_of_its_vehicle_from_the_next_step_on() -> None:
    found, mission = _command(what="go_to", vehicle=2, places=[[100.04, -50]])
    assert found.text.startswith(HEAD)
    assert TEXT.split("tasks:")[0] in found.text  # all else stands as it stood
    (change,) = mission.changes
    assert (change.kind, change.task) == ("task_added", 3)
    assert 24_000 < change.at_ms == found.at_ms <= 24_000 + mission.simulation.step_ms
    task = next(one for one in mission.tasks if one.id == 3)
    assert (task.kind.value, task.eligible, task.label) == ("must_fly", (2,), "by the operator")
    assert task.points[0][:3] == (100.0, -50.0, 300.0)
    assert mission.relations == "|(|(p1 p2) p3)"
    _, higher = _command(what="loiter", vehicle=2, places=[[0, 0]], duration_s=9, alt_m=412.34)
    assert next(one for one in higher.tasks if one.id == 3).points[0].alt_m == 412.3
    # a second one takes the next numbers, and keeps the first
    again, both = _command(
        found.text, 40_000, what="loiter", vehicle=1, places=[[0, 0]], duration_s=30
    )
    assert again.text.count(HEAD) == 1
    assert [one.task for one in both.changes] == [3, 4]
    assert "task 4 for vehicle 1" in again.what


def test_zones_and_tasks_are_added_and_taken_away() -> None:
    corners = [[0, 900], [300, 900], [300, 1200]]
    found, mission = _command(what="keep_out", places=corners)
    zone = mission.changes[0].zone
    assert zone is not None
    assert (zone.id, zone.label) == (1, "by the operator")
    assert [list(map(float, one[:2])) for one in zone.vertices] == corners
    _, ended = _command(found.text, 50_000, what="end_zone", id=1)
    assert ended.changes[1].kind == "zone_ends"
    _, dropped = _command(what="drop_task", id=2)
    assert (dropped.changes[0].kind, dropped.changes[0].task) == ("task_removed", 2)


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        (None, NotObeyed), ({"what": "land"}, NotObeyed),
        ({"what": "keep_out", "places": [[0, 0], [1, 1]]}, NotObeyed),
        ({"what": "keep_out", "places": [[0, 0], [9, 9], [9, "x"]]}, NotObeyed),
        ({"what": "go_to", "vehicle": 7, "places": [[0, 0]]}, NotObeyed),
        ({"what": "go_to", "vehicle": 1, "places": [[0, float("nan")]]}, NotObeyed),
        ({"what": "loiter", "vehicle": 1, "places": [[0, 0]], "duration_s": 0}, NotObeyed),
        ({"what": "drop_task"}, NotObeyed), ({"what": "drop_task", "id": 9}, BadInput),
        ({"what": "end_zone", "id": 1}, BadInput),
        # two edges of it cross
        ({"what": "keep_out", "places": [[0, 0], [900, 900], [900, 0], [0, 900]]}, BadInput),
    ],
)  # fmt: skip
def test_what_is_no_command_or_not_possible_is_refused(asked: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        commanded(TEXT, "m.yaml", 0, 24_000, asked)


def test_a_page_can_send_as_many_corners_as_it_draws() -> None:
    (drawn,) = re.findall(r"keep_out: \[3, (\d+)\]", (PAGE / "operate.js").read_text())
    assert int(drawn) == MOST_CORNERS
    farthest = [[-9_999_999.9, -9_999_999.9]] * MOST_CORNERS
    asked = {"do": "command", "command": {"what": "keep_out", "places": farthest}}
    assert len(json.dumps(asked, separators=(",", ":"))) <= LONGEST


def test_a_variant_that_would_have_it_elsewhere_is_refused() -> None:
    asked = {"what": "go_to", "vehicle": 1, "places": [[900, 300]]}
    with pytest.raises(BadInput, match="other places"):
        commanded(TEXT, "m.yaml", 7, 24_000, asked)
    assert commanded(TEXT, "m.yaml", 7, 24_000, {"what": "drop_task", "id": 1}).at_ms > 24_000


class Flight:
    """A process that flies, as a session hears it; said: what it was told."""

    def __init__(self, _module: str, heard: Any, *_: Any) -> None:
        self.hear = lambda told: heard(told, json.dumps(told))
        self.said: list[Any] = []

    def at(self, ms: int) -> None:
        self.hear({"set": {"end_ms": ms}})

    def stands(self) -> None:
        self.hear({"status": {"state": "paused"}})

    def say(self, asked: Any) -> None:
        self.said.append(asked)

    def end(self, _patience_s: float) -> None: ...


@pytest.fixture
def flights(monkeypatch: pytest.MonkeyPatch) -> list[Flight]:
    """Those that sessions start, in their order."""
    found: list[Flight] = []

    def started(*given: Any) -> Flight:
        found.append(Flight(*given))
        return found[-1]

    monkeypatch.setattr(live_session, "JsonProcess", started)
    return found


def test_no_command_is_taken_until_the_flight_is_where_the_last_one_was(
    flights: list[Flight],
) -> None:
    given: list[int] = []

    def amended(now_ms: int, _command: Any) -> dict[str, Any]:
        given.append(now_ms)
        return {"until_ms": now_ms + 100}

    session = live_session.LiveSession("flies", {}, amended)
    asked = {"do": "command", "command": {}}
    flights[0].at(5000)
    flights[0].stands()
    session.order(session.token, "a", asked)
    flights[1].at(3000)
    flights[1].stands()  # as it says while it flies up to the command
    with pytest.raises(NotObeyed, match=r"up to 5\.1 s first"):
        session.order(session.token, "a", asked)
    flights[1].at(5100)
    session.order(session.token, "a", asked)
    assert given == [5000, 5100]


def test_a_direct_command_goes_to_the_flight_that_is_and_its_text_comes_back(
    flights: list[Flight],
) -> None:
    texts: list[str] = []
    anew: list[int] = []

    def checked(now_ms: int, command: Any) -> None:
        directed(TEXT, "m.yaml", 0, now_ms, command)

    def amended(now_ms: int, _command: Any) -> dict[str, Any]:
        anew.append(now_ms)
        return {"until_ms": now_ms + 100}

    direct = live_session.Direct(DIRECT, checked, texts.append)
    session = live_session.LiveSession("flies", {}, amended, direct)
    (flight,) = flights
    asked = {"do": "command", "command": {"what": "resume", "vehicle": 1}}
    with pytest.raises(NotObeyed, match="has not begun"):
        session.order(session.token, "a", asked)
    flight.at(5000)
    flight.hear({"status": {"state": "flying"}})
    session.order(session.token, "a", asked)
    with pytest.raises(NotObeyed, match="expected vehicle"):
        session.order(session.token, "a", {"do": "command", "command": {"what": "hold_here"}})
    assert flight.said == [{"do": "direct", "command": asked["command"]}]
    # what is planned anew waits until the flight has taken it up, for it is flown anew with it
    flight.stands()
    other = {"do": "command", "command": {"what": "drop_task", "id": 1}}
    with pytest.raises(NotObeyed, match="fly on by a step"):
        session.order(session.token, "a", other)
    flight.hear({"directed": {"text": "the mission with it", "refused": ""}})
    assert texts == ["the mission with it"]
    assert [one for one in session.told(0)["updates"] if "directed" in one] == []
    session.order(session.token, "a", other)
    assert (anew, len(flights)) == ([5000], 2)
    flights[1].stands()
    with pytest.raises(NotObeyed, match=r"up to 5\.1 s first"):
        session.order(session.token, "a", asked)


def test_orders_wait_for_the_next_step_and_one_that_cannot_be_is_told() -> None:
    def put(text: str, at_ms: int, command: Any) -> Directed:
        return directed(text, "m.yaml", 0, at_ms, command)

    orders, told = DirectOrders(TEXT, put), list[Any]()
    assert (orders.due(1000, told.append), orders.mission) == ((), None)
    orders.give({"what": "hold_here", "vehicle": 1})
    orders.give({"what": "hold_at", "vehicle": 1, "places": [[0, 900_000]]})
    orders.give({"what": "resume", "vehicle": 1})
    found = orders.due(1250, told.append)
    assert [(one.kind, one.at_ms) for one in found] == [
        ("vehicle_holds", 1250), ("vehicle_resumes", 1250),
    ]  # fmt: skip
    assert orders.mission is not None
    assert orders.mission.changes == found
    assert [bool(one["directed"]["refused"]) for one in told] == [False, True, False]
    assert "too far" in told[1]["directed"]["refused"]
    assert loaded(parse_document(told[2]["directed"]["text"], "m.yaml")).changes == found
    assert orders.due(1500, told.append) == ()


@pytest.mark.slow
def test_a_flight_obeys_at_once_and_is_that_of_the_mission_that_it_writes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with _flown_in_browser(tmp_path) as (live, page):
        number = live.told()["flight"]
        page.click("#fly")
        page.until(f"{STATE} === 'flying' && Number(document.getElementById('slider').max) > 1000")
        page.value("document.activeElement.blur()")
        page.key("u")
        _choose(page, "hold_at")
        page.until("document.getElementById('operate-hint').textContent.startsWith('Click')")
        page.click("#map")
        page.until("document.getElementById('confirm-command').open")
        assert "without stopping" in page.text("command-text")
        page.value("document.getElementById('command-vehicle').value = 1")
        # in feet above the ground, which is 0 m; 60 m are two vertical thresholds
        assert page.text("command-alt-unit") == "ft"
        assert page.text("command-alt-note").startswith(
            "Left empty: the altitude that it has then."
        )
        for wrong in ("150", "-3", "400000"):
            _type(page, "command-alt", wrong)
            assert page.value("document.getElementById('command-yes').disabled"), wrong
            assert "more than 60 m (197 ft), 100000 m" in page.text("command-alt-note")
        _type(page, "command-alt", "1050")
        assert page.text("command-alt-note").startswith(
            "320 m (1050 ft) above mean sea level, 320 m"
        )
        page.click("#command-yes")
        page.until(
            "document.getElementById('live-text').textContent.includes('it circles through')"
        )
        page.until("document.getElementById('events').textContent.includes('commanded to hold at')")
        page.until("document.getElementById('events').textContent.includes(', altitude 320 m')")
        assert page.text("live-state") == "flying"  # it went on all the while
        _choose(page, "resume")
        page.until("document.getElementById('confirm-command').open")
        page.value("document.getElementById('command-vehicle').value = 1")
        page.click("#command-yes")
        page.until("document.getElementById('events').textContent.includes('to resume its plan')")
        assert live.told()["flight"] == number  # nothing was flown anew
        assert page.logged == []
        live.order("a", do="take")
        live.order("a", do="rate", rate=1000)
        assert live.until("ended", "failed", "lost")["state"] == "ended"
    results = tmp_path / "live" / "crossing"
    assert main(["certify", str(results)]) in (0, 1)
    assert "no file of the results" not in capsys.readouterr().err
    report = json.loads((results / "report.json").read_text(encoding="utf-8"))
    assert [one["kind"] for one in report["mission"]["changes"]] == [
        "vehicle_holds", "vehicle_resumes",
    ]  # fmt: skip
    _same_when_flown_again(tmp_path, report)
    capsys.readouterr()


@contextmanager
def _flown_in_browser(tmp_path: Path) -> Iterator[tuple[Served, Page]]:
    """SHORT, planned and standing at its begin, and the page that commands it."""
    mission = tmp_path / "crossing.yaml"
    mission.write_text(SHORT, encoding="utf-8")
    with flying(mission, tmp_path / "live") as live, browsing(tmp_path / "profile") as page:
        page.go(live.url)
        page.until(STANDS)
        yield live, page


def _same_when_flown_again(tmp_path: Path, report: dict[str, Any]) -> None:
    """The mission that was written with the commands gives the same log."""
    assert report["command"].endswith("mission.yaml --out again")
    written = tmp_path / "live" / "crossing" / "mission.yaml"
    assert (
        main(["run", str(written), "--quiet", "--out", str(tmp_path / "again")])
        == report["exit_code"]
    )
    second = json.loads((tmp_path / "again" / "crossing" / "report.json").read_text("utf-8"))
    assert second["log"]["digest"] == report["log"]["digest"]


def _type(page: Page, name: str, text: str) -> None:
    page.value(
        f"(i => {{ i.value = '{text}'; i.dispatchEvent(new Event('input')); }})"
        f"(document.getElementById('{name}'))"
    )


def _choose(page: Page, what: str) -> None:
    page.value(
        f"(s => {{ s.value = '{what}'; s.dispatchEvent(new Event('change')); }})"
        "(document.getElementById('operate'))"
    )


@pytest.mark.slow
def test_a_flight_with_a_command_is_that_of_the_mission_that_it_writes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with _flown_in_browser(tmp_path) as (live, page):
        page.click("#fly-step")
        page.until("Number(document.getElementById('slider').max) === 1000")
        before = live.told()["updates"]
        _choose(page, "go_to")
        page.until("document.getElementById('operate-hint').textContent.startsWith('Click')")
        page.click("#map")
        page.until("document.getElementById('confirm-command').open")
        page.value("document.getElementById('command-vehicle').value = 2")
        page.click("#command-yes")
        # it is flown anew up to the command, and stands there
        page.until("document.getElementById('events')?.textContent.includes('task 3 is requested')")
        page.until(STANDS)
        assert page.text("live-who") == "This page commands the flight."
        again = live.told()["updates"]
        assert _rows(again)[: len(_rows(before))] == _rows(before)  # what was flown is the same
        assert live.order("a", do="command", command={"what": "drop_task", "id": 1}).status == 409
        assert live.order("a", do="take").status == 200
        wrong = live.order("a", do="command", command={"what": "drop_task", "id": 9})
        assert (wrong.status, "9" in wrong.data()["error"]) == (422, True)
        assert live.until("paused")["state"] == "paused"  # nothing has happened to the flight
        live.order("a", do="rate", rate=1000)
        live.order("a", do="play")
        assert live.until("ended", "failed", "lost")["state"] == "ended"
        assert page.logged == []
    results = tmp_path / "live" / "crossing"
    report = json.loads((results / "report.json").read_text(encoding="utf-8"))
    assert "by the operator" in (results / "mission.yaml").read_text(encoding="utf-8")
    _same_when_flown_again(tmp_path, report)
    capsys.readouterr()


def _rows(updates: list[Any]) -> list[Any]:
    return [row for one in updates for row in one.get("tracks", {}).get("2", ())]
