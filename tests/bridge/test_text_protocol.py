"""The CRATOUS text protocol: lines, the streaming parser, the handshake."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire_messages import ATTITUDE, OWN_POSITION, RESET, ROUTE_REQUEST, TRAFFIC, messages

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.handshake import (
    DEFAULT_SECRET,
    HELLO,
    ClientHandshake,
    ServerHandshake,
)
from cratous.bridge.text_protocol.layouts import LAYOUTS
from cratous.spec.errors import BadInput

DOWN, UP = tp.Direction.DOWN, tp.Direction.UP


def parse(text: str | bytes, direction: tp.Direction = DOWN, **options: Any) -> list[tp.Record]:
    parser = tp.StreamParser(direction, **options)
    data = text.encode("latin-1") if isinstance(text, str) else text
    return parser.feed(data) + parser.finish()


def one_error(text: str | bytes, direction: tp.Direction = DOWN, **options: Any) -> tp.WireError:
    (error,) = parse(text, direction, **options)
    assert isinstance(error, tp.WireError), error
    return error


# -- formats -----------------------------------------------------------------------------------

ORIGINAL_LINES = [
    (tp.Waypoint(1, 22.0, 45.3, -121.0, 700.0, 0),
     "WAYPT,total1.0,speed22.000000,lat45.300000,long-121.000000,alt700.000000,index0.0,\n"),
    (tp.FenceVertex("KEEPIN", 4, 1, 45.32, -121.02, 0.0, 1e5, 1),
     "GEOFN,type_KEEPIN_,totalvert4.0,vertIndex1,lat45.320000,long-121.020000,floor0.000000,"
     "ceil100000.000000,index1.0,\n"),
    (tp.FenceVertex("KEEPOUT", 3, 2, 45.302, -120.97, 0.0, 1e5, 2),
     "GEOFN,type_KEEPOUT_,totalvert3.0,vertIndex2.0,lat45.302000,long-120.970000,floor0.000000,"
     "ceil100000.000000,index2.0,\n"),
    (tp.FenceDone(1), "COMND,typeGEOFN_SEND,id1.0,\n"),
    (tp.FenceDone(), "COMND,typeGEOFN_SEND,\n"),
    (tp.StartMission(), "COMND,typeSTART_MISSION,\n"),
    (RESET,
     "COMND,typeRESET_SFT,lat45.306000,long-120.988001,alt705.000000,\n"),
    (tp.SoftReset(), "COMND,typeRESET_SFT,\n"),
    (tp.HardReset(), "COMND,typeRESET_HRD,\n"),
    (tp.ForgetFences(), "COMND,typeFORGET_GEOFN,\n"),
    (tp.ForgetWaypoints(), "COMND,typeFORGET_WAYPT,\n"),
    (tp.StopMission(), "COMND,typeSTOP_MISSION,\n"),
    (tp.UxasPlans(), "COMND,typeUXAS_PLANS,\n"),
    (tp.IcarousPlans(), "COMND,typeICAROUS_PLANS,\n"),
    (OWN_POSITION,
     "POSTN,timegps12.500000,lat45.301234,long-120.998765,altabs700.250000,altrel700.250000,"
     "north21.213203,east-5.500000,down1.250000,hdop0.100000,vdop0.100000,numsats25.0,id1.0,\n"),
    (ATTITUDE, "ATTUD,roll-12.500000,pitch3.250000,yaw0.000000,\n"),
    (TRAFFIC,
     "OBJCT,type_TRAFFIC_,lat45.310000,long-120.950000,alt680.000000,north-20.000000,"
     "east1.500000,down-0.750000,index3.0,\n"),
    (tp.WaypointReached(0), "WPRCH,id0.0,\n"),
    (ROUTE_REQUEST,
     "WPREQ,typeASTAR,slat45.300000,slong-121.000000,salt700.000000,elat45.330000,"
     "elong-120.950000,ealt700.000000,track90.000000,vh22.000000,vv0.000000,\n"),
    (tp.EpochTold("ICAROUS", 5), "EPOCH,type_ICAROUS_,epoch5.0,\n"),
    (tp.WayOfAnother(3, 7, 45.3, -121.0, 700.0, 2),
     "OTHER,id3.0,total7.0,lat45.300000,long-121.000000,alt700.000000,index2.0,\n"),
    (tp.VelocityOfAnother(3, 10.0, 20.0, 1.5),
     "OVELO,id3.0,north10.000000,east20.000000,down1.500000,\n"),
    (tp.SetMode("ACTIVE"), "SETMOD,type_ACTIVE_,\n"),
    (tp.SetMode("PASSIVE"), "SETMOD,type_PASSIVE_,\n"),
    (tp.SetVelocity(10.0, 20.0, 1.5), "SETVEL,north10.000000,east20.000000,down1.500000,\n"),
    (tp.SetPosition(45.312, -120.955, 710.0),
     "SETPOS,lat45.312000,long-120.955000,alt710.000000,\n"),
    (tp.GoToWaypoint(2), "GOTOWP,id2,\n"),
    (tp.RouteStart(), "RPRSP,typeST,\n"),
    (tp.RoutePoint(45.3, -121.0, 700.0, 22.0),
     "RPRSP,typeWP,lat45.300000,long-121.000000,alt700.000000,spd22.000000,\n"),
    (tp.RouteEnd(), "RPRSP,typeED,\n"),
    (tp.Heartbeat(7, 3.5), "HBEAT,seq7.0,time3.500000,\n"),
    (tp.Hello(400), "HELLO,id400.0,\n"),
    (tp.LinesMissing("WAYPT", 0, 7, 2, 4),
     "AGAIN,type_WAYPT_,number0.0,total7.0,first2.0,last4.0,\n"),
    (tp.NotKnown("DIVE_NOW"), "NOCMD,kindDIVE_NOW,\n"),
]  # fmt: skip


@pytest.mark.parametrize(("message", "line"), ORIGINAL_LINES)
def test_original_line_both_ways(message: tp.Message, line: str) -> None:
    assert tp.encode(message, dialect=tp.Dialect.ORIGINAL).decode("ascii") == line
    assert parse(line, tp.direction_of(message)) == [message]


def test_every_message_is_in_the_table_above() -> None:
    assert {type(m) for m, _ in ORIGINAL_LINES} == {layout.message for layout in LAYOUTS}


def test_our_dialect() -> None:
    assert tp.encode(tp.SetMode("ACTIVE", 3)) == b"SETMOD,type_ACTIVE_,epoch3.0,\n"
    assert (
        tp.encode(tp.SetMode("ACTIVE", 3), dialect=tp.Dialect.ORIGINAL) == b"SETMOD,type_ACTIVE_,\n"
    )
    assert tp.encode(tp.SetMode("PASSIVE", 4, 7)) == b"SETMOD,type_PASSIVE_,epoch4.0,request7.0,\n"
    assert parse("RPRSP,typeED,request7.0,\n", DOWN) == [tp.RouteEnd(7)], "UxAS answers too"
    assert parse("SETMOD,epoch3.0,type_ACTIVE_,\n", UP) == [tp.SetMode("ACTIVE", 3)]
    assert b"lat45.123456789,long-0.000000001" in tp.encode(
        tp.SetPosition(45.123456789, -0.000000001, 0.0)
    )
    asked = tp.RouteRequest("RRT", *(1.0,) * 9, request=7)
    for message in (asked, tp.RouteStart(7), tp.RoutePoint(1.0, 1.0, 1.0, 1.0, 7), tp.RouteEnd(7)):
        line = tp.encode(message).decode("ascii")
        assert line.endswith("request7.0,\n")
        for k in range(len(line)):
            parser = tp.StreamParser(tp.direction_of(message))
            assert [*parser.feed(line[:k].encode()), *parser.feed(line[k:].encode())] == [message]
        plain = tp.encode(message, dialect=tp.Dialect.ORIGINAL).decode("ascii")
        assert plain == line.replace(",request7.0", "").replace(".000000000", ".000000")
    # A fence of ten vertices, which the original's own way of writing breaks.
    assert b"vertIndex1.0," in tp.encode(tp.FenceVertex("KEEPIN", 12, 1, 1.0, 1.0, 0.0, 1.0, 1))


@pytest.mark.parametrize(
    "message",
    [
        tp.SetVelocity(math.nan, 0.0, 0.0),
        tp.SetVelocity(math.inf, 0.0, 0.0),
        tp.SetVelocity(1e15, 0.0, 0.0),
        tp.SetPosition(91.0, 0.0, 0.0),
        tp.SetPosition(0.0, 181.0, 0.0),
        tp.WaypointReached(-1),
        tp.WaypointReached(256),
        tp.WaypointReached(1.5),  # type: ignore[arg-type]
        tp.SetMode("INACTIVE"),
        tp.Waypoint(51, 1.0, 1.0, 1.0, 1.0, 0),
        tp.SetVelocity("1", 0.0, 0.0),  # type: ignore[arg-type]
    ],
)
def test_value_that_cannot_be_sent_is_refused(message: tp.Message) -> None:
    with pytest.raises(BadInput, match=type(message).__name__):
        tp.encode(message)


def test_wide_limits() -> None:
    message = tp.Waypoint(500, 1.0, 1.0, 1.0, 1.0, 499)
    line = tp.encode(message, limits=tp.WIDE_LIMITS)
    assert parse(line, limits=tp.WIDE_LIMITS) == [message]
    assert one_error(line).what == "number out of range"


# -- lines that are refused --------------------------------------------------------------------

ATTUD = "ATTUD,roll1.0,pitch2.0,yaw3.0,\n"


@pytest.mark.parametrize(
    ("line", "what", "column"),
    [
        ("ATTUD,roll1.0,pitch2.0,\n", "field missing", 24),
        ("ATTUD,roll1.0,pitch2.0,yaw3.0\n", "field is not ended", 30),
        ("ATTUD,roll1.0,roll1.0,pitch2.0,yaw3.0,\n", "field given twice", 15),
        ("ATTUD,rollabc,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,rollnan,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll-inf,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll0x1.8p3,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll1.0e,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll1.0 ,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll1_0.0,pitch2.0,yaw3.0,\n", "not a number", 11),
        ("ATTUD,roll7,pitch2.0,yaw3.0,\n", "integer without .0", 11),
        ("ATTUD,roll1e300,pitch2.0,yaw3.0,\n", "number too large", 11),
        ("ATTUD,roll" + "1" * 390 + ".0,pitch2.0,yaw3.0,\n", "number too long", 11),
        ("ATTUD,barroll1.0,roll1.0,pitch2.0,yaw3.0,\n", "label inside another", 7),
        ("ATTUDE,roll1.0,pitch2.0,yaw3.0,\n", "unknown tag", 1),
        ("attud,roll1.0,pitch2.0,yaw3.0,\n", "unknown tag", 1),
        ("WAYPTtotal1,index1,lat51.4,\n", "line of another dialect", 1),
        ("COMNDTYPESTART_MISSION,\n", "line of another dialect", 1),
        ("ATTUDx,roll1.0,pitch2.0,yaw3.0,\n", "unknown tag", 1),
        ("ATTUD,roll1.0,pit\0ch2.0,yaw3.0,\n", "byte that is not printable", 18),
        ("ATTUD,roll1.0,\rpitch2.0,yaw3.0,\n", "byte that is not printable", 15),
        ("ATTUD,roll\xb2.0,pitch2.0,yaw3.0,\n", "byte that is not printable", 11),
        ("COMND,typeSTART_MISSIONX,\n", "unknown type", 11),
        ("COMND,\n", "field missing", 7),
        ("COMND,typeSTART_MISSION,typeRESET_HRD,\n", "field given twice", 25),
        ("COMND,typeRESET_SFT,lat1.0,\n", "field missing", 28),
        ("WPRCH,id1.5,\n", "number out of range", 9),
        ("WPRCH,id-1.0,\n", "number out of range", 9),
        ("WPRCH,id256.0,\n", "number out of range", 9),
        ("OBJCT,type_BIRD_,lat1.0,long1.0,alt1.0,north1.0,east1.0,down1.0,index1.0,\n",
         "unknown word", 11),
        ("ATTUD,roll1.0,pitch2.0,yaw3.0,", "message cut off", 31),
    ],
)  # fmt: skip
def test_bad_line_is_an_error_with_its_column(line: str, what: str, column: int) -> None:
    error = one_error(line)
    assert (error.what, error.line, error.column) == (what, 1, column)


def test_label_is_matched_whole() -> None:
    assert (
        one_error("WAYPT,flat9.0,total1.0,speed22.0,lat45.3,long-121.0,alt7.0,index0.0,\n").got
        == "'flat9.0'"
    )
    (vertex,) = parse(
        "GEOFN,index2.0,ceil9.0,vertIndex1.0,floor0.0,long7.0,lat45.3,totalvert3.0,type_KEEPIN_,\n"
    )
    assert vertex == tp.FenceVertex("KEEPIN", 3, 1, 45.3, 7.0, 0.0, 9.0, 2)


def test_bare_vertex_index_of_the_original() -> None:
    line = "GEOFN,type_KEEPIN_,totalvert12.0,vertIndex1,lat4.0,long7.0,floor0.0,ceil9.0,index2.0,\n"
    assert one_error(line).what == "integer without .0"
    assert isinstance(parse(line, original_peer=True)[0], tp.FenceVertex)


def test_unknown_is_skipped_and_recorded() -> None:
    records = parse("HELLO,a1,\n\n" + ATTUD.replace("yaw", "foo7,yaw"))
    assert records == [
        tp.Skipped(1, 1, "HELLO,a1,"),
        tp.Skipped(2, 1, ""),
        tp.Attitude(1.0, 2.0, 3.0),
        tp.Skipped(3, 24, "foo7"),
    ]


def test_goes_on_after_an_error() -> None:
    records = parse("ATTUD,rollx,\n" + ATTUD + "x" * 5000 + "\n" + ATTUD)
    assert [type(r).__name__ for r in records] == [
        "WireError", "Attitude", "WireError", "Attitude"
    ]  # fmt: skip
    assert isinstance(records[2], tp.WireError)
    assert (records[2].line, records[2].what) == (3, "line too long")


def test_memory_is_bounded() -> None:
    parser = tp.StreamParser(DOWN)
    records = [r for _ in range(1000) for r in parser.feed(b"x" * 1000)]
    assert [r.what for r in records if isinstance(r, tp.WireError)] == ["line too long"]
    assert len(parser._pending) <= 4096
    assert parser.feed(b"\n" + ATTUD.encode()) == [tp.Attitude(1.0, 2.0, 3.0)]
    assert parser.finish() == []


# -- properties --------------------------------------------------------------------------------


PIECES = st.lists(
    messages(DOWN).map(tp.encode)
    | st.binary(max_size=30)
    | st.sampled_from([b"\n", b"x" * 5000, b"ATTUD,rollabc,\n", b"WPRCH,id", b"1.0,\n"]),
    max_size=12,
)


@given(PIECES, st.data())
def test_any_segmentation_gives_the_same(pieces: list[bytes], data: st.DataObject) -> None:
    stream = b"".join(pieces)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=20)))
    parser = tp.StreamParser(DOWN)
    records: list[tp.Record] = []
    for start, end in zip([0, *cuts], [*cuts, len(stream)], strict=True):
        records += parser.feed(stream[start:end])
    assert records + parser.finish() == parse(stream)


@given(PIECES)
def test_byte_by_byte_gives_the_same(pieces: list[bytes]) -> None:
    stream = b"".join(pieces)
    parser = tp.StreamParser(DOWN)
    records = [r for i in range(len(stream)) for r in parser.feed(stream[i : i + 1])]
    assert records + parser.finish() == parse(stream)


@given(messages(DOWN), st.integers(0, 200), st.binary(min_size=1, max_size=3))
def test_damaged_line_never_raises(message: tp.Message, at: int, noise: bytes) -> None:
    line = tp.encode(message)
    at %= len(line)
    for record in parse(line[:at] + noise + line[at + len(noise) :]):
        assert isinstance(record, tp.Message | tp.WireError | tp.Skipped)


@given(messages(DOWN) | messages(UP), st.integers(0, 200), st.binary(max_size=3), st.booleans())
def test_a_line_that_is_read_at_once_is_read_as_piece_by_piece(
    message: tp.Message, at: int, noise: bytes, instead: bool
) -> None:
    """Whole lines of the plain form take another way through the parser; damaged they must not be another message."""
    line = tp.encode(message)
    at %= len(line)
    damaged = line[:at] + noise + line[at + len(noise) * instead :]
    whole = tp.StreamParser(tp.direction_of(message))
    pieces = tp.StreamParser(tp.direction_of(message))
    at_once = whole.feed(damaged) + whole.finish()
    records = [r for i in range(len(damaged)) for r in pieces.feed(damaged[i : i + 1])]
    # as text: 1 and 1.0 are one value, but not one kind of number
    assert repr(at_once) == repr(records + pieces.finish())
    assert [hash(r) for r in at_once if isinstance(r, tp.Message)] == [
        hash(r) for r in records if isinstance(r, tp.Message)
    ]


# -- handshake ---------------------------------------------------------------------------------


@given(st.integers(1, 90), st.integers(1, 90))
def test_handshake_in_any_pieces(down: int, up: int) -> None:
    server, client = ServerHandshake(), ClientHandshake()
    to_client, to_server = server.start(), client.start()
    for _ in range(200):
        if to_client:
            piece, to_client = to_client[:down], to_client[down:]
            to_server += client.feed(piece)
        if to_server:
            piece, to_server = to_server[:up], to_server[up:]
            to_client += server.feed(piece)
    assert server.done
    assert client.done
    assert server.rest == client.rest == b""


def test_handshake_with_glued_messages() -> None:
    server = ServerHandshake()
    assert server.feed(DEFAULT_SECRET.encode() + b"HELLO,id1.0,\n") == b"ok "
    assert server.rest == b"HELLO,id1.0,\n"
    client = ClientHandshake()
    assert client.feed(HELLO) == DEFAULT_SECRET.encode()
    assert client.feed(b"ok " + ATTUD.encode()) == b""
    assert client.done
    assert client.rest == ATTUD.encode()


def test_handshake_refusals() -> None:
    server = ServerHandshake()
    assert server.feed(b"0" * 63) == b""
    assert server.feed(b"0") == b"error"
    assert server.failed
    assert not server.done
    assert DEFAULT_SECRET not in server.failed
    for answer in (b"error", b"OK ", b"okay"):
        client = ClientHandshake()
        client.feed(HELLO)
        client.feed(answer)
        assert client.failed
        assert not client.done
    client = ClientHandshake()
    assert client.feed(b"SSH-2.0-Something") == b""
    assert "expected 'ICAROUS-UxAS_LMCP'" in client.failed
    with pytest.raises(ValueError, match="64 hexadecimal"):
        ServerHandshake("xyz")
