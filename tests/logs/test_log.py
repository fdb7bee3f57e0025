"""The message log: complete or absent, one digest for one content, and records as plain data."""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mission_tools import must_fly, plain_mission, plain_vehicle

from cratous.services.bus import Envelope
from cratous.services.logs.log import (
    LogWriter,
    read_digest,
    read_envelopes,
    read_heard,
    read_log,
    read_meta,
)
from cratous.services.logs.records import canonical, fingerprint, from_data, to_data
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Position, Zone, ZoneKind

MESSAGES = [Envelope(k, 250 * k, "sim", "cratous.TruthState", {"k": k}) for k in range(1203)]


def write(path: Path, messages: list[Envelope], **meta: object) -> str:
    with LogWriter(path, encode=canonical, **meta) as writer:
        for message in messages:
            writer.tap(message)
        return writer.digest()


def test_what_is_written_is_read(tmp_path: Path) -> None:
    digest = write(tmp_path / "log.sqlite", MESSAGES, seed=7, mission={"name": "x"})
    rows = list(read_log(tmp_path / "log.sqlite"))
    assert [row.seq for row in rows] == list(range(1203))
    assert rows[3].time_ms == 750
    assert read_digest(tmp_path / "log.sqlite") == digest
    assert read_meta(tmp_path / "log.sqlite") == {"mission": {"name": "x"}, "seed": 7}


def test_envelopes_come_back(tmp_path: Path) -> None:
    import json

    write(tmp_path / "log.sqlite", MESSAGES)
    assert list(read_envelopes(tmp_path / "log.sqlite", decode=json.loads)) == MESSAGES


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        ({"$type": "CRATOUS/Heartbeat"}, "a body of another type"),
        ({"$type": "CRATOUS/TruthState", "North": "far"}, "wrong value"),
        ({"$type": "CRATOUS/Nothing"}, "Nothing"),
    ],
)
@pytest.mark.parametrize("read", [read_heard, read_envelopes])
def test_a_body_that_is_not_of_its_message_is_refused(
    tmp_path: Path, body: dict, wrong: str, read: Callable[[Path], Iterable[object]]
) -> None:
    write(tmp_path / "log.sqlite", [Envelope(0, 0, "sim", "cratous.TruthState", body)])
    with pytest.raises(BadInput, match=wrong) as raised:
        list(read(tmp_path / "log.sqlite"))
    assert raised.value.where == "message 0 (cratous.TruthState)"


@pytest.mark.parametrize(
    "changed",
    [
        replace(MESSAGES[5], time_ms=1),
        replace(MESSAGES[5], source="other"),
        replace(MESSAGES[5], topic="cratous.Other"),
        replace(MESSAGES[5], body={"k": 6}),
    ],
)
def test_any_change_changes_the_digest(tmp_path: Path, changed: Envelope) -> None:
    one = write(tmp_path / "one", MESSAGES[:10])
    other = write(tmp_path / "other", [*MESSAGES[:5], changed, *MESSAGES[6:10]])
    assert one != other


def test_meta_is_no_part_of_the_digest(tmp_path: Path) -> None:
    assert write(tmp_path / "a", MESSAGES, seed=1) == write(tmp_path / "b", MESSAGES, seed=2)


def broken(path: Path) -> None:
    with LogWriter(path, encode=canonical) as writer:
        writer.tap(MESSAGES[0])
        raise ZeroDivisionError


def test_an_error_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError):
        broken(tmp_path / "log")
    assert list(tmp_path.iterdir()) == []


def test_the_file_has_its_name_only_when_whole(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", encode=canonical) as writer:
        writer.tap(MESSAGES[0])
        assert not (tmp_path / "log").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_no_log_and_no_database(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no such file"):
        list(read_log(tmp_path / "absent"))
    (tmp_path / "text").write_text("this is no database, and long enough to be looked at" * 20)
    with pytest.raises(BadInput, match="not a message log"):
        list(read_log(tmp_path / "text"))
    sqlite3.connect(tmp_path / "empty").execute("CREATE TABLE x(y)").connection.commit()
    with pytest.raises(BadInput, match="not a message log"):
        read_meta(tmp_path / "empty")


class Colour(StrEnum):
    RED = "red"


class Pair(NamedTuple):
    a: int
    b: float


@dataclass(frozen=True)
class Thing:
    colour: Colour
    pair: Pair
    many: tuple[Pair, ...] = ()
    maybe: int | None = None
    two: tuple[float, str] = (0.0, "")


@given(
    st.builds(
        Thing,
        colour=st.just(Colour.RED),
        pair=st.builds(Pair, st.integers(), st.floats(allow_nan=False, allow_infinity=False)),
        many=st.lists(st.builds(Pair, st.integers(), st.just(0.5)), max_size=3).map(tuple),
        maybe=st.none() | st.integers(),
        two=st.tuples(st.just(1.5), st.text()),
    )
)
def test_records_come_back(thing: Thing) -> None:
    import json

    assert from_data(Thing, to_data(thing)) == thing
    assert from_data(Thing, json.loads(canonical(to_data(thing)))) == thing


@pytest.mark.parametrize(
    ("data", "item"),
    [
        ({"colour": "blue", "pair": {"a": 1, "b": 2.0}}, "Thing.colour"),
        ({"colour": "red", "pair": {"a": "1", "b": 2.0}}, "Thing.pair.a"),
        ({"colour": "red", "pair": {"a": True, "b": 2.0}}, "Thing.pair.a"),
        ({"colour": "red", "pair": {"a": 1}}, "Thing.pair"),
        ({"colour": "red"}, "Thing"),
        ({"colour": "red", "pair": {"a": 1, "b": 2.0}, "size": 1}, "Thing.size"),
        ({"colour": "red", "pair": {"a": 1, "b": 2.0}, "two": [1.0]}, "Thing.two"),
        ([], "Thing"),
    ],
)
def test_data_that_does_not_fit_is_refused(data: object, item: str) -> None:
    with pytest.raises(BadInput) as caught:
        from_data(Thing, data)
    assert caught.value.item == item


def test_not_a_number_has_no_canonical_text() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        canonical([math.nan])


def test_a_record_is_read_as_no_kind_of_it_that_has_the_same_fields() -> None:
    class Named(Thing):
        pass

    data = to_data(Thing(Colour.RED, Pair(1, 2.0)))
    assert type(from_data(Thing, data)) is Thing
    assert type(from_data(Named, data)) is Named


def test_a_mission_comes_back() -> None:
    mission = plain_mission(
        (plain_vehicle(1, Position(0.0, 1.0, 2.0)),),
        (must_fly(1, (1.0, 2.0, 3.0), label="t"),),
        source="m.yaml",
        zones=(Zone(3, ZoneKind.KEEP_IN, ((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)), 0.0, 99.0),),
        instances=(1,),
    )
    again = from_data(Mission, to_data(mission))
    assert again == mission
    assert fingerprint(to_data(again)) == fingerprint(to_data(mission))
