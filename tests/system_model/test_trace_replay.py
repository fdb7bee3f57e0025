"""Traces of authority on the actors that fly: what the design does they do, what a broken one does they do not."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from cratous.core.authority.cycle import gate_wished
from cratous.core.authority.gate import UXAS, Gate
from cratous.proofs.system_search.authority import Design, State, steps
from cratous.proofs.system_search.breadth_first import search
from cratous.proofs.system_search.faults import FAULTS
from cratous.services.cli import main
from cratous.services.cli.replay_trace import replay_trace
from cratous.services.flight import link_end, vehicle
from cratous.services.icarous import instance
from cratous.services.trace_replay.files import FORMAT, Trace, read, write
from cratous.services.trace_replay.play import play
from cratous.spec.errors import BadInput
from cratous.spec.system.trace import TRACK, Entry, Event, Standing

BACK = search(Design(), 8).back
"""Takeover, offer and handback, by the shortest way."""


EARLIER = {"uxas-always": 2, "offer-taken-unheard": 2}
"""Traces that are left by an event before the last: there a command is sent that, once it arrives, is the fault."""


def walk(seed: int) -> list[Entry]:
    """Some of what the design can do, each kind of event as likely as any other; mostly what changes something."""
    drawn, state, found = random.Random(seed), State(), list[Entry]()
    for _ in range(16):
        can = list(steps(Design(), state))
        if drawn.randint(1, 4) > 1:
            can = [one for one in can if believed(one.after) != believed(state)] or can
        kind = drawn.choice(sorted({step.event.kind for step in can}))
        step = drawn.choice([one for one in can if one.event.kind == kind])
        assert not step.wrong
        found.append(step.entry)
        state = step.after
    return found


def believed(state: State) -> tuple[object, ...]:
    """What the parts of a state know of authority, without what is on its way."""
    return (state.gate, state.cycle, state.end, state.suspended, state.known)


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_the_actors_leave_the_trace_of_each_broken_design(name: str) -> None:
    found = search(FAULTS[name].design, 8)
    played = play(found.trace)
    assert played.why
    assert played.followed == len(found.trace) - EARLIER.get(name, 1)


def test_the_actors_fly_takeover_offer_and_handback_as_the_design_does() -> None:
    assert BACK
    assert play(BACK) == (len(BACK), "")


@pytest.mark.parametrize("seed", [*range(12), 1176])
def test_whatever_the_design_can_do_the_actors_do(seed: int) -> None:
    entries = walk(seed)
    assert play(entries) == (len(entries), "")


def test_the_walks_take_every_kind_of_step() -> None:
    """Takeovers, offers and withdrawals, lines that are believed and refused, commands flown and dropped."""
    after = [entry for seed in range(12) for entry in walk(seed)]
    assert {e.event.kind for e in after} == {"heartbeat", "report", "mode", "track", "command"}
    assert {e.after.accepted for e in after if e.event.kind == "command"} == {True, False}
    assert {e.after.mode for e in after} == {0, 1, 2}
    assert {e.after.suspended for e in after} == {True, False}
    assert any("withdraws" in e.text for e in after)
    assert any("takes the vehicle back" in e.text for e in after)
    assert any("refused" in e.text for e in after)
    assert any("overtaken" in e.text for e in after)


def _gate_that_stays_offered(state: Any, _sender: int, _epoch: int, command: Any) -> Any:
    return state.__class__(**{**vars(state), "command": command})


def test_actors_with_the_fault_fly_its_trace_to_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    trace = search(FAULTS["no-acknowledgement"].design, 8).trace
    monkeypatch.setattr(vehicle, "commanded", _gate_that_stays_offered)
    assert play(trace) == (len(trace), "")


def test_a_lost_takeover_is_flown_by_a_vehicle_that_loses_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def lost(gate: Gate, act: int) -> Gate:
        return gate if act == 3 else gate_wished(gate, act)

    trace = search(FAULTS["takeover-lost"].design, 8).trace
    for actor in (vehicle, instance):
        monkeypatch.setattr(actor, "gate_wished", lost)
    assert not play(trace).why


def test_an_end_that_believes_all_flies_the_trace_of_one(monkeypatch: pytest.MonkeyPatch) -> None:
    fault = FAULTS["mode-without-gate"]
    monkeypatch.setattr(link_end, "link_mode", fault.design.mode)
    trace = search(fault.design, 8).trace
    assert play(trace) == (len(trace), "")


def _entry(event: Event) -> Entry:
    return Entry("text", event, Standing(0, 0, False, 0, False, 0, False, True, -1))


@pytest.mark.parametrize(
    ("event", "why"),
    [
        (Event("command", False, 1, 1, 1), "such a command was never sent"),
        (Event("command", False, UXAS, 0, 1), "such a command was never sent"),
        (Event("report", True, 1, 2), "such a report of the gate was never made"),
    ],
)
def test_what_nobody_has_sent_does_not_arrive(event: Event, why: str) -> None:
    assert play([_entry(event)]) == (0, why)


def test_the_commands_work_together(tmp_path: Path) -> None:
    names = ["safe", "no-sender-check"]
    assert main(["search-faults", *names, "--traces", str(tmp_path)]) == 0
    files = [str(tmp_path / f"{name}.json") for name in names]
    run = CliRunner().invoke(replay_trace, files)
    assert run.exit_code == 0, run.output
    assert "flown to its end as the trace says" in run.output
    assert "what flies leaves the trace" in run.output
    machine = CliRunner().invoke(replay_trace, ["--json", *files])
    told = json.loads(machine.output)
    assert [one["design"] for one in told["traces"]] == names
    assert told["exit_code"] == 0


def test_traces_take_the_place_of_traces_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["search-faults", "no-sender-check", "--steps", "1", "--traces"]
    file = tmp_path / "no-sender-check.json"
    for _ in range(2):
        assert main([*words, str(tmp_path)]) == 0
        assert read(file).design == "no-sender-check"
    assert main([*words, str(file / "in")]) == 2
    assert "the folder of traces cannot be written" in capsys.readouterr().err
    file.write_text("[1]")
    assert main([*words, str(tmp_path)]) == 2
    assert file.read_text() == "[1]"


def test_a_trace_that_is_left_without_a_fault_is_told(tmp_path: Path) -> None:
    """A design that says less than what flies: exit code 1."""
    heartbeat = Entry("nothing", Event("heartbeat", False), _entry(Event(TRACK)).after)
    write(tmp_path / "t.json", Trace("mine", "ours", "", (heartbeat,)))
    assert main(["replay-trace", str(tmp_path / "t.json")]) == 1
    write(tmp_path / "t.json", Trace("mine", "ours", "", BACK[:1]))
    assert main(["replay-trace", str(tmp_path / "t.json")]) == 0
    fault = Trace("mine", "ours", "a fault", BACK[:1])
    write(tmp_path / "t.json", fault)
    assert main(["replay-trace", str(tmp_path / "t.json")]) == 1


def _changed(data: Any, *path: Any, to: Any) -> str:
    at = data
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = to
    return json.dumps(data)


def test_a_file_that_is_no_trace_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "t.json"
    trace = Trace("mine", "ours", "", (_entry(Event("heartbeat")),))
    write(file, trace)
    assert read(file) == trace
    good = file.read_text()
    for text, item in (
        ("{", "JSON"),
        ("[" * 100_000, "JSON"),
        ("[]", "file"),
        (_changed(json.loads(good), "format", to="another"), "format"),
        (_changed(json.loads(good), "entries", to=[]), "entries"),
        (_changed(json.loads(good), "entries", to=[{}] * 101), "entries"),
        (_changed(json.loads(good), "says", to="x" * 501), "says"),
        (_changed(json.loads(good), "entries", 0, "event", "kind", to="wish"), "event.kind"),
        (_changed(json.loads(good), "entries", 0, "event", "flag", to=1), "event.flag"),
        (_changed(json.loads(good), "entries", 0, "event", "epoch", to=True), "event.epoch"),
        (_changed(json.loads(good), "entries", 0, "event", "epoch", to=-1), "event.epoch"),
        (_changed(json.loads(good), "entries", 0, "event", "epoch", to=10**4000), "event.epoch"),
        (_changed(json.loads(good), "entries", 0, "after", "mode", to=0.5), "after.mode"),
        (_changed(json.loads(good), "entries", 0, "after", "more", to=0), "entries[0].after"),
    ):
        file.write_text(text)
        with pytest.raises(BadInput) as refused:
            read(file)
        assert item in str(refused.value)
    assert FORMAT in good
    assert main(["replay-trace", str(tmp_path / "none.json")]) == 2
