"""What Foxglove draws of a log: by the MCAP specification, by its schemas, and in the right place."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from cratous.bridge import lmcp
from cratous.services.logs.entry import Entry
from cratous.services.logs.mcap_log import McapWriter
from cratous.services.logs.views import GEO_JSON, LOCATION_FIX, SCENE, SCHEMAS, Views
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame

HOME = (45.0, -120.0)


def place(north_m: float, east_m: float, altitude_m: float = 700.0) -> Any:
    latitude, longitude = Projection(Frame(*HOME)).to_geodetic(north_m, east_m)
    return lmcp.new("Location3D", Latitude=latitude, Longitude=longitude, Altitude=altitude_m)


def state(number: int, north_m: float, east_m: float, heading: float, up_m: float = 0.0) -> Any:
    where = place(north_m, east_m, 700.0 + up_m)
    return lmcp.new("AirVehicleState", ID=number, Location=where, Heading=heading)


def zones() -> Iterator[Any]:
    corners = [place(0, 0), place(100, 0), place(0, 100)]
    yield lmcp.new("KeepInZone", ZoneID=1, Boundary=lmcp.new("Polygon", BoundaryPoints=corners))
    shape = lmcp.new("Rectangle", CenterPoint=place(0, 0), Width=200.0, Height=100.0)
    yield lmcp.new("KeepOutZone", ZoneID=2, Boundary=shape.copy(Rotation=90.0))
    shape = lmcp.new("Circle", CenterPoint=place(0, 0), Radius=500.0)
    yield lmcp.new("KeepOutZone", ZoneID=3, Boundary=shape)
    yield lmcp.new("KeepOutZone", ZoneID=4, Boundary=shape.copy(Radius=0.0))
    yield lmcp.new("KeepOutZone", ZoneID=5, Boundary=shape.copy(Radius=math.nan))


def views(*messages: Any) -> list[Any]:
    made = Views()
    return [
        view
        for k, message in enumerate(messages)
        for view in made.of(json.loads(lmcp.to_json(message)), message.all_names, 10**9 * k)
    ]


def geometry(view: Any) -> Any:
    assert view.schema == GEO_JSON
    feature = json.loads(view.data["geojson"])
    assert feature["type"] == "Feature"
    return feature["geometry"]["coordinates"]


def local(coordinates: list[list[float]]) -> list[tuple[float, float]]:
    projection = Projection(Frame(*HOME))
    return [projection.to_local(latitude, longitude) for longitude, latitude in coordinates]


def test_a_state_is_a_fix_and_an_arrow_east_north_and_up_of_the_first() -> None:
    found = views(state(4, 0, 0, 0.0), state(5, 300, 400, 90.0, 50.0))
    assert [view.topic for view in found] == [
        "/vehicles/4/fix",
        "/vehicles/scene",
        "/vehicles/5/fix",
        "/vehicles/scene",
    ]
    assert found[2].data["altitude"] == pytest.approx(750)
    assert found[2].data["timestamp"] == {"sec": 1, "nsec": 0}
    arrows = []
    for view in (found[1], found[3]):
        (entity,) = view.data["entities"]
        (arrow,) = entity["arrows"]
        arrows.append((arrow["pose"]["position"], arrow["pose"]["orientation"]))
    at, turned = zip(*arrows, strict=True)
    assert at[0] == {"x": 0.0, "y": 0.0, "z": 0.0}
    # altitudes are real32 on the wire, latitudes real64
    assert [at[1][axis] for axis in "xyz"] == pytest.approx([400, 300, 50], abs=1e-3)
    # an arrow without a turn points east; a heading of 0 is north, a quarter turn to the left
    assert turned[0]["z"] == pytest.approx(math.sin(math.pi / 4))
    assert (turned[1]["z"], turned[1]["w"]) == pytest.approx((0.0, 1.0))


def test_zones_and_ways_lie_where_they_are() -> None:
    kept_in, rectangle, circle = views(*zones())  # those without a shape give nothing
    ring = local(geometry(kept_in)[0])
    assert ring[0] == ring[-1]
    assert [round(x, 2) for corner in ring[:3] for x in corner] == [0, 0, 100, 0, 0, 100]
    ring = local(geometry(rectangle)[0])  # 200 m east-west, turned by 90 degrees
    assert {(round(abs(n)), round(abs(e))) for n, e in ring} == {(100, 50)}
    assert all(
        math.hypot(*corner) == pytest.approx(500, abs=0.01) for corner in local(geometry(circle)[0])
    )
    waypoints = [
        lmcp.new("Waypoint", Number=k, Latitude=45.0 + k / 100, Longitude=-120.0) for k in range(3)
    ]
    command = lmcp.new("MissionCommand", VehicleID=7, WaypointList=waypoints)
    response = lmcp.new("AutomationResponse", MissionCommandList=[command])
    for view in views(command, response):
        assert view.topic == "/vehicles/7/route"
        assert geometry(view) == [[-120.0, 45.0], [-120.0, 45.01], [-120.0, 45.02]]


@pytest.mark.parametrize(
    "message",
    [
        state(1, 0, 0, 0.0).copy(Location=lmcp.new("Location3D", Latitude=math.nan)),
        lmcp.new("KeepOutZone", Boundary=lmcp.new("AbstractGeometry")),
        lmcp.new("MissionCommand", VehicleID=1),
        lmcp.new("KeyValuePair"),
    ],
    ids=["no number", "no boundary", "no way", "nothing to see"],
)
def test_what_has_no_place_gives_nothing(message: Any) -> None:
    assert views(message) == []


def test_a_heading_that_is_no_number_still_has_a_fix() -> None:
    assert [view.schema for view in views(state(1, 0, 0, math.nan))] == [LOCATION_FIX]


def test_an_export_holds_what_the_specification_and_foxglove_want(tmp_path: Path) -> None:
    """Read by the library of MCAP's authors, every check sum verified; each message by its schema."""
    from mcap.reader import make_reader
    from mcap.records import ChunkIndex
    from mcap.stream_reader import StreamReader

    messages = [*zones(), *(state(4, 10.0 * k, 0, 0.0) for k in range(500))]
    there = tmp_path / "log.mcap"
    with there.open("wb") as out:
        writer = McapWriter(out)
        for seq, message in enumerate(messages):
            topic, body = message.all_names[0], lmcp.binary.pack(message)
            assert writer.write(Entry(seq, 500 * seq, "sim", topic, body)) is None
        writer.close({})
    with there.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_header().library.startswith("cratous")
        summary = reader.get_summary()
        found = list(reader.iter_messages(log_time_order=False))
        times = [message.log_time for _, _, message in reader.iter_messages()]
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.message_count == len(found) == len(messages) + 3 + 2 * 500
    assert summary.statistics.chunk_count == len(summary.chunk_indexes) > 1
    assert summary.statistics.channel_count == len(summary.channels)
    assert times == sorted(times)
    assert times[-1] == summary.statistics.message_end_time == 500 * (len(messages) - 1) * 10**6
    kinds = set()
    schemas = {number: json.loads(schema.data) for number, schema in summary.schemas.items()}
    for schema, channel, message in found:
        kinds.add((channel.topic, channel.message_encoding, schema.name, schema.encoding))
        assert schemas[schema.id]["type"] == "object"
        if message.sequence < 50:  # the rest is like these
            jsonschema.validate(json.loads(message.data), schemas[schema.id])
    assert {kind[1] for kind in kinds} == {"json"}
    assert {kind[3] for kind in kinds} == {"jsonschema"}
    assert {(topic, name) for topic, _, name, _ in kinds} >= {
        ("/vehicles/4/fix", LOCATION_FIX),
        ("/vehicles/scene", SCENE),
        ("/zones/2", GEO_JSON),
        ("afrl.cmasi.AirVehicleState", "afrl.cmasi.AirVehicleState"),
    }
    with there.open("rb") as stream:
        records = list(StreamReader(stream, validate_crcs=True, emit_chunks=True).records)
    indexes = [record for record in records if isinstance(record, ChunkIndex)]
    assert all(index.message_index_length > 0 for index in indexes)
    assert [type(record).__name__ for record in (records[0], records[-1])] == ["Header", "Footer"]


def test_the_schemas_of_views_are_schemas() -> None:
    for name, schema in SCHEMAS.items():
        jsonschema.Draft202012Validator.check_schema(schema)
        assert (schema["title"], schema["type"]) == (name, "object")
