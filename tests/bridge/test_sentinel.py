"""Sentinel frames and envelopes: any segmentation, any rubbish, the same messages."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.bridge import envelope, sentinel
from cratous.bridge.bytesum import byte_sum
from cratous.bridge.sentinel import FrameStream, frame
from cratous.spec.errors import BadInput

GOOD = frame(b"a.B$lmcp|a.B||100|66$LMCP")


def pieces(data: bytes, seed: int) -> list[bytes]:
    rng = random.Random(seed)
    found, at = [], 0
    while at < len(data):
        size = rng.choice((1, 2, 7, 8, 64, 9000))
        found.append(data[at : at + size])
        at += size
    return found


def read(parts: list[bytes], **limits: int) -> tuple[list[bytes], FrameStream]:
    stream = FrameStream(**limits)
    got = [payload for part in parts for payload in stream.feed(part)]
    return got, stream


@given(st.binary(max_size=2000))
def test_sum_is_the_sum(data: bytes) -> None:
    assert byte_sum(data) == sum(data)
    assert byte_sum(memoryview(bytearray(data))) == sum(data)


def test_sum_wraps_at_32_bits() -> None:
    data = bytes([255]) * 17_000_000
    assert byte_sum(data) == 255 * 17_000_000 % 2**32


BAD = {
    b"rubbish": sentinel.OUTSIDE,
    b"+=+=+=": sentinel.BAD_LENGTH,  # with the next head it is a longer one
    b"+=+=+": sentinel.OUTSIDE,
    GOOD.replace(b"25#", b"3#"): sentinel.NO_TAIL,
    GOOD.replace(b"25#", b"12x#"): sentinel.BAD_LENGTH,
    GOOD.replace(b"25#", b"#"): sentinel.BAD_LENGTH,
    GOOD.replace(b"25#", b"-5#"): sentinel.BAD_LENGTH,
    GOOD.replace(b"25#", b"99999999999#"): sentinel.BAD_LENGTH,
    GOOD.replace(b"25#", b"1600000000#"): sentinel.TOO_LONG,
    GOOD[:-16] + b"7?^?^?^?^": None,
    GOOD[:40]: sentinel.NO_TAIL,
    GOOD[8:]: sentinel.OUTSIDE,
}


@pytest.mark.parametrize("bad", BAD, ids=lambda b: repr(b[:24]))
@pytest.mark.parametrize("seed", range(4))
def test_the_next_good_frame_arrives_and_the_fault_is_reported(bad: bytes, seed: int) -> None:
    data = GOOD + bad + GOOD + GOOD
    got, stream = read(pieces(data, seed))
    got += stream.close()
    assert got == [sentinel.unframe(GOOD)] * 3
    assert stream.drops
    first = stream.drops[0]
    assert first.offset == len(GOOD)
    assert BAD[bad] in (None, first.reason)
    assert stream.dropped_bytes == len(bad)
    assert stream.frames == 3
    with pytest.raises(BadInput, match=f"line: byte {len(GOOD)}"):
        raise first.error("line")


@settings(max_examples=300)
@given(st.data())
def test_segmentation_makes_no_difference(data: st.DataObject) -> None:
    alphabet = st.sampled_from(
        [GOOD, frame(b""), frame(GOOD), GOOD[:60], b"+=+=+=+=", b"12#@#@#@#@", b"!%!%!%!%", b"x",
         b"+=", b"?^?^?^?^", frame(bytes(300))]
    )  # fmt: skip
    stream = b"".join(data.draw(st.lists(alphabet, max_size=12)))
    whole, first = read([stream])
    whole += first.close()
    for seed in range(3):
        got, other = read(pieces(stream, seed))
        got += other.close()
        assert got == whole
        assert list(other.drops) == list(first.drops)
        assert (other.counts, other.dropped_bytes) == (first.counts, first.dropped_bytes)
    framed = sum(len(frame(p)) for p in whole)
    assert framed + first.dropped_bytes == len(stream)


def test_a_frame_in_a_frame_is_payload() -> None:
    inside = GOOD + sentinel.TAIL + b"1" + sentinel.END
    got, stream = read(pieces(frame(inside), 1))
    assert got == [inside]
    assert not stream.drops


def test_60_kb_and_byte_by_byte() -> None:
    big = bytes(range(256)) * 240
    data = frame(big) + GOOD
    for parts in ([data], [data[i : i + 1] for i in range(len(data))]):
        got, stream = read(parts)
        assert got == [big, sentinel.unframe(GOOD)]
        assert stream.pending == 0


def test_what_is_announced_is_not_held() -> None:
    stream = FrameStream(max_payload=1000)
    assert stream.feed(b"+=+=+=+=1600000000#@#@#@#@") == []
    assert stream.pending < 8
    assert stream.counts[sentinel.TOO_LONG] == 1
    for _ in range(1000):
        stream.feed(b"+=+=+=+=999#@#@#@#@" * 10)
        assert stream.pending <= 1100
    assert len(stream.drops) == 100
    assert stream.counts[sentinel.NO_TAIL] > 9000


def test_an_unfinished_frame_can_be_given_up() -> None:
    seen: list[sentinel.Drop] = []
    stream = FrameStream(on_drop=seen.append)
    assert stream.feed(b"+=+=+=+=60000#@#@#@#@abc" + GOOD) == []
    assert stream.pending > 0
    assert stream.abandon() == [sentinel.unframe(GOOD)]
    assert [d.reason for d in seen] == [sentinel.UNFINISHED]
    assert stream.abandon() == []
    assert stream.feed(GOOD) == [sentinel.unframe(GOOD)]


def test_unframe_takes_exactly_one() -> None:
    for wrong in (b"", GOOD + GOOD, GOOD + b"x", GOOD[:-1], GOOD[1:]):
        with pytest.raises(BadInput):
            sentinel.unframe(wrong)


def test_captured_frames_are_rebuilt(shared: Path) -> None:
    folder = shared / "vectors" / "openuxas" / "frames"
    files = sorted(folder.glob("*.zmq.bin"))
    assert len(files) == 36
    for file in files:
        raw = file.read_bytes()
        message = envelope.parse(raw)
        assert message.pack() == raw
        framed = file.with_name(file.name.replace(".zmq.", ".tcp.")).read_bytes()
        assert frame(raw) == framed
        assert sentinel.unframe(framed) == raw


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"abcdefghijklmnop", "end of the address"),
        (b"abc$defghijklmnop", "end of the attributes"),
        (b"a.B$lmcp|a.B|100$LMCP", "number of attributes"),
        (b"a.B$lmcp|a.B||1|2|3$LMCP", "number of attributes"),
        (b"$lmcp|a.B||1|2$LMCP", "empty address"),
        (b"a.B$lmcp|a.B||1|2$", "no payload"),
        (b"a$b|c$d", "too short"),
        (b"\xff.B$lmcp|a.B||1|2$LMCP", "UTF-8"),
        (b"a" * 5000 + b"$lmcp|a.B||1|2$LMCP", "end of the address"),
    ],
)
def test_malformed_envelopes_are_refused(data: bytes, what: str) -> None:
    with pytest.raises(BadInput, match=what):
        envelope.parse(data)


def test_envelopes_that_would_be_read_otherwise_are_not_written() -> None:
    good = envelope.enclose("a.B", b"LMCP$|", entity_id=100, service_id=66)
    assert envelope.parse(good.pack()) == good
    assert good.sent_by("TcpBridge", 100, 53).pack() == b"a.B$lmcp|a.B|TcpBridge|100|53$LMCP$|"
    assert envelope.enclose("a.B", b"x", address="fleet").address == "fleet"
    for bad in (
        envelope.enclose("a$B", b"x"),
        envelope.enclose("a.B", b"x", group="a|b"),
        envelope.enclose("a.B", b""),
        envelope.enclose("", b"x"),
        envelope.enclose("a" * 5000, b"x"),
    ):
        with pytest.raises(BadInput):
            bad.pack()


@given(
    noise=st.lists(st.sampled_from([b"+=+=+=+=", b"+=+=+=+=5#@#@#@#@", b"x", frame(b"abc")]), max_size=40),
    cuts=st.lists(st.integers(1, 30), max_size=40),
    most=st.integers(1, 6),
)  # fmt: skip
def test_a_stream_of_noise_is_given_up_at_the_same_place_however_it_is_cut(
    noise: list[bytes], cuts: list[int], most: int
) -> None:
    data = b"".join(noise) + b"." * 30
    whole, cut = FrameStream(max_strays=most), FrameStream(max_strays=most)
    expected, got, at = whole.feed(data), [], 0
    for size in [*cuts, len(data)]:
        got += cut.feed(data[at : at + size])
        at += size
    assert (got, cut.spoiled, cut.counts) == (expected, whole.spoiled, whole.counts)
    free = FrameStream()
    free.feed(data)
    assert len(expected) <= free.frames
    if not whole.spoiled:
        assert whole.frames == free.frames


def test_what_comes_after_too_much_noise_is_not_read() -> None:
    stream = FrameStream(max_strays=100)
    assert stream.feed(b"+=+=+=+=x" * 99 + frame(b"in time")) == [b"in time"]
    assert stream.feed(b"+=+=+=+=x" * 100 + frame(b"too late")) == []
    assert stream.spoiled
    assert stream.pending == 0
    assert stream.feed(frame(b"later")) == []
    assert stream.close() == []


def test_a_peer_that_is_gone_leaves_no_long_work_behind() -> None:
    stream = FrameStream(max_strays=1000)
    stream.feed(b"+=+=+=+=9999999#@#@#@#@" * 100_000)  # heads of frames that never come
    assert stream.close() == []
    assert sum(stream.counts.values()) == 1000
