"""The dialects of the text protocol that need no keys: the lines of the thesis's, and how they are told apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire_messages import ATTITUDE, OWN_POSITION, RESET, ROUTE_REQUEST, TRAFFIC, messages

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.dialects import LAYOUT_IN
from cratous.bridge.text_protocol.layouts import LAYOUTS, OURS_ALONE, Kind
from cratous.bridge.text_protocol.parser import OTHER_DIALECT
from cratous.spec.errors import BadInput

DOWN, UP = tp.Direction.DOWN, tp.Direction.UP
THESIS = tp.Dialect.THESIS
EXAMPLE = b"WAYPTtotal1,index1,lat51.433647,long-0.215516,alt100,speed100,\n"
"""The line that the thesis shows: "the first waypoint of a mission that has only one waypoint"."""

# The tags of the first eight are the thesis's (its text and table 3.1), as are the fields of WAYPT.
THESIS_LINES = [
    (tp.Waypoint(1, 100.0, 51.433647, -0.215516, 100.0, 0), EXAMPLE.decode()),
    (tp.FenceVertex("KEEPIN", 12, 1, 45.32, -121.02, 0.0, 1e5, 1),
     "GEOFNtype_KEEPIN_,totalvert12,vertIndex1,lat45.32,long-121.02,floor0,ceil100000,index1,\n"),
    (OWN_POSITION,
     "POSTNtimegps12.5,lat45.301234,long-120.998765,altabs700.25,altrel700.25,north21.213203,"
     "east-5.5,down1.25,hdop0.1,vdop0.1,numsats25,id1,\n"),
    (ATTITUDE, "ATTUDroll-12.5,pitch3.25,yaw0,\n"),
    (TRAFFIC,
     "OBJCTtype_TRAFFIC_,lat45.31,long-120.95,alt680,north-20,east1.5,down-0.75,index3,\n"),
    (tp.StartMission(), "COMNDtypeSTART_MISSION,\n"),
    (tp.WaypointReached(0), "WPRCHid1,\n"),
    (ROUTE_REQUEST,
     "WPREQtypeASTAR,slat45.3,slong-121,salt700,elat45.33,elong-120.95,ealt700,track90,vh22,vv0,\n"),
    (tp.FenceDone(1), "COMNDtypeGEOFN_SEND,id1,\n"),
    (RESET,
     "COMNDtypeRESET_SFT,lat45.306,long-120.988001,alt705,\n"),
    (tp.HardReset(), "COMNDtypeRESET_HRD,\n"),
    (tp.ForgetFences(), "COMNDtypeFORGET_GEOFN,\n"),
    (tp.ForgetWaypoints(), "COMNDtypeFORGET_WAYPT,\n"),
    (tp.StopMission(), "COMNDtypeSTOP_MISSION,\n"),
    (tp.UxasPlans(), "COMNDtypeUXAS_PLANS,\n"),
    (tp.IcarousPlans(), "COMNDtypeICAROUS_PLANS,\n"),
    (tp.EpochTold("UXAS", 5), "EPOCHtype_UXAS_,epoch5,\n"),
    (tp.WayOfAnother(3, 7, 45.3, -121.0, 700.0, 2),
     "OTHERid3,total7,lat45.3,long-121,alt700,index2,\n"),
    (tp.VelocityOfAnother(3, 10.0, 20.0, 1.5), "OVELOid3,north10,east20,down1.5,\n"),
    (tp.SetMode("ACTIVE"), "SETMOtype_ACTIVE_,\n"),
    (tp.SetVelocity(10.0, 20.0, 1.5), "SETVEnorth10,east20,down1.5,\n"),
    (tp.SetPosition(45.312, -120.955, 710.0), "SETPOlat45.312,long-120.955,alt710,\n"),
    (tp.GoToWaypoint(2), "GOTOWid3,\n"),
    (tp.RouteStart(), "RPRSPtypeST,\n"),
    (tp.RoutePoint(45.3, -121.0, 700.0, 22.0), "RPRSPtypeWP,lat45.3,long-121,alt700,spd22,\n"),
    (tp.RouteEnd(), "RPRSPtypeED,\n"),
    (tp.Heartbeat(7, 3.5), "HBEATseq7,time3.5,\n"),
    (tp.Hello(400), "HELLOid400,\n"),
    (tp.LinesMissing("WAYPT", 0, 7, 2, 4), "AGAINtype_WAYPT_,number0,total7,first2,last4,\n"),
    (tp.NotKnown("DIVE_NOW"), "NOCMDkindDIVE_NOW,\n"),
]  # fmt: skip


def parse(text: str | bytes, direction: tp.Direction = DOWN, **options: Any) -> list[tp.Record]:
    parser = tp.StreamParser(direction, **{"dialect": THESIS, **options})
    data = text.encode("latin-1") if isinstance(text, str) else text
    return parser.feed(data) + parser.finish()


@pytest.mark.parametrize(("message", "line"), THESIS_LINES)
def test_thesis_line_both_ways(message: tp.Message, line: str) -> None:
    assert tp.encode(message, dialect=THESIS).decode("ascii") == line
    direction = tp.direction_of(message)
    for written in (line, line.replace("\n", "\r\n")):
        assert parse(written, direction) == [message]


def test_every_message_is_in_the_table_above() -> None:
    assert {type(m) for m, _ in THESIS_LINES} == {layout.message for layout in LAYOUTS}
    assert all(len(layout.tag) == 5 for layout in LAYOUT_IN[THESIS].values())


@pytest.mark.parametrize(
    "line",
    [
        "WAYPTTOTAL1,INDEX1,LAT51.433647,LONG-0.215516,ALT100,SPEED100,\n",  # as its text says
        "WAYPTspeed100,alt100,long-0.215516,lat51.433647,index1,total1,\n",  # in any order
        "WAYPTtotal1.0,index1.0,lat51.433647,long-0.215516,alt100.000000,speed1e2,\n",
    ],
)
def test_how_else_the_thesis_s_example_may_be_written(line: str) -> None:
    assert parse(line) == parse(EXAMPLE)
    assert isinstance(parse(line)[0], tp.Waypoint)


def test_capitals_are_read_in_each_message() -> None:
    assert parse("COMNDTYPESTART_MISSION,\n") == [tp.StartMission()]
    fence = "GEOFNTYPE_KEEPOUT_,TOTALVERT3,VERTINDEX2,LAT1,LONG2,FLOOR3,CEIL4,INDEX5,\n"
    assert parse(fence) == [tp.FenceVertex("KEEPOUT", 3, 2, 1.0, 2.0, 3.0, 4.0, 5)]


@pytest.mark.parametrize(
    ("line", "what", "column"),
    [
        ("WAYPT,total1,index1,lat5,long0,alt1,speed1,\n", OTHER_DIALECT, 1),
        ("COMND,typeSTART_MISSION,\n", OTHER_DIALECT, 1),
        ("WAYPTtotal1,index0,lat5,long0,alt1,speed1,\n", "number out of range", 18),
        ("WAYPTtotal1,index1,lat5,long0,alt1,\n", "field missing", 36),
        ("WAYPTtotal1,index1,lat91,long0,alt1,speed1,\n", "angle out of range", 23),
        ("WAYPTtotal51,index1,lat5,long0,alt1,speed1,\n", "number out of range", 11),
        ("ATTUDroll1,ROLL1,pitch2,yaw3,\n", "field given twice", 12),
        ("ATTUDroll1,pitch2,yaw3\n", "field is not ended", 23),
        ("ATTUDrollnan,pitch2,yaw3,\n", "not a number", 10),
        ("ATTUDEroll1,pitch2,yaw3,\n", "label inside another", 6),
        ("attudroll1,pitch2,yaw3,\n", "unknown tag", 1),
        ("COMNDtypeDIVE,\n", "unknown type", 10),
        ("COMND\n", "field missing", 6),
        ("OBJCTtype_BIRD_,lat1,long1,alt1,north1,east1,down1,index1,\n", "unknown word", 10),
        ("ATTUDroll1,pitch2,yaw3,", "message cut off", 24),
    ],
)
def test_bad_line_is_an_error_with_its_column(line: str, what: str, column: int) -> None:
    (error,) = parse(line)
    assert isinstance(error, tp.WireError), error
    assert (error.what, error.line, error.column) == (what, 1, column)


def test_unknown_is_skipped_and_recorded() -> None:
    """Of the own state the thesis says heading and waypoint too, but not how they are written."""
    assert parse("NEWONEx1,\n\nabc\nATTUDroll1,pitch2,yaw3,heading4,\n") == [
        tp.Skipped(1, 1, "NEWONEx1,"),
        tp.Skipped(2, 1, ""),
        tp.Skipped(3, 1, "abc"),
        tp.Attitude(1.0, 2.0, 3.0),
        tp.Skipped(4, 24, "heading4"),
    ]


def test_a_value_that_cannot_be_sent_is_refused() -> None:
    for message in (tp.WaypointReached(-1), tp.SetVelocity(float("nan"), 0.0, 0.0)):
        with pytest.raises(BadInput, match=type(message).__name__):
            tp.encode(message, dialect=THESIS)


def as_written(message: tp.Message, dialect: tp.Dialect) -> tp.Message:
    """What the other end reads: without epochs and with six decimals of places, but in our dialect."""
    if dialect is tp.Dialect.CRATOUS:
        return message
    changes: dict[str, Any] = {}
    for field in LAYOUT_IN[dialect][type(message)].fields:
        value = getattr(message, field.attribute)
        if field.optional and field.label in OURS_ALONE:
            changes[field.attribute] = None
        elif field.kind is Kind.DEGREES and value is not None:
            changes[field.attribute] = round(value, 6)
    return replace(message, **changes)


@pytest.mark.parametrize("dialect", tp.Dialect)
@given(st.sampled_from(list(tp.Direction)).flatmap(lambda d: st.lists(messages(d), min_size=1)))
def test_format_and_parse_round_trip(dialect: tp.Dialect, sent: list[tp.Message]) -> None:
    data = b"".join(tp.encode(message, dialect=dialect) for message in sent)
    read = parse(data, tp.direction_of(sent[0]), dialect=dialect, original_peer=True)
    assert read == [as_written(message, dialect) for message in sent]


@pytest.mark.parametrize("direction", tp.Direction)
def test_the_thesis_s_lines_at_every_split(direction: tp.Direction) -> None:
    lines = [line for message, line in THESIS_LINES if tp.direction_of(message) is direction]
    stream = "".join([*lines, "WPRCHid\r\n", "HELLO,id1.0,\n", *lines]).encode()
    whole = parse(stream, direction)
    assert len(whole) == 2 * len(lines) + 2
    for at in range(len(stream) + 1):
        parser = tp.StreamParser(direction, dialect=THESIS)
        assert parser.feed(stream[:at]) + parser.feed(stream[at:]) + parser.finish() == whole


@given(
    st.sampled_from([line.encode() for _, line in THESIS_LINES]),
    st.lists(st.tuples(st.integers(0, 200), st.binary(max_size=3)), min_size=1, max_size=4),
    st.integers(0, 3),
)
def test_a_damaged_line_never_raises_and_the_next_one_is_read(
    line: bytes, damage: list[tuple[int, bytes]], cut: int
) -> None:
    for at, noise in damage:
        at %= len(line)
        line = line[:at] + noise + line[at + cut :]
    for direction in tp.Direction:
        *records, last = parse(line + b"\n" + EXAMPLE, direction)
        for record in (*records, last):
            assert isinstance(record, tp.Message | tp.WireError | tp.Skipped)
        if direction is DOWN:
            assert last == THESIS_LINES[0][0]


def test_memory_is_bounded() -> None:
    parser = tp.StreamParser(DOWN, dialect=THESIS)
    records = [r for _ in range(100) for r in parser.feed(b"x" * 1000)]
    assert [r.what for r in records if isinstance(r, tp.WireError)] == ["line too long"]
    assert len(parser._pending) <= 4096


@pytest.mark.parametrize("message", [message for message, _ in THESIS_LINES])
def test_each_line_of_another_dialect_is_known_as_one(message: tp.Message) -> None:
    direction = tp.direction_of(message)
    for written, read in ((THESIS, tp.Dialect.CRATOUS), (tp.Dialect.ORIGINAL, THESIS)):
        (error,) = parse(tp.encode(message, dialect=written), direction, dialect=read)
        assert isinstance(error, tp.WireError), error
        assert error.what == OTHER_DIALECT
