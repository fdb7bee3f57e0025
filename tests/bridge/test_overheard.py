"""What is read beside a CRATOUS bridge, and what it is worth."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import text_protocol as tp
from cratous.bridge.passive_decoder import NO_OPENING, REFUSED, Overheard, Said
from cratous.bridge.text_protocol.authenticated_lines import (
    DAMAGED,
    FORGED,
    SealedClient,
    SealedServer,
)
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.handshake import (
    ACCEPT,
    DEFAULT_SECRET,
    HELLO,
    ClientHandshake,
    Handshake,
    ServerHandshake,
)

KEY = b"k" * 32
LINES = {
    True: [tp.Hello(3), tp.SetMode("ACTIVE", 1), tp.SetVelocity(20.0, -5.0, 0.5)],
    False: [
        tp.OwnPosition(12.5, 37.1, -76.4, 300.0, 300.0, 22.0, 0.0, 0.0, vehicle_id=3),
        tp.Traffic("TRAFFIC", 37.2, -76.3, 310.0, -20.0, 1.5, 0.0, 9),
    ],
}
"""What ICAROUS says (True), and UxAS."""


# ---- what is read beside ----------------------------------------------------------------------


def talk(
    uxas: Handshake, icarous: Handshake, dialect: Dialect = Dialect.CRATOUS
) -> list[tuple[bool, bytes]]:
    """All that both ends say, in order: whether it is ICAROUS, and what."""
    found = [(False, uxas.start())]
    while not (icarous.done and uxas.done):
        up = icarous.feed(found[-1][1])
        found.append((True, up))
        found.append((False, uxas.feed(up)))
        if uxas.failed:
            return found
        icarous.feed(found[-1][1]) if uxas.done else None
    ours = dialect is Dialect.CRATOUS
    for up, lines in LINES.items():
        end = icarous if up else uxas
        for line in lines:
            if isinstance(line, tp.Hello) and not ours:
                continue
            data = tp.encode(line, dialect=dialect)
            seal = getattr(end, "seal", None)
            found.append((up, data if seal is None else seal.wrap(data, 5)))
    return found


def heard(
    said: list[tuple[bool, bytes]], one: Overheard, near_is_icarous: bool = True
) -> list[Said]:
    return [
        record for up, data in said for record in one.feed(up if near_is_icarous else not up, data)
    ]


def plain() -> tuple[Handshake, Handshake]:
    return ServerHandshake(DEFAULT_SECRET), ClientHandshake(DEFAULT_SECRET)


def sealed() -> tuple[Handshake, Handshake]:
    return SealedServer(keys={3: KEY}), SealedClient(keys={3: KEY})


def messages(found: list[Said]) -> set[tuple[tp.Direction, object]]:
    return {(s.direction, s.record) for s in found if s.direction is not None}


WANTED = {(tp.Direction.UP, m) for m in LINES[True]} | {
    (tp.Direction.DOWN, m) for m in LINES[False]
}


@pytest.mark.parametrize("near_is_icarous", [True, False])
@pytest.mark.parametrize("kind", ["plain", "with a key", "without one"])
def test_each_line_is_read_in_its_direction(kind: str, near_is_icarous: bool) -> None:
    one = Overheard(lambda vehicle: KEY if kind == "with a key" and vehicle == 3 else None)
    found = heard(talk(*(plain() if kind == "plain" else sealed())), one, near_is_icarous)
    assert messages(found) == WANTED
    assert (one.vehicle_id, one.authenticated) == (3, kind == "with a key")


def test_the_dialect_of_the_thesis_tells_itself() -> None:
    one = Overheard()
    found = messages(heard(talk(*plain(), Dialect.THESIS), one))
    assert (tp.Direction.UP, tp.SetVelocity(20.0, -5.0, 0.5)) in found
    assert {type(m) for _, m in found} == {
        tp.SetMode, tp.SetVelocity, tp.OwnPosition, tp.Traffic,
    }  # fmt: skip
    assert one.vehicle_id == 3, "of the position"


@given(st.data())
def test_how_it_is_cut_changes_nothing(data: st.DataObject) -> None:
    said = talk(*(plain() if data.draw(st.booleans()) else sealed()))
    pieces = []
    for up, text in said:
        while text:
            count = data.draw(st.integers(1, len(text)))
            pieces.append((up, text[:count]))
            text = text[count:]
    one = Overheard(lambda _: KEY)
    assert messages(heard(pieces, one)) == WANTED


@given(st.lists(st.tuples(st.booleans(), st.binary(max_size=300)), max_size=20), st.booleans())
def test_nothing_that_comes_raises(pieces: list[tuple[bool, bytes]], opened: bool) -> None:
    one = Overheard(lambda _: KEY)
    for up, text in talk(*sealed()) if opened else []:
        one.feed(up, text)
    heard(pieces, one)
    one.skip()
    heard(pieces, one)


def test_who_has_another_key_reads_and_does_not_authenticate() -> None:
    one = Overheard(lambda _: b"x" * 32)
    assert messages(heard(talk(*sealed()), one)) == WANTED
    assert one.other_key
    assert not one.authenticated


def test_a_forged_packet_is_told_and_is_no_line() -> None:
    one, said = Overheard(lambda _: KEY), talk(*sealed())
    heard(said, one)
    forged = SealedClient(keys={3: b"y" * 32})
    forged._sealed(True, b"y" * 32, 3, (b"0" * 32, b"1" * 32))
    assert forged.seal is not None
    forged.seal.sent = 50
    (found,) = one.feed(True, forged.seal.wrap(tp.encode(tp.SetMode("ACTIVE", 9)), 9))
    assert getattr(found.record, "what", "") == FORGED


def test_a_refused_opening_and_another_protocol_are_told_and_show_no_secret() -> None:
    secret = "0123456789abcdef" * 4
    one = Overheard()
    found = heard(talk(ServerHandshake(DEFAULT_SECRET), ClientHandshake(secret)), one)
    assert [getattr(s.record, "what", "") for s in found] == [REFUSED]
    assert secret[:8] not in str(found)
    assert one.feed(True, b"anything\n") == []
    (found,) = Overheard().feed(False, b"HTTP/1.1 200 OK\r\n")
    assert getattr(found.record, "what", "") == NO_OPENING


def test_after_bytes_were_left_out_it_goes_on_with_the_next_line() -> None:
    for ends in (plain(), sealed()):
        one, said = Overheard(lambda _: KEY), talk(*ends)
        heard(said, one)
        one.skip()
        seal = getattr(ends[1], "seal", None)
        line = tp.encode(tp.SetMode("PASSIVE", 2))
        cut = line if seal is None else seal.wrap(line, 6)
        again = line if seal is None else seal.wrap(line, 7)
        found = [s.record for s in one.feed(True, cut[10:] + again)]
        assert found[-1] == tp.SetMode("PASSIVE", 2) or tp.SetMode("PASSIVE", 2) in found
        assert not one.authenticated


def test_a_client_cannot_pass_for_uxas_before_uxas_has_spoken() -> None:
    """Lines of one without a key would else be read as if the hands had been shaken."""
    one, server = Overheard(lambda _: KEY), SealedServer(keys={3: KEY})
    found = one.feed(True, HELLO + ACCEPT + tp.encode(LINES[False][0]))
    found += one.feed(False, server.start() + b"error,another dialect than v2\n" + b" " * 64)
    assert [getattr(s.record, "what", "") for s in found] == [NO_OPENING]
    assert not one.is_open


def test_without_a_secret_hands_are_not_shaken() -> None:
    one = Overheard()
    one.feed(True, HELLO + ACCEPT + tp.encode(LINES[False][0]))
    found = one.feed(False, b"HTTP/1.1 400 Bad Request\r\n" * 5)
    assert [getattr(s.record, "what", "") for s in found] == [NO_OPENING]
    assert not one.is_open


def test_a_packet_that_does_not_end_is_told_without_a_key_too() -> None:
    one = Overheard()
    heard(talk(*sealed()), one)
    (found,) = one.feed(True, b"x" * 9000)
    assert getattr(found.record, "what", "") == DAMAGED
