"""The ground station's server over loopback: what it gives out, to whom, and what it refuses."""

from __future__ import annotations

import hashlib
import json
import mimetypes
import shutil
import signal
import socket
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

import pytest
from ground_station_tools import LIMIT_S, PAGE, ask, page_files, serving
from simulator_tools import mission, scenario, waypoint

from cratous.services.cli import main
from cratous.services.ground_station.access import Access
from cratous.services.ground_station.page_data import ReadAnew
from cratous.services.ground_station.recording import recording
from cratous.services.ground_station.server import GroundStation
from cratous.services.ground_station.verdicts import NO_REPORT, OTHER_LOG
from cratous.services.web import connection
from cratous.services.web.connection import MOST_SILENT
from cratous.spec.errors import BadInput

KINDS = {
    ".html": "text/html; charset=utf-8", ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8", ".svg": "image/svg+xml", ".png": "image/png",
}  # fmt: skip
LEAFLET = "/vendor/leaflet/"
LEAFLET_NAMES = (
    b'"http://www.w3.org/2000/svg"', b"https://leafletjs.com", b"http://www.w3.org/2000/svg",
    b"https://bugs.chromium.org/", b"https://bugzilla.mozilla.org/",
)  # fmt: skip


@pytest.fixture(scope="module")
def port(crossing: Path) -> Iterator[int]:
    with serving(crossing) as (_, port):
        yield port


def test_the_page_and_all_that_it_names_are_there(port: int) -> None:
    page = ask(port, "/")
    assert page.status == 200
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert page.body == (PAGE / "index.html").read_bytes()
    named = {path for path in page_files() if f'"{path}"'.encode() in page.body}
    assert named == {
        "/main.js", "/station.css", "/icon.svg", f"{LEAFLET}leaflet.js", f"{LEAFLET}leaflet.css",
    }  # fmt: skip
    for path, file in page_files().items():
        got = ask(port, path)
        assert got.status == 200
        assert got.headers["content-type"] == KINDS[file.suffix], path
        assert got.body == file.read_bytes()
        assert int(got.headers["content-length"]) == len(got.body) > 100


def test_a_file_that_a_browser_has_is_not_sent_again_and_parts_of_it_are(port: int) -> None:
    first = ask(port, "/main.js")
    again = ask(port, "/main.js", If_None_Match=first.headers["etag"])
    assert (again.status, again.body) == (304, b"")
    part = ask(port, "/main.js", Range="bytes=10-19")
    assert (part.status, part.body) == (206, first.body[10:20])


def test_what_a_file_is_does_not_hang_on_the_machine_s_own_tables(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Some of them call JavaScript plain text, which no browser runs then."""
    for end in KINDS:
        monkeypatch.setitem(mimetypes.types_map, end, "text/plain")
    with GroundStation(ReadAnew(dict), 0, Access()):
        for end, kind in KINDS.items():
            assert mimetypes.guess_type(f"a/vendor/b{end}")[0] == kind.partition(";")[0]


def test_nothing_of_the_page_comes_from_elsewhere() -> None:
    for path, file in {**page_files(), **{page.name: page for page in PAGE.glob("*.html")}}.items():
        # names of a namespace and of a home page, which are fetched by nobody
        body = file.read_bytes()
        for name in (b'"http://www.w3.org/2000/svg"', *(LEAFLET_NAMES if LEAFLET in path else ())):
            body = body.replace(name, b"")
        assert b"http" not in body.lower(), path


def test_leaflet_is_as_it_was_published_with_its_licence() -> None:
    folder = files("cratous.services.ground_station").joinpath("page/vendor")
    told = folder.joinpath("SOURCES").read_text(encoding="utf-8")
    for name in ("leaflet.js", "leaflet.css"):
        digest = hashlib.sha256(folder.joinpath("leaflet", name).read_bytes()).hexdigest()
        assert [name, digest] in [line.split() for line in told.splitlines()]
    licence = folder.joinpath("leaflet/LICENSE").read_text(encoding="utf-8")
    assert licence.startswith(
        "BSD 2-Clause License\n\nCopyright (c) 2010-2023, Volodymyr Agafonkin"
    )


def test_every_answer_has_the_headers_that_keep_others_out(port: int) -> None:
    for got in (ask(port, "/"), ask(port, "/recording.json"), ask(port, "/none")):
        policy = got.headers["content-security-policy"]
        assert policy.startswith("default-src 'none'; script-src 'self';")
        assert "unsafe" not in policy
        assert "frame-ancestors 'none'" in policy
        assert got.headers["x-content-type-options"] == "nosniff"
        assert got.headers["cache-control"] == "no-store"
        assert "access-control-allow-origin" not in got.headers


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{}", "127.0.0.1", "127.0.0.1:1"])
def test_another_name_in_host_is_refused(port: int, host: str) -> None:
    for path in ("/", "/recording.json"):
        got = ask(port, path, Host=host.format(port))
        assert got.status == 421
        assert b"answers to no other name" in got.body
    assert ask(port, "/", Host=f"localhost:{port}").status == 200


@pytest.mark.parametrize(
    "path", ["/none", "/../server.py", "/page/main.js", "//etc/passwd", "/%2e%2e/server.py", "*"]
)
def test_no_other_path_gives_anything(port: int, path: str) -> None:
    got = ask(port, path)
    assert got.status == 404
    assert got.data() == {"error": "there is no such page"}


def test_it_takes_nothing(port: int) -> None:
    for method in ("POST", "PUT", "DELETE", "OPTIONS", "NONSENSE"):
        assert ask(port, "/", method).status == 405
    assert ask(port, "/", "HEAD").body == b""


def test_when_a_vehicle_takes_no_part_is_what_the_mission_says(popup: Path) -> None:
    lost = {"vehicle": 2, "from_ms": 60_000, "to_ms": None, "why": "lost"}
    assert recording(popup)["absences"] == [lost]


def test_a_recording_is_what_the_flight_s_report_says(port: int, crossing: Path) -> None:
    got = ask(port, "/recording.json", Accept_Encoding="gzip")
    assert got.headers["content-encoding"] == "gzip"
    found = got.data()
    assert found == ask(port, "/recording.json").data()
    report = json.loads((crossing / "report.json").read_text())
    for key in ("tracks", "takeovers", "authority", "events", "end_ms", "outcome"):
        assert found[key] == report["flight"][key], key
    assert found["verdicts"]["overall"] == report["verdict"]
    for name in ("requirements", "constraints"):
        shown = found["verdicts"]["details" if name == "constraints" else name]
        assert [(r["requirement"], r["item"], r["verdict"], r["margin"]) for r in shown] == [
            (r["requirement"], r["item"], r["verdict"], r["margin"]) for r in report[name]
        ]
    # what ICAROUS commands in a takeover are no routes, so that of UxAS stays
    assert {route["vehicle"] for route in found["routes"]} == {1, 2}
    assert all(len(route["points"]) > 1 for route in found["routes"])
    assert any(route["sender"] == "UxAS" for route in found["routes"])
    assert found["unread"] == 0
    assert [link["alive"] for link in found["links"]] == [True, True]


def test_a_log_alone_has_no_verdicts(crossing: Path) -> None:
    found = recording(crossing / "log.sqlite")
    assert found["verdicts"] == {"why_none": NO_REPORT}
    assert found["takeovers"]


def test_a_report_of_another_log_gives_no_verdicts(crossing: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(crossing, folder)
    report = json.loads((folder / "report.json").read_text())
    report["log"]["digest"] = "0" * 64
    (folder / "report.json").write_text(json.dumps(report))
    assert recording(folder)["verdicts"] == {"why_none": OTHER_LOG}


def test_verdicts_are_not_shown_beside_a_log_that_was_changed(
    crossing: Path, tmp_path: Path
) -> None:
    changed = shutil.copytree(crossing, tmp_path / "changed")
    with sqlite3.connect(changed / "log.sqlite") as base:
        base.execute("UPDATE messages SET body = replace(body, '300.0', '310.0') WHERE seq > 50")
    with pytest.raises(BadInput, match="not those that were logged"):
        recording(changed)


def test_a_damaged_report_is_named(crossing: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(crossing, folder)
    report = json.loads((folder / "report.json").read_text())
    report["constraints"][3]["verdict"] = 7
    (folder / "report.json").write_text(json.dumps(report))
    with pytest.raises(BadInput, match=r"report\.json") as caught:
        recording(folder)
    assert caught.value.item == "constraints[3].verdict"


def test_a_log_of_others_shows_what_its_messages_tell(crossing: Path, tmp_path: Path) -> None:
    """Without the mission: positions, routes and events; authority and links are not in the log."""
    told = tmp_path / "told.jsonl"
    words = ["--type", "AirVehicleState", "--type", "AutomationResponse"]
    assert main(["log", "export", str(crossing), *words, "-o", str(told)]) == 0
    found, full = recording(told), recording(crossing)
    assert found["authority"] is found["links"] is None
    assert {vehicle["id"] for vehicle in found["vehicles"]} == {1, 2}
    assert {route["vehicle"] for route in found["routes"]} == {1, 2}
    assert [event["text"].split()[0] for event in found["events"]] == ["AutomationResponse"]
    # another origin, the same ways: lengths of the two tracks agree
    for number in ("1", "2"):
        (a, b), (c, d) = ((r["tracks"][number][0], r["tracks"][number][-5]) for r in (found, full))
        assert b[1] - a[1] == pytest.approx(d[1] - c[1], abs=25)
        assert b[2] - a[2] == pytest.approx(d[2] - c[2], abs=25)


def test_a_capture_without_times_is_shown_by_the_clock_in_its_messages(tmp_path: Path) -> None:
    file, told = tmp_path / "scenario.xml", tmp_path / "told.bin"
    file.write_text(scenario(mission(waypoint(1, 2, 45.02), waypoint(2, 2, 45.1))))
    assert main(["sim", str(file), "--until", "30", "-o", str(told)]) == 0
    found = recording(told)
    assert found["log"]["kind"] == "frames"
    ((_, track),) = found["tracks"].items()
    assert len(track) >= 28
    assert [row[0] for row in track] == sorted({row[0] for row in track})
    assert 25_000 < found["end_ms"] <= 31_000
    assert {len(route["points"]) for route in found["routes"]} == {2}


def test_what_is_nowhere_and_what_cannot_be_decoded_is_not_drawn(tmp_path: Path) -> None:
    """A latitude of 200 degrees, a zone that is text, a route without waypoints."""
    log = tmp_path / "told.jsonl"
    place = {"$type": "CMASI/Location3D", "Latitude": 45.0, "Longitude": 9.0, "Altitude": 100.0}
    bodies: list[tuple[str, dict[str, object]]] = [
        ("AirVehicleState", {"ID": 1, "Location": {**place, "Latitude": 200.0}}),
        ("AirVehicleState", {"ID": 1, "Location": place}),
        ("AirVehicleState", {"ID": 2, "Location": {**place, "Latitude": -91.0}}),
        ("MissionCommand", {"VehicleID": 1, "WaypointList": [place, place]}),
        ("MissionCommand", {"VehicleID": 1, "WaypointList": []}),
        ("KeepOutZone", {"$text": "text"}),
        ("AirVehicleState", {"$text": "text"}),
    ]
    log.write_text(
        "".join(
            json.dumps(
                {"seq": k, "time_ms": 1000 * k, "source": "a", "topic": f"afrl.cmasi.{name}",
                 "body": body if "$text" in body else {"$type": f"CMASI/{name}", **body}}
            ) + "\n"
            for k, (name, body) in enumerate(bodies)
        )
    )  # fmt: skip
    found = recording(log)
    assert found["tracks"] == {"1": [[1000, 0.0, 0.0, 100.0, -1]]}
    assert [(r["time_ms"], len(r["points"])) for r in found["routes"]] == [(3000, 2), (4000, 0)]
    assert found["zones"] == []
    assert found["unread"] == 2


def test_a_damaged_log_is_told_in_the_page_s_answer_and_on_stderr(
    crossing: Path, tmp_path: Path
) -> None:
    log = tmp_path / "log.sqlite"
    shutil.copy(crossing / "log.sqlite", log)
    with sqlite3.connect(log) as database:
        (seq,) = database.execute(
            "SELECT max(seq) FROM messages WHERE topic = 'cratous.TaskProgress'"
        ).fetchone()
        database.execute("UPDATE messages SET body = '{\"Time\":1}' WHERE seq = ?", (seq,))
    with serving(log) as (running, port):
        got = ask(port, "/recording.json")
        assert got.status == 422
        told = got.data()
        assert told["error"] == "a field is missing"
        assert told["where"] == f"{log}, message {seq} (cratous.TaskProgress)"
        assert ask(port, "/").status == 200
        running.send_signal(signal.SIGTERM)
        _, said = running.communicate(timeout=LIMIT_S)
        assert f"message {seq} (cratous.TaskProgress)" in said
        assert running.returncode == 0


def test_what_is_no_log_is_refused_before_anything_listens(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["serve", str(tmp_path / "none")]) == 2
    (tmp_path / "text").write_text("not a log")
    assert main(["serve", str(tmp_path / "text")]) == 2
    assert "not a message log" in capsys.readouterr().err


def test_a_port_in_use_is_refused(crossing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert main(["serve", str(crossing), "--port", str(taken.getsockname()[1])]) == 2
    assert "cannot listen there" in capsys.readouterr().err


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The port of a server in this process that gives its clients an hour for a request."""
    monkeypatch.setattr(connection, "REQUEST_S", 3600.0)
    with GroundStation(ReadAnew(dict), 0, Access()) as server:
        serving = threading.Thread(target=server.serve_forever)
        serving.start()
        try:
            yield server.port
        finally:
            server.shutdown()
            serving.join(LIMIT_S)


def test_silent_clients_hold_up_nobody(patient: int) -> None:
    silent = [socket.create_connection(("127.0.0.1", patient)) for _ in range(20)]
    assert ask(patient, "/").status == 200
    for one in silent:
        one.close()


def test_who_floods_it_and_asks_nothing_is_cut_off(patient: int) -> None:
    """More than it takes at once: the oldest go, long before their time is over, and who asks is answered."""
    flood = []
    for k in range(3 * MOST_SILENT):
        flood.append(socket.create_connection(("127.0.0.1", patient)))
        if k % 3:  # some begin a request, or the head of a command, and never end it
            with suppress(ConnectionError):  # it may be the oldest by then
                flood[-1].sendall(b"GET / HT" if k % 3 == 1 else b"POST /command HTTP/1.0\r\n")
    for _ in range(5):
        assert ask(patient, "/").status == 200
    flood[0].settimeout(LIMIT_S)
    with suppress(ConnectionResetError):
        assert flood[0].recv(1) == b""
    for one in flood:
        one.close()


def test_ctrl_c_ends_it(crossing: Path) -> None:
    with serving(crossing) as (running, port):
        assert ask(port, "/recording.json").status == 200
        running.send_signal(signal.SIGINT)
        assert running.wait(timeout=LIMIT_S) == 0
