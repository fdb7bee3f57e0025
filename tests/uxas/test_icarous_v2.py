"""UxAS's end in v2: what is put into a vehicle's connection by somebody without its key is not believed, and is said."""

from __future__ import annotations

import contextlib
import socket
from pathlib import Path
from typing import Any

import pytest
from bridge_flight import way
from icarous_rig import Rig, state

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.authenticated_lines import (
    DAMAGED,
    FORGED,
    REPLAYED,
    Seal,
    SealedClient,
)
from cratous.bridge.text_protocol.keys import new_keys
from cratous.spec.mission.guarantees import Outcome

SERVICE = "IcarousCommunicationService"
KEYS = new_keys([1])
MORE = 'NumberOfUAVs="1" VehicleIDs="1"'


class Sealed:
    """The ICAROUS of vehicle 1, with its key."""

    def __init__(self, rig: Rig) -> None:
        self.rig, self.handshake = rig, SealedClient(keys=KEYS.by_vehicle)
        self.sock = socket.create_connection(("127.0.0.1", rig.port), timeout=60)
        rig.opened.append(self.sock)
        self.sock.setblocking(False)
        rig.until(self._opened)

    def _opened(self) -> bool:
        with contextlib.suppress(BlockingIOError):
            self.sock.sendall(self.handshake.feed(self.sock.recv(65536)))
        assert not self.handshake.failed
        return self.handshake.done

    @property
    def seal(self) -> Seal:
        assert self.handshake.seal is not None
        return self.handshake.seal

    def say(self, line: tp.Message) -> bytes:
        """What has gone over the wire."""
        packet = self.seal.wrap(tp.encode(line), 1000)
        self.sock.sendall(packet)
        return packet


@pytest.fixture
def rig(tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch) -> Rig:
    for name, text in KEYS.environment().items():
        monkeypatch.setenv(name, text)
    return Rig(tmp_path, f'{MORE} Dialect="v2"', opened)


def greeted(rig: Rig) -> tuple[Sealed, Seal]:
    """The instance, once its first mode is believed, and a stranger who seals with another key and the same count."""
    one = Sealed(rig)
    one.say(tp.SetMode("PASSIVE", 0))
    rig.until(lambda: rig.process.bus.state(SERVICE).fresh == frozenset())
    return one, Seal(1, b"k" * 32, b"k" * 32, sent=one.seal.sent)


def refused(rig: Rig) -> dict[str, int]:
    return dict(rig.service.port.counts.refused)


@pytest.mark.shows(SERVICE, "Dialect")
def test_a_forged_mode_moves_no_gate_and_is_counted_where_authority_is_judged(rig: Rig) -> None:
    one, stranger = greeted(rig)
    taken = tp.encode(tp.SetMode("ACTIVE", 1))
    one.sock.sendall(taken)  # as it would be believed without keys
    one.sock.sendall(stranger.wrap(taken, 1000))
    one.sock.sendall(stranger.wrap(tp.encode(tp.SetVelocity(1.0, 0.0, 0.0)), 1000))
    rig.until(lambda: refused(rig) == {DAMAGED: 1, FORGED: 2})
    assert [(r.Reason, r.Epoch, r.GateEpoch) for r in rig.got("ModeRefused")] == [(FORGED, 0, 0)]
    assert not rig.got("AuthorityChange")
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)), state(1, 1.0, 1500))
    genuine = one.say(tp.SetMode("ACTIVE", 1))
    one.say(tp.SetVelocity(0.0, 20.0, 0.0))
    rig.until(lambda: rig.got("VehicleActionCommand"))
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    changes = len(rig.got("AuthorityChange"))
    one.sock.sendall(genuine)
    rig.until(lambda: refused(rig).get(REPLAYED) == 1)
    assert len(rig.got("AuthorityChange")) == changes, "a recorded packet takes nothing"
    verdict = rig.authority()
    assert verdict.outcome is Outcome.HOLDS, verdict.note
    assert "1 modes refused" in verdict.note


@pytest.mark.shows(SERVICE, "Dialect")
def test_many_forged_modes_are_told_seldom_and_counted_all(rig: Rig) -> None:
    one, stranger = greeted(rig)
    for k in range(100):
        one.sock.sendall(stranger.wrap(tp.encode(tp.SetMode("ACTIVE", k)), 1000))
    rig.until(lambda: refused(rig) == {FORGED: 100})
    more = [f" ({count} so far)" for count in (2, 4, 8, 16, 32, 64)]
    assert [r.Reason for r in rig.got("ModeRefused")] == [FORGED + m for m in ("", *more)]


def test_a_peer_without_a_key_is_refused_whatever_it_says(opened: list[Any], rig: Rig) -> None:
    peer = socket.create_connection(("127.0.0.1", rig.port), timeout=60)
    opened.append(peer)
    peer.sendall(b"0" * 64 + tp.encode(tp.Hello(1)) + tp.encode(tp.SetMode("ACTIVE", 1)))
    rig.until(lambda: rig.said.has("another dialect than v2"))
    assert not rig.process.bus.state(SERVICE).fresh
