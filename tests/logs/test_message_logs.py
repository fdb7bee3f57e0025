"""Logs of all formats: what is written is read, what is damaged is said, nothing is lost silently."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path

import jsonschema
import pytest
from log_tools import STATE, UNKNOWN, copy, entries, read, state, write

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.logs import foxglove
from cratous.services.logs.entry import Entry, any_data, to_bytes, to_object, to_text, topic_of
from cratous.services.logs.export import export
from cratous.services.logs.log import LogWriter, read_digest, read_envelopes, read_log
from cratous.services.logs.selection import Selection
from cratous.services.logs.source import open_log
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.spec.errors import BadInput


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return write(tmp_path / "log.sqlite", list(entries()), seed=3)


def test_what_is_written_is_read(log: Path) -> None:
    assert read(log) == list(entries())
    with open_log(log) as source:
        source.verify()
        closing = source.closing()
        assert closing is not None
        assert closing.messages == 16
        assert source.holes() == 0
        assert source.meta() == {"seed": 3}
        assert {t.topic: t.messages for t in source.topics()}[STATE] == 12
    assert not list(log.parent.glob("*-wal"))


def test_bodies_in_every_form() -> None:
    made = list(entries())
    assert to_object(made[0]) == state(400, 0)
    assert to_bytes(made[12])[:4] == b"LMCP"
    assert json.loads(to_text(made[0]))["ID"] == 400
    assert topic_of(bytes(made[0].body)) == STATE  # type: ignore[arg-type]
    assert topic_of(UNKNOWN) == "unknown.NOBODY.7"
    data, error = any_data(made[-1])
    assert set(data) == {"$lmcp"}
    assert "NOBODY" in str(error) or "series" in str(error)
    with pytest.raises(BadInput):
        to_object(made[-1])
    with pytest.raises(BadInput):
        topic_of(b"short")


@pytest.mark.parametrize("form", ["jsonl", "mcap", "sqlite"])
def test_these_formats_hold_everything(log: Path, form: str) -> None:
    there = copy(log, f"copy.{form}", form)
    assert read(there) == list(entries())
    back = copy(there, "back.sqlite", "sqlite")
    assert read_digest(back) == read_digest(log)


def test_mcap_with_bytes_gives_the_very_bytes_back(tmp_path: Path) -> None:
    body = bytearray(lmcp.binary.pack(state(400, 1)))
    body[-4:] = b"\0\0\0\0"  # "not computed", which packing anew would not give
    made = [Entry(0, 0, "a", STATE, bytes(body)), *list(entries())[12:13]]
    there = write(tmp_path / "log.sqlite", [made[0], made[1]._replace(seq=1)])
    found = read(copy(there, "b.mcap", "mcap", with_bytes=True))
    assert found[0].body == bytes(body)
    assert found[1].body == made[1].body


@pytest.mark.parametrize("form", ["xml", "lmcp", "frames", "uxas"])
def test_other_formats_name_what_they_cannot_hold(log: Path, form: str) -> None:
    target = log.with_name(f"copy.{form}")
    with open_log(log) as source:
        done = export(source, target, form)
    whole = form in ("lmcp", "frames")
    assert (done.count, len(done.left_out)) == ((16, 0) if whole else (15, 1))
    found = read(target) if form != "xml" else read_xml_with_nan(target, log)
    originals = list(entries())
    for entry, original in zip(found, originals, strict=False):
        if original.topic == "afrl.cmasi.WeatherReport" or original.topic.startswith("unknown"):
            continue  # not-a-number is not equal to itself
        assert to_object(entry) == to_object(original)
        assert entry.topic == original.topic
    if form in ("xml", "uxas"):
        assert [e.time_ms for e in found] == [e.time_ms for e in originals[: len(found)]]
    if form == "frames":
        assert [e[5:] for e in found[:12]] == [e[5:] for e in originals[:12]]
        assert found[13][5:] == originals[13][5:]
        assert found[15].body == UNKNOWN


def read_xml_with_nan(target: Path, log: Path) -> list[Entry]:
    """Not-a-number in XML is refused when it is read: said, with the line."""
    with pytest.raises(BadInput, match="a number"):
        read(target)
    with open_log(log) as source:
        export(source, target, "xml", Selection(to_ms=3100))
    return read(target)


def test_uxas_reads_its_table(log: Path) -> None:
    there = copy(log, "messageLog.db3", "uxas")
    rows = sqlite3.connect(there).execute("SELECT * FROM msg ORDER BY id").fetchall()
    assert rows[0][:6] == (1, 0, STATE, "", 100, 66)
    assert rows[0][6].startswith('<AirVehicleState Series="CMASI">')
    names = [r[1] for r in sqlite3.connect(there).execute("PRAGMA table_info(msg)")]
    assert names == ["id", "time_ms", "descriptor", "groupID", "entityID", "serviceID", "xml"]


def test_csv_is_flat(log: Path) -> None:
    import csv

    with copy(log, "copy.csv", "csv").open(newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 16
    assert rows[0]["Location.Latitude"] == "45.0"
    assert rows[0]["Airspeed"] == "22.5"
    assert json.loads(rows[13]["Info"])[0]["Key"] == "ä <&> €"
    assert rows[15]["$lmcp"]


def foxglove_accepts(schema: dict[str, object]) -> None:
    """The rules of Foxglove's reader of JSON Schemas: one plain type everywhere, no references."""
    kind = schema.get("type")
    assert kind in ("object", "array", "string", "number", "integer", "boolean"), schema
    assert not {"$ref", "anyOf", "oneOf", "allOf"} & set(schema)
    properties = schema.get("properties", {})
    assert isinstance(properties, dict)
    for part in properties.values():
        foxglove_accepts(part)
    if kind == "array":
        assert isinstance(schema["items"], dict)
        foxglove_accepts(schema["items"])


def test_every_type_has_a_schema_that_foxglove_reads() -> None:
    count = 0
    for topic in lmcp.types:
        schema = foxglove.schema_of(topic)
        foxglove_accepts(schema)
        jsonschema.Draft202012Validator.check_schema(schema)
        body = foxglove.without_null(json.loads(lmcp.to_json(lmcp.new(topic))))
        jsonschema.validate(body, schema)
        assert lmcp.from_dict(body) == lmcp.new(topic)
        count += 1
    assert count > 150


def test_mcap_opens_by_the_specification(log: Path) -> None:
    from mcap.reader import make_reader

    with copy(log, "copy.mcap", "mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert (
            summary.statistics.message_count == 16 + 2 * 12
        )  # and a fix and an arrow for each state
        found = list(reader.iter_messages())
    seen = set()
    for schema, channel, message in found:
        seen.add((channel.topic, channel.message_encoding, schema.name if schema else None))
        if schema is not None:
            assert schema.encoding == "jsonschema"
            body = json.loads(message.data)
            if "NaN" not in message.data.decode():
                jsonschema.validate(body, json.loads(schema.data))
        assert message.log_time == message.publish_time
    assert (STATE, "json", STATE) in seen
    assert ("/vehicles/400/fix", "json", "foxglove.LocationFix") in seen
    assert ("lmcp/unknown.NOBODY.7", "lmcp", None) in seen
    fix = next(m for _, c, m in found if c.topic == "/vehicles/500/fix" and m.log_time)
    assert json.loads(fix.data)["latitude"] == pytest.approx(45.001)
    assert json.loads(fix.data)["timestamp"] == {"sec": 0, "nsec": 500_000_000}


def test_what_the_originals_sent_is_a_log(shared: Path, tmp_path: Path) -> None:
    """UxAS's TCP stream as it was captured: 29 frames, the same bytes again from our log."""
    stream = shared / "vectors/openuxas/frames/waterway-stream.tcp.bin"
    with open_log(stream) as source:
        export(source, tmp_path / "log.sqlite", "sqlite")
    found = read(tmp_path / "log.sqlite")
    assert len(found) == 29
    assert all(to_object(entry).all_names[0] == entry.topic for entry in found)
    for form in ("mcap", "jsonl"):
        between = copy(tmp_path / "log.sqlite", f"between.{form}", form)
        assert copy(between, "again.frames", "frames").read_bytes() == stream.read_bytes()


def test_a_scenario_of_amase_is_a_log(shared: Path) -> None:
    scenario = shared / "vectors/amase/scenarios/02_waterway.xml"
    with open_log(scenario) as source:
        assert source.kind == "xml"
        found = list(source.entries())
    assert len(found) == 6
    assert [entry.time_ms for entry in found[:2]] == [1000, 1100]


# --- selection


@pytest.mark.parametrize(
    ("selection", "count"),
    [
        (Selection(), 16),
        (Selection(types=("AirVehicleState",)), 12),
        (Selection(types=("afrl.cmasi.EntityState",)), 12),
        (Selection(types=("CMASI/VehicleActionCommand",)), 1),  # a MissionCommand is one
        (Selection(types=("afrl.cmasi.*",)), 15),
        (Selection(types=("unknown.NOBODY.7",)), 1),
        (Selection(from_ms=1000, to_ms=1500), 4),
        (Selection(entities=(400,)), 7),
        (Selection(entities=(400, 500)), 13),
        (Selection(entities=(7,)), 0),  # a command's id is no vehicle's
        (Selection(text="Ä <&>"), 1),
        (Selection(sources=("uxas", "w")), 3),
        (Selection(types=("EntityState",), entities=(500,), from_ms=2000), 2),
    ],
)
def test_selection(log: Path, selection: Selection, count: int) -> None:
    assert len(read(log, selection)) == count
    assert len(read(copy(log, "c.jsonl", "jsonl"), selection)) == count


def test_a_type_that_nobody_knows_and_is_not_there_is_refused() -> None:
    with pytest.raises(BadInput, match="unknown type") as caught:
        Selection(types=("AirVehicelState",)).check_types([STATE])
    assert caught.value.item == "AirVehicelState"
    Selection(types=("unknown.NOBODY.7",)).check_types(["unknown.NOBODY.7"])
    Selection(types=("afrl.*",)).check_types([STATE])


# --- the logs of flights, in the same schema


def test_a_flight_log_is_a_log(tmp_path: Path) -> None:
    flown = [Envelope(k, 500 * k, "sim", STATE, state(400, k)) for k in range(700)]
    with LogWriter(tmp_path / "log.sqlite", mission={"name": "m"}) as writer:
        for envelope in flown:
            writer.tap(envelope)
    found = read(tmp_path)
    assert len(found) == 700
    assert to_object(found[5]) == state(400, 5)
    with open_log(tmp_path) as source:
        source.verify()
        assert source.meta() == {"mission": {"name": "m"}}
    back = copy(copy(tmp_path / "log.sqlite", "c.mcap", "mcap"), "back.sqlite", "sqlite")
    assert read_digest(back) == writer.digest()
    assert list(read_envelopes(back)) == flown
    with SqliteLog(back) as log:
        assert log.meta() == {"mission": {"name": "m"}}


def test_a_log_of_bytes_reads_as_a_flight_log(log: Path) -> None:
    rows = read_log(log)
    first = [next(rows) for _ in range(15)]
    with pytest.raises(BadInput, match=r"NOBODY|series"):
        next(rows)
    assert json.loads(first[0].body)["$type"] == "CMASI/AirVehicleState"


def test_logs_of_the_first_version_are_read(tmp_path: Path) -> None:
    old = tmp_path / "log.sqlite"
    database = sqlite3.connect(old)
    database.executescript(
        "CREATE TABLE messages(seq INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, source TEXT NOT"
        " NULL, topic TEXT NOT NULL, body TEXT NOT NULL);"
        "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);"
    )
    text = lmcp.to_json(state(400, 2))
    database.execute("INSERT INTO messages VALUES(0, 5, 'sim', ?, ?)", (STATE, text))
    database.commit()
    assert read(old) == [Entry(0, 5, "sim", STATE, text)]
    with open_log(old) as source:
        assert source.gaps() == []
        assert source.closing() is None
        source.verify()
