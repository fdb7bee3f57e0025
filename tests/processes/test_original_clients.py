"""A flight in processes with the original's clients: UxAS waits for them, and no ICAROUS is started."""

from __future__ import annotations

import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cratous.bridge.text_protocol import Dialect
from cratous.bridge.text_protocol.keys import KEY_VARIABLE, Keys, key_of, new_keys
from cratous.services.cli import main
from cratous.services.cli.job import InProcesses
from cratous.services.cli.processes_job import as_flown
from cratous.services.icarous_communication.settings import ATTRIBUTES, settings_of
from cratous.services.loading import load
from cratous.services.loading.uxas_settings import read, values_of
from cratous.services.processes import flight as flights
from cratous.services.processes.children import Children
from cratous.services.processes.files import CLIENTS_S, ORIGINAL_PORT, Ports, write_configuration
from cratous.spec.mission import Mission


@pytest.fixture(scope="module")
def crossing(root: Path) -> Mission:
    return load(root / "examples/crossing/mission.yaml", 0)


@pytest.mark.parametrize("original", [True, False])
def test_uxas_s_end_speaks_with_who_is_there(
    crossing: Mission, tmp_path: Path, original: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in new_keys(crossing.instances).environment().items():
        monkeypatch.setenv(name, text)
    ports = Ports(1001, 1002, ORIGINAL_PORT)
    cfg = write_configuration(crossing, crossing.instances, ports, tmp_path, original)
    (entry,) = (e for e in read(cfg).entries if e.type == "IcarousCommunicationService")
    values = values_of(ATTRIBUTES, entry.attributes, str(cfg), entry.type, [])
    settings = settings_of(entry, values)
    assert (settings.instances, settings.ids, settings.where.port) == (2, (1, 2), 5557)
    assert settings.dialect is (Dialect.ORIGINAL if original else Dialect.CRATOUS)
    assert (settings.keys is None) is original
    assert (settings.wait_s == CLIENTS_S) is original


@pytest.mark.parametrize("original", [True, False])
def test_no_icarous_is_started_where_clients_are_waited_for(
    crossing: Mission, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, original: bool
) -> None:
    told, started, had = list[str](), dict[str, tuple[str, ...]](), dict[str, Keys]()
    plan: Any = SimpleNamespace(items=[])
    how: Any = SimpleNamespace(
        tell=told.append, folder=tmp_path, path=tmp_path, digest="0" * 64, rate=1.0,
        allow_unproved=True, original=original, amase=None, direct=None,
    )  # fmt: skip
    nobody: Any = SimpleNamespace()
    one = flights._Flight(crossing, plan, nobody, SimpleNamespace(accepted=id), how, nobody)  # type: ignore[arg-type]
    monkeypatch.setattr(flights, "write_scenario", lambda *_: tmp_path)
    monkeypatch.setattr(flights, "write_messages", lambda *_: None)
    one._start_simulator = lambda _: 1  # type: ignore[method-assign]
    one._connect = lambda _: nobody  # type: ignore[method-assign]
    one._wait = one._control = lambda *_: None  # type: ignore[assignment,method-assign]

    def start(name: str, *words: str, keys: Keys = Keys({}), **_: object) -> None:
        started[name], had[name] = words, keys

    one._start = start  # type: ignore[method-assign]
    one.start()
    assert set(started) == ({"uxas"} if original else {"uxas", "icarous_1", "icarous_2"})
    for name, words in started.items():
        # a mission that was changed since is not flown
        assert (("--mission-hash", how.digest) in pairwise(words)) is (name != "uxas")
        assert not {"--plain", "--original", "--thesis"} & set(words)
    # each ICAROUS has its own key, UxAS that of each; the clients' protocol has none
    of_uxas = had["uxas"].by_vehicle
    assert sorted(of_uxas) == ([] if original else [1, 2])
    assert len(set(of_uxas.values())) == len(of_uxas)
    for vehicle, key in of_uxas.items():
        assert had[f"icarous_{vehicle}"].by_vehicle == {vehicle: key}
    asks = [text for text in told if text.startswith("start the original's clients")]
    assert len(asks) == original
    assert not original or asks[0].endswith("for vehicle 1, then 2: UxAS waits for 2")
    assert (one.ports.icarous == ORIGINAL_PORT) is original


def test_a_process_has_the_keys_that_it_is_given_and_no_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys, others = new_keys([1, 2]), new_keys([1, 2, 3])
    for name, text in others.environment().items():
        monkeypatch.setenv(name, text)
    with Children(tmp_path, tmp_path) as children:
        found = {}
        for number, given in ((2, keys.of(2)), (0, Keys({}))):
            pid = children.start(f"one_{number}", "version", private=given.environment())
            # Empty until the kernel has set up the new program.
            limit_s = time.monotonic() + 60
            while not (text := Path(f"/proc/{pid}/environ").read_text()):
                assert time.monotonic() < limit_s
            fields = (field.partition("=") for field in text.split("\0"))
            found[number] = {name: value for name, _, value in fields if "BRIDGE_KEY" in name}
            assert keys.by_vehicle[2].hex() not in Path(f"/proc/{pid}/cmdline").read_text()
    assert found == {2: {KEY_VARIABLE.format(2): keys.by_vehicle[2].hex()}, 0: {}}
    monkeypatch.setenv(KEY_VARIABLE.format(2), found[2][KEY_VARIABLE.format(2)])
    assert key_of(2, None) == keys.by_vehicle[2]
    assert keys.by_vehicle[2].hex() not in f"{keys!r} {keys.of(2)!r}"


def test_the_report_does_not_say_which_icarous_flew(crossing: Mission) -> None:
    mission = replace(crossing, notes=())
    (ours, _), (theirs, _) = (
        as_flown(mission, InProcesses()).notes,
        as_flown(mission, InProcesses(original=True)).notes,
    )
    assert "and 2 of ICAROUS" in ours
    assert "2 clients of the original's; which ICAROUS is behind them is not known here" in theirs


def test_it_is_of_processes_alone(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = str(root / "examples/crossing/mission.yaml")
    assert main(["run", mission, "--original-clients"]) == 2
    assert "--original-clients is of --processes" in capsys.readouterr().err
