"""Hostile input: every reader refuses it with a typed error, within bounds of memory and CPU time."""

from __future__ import annotations

import base64
import gzip
import json
import os
import resource
import sqlite3
import subprocess
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.loading.document import parse_document
from cratous.services.logs.source import open_log
from cratous.services.planning.assign_certificate import read as read_certificate
from cratous.services.planning.assign_certificate import verify
from cratous.services.planning.assign_vectors import read as read_problem
from cratous.spec.daa import encounter_files as daa_file
from cratous.spec.errors import BadInput
from cratous.spec.files import limits
from cratous.spec.files.limits import inflated, integer_of, json_of
from cratous.spec.files.text_file import bytes_of, lines_of, text_of

MEMORY_BYTES, CPU_S = 1_000_000_000, 20
"""What a child may take in all, with the interpreter and numpy: the inputs ask for gigabytes."""
PROBLEM = {
    "vehicles": [{"id": 1}],
    "tasks": [{"id": 1, "duration_ms": 5, "eligible": [1]}],
    "process_algebra": "p1",
    "travel_ms": [[0]],
    "start_cost_ms": [[7]],
}
DIGITS = "9" * 5000
DEEP = "[" * 100_000 + "]" * 100_000


def _bomb(size: int, unit: bytes = b" ") -> bytes:
    """Gzipped repetitions of a unit: members one after the other, which read as one file."""
    piece = unit * (1_000_000 // len(unit))
    return gzip.compress(piece) * (size // len(piece))


def _certificate_bomb(megabytes: int = 640) -> bytes:
    packer = zlib.compressobj(1)
    zeros = bytes(1_000_000)
    packed = b"".join([*(packer.compress(zeros) for _ in range(megabytes)), packer.flush()])
    proof = {
        "kind": "layers", "bound": 12, "limit": 12, "sizes": [megabytes * 1_000_000 // 12],
        "origins": base64.b64encode(packed).decode(),
    }  # fmt: skip
    body = {
        "format": "cratous-assignment-certificate/1",
        "problem": {
            "name": "x", "vehicles": [1], "ready_ms": [0], "relations": "p1", "semantics": "time",
            "choices": [{"task_id": 1, "option_id": 1, "duration_ms": 5, "vehicles": [1]}],
            "travel_ms": [[[0], [7]]],
        },
        "claim": {"status": "optimal", "cost": 12, "bound": 12},
        "steps": [{
            "vehicle_id": 1, "task_id": 1, "option_id": 1, "arrive_ms": 7, "start_ms": 7,
            "end_ms": 12,
        }],
        "proofs": [proof],
    }  # fmt: skip
    from cratous.services.planning.assign_certificate import _digest

    return json.dumps({**body, "sha256": _digest(body)}).encode()


def _in_child(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run code with limits on address space and CPU time."""

    def bound() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))

    head = "import sys\nfrom pathlib import Path\nfrom cratous.spec.errors import BadInput\n"
    tail = "\n".join(f"    {line}" for line in code.splitlines())
    whole = f"{head}try:\n{tail}\nexcept BadInput as error:\n    print(error); sys.exit(2)"
    return subprocess.run(
        [sys.executable, "-c", whole, *arguments],
        capture_output=True, text=True, timeout=600, preexec_fn=bound, check=False,
        env={"PATH": "", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip


READ_CASES = (
    "from cratous.services.conform import cases\nfor case in cases(Path(sys.argv[1])): pass"
)
READ_FRAMES = "from cratous.services.conform.frames import cases\nlist(cases(Path(sys.argv[1])))"
READ_MISSION = (
    "from cratous.services.loading.document import read_document\nread_document(Path(sys.argv[1]))"
)
READ_LMCP = (
    "from cratous.bridge.lmcp import stored_forms\n"
    "for found in stored_forms.read(Path(sys.argv[1]).read_bytes()): pass"
)
READ_XML = "from cratous.bridge.lmcp import xml\nxml.read_file(sys.argv[1])"
READ_LOG = (
    "from cratous.services.logs.source import open_log\n"
    "for entry in open_log(Path(sys.argv[1])).entries(): pass"
)
CHECK = (
    "from cratous.services.planning.assign_certificate import read, verify\n"
    "wrong = verify(read(Path(sys.argv[1]))).wrong\n"
    "if wrong: raise BadInput(wrong)"
)


@pytest.mark.parametrize(
    ("name", "make", "code", "wanted"),
    [
        ("spaces.jsonl.gz", lambda: _bomb(3_000_000_000), READ_CASES, "line is too long"),
        ("list.json.gz", lambda: gzip.compress(b"[") + _bomb(60_000_000, b"{}," * 30 + b"\n"), READ_CASES, "too many lists"),
        ("spaces.hex.gz", lambda: _bomb(3_000_000_000), READ_FRAMES, "too long unpacked"),
        ("lmcp.gz", lambda: _bomb(3_000_000_000), READ_LMCP, "too long unpacked"),
        ("flow.yaml", lambda: b"a: [" + b"1," * 2_000_000 + b"1]", READ_MISSION, "too many values"),
        ("deep.yaml", lambda: b"a: " + b"[" * 1_000_000, READ_MISSION, "nested too deeply"),
        ("braces.yaml", lambda: b"a: " + b"{a: " * 500_000, READ_MISSION, "nested too deeply"),
        ("dashes.yaml", lambda: b"- " * 1_000_000, READ_MISSION, "nested too deeply"),
        ("tags.xml", lambda: b"<a>" + b"<a/>" * 6_000_000 + b"</a>", READ_XML, "too many elements"),
        ("certificate.json", _certificate_bomb, CHECK, "a layer has more than"),
        ("objects.json", lambda: b"[" + b"{}," * 20_000_000 + b"{}]", CHECK, "too large"),
        ("objects.jsonl", lambda: b'{"a":[' + b"{}," * 9_000_000 + b"{}]}", READ_LOG, "too many"),
    ],
)  # fmt: skip
def test_costly_input_is_refused_before_it_costs(
    name: str, make: Callable[[], bytes], code: str, wanted: str, tmp_path: Path
) -> None:
    file = tmp_path / name
    file.write_bytes(make())
    done = _in_child(code, str(file))
    assert done.returncode == 2, done.stderr[-500:]
    assert wanted in done.stdout


def test_a_chunk_of_a_log_is_inflated_within_its_bound(tmp_path: Path) -> None:
    from mcap.writer import CompressionType, Writer

    file = tmp_path / "bomb.mcap"
    with file.open("wb") as out:
        writer = Writer(out, chunk_size=1 << 31, compression=CompressionType.ZSTD)
        writer.start(profile="cratous", library="x")
        channel = writer.register_channel("a", "json", 0, {})
        for number in range(20):
            writer.add_message(channel, 0, bytes(20_000_000), 0, number)
        writer.finish()
    done = _in_child(READ_LOG, str(file))
    assert done.returncode == 2, done.stderr[-500:]
    assert "a chunk of" in done.stdout


def log_of(folder: Path, *statements: str) -> Path:
    """A file of SQLite with a table `meta`, and what else is stated."""
    file = folder / "log.sqlite"
    with sqlite3.connect(file) as made:
        for statement in ("CREATE TABLE meta(key TEXT, value TEXT)", *statements):
            made.execute(statement)
    return file


def test_a_view_is_no_table_of_a_log(tmp_path: Path) -> None:
    file = log_of(
        tmp_path,
        "CREATE VIEW messages AS WITH RECURSIVE n(seq) AS (SELECT 0 UNION ALL SELECT seq + 1 "
        "FROM n) SELECT seq, 0 AS time_ms, 'a' AS source, 'b' AS topic, '{}' AS body FROM n",
    )
    with pytest.raises(BadInput, match="not a message log"):
        open_log(file)


def test_a_value_of_a_log_is_bounded(tmp_path: Path) -> None:
    file = log_of(
        tmp_path,
        "CREATE TABLE messages(seq INTEGER PRIMARY KEY, time_ms INTEGER, source TEXT, "
        "topic TEXT, body TEXT)",
        "INSERT INTO messages VALUES(0, 0, 'a', 'b', zeroblob(100000000))",
    )
    with pytest.raises(BadInput, match="damaged"):
        list(open_log(file).entries())


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("", "not JSON"),
        ("{", "not JSON"),
        (DEEP, "nested too deeply"),
        ('{"a":' * 101 + "1" + "}" * 101, "nested too deeply"),
        (DIGITS, "too many digits"),
        ('{"a": -' + DIGITS + "}", "too many digits"),
        ("1e999", "not a number that a double holds"),
        ("0." + DIGITS + "e5000", "not a number that a double holds"),
        ("NaN", "NaN is not a JSON number"),
        ("[-Infinity]", "Infinity is not a JSON number"),
        ('{"a": {"b": 1, "c": 2, "b": 3}}', "a name is given twice"),
        ('"\\ud800"', "half a character"),
        (b'"\xff"', "not a text file"),
        ("[" + "{}," * 1_000_001 + "{}]", "too many lists and objects"),
        ("[" + "1," * 16_000_001 + "1]", "too many values"),
    ],
)
def test_json_that_is_none_or_too_much(text: str | bytes, wanted: str) -> None:
    with pytest.raises(BadInput, match=wanted) as error:
        json_of(text, "here")
    assert error.value.where == "here"
    assert error.value.expected


def test_json_within_its_bounds_is_read_as_it_is() -> None:
    data = {"a": [1, -2.5, "x\u202e", None, True, 10**299], "b": {"c": "9" * 5000, "d": 1e300}}
    assert json_of(json.dumps(data), "") == data
    assert json_of('["\\ud83d\\ude00", 1e300]', "") == ["\U0001f600", 1e300]
    nested = "[" * 100 + "]" * 100
    assert json_of(nested, "") == json.loads(nested)


def test_gzip_is_whole_and_bounded() -> None:
    assert inflated(gzip.compress(b"abc") + gzip.compress(b"def"), "") == b"abcdef"
    assert inflated(gzip.compress(b"a" * 10), "", 10) == b"a" * 10
    for data, wanted in (
        (gzip.compress(b"a" * 11), "too long unpacked"),
        (gzip.compress(b"abc")[:-3], "ends too early"),
        (b"abc", "not gzip"),
    ):
        with pytest.raises(BadInput, match=wanted):
            inflated(data, "", 10)


def test_integers_of_texts() -> None:
    assert integer_of(" -12", -20, 20) == -12
    for text in ("21", DIGITS, "1.0", "", "١", "1_0", "--1", "+-1"):
        assert integer_of(text, -20, 20) is None


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (f"a: {DIGITS}", "too many digits"),
        (f"a: 0x{'f' * 5000}", "too many digits"),
        (f"a: 1.{DIGITS}", "too many digits"),
        ("a: 9007199254740993", "out of range"),
        ("a: 1e999", "not a finite number"),
        ("a: .inf", "not a finite number"),
        ("a: " + "[" * 33 + "]" * 33, "nested too deeply"),
        ("a: &x [1]\nb: *x", "aliases are not allowed"),
        ('a: "\\e[31m"', "control character"),
        ('"\\e": 1', "control character"),
        ('a: "\\ud800"', "."),
    ],
)
def test_yaml_that_is_too_much(text: str, wanted: str) -> None:
    with pytest.raises(BadInput, match=wanted) as error:
        parse_document(text, "m.yaml")
    assert error.value.where.startswith("m.yaml")


def test_yaml_within_its_bounds() -> None:
    assert (
        parse_document('a: 9007199254740992\nb: "x\\ty\\n"\nc: ' + "[" * 31 + "]" * 31, "m").data[
            "a"
        ]
        == 2**53
    )


@pytest.mark.parametrize(
    ("change", "item"),
    [
        ({"process_algebra": 5}, "problem.process_algebra"),
        ({"vehicles": [{"id": []}]}, "vehicles[0].id"),
        ({"vehicles": 5}, "problem.vehicles"),
        ({"tasks": [None]}, "tasks[0]"),
        ({"tasks": [{"id": 1, "duration_ms": 5}]}, "tasks[0].eligible"),
        ({"tasks": [{"id": 1, "duration_ms": 5, "eligible": 5}]}, "tasks[0].eligible"),
        ({"tasks": [{"id": 1, "duration_ms": 10**299, "eligible": [1]}]}, "choices[0].duration_ms"),
        ({"travel_ms": 5}, "travel_ms[0]"),
        ({"travel_ms": [5]}, "travel_ms[0][0]"),
        ({"start_cost_ms": [["a"]]}, "travel_ms[0][1][0]"),
        ({"start_cost_ms": [5]}, "start_cost_ms[0]"),
    ],
)  # fmt: skip
def test_a_problem_of_another_shape_is_told_in_the_user_s_words(
    change: dict[str, object], item: str
) -> None:
    with pytest.raises(BadInput) as error:
        read_problem({**PROBLEM, **change}, "time")
    assert error.value.item == item
    assert error.value.expected
    for word in ("NoneType", "subscriptable", "iterable", "indices", "unhashable", " int;"):
        assert word not in str(error.value)


@pytest.mark.parametrize("data", [[1, 2], "cost_matrix", 5, None])
def test_a_problem_is_an_object(data: object) -> None:
    with pytest.raises(BadInput, match="not an object"):
        read_problem(data, "time")


def test_a_small_matrix_does_not_ask_for_a_large_table() -> None:
    options = [{"option": k, "cost_ms": 1, "eligible": [1]} for k in range(1, 2001)]
    task = {
        "task": 1,
        "composition": "+(" + " ".join(f"p{k}" for k in range(1, 2001)) + ")",
        "options": options,
    }
    data = {
        "vehicles": list(range(1, 60)), "tasks": [task], "cost_matrix": [],
        "task_relationships": "p1",
    }  # fmt: skip
    with pytest.raises(BadInput, match="too many ways"):
        read_problem(data, "order")


@pytest.mark.parametrize(
    "change",
    [
        {"claim": None}, {"claim": {"status": 5, "cost": 1, "bound": 1}}, {"problem": []},
        {"problem": {"vehicles": [[]]}}, {"steps": 5}, {"steps": [{"x": 1}]}, {"proofs": None},
        {"proofs": [{"kind": "layers", "sizes": [-1], "origins": ""}]}, {"proofs": [5]},
    ],
)  # fmt: skip
def test_a_certificate_of_another_shape_is_refused(
    change: dict[str, object], tmp_path: Path
) -> None:
    from cratous.services.planning.assign_certificate import _digest

    body = json.loads(_certificate_bomb(0))
    body = {**body, **change}
    body["sha256"] = _digest(body)
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(body))
    assert verify(read_certificate(file)).wrong


HEAD = "NAME sx sy sz vx vy vz time\n[none] [m] [m] [m] [m/s] [m/s] [m/s] [s]\n"


@pytest.mark.parametrize(
    ("row", "item"),
    [
        ("a 0 0 1e308 0 0 0 0", "alt"),
        ("a 0 0 100001 0 0 0 0", "alt"),
        ("a 1e9 0 0 0 0 0 0", "x"),
        ("a 0 0 0 -20000 0 0 0", "vx"),
        ("a 0 0 0 0 0 1e5 0", "vs"),
        ("a 0 0 0 0 0 0 1e11", "time"),
        ("a 0 0 0 0 0 0 1e300:0:0", "time"),
        (f"a 0 0 {DIGITS} 0 0 0 0", "alt"),
    ],
)
def test_states_that_nothing_can_have_are_refused(row: str, item: str) -> None:
    with pytest.raises(BadInput) as error:
        daa_file.parse(HEAD + row + "\n")
    assert error.value.item == item
    assert len(str(error.value)) < 300 or item == "alt"


def test_the_bounds_leave_room_for_what_the_formats_are_used_for() -> None:
    """The largest line of the recorded sessions of OpenUxAS has 40 MB."""
    assert limits.LINE_BYTES >= 41_000_000
    assert limits.MESSAGES_BYTES >= 176_000_000
    assert limits.STATES >= 200_000


def test_lines_and_states_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "LINES", 100)
    monkeypatch.setattr(limits, "STREAM_BYTES", 10_000)
    monkeypatch.setattr(daa_file, "ENCOUNTER_ROWS", 100)
    file = tmp_path / "lines.jsonl.gz"
    file.write_bytes(gzip.compress(b"\n" * 101))
    with pytest.raises(BadInput, match="too many lines"):
        list(lines_of(file))
    file.write_bytes(gzip.compress((b" " * 999 + b"\n") * 11))
    with pytest.raises(BadInput, match="too long unpacked"):
        list(lines_of(file))
    plain = tmp_path / "lines.jsonl"
    plain.write_bytes(b"\n" * 101)  # no longer in memory than on the disk
    assert len(list(lines_of(plain))) == 101
    rows = "".join(f"a 0 0 0 0 0 0 {k}\n" for k in range(101))
    with pytest.raises(BadInput, match="too many states"):
        daa_file.parse(HEAD + rows)


@pytest.mark.parametrize("read", [bytes_of, text_of, lambda file: next(lines_of(file))])
def test_neither_pipe_nor_device_is_waited_for(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    pipe = tmp_path / "pipe.req"
    os.mkfifo(pipe)
    for file in (pipe, Path("/dev/null")):
        with pytest.raises(BadInput, match="not a regular file"):
            read(file)
