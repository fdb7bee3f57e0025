"""Logs that are none, are damaged or lie on a full disk; logs that are still being written."""

from __future__ import annotations

import os
import random
import resource
import sqlite3
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from log_tools import STATE, copy, entries, full_disk, read, state, write

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.logs.entry import Entry, any_data
from cratous.services.logs.export import export
from cratous.services.logs.follow import follow_log
from cratous.services.logs.log import LogWriter
from cratous.services.logs.selection import Selection
from cratous.services.logs.source import open_log
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.logs.store import LogStore
from cratous.spec.errors import BadInput

# --- bad input and bad disks


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return write(tmp_path / "log.sqlite", list(entries()), seed=3)


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


def test_a_full_disk_loses_nothing_silently(tmp_path: Path) -> None:
    with full_disk(300_000):
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
    with full_disk(300_000):
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
    with full_disk(300_000):

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
