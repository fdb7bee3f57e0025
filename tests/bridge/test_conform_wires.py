"""Suites `lmcp` and `frames`: the published vectors pass, and what is wrong fails."""

from __future__ import annotations

import gzip
import json
from collections import Counter
from pathlib import Path

import pytest

from cratous.bridge import envelope, lmcp
from cratous.bridge.sentinel import FrameStream, frame
from cratous.services.cli import main
from cratous.services.conform import frames, run, suite
from cratous.services.conform import lmcp as messages
from cratous.spec.errors import BadInput


def test_published_messages_both_ways(shared: Path) -> None:
    seen = 0
    for name in ("open-lmcp", "open-lmcp-daidalus"):
        report = run(suite("lmcp"), shared / "vectors" / "lmcp" / f"{name}.jsonl.gz", 3)
        assert [r.text for r in report.shown] == []
        assert not report.skipped
        seen += report.passed
    assert seen == 1312 + 70


def test_published_quirks(shared: Path) -> None:
    report = run(suite("lmcp"), shared / "vectors" / "lmcp" / "lmcp-quirks.jsonl", 3)
    assert [r.text for r in report.shown] == []
    assert (report.passed, report.skipped.total()) == (27, 0)


def test_captured_frames_and_robustness(shared: Path) -> None:
    folder = shared / "vectors" / "openuxas" / "frames"
    passed: Counter[str] = Counter()
    for file in sorted(folder.iterdir()):
        if file.suffix in (".bin", ".json", ".hex"):
            report = run(suite("frames"), file, 3)
            assert [r.text for r in report.shown] == [], file.name
            assert not report.skipped, file.name
            passed[file.name.split(".", 1)[1]] += report.passed
    assert passed["zmq.bin"] == 36
    assert passed["tcp.bin"] == 37
    assert passed["json"] == 36 + 32


def test_the_captured_session_decodes_whole(shared: Path) -> None:
    folder = shared / "vectors" / "amase"
    data = gzip.decompress((folder / "session-waterway-rate10.tcp.bin.gz").read_bytes())
    stream = FrameStream()
    objects = []
    for at in range(0, len(data), 1460):
        for payload in stream.feed(data[at : at + 1460]):
            message = envelope.parse(payload)
            obj = lmcp.binary.unpack(message.payload)
            assert lmcp.binary.pack(obj) == message.payload
            assert lmcp.full_names(obj)[0] == message.descriptor
            objects.append(obj)
    assert stream.pending == 0
    assert not stream.drops
    for rate in ("rate10", "rate1"):
        with gzip.open(
            folder / f"session-waterway-{rate}.jsonl.gz", "rt", encoding="utf-8"
        ) as lines:
            rows = [json.loads(line) for line in lines]
        received = [row for row in rows if row["dir"] == "in"]
        if rate == "rate10":
            assert len(received) == len(objects)
            pairs = zip(received, objects, strict=True)
            assert all(json.loads(lmcp.to_json(o)) == row["msg"] for row, o in pairs)
        for row in rows:
            if "hex" in row:
                obj = lmcp.binary.unpack(bytes.fromhex(row["hex"]))
                assert json.loads(lmcp.to_json(obj)) == row["msg"]
    counts = Counter(type(obj).__name__ for obj in objects)
    assert counts["AirVehicleState"] > 3000
    assert counts["SessionStatus"] > 1500


GOOD = {
    "type": "CMASI/KeyValuePair",
    "kind": "rand",
    "fields": {"$type": "CMASI/KeyValuePair", "Key": "é", "Value": "v"},
    "hex": lmcp.binary.pack(lmcp.new("KeyValuePair", Key="é", Value="v")).hex(),
    "xml": '<KeyValuePair Series="CMASI"><Key>é</Key><Value>v</Value></KeyValuePair>',
}


@pytest.mark.parametrize(
    ("change", "label"),
    [
        ({"fields": {"$type": "CMASI/KeyValuePair", "Key": "e", "Value": "v"}}, "bytes to fields"),
        ({"hex": GOOD["hex"][:-8] + "00000000"}, "fields to bytes"),
        ({"hex": GOOD["hex"][:-8]}, "refused"),
        ({"fields": {"$type": "CMASI/KeyValuePair", "Kee": "é"}}, "refused"),
        ({"xml": GOOD["xml"].replace("é", "e")}, "xml"),
        ({"tcp_java": frame(b"a.B$lmcp|a.B||0|0$LMCP").hex()}, "tcp_java"),
    ],
)
def test_a_wrong_message_fails(change: dict, label: str) -> None:
    assert messages.judge(GOOD).status == "passed"
    result = messages.judge({**GOOD, **change})
    assert (result.status, result.label) == ("failed", label)


def test_what_is_no_message_case() -> None:
    assert messages.judge({"type": "x"}).status == "not covered"
    assert messages.judge({"type": "x", "hex": ""}).status == "not covered"
    with pytest.raises(BadInput):
        messages.judge({"type": "x", "hex": "zz"})
    kept = {"py": "same", "java": "same ", "cpp": "same mod checksum"}
    refused = messages.judge({"case": "short", "hex": GOOD["hex"][:-2], "outcome": kept})
    assert (refused.status, refused.label) == ("failed", "refused what all keep")
    assert (
        messages.judge({"case": "short", "hex": GOOD["hex"][:-2], "outcome": {}}).status == "passed"
    )


def test_a_wrong_stream_or_case_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    raw = envelope.enclose("afrl.cmasi.KeyValuePair", bytes.fromhex(GOOD["hex"])).pack()
    files = {
        "good.tcp.bin": frame(raw) * 3,
        "good.zmq.bin": raw,
        "good.tcp.hex": frame(raw).hex().encode(),
        "short.tcp.bin": frame(raw)[:-1],
        "noise.tcp.bin": frame(raw) + b"x" + frame(raw),
        "leading.tcp.bin": frame(raw).replace(b"=%d#" % len(raw), b"=0%d#" % len(raw)),
        "other.zmq.bin": raw.replace(b"|afrl.cmasi.KeyValuePair", b"|afrl.cmasi.KeyValuePear"),
        "cases.json": json.dumps([
            {"label": "hexed", "hex": frame(raw).hex(), "expected_if_strict": 1},
            {"label": "lost", "hex": frame(raw)[1:].hex(), "expected_if_strict": 1},
            {"label": "huge size", "expected_if_strict": 2},
            {"label": "never heard of"},
        ]).encode(),
    }  # fmt: skip
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
        report = run(suite("frames"), tmp_path / name, 9)
        expected = (3 if name == "cases.json" else 1, 0)
        if name == "cases.json":
            assert (report.passed, report.failed, report.skipped.total()) == (1, 2, 1)
            assert set(report.differences) == {"messages are lost"}
        elif name.startswith("good"):
            assert (report.passed, report.failed) == expected
        else:
            assert report.failed == 1, name
    assert main(["conform", "frames", str(tmp_path / "good.tcp.bin")]) == 0
    assert "1 passed, 0 failed" in capsys.readouterr().out
    for name, data in {"x.txt": b"", "y.json": b"{", "z.json": b"3", "w.hex": b"q"}.items():
        (tmp_path / name).write_bytes(data)
        assert main(["conform", "frames", str(tmp_path / name)]) == 2
    assert main(["conform", "frames", str(tmp_path / "none.bin")]) == 2


def test_every_robustness_case_says_what_it_sends() -> None:
    data, good = frames.sent("huge size") or (b"", [])
    assert b"99999999999999999999" in data
    assert len(good) == 1
    assert frames.sent("never heard of") is None


def test_a_folder_is_all_files_in_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    state = lmcp.new("AirVehicleState", ID=4)
    message = envelope.enclose(state.all_names[0], lmcp.binary.pack(state)).pack()
    (tmp_path / "b.tcp.bin").write_bytes(frame(message) * 3)
    (tmp_path / "a.zmq.bin").write_bytes(message)
    (tmp_path / "deeper").mkdir()
    assert main(["conform", "frames", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [Path(line.partition(":")[0]).name for line in lines[:2]] == ["a.zmq.bin", "b.tcp.bin"]
    assert lines[-1] == "2 passed, 0 failed"
    assert main(["conform", "frames", str(tmp_path / "deeper")]) == 3
