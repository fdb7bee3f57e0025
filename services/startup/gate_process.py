"""The ledger's gate in a process of its own, while this one does what it may do before the gate's answer.

The process is a fork, so that what is compared with the proofs are the very functions that this process runs. Its
answer comes by a pipe, as data. Nothing else counts as an acceptance: if the process ends without an answer, or with
anything else than one, the code is refused.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

from cratous.core import ledger
from cratous.core.kernel import REGISTRY
from cratous.core.ledger import Problem, Standing
from cratous.services.processes.leash import end_at_once_with
from cratous.spec.errors import Refused

MOST_BYTES = 1 << 24
"""Longest answer that is read."""
COUNTS = ("kernels", "theorems", "assumptions")
REFUSED, ELSEWHERE = "refused", "elsewhere"


def nothing() -> None:
    """Prepare nothing."""


class Gate:
    """The gate's answer, which may still be on its way."""

    def __init__(self, allow_unproved: bool) -> None:
        self._allow = allow_unproved
        self._known = _running()
        read, write = os.pipe()
        parent = os.getpid()
        self._child = os.fork()
        if not self._child:
            _answer(write, parent, allow_unproved)
        os.close(write)
        self._pipe = os.fdopen(read, "rb")

    def standing(self, meanwhile: Callable[[], object] = nothing) -> Standing:
        """As `core.ledger.require`, with the same answers; meanwhile: what the caller prepares for after it.

        Raises Refused also if the process ended without an answer. To be called once.
        """
        meanwhile()
        said = self._pipe.read(MOST_BYTES)
        answer = _understood(said, self._ended())
        if ELSEWHERE in answer or not _same(self._known, _running()):
            # it failed otherwise than by refusing, or something was registered or replaced since
            return ledger.require(allow_unproved=self._allow)
        if REFUSED in answer:
            raise Refused(answer[REFUSED])
        problems = tuple(Problem(*one) for one in answer["problems"])
        return Standing(**{name: answer[name] for name in COUNTS}, problems=problems)

    def end(self) -> None:
        """End the process, whether or not it has answered."""
        self._pipe.close()
        if self._child:
            os.kill(self._child, signal.SIGKILL)  # it is ours until it is waited for
            self._ended()

    def _ended(self) -> int:
        """The exit code of the process, once it has ended."""
        child, self._child = self._child, 0
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


class Here:
    """The gate in this process."""

    def __init__(self, allow_unproved: bool) -> None:
        self._allow = allow_unproved

    def standing(self, meanwhile: Callable[[], object] = nothing) -> Standing:
        """As `Gate.standing`, without preparing anything: it would gain no time."""
        return ledger.require(allow_unproved=self._allow)

    def end(self) -> None:
        """There is no process to end."""


@contextlib.contextmanager
def begun(*, allow_unproved: bool) -> Iterator[Gate | Here]:
    """The gate, begun: its answer is `standing()`, and until then nothing may be answered, flown or written.

    It runs in a fork, before this process has threads; where forking is unsafe (threads, another system than Linux)
    or useless (one core), in this process when its answer is asked for.
    """
    gate: Gate | Here = Here(allow_unproved)
    if _may_fork():
        ledger.load_all()  # the fork looks at the functions of this process
        gate = Gate(allow_unproved)
    try:
        yield gate
    finally:
        gate.end()


def _may_fork() -> bool:
    """Whether a fork is safe and runs beside this process."""
    return (
        sys.platform == "linux"
        and threading.active_count() == 1
        and len(os.sched_getaffinity(0)) > 1
    )


def _running() -> list[tuple[str, Any, Any]]:
    """What is registered, with the code that it runs now."""
    return [
        (name, entry.function, getattr(entry.function, "__code__", None))
        for name, entry in REGISTRY.items()
    ]


def _same(one: list[tuple[str, Any, Any]], other: list[tuple[str, Any, Any]]) -> bool:
    """Whether these are the same functions with the same code."""
    return len(one) == len(other) and all(
        a[0] == b[0] and a[1] is b[1] and a[2] is b[2] for a, b in zip(one, other, strict=True)
    )


def _answer(write: int, parent: int, allow_unproved: bool) -> NoReturn:
    """In the fork: run the gate, write its answer, and end without the cleanup of the process that was forked."""
    code = 1
    try:
        gc.disable()  # collecting would copy the pages that both processes share
        end_at_once_with(parent)
        try:
            standing = ledger.require(allow_unproved=allow_unproved)
            problems = [[one.name, one.what] for one in standing.problems]
            answer = {**{n: getattr(standing, n) for n in COUNTS}, "problems": problems}
        except Refused as refusal:
            answer = {REFUSED: str(refusal)}
        except Exception:  # the other process meets it too, and says it
            answer = {ELSEWHERE: True}
        with open(write, "wb") as pipe:
            pipe.write(json.dumps(answer).encode())
        code = 0
    finally:
        os._exit(code)


def _understood(said: bytes, code: int) -> dict[str, Any]:
    """The answer; Refused if it is none."""
    answer: Any = None
    if code == 0:
        with contextlib.suppress(ValueError, RecursionError):
            answer = json.loads(said)
    if not _is_answer(answer):
        raise Refused(
            "the process that compares the code with its proofs ended without an answer "
            f"(exit code {code}): nothing vouches for the code that would fly"
        )
    found: dict[str, Any] = answer
    return found


def _is_answer(answer: Any) -> bool:
    if not isinstance(answer, dict):
        return False
    if answer.keys() == {REFUSED}:
        return isinstance(answer[REFUSED], str)
    if answer.keys() == {ELSEWHERE}:
        return answer[ELSEWHERE] is True
    if answer.keys() != {*COUNTS, "problems"} or not isinstance(answer["problems"], list):
        return False
    return all(type(answer[n]) is int and answer[n] >= 0 for n in COUNTS) and all(
        isinstance(one, list) and len(one) == 2 and all(isinstance(text, str) for text in one)
        for one in answer["problems"]
    )
