"""MDM files at run time, and what is generated from the models: stubs, schema, docstrings."""

from __future__ import annotations

import ast
import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import jsonschema
import pytest

from cratous.bridge import lmcp
from cratous.bridge.lmcp import binary, generate, mdm, model, schema, stubs
from cratous.spec.errors import BadInput

OURS = """<?xml version="1.0"?>
<!DOCTYPE MDM SYSTEM 'MDM.DTD'>
<MDM>
  <SeriesName>OURS</SeriesName>
  <Namespace>acme/ours</Namespace>
  <Version>7</Version>
  <EnumList>
    <Enum Name="Mood"><Entry Name="Calm"/><Entry Name="Loud" Value="5"/><Entry Name="Odd"/></Enum>
  </EnumList>
  <StructList>
    <Struct Name="Buoy" Extends="CMASI/EntityState">
      <Field Name="Depth" Type="real32" Units="meter" Default="2.5"/>
      <Field Name="Mood" Type="Mood" Default="Loud"/>
      <Field Name="Place" Type="Location3D" Series="CMASI" Default="null" Optional="true"/>
      <Field Name="Marks" Type="uint16[3]" Series="" Default=""/>
      <Field Name="Moods" Type="Mood[]"/>
      <Field Name="Many" Type="string[]" LargeArray="true" MaxArrayLength="9"/>
      <Field Name="from" Type="char" Default="x"/>
      <Field Name="Parts" Type="LmcpObject[]"/>
    </Struct>
    <Struct Name="Second" ID="40"><Comment>Nothing in it.</Comment></Struct>
    <Struct Name="Third" Extends="Buoy"><Field Name="Flags" Type="bool[]"/></Struct>
  </StructList>
</MDM>
"""


@pytest.fixture
def ours(tmp_path: Path) -> Iterator[Path]:
    file = tmp_path / "OURS.xml"
    file.write_text(OURS)
    assert mdm.load(file) == ("OURS",)
    yield file
    model.remove("OURS")


def test_a_series_loaded_at_run_time_is_like_any_other(ours: Path) -> None:
    assert mdm.load(ours) == ()  # the same again is nothing new
    assert [s.id for s in model.load("OURS").structs.values()] == [41, 40, 42]
    assert model.load("OURS").enums["Mood"] == {"Calm": 0, "Loud": 5, "Odd": 2}
    buoy = lmcp.new("Buoy", ID=4, Marks=[1, 2, 3], Moods=["Odd", "Calm"], Many=["é", ""])
    assert (buoy.Depth, str(buoy.Mood), buoy.Place, buoy.Mood) == (2.5, "Loud", None, 5)
    assert isinstance(buoy, lmcp.types["afrl.cmasi.EntityState"])
    assert lmcp.full_names(buoy) == ("acme.ours.Buoy", "afrl.cmasi.EntityState")
    third = lmcp.new("acme.ours.Third", Flags=[True, False], Parts=[buoy, lmcp.new("Second"), None])
    for obj in (buoy, third, lmcp.new("OURS/Second")):
        raw = binary.pack(obj)
        assert binary.unpack(raw) == obj
        assert binary.lazy(raw) == obj
        assert lmcp.from_json(lmcp.to_json(obj)) == obj
        if obj is not third:  # a char of two bytes aside, XML holds everything
            assert lmcp.xml.loads(lmcp.xml.dumps(obj)) == [obj]
    assert "Depth: real32 [meter], default 2.5" in (type(buoy).__doc__ or "")
    ast.parse(stubs.stub("OURS").replace("from: str", "from_: str"))
    validator = jsonschema.Draft202012Validator(schema.schema(["Third"]))
    validator.validate(json.loads(lmcp.to_json(third)))


def test_a_removed_series_is_unknown_again(tmp_path: Path) -> None:
    file = tmp_path / "OURS.xml"
    file.write_text(OURS)
    mdm.load(file)
    raw = binary.pack(lmcp.new("Buoy"))
    assert binary.unpack(raw).Depth == 2.5
    model.remove("OURS")
    assert "Buoy" not in lmcp.types
    for read in (binary.unpack, binary.lazy):
        with pytest.raises(BadInput, match="unknown message series"):
            read(raw)
    with pytest.raises(BadInput, match="not a series that was added"):
        model.remove("CMASI")


def test_another_version_of_a_known_series_is_refused(ours: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.xml"
    for old, new in (("<Version>7", "<Version>8"), ('"2.5"', '"3.5"')):
        other.write_text(OURS.replace(old, new))
        with pytest.raises(BadInput, match="another model of a series that is known"):
            mdm.load(other)
    raw = bytearray(binary.pack(lmcp.new("Buoy")))
    raw[22] = 8
    raw[-4:] = bytes(4)
    with pytest.raises(BadInput, match="expected version 7; got 8"):
        binary.unpack(bytes(raw))


def test_files_may_refer_to_each_other(tmp_path: Path) -> None:
    texts = {
        "A.xml": '<Struct Name="Left"><Field Name="R" Type="BB/Right" Default="null"/></Struct>',
        "B.xml": '<Struct Name="Right" Extends="AA/Left"/>',
    }
    for name, text in texts.items():
        head = f"<SeriesName>{name[0] * 2}</SeriesName><Namespace>x/{name[0]}</Namespace>"
        (tmp_path / name).write_text(f"<MDM>{head}<StructList>{text}</StructList></MDM>")
    with pytest.raises(BadInput, match=r"A\.xml:1: Left\.R: unknown series"):
        mdm.load(tmp_path / "A.xml")
    assert mdm.load(*(tmp_path / name for name in texts)) == ("AA", "BB")
    right = lmcp.new("Right", R=lmcp.new("Right"))
    assert binary.unpack(binary.pack(right)) == right
    model.remove("BB")
    model.remove("AA")


@pytest.mark.parametrize(
    ("old", "new", "where", "what"),
    [
        ("<MDM>", "<MDM", "4", "not well-formed"),
        ("OURS<", "TOOLONGNAME<", "4", "wrong series name"),
        ("acme/ours", "acme//ours", "5", "wrong namespace"),
        (">7<", ">70000<", "6", "wrong version"),
        ('"Odd"', '"Calm"', "8", "name given twice"),
        ('Value="5"', 'Value="2"', "8", "value given twice"),
        ('Type="real32"', 'Type="real33"', "12", "unknown type"),
        ('"2.5"', '"deep"', "12", "wrong default"),
        ('"2.5"', '"1e39"', "12", "wrong default"),
        ('Default="Loud"', 'Default="Mild"', "13", "wrong default"),
        ('Series="CMASI"', 'Series="CMASY"', "14", "unknown series"),
        ("uint16[3]", "uint16[0]", "15", "wrong array"),
        ("uint16[3]", "map<a,b>", "15", "not well-formed"),
        ("uint16[3]", "a,b", "15", "wrong type"),
        ('LargeArray="true"', 'LargeArray="yes"', "17", "wrong LargeArray"),
        ('Name="from"', 'Name="names"', "18", "use themselves"),
        ('Name="from"', 'Name="2nd"', "18", "wrong name"),
        ('Name="from"', 'Name="Depth"', "18", "given twice"),
        ('Name="from"', 'Name="Heading"', "11", "field of an ancestor"),
        ('ID="40"', 'ID="0"', "21", "wrong ID"),
        ('ID="40"', 'Id="40"', "21", "unknown attribute"),
        ('Units="meter"', 'Unit="meter"', "12", "unknown attribute"),
        ('ID="40">', 'ID="40">5', "21", "text between elements"),
        ("<StructList>", "<StructList>x", "10", "text between elements"),
        ('Extends="Buoy"', 'Extends="Third"', "22", "extends itself"),
        ('Extends="Buoy"', 'Extends="Mood"', "22", "wrong parent"),
        ('Extends="Buoy"', 'Extends="Boy"', "22", "unknown type"),
        ("bool[]", "bool", "22", None),
        ("<StructList>", "<Structs>", "10", "not well-formed"),
        ("<EnumList>", "<StructList/><EnumList>", "10", "element given twice"),
        ("acme/ours", "afrl/cmasi", "", "one namespace"),
    ],
)
def test_mistakes_have_file_and_line(
    tmp_path: Path, old: str, new: str, where: str, what: str | None
) -> None:
    file = tmp_path / "BAD.xml"
    file.write_text(OURS.replace(old, new, 1))
    if what is None:
        assert mdm.read_all([file])[0].name == "OURS"
        return
    with pytest.raises(BadInput, match=what) as caught:
        mdm.load(file)
    if "well-formed" not in what and where:
        assert caught.value.where == f"{file}:{where}"
    assert "OURS" not in model.known()


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="there is no such file"):
        mdm.load(tmp_path / "none.xml")
    with pytest.raises(BadInput, match="not an MDM file"):
        mdm.parse("<AMASE/>")


def test_the_models_are_those_of_the_mdm_files(shared: Path, root: Path) -> None:
    files = [*(shared / "mdms").glob("*.xml"), *(shared / "mdms-daidalus").glob("*.xml")]
    assert len(files) == 8
    for file in files:
        data = mdm.parse(file.read_bytes(), str(file))
        held = root / "spec" / "lmcp" / f"{data['series']}.json"
        assert mdm.dumps(data) == held.read_text("utf-8")
    assert mdm.load(*files) == ()  # all known, and the same


def test_what_is_generated_is_up_to_date() -> None:
    for file, text in generate.files().items():
        assert file.read_text("utf-8") == text, f"{file.name}: run `make docs`"
        if file.suffix == ".pyi":
            ast.parse(text)
    assert generate.main(check=True) == 0


def test_modules_hold_the_classes() -> None:
    from cratous.bridge.lmcp.messages import cmasi
    from cratous.bridge.lmcp.messages.uxtask import TaskInitialized

    assert cmasi.AirVehicleState is lmcp.types["AirVehicleState"]
    assert cmasi.NavigationMode.Loiter is lmcp.enums["NavigationMode"].Loiter
    assert TaskInitialized(TaskID=1).TaskID == 1
    assert "Location3D" in dir(cmasi)
    assert not hasattr(cmasi, "TaskInitialized")
    assert cmasi.AirVehicleState.__module__ == "cratous.bridge.lmcp.messages.cmasi"


def test_the_published_schema_takes_golden_fields(shared: Path, root: Path) -> None:
    published = json.loads((root / "spec" / "lmcp" / "lmcp.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(published)
    seen = set()
    for name in ("open-lmcp", "open-lmcp-daidalus"):
        with gzip.open(
            shared / "vectors" / "lmcp" / f"{name}.jsonl.gz", "rt", encoding="utf-8"
        ) as f:
            for case in map(json.loads, f):
                if case["type"] in seen or case["kind"] not in ("rand", "edge"):
                    continue
                if len(case["hex"]) > 1500 or not case["fields"]:
                    continue
                seen.add(case["type"])
                ref = {"$ref": "#/$defs/" + case["type"].replace("/", "~1")}
                one = {"$defs": published["$defs"], **ref}
                jsonschema.Draft202012Validator(one).validate(case["fields"])
    assert len(seen) > 150


@pytest.mark.parametrize(
    "bad",
    [
        {"$type": "CMASI/Task", "TaskId": 1},
        {"$type": "CMASI/Task", "TaskID": 2**63},
        {"$type": "CMASI/Task", "TaskID": 1.5},
        {"$type": "CMASI/Task", "Required": 1},
        {"$type": "CMASI/LoiterAction", "LoiterType": 1},
        {"$type": "CMASI/LoiterAction", "Location": None},
        {"$type": "CMASI/LoiterAction", "Location": {"$type": "CMASI/Task"}},
        {"TaskID": 1},
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(bad: dict) -> None:
    validator = jsonschema.Draft202012Validator(schema.schema(["Task", "LoiterAction"]))
    assert not validator.is_valid(bad)
    with pytest.raises(BadInput):
        lmcp.from_dict(bad)
