"""The text protocol held against recorded lines of the original client and service."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from cratous.bridge import text_protocol as tp

VECTORS = Path(__file__).resolve().parents[3] / "shared" / "vectors" / "cratous"
pytestmark = pytest.mark.skipif(not VECTORS.is_dir(), reason="no ../shared/vectors/cratous")

# Where we accept what the file proposes to reject, and why.
ACCEPTED = {
    34: "the line is that of a real takeover; only ICAROUS knows that it meant _INACTIVE_",
    62: "a message may come in any pieces",
    63: "a message may come in any pieces",
    64: "a message may come in any pieces",
    66: "a message may come in any pieces",
    104: "every line is right; zone ids with a gap concern who keeps the zones",
    106: "every line is right; what a hard reset forgets concerns who keeps the plan",
    108: "every line is right; the sign is the original client's own mistake",
}


def examples() -> list[dict[str, Any]]:
    lines = (VECTORS / "examples.jsonl").read_text("utf-8").splitlines()
    return [case for case in map(json.loads, lines) if case["kind"] != "handshake"]


def test_verdicts_on_the_examples() -> None:
    different = set()
    for case in examples():
        parser = tp.StreamParser(tp.Direction(case["direction"]))
        line = "x" * 65535 if case["n"] == 109 else case["line"]  # shortened in the file
        records = parser.feed(line.encode("utf-8")) + parser.finish()
        refused = any(isinstance(record, tp.WireError) for record in records)
        if refused != (case["strict"] == "reject"):
            assert not refused, case
            different.add(case["n"])
    assert different == set(ACCEPTED)


def test_valid_lines_are_written_as_the_original_writes_them() -> None:
    count = 0
    for case in examples():
        if case["kind"] != "valid":
            continue
        records = tp.StreamParser(tp.Direction(case["direction"])).feed(case["line"].encode())
        written = b"".join(
            tp.encode(record, dialect=tp.Dialect.ORIGINAL)
            for record in records
            if isinstance(record, tp.Message)
        )
        assert written.decode() == case["line"], case["n"]
        count += 1
    assert count >= 14


def test_recorded_sessions_of_the_original_service_and_client() -> None:
    count = 0
    for path in sorted((VECTORS / "sessions").glob("*.jsonl")):
        for line in path.read_text("utf-8").splitlines():
            event = json.loads(line)
            if event.get("ev") != "send":
                continue
            direction = tp.Direction.DOWN if event["who"] == "ICS" else tp.Direction.UP
            parser = tp.StreamParser(direction, original_peer=True)
            records = parser.feed(event["data"].encode()) + parser.finish()
            assert records, event
            for record in records:
                assert isinstance(record, tp.Message), (path.name, event, record)
                count += 1
    assert count > 100
