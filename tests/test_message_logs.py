"""Logs of all formats: what is written is read, what is damaged is said, nothing is lost silently."""

from __future__ import annotations

import json
import os
import random
import resource
import signal
import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.log import LogWriter, read_digest, read_envelopes, read_log
from cratous.services.logs import foxglove
from cratous.services.logs.entry import Entry, any_data, to_bytes, to_object, to_text, topic_of
from cratous.services.logs.export import export
from cratous.services.logs.follow import follow_log
from cratous.services.logs.selection import Selection
from cratous.services.logs.source import open_log
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.logs.store import LogStore
from cratous.spec.errors import BadInput

STATE = "afrl.cmasi.AirVehicleState"
UNKNOWN = b"LMCP\0\0\0\x0f\x01NOBODY\0\0\0\0\0\x07\0\x01\0\0\0\0"


def state(vehicle: int, k: int) -> object:
    place = lmcp.new("Location3D", Latitude=45.0 + k / 1000, Longitude=-120.0, Altitude=700.0)
    return lmcp.new(
        "AirVehicleState", ID=vehicle, Time=500 * k, Location=place, Airspeed=22.5, Mode="Loiter"
    )


def entries() -> Iterator[Entry]:
    """States of two vehicles as bytes, a command as JSON, an envelope, and a type nobody knows."""
    seq = 0
    for k in range(6):
        for vehicle in (400, 500):
            body = lmcp.binary.pack(state(vehicle, k))
            yield Entry(seq, 500 * k, "sim", STATE, body, None, None, "100", "66")
            seq += 1
    command = lmcp.new("MissionCommand", CommandID=7, VehicleID=400, FirstWaypoint=1)
    yield Entry(seq, 3000, "uxas", "afrl.cmasi.MissionCommand", lmcp.to_json(command))
    status = lmcp.new(
        "ServiceStatus", Info=[lmcp.new("KeyValuePair", Key="ä <&> €", Value='"quoted", 1')]
    )
    yield Entry(
        seq + 1, 3100, "uxas", "afrl.cmasi.ServiceStatus", lmcp.binary.pack(status),
        "eid100.sid5", "ground", "100", "7",
    )  # fmt: skip
    report = lmcp.new("WeatherReport", WindSpeed=float("nan"))
    yield Entry(seq + 2, 3200, "w", "afrl.cmasi.WeatherReport", lmcp.to_json(report))
    yield Entry(seq + 3, 3300, "other", "unknown.NOBODY.7", UNKNOWN)


def write(path: Path, made: list[Entry], **meta: object) -> Path:
    with LogStore(path, every_s=None, **meta) as store:
        for entry in made:
            store.keep(entry)
    return path


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return write(tmp_path / "log.sqlite", list(entries()), seed=3)


def read(path: Path, selection: Selection | None = None) -> list[Entry]:
    with open_log(path) as source:
        return list(source.entries(selection))


def copy(log: Path, name: str, form: str, **options: bool) -> Path:
    target = log.with_name(name)
    with open_log(log) as source:
        export(source, target, form, **options)
    return target


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


# --- bad input and bad disks


def test_what_is_no_log(tmp_path: Path) -> None:
    for name, data in (
        ("absent", None),
        ("empty", b""),
        ("noise", b"\x07" * 300),
        ("other.sqlite", None),
    ):
        if data is not None:
            (tmp_path / name).write_bytes(data)
    sqlite3.connect(tmp_path / "other.sqlite").execute("CREATE TABLE x(y)").connection.commit()
    for name in ("absent", "empty", "noise", "other.sqlite"):
        with pytest.raises(BadInput):
            read(tmp_path / name)


def damage(path: Path, offset: int, data: bytes = b"\xff" * 64) -> None:
    with path.open("r+b") as stream:
        stream.seek(offset)
        stream.write(data)


def big(tmp_path: Path) -> Path:
    made = [Entry(k, 500 * k, "sim", STATE, lmcp.binary.pack(state(400, k))) for k in range(1500)]
    return write(tmp_path / "big.sqlite", made)


def test_a_damaged_database_is_said_and_salvaged(tmp_path: Path) -> None:
    log = big(tmp_path)
    size = log.stat().st_size
    damage(log, size // 2 // 4096 * 4096, b"\xff" * 4096)
    with pytest.raises(BadInput, match="damaged"):
        read(log)
    with pytest.raises(BadInput, match="damaged"), open_log(log) as source:
        source.verify()
    target = tmp_path / "rest.sqlite"
    with pytest.raises(BadInput, match="damaged"):
        copy(log, target.name, "sqlite")
    assert not target.exists()
    with open_log(log) as source:
        done = export(source, target, "sqlite", salvage=True)
    assert done.damage is not None
    assert 0 < done.count < 1500
    assert [e.seq for e in read(target)] == list(range(done.count))


def test_a_changed_message_is_found(tmp_path: Path) -> None:
    log = big(tmp_path)
    database = sqlite3.connect(log)
    database.execute("UPDATE messages SET time_ms = 1 WHERE seq = 7")
    database.commit()
    with pytest.raises(BadInput, match="not those that were logged"), open_log(log) as source:
        source.verify()


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.floats(0, 1), flips=st.lists(st.floats(0, 1), max_size=3))
def test_truncated_and_damaged_mcap(cut: float, flips: list[float], tmp_path: Path) -> None:
    log = tmp_path / "log.sqlite"
    if not log.exists():
        write(log, list(entries()))
        copy(log, "whole.mcap", "mcap")
    data = bytearray((tmp_path / "whole.mcap").read_bytes())
    for flip in flips:
        data[int(flip * (len(data) - 1))] ^= 0x55
    size = max(9, int(cut * len(data)))
    hurt = tmp_path / "hurt.mcap"
    hurt.write_bytes(data[:size])
    found = []
    try:
        for entry in read(hurt) if size == len(data) else open_log(hurt).entries():
            found.append(entry)
    except BadInput:
        pass
    else:
        assert size == len(data)
    if not flips:
        assert found == list(entries())[: len(found)]


def hurt(data: bytearray, dice: random.Random) -> None:
    """Change, replace, take out or cut off some bytes."""
    for _ in range(dice.choice([1, 1, 2, 5])):
        at, kind = dice.randrange(len(data)), dice.random()
        if kind < 0.5:
            data[at] = dice.randrange(256)
        elif kind < 0.7:
            data[at : at + dice.randrange(1, 40)] = dice.randbytes(dice.randrange(1, 40))
        elif kind < 0.85:
            del data[at : at + dice.randrange(1, 100)]
        else:
            del data[at + 1 :]
        if not data:
            data += b"x"


@pytest.mark.parametrize("form", ["sqlite", "mcap", "jsonl", "xml", "frames", "lmcp", "uxas"])
def test_damage_of_any_kind_is_an_error_of_ours(log: Path, form: str) -> None:
    whole = copy(log, f"whole.{form}", form).read_bytes()
    dice, bad = random.Random(form), 0
    for _ in range(60):
        data = bytearray(whole)
        hurt(data, dice)
        log.with_name("hurt").write_bytes(data)
        try:
            with open_log(log.with_name("hurt")) as source:
                source.meta()
                source.topics()
                source.gaps()
                source.holes()
                source.verify()
                for entry in source.entries():
                    any_data(entry)
        except BadInput:
            bad += 1
    assert bad >= 20


def test_truncated_mcap_is_salvaged(tmp_path: Path) -> None:
    whole = copy(big(tmp_path), "whole.mcap", "mcap")
    short = tmp_path / "short.mcap"
    short.write_bytes(whole.read_bytes()[: whole.stat().st_size * 2 // 3])
    with pytest.raises(BadInput, match=r"truncated|not whole"):
        read(short)
    with open_log(short) as source:
        done = export(source, tmp_path / "rest.jsonl", "jsonl", salvage=True)
    assert done.damage is not None
    assert len(read(tmp_path / "rest.jsonl")) == done.count


def test_a_foreign_mcap_is_refused(tmp_path: Path) -> None:
    from mcap.writer import Writer

    writer = Writer(str(tmp_path / "x.mcap"))
    writer.start(profile="ros1")
    channel = writer.register_channel("/t", "json", 0)
    writer.add_message(channel, 0, b"{}", 0)
    writer.finish()
    with pytest.raises(BadInput, match="not an MCAP file of ours"):
        read(tmp_path / "x.mcap")


@pytest.mark.parametrize(
    "line",
    [
        "{",
        "[]",
        '{"seq": 0}',
        '{"seq": true, "time_ms": 0, "source": "", "topic": "", "body": {}}',
        '{"seq": 0, "time_ms": 0, "source": "", "topic": "", "body": []}',
        '{"seq": 0, "time_ms": 0, "source": "", "topic": "", "body": {}, "group": 7}',
        '{"seq": 0, "time_ms": 0, "source": "", "topic": "", "body": {"$lmcp": "?"}}',
        '{"seq": 0, "time_ms": 0, "source": "", "topic": "", "form": "lmcp", "body": {"$type": "x"}}',
    ],
)
def test_wrong_json_lines_say_which(tmp_path: Path, line: str) -> None:
    good = '{"seq": 0, "time_ms": 0, "source": "", "topic": "", "body": {}}'
    (tmp_path / "x.jsonl").write_text(f"{good}\n{line}\n")
    with pytest.raises(BadInput, match=r"x\.jsonl:2"):
        read(tmp_path / "x.jsonl")


def test_an_export_that_is_out_of_order_is_no_log(tmp_path: Path) -> None:
    line = '{"seq": 5, "time_ms": 0, "source": "", "topic": "t", "body": {}}\n'
    (tmp_path / "x.jsonl").write_text(line * 2)
    with pytest.raises(BadInput, match="not in order"):
        copy(tmp_path / "x.jsonl", "y.sqlite", "sqlite")
    assert not (tmp_path / "y.sqlite").exists()


def test_a_folder_that_cannot_be_written(tmp_path: Path, log: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(BadInput, match="cannot be written"):
        LogStore(tmp_path / "file" / "log.sqlite")
    with pytest.raises(BadInput, match="cannot be written"):
        LogWriter(tmp_path / "file" / "log.sqlite")
    with pytest.raises(BadInput, match="cannot be written"), open_log(log) as source:
        export(source, tmp_path / "file" / "x.jsonl", "jsonl")
    with pytest.raises(BadInput, match="exists already"):
        LogStore(log)
    assert read(log) == list(entries())


@contextmanager
def small_disk() -> Iterator[None]:
    """Files of this process may not grow beyond 300 kB: a disk that is full.

    Not a fixture: pytest itself must be able to write between the phases of a test.
    """
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, old[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)
        signal.signal(signal.SIGXFSZ, ignored)


def test_a_full_disk_loses_nothing_silently(tmp_path: Path) -> None:
    with small_disk():
        path = tmp_path / "log.sqlite"
        store = LogStore(path, batch=100, every_s=None, hold=500)
        body = lmcp.binary.pack(state(400, 1))
        good = [store.write(Entry(0, k, "sim", STATE, body)) for k in range(4000)]
        assert good[0]
        assert not good[-1]
        assert store.trouble
        assert store.lost == 4000 - store.committed - 500
        with SqliteLog(path) as log:
            assert [e.seq for e in log.entries()] == list(range(store.committed))
        # there is room again: what was held is written, the gap is named, and it goes on
        resource.setrlimit(
            resource.RLIMIT_FSIZE, (-1, resource.getrlimit(resource.RLIMIT_FSIZE)[1])
        )
        assert store.flush()
        assert store.write(Entry(0, 4000, "sim", STATE, body))
        lost = store.lost
        store.close()
        with SqliteLog(path) as log:
            log.verify()
            (gap,) = log.gaps()
            assert gap.missing == lost == log.holes()
            assert (gap.before_seq, gap.last_ms) == (4000, 3999)
            assert "full" in gap.reason or "I/O" in gap.reason
            assert log.last_seq() == 4000


def test_a_disk_that_stays_full_is_an_error_at_the_end(tmp_path: Path) -> None:
    with small_disk():
        store = LogStore(tmp_path / "log.sqlite", batch=100, every_s=None, hold=500)
        body = lmcp.binary.pack(state(400, 1))
        for k in range(4000):
            store.write(Entry(0, k, "sim", STATE, body))
        with pytest.raises(BadInput, match=r"not whole: [0-9]+ of 4000 messages are lost"):
            store.close()
        assert len(read(tmp_path / "log.sqlite")) == store.committed
        with pytest.raises(BadInput, match=r"cannot be written|not whole"):
            copy(tmp_path / "log.sqlite", "copy.xml", "xml")
        assert not (tmp_path / "copy.xml").exists()
        assert not list(tmp_path.glob(".copy*"))


def test_a_flight_log_on_a_full_disk_is_an_error_and_no_file(tmp_path: Path) -> None:
    with small_disk():

        def fill() -> None:
            with LogWriter(tmp_path / "log.sqlite") as writer:
                for k in range(4000):
                    writer.tap(Envelope(k, k, "sim", STATE, state(400, k)))

        with pytest.raises(BadInput, match="cannot be written"):
            fill()
        assert list(tmp_path.iterdir()) == []


# --- while it is written


def test_messages_are_on_disk_soon_though_none_follow(tmp_path: Path) -> None:
    store = LogStore(tmp_path / "log.sqlite", batch=1000, every_s=0.02)
    store.write(Entry(0, 0, "sim", STATE, "{}"))
    deadline = time.monotonic() + 120
    while not store.committed and time.monotonic() < deadline:
        time.sleep(0.01)
    assert len(read(tmp_path / "log.sqlite")) == 1
    store.close()
    with pytest.raises(BadInput, match="closed"):
        store.write(Entry(0, 0, "sim", STATE, "{}"))


def test_follow_sees_every_message_and_the_end(tmp_path: Path) -> None:
    import threading

    path = tmp_path / "log.sqlite"
    made = list(entries())

    def slowly() -> None:
        with LogStore(path, batch=3, every_s=0.01) as store:
            for entry in made:
                store.write(entry)
                time.sleep(0.005)

    writer = threading.Thread(target=slowly)
    writer.start()
    found = list(follow_log(path, Selection(), deadline=time.monotonic() + 60, poll_s=0.01))
    writer.join()
    assert found == [*made, None]
    assert not os.path.exists(f"{path}-wal")
    assert list(follow_log(path, Selection(types=("EntityState",)), new=False))[:-1] == made[:12]


def test_follow_waits_for_a_log_only_so_long(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no such file"):
        list(follow_log(tmp_path / "x", Selection(), deadline=time.monotonic() + 0.05))
    with LogStore(tmp_path / "log.sqlite", every_s=None) as store:
        store.write(next(entries()))
        store.flush()
        new = follow_log(
            tmp_path / "log.sqlite", Selection(), new=True, deadline=time.monotonic() + 0.05
        )
        assert list(new) == []
