"""Traces of the certificate in hand on the vehicle that holds it: what the design does it does, what a broken one does not."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from cratous.core.permit.hand import OFFERED, Hand, Offer
from cratous.proofs.system_search.breadth_first import search
from cratous.proofs.system_search.certificate_faults import HAND_FAULTS
from cratous.proofs.system_search.certificates import HandDesign
from cratous.services.cli import main
from cratous.services.cli.replay_trace import replay_trace
from cratous.services.flight import holding
from cratous.services.trace_replay.files import HAND_FORMAT, Trace, read, write
from cratous.services.trace_replay.play import play_hand
from cratous.spec.errors import BadInput
from cratous.spec.system.hand_trace import (
    ANSWER,
    ARRIVES,
    KINDS,
    LEFT,
    OFFER,
    TIME,
    Entry,
    Event,
    InHand,
)

STEPS = 6
BY_ANOTHER_WAY = {
    "certificate-without-base": "the gate is UxAS's",
    "same-id-when-left": "the gate is UxAS's",
    "certificate-for-other-tracks": "the vehicle sees the track",
    "answer-for-another": "the vehicle asks of what is in hand",
    "certificate-too-late": "the vehicle is not where the manoeuvre begins",
}
"""Faults of the hand alone that a vehicle does not fly even so, and what keeps it from that."""


def walk(seed: int) -> list[Entry]:
    """Some of what the design can do, each kind of event as likely as any other."""
    drawn, design, found = random.Random(seed), HandDesign(), list[Entry]()
    state = design.first()
    for _ in range(12):
        can = list(design.steps(state))
        kind = drawn.choice(sorted({step.event.kind for step in can}))
        step = drawn.choice([one for one in can if one.event.kind == kind])
        assert not step.wrong
        found.append(step.entry)
        state = step.after
    return found


@pytest.mark.parametrize("name", sorted(HAND_FAULTS))
def test_the_vehicle_leaves_the_trace_of_each_broken_design_at_its_last_event(name: str) -> None:
    found = search(HAND_FAULTS[name].design, STEPS)
    played = play_hand(found.trace)
    assert played.followed == len(found.trace) - 1
    assert "in the trace" in played.why


@pytest.mark.parametrize("name", sorted(HAND_FAULTS))
def test_a_vehicle_with_the_fault_flies_its_trace_unless_something_else_keeps_it_from_that(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    design = HAND_FAULTS[name].design

    def accepts(hand: Hand, offer: Offer, now: int, reserve: int) -> bool:
        return design.step(hand, OFFERED, offer, False, now, reserve) != hand

    def unsaid(held: holding.InHand, *_: Any) -> holding.Kept:
        return held, ()

    monkeypatch.setattr(holding, "hand_step", design.step)
    monkeypatch.setattr(holding, "accepts", accepts)
    if design.unnoticed:
        monkeypatch.setattr(holding, "left", unsaid)
    trace = search(design, STEPS).trace
    assert bool(play_hand(trace).why) == (name in BY_ANOTHER_WAY)


def test_the_vehicle_flies_a_certificate_a_handback_and_another_certificate() -> None:
    back = search(HandDesign(), STEPS).back
    assert back[-1].after.until > back[-1].after.now
    assert play_hand(back) == (len(back), "")


@pytest.mark.parametrize("seed", range(40))
def test_whatever_the_design_can_do_the_vehicle_does(seed: int) -> None:
    entries = walk(seed)
    assert play_hand(entries) == (len(entries), "")


def directed(*wanted: Event) -> list[Entry]:
    """The design's own steps by these events."""
    design, found = HandDesign(), list[Entry]()
    state = design.first()
    for event in wanted:
        (step,) = [one for one in design.steps(state) if one.event == event]
        assert not step.wrong
        found.append(step.entry)
        state = step.after
    return found


def test_what_was_offered_before_a_handback_with_nothing_in_hand_is_refused_afterwards() -> None:
    """ICAROUS has no certificate in hand, offers one that begins later, hands back, and takes over again."""
    later, left = Event(OFFER, 1, 5, 9), Event(LEFT, 2)
    again, late = Event(OFFER, 3, 0, 4), Event(ARRIVES, 1)
    passing = [Event(TIME)] * 5
    entries = directed(later, left, again, *passing, late)
    assert entries[-1].text.startswith("the offer of trajectory 1")
    assert "refused" in entries[-1].text
    assert play_hand(entries) == (len(entries), "")
    in_time = directed(later, *passing, late)
    assert "TAKEN" in in_time[-1].text
    assert play_hand(in_time) == (len(in_time), "")


def test_the_walks_take_every_kind_of_step() -> None:
    """Offers that are taken and refused, news that is permitted and not, what is in hand and what is left."""
    walks = [walk(seed) for seed in range(40)]
    every = [entry for one in walks for entry in one]
    assert {e.event.kind for e in every} == set(KINDS)
    assert {"TAKEN" in e.text for e in every if e.event.kind == ARRIVES} == {True, False}
    assert {e.event.permitted for e in every if e.event.kind == ANSWER} == {True, False}
    certain = [e.after.until > e.after.now for e in every]
    assert 40 < sum(certain) < len(certain) - 40


@pytest.mark.parametrize(
    ("event", "why"),
    [
        (Event(ARRIVES, 1), "such an offer was never made"),
        (Event(ANSWER, 0, permitted=True), "nobody has asked whether that trajectory is permitted"),
        (Event(OFFER, 1, 5, 5), "ICAROUS offers nothing that has begun, or is permitted for no"),
    ],
)
def test_what_nobody_has_sent_does_not_arrive(event: Event, why: str) -> None:
    followed, told = play_hand([Entry("text", event, InHand(0, 0))])
    assert followed == 0
    assert told.startswith(why)


def test_the_commands_work_together(tmp_path: Path) -> None:
    names = ["safe-certificate", "no-surprise"]
    assert main(["search-faults", *names, "--traces", str(tmp_path)]) == 0
    files = [str(tmp_path / f"{name}.json") for name in names]
    run = CliRunner().invoke(replay_trace, files)
    assert run.exit_code == 0, run.output
    assert "flown to its end as the trace says" in run.output
    assert (
        "what flies leaves the trace: nothing is certain at heartbeat 0, in the trace what is in hand at heartbeat 0 is"
        " certain until 1" in run.output
    )


def test_a_trace_keeps_its_kind_in_a_file(tmp_path: Path) -> None:
    file = tmp_path / "t.json"
    told = Trace("mine", "ours", "", (Entry("a heartbeat", Event(TIME), InHand(1, 1)),))
    write(file, told)
    assert read(file) == told
    assert HAND_FORMAT in file.read_text()
    for old, new, item in (
        ('"time"', '"heartbeat"', "event.kind"),
        ("certificate", "authority", ""),
    ):
        text = file.read_text()
        file.write_text(text.replace(old, new))
        with pytest.raises(BadInput, match="not a trace") as refused:
            read(file)
        assert item in str(refused.value)
        file.write_text(text)
