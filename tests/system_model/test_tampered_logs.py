"""Logs of the examples fit the model; whatever is changed in one is named, at the first event that does not fit."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from tampering import (
    Log,
    after_the_end,
    alter,
    at,
    copy_to,
    cut_short,
    days_later,
    deaf,
    make,
    remove,
    send_as,
    strike,
    swap,
    time_goes_back,
)

from cratous.services.bus import Envelope
from cratous.services.certify.rejudge import subject
from cratous.services.cli import main
from cratous.services.logs.log import LogWriter, read_envelopes, read_meta
from cratous.services.system_model.replay import Replayed, replay

FlyOnce = Callable[[Path], Path]
EXAMPLES = (
    "crossing",
    "popup",
    pytest.param("relations", marks=pytest.mark.long),
    pytest.param("search", marks=pytest.mark.long),
    pytest.param("partial", marks=pytest.mark.long),
)


def log_of(fly_once: FlyOnce, root: Path, name: str) -> Path:
    return fly_once(root / "examples" / name / "mission.yaml") / "log.sqlite"


@cache
def messages(log: Path) -> tuple[Envelope, ...]:
    return tuple(read_envelopes(log))


def judged(log: Path, envelopes: Log) -> Replayed:
    return replay(subject(log)[0], True, envelopes)


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_fits(name: str, fly_once: FlyOnce, root: Path) -> None:
    log = log_of(fly_once, root, name)
    found = judged(log, list(messages(log)))
    assert found.finding is None, found.finding.text
    assert found.events["GatedCommand"] > 0
    assert found.events["Heartbeat"] > 1000


TAKEOVER = {"VehicleID": 2, "Epoch": 1}
OFFER = {"VehicleID": 2, "Epoch": 2, "Offered": True}
BACK = {"VehicleID": 2, "Epoch": 2, "Owner": "UxAS"}
BY_ICAROUS = {"VehicleID": 2, "Sender": "ICAROUS"}
BY_UXAS = {"VehicleID": 2, "Sender": "UxAS"}
UP, DOWN = {"VehicleID": 1, "Direction": "Up"}, {"VehicleID": 1, "Direction": "Down"}
OF_THE_LINK = ("BridgeStatus", "Heartbeat", "ModeRefused", "TaskProgress")
GATE, COMMAND = "a report of the gate", "a command of UxAS"
TAMPERED: dict[str, tuple[Callable[[Log], None], str, int]] = {
    "takeover removed": (remove("GateState", **TAKEOVER), GATE, 21_500),
    "change of authority removed": (remove("AuthorityChange", **TAKEOVER), GATE, 21_500),
    "first command of ICAROUS removed": (
        remove("GatedCommand", 21_500, **BY_ICAROUS),
        "a heartbeat of ICAROUS",
        21_500,
    ),
    "a command of ICAROUS removed": (
        remove("GatedCommand", 30_000, **BY_ICAROUS),
        "a heartbeat of ICAROUS",
        30_000,
    ),
    "a command of ICAROUS twice": (
        copy_to(30_000, {}, "GatedCommand", **BY_ICAROUS),
        "a second heartbeat of ICAROUS",
        30_000,
    ),
    "forged epoch": (
        alter({"Epoch": 9}, "GatedCommand", 30_000, **BY_ICAROUS),
        "a command of ICAROUS",
        30_000,
    ),
    "former epoch of ICAROUS": (
        alter({"Epoch": 0}, "GatedCommand", 30_000, **BY_ICAROUS),
        "a command of ICAROUS",
        30_000,
    ),
    "another instance commands": (
        send_as("icarous/1", "GatedCommand", 30_000, **BY_ICAROUS),
        "a command in the name of ICAROUS",
        30_000,
    ),
    "ICAROUS commands before it has taken over": (
        copy_to(10_000, {"Epoch": 0}, "GatedCommand", **BY_ICAROUS),
        "a heartbeat of ICAROUS",
        10_000,
    ),
    "second commander": (
        copy_to(30_000, {"Epoch": 1}, "GatedCommand", **BY_UXAS),
        COMMAND,
        30_000,
    ),
    "late command of UxAS not dropped": (
        copy_to(30_000, {"Epoch": 0}, "GatedCommand", **BY_UXAS),
        GATE,
        30_000,
    ),
    "command of UxAS from elsewhere": (
        send_as("radio", "GatedCommand", **BY_UXAS),
        "a command in the name of UxAS",
        0,
    ),
    "a state of the gate from elsewhere": (
        send_as("icarous/2", "GateState", **TAKEOVER),
        "the sender of a GateState",
        21_500,
    ),
    "a heartbeat from elsewhere": (
        send_as("vehicle/1", "Heartbeat", 30_000, **UP),
        "the sender of a Heartbeat",
        30_000,
    ),
    "offer removed": (remove("GateState", **OFFER), "a command of ICAROUS", 34_500),
    "handback without an offer": (
        copy_to(30_000, {"Epoch": 1}, "GatedCommand", "uxas/ics", **BY_UXAS),
        "a handback",
        30_000,
    ),
    "handback in a former epoch": (
        alter({"Epoch": 1}, "GatedCommand", 34_500, **BY_UXAS),
        "a handback",
        34_500,
    ),
    "handback command removed": (
        remove("GatedCommand", 34_500, **BY_UXAS),
        "a second heartbeat of ICAROUS",
        34_500,
    ),
    "command of the offer before it": (
        swap("GateState", "GatedCommand", 34_500, **OFFER),
        "a command of ICAROUS",
        34_500,
    ),
    "offer that is a handback": (
        alter({"Owner": "UxAS", "Offered": False}, "GateState", **OFFER),
        "a heartbeat of ICAROUS",
        34_500,
    ),
    "handback leaves the offer open": (
        alter({"Offered": True}, "GateState", **BACK),
        GATE,
        34_500,
    ),
    "offer as soon as taken over": (
        copy_to(22_000, {}, "GateState", **OFFER),
        "a heartbeat of ICAROUS",
        22_000,
    ),
    "epoch goes back": (
        alter({"Epoch": 0}, "GateState", **TAKEOVER),
        "a heartbeat of ICAROUS",
        21_500,
    ),
    "epoch skipped": (
        alter({"Epoch": 2}, "GateState", **TAKEOVER),
        "a heartbeat of ICAROUS",
        21_500,
    ),
    "change of authority before the takeover": (
        swap("GateState", "AuthorityChange", **TAKEOVER),
        GATE,
        21_500,
    ),
    "taken over a second time": (
        copy_to(30_000, {"Epoch": 2}, "GateState", **TAKEOVER),
        "a heartbeat of ICAROUS",
        30_000,
    ),
    "a drop that nothing led to": (
        make(30_000, "vehicle/2", **{
            "$type": "CommandDropped", "VehicleID": 2, "Sender": "UxAS", "Epoch": 0,
            "GateEpoch": 1, "Reason": "of another epoch",
        }),
        GATE,
        30_000,
    ),
    "a true mode refused": (
        make(30_000, "uxas/ics", **{
            "$type": "ModeRefused", "VehicleID": 2, "Owner": "ICAROUS", "Epoch": 1,
            "GateEpoch": 1, "Reason": "forged",
        }),
        "a mode refused",
        30_000,
    ),
    "the present mode overtaken": (
        make(30_000, "uxas/ics", **{
            "$type": "BridgeStatus", "VehicleID": 2, "Alive": True,
            "Note": "a mode of epoch 1 is overtaken by one of epoch 1",
        }),
        "a mode that is overtaken",
        30_000,
    ),
    "a task suspended without a takeover": (
        make(10_000, "uxas/ics", **{
            "$type": "TaskProgress", "TaskID": 1, "VehicleID": 1, "Phase": "Suspended",
            "Served": 0.0, "Note": "",
        }),
        "UxAS lets the vehicle go",
        10_000,
    ),
    "silence that was none": (
        make(30_000, "uxas/ics", **{
            "$type": "BridgeStatus", "VehicleID": 1, "Alive": False, "Note": "silent since 1000 ms",
        }),
        "a report of silence",
        30_000,
    ),
    "heard again without silence": (
        make(30_000, "uxas/ics", **{
            "$type": "BridgeStatus", "VehicleID": 1, "Alive": True, "Note": "heard again",
        }),
        "a sign of life",
        30_000,
    ),
    "silence that is not reported": (deaf, "the link", 12_000),
    "lost and alive": (
        make(30_000, "uxas/ics", **{
            "$type": "BridgeStatus", "VehicleID": 1, "Alive": True, "Note": "link lost: closed",
        }),
        "a status of the link",
        30_000,
    ),
    "connection removed": (
        remove("BridgeStatus", VehicleID=1),
        "a heartbeat to ICAROUS",
        0,
    ),
    "nothing of the link": (strike(*OF_THE_LINK), "the link", 0),
    "nothing of the link of the one that nobody takes over": (
        strike(*OF_THE_LINK, VehicleID=1), "the link", 0,
    ),
    "nothing of authority": (
        strike(*OF_THE_LINK, "GatedCommand", "GateState", "AuthorityChange", "CommandDropped"),
        "the link",
        0,
    ),
    "heartbeat to ICAROUS removed": (
        remove("Heartbeat", 30_000, **DOWN),
        "a heartbeat to ICAROUS",
        30_000,
    ),
    "heartbeat to ICAROUS with a former number": (
        alter({"Sequence": 3}, "Heartbeat", 30_000, **DOWN),
        "a heartbeat to ICAROUS",
        30_000,
    ),
    "heartbeat of ICAROUS that was never sent": (
        alter({"Sequence": 9999}, "Heartbeat", 30_000, **UP),
        "a heartbeat from ICAROUS",
        30_000,
    ),
    "another time in the message": (
        alter({"Time": 1}, "GateState", **TAKEOVER),
        "GateState",
        21_500,
    ),
    "a vehicle that there is not": (
        alter({"VehicleID": 77}, "GateState", **TAKEOVER),
        "GateState",
        21_500,
    ),
    "the end removed": (cut_short, "the end of the log", 220_750),
    "a command after the end": (after_the_end, "GatedCommand", 220_750),
    "time goes back": (time_goes_back, "the time of a message", 30_000),
    "the end days later": (days_later, "the time of a message", 220_750),
}  # fmt: skip


@pytest.mark.parametrize("name", TAMPERED)
def test_a_tampered_log_does_not_fit(name: str, fly_once: FlyOnce, root: Path) -> None:
    log = log_of(fly_once, root, "crossing")
    envelopes = list(messages(log))
    change, what, time_ms = TAMPERED[name]
    change(envelopes)
    finding = judged(log, envelopes).finding
    assert finding is not None
    assert finding.what.startswith(what), finding.text
    assert finding.time_ms == time_ms, finding.text
    assert finding.expected
    assert finding.got


def test_the_command_names_what_does_not_fit(
    fly_once: FlyOnce, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = log_of(fly_once, root, "crossing")
    assert main(["monitor", str(log.parent), "--model", "--allow-unproved"]) in (0, 3)
    said = capsys.readouterr().out
    assert "fits the model" in said
    assert "not covered: SETMOD lines" in said
    assert "cratous.TruthState: message not looked at" in said
    changed = tmp_path / "log.sqlite"
    envelopes = list(messages(log))
    TAMPERED["second commander"][0](envelopes)
    with LogWriter(changed, **read_meta(log)) as writer:
        for seq, one in enumerate(envelopes):
            writer.tap(replace(one, seq=seq))
    assert main(["monitor", str(changed), "--model", "--json", "--allow-unproved"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert not data["fits"]
    assert data["finding"]["vehicle_id"] == 2
    assert data["finding"]["got"] == "epoch 1"
    (told,) = data["steps"]["UxAS commands a track"].items()
    assert told[0] == "cratous.core.authority.link_end.track_is_told"
    assert told[1] > 1


def test_steps_are_covered_by_what_was_asked(
    fly_once: FlyOnce, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A log that ends before the takeover asks nothing of the steps of who flies; one of no instance nothing at all."""
    log = log_of(fly_once, root, "crossing")
    whole = list(messages(log))
    for name, meta, kept in (
        ("short", {}, whole[: at(whole, "GateState")]),
        ("bare", {"avoidance": False}, [m for m in whole if m.topic.endswith("MissionEnd")]),
    ):
        with LogWriter(tmp_path / f"{name}.sqlite", **{**read_meta(log), **meta}) as writer:
            for seq, one in enumerate(kept):
                writer.tap(replace(one, seq=seq))
    words = ["monitor", "--model", "--allow-unproved"]
    main([*words, str(log)])
    assert "not exercised" not in capsys.readouterr().out
    assert main([*words, str(tmp_path / "short.sqlite")]) == 1
    said = capsys.readouterr().out
    assert "not exercised: a heartbeat of ICAROUS (cycle_flown)" in said
    assert (
        "not exercised: the gate changes at ICAROUS's wish (gate_wished, gate_takeover, gate_offer)"
        in said
    )
    assert "covered: the gate changes" not in said
    assert main([*words, str(tmp_path / "bare.sqlite")]) == 3
    said = capsys.readouterr().out
    assert "fits the model: each" not in said
    assert "no vehicle was flown with an ICAROUS instance" in said
    assert "not exercised: UxAS commands a track (track_is_told)" in said
    assert main([*words, "--json", str(tmp_path / "bare.sqlite")]) == 3
    data = json.loads(capsys.readouterr().out)
    assert (data["fits"], data["finding"], data["vehicles_with_icarous"]) == (None, None, 0)
    assert {count for kernels in data["steps"].values() for count in kernels.values()} == {0}


def test_what_cannot_be_asked_is_refused(
    fly_once: FlyOnce, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = log_of(fly_once, root, "crossing")
    words = ["monitor", str(log), "--model", "--allow-unproved"]
    assert main([*words, "--requirements", "x.req"]) == 2
    bare = tmp_path / "log.sqlite"
    meta = {**read_meta(log), "avoidance": "perhaps"}
    with LogWriter(bare, **meta):
        pass
    assert main(["monitor", str(bare), "--model", "--allow-unproved"]) == 2
    assert "meta.avoidance" in capsys.readouterr().err
    del meta["mission"]
    bare.unlink()
    with LogWriter(bare, **meta):
        pass
    assert main(["monitor", str(bare), "--model", "--allow-unproved"]) == 2
    assert "meta.mission" in capsys.readouterr().err
