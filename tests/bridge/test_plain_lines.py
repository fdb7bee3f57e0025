"""Lines that are read at once: never otherwise than field by field, whatever stands in a field or between lines."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from fuzz_lines import WAYS, End, changed
from wire_messages import ATTITUDE, OWN_POSITION, RESET, ROUTE_REQUEST, TRAFFIC

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.authenticated_lines import Seal
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.layouts import LAYOUTS, ORIGINAL_LIMITS, WIDE_LIMITS

DOWN = tp.Direction.DOWN
WRITTEN: list[tp.Message] = [
    tp.Waypoint(3, 22.0, 37.1, -76.4, 300.0, 2),
    tp.FenceVertex("KEEPOUT", 12, 12, 45.0, -121.0, 0.0, 1e5, 64),
    OWN_POSITION,
    ATTITUDE,
    TRAFFIC,
    tp.WaypointReached(0),
    tp.EpochTold("UXAS", 5),
    tp.SetVelocity(1.5, -2.0, -0.0),
    tp.SetPosition(45.0, -121.0, 300.0),
    tp.Heartbeat(1, 0.5),
    tp.LinesMissing("WAYPT", 0, 3, 1, 2),
    tp.Hello(400),
]
EACH = [*WRITTEN, tp.GoToWaypoint(7)]
KINDS: list[tp.Message] = [
    *EACH,
    RESET,
    ROUTE_REQUEST,
    tp.StartMission(),
    tp.FenceDone(1),
    tp.HardReset(),
    tp.ForgetFences(),
    tp.ForgetWaypoints(),
    tp.StopMission(),
    tp.UxasPlans(),
    tp.IcarousPlans(),
    tp.WayOfAnother(3, 7, 45.3, -121.0, 700.0, 2),
    tp.VelocityOfAnother(3, 10.0, 20.0, 1.5),
    tp.SetMode("ACTIVE", 3),
    tp.RouteStart(4),
    tp.RoutePoint(45.3, -121.0, 700.0, 22.0, 4),
    tp.RouteEnd(4),
    tp.NotKnown("DIVE_NOW"),
]
CHANGED = 60
"""So many changes of each line are read."""
NUMBERS = (
    *("0.0", "-0.0", "00.0", "0.000000", "-0.000000", "1", "007.0", "+1.0", "1e3", "1.5", "1.", ".5", "--1.0"),
    *("90.000000", "90.000001", "-90.000001", "180.000000", "180.000001", "-180.000001", "360.0"),
    *("49.0", "50.0", "51.0", "64.0", "65.0", "255.0", "256.0", "99999.0", "100000.0", "100001.0", "-1.0"),
    *("9" * 14 + ".0", "1" + "0" * 14 + ".0", "1" + "0" * 15 + ".0", "0." + "1" * 12, "0." + "1" * 13),
    *("9" * 70 + ".0", "nan", "inf", "-inf", "1.0\r", " 1.0", "1.0 ", "1_0.0", "1x0", "1/0", "0x1.0", "1.0\0", "1.0\xe9"),
    *("_UXAS_", "_KEEPIN_", "_TRAFFIC_", "UXAS", "_uxas_", ""),
)  # fmt: skip


def numbers(line: str) -> Iterator[str]:
    """The line with each value replaced by each of these, and with other fields or ends."""
    tag, *fields = line.rstrip("\n").removesuffix(",").split(",")
    for k, field in enumerate(fields):
        label = field.rstrip("0123456789.-") if "_" not in field else "type"
        for value in NUMBERS:
            yield ",".join([tag, *fields[:k], label + value, *fields[k + 1 :], ""])
        yield ",".join([tag, *fields[:k], *fields[k + 1 :], ""])
        yield ",".join([tag, *fields[:k], field, *fields[k:], ""])
        yield ",".join([tag, *fields[:k], "other1.0", *fields[k:], ""])
    yield ",".join([tag, *reversed(fields), ""])
    whole = ",".join([tag, *fields, ""])
    yield from (whole[:-1], whole + "\r", whole + "\r\r", "\r" + whole, whole + " ", whole + ",")
    yield from (tag + whole, tag + "X" + whole[len(tag) :], tag.lower() + whole[len(tag) :])


@pytest.mark.parametrize("message", EACH, ids=lambda message: type(message).__name__)
@pytest.mark.parametrize("limits", [ORIGINAL_LIMITS, WIDE_LIMITS], ids=["original", "wide"])
@pytest.mark.parametrize("dialect", list(Dialect))
def test_a_line_is_read_at_once_as_in_two_pieces(
    message: tp.Message, limits: tp.Limits, dialect: Dialect
) -> None:
    way = tp.direction_of(message)
    for original_peer in (False, True):
        one, two = (
            tp.StreamParser(way, limits=limits, dialect=dialect, original_peer=original_peer)
            for _ in range(2)
        )
        for line in numbers(tp.encode(message, limits=WIDE_LIMITS).decode()):
            data = line.encode("latin-1") + b"\n"
            # as text: 1 and 1.0 are one value, 0.0 and -0.0 too
            assert repr(one.feed(data)) == repr(two.feed(data[:3]) + two.feed(data[3:])), data


@pytest.mark.parametrize("message", WRITTEN, ids=lambda message: type(message).__name__)
def test_what_our_writer_writes_is_read_at_once(
    message: tp.Message, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(tp.StreamParser, "_parse")  # field by field
    parser = tp.StreamParser(tp.direction_of(message))
    assert repr(parser.feed(tp.encode(message))) == repr([message])


def test_what_follows_the_beginning_of_a_line_belongs_to_it() -> None:
    line = tp.encode(ATTITUDE)
    parser = tp.StreamParser(DOWN)
    assert parser.feed(b"POSTN,") == []
    (record,) = parser.feed(line)
    assert isinstance(record, tp.WireError)
    assert parser.feed(line) == [ATTITUDE]


def test_a_line_too_long_is_none_however_it_goes_on() -> None:
    short, line = tp.encode(tp.WaypointReached(0)), tp.encode(ATTITUDE)
    parser = tp.StreamParser(DOWN, max_line=len(short) - 1)
    (record,) = parser.feed(line)
    assert isinstance(record, tp.WireError)
    assert record.what == "line too long"
    assert [type(r) for r in parser.feed(line[:-1])] == [tp.WireError]
    assert parser.feed(short) == []  # the end of the long one
    assert parser.feed(short) == [tp.WaypointReached(0)]


def test_all_kinds_are_there() -> None:
    assert {type(message) for message in KINDS} == {layout.message for layout in LAYOUTS}


@pytest.mark.parametrize("message", KINDS, ids=lambda message: type(message).__name__)
@pytest.mark.parametrize("dialect", WAYS, ids=lambda way: "v2" if way is None else way.value)
def test_a_changed_line_is_read_alike_however_it_is_cut(
    message: tp.Message, dialect: Dialect | None
) -> None:
    """Cut short to nothing at last, and changed at random: nothing raises, and where the bytes are cut is all one."""
    draw = random.Random(f"{type(message).__name__} {dialect}")
    seal, line = (
        Seal(1, bytes(32), bytes(32)),
        tp.encode(message, dialect=dialect or Dialect.CRATOUS),
    )
    if dialect is None:
        line = seal.wrap(line, 0)
    short = [line[:end] for end in range(len(line) + 1)]
    short += [one + b"\n" for one in short]
    refused = 0
    for data in [*short, *(changed(line, draw) for _ in range(CHANGED))]:
        for original in (False, True):
            way = tp.direction_of(message)
            whole = End(way, dialect, original).read(data)
            at = draw.randrange(len(data) + 1)
            assert End(way, dialect, original).read(data[:at], data[at:]) == whole, (data, at)
            # byte by byte a whole line has been every shorter one on the way
            if not line.startswith(data.removesuffix(b"\n")) or data in (line, line[:-1]):
                single = [data[k : k + 1] for k in range(len(data))]
                assert End(way, dialect, original).read(*single) == whole, data
            records, wrong = whole
            assert all(isinstance(r, tp.Message | tp.WireError | tp.Skipped) for r in records)
            refused += bool(wrong) or not any(isinstance(r, tp.Message) for r in records)
    assert refused > len(short), "most of what is changed is no message"
    assert End(way, dialect, True).read(line)[0] != [], "and the line itself is one"
