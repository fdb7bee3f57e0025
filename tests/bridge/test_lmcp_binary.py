"""LMCP in binary: noise, limits, and where implementations disagree.

The golden messages of the reference implementations are in test_conform_wires.py.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.bridge.lmcp import reference_codec
from cratous.spec.errors import BadInput

VECTORS = Path(__file__).resolve().parents[3] / "shared" / "vectors" / "lmcp"
needs_vectors = pytest.mark.skipif(not VECTORS.is_dir(), reason="no ../shared/vectors/lmcp")

# What the reference implementations read in different ways, or wrongly, is refused.
REFUSED = {
    "invalid utf8 bytes": "UTF-8",
    "bad checksum": "checksum",
    "trailing 3 bytes after message": "length",
    "truncated (drop last 10 bytes)": "length",
    "bad control string": "not an LMCP message",
    "wrong version root": "version 3",
    "unknown type id root": "unknown message type",
    "unknown series root": "unknown message series",
    "root null flag 0": "null",
    "required struct null": "LoiterAction.Location",
    "unknown nested type": "unknown message type",
    "wrong nested class (Circle where Location3D declared)": "expected Location3D",
    "enum value not in enum (99)": "got 99",
    "bool byte = 2": "0 or 1",
}


@needs_vectors
def test_messages_on_which_implementations_disagree() -> None:
    seen = set()
    for line in (VECTORS / "lmcp-quirks.jsonl").read_text("utf-8").splitlines():
        case = json.loads(line)
        raw = bytes.fromhex(case["hex"])
        if case["case"] in REFUSED:
            seen.add(case["case"])
            with pytest.raises(BadInput, match=REFUSED[case["case"]]):
                lmcp.binary.unpack(raw)
        else:
            again = lmcp.binary.pack(lmcp.binary.unpack(raw))
            assert again[:-4] == raw[:-4], case["case"]
    assert seen == set(REFUSED)


@given(st.binary(max_size=60))
def test_noise_is_refused_not_raised(noise: bytes) -> None:
    with pytest.raises(BadInput):
        lmcp.binary.unpack(noise)


@given(st.integers(8, 250), st.integers(0, 255))
def test_one_changed_byte_is_refused(at: int, value: int) -> None:
    state = lmcp.new("AirVehicleState", ID=7, AssociatedTasks=list(range(8)))
    raw = bytearray(lmcp.binary.pack(state))
    at = min(at, len(raw) - 5)
    if raw[at] == value:
        return
    raw[at] = value
    with pytest.raises(BadInput, match="checksum"):
        lmcp.binary.unpack(bytes(raw))
    raw[-4:] = bytes(4)  # no checksum: then it is refused by its content, or reads as an object
    try:
        obj = lmcp.binary.unpack(bytes(raw))
    except BadInput:
        return
    assert lmcp.binary.pack(obj)[8:-4] == bytes(raw)[8:-4]


def test_limits_of_the_wire() -> None:
    with pytest.raises(BadInput, match="too long"):
        lmcp.binary.pack(lmcp.new("KeyValuePair", Key="x" * 65536))
    with pytest.raises(BadInput, match="too long"):
        lmcp.binary.pack(lmcp.new("AutomationRequest", TaskList=[0] * 65536))
    nested = lmcp.new("GatedCommand")
    for _ in range(100):
        nested = lmcp.new("GatedCommand", Command=nested)
    with pytest.raises(BadInput, match="too deeply"):
        lmcp.binary.unpack(lmcp.binary.pack(nested))


def test_a_message_of_very_many_elements_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    regions = [lmcp.new("GraphEdge")] * 3
    raw = lmcp.binary.pack(lmcp.new("GraphRegion", EdgeList=regions))
    for module in (reference_codec, lmcp.binary):
        monkeypatch.setattr(module, "MAX_ELEMENTS", 2)
    with pytest.raises(BadInput, match=r"GraphRegion\.EdgeList: too many elements"):
        lmcp.binary.unpack(raw)
    with pytest.raises(BadInput, match="too many elements"):
        lmcp.binary.lazy(raw).complete()
    monkeypatch.setattr(lmcp.binary, "MAX_MESSAGE", 50)
    for use in (
        lambda: lmcp.binary.unpack(raw),
        lambda: lmcp.binary.pack(lmcp.new("Task", Label="x" * 60)),
    ):
        with pytest.raises(BadInput, match="message too long"):
            use()


def test_a_count_of_four_billion_is_refused_at_once() -> None:
    raw = bytearray(lmcp.binary.pack(lmcp.new("GraphRegion")))
    for at in range(len(raw) - 12, len(raw) - 4):
        wrong = raw[:at] + b"\xff\xff\xff\xff" + raw[at + 4 :]
        wrong[-4:] = bytes(4)
        with pytest.raises(BadInput):
            lmcp.binary.unpack(bytes(wrong))
