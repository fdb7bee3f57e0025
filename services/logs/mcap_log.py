"""MCAP: export that Foxglove opens, and import of our own exports.

One channel per type and envelope, JSON with the type's JSON Schema; `channel.metadata` holds role,
sender and envelope, so that nothing of an entry is lost. Roles: `message`; `bytes`, the LMCP
message as logged (encoding `lmcp`, on request, and for what cannot be decoded); `view`, what
Foxglove's map and 3D panels draw (`views`). Time 0 is that of the log's clock. Meta data, gaps and
the number of messages are in metadata records: a file without them is truncated.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import IO, Any

from cratous.services.logs.entry import Entry, any_data, to_bytes
from cratous.services.logs.foxglove import schema_of, without_null
from cratous.services.logs.records import canonical
from cratous.services.logs.views import SCHEMAS, View, Views
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CELL_BYTES, integer_of, json_of

PROFILE = "cratous"
MAGIC = b"\x89MCAP0\r\n"
_ENVELOPE = ("address", "group", "entity_id", "service_id", "content_type")
_GAP = [int, int, int, int, str]
_CHUNK = 1 << 18  # bytes; the most that a truncated file loses
_NS = 1_000_000  # nanoseconds in a millisecond


class McapWriter:
    """Writes entries to a binary stream; `close` completes the file."""

    def __init__(self, stream: IO[bytes], *, with_bytes: bool = False, views: bool = True) -> None:
        """with_bytes: also a channel with the LMCP bytes; views: also what Foxglove draws."""
        from mcap.writer import CompressionType, Writer

        from cratous import __version__

        self._out = Writer(stream, chunk_size=_CHUNK, compression=CompressionType.ZSTD)
        self._out.start(profile=PROFILE, library=f"cratous {__version__}")
        self._with_bytes, self._views = with_bytes, Views() if views else None
        self._channels: dict[tuple[Any, ...], int] = {}
        self._schemas: dict[str, int] = {}
        self.count = 0

    def write(self, entry: Entry) -> BadInput | None:
        """Add one message; returns the error if it can only be written as bytes."""
        time_ns = entry.time_ms * _NS
        if not 0 <= time_ns < 2**63 or not 0 <= entry.seq < 2**32:
            raise BadInput(
                "MCAP cannot hold this time or number",
                where=entry.place,
                expected="times from 0, numbers below 2^32",
                got=f"{entry.time_ms} ms, number {entry.seq}",
            )
        data, error = any_data(entry)
        if error is None and "$type" not in data:
            error = BadInput("not an LMCP object", where=entry.place, expected='{"$type": ...}')
        self.count += 1
        if isinstance(entry.body, bytes) and (self._with_bytes or error is not None):
            self._add(entry, "bytes", "lmcp", entry.body)
        elif self._with_bytes and error is None:
            self._add(entry, "bytes", "lmcp", to_bytes(entry))
        if error is not None:
            if isinstance(entry.body, str):
                self._add(entry, "text", "json", entry.body.encode())
            return error
        text = json.dumps(without_null(data), ensure_ascii=False, separators=(",", ":"))
        self._add(entry, "message", "json", text.encode())
        if self._views is not None:
            for view in self._views.of(data, _names(entry.topic), time_ns):
                self._view(entry, view)
        return None

    def _view(self, entry: Entry, view: View) -> None:
        key = ("view", view.topic)
        if key not in self._channels:
            schema = self._schema(view.schema, SCHEMAS[view.schema])
            self._register(key, view.topic, "json", schema, {"role": "view"}, entry)
        self._put(self._channels[key], entry, json.dumps(view.data, separators=(",", ":")).encode())

    def _add(self, entry: Entry, role: str, encoding: str, body: bytes) -> None:
        key = (role, entry.topic, entry.source, type(entry.body), *entry[5:])
        if key not in self._channels:
            schema = 0
            if role == "message":
                schema = self._schema(entry.topic, schema_of(entry.topic))
            form = "lmcp" if isinstance(entry.body, bytes) else "json"
            about = {"role": role, "type": entry.topic, "source": entry.source, "body": form}
            for name, value in zip(_ENVELOPE, entry[5:], strict=True):
                if value is not None:
                    about[name] = value
            topic = entry.topic if role != "bytes" else f"lmcp/{entry.topic}"
            self._register(key, topic, encoding, schema, about, entry)
        self._put(self._channels[key], entry, body)

    def _register(
        self,
        key: tuple[Any, ...],
        topic: str,
        encoding: str,
        schema: int,
        about: dict[str, str],
        entry: Entry,
    ) -> None:
        if len(self._channels) >= 65_000:
            raise BadInput(
                "too many kinds of message for MCAP", where=entry.place, expected="< 65,000"
            )
        self._channels[key] = self._out.register_channel(topic, encoding, schema, about)

    def _put(self, channel: int, entry: Entry, body: bytes) -> None:
        time_ns = entry.time_ms * _NS
        self._out.add_message(channel, time_ns, body, time_ns, entry.seq)

    def _schema(self, name: str, schema: dict[str, Any]) -> int:
        if name not in self._schemas:
            text = json.dumps(schema, ensure_ascii=False).encode()
            self._schemas[name] = self._out.register_schema(name, "jsonschema", text)
        return self._schemas[name]

    def close(self, meta: dict[str, Any], gaps: Iterable[tuple[Any, ...]] = ()) -> None:
        """Write meta data and summary."""
        self._out.add_metadata("meta", {key: canonical(value) for key, value in meta.items()})
        for number, gap in enumerate(gaps):
            self._out.add_metadata("gap", {str(number): canonical(list(gap))})
        self._out.add_metadata("closing", {"count": str(self.count)})
        self._out.finish()


@cache
def _names(topic: str) -> tuple[str, ...]:
    from cratous.bridge import lmcp

    names: tuple[str, ...] = lmcp.types[topic].all_names
    return names


def is_mcap(head: bytes) -> bool:
    """Whether a file with these first bytes is MCAP."""
    return head.startswith(MAGIC)


def read_meta(path: Path) -> tuple[dict[str, Any], list[list[Any]]]:
    """The log's meta data and gaps; empty if the file is truncated (`read_mcap` says so)."""
    found = []
    with suppress(BadInput):
        found = [record for record in _records(path) if type(record).__name__ == "Metadata"]
    meta: dict[str, Any] = {}
    gaps: list[list[Any]] = []
    for record in found:
        try:
            values = {key: json_of(value, str(path)) for key, value in record.metadata.items()}
        except BadInput as error:
            raise _damaged(path, 0, error) from None
        if record.name == "meta":
            meta = values
        elif record.name == "gap":
            gaps += values.values()
    if any(not isinstance(gap, list) or [*map(type, gap)] != _GAP for gap in gaps):
        raise _damaged(path, 0, ValueError("wrong values in a gap"))
    return meta, gaps


def _records(path: Path) -> Iterator[Any]:
    """The records of the file, including those in chunks; BadInput where it is damaged."""
    from mcap.stream_reader import StreamReader

    with path.open("rb") as stream:
        reader = StreamReader(
            stream, validate_crcs=True, emit_chunks=True, record_size_limit=CELL_BYTES
        )
        records, read = _unpacked(reader.records), 0
        while True:
            try:
                record = next(records)
            except StopIteration:
                return
            except Exception as error:  # parser and decompressors raise errors of all kinds
                raise _damaged(path, read, error) from None
            read += 1
            yield record


def _unpacked(records: Iterable[Any]) -> Iterator[Any]:
    """The records, including those of chunks, which are inflated up to their limit and declared size."""
    for record in records:
        if type(record).__name__ != "Chunk":
            yield record
            continue
        data, size = _chunk_data(record), record.uncompressed_size
        if len(data) != size:
            raise ValueError(f"a chunk of {size} bytes unpacks to another length")
        if record.uncompressed_crc not in (0, zlib.crc32(data)):
            raise ValueError("a chunk has a wrong checksum")
        yield from _of_chunk(data)


def _of_chunk(data: bytes) -> Iterator[Any]:
    """The records of a chunk one by one: a list of them takes many times the chunk's memory."""
    from mcap.data_stream import ReadDataStream
    from mcap.opcode import Opcode
    from mcap.records import Channel, Message

    stream = ReadDataStream(BytesIO(data))
    while stream.count < len(data):
        opcode, length = stream.read1(), stream.read8()
        if length > len(data):
            raise ValueError(f"a record of {length} bytes in a chunk of {len(data)}")
        end = stream.count + length
        if opcode == Opcode.CHANNEL:
            yield Channel.read(stream)
        elif opcode == Opcode.MESSAGE:
            yield Message.read(stream, length)
        else:
            stream.read(length)
        if stream.count != end:
            raise ValueError("a record has a wrong length")


def _chunk_data(chunk: Any) -> bytes:
    if chunk.uncompressed_size > CELL_BYTES:
        raise ValueError(f"a chunk of {chunk.uncompressed_size} bytes; at most {CELL_BYTES}")
    if chunk.compression == "zstd":
        import zstandard

        reader = zstandard.ZstdDecompressor().stream_reader(chunk.data)
        return bytes(reader.read(chunk.uncompressed_size + 1))
    if chunk.compression == "lz4":
        import lz4.frame  # type: ignore[import-untyped]

        unpacker = lz4.frame.LZ4FrameDecompressor()
        return bytes(unpacker.decompress(chunk.data, chunk.uncompressed_size + 1))
    if chunk.compression:
        raise ValueError(f"unknown compression {chunk.compression[:20]!r}")
    return bytes(chunk.data)


def _damaged(path: Path, read: int, error: Exception) -> BadInput:
    text = str(error) or "it ends too early"
    return BadInput(
        f"the MCAP file is damaged or truncated after {read} records ({text})", where=str(path)
    )


def read_mcap(path: Path) -> Iterator[Entry]:
    """The messages of one of our exports, in order; BadInput for damage and for other files."""
    channels: dict[int, Any] = {}
    done: int | None = None
    count: int | None = None
    read = 0
    for record in _records(path):
        name = type(record).__name__
        if name == "Header" and record.profile != PROFILE:
            raise BadInput(
                "not an MCAP file of ours",
                where=str(path),
                expected=f"profile {PROFILE!r}",
                got=repr(record.profile),
            )
        if name == "Channel":
            channels[record.id] = record
        elif name == "Metadata" and record.name == "closing":
            text = record.metadata.get("count", "")
            count = integer_of(text, 0, 2**63)
        elif name == "Message":
            try:
                entry = _entry(record, channels.get(record.channel_id), path)
            except (KeyError, UnicodeDecodeError) as error:
                raise _damaged(path, read, error) from None
            # bytes precede the JSON of the same message and take precedence
            if entry is None or entry.seq == done:
                continue
            done = entry.seq
            read += 1
            yield entry
    if count != read:
        raise BadInput(
            "the MCAP file is not whole",
            where=str(path),
            expected="messages that were written: " + ("?" if count is None else str(count)),
            got=str(read),
        )


def _entry(record: Any, channel: Any, path: Path) -> Entry | None:
    about = getattr(channel, "metadata", {})
    role = about.get("role")
    if role == "view":
        return None
    if role not in ("message", "bytes", "text"):
        raise BadInput(
            "message on a channel that is not ours",
            where=str(path),
            item=getattr(channel, "topic", "no channel"),
        )
    envelope = [about.get(name) for name in _ENVELOPE]
    time_ms = record.log_time // _NS
    head = (record.sequence, time_ms, about["source"], about["type"])
    if role == "bytes":
        body: str | bytes = record.data
        if about["body"] == "json":
            return None  # the JSON that follows is what was logged
    elif role == "text":
        body = record.data.decode()
    else:
        body = _body(record.data, about["body"], f"{path}: message {record.sequence}")
    return Entry(*head, body, *envelope)


def _body(data: bytes, form: str, where: str) -> str | bytes:
    from cratous.bridge import lmcp

    message = lmcp.from_json(data, where)
    return lmcp.binary.pack(message) if form == "lmcp" else lmcp.to_json(message)
