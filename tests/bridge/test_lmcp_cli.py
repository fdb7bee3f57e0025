"""`cratous lmcp`, and the forms that it reads and writes."""

from __future__ import annotations

import gzip
import io
import json
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import pytest

from cratous.bridge import lmcp, sentinel
from cratous.bridge.lmcp import binary, differences, model, stored_forms
from cratous.services.cli import main
from cratous.spec.errors import BadInput

TASKS = [lmcp.new("uxas.messages.task.TaskInitialized", TaskID=n) for n in (1, 2)]
STATE = lmcp.new(
    "AirVehicleState", ID=400, Mode="Loiter", Info=[lmcp.new("KeyValuePair", Key="é<")]
)


@pytest.mark.parametrize("form", stored_forms.OUTPUTS)
@pytest.mark.parametrize("packed", [False, True])
def test_every_form_is_found_out_and_read_back(form: str, packed: bool) -> None:
    data = stored_forms.write(STATE, form)
    if packed:
        data = gzip.compress(data, mtime=0)
    (found,) = stored_forms.read(data, "file")
    assert found.error is None
    assert found.object == STATE
    again = stored_forms.write(found.object, form, found.envelope)
    assert again == (gzip.decompress(data) if packed else data)
    if form not in ("xml",):
        other = gzip.compress(again * 2) if form != "envelope" else again
        assert [f.object for f in stored_forms.read(other)] == [STATE] * (1 + (form != "envelope"))


def test_what_is_wrong_does_not_hide_the_others() -> None:
    good = stored_forms.write(STATE, "frames")
    bad = sentinel.frame(b"a.B$lmcp|a.B||1|2$LMCP....")
    found = list(stored_forms.read(good + b"x" * 20 + bad + good[:50] + good, "f"))
    assert sum(f.object == STATE for f in found) == 2
    errors = [str(f.error) for f in found if f.error]
    assert any("f: frame 2" in e for e in errors)
    assert any(f"byte {len(good)}: bytes outside of a frame" in e for e in errors)
    lines = b'{"$type":"CMASI/Task"}\n{"$type":"CMASI/Tusk"}\n\nnonsense\n'
    found = list(stored_forms.read(lines, "f"))
    assert [f.error is None for f in found] == [True, False, False]
    assert [f.where for f in found] == ["f:1", "f:2", "f:4"]


@pytest.mark.parametrize(
    "data", [b"", b"nothing of this", b"0g", b"6162", gzip.compress(b"LMCP", mtime=0)[:-3], b"\x1f\x8bxx",
             b"LMCP\0", b"<a", b"\xff\xfe{"],
)  # fmt: skip
def test_what_is_of_no_form_is_refused(data: bytes) -> None:
    with pytest.raises(BadInput):
        list(stored_forms.read(data, "f"))


def test_decode_and_encode(tmp_path: Path, capsysbinary: pytest.CaptureFixture[bytes]) -> None:
    file = tmp_path / "in.json"
    file.write_bytes(b"".join(stored_forms.write(t, "json") for t in TASKS))
    out = tmp_path / "out.bin"
    options = ["--entity", "100", "--service", "66", "--group", "g", "-o", str(out)]
    assert main(["lmcp", "encode", str(file), "--to", "frames", *options]) == 0
    assert out.read_bytes().startswith(b"+=+=+=+=119#@#@#@#@uxas.messages.task.TaskInitialized$")
    assert main(["lmcp", "decode", str(out)]) == 0
    assert capsysbinary.readouterr().out == file.read_bytes()
    assert main(["lmcp", "decode", str(out), "--envelope"]) == 0
    first = json.loads(capsysbinary.readouterr().out.splitlines()[0])
    assert (first["sourceGroup"], first["sourceEntityId"], first["sourceServiceId"]) == (
        "g",
        "100",
        "66",
    )
    assert first["message"] == {"$type": "UXTASK/TaskInitialized", "TaskID": 1}
    assert main(["lmcp", "decode", str(out), "--to", "xml", "--envelope"]) == 0
    assert b"<!-- uxas.messages.task.TaskInitialized lmcp|" in capsysbinary.readouterr().out
    assert main(["lmcp", "encode", str(out), "--to", "hex"]) == 0
    assert capsysbinary.readouterr().out == b"".join(stored_forms.write(t, "hex") for t in TASKS)
    out.write_bytes(out.read_bytes()[:-1])
    assert main(["lmcp", "decode", str(out)]) == 2
    result = capsysbinary.readouterr()
    assert result.out.count(b"\n") == 1
    assert b"unfinished frame" in result.err
    assert main(["lmcp", "encode", str(out)]) == 2
    assert capsysbinary.readouterr().out == b""


def test_decode_as_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "state.bin"
    file.write_bytes(binary.pack(STATE))
    assert main(["lmcp", "decode", str(file), "--to", "text"]) == 0
    text = capsys.readouterr().out
    assert "  Heading: 0.0 degree\n" in text
    assert "    Latitude: 0.0 degree\n" in text
    assert "    [0] KeyValuePair (CMASI/KeyValuePair)\n      Key: 'é<'\n" in text


def test_standard_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stdin = SimpleNamespace(buffer=io.BytesIO(binary.pack(TASKS[0])))
    monkeypatch.setattr("sys.stdin", stdin)
    assert main(["lmcp", "decode", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["TaskID"] == 1


def test_describe(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lmcp", "describe"]) == 0
    assert "DAIDALUS" in capsys.readouterr().out
    assert main(["lmcp", "describe", "CMASI/Task"]) == 0
    text = capsys.readouterr().out
    assert "Priority: byte, default 0" in text
    assert "IMPACT/PatternSearchTask" in text
    assert main(["lmcp", "describe", "AltitudeType"]) == 0
    assert "AGL = 0" in capsys.readouterr().out
    assert main(["lmcp", "describe", "VEHICLES"]) == 0
    assert "2 GroundVehicleState extends CMASI/EntityState" in capsys.readouterr().out
    assert main(["lmcp", "describe", "VEHICLES", "--stubs"]) == 0
    assert "class GroundVehicleState(_cmasi.EntityState):" in capsys.readouterr().out
    assert main(["lmcp", "describe", "SearchTask", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["extends"] == "CMASI/Task"
    assert main(["lmcp", "describe", "AirVehicleStat"]) == 2
    assert "AirVehicleState" in capsys.readouterr().err


def test_diff_of_messages_and_series(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {
        "a.bin": binary.pack(STATE),
        "b.json": stored_forms.write(STATE.copy(ID=401, AssociatedTasks=[5]), "json"),
        "c.xml": stored_forms.write(STATE, "xml"),
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    a, b, c = (str(tmp_path / name) for name in files)
    assert main(["lmcp", "diff", a, c]) == 0
    assert main(["lmcp", "diff", a, b]) == 1
    text = capsys.readouterr().out
    assert "AirVehicleState.ID: 400 | 401" in text
    assert "AirVehicleState.AssociatedTasks[0]: nothing | 5" in text
    assert main(["lmcp", "diff", a, b, "--json"]) == 1
    assert len(json.loads(capsys.readouterr().out)["differences"]) == 2
    assert main(["lmcp", "diff", a, "CMASI"]) == 2
    assert main(["lmcp", "diff", "CMASI", "CMASI"]) == 0
    mdm = tmp_path / "VEHICLES.xml"
    mdm.write_text(
        "<MDM><SeriesName>VEHICLES</SeriesName><Namespace>afrl/vehicles</Namespace>"
        '<Version>2</Version><StructList><Struct Name="GroundVehicleState" '
        'Extends="CMASI/EntityState"><Field Name="Wheels" Type="byte"/></Struct></StructList></MDM>'
    )
    capsys.readouterr()
    assert main(["lmcp", "diff", "VEHICLES", str(mdm)]) == 1
    text = capsys.readouterr().out
    assert "version: 1 | 2" in text
    assert "GroundVehicleState type: 2 | 1" in text
    assert "GroundVehicleState.Wheels: nothing | byte" in text


def test_differences_are_those_of_the_wire() -> None:
    one = lmcp.new("Location3D", Latitude=float("nan"), Longitude=0.0)
    assert list(differences.of_objects(one, one.copy())) == []
    (found,) = differences.of_objects(one, one.copy(Longitude=-0.0))
    assert found.path == "Location3D.Longitude"
    (found,) = differences.of_objects(lmcp.new("Task"), None)
    assert found.second == "null"
    lazy = binary.lazy(binary.pack(STATE))
    assert list(differences.of_objects(STATE, lazy)) == []


def test_schema_and_own_series(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lmcp", "schema", "Task"]) == 0
    data = json.loads(capsys.readouterr().out)
    jsonschema.Draft202012Validator(data).validate({"$type": "CMASI/Task", "TaskID": 1})
    assert main(["lmcp", "schema", "Tisk"]) == 2
    file = tmp_path / "OWN.xml"
    file.write_text(
        "<MDM><SeriesName>OWN</SeriesName><Namespace>own</Namespace><StructList>"
        '<Struct Name="Buoy"><Field Name="Depth" Type="real32" Units="meter"/></Struct>'
        "</StructList></MDM>"
    )
    try:
        assert main(["lmcp", "--mdm", str(file), "describe", "Buoy"]) == 0
        assert "Depth: real32 [meter], default 0.0" in capsys.readouterr().out
    finally:
        model.remove("OWN")
    file.write_text(file.read_text().replace("real32", "real"))
    assert main(["lmcp", "--mdm", str(file), "describe", "Buoy"]) == 2
    assert f"{file}:1" in capsys.readouterr().err
