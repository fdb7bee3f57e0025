"""LMCP objects and their JSON form."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.bridge.lmcp import model
from cratous.spec.errors import BadInput


def test_models_hold_every_type() -> None:
    counts = {s: len(model.load(s).structs) for s in model.SERIES}
    assert counts == {
        "CRATOUS": 24,
        "CMASI": 60,
        "UXTASK": 29,
        "ROUTE": 14,
        "IMPACT": 35,
        "UXNATIVE": 17,
        "VEHICLES": 6,
        "PERCEIVE": 3,
        "DAIDALUS": 10,
    }
    assert len(lmcp.types) == 198
    for name in lmcp.types:
        obj = lmcp.new(name)
        assert lmcp.full_names(obj)[0] == name
        assert lmcp.from_json(lmcp.to_json(obj)) == obj
    assert all(isinstance(next(iter(lmcp.enums[name])), int) for name in lmcp.enums)


def test_series_ids_are_the_published_ones() -> None:
    assert model.load("CMASI").wire_id == 4849604199710720000
    assert model.load("UXNATIVE").wire_id == 6149751333668345413


def test_classes_inherit_and_topics_follow() -> None:
    state = lmcp.new("AirVehicleState", ID=400)
    assert isinstance(state, lmcp.types["afrl.cmasi.EntityState"])
    assert lmcp.types["CMASI/AirVehicleState"] is type(state)
    assert lmcp.full_names(state) == ("afrl.cmasi.AirVehicleState", "afrl.cmasi.EntityState")
    assert "afrl.cmasi.Nothing" not in lmcp.types
    assert not hasattr(state, "__dict__")


def test_short_name_of_two_series_means_ours() -> None:
    assert model.series_with("TaskProgress") == ("CRATOUS", "UXTASK")
    assert lmcp.new("TaskProgress").type_name == "CRATOUS/TaskProgress"
    assert lmcp.new("UXTASK/TaskProgress").type_name == "UXTASK/TaskProgress"


def test_defaults() -> None:
    zone = lmcp.new("KeepOutZone")
    assert zone.MinAltitudeType == lmcp.enums["AltitudeType"].AGL
    assert zone.MaxAltitudeType.name == "MSL"
    assert zone.Boundary is not None
    assert lmcp.new("CameraState").Centerpoint is None
    assert lmcp.new("DAIDALUS/GroundHeadingInterval").GroundHeadings == [0.0, 0.0]
    assert lmcp.new("Conflict").TimeToViolation_s == -1.0
    first, second = lmcp.new("AutomationRequest"), lmcp.new("AutomationRequest")
    first.TaskList.append(1)
    assert second.TaskList == []


def test_values_are_taken_in_the_field_s_own_type() -> None:
    point = lmcp.new("Location3D", Latitude=45, AltitudeType="AGL")
    assert type(point.Latitude) is float
    assert point.AltitudeType is lmcp.enums["AltitudeType"].AGL
    assert str(point.AltitudeType) == "AGL"
    assert lmcp.new("Location3D", AltitudeType=1).AltitudeType.name == "MSL"
    assert lmcp.new("AutomationRequest", TaskList=(1, 2)).TaskList == [1, 2]


@pytest.mark.parametrize(
    ("name", "fields", "item"),
    [
        ("AirVehicleState", {"Id": 1}, "AirVehicleState.Id"),
        ("AirVehicleState", {"ID": "1"}, "AirVehicleState.ID"),
        ("AirVehicleState", {"ID": 2**63}, "AirVehicleState.ID"),
        ("AirVehicleState", {"ID": True}, "AirVehicleState.ID"),
        ("AirVehicleState", {"Heading": "1"}, "AirVehicleState.Heading"),
        ("AirVehicleState", {"Heading": 1e39}, "AirVehicleState.Heading"),
        ("AirVehicleState", {"Location": None}, "AirVehicleState.Location"),
        ("AirVehicleState", {"Mode": "Nowhere"}, "AirVehicleState.Mode"),
        ("AirVehicleState", {"AssociatedTasks": [1, 2.5]}, "AirVehicleState.AssociatedTasks[1]"),
        ("GroundHeadingInterval", {"GroundHeadings": [1.0]}, "GroundHeadingInterval"),
        ("NoSuchType", {}, "NoSuchType"),
    ],
)
def test_wrong_values_are_refused_by_name(name: str, fields: dict, item: str) -> None:
    with pytest.raises(BadInput) as caught:
        lmcp.new(name, **fields)
    assert caught.value.item.startswith(item)


def test_unknown_field_names_the_nearest() -> None:
    with pytest.raises(BadInput, match="Groundspeed"):
        lmcp.new("AirVehicleState", GroundSpeed=1.0)


def test_copy_is_deep_and_equality_is_by_value() -> None:
    state = lmcp.new("AirVehicleState", ID=1, AssociatedTasks=[5])
    other = state.copy()
    assert other == state
    other.Location.Latitude = 1.0
    other.AssociatedTasks.append(6)
    assert state.Location.Latitude == 0.0
    assert state.AssociatedTasks == [5]
    assert other != state
    assert state.copy(ID=2).ID == 2
    assert lmcp.new("EntityState") != lmcp.new("AirVehicleState")


def test_repr_shows_what_is_not_default() -> None:
    state = lmcp.new("AirVehicleState", ID=1, Mode="Loiter")
    assert repr(state) == "AirVehicleState(ID=1, Mode=Loiter)"


def test_gated_command_holds_any_struct() -> None:
    gated = lmcp.new("GatedCommand", VehicleID=1, Command=lmcp.new("MissionCommand", CommandID=3))
    assert lmcp.from_json(lmcp.to_json(gated)) == gated
    assert lmcp.new("GatedCommand").Command is None
    with pytest.raises(BadInput):
        lmcp.new("GatedCommand", Command=3)


def test_json_form() -> None:
    text = lmcp.to_json(lmcp.new("Location3D", Latitude=0.1, Altitude=7))
    expected = (
        '{"$type":"CMASI/Location3D","Latitude":0.1,"Longitude":0.0,"Altitude":7.0,'
        '"AltitudeType":"MSL"}'
    )
    assert text == expected
    point = lmcp.new("Location3D")
    point.Altitude = 7  # assigned, not given to the constructor: still written as a real
    point.Latitude = 0.1
    assert lmcp.to_json(point) == expected


@given(st.floats(width=64), st.text(max_size=30), st.integers(-(2**63), 2**63 - 1))
def test_json_round_trip_is_exact(number: float, text: str, count: int) -> None:
    obj = lmcp.new("SafetyVerdict", Margin=number, Note=text, Vehicles=[count], Verdict="Unknown")
    written = lmcp.to_json(obj)
    assert lmcp.to_json(lmcp.from_json(written)) == written
    assert repr(lmcp.to_data(obj)) == repr(json.loads(written))
    read = lmcp.from_json(written)
    assert math.isnan(number) if math.isnan(read.Margin) else read.Margin == number
    assert math.copysign(1, read.Margin) == math.copysign(1, number) or math.isnan(number)
    assert json.loads(written, parse_constant=pytest.fail)["Note"] == text


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ('{"$type":"CMASI/AirVehicleState","Id":1}', "AirVehicleState.Id"),
        ('{"$type":"CMASI/AirVehicleState","Mode":0}', "AirVehicleState.Mode"),
        (
            '{"$type":"CMASI/AirVehicleState","Location":{"$type":"CMASI/Location3D","Latitude":""}}',
            "AirVehicleState.Location.Location3D.Latitude",
        ),
        ('{"$type":"CMASI/Nothing"}', "CMASI/Nothing"),
        ('{"$type":"CMASI/Location3D","Latitude":NaN}', ""),
        ('{"ID":1}', ""),
        ("[1]", ""),
        ("{", ""),
        ("[" * 100000, ""),
        ('{"$type":"CRATOUS/GatedCommand","Command":' * 100 + "null" + "}" * 100, None),
    ],
)
def test_bad_json_is_refused(text: str, item: str | None) -> None:
    with pytest.raises(BadInput) as caught:
        lmcp.from_json(text, "log:7")
    assert caught.value.where == "log:7"
    if item is not None:
        assert caught.value.item == item


def test_value_of_a_wrong_type_is_not_written() -> None:
    state = lmcp.new("AirVehicleState")
    state.ID = "four"
    for write in (lmcp.binary.pack, lmcp.xml.dumps):
        with pytest.raises(BadInput, match=r"AirVehicleState\.ID"):
            write(state)
