"""Fuzzing of the LMCP codec and of the sentinel frames: `make fuzz`, and a small run in the tests.

Messages are drawn from the models, changed, and put to every reader. What counts as a fault: any
exception but BadInput, a case that takes seconds, memory that grows, a message that reads to an
object which is not written as the same bytes, two readers that do not agree, or frames whose bytes
are not all accounted for.

    python tests/programs/fuzz_lmcp.py --count 1000000 --seed 1
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import random
import resource
import struct
import sys
import time
from collections import Counter
from typing import Any

from cratous.bridge import envelope, lmcp
from cratous.bridge.bytesum import byte_sum
from cratous.bridge.lmcp import binary, model, reference_codec
from cratous.bridge.sentinel import HEAD, MAX_PAYLOAD, FrameStream, frame
from cratous.spec.errors import BadInput

SECONDS = 20  # for a thousand cases; a hang otherwise
MEMORY_MB = 256  # growth of the process over a run
TEXTS = ("", "a", "UAV 400", "\0", "$|+=+=+=+=", "é漢🚁", "<&>", "x" * 300)
INTERESTING = (0, 1, 2, 127, 128, 200, 255)


def random_value(rng: random.Random, field: model.Field, depth: int) -> Any:
    kind = field.kind
    if kind == "string":
        return rng.choice(TEXTS)
    if kind == "char":
        return chr(rng.randrange(256))
    if kind == "bool":
        return rng.random() < 0.5
    if kind in ("real32", "real64"):
        number = rng.choice((0.0, -0.0, 1.5, -1e9, float("inf"), 1e-40, rng.uniform(-200, 200)))
        if kind == "real64":
            return number
        return struct.unpack(">f", struct.pack(">f", number))[0]
    if kind == "enum":
        return rng.choice(list(lmcp.enums[field.type]))
    if kind in ("struct", "any"):
        base = "" if kind == "any" else field.type
        return random_object(rng, rng.choice(descendants(base)), depth + 1)
    low, high = model.INTEGER_RANGES[kind]
    return rng.choice((0, 1, low, high, rng.randint(low, high)))


_descendants: dict[str, list[str]] = {}


def descendants(base: str) -> list[str]:
    """The names of the types that a field of this type may hold."""
    if not _descendants:
        for name in lmcp.types:
            cls = lmcp.types[name]
            for above in cls.__mro__:
                key = getattr(above, "type_name", None)
                if key is not None:
                    _descendants.setdefault(key, []).append(name)
    return _descendants[base]


def random_object(rng: random.Random, name: str, depth: int = 0) -> Any:
    """An object with random values, nested at most four levels."""
    values = {}
    for field in lmcp.types[name].fields:
        struct_ = field.kind in ("struct", "any")
        if struct_ and (depth > 3 or (field.nullable and rng.random() < 0.3)):
            if field.array is None and field.nullable:
                values[field.name] = None
            continue
        if field.array is None:
            values[field.name] = random_value(rng, field, depth)
            continue
        count = field.array or rng.choice((0, 0, 1, 2) if struct_ else (0, 1, 3, 20))
        values[field.name] = [random_value(rng, field, depth) for _ in range(count)]
    return lmcp.new(name, **values)


def mutated(rng: random.Random, raw: bytes, other: bytes) -> bytes:
    """A changed message; most keep the right tag, length and checksum, to get further in."""
    data = bytearray(raw)
    for _ in range(rng.choice((1, 1, 1, 2, 5))):
        at = rng.randrange(len(data)) if data else 0
        way = rng.randrange(8)
        if way <= 1 and data:
            data[at] ^= 1 << rng.randrange(8)
        elif way == 2 and data:
            data[at] = rng.choice(INTERESTING)
        elif way == 3:
            del data[at : at + rng.choice((1, 2, 4, 15, 1000))]
        elif way == 4:
            data[at:at] = rng.randbytes(rng.choice((1, 2, 4, 15)))
        elif way == 5:
            cut = rng.randrange(len(other))
            data[at:] = other[cut:]
        elif way == 6:
            data[at : at + 2] = rng.choice((b"\0\0", b"\xff\xff", b"\0\1", b"\x7f\xff"))
        else:
            data[at : at + 15] = other[8:23]
    if rng.random() < 0.9 and len(data) >= 13:
        short = rng.random() < 0.05  # the length of OpenUxAS's Python client
        data[:8] = struct.pack(">4sI", b"LMCP", len(data) - 12 - short)
        total = byte_sum(bytes(data[:-4])) if short or rng.random() < 0.5 else 0
        data[-4:] = struct.pack(">I", total)
    return bytes(data)


def message_case(rng: random.Random, corpus: list[bytes], seen: Counter[str]) -> None:
    raw = mutated(rng, rng.choice(corpus), rng.choice(corpus))
    found: Any = None
    try:
        found = binary.unpack(raw)
    except BadInput as err:
        seen[err.what] += 1
        if not err.where:
            raise AssertionError(f"an error that says no place: {err} {raw.hex()}") from None
    else:
        seen["read"] += 1
        again = binary.pack(found)
        # a NaN may carry other bits; everything else comes out as it came in
        if again[:-4] != raw[:-4] and b"\x7f" not in raw and b"\xff" not in raw:
            raise AssertionError(f"written otherwise than read: {raw.hex()} {again.hex()}")
    if rng.random() < 0.1:
        agree(raw, found)
        let_pass(raw, found, seen)


def let_pass(raw: bytes, found: Any, seen: Counter[str]) -> None:
    """What is let pass for a client's sake is a right message in the end; nothing else changes."""
    try:
        obj, message, notes = binary.received(raw)
    except BadInput:
        if found is not None:
            raise AssertionError(f"read, and refused from a client: {raw.hex()}") from None
        return
    if bool(notes) == (found is not None) or lmcp.to_json(binary.unpack(message)) != lmcp.to_json(
        obj
    ):
        raise AssertionError(f"let pass otherwise than read: {raw.hex()} {notes}")
    seen["let pass"] += bool(notes)


def agree(raw: bytes, found: Any) -> None:
    """The careful and the lazy reader say the same as the fast one."""
    text = "" if found is None else lmcp.to_json(found)
    for reader in (_carefully, _lazily, _field_by_field):
        try:
            other = lmcp.to_json(reader(raw))
        except BadInput:
            other = ""
        if other != text:
            raise AssertionError(f"{reader.__name__} disagrees: {raw.hex()} {other} {text}")
    if found is not None and not found.raw_message():
        parts = reference_codec.pack(found)
        if bytes(parts) != binary.pack(found)[8:-4]:
            raise AssertionError(f"writers disagree: {raw.hex()}")
        if lmcp.to_json(lmcp.from_json(text)) != text:
            raise AssertionError(f"JSON form changes {text}")
        # compared as texts, since of not-a-number no two are equal
        if repr(lmcp.to_data(found)) != repr(json.loads(text)):
            raise AssertionError(f"as plain data it is not {text}")


def _carefully(raw: bytes) -> Any:
    binary._checked(raw, "message")
    return reference_codec.read(raw, 8, len(raw) - 4, "message")


def _lazily(raw: bytes) -> Any:
    return binary.lazy(raw).complete()


def _field_by_field(raw: bytes) -> Any:
    obj = binary.lazy(raw)
    for name in obj.names:
        getattr(obj, name)
    return obj.complete()


def frame_case(rng: random.Random, corpus: list[bytes], seen: Counter[str]) -> None:
    good = rng.choice(corpus)
    whole = frame(envelope.enclose("afrl.cmasi.X", good).pack())
    parts = [whole]
    for _ in range(rng.choice((1, 1, 2, 4))):
        parts.append(_changed(rng, whole))
    parts.append(whole)
    data = b"".join(parts)
    stream = FrameStream(max_payload=rng.choice((1000, 100_000, MAX_PAYLOAD)))
    payloads, at = [], 0
    while at < len(data):
        size = rng.choice((1, 7, 64, 1000, 100_000))
        payloads += stream.feed(data[at : at + size])
        if stream.pending > stream.max_payload + 64:
            raise AssertionError(f"more than the limit is held: {stream.pending}")
        at += size
    payloads += stream.close()
    seen.update(stream.counts)
    seen["frames"] += len(payloads)
    if sum(len(frame(p)) for p in payloads) + stream.dropped_bytes < len(data) - 100:
        raise AssertionError(f"bytes lost: {data.hex()}")
    if stream.max_payload >= len(good) + 100 and not payloads:
        raise AssertionError(f"the good frame did not arrive: {data.hex()}")
    for payload in payloads:
        try:
            binary.unpack(envelope.parse(payload).payload)
        except BadInput as err:
            seen[err.what] += 1


def _changed(rng: random.Random, whole: bytes) -> bytes:
    way = rng.randrange(6)
    at = rng.randrange(len(whole))
    if way == 0:
        return whole[:at]
    if way == 1:
        return whole[at:]
    if way == 2:
        return whole[:at] + rng.randbytes(rng.choice((1, 3, 40))) + whole[at:]
    if way == 3:
        digits = b"%d" % rng.choice((0, 3, 117, 1_600_000_000, 10**12, len(whole)))
        return HEAD + digits + whole[len(HEAD) + 3 :]
    if way == 4:
        return HEAD * rng.randrange(1, 5) + whole[at:]
    return whole[:at] + bytes([rng.randrange(256)]) + whole[at + 1 :]


def run(count: int, seed: int) -> Counter[str]:
    """`count` cases, one in five a stream of frames; raises for a fault, and says with which seed."""
    rng = random.Random(seed)
    corpus = []
    for name in lmcp.types:
        corpus += [binary.pack(random_object(rng, name)) for _ in range(3)]
    corpus = [raw for raw in corpus if len(raw) < 4000]
    seen: Counter[str] = Counter()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        for number in range(count):
            if number % 1000 == 0:
                faulthandler.dump_traceback_later(SECONDS, exit=True)
            case = frame_case if number % 5 == 0 else message_case
            try:
                case(rng, corpus, seen)
            except Exception as err:
                raise AssertionError(f"case {number} of seed {seed}: {err!r}") from err
    finally:
        faulthandler.cancel_dump_traceback_later()
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    seen["memory grown [MB]"] = round(grown)
    if grown > MEMORY_MB:
        raise AssertionError(f"memory grew by {grown:.0f} MB")
    return seen


def main() -> int:
    """The command line."""
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    options.add_argument("--count", type=int, default=1_000_000)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    start = time.perf_counter()
    seen = run(given.count, given.seed)
    for what, many in seen.most_common():
        print(f"{many:>9} {what}")
    took = time.perf_counter() - start
    print(f"{given.count} cases, no crash, no hang, {took:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
