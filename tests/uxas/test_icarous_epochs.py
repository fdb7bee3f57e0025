"""Epochs over a restart: whichever end is started anew within a flight, none is given twice or goes back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from bridge_flight import way
from hypothesis import given
from hypothesis import strategies as st
from icarous_rig import Rig, state
from icarous_tools import PROJECTION, VOLUME

from cratous.bridge import text_protocol as tp
from cratous.bridge.port import Address
from cratous.bridge.redial import Redial
from cratous.bridge.text_port import TextPort
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_takeover
from cratous.services.flight.dynamics import Limits
from cratous.services.flight.link_lines import MOST_SAID
from cratous.services.icarous.state import Config
from cratous.services.icarous_program import program as program_module
from cratous.services.icarous_program.epochs import EpochFile
from cratous.services.icarous_program.program import Program
from cratous.services.icarous_program.step import Craft, IcarousEnd, Refuse, State, Tell
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa

CRAFT = Craft(Config(1, Daa(VOLUME), PROJECTION, 500), Limits(15.0, 33.0, 0.52, 5.0), 60.0)
SERVICE = "IcarousCommunicationService"
ONE = 'NumberOfUAVs="1"'


@pytest.fixture(autouse=True)
def short_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program_module, "_LONGEST_POLL_MS", 1)


class Pilot:
    """`cratous icarous` of vehicle 1 in this process, against a rig's service."""

    def __init__(self, rig: Rig, opened: list[Any], file: Path | None = None) -> None:
        self.said: list[str] = []
        port = TextPort(Address("tcp", "127.0.0.1", rig.port, "UxAS"), server=False)
        opened.append(port)
        kept = None if file is None else EpochFile(file, 1)
        self.rig, self.port = rig, port
        self.program = Program(
            IcarousEnd(CRAFT), port, lambda _, text: self.said.append(text), epochs=kept
        )

    @property
    def gate(self) -> Gate:
        return self.program.state.gate

    def until(self, done: Any) -> None:
        self.rig.until(lambda: (self.program.turn(), done())[1])

    def take_over(self) -> None:
        """What its step does at a takeover."""
        state_ = self.program.state
        after = gate_takeover(state_.gate)
        self.program._keep(State(state_.instance, after), state_)
        self.program._say(tp.SetMode("ACTIVE", after.epoch))
        self.until(lambda: self.known() == after)

    def known(self) -> Gate:
        """The gate as UxAS's end knows it."""
        peer = self.rig.process.bus.state(SERVICE).link.peer(1)
        return Gate(UXAS, -1, False) if peer is None else peer.gate

    def end(self) -> None:
        """It is killed: nothing more is said."""
        self.port.close()
        self.rig.until(lambda: gone(self.rig))

    def gone_is_seen(self) -> bool:
        """Its program sees that UxAS is gone."""
        while self.program._open:
            self.program.turn()
        return True


def gone(rig: Rig) -> bool:
    """UxAS's end sees that the instance is gone."""
    peer = rig.process.bus.state(SERVICE).link.peer(1)
    return peer is not None and not peer.open


def epochs(rig: Rig) -> list[int]:
    """All that were told on the bus, in order."""
    return [
        e.body.Epoch for e in rig.sent if type(e.body).__name__ in ("GateState", "GatedCommand")
    ]


def flying(rig: Rig) -> None:
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)), state(1, 1.0, 1500))


@pytest.mark.parametrize("kept", [False, True], ids=["told by UxAS", "in a file"])
@pytest.mark.parametrize("owned", [False, True], ids=["UxAS flies", "ICAROUS flies"])
def test_an_icarous_that_is_started_anew_goes_on_after_the_epochs_it_gave(
    tmp_path: Path, opened: list[Any], kept: bool, owned: bool
) -> None:
    rig = Rig(tmp_path, ONE, opened)
    flying(rig)
    file = tmp_path / "epoch" if kept else None
    first = Pilot(rig, opened, file)
    first.until(lambda: first.known().epoch == 0 and not rig.process.bus.state(SERVICE).fresh)
    first.take_over()
    if not owned:  # handed back in epoch 2
        first.program._say(tp.SetMode("PASSIVE", 2))
        state_ = first.program.state
        first.program._keep(State(state_.instance, Gate(ICAROUS, 2, True)), state_)
        first.until(lambda: first.gate == Gate(UXAS, 2, False))
    before = first.known()
    assert before.epoch == (1 if owned else 2)
    first.end()
    second = Pilot(rig, opened, file)
    assert second.gate.epoch == (0 if not kept else 2)
    second.until(lambda: second.known() == second.gate == Gate(UXAS, 2, False))
    assert epochs(rig) == sorted(epochs(rig))
    # the next takeover is in an epoch that nobody has seen
    second.take_over()
    assert second.known() == Gate(ICAROUS, 3, False)
    assert epochs(rig) == sorted(epochs(rig))
    assert kept or rig.said.has("ICAROUS is in epoch 0, which is over")
    assert not rig.got("ModeRefused")


def test_a_uxas_that_is_started_anew_hears_the_epoch_before_it_tells_one(
    tmp_path: Path, opened: list[Any]
) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "two").mkdir()
    first = Rig(tmp_path / "one", ONE, opened)
    flying(first)
    pilot = Pilot(first, opened)
    pilot.until(lambda: pilot.known().epoch == 0 and not first.process.bus.state(SERVICE).fresh)
    pilot.take_over()
    first.process.close()
    second = Rig(tmp_path / "two", ONE, opened)
    flying(second)
    assert pilot.gone_is_seen()
    pilot.rig = second
    where = Address("tcp", "127.0.0.1", second.port, "UxAS")
    pilot.program._redial = Redial(pilot.port, (where,))  # another port than before
    pilot.until(lambda: pilot.known() == Gate(ICAROUS, 1, False))
    assert set(epochs(second)) == {1}


def test_both_ends_started_anew_go_on_from_the_file(tmp_path: Path, opened: list[Any]) -> None:
    file = tmp_path / "epoch"
    EpochFile(file, 1).keep(Gate(ICAROUS, 7, False))
    rig = Rig(tmp_path, ONE, opened)
    flying(rig)
    pilot = Pilot(rig, opened, file)
    assert pilot.gate == Gate(ICAROUS, 8, True)
    pilot.until(lambda: pilot.known() == pilot.gate == Gate(UXAS, 8, False))
    assert set(epochs(rig)) == {8}
    assert file.read_text() == "vehicle 1 epoch 8 UxAS\n"


def test_an_epoch_that_was_never_given_is_refused_after_a_restart_too(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, ONE, opened)
    flying(rig)
    one = rig.fake(hello=1)
    one.say(tp.SetMode("ACTIVE", 5))
    rig.until(lambda: rig.got("AuthorityChange"))
    one.close()
    rig.until(lambda: gone(rig))
    two = rig.fake(hello=1)
    two.say(*[tp.SetMode("ACTIVE", 1)] * 4, tp.SetMode("PASSIVE", 0))
    rig.until(lambda: len(two.all(tp.EpochTold)) == 5)
    # one that goes on like that does not fill the log: the 1st, 2nd, 4th... are in it
    assert sum("which is over" in line for line in rig.said) == 3
    assert set(two.all(tp.EpochTold)) == {tp.EpochTold("ICAROUS", 5)}
    two.say(tp.SetMode("ACTIVE", 5), tp.SetMode("ACTIVE", 40))
    rig.until(lambda: rig.got("ModeRefused"))
    assert [(m.Epoch, m.GateEpoch) for m in rig.got("ModeRefused")] == [(40, 5)]


def test_no_peer_raises_an_epoch_so_far_that_the_next_one_has_no_room(
    tmp_path: Path, opened: list[Any]
) -> None:
    far = 10**15 - 1  # the greatest that a line can say
    rig = Rig(tmp_path, ONE, opened)
    flying(rig)
    one = rig.fake(hello=1)
    one.say(tp.SetMode("ACTIVE", far))
    rig.until(lambda: rig.got("ModeRefused"))
    assert not rig.got("AuthorityChange")
    one.say(tp.SetMode("ACTIVE", MOST_SAID.epoch))
    rig.until(lambda: rig.got("AuthorityChange"))
    one.close()
    rig.until(lambda: gone(rig))
    # one that is started anew goes on even from there
    pilot = Pilot(rig, opened, tmp_path / "epoch")
    pilot.until(lambda: pilot.known() == pilot.gate == Gate(UXAS, MOST_SAID.epoch + 1, False))
    state_ = pilot.program.state
    after, answers = IcarousEnd(CRAFT).handle(state_, tp.EpochTold("ICAROUS", far))
    assert after == state_
    assert [type(a) for a in answers] == [Refuse]


@given(st.integers(0, 9), st.sampled_from(["UXAS", "ICAROUS"]), st.integers(0, 9), st.booleans())
def test_what_is_told_never_takes_an_epoch_back(
    own: int, owner: str, told: int, commands: bool
) -> None:
    gate = Gate(ICAROUS if commands else UXAS, own, False)
    after, answers = IcarousEnd(CRAFT).handle(State(gate=gate), tp.EpochTold(owner, told))
    assert after.gate.epoch >= max(own, told)
    if told <= own:
        assert (after.gate, answers) == (gate, ())
        return
    # nobody steers for ICAROUS: what it had is offered, in an epoch that nobody has seen
    expected = Gate(ICAROUS, told + 1, True) if owner == "ICAROUS" else Gate(UXAS, told, False)
    assert after.gate == expected
    assert Tell(tp.SetMode("PASSIVE", expected.epoch)) in answers


@pytest.mark.parametrize(
    "text",
    ["", "vehicle 2 epoch 3 UxAS\n", "vehicle 1 epoch -3 UxAS\n", "vehicle 1 epoch 3 UxAS",
     "vehicle 1 epoch 3 Nobody\n", "vehicle 1 epoch " + "9" * 40 + " UxAS\n",
     "vehicle 1 epoch " + "9" * 15 + " ICAROUS\n"],
)  # fmt: skip
def test_a_file_that_is_no_epoch_of_this_vehicle_is_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "epoch"
    file.write_text(text)
    with pytest.raises(BadInput, match="not the epoch of this vehicle"):
        EpochFile(file, 1).resumed()
    EpochFile(file, 1).keep(Gate(ICAROUS, 4, True))
    assert EpochFile(file, 1).resumed() == Gate(ICAROUS, 4, True)


@pytest.mark.parametrize("name", [".", "e" * 300])
def test_a_name_that_can_be_no_file_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(BadInput, match="cannot be read"):
        EpochFile(tmp_path / name, 1).resumed()
