"""LMCP in XML: reading of real files, strictness, writing."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.spec.errors import BadInput

EXAMPLES = Path(__file__).resolve().parents[3] / "shared" / "examples" / "openuxas"
needs_examples = pytest.mark.skipif(not EXAMPLES.is_dir(), reason="no ../shared/examples")


def read(text: str, **options: bool) -> list:
    return lmcp.xml.loads(text, notes=[], **options)


def test_order_of_fields_and_missing_fields() -> None:
    (zone,) = read(
        '<KeepOutZone Series="CMASI"><ZoneID>3</ZoneID><Boundary><Circle Series="CMASI">'
        "<Radius>5</Radius><CenterPoint><Location3D><Longitude> 7.5 </Longitude></Location3D>"
        "</CenterPoint></Circle></Boundary><MaxAltitudeType>AGL</MaxAltitudeType></KeepOutZone>"
    )
    assert zone.ZoneID == 3
    assert zone.Boundary.CenterPoint.Longitude == 7.5
    assert zone.MaxAltitudeType.name == "AGL"
    assert zone.MinAltitudeType.name == "AGL"  # the default


def test_arrays_null_and_enums() -> None:
    (task,) = read(
        '<LineSearchTask Series="CMASI"><EligibleEntities><int64>1</int64><uint32>2</uint32>'
        "</EligibleEntities><DesiredWavelengthBands><WavelengthBand>EO</WavelengthBand>"
        "</DesiredWavelengthBands><PointList><null/><Location3D/></PointList></LineSearchTask>"
    )
    assert task.EligibleEntities == [1, 2]
    assert [band.name for band in task.DesiredWavelengthBands] == ["EO"]
    assert task.PointList == [None, lmcp.new("Location3D")]


def test_text_keeps_blanks_and_entities() -> None:
    (pair,) = read(
        "<KeyValuePair><Key>  a&lt;b&#13; </Key><Value><![CDATA[<x>]]></Value></KeyValuePair>"
    )
    assert pair.Key == "  a<b\r "
    assert pair.Value == "<x>"
    assert read(lmcp.xml.dumps(pair)) == [pair]


def test_real32_is_read_in_its_own_precision() -> None:
    (point,) = read("<Location3D><Altitude>0.1</Altitude><Latitude>0.1</Latitude></Location3D>")
    assert point.Altitude == 0.10000000149011612
    assert point.Latitude == 0.1


def test_container_gives_all_children() -> None:
    assert len(read("<Messages><Location3D/><KeyValuePair/></Messages>")) == 2


def test_field_twice_last_wins_and_is_noted() -> None:
    notes: list[str] = []
    (task,) = lmcp.xml.loads(
        "<Task><TaskID>1</TaskID>\n<TaskID>2</TaskID></Task>", "task.xml", notes
    )
    assert task.TaskID == 2
    assert notes == ["task.xml:2: Task.TaskID is given twice; the last one counts"]
    with pytest.warns(lmcp.xml.LmcpNote, match="given twice"):
        lmcp.xml.loads("<Task><TaskID>1</TaskID><TaskID>2</TaskID></Task>")


def test_unknown_field_is_noted_or_refused() -> None:
    text = "<AutomationRequest>\n<EntityLst/></AutomationRequest>"
    notes: list[str] = []
    lmcp.xml.loads(text, "r.xml", notes)
    assert len(notes) == 1
    assert "r.xml:2" in notes[0]
    assert "EntityList" in notes[0]
    with pytest.raises(BadInput, match="unknown field"):
        read(text, strict=True)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("<AutomationRequest><EntityList><int64>1<int64></EntityList></AutomationRequest>", "XML"),
        ("", "XML"),
        ("<A/>", "no LMCP object"),
        ("<A><B/></A>", "unknown message type"),
        ('<Task Series="ROUTE"/>', "unknown message type"),
        ("<TaskProgress/>", "several series"),
        ("<Task><TaskID>1.5</TaskID></Task>", "int64"),
        ("<Task><TaskID>9223372036854775808</TaskID></Task>", "int64"),
        ("<Task><TaskID>1_0</TaskID></Task>", "int64"),
        ("<Task><TaskID/></Task>", "int64"),
        ("<Task><Required>yes</Required></Task>", "true or false"),
        ("<Location3D><Latitude>45,3</Latitude></Location3D>", "a number"),
        ("<Location3D><Latitude>0x10</Latitude></Location3D>", "a number"),
        ("<Location3D><Latitude>NaN</Latitude></Location3D>", "a number"),
        ("<Location3D><Latitude>1e400</Latitude></Location3D>", "real64"),
        ("<Location3D><Altitude>1e39</Altitude></Location3D>", "real32"),
        ("<Location3D><AltitudeType>FOO</AltitudeType></Location3D>", "AGL or MSL"),
        ("<Location3D><Latitude><real64>1</real64></Latitude></Location3D>", "one value"),
        ("<Location3D>7</Location3D>", "text between elements"),
        ("<KeepOutZone><Boundary/></KeepOutZone>", "null"),
        ("<KeepOutZone><Boundary><Location3D/></Boundary></KeepOutZone>", "AbstractGeometry"),
        ("<KeepOutZone><Boundary><Circle/><Circle/></Boundary></KeepOutZone>", "more than one"),
        ("<Task><EligibleEntities><real64>1</real64></EligibleEntities></Task>", "<int64>"),
        ("<Task><EligibleEntities>1 2</EligibleEntities></Task>", "text between"),
        (
            '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/hostname">]>'
            "<KeyValuePair><Key>&x;</Key></KeyValuePair>",
            "entity",
        ),
        (
            '<!DOCTYPE a [<!ENTITY x "xx"><!ENTITY y "&x;&x;">]>'
            "<KeyValuePair><Key>&y;</Key></KeyValuePair>",
            "entity",
        ),
    ],
)
def test_bad_xml_is_refused_with_its_place(text: str, what: str) -> None:
    with pytest.raises(BadInput, match=what) as caught:
        lmcp.xml.loads(text, "f.xml", [])
    assert caught.value.where.startswith("f.xml:")


def test_missing_file() -> None:
    with pytest.raises(BadInput, match=r"no/such\.xml.*no such file"):
        lmcp.xml.read_file("no/such.xml")


def test_text_that_xml_cannot_hold() -> None:
    with pytest.raises(BadInput, match="control characters"):
        lmcp.xml.dumps(lmcp.new("KeyValuePair", Key="a\0"))


@given(st.text(st.characters(exclude_categories=("Cc", "Cs"), exclude_characters="\ufffe\uffff")))
def test_any_text_round_trips(text: str) -> None:
    pair = lmcp.new("KeyValuePair", Key=text)
    assert read(lmcp.xml.dumps(pair)) == [pair]


@needs_examples
def test_every_file_of_the_examples_reads() -> None:
    files = sorted(EXAMPLES.glob("*/inputs/**/*.xml"))
    assert len(files) > 15
    for path in files:
        (obj,) = lmcp.xml.read_messages(path, [])
        assert read(lmcp.xml.dumps(obj)) == [obj]


@needs_examples
def test_waterway_line_keeps_its_view_angle() -> None:
    (path,) = EXAMPLES.glob("waterway/inputs/tasks/1000*.xml")
    notes: list[str] = []
    (task,) = lmcp.xml.read_file(path, notes)
    assert [wedge.AzimuthCenterline for wedge in task.ViewAngleList] == [35.0]
    assert any("ViewAngleList is given twice" in note for note in notes)
