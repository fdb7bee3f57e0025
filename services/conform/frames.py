"""Suite `frames`: captured wire bytes, rebuilt byte for byte, and malformed input to a TCP bridge.

By file name: `*.zmq.bin` contains one addressed message, `*.tcp.bin` (also `.gz`) a stream of
sentinel frames, `*.tcp.hex` the same in hexadecimal; a `.json` contains either the parts of one
message (compared with the two `.bin` beside it) or a list of robustness cases.

A stream passes if nothing of it is dropped, every message is read and written to the same bytes,
the frames are rebuilt, and each of several segmentations, down to single bytes, gives the same. A
robustness case names what is sent by its `label` (or gives it as `hex`); it passes if exactly its
good messages arrive, in order, each fault is reported, and a good frame sent later arrives, in
every segmentation.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from cratous.bridge import envelope, lmcp
from cratous.bridge.sentinel import BODY, END, HEAD, TAIL, FrameStream, frame
from cratous.services.conform import Result, failed, not_covered, passed
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import inflated, json_of
from cratous.spec.files.text_file import bytes_of

SINGLE_BYTES = 200_000  # streams up to this length are also fed byte by byte


def cases(file: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """(number, case) of one file; raises BadInput if it is of no known kind."""
    raw = bytes_of(file)
    if file.suffix == ".gz":
        raw = inflated(raw, str(file))
    name = file.name.removesuffix(".gz")
    if name.endswith(".zmq.bin"):
        yield 1, {"id": file.name, "kind": "message", "data": raw}
    elif name.endswith(".hex"):
        try:
            yield 1, {"id": file.name, "kind": "stream", "data": bytes.fromhex(raw.decode("ascii"))}
        except ValueError as error:
            raise BadInput(f"this is not hexadecimal: {error}", where=str(file)) from error
    elif name.endswith(".json"):
        yield from _json_cases(file, raw)
    elif name.endswith(".bin"):
        yield 1, {"id": file.name, "kind": "stream", "data": raw}
    else:
        raise BadInput(
            "a file of no known kind",
            where=str(file),
            expected="*.zmq.bin, *.tcp.bin, *.tcp.hex or *.json",
            got=file.name,
        )


def _json_cases(file: Path, raw: bytes) -> Iterator[tuple[int, dict[str, Any]]]:
    data = json_of(raw, str(file))
    if isinstance(data, list) and all(isinstance(case, dict) for case in data):
        for number, case in enumerate(data, 1):
            yield number, {**case, "kind": "robustness", "id": case.get("label", f"case {number}")}
        return
    if not isinstance(data, dict):
        raise BadInput(
            "neither a message nor cases", where=str(file), expected="an object or a list"
        )
    parts = {}
    for part in ("zmq", "tcp"):
        other = file.with_name(file.name.removesuffix(".json") + f".{part}.bin")
        parts[part] = bytes_of(other) if other.is_file() else None
    yield 1, {**data, "kind": "parts", "id": file.name, **parts}


def judge(case: dict[str, Any]) -> Result:
    """Judge one case of `cases`."""
    kinds: dict[str, Callable[[dict[str, Any]], Result]] = {
        "message": _message,
        "stream": _stream,
        "parts": _parts,
        "robustness": _robustness,
    }
    try:
        return kinds[case["kind"]](case)
    except BadInput as error:
        return failed(case["id"], "refused", str(error))


def _rebuilt(raw: bytes) -> str:
    """The fault of an addressed message that is read and written again; empty if none."""
    message = envelope.parse(raw)
    obj = lmcp.binary.unpack(message.payload)
    if message.descriptor != lmcp.full_names(obj)[0]:
        return f"descriptor {message.descriptor}, but the message is {lmcp.full_names(obj)[0]}"
    again = envelope.AddressedMessage(
        message.address, *message.attributes, lmcp.binary.pack(obj)
    ).pack()
    return "" if again == raw else f"rebuilt as {again.hex()[:300]}"


def _message(case: dict[str, Any]) -> Result:
    wrong = _rebuilt(case["data"])
    return failed(case["id"], "message", wrong) if wrong else passed(case["id"])


def segmentations(data: bytes) -> Iterator[tuple[str, list[bytes]]]:
    """Named ways to split a stream; unsplit comes first."""
    yield "at once", [data]
    sizes = [1] if len(data) <= SINGLE_BYTES else []
    for size in (*sizes, 7, 1460, 8192):
        yield f"{size} bytes each", [data[i : i + size] for i in range(0, len(data), size)]
    for seed in (1, 2):
        rng, parts, at = random.Random(seed), [], 0
        while at < len(data):
            size = rng.choice((1, 2, 8, 9, 100, 5000))
            parts.append(data[at : at + size])
            at += size
        yield f"random cuts {seed}", parts


def _stream(case: dict[str, Any]) -> Result:
    name, data = case["id"], case["data"]
    first: list[bytes] = []
    checks = 0
    for how, parts in segmentations(data):
        checks += 1
        stream = FrameStream()
        got = [payload for part in parts for payload in stream.feed(part)]
        if stream.pending or stream.drops:
            drop = stream.drops[0].error(name) if stream.drops else f"{stream.pending} bytes left"
            return failed(name, "not all frames", f"{how}: {drop}", checks)
        if checks == 1:
            first = got
            if b"".join(map(frame, got)) != data:
                return failed(name, "frames are rebuilt otherwise", how, checks)
        elif got != first:
            return failed(name, "segmentation matters", f"{how}: {len(got)} messages", checks)
    for number, payload in enumerate(first):
        checks += 1
        wrong = _rebuilt(payload)
        if wrong:
            return failed(name, "message", f"number {number}: {wrong}", checks)
    return passed(name, checks)


def _parts(case: dict[str, Any]) -> Result:
    name, raw, framed = case["id"], case["zmq"], case["tcp"]
    if raw is None or framed is None:
        return not_covered(name, "no captured bytes beside it")
    message = envelope.parse(raw)
    obj = lmcp.binary.unpack(message.payload)
    stream = FrameStream()
    checks = {
        "address": message.address == case.get("address"),
        "attributes": list(message.attributes) == case.get("attributes"),
        "frame": stream.feed(framed) == [raw] and frame(raw) == framed,
        "lengths": (len(framed), len(raw), len(message.payload))
        == tuple(case.get(key) for key in ("tcp_frame_bytes", "zmq_frame_bytes", "lmcp_bytes")),
        "fields": _same(lmcp.to_dict(obj), case.get("fields")),
        "message": not _rebuilt(raw),
    }
    for number, (what, good) in enumerate(checks.items(), 1):
        if not good:
            return failed(name, what, f"{what} differ: {message.address}, {obj!r:.300}", number)
    return passed(name, len(checks))


def _same(ours: Any, given: Any) -> bool:
    """Whether the captured fields, which have no types and give enums as numbers, equal ours."""
    if isinstance(ours, dict) and isinstance(given, dict):
        kinds = lmcp.types[ours["$type"]].fields
        names = {k for k in given if not k.startswith("$")}
        if names != {f.name for f in kinds}:
            return False
        return all(_same(_plain(f, ours[f.name]), given[f.name]) for f in kinds)
    if isinstance(ours, list) and isinstance(given, list):
        return len(ours) == len(given) and all(map(_same, ours, given))
    return bool(ours == given)


def _plain(field: Any, value: Any) -> Any:
    if field.kind != "enum":
        return value
    members = lmcp.enums[field.type]
    return [int(members[v]) for v in value] if isinstance(value, list) else int(members[value])


# -- robustness: what each label sends -----------------------------------------------------------
ADDRESS = "uxas.messages.task.TaskInitialized"


def _good(task: int, text: str = "", entity: int = 100) -> bytes:
    """A valid payload: a TaskInitialized message, or one with a long text."""
    if text:
        obj = lmcp.new(
            "uxas.messages.uxnative.CreateNewService", ServiceID=task, XmlConfiguration=text
        )
    else:
        obj = lmcp.new(ADDRESS, TaskID=task)
    name = lmcp.full_names(obj)[0]
    return envelope.enclose(name, lmcp.binary.pack(obj), entity_id=entity).pack()


def _with(old: bytes, new: bytes, payload: bytes) -> bytes:
    assert old in payload
    return payload.replace(old, new, 1)


def _framed(payload: bytes, *, size: bytes | None = None, total: bytes | None = None) -> bytes:
    """A frame with another length or checksum text."""
    right = frame(payload)
    start, end = right.index(BODY), right.rindex(TAIL)
    return b"".join((
        HEAD, right[len(HEAD) : start] if size is None else size, BODY, payload, TAIL,
        right[end + len(TAIL) : -len(END)] if total is None else total, END,
    ))  # fmt: skip


def sent(label: str) -> tuple[bytes, list[bytes]] | None:
    """(the bytes that a case sends, the good payloads in them); None for an unknown label."""
    one, two = _good(1), _good(2)
    lmcp_at = one.index(b"LMCP")
    bare = one[:lmcp_at]  # address and attributes
    series = one.index(b"UXTASK")
    large = {size: _good(3, "x" * (size * 1000)) for size in (9, 60)}
    tails = _good(3, f"<a>{TAIL.decode()}7{END.decode()}</a>")
    then_good: dict[str, bytes] = {
        "garbage prefix": b"garbage \x00\xff+=+=",
        "wrong size then valid": _framed(two, size=b"3"),
        "wrong checksum then valid": _framed(two, total=b"7"),
        "non digit size": _framed(two, size=b"12x"),
        "empty size": _framed(two, size=b""),
        "negative size": _framed(two, size=b"-5"),
        "huge size": _framed(two, size=b"99999999999999999999"),
        "size of 1.6 GB": _framed(two, size=b"1600000000"),
        "huge checksum": _framed(two, total=b"99999999999999999999"),
        "missing head sentinel": frame(two)[len(HEAD) :],
        "truncated frame then valid": frame(two)[:60],
        "no $ in payload": frame(b"abcdefghijklmnop"),
        "one $ only": frame(b"abc$defghijklmnop"),
        "too few attributes": frame(ADDRESS.encode() + b"$lmcp|x|1$" + two[lmcp_at:]),
        "empty address": frame(two[len(ADDRESS) :]),
        "lmcp truncated": frame(two[:-10]),
        "lmcp bad checksum": frame(two[:-1] + bytes([two[-1] ^ 1])),
        "lmcp unknown series": frame(_zero(_with(b"UXTASK", b"UXTUSK", two))),
        "lmcp unknown type": frame(_zero(two[: series + 10] + b"\x77" + two[series + 11 :])),
        "lmcp wrong version": frame(_zero(two[: series + 13] + b"\x63" + two[series + 14 :])),
        "lmcp null object": frame(bare + b"LMCP\0\0\0\1\0\0\0\0\0"),
        "lmcp size larger than data": frame(
            two[: lmcp_at + 4] + b"\0\1\0\0" + two[lmcp_at + 8 :]
        ),
        "1 MB garbage then valid": bytes(range(256)) * 4096,
    }  # fmt: skip
    if label in then_good:
        return then_good[label] + frame(one), [one]
    zero = _zero(two)
    foreign = _good(2, entity=777)
    alone: dict[str, list[bytes]] = {
        "valid": [one],
        "two frames in one write": [one, two],
        "one frame byte by byte": [one],
        "split in 7-byte chunks": [one],
        "payload contains tail sentinel": [tails],
        "lmcp zero checksum": [zero, one],
        "valid frame of 9 kB (string field)": [large[9]],
        "valid frame of 60 kB (string field)": [large[60]],
        "foreign entity id 777": [foreign, one],
    }
    if label in alone:
        return b"".join(map(frame, alone[label])), alone[label]
    if label == "garbage between":
        return frame(one) + b"garbage" + frame(two), [one, two]
    return None


def _zero(payload: bytes) -> bytes:
    return payload[:-4] + bytes(4)


def _robustness(case: dict[str, Any]) -> Result:
    name, minimum = str(case["id"]), case.get("expected_if_strict", 0)
    later = _good(99)
    given = case.get("hex")
    if given is not None:
        data, good = bytes.fromhex(given), None
    else:
        found = sent(name)
        if found is None:
            return not_covered(name, "a label that this suite cannot send, and no hex")
        data, good = found
    checks = 0
    for how, parts in segmentations(data):
        checks += 1
        got, faults = _arrived([*parts, frame(later)])
        if got[-1:] != [later]:
            return failed(name, "the later frame is lost", how, checks)
        if good is not None and got[:-1] != good:
            return failed(name, "other messages", f"{how}: {len(got) - 1}, not {len(good)}", checks)
        if len(got) - 1 < minimum:
            return failed(name, "messages are lost", f"{how}: {len(got) - 1} of {minimum}", checks)
        if good is not None and bool(faults) == (data == b"".join(map(frame, good))):
            return failed(name, "faults are not reported", f"{how}: {faults}", checks)
    return passed(name, checks)


def _arrived(parts: list[bytes]) -> tuple[list[bytes], list[BadInput]]:
    """The payloads that contain messages, and the errors for everything else."""
    stream, faults, got = FrameStream(), [], []
    for part in parts:
        for payload in stream.feed(part):
            try:
                lmcp.binary.unpack(envelope.parse(payload).payload)
                got.append(payload)
            except BadInput as error:
                faults.append(error)
    return got, faults + [drop.error() for drop in stream.drops]
