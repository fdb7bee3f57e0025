"""`cratous serve --host`: another address than 127.0.0.1, where whatever is asked needs a token."""

from __future__ import annotations

import http.client
import json
from collections.abc import Iterator
from email.message import Message
from pathlib import Path
from typing import NamedTuple

import pytest
from chromium_tools import browsing
from ground_station_tools import LIMIT_S, Got, serving_at

from cratous.services.cli import main
from cratous.services.ground_station.access import ENVIRONMENT, TOKEN, Access, access_of
from cratous.spec.errors import BadInput

ROOT = Path(__file__).resolve().parents[2]
HOST = "127.0.0.2"
"""Of this machine alone too, yet not where it listens by itself."""
OWN = "a-token-of-my-own_1"


class Place(NamedTuple):
    """A server, and the tokens in the address that it printed."""

    port: int
    access: str
    commands: str = ""

    def ask(self, path: str, method: str = "GET", body: bytes = b"", /, **headers: str) -> Got:
        line = http.client.HTTPConnection(HOST, self.port, timeout=LIMIT_S)
        try:
            named = {name.replace("_", "-"): value for name, value in headers.items()}
            line.request(method, path, body or None, named)
            answer = line.getresponse()
            found = {name.lower(): value for name, value in answer.getheaders()}
            return Got(answer.status, found, answer.read())
        finally:
            line.close()

    def cookie(self, token: str | None = None) -> str:
        return f"cratous_access_{self.port}={self.access if token is None else token}"

    def sent(self, path: str, asked: object, **changed: str) -> Got:
        """A command as the page sends it, but for the headers that are changed."""
        headers = {
            "Origin": f"http://{HOST}:{self.port}", "Content-Type": "application/json",
            "X-Cratous-Token": self.commands, "X-Cratous-Page": "a", "Cookie": self.cookie(),
            **{name.replace("_", "-"): value for name, value in changed.items()},
        }  # fmt: skip
        return self.ask(path, "POST", json.dumps(asked).encode(), **headers)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A message log of one state."""
    place = {"$type": "CMASI/Location3D", "Latitude": 45.0, "Longitude": 9.0, "Altitude": 100.0}
    body = {"$type": "CMASI/AirVehicleState", "ID": 1, "Location": place}
    entry = {"seq": 0, "time_ms": 0, "source": "a", "topic": "afrl.cmasi.AirVehicleState"}
    file = tmp_path_factory.mktemp("log") / "told.jsonl"
    file.write_text(json.dumps({**entry, "body": body}) + "\n")
    return file


@pytest.fixture(scope="module")
def replay(log: Path) -> Iterator[Place]:
    with serving_at(HOST, str(log)) as (port, said):
        assert set(said) == {"access"}
        yield Place(port, said["access"])


@pytest.fixture(scope="module")
def editor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    mission = tmp_path_factory.mktemp("edited") / "mission.yaml"
    mission.write_bytes((ROOT / "examples/crossing/mission.yaml").read_bytes())
    with serving_at(HOST, str(mission), "--edit", "--allow-unproved") as (port, said):
        yield Place(port, said["access"], said["token"])


@pytest.mark.parametrize(
    "path", ["/", "/main.js", "/icon.svg", "/recording.json", "/live.json?from=0", "/none",
             "/overlays.json?latitude=45&longitude=9", "/planned.json"],
)  # fmt: skip
def test_without_the_token_nothing_is_given_out(replay: Place, path: str) -> None:
    wrong = f"{replay.access[:-1]}{'A' if replay.access[-1] != 'A' else 'B'}"
    for headers in (
        {}, {"Cookie": replay.cookie(wrong)}, {"Cookie": f"other={replay.access}"},
        {"Cookie": replay.cookie("")}, {"Authorization": f"Bearer {wrong}"},
        {"Authorization": "Bearer "}, {"Authorization": replay.access},
        {"X_Cratous_Token": replay.access},
    ):  # fmt: skip
        got = replay.ask(path, **headers)
        assert got.status == 401, headers
        assert list(got.data()) == ["error"]
        assert got.headers["www-authenticate"] == "Bearer"
        assert got.headers["content-security-policy"].startswith("default-src 'none'")
        assert "set-cookie" not in got.headers
        assert replay.access.encode() not in got.body
    sign = "&" if "?" in path else "?"
    assert replay.ask(f"{path}{sign}access={wrong}").status == 401
    assert replay.ask(f"{path}{sign}access=%C3%BC").status == 401
    assert replay.ask(path, "HEAD").status == 401


def test_the_address_that_is_printed_lets_in_and_is_remembered_by_a_cookie(replay: Place) -> None:
    assert TOKEN.fullmatch(replay.access)
    first = replay.ask(f"/?access={replay.access}")
    assert first.status == 200
    kept = first.headers["set-cookie"]
    assert kept == f"{replay.cookie()}; Path=/; HttpOnly; SameSite=Strict"
    for path in ("/", "/main.js", "/recording.json"):
        got = replay.ask(
            path, Cookie=f"a=b c; x; {replay.cookie()}; é=1".encode().decode("latin-1")
        )
        assert got.status == 200
        assert "set-cookie" not in got.headers
    assert replay.ask("/none", Cookie=replay.cookie()).status == 404
    assert replay.ask("/recording.json", Authorization=f"Bearer {replay.access}").status == 200


def test_the_name_it_is_called_by_still_counts(replay: Place) -> None:
    for name in (f"{HOST}:{replay.port}", f"localhost:{replay.port}"):
        assert replay.ask("/", Host=name, Cookie=replay.cookie()).status == 200
    for name in ("evil.example", f"evil.example:{replay.port}", HOST, f"127.0.0.9:{replay.port}"):
        assert replay.ask("/", Host=name, Cookie=replay.cookie()).status == 421


def test_a_replay_still_takes_nothing(replay: Place) -> None:
    assert replay.sent("/command", {}, Cookie="").status == 401
    assert replay.sent("/command", {}).status == 501


def test_editing_needs_both_tokens_and_its_own_page(editor: Place) -> None:
    asked = {"text": "name: x\n"}
    assert editor.commands not in {"", editor.access}
    assert editor.sent("/sketch", asked).status == 200
    assert editor.sent("/sketch", asked, Cookie="").status == 401
    assert editor.sent("/sketch", asked, Cookie=editor.cookie(editor.commands)).status == 401
    assert editor.sent(f"/sketch?access={editor.access}", asked, Cookie="").status == 404
    assert editor.sent("/sketch", asked, X_Cratous_Token="wrong").status == 403
    assert editor.sent("/sketch", asked, X_Cratous_Token=editor.access).status == 403
    for origin in ("http://evil.example", f"http://127.0.0.1:{editor.port}", "null"):
        got = editor.sent("/sketch", asked, Origin=origin)
        assert (got.status, got.data()["error"]) == (403, "commands come from this page alone")
    assert editor.sent("/sketch", asked, Host="evil.example").status == 421
    assert editor.ask("/planned.json").status == 401
    assert editor.ask("/planned.json", Cookie=editor.cookie()).data() == {"state": "none"}


def test_the_updates_of_a_flight_need_the_token(tmp_path: Path) -> None:
    words = (str(ROOT / "examples/crossing/mission.yaml"), "--out", str(tmp_path))
    with serving_at(HOST, *words) as (port, said):
        flight = Place(port, said["access"], said["token"])
        assert flight.ask("/live.json?from=0", X_Cratous_Token=flight.commands).status == 401
        told = flight.ask("/live.json?from=0", Cookie=flight.cookie(), X_Cratous_Page="a")
        assert told.status == 200
        assert told.data()["who"] == "watch"
        assert flight.sent("/command", {"do": "stop"}, Cookie="").status == 401
        assert flight.sent("/command", {"do": "stop"}, X_Cratous_Token="").status == 403


def test_a_token_of_a_file_or_of_the_environment_is_not_printed(log: Path, tmp_path: Path) -> None:
    file = tmp_path / "token"
    file.write_text(f"{OWN}\n")
    with serving_at(HOST, str(log), "--access-token-file", str(file)) as (port, said):
        assert said == {}
        assert Place(port, OWN).ask(f"/?access={OWN}").status == 200
        assert Place(port, OWN).ask("/").status == 401
    # asked for, it is needed on 127.0.0.1 too
    with serving_at("127.0.0.1", str(log), **{ENVIRONMENT: OWN}) as (port, said):
        assert said == {}
        line = http.client.HTTPConnection("127.0.0.1", port, timeout=LIMIT_S)
        line.request("GET", "/recording.json")
        assert line.getresponse().status == 401
        line.close()


@pytest.mark.parametrize("token", ["short", "fifteen-letters", "a b" * 9, "ä" * 20, "a" * 201, ""])
def test_what_is_no_token_is_refused_and_not_shown(
    log: Path, tmp_path: Path, token: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "token"
    file.write_text(token, encoding="utf-8")
    assert main(["serve", str(log), "--host", HOST, "--access-token-file", str(file)]) == 2
    said = capsys.readouterr().err
    assert "not a token" in said
    assert f"{len(token)} characters" in said
    assert not token or token not in said
    assert main(["serve", str(log), "--access-token-file", str(tmp_path / "none")]) == 2
    assert "there is no such file" in capsys.readouterr().err


@pytest.mark.parametrize("host", ["", "no host", "256.1.1.1", "host.invalid"])
def test_what_is_no_address_is_refused(
    log: Path, host: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["serve", str(log), "--host", host]) == 2
    assert "no such address" in capsys.readouterr().err


def test_an_address_of_another_machine_cannot_be_listened_on(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["serve", str(log), "--host", "192.0.2.1"]) == 2
    assert "cannot listen there" in capsys.readouterr().err


def test_by_which_names_it_may_be_called(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("socket.gethostname", lambda: "Station")
    near = ("192.0.2.7", 8760)
    everywhere = Access("0.0.0.0", OWN, told=True)
    assert everywhere.whole_url(8760, "c") == f"http://Station:8760/?access={OWN}&token=c"
    for host in ("station:8760", "STATION:8760", "192.0.2.7:8760", "localhost:8760"):
        assert everywhere.called([host], near, 8760)
    for host in ("192.0.2.8:8760", "evil.example:8760", "station", "station:1", ""):
        assert not everywhere.called([host], near, 8760)
    assert not everywhere.called([], near, 8760)
    assert not everywhere.called(["station:8760", "station:8760"], near, 8760)
    # a browser leaves out the port of HTTP
    assert everywhere.called(["station"], near, 80)
    wide = Access("::1", OWN)
    assert wide.url(8760) == "http://[::1]:8760/"
    assert wide.called(["[::1]:8760"], ("::1", 8760, 0, 0), 8760)
    assert Access().whole_url(8760, "") == "http://127.0.0.1:8760/"


def test_every_new_token_is_another_one_and_this_machine_alone_needs_none() -> None:
    one, other = access_of(HOST, None), access_of(HOST, None)
    assert one.token != other.token
    assert len(one.token) >= 32
    assert one.told
    assert (access_of("127.0.0.1", None).token, access_of("127.0.0.1", None).told) == ("", False)
    assert access_of("localhost", None).token
    with pytest.raises(BadInput, match="no such address"):
        Access("")
    assert one.shown_by(Message(), "", 8760) is None


@pytest.mark.slow
def test_a_browser_is_let_in_by_the_printed_address_alone(replay: Place, tmp_path: Path) -> None:
    with browsing(tmp_path / "profile") as page:
        own = f"http://{HOST}:{replay.port}/"
        page.go(own)
        page.until("document.body?.textContent.includes('needs the token')")
        page.logged.clear()
        page.go(f"{own}?access={replay.access}&x=1#t=0")
        page.until("document.querySelector('#aircraft tr')")
        # it is in no address that is given to others, and no script can read it
        assert page.value("location.search") == "?x=1"
        assert page.value("document.cookie") == ""
        page.go(own)
        page.until("document.querySelector('#aircraft tr')")
        assert page.logged == []
