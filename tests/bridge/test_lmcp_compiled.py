"""The generated and the lazy readers and writers do what the careful ones do."""

from __future__ import annotations

import copy
import importlib.util
import pickle
import random
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from cratous.bridge import lmcp
from cratous.bridge.lmcp import binary, compiled, reference_codec
from cratous.spec.errors import BadInput


@pytest.fixture(scope="module")
def fuzz() -> ModuleType:
    file = Path(__file__).parents[1] / "programs" / "fuzz_lmcp.py"
    spec = importlib.util.spec_from_file_location("fuzz_lmcp", file)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_type_is_written_and_read_as_the_careful_way(fuzz: ModuleType) -> None:
    rng = random.Random(5)
    for name in lmcp.types:
        for _ in range(4):
            obj = fuzz.random_object(rng, name)
            raw = binary.pack(obj)
            assert raw[8:-4] == bytes(reference_codec.pack(obj)), name
            assert binary.unpack(raw) == obj, name
            assert reference_codec.read(raw, 8, len(raw) - 4, "message") == obj, name
            assert binary.lazy(raw) == obj, name
            assert obj == binary.lazy(raw), name


def test_fuzzing_finds_nothing(fuzz: ModuleType) -> None:
    seen = fuzz.run(4000, 7)
    assert seen["read"] > 100
    assert seen["frames"] > 1000
    assert len(seen) > 15


def test_what_is_assigned_later_is_checked_or_converted_when_written() -> None:
    state = lmcp.new("AirVehicleState", ID=1)
    state.Heading = 7
    state.Mode = "Loiter"
    state.ID = np.int64(12)
    state.AssociatedTasks = (1, 2)
    read = binary.unpack(binary.pack(state))
    assert (read.Heading, str(read.Mode), read.ID, read.AssociatedTasks) == (
        7.0,
        "Loiter",
        12,
        [1, 2],
    )
    for name, wrong in {
        "ID": True,
        "Heading": False,
        "Mode": lmcp.enums["AltitudeType"].MSL,
        "Location": None,
        "AssociatedTasks": [1, True],
        "PayloadStateList": [lmcp.new("Location3D")],
        "Info": [lmcp.new("KeyValuePair", Key="x" * 65536)],
    }.items():
        bad = state.copy()
        setattr(bad, name, wrong)
        with pytest.raises(BadInput):
            binary.pack(bad)
    text = lmcp.new("KeyValuePair", Key="\udc80")
    with pytest.raises(BadInput, match="UTF-8"):
        binary.pack(text)


def test_an_object_within_itself_is_refused() -> None:
    gated = lmcp.new("GatedCommand")
    gated.Command = gated
    for write in (binary.pack, lmcp.xml.dumps, lmcp.to_json):
        with pytest.raises(BadInput, match="too deeply"):
            write(gated)


def test_lazy_messages_are_ordinary_once_looked_into() -> None:
    state = lmcp.new("AirVehicleState", ID=400, AssociatedTasks=[5])
    raw = binary.pack(state)
    lazy = binary.lazy(raw)
    cls = type(state)
    assert type(lazy) is not cls
    assert isinstance(lazy, lmcp.types["EntityState"])
    assert lmcp.full_names(lazy) == lmcp.full_names(state)
    assert binary.pack(lazy) == raw
    assert type(lazy) is not cls  # passed on without being read
    assert (lazy.ID, lazy.Heading) == (400, 0.0)
    assert type(lazy) is not cls  # numbers in front are read by themselves
    assert binary.pack(lazy) == raw
    assert lazy.Location.Latitude == 0.0
    assert type(lazy) is cls
    lazy.ID = 401
    assert binary.unpack(binary.pack(lazy)).ID == 401

    changed = binary.lazy(raw)
    changed.ID = 402  # the first access may be an assignment
    assert binary.unpack(binary.pack(changed)) == state.copy(ID=402)
    assert binary.lazy(raw).copy(ID=1) == state.copy(ID=1)
    assert repr(binary.lazy(raw)) == repr(state)
    assert binary.lazy(raw).checked() == state
    assert lmcp.to_json(binary.lazy(raw)) == lmcp.to_json(state)
    assert lmcp.xml.dumps(binary.lazy(raw)) == lmcp.xml.dumps(state)
    within = lmcp.new("GatedCommand", Command=binary.lazy(raw))
    assert binary.unpack(binary.pack(within)).Command == state
    with pytest.raises(AttributeError, match="NoSuch"):
        _ = binary.lazy(raw).NoSuch
    empty = binary.pack(lmcp.new("GroundVehicleState"))
    assert binary.pack(binary.lazy(empty)) == empty
    nothing = binary.pack(lmcp.new("AbstractGeometry"))
    assert binary.lazy(nothing) == lmcp.new("AbstractGeometry")


def test_a_lazy_message_that_is_wrong_says_so_when_looked_into() -> None:
    raw = bytearray(binary.pack(lmcp.new("Task", TaskID=1)))
    raw[-5] = 2  # the boolean Required
    raw[-4:] = bytes(4)
    lazy = binary.lazy(bytes(raw), "line 7")
    assert lazy.TaskID == 1
    for _ in range(2):
        with pytest.raises(BadInput, match=r"line 7: byte 42: Task\.Required.*0 or 1"):
            _ = lazy.Priority
    assert lazy.TaskID == 1
    with pytest.raises(BadInput, match="0 or 1"):
        lazy.complete()
    short = bytearray(raw[:29] + bytes(4))  # its only number would reach into the checksum
    short[7] = len(short) - 12
    with pytest.raises(BadInput, match=r"Task\.TaskID: message ends too early"):
        _ = binary.lazy(bytes(short)).TaskID
    interval = binary.lazy(binary.pack(lmcp.new("AltitudeInterval")))
    interval.Altitude[0] = 1.0  # a list that was read can be changed: the message is written anew
    assert binary.unpack(binary.pack(interval)).Altitude == [1.0, 0.0]
    for wrong in (b"LMCP", raw[:-1], bytes(raw[:8]) + b"\2" + bytes(raw[9:])):
        with pytest.raises(BadInput):
            binary.lazy(bytes(wrong))
    other = bytearray(raw)
    other[10] = 0x21
    with pytest.raises(BadInput, match="unknown message series"):
        binary.lazy(bytes(other))


def test_copies_of_the_standard_library(fuzz: ModuleType) -> None:
    rng = random.Random(3)
    for name in ("AirVehicleState", "ImpactAutomationRequest", "GraphRegion", "GatedCommand"):
        obj = fuzz.random_object(rng, lmcp.types[name].all_names[0])
        assert pickle.loads(pickle.dumps(obj)) == obj
        assert copy.deepcopy(obj) == obj
    state = lmcp.new("AirVehicleState")
    deep = copy.deepcopy(state)
    deep.Location.Latitude = 9.0
    assert state.Location.Latitude == 0.0


def test_messages_behind_each_other_are_split() -> None:
    one, two = (binary.pack(lmcp.new("Task", TaskID=i)) for i in (1, 2))
    assert list(binary.split(one + two)) == [one, two]
    for wrong in (one + b"LM", one + two[:-1], one + b"x" * 20):
        with pytest.raises(BadInput, match=f"byte {len(one)}"):
            list(binary.split(wrong))


def test_what_is_prepared_is_made_with_the_objects_in_its_fields(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(compiled, "_made", {})
    binary.prepare([lmcp.types["MissionCommand"]])
    assert {cls.__name__ for cls in compiled._made} >= {
        "MissionCommand",
        "Waypoint",
        "VehicleAction",
    }
