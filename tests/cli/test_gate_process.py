"""The gate beside what its caller imports: the same answers, and nothing that is not an answer accepts."""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from cratous.core import ledger
from cratous.core.kernel import REGISTRY
from cratous.core.ledger import Problem, Standing
from cratous.services.cli import job, main
from cratous.services.startup import gate_process
from cratous.services.startup.gate_process import Gate, Here, begun
from cratous.spec.errors import BadInput, Refused

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the gate is forked on Linux only")
GOOD = {"kernels": 2, "theorems": 3, "assumptions": 0, "problems": []}
WITHOUT = "without an answer"


@pytest.fixture(autouse=True)
def _forks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gate_process, "_may_fork", lambda: True)


def answered(*, allow_unproved: bool = False) -> Standing:
    with begun(allow_unproved=allow_unproved) as gate:
        assert isinstance(gate, Gate)
        return gate.standing()


def test_it_answers_as_the_gate_here(monkeypatch: pytest.MonkeyPatch) -> None:
    assert answered(allow_unproved=True) == ledger.require(allow_unproved=True)
    process, given = os.getpid(), Standing(2, 3, 1, (Problem("a", "b"), Problem("c", "d")))

    def require(**how: bool) -> Standing:
        assert os.getpid() != process
        assert how == {"allow_unproved": True}
        return given

    monkeypatch.setattr(ledger, "require", require)
    assert answered(allow_unproved=True) == given


def test_what_it_refuses_is_refused_in_the_same_words(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = ledger.check_everything()
    wrong = Standing(whole.kernels, 1, 0, (Problem(next(iter(REGISTRY)), "changed"),))
    monkeypatch.setattr(ledger, "check_everything", lambda folder=None: wrong)
    with pytest.raises(Refused) as here:
        ledger.require()
    with pytest.raises(Refused) as beside:
        answered()
    assert str(beside.value) == str(here.value)


@pytest.mark.parametrize("end", [lambda: os._exit(0), lambda: os.kill(os.getpid(), signal.SIGKILL)])
def test_a_process_that_dies_is_a_refusal(end: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ledger, "require", lambda **_: end())
    with pytest.raises(Refused, match=WITHOUT):
        answered(allow_unproved=True)


@pytest.mark.parametrize(
    ("said", "code"),
    [
        (b"", 0),
        (b"{}", 0),
        (b"[]", 0),
        (b"null", 0),
        (b"\xff\xfe", 0),
        (b"[" * 100_000, 0),
        (json.dumps(GOOD).encode()[:-1], 0),
        (json.dumps(GOOD).encode() * 2, 0),
        (json.dumps(GOOD).encode(), 1),
        (json.dumps({**GOOD, "more": 1}).encode(), 0),
        (json.dumps({**GOOD, "kernels": -1}).encode(), 0),
        (json.dumps({**GOOD, "kernels": True}).encode(), 0),
        (json.dumps({**GOOD, "kernels": 2.0}).encode(), 0),
        (json.dumps({**GOOD, "problems": [["a"]]}).encode(), 0),
        (json.dumps({**GOOD, "problems": [["a", 1]]}).encode(), 0),
        (json.dumps({**GOOD, "problems": {}}).encode(), 0),
        (json.dumps({**GOOD, "refused": "x"}).encode(), 0),
        (b'{"refused": 1}', 0),
        (b'{"elsewhere": false}', 0),
    ],
)
def test_an_answer_that_is_none_is_a_refusal(
    said: bytes, code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def answer(write: int, *_: Any) -> None:
        try:
            os.write(write, said)
        finally:
            os._exit(code)

    monkeypatch.setattr(gate_process, "_answer", answer)
    with pytest.raises(Refused, match=WITHOUT):
        answered(allow_unproved=True)


def test_the_answer_of_these_tests_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """So each of the above is refused for its difference alone."""
    monkeypatch.setattr(
        gate_process,
        "_answer",
        lambda write, *_: (os.write(write, json.dumps(GOOD).encode()), os._exit(0)),
    )
    assert answered() == Standing(2, 3, 0, ())


def test_what_else_it_meets_is_raised_here(monkeypatch: pytest.MonkeyPatch) -> None:
    def require(**_: bool) -> Standing:
        raise BadInput("the cache folder cannot be trusted")

    monkeypatch.setattr(ledger, "require", require)
    with pytest.raises(BadInput, match="cannot be trusted"):
        answered()


def test_what_is_registered_or_replaced_meanwhile_is_looked_at_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    here: list[int] = []

    def require(**_: bool) -> Standing:
        here.append(1)
        return Standing(1, 1, 0, ())

    monkeypatch.setattr(ledger, "require", require)
    name, entry = next((n, e) for n, e in REGISTRY.items() if e.kind == "kernel")
    ledger.load_all()
    with begun(allow_unproved=False) as gate:
        monkeypatch.setitem(REGISTRY, "other.kernel", entry)
        gate.standing()
    assert here == [1]
    with begun(allow_unproved=False) as gate:
        monkeypatch.setattr(
            entry.function, "__code__", entry.function.__code__.replace(co_name="x")
        )
        gate.standing()
    assert here == [1, 1], name
    with begun(allow_unproved=False) as gate:
        gate.standing()
    assert here == [1, 1]


def test_with_threads_it_runs_in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    over = threading.Event()
    thread = threading.Thread(target=over.wait)
    thread.start()
    try:
        with begun(allow_unproved=True) as gate:
            assert isinstance(gate, Here)
    finally:
        over.set()
        thread.join()
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    with begun(allow_unproved=True) as gate:
        assert isinstance(gate, Here)


def test_who_needs_no_answer_any_more_leaves_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ledger, "require", lambda **_: time.sleep(60))
    before = time.monotonic()
    with begun(allow_unproved=True) as gate:
        assert isinstance(gate, Gate)
        child = gate._child
    assert time.monotonic() - before < 30
    with pytest.raises(ProcessLookupError):
        os.kill(child, 0)


@pytest.mark.parametrize("command", ["run", "plan"])
def test_nothing_is_planned_flown_or_written_before_its_answer(
    command: str, root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    def refused(**_: bool) -> Standing:
        time.sleep(0.5)
        raise Refused("the code is not what was proved")

    begun_work: list[str] = []
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ledger, "require", refused)
    monkeypatch.setattr(job, "new_bus", lambda: begun_work.append("planned"))
    monkeypatch.setattr(job, "fly_mission", lambda *_: begun_work.append("flown"))
    code = main([command, str(root / "examples" / "crossing" / "mission.yaml")])
    said = capsys.readouterr()
    assert code == Refused("").exit_code
    assert "the code is not what was proved" in said.err
    assert said.out == ""
    assert begun_work == []
    assert [file for file in tmp_path.rglob("*") if file.is_file()] == []
