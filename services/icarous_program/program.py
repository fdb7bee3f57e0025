"""The loop of `cratous icarous`: one connection to UxAS, its lines to the step, the answers back.

The connection that ends comes again, and UxAS tells everything anew on it; epochs go on. Time is that of
POSTN, so nothing that is decided depends on the machine's clock.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

import zmq

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Report, Tally, is_due
from cratous.bridge.text_port import Came, Opened, TextPort
from cratous.bridge.text_protocol import Hello, Message, Skipped
from cratous.services.icarous_program.step import Answer, IcarousEnd, Note, Refuse, State, Tell
from cratous.spec.errors import BadInput, CratousError

_PAUSE_S = (0.1, 2.0)
"""First and longest pause between attempts to connect."""
_LONGEST_POLL_MS = 200  # so that a signal is seen


class UxasGone(CratousError):
    """UxAS was not reached, or is gone, for longer than the program was told to wait."""

    exit_code = 3


class Patience(NamedTuple):
    """wait_s: how long to wait for UxAS, at the start and each time that it is gone; once: the end of
    the first connection is the end."""

    wait_s: float = 60.0
    once: bool = False


class Program:
    """One vehicle's ICAROUS; `run` until `stopping` is set, or UxAS is gone for good."""

    def __init__(
        self,
        end: IcarousEnd,
        port: TextPort,
        report: Report,
        patience: Patience = Patience(),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._end, self._port, self._report = end, port, report
        self._patience, self._clock = patience, clock
        self.state, self.stopping = State(), False
        self._tally = Tally(f"vehicle {end.craft.config.vehicle_id}", report)
        self._key: int | None = None
        self._open = False
        self._again_s, self._pause_s = clock(), _PAUSE_S[0]
        self._until_s, self._why = clock() + patience.wait_s, "nobody listens there"

    def run(self) -> None:
        """UxasGone if UxAS cannot be had."""
        try:
            while not self.stopping:
                self.turn()
        finally:
            self._port.close()
            refused = self._tally.counts.refused
            lines = ", ".join(f"{why}: {n}" for why, n in sorted(refused.items())) or "none"
            self._report("INFO", f"ended; {self._port.counts.line()}; not acted upon: {lines}")

    def turn(self) -> None:
        """Wait for the next thing, and do all that is there to do."""
        now_s = self._clock()
        if self._key is None and is_due(self._again_s, now_s):
            self._dial(now_s)
        self._wait()
        now_s = self._clock()
        for came in self._port.step(now_s):
            self._came(came, now_s)
        if not self._open and is_due(self._until_s, now_s):
            where = self._port.where.text
            raise UxasGone(f"{where}: no UxAS for {self._patience.wait_s:g} s ({self._why})")

    def _dial(self, now_s: float) -> None:
        try:
            self._key = self._port.dial(now_s)
        except BadInput as error:
            self._why = error.got or error.what
            self._retry(now_s)

    def _retry(self, now_s: float) -> None:
        self._again_s = now_s + self._pause_s
        self._pause_s = min(2 * self._pause_s, _PAUSE_S[1])

    def _wait(self) -> None:
        poller = zmq.Poller()
        handles = self._port.handles()
        for handle, flags in handles:
            poller.register(handle, flags)
        if handles:
            with contextlib.suppress(InterruptedError):
                poller.poll(_LONGEST_POLL_MS)
        else:
            time.sleep(min(_LONGEST_POLL_MS / 1000, self._pause_s))

    def _came(self, came: Came, now_s: float) -> None:
        match came.what:
            case Opened(peer):
                self._open, self._pause_s = True, _PAUSE_S[0]
                self._report("INFO", f"connected to UxAS at {peer}")
                self._say(Hello(self._end.craft.config.vehicle_id))
                self.state, answers = self._end.connected(self.state)
                self._answer(answers)
            case LinkEvent(kind, detail):
                self._ended(f"{kind} {detail}".strip(), now_s)
            case Message() as line:
                self._line(line)
            case Skipped() as skipped:
                self._tally.refuse("not known", skipped.text)

    def _ended(self, why: str, now_s: float) -> None:
        self._report("WARN", f"the connection to UxAS has ended: {why}")
        was_open, self._open, self._key, self._why = self._open, False, None, why
        if was_open:
            if self._patience.once:
                raise UxasGone(f"{self._port.where.text}: {why}")
            self._until_s = now_s + self._patience.wait_s
        self._retry(now_s)

    def _line(self, line: Message) -> None:
        try:
            self.state, answers = self._end.handle(self.state, line)
        except Exception as error:  # one line must not end the avoidance of the next ones
            self._tally.refuse("line that the step fails at", f"{line}: {error!r}")
            return
        self._answer(answers)

    def _answer(self, answers: Iterable[Answer]) -> None:
        for answer in answers:
            match answer:
                case Tell(line):
                    self._say(line)
                case Note(severity, text):
                    self._report(severity, text)
                case Refuse(why, detail):
                    self._tally.refuse(why, detail)

    def _say(self, line: Message) -> None:
        if self._key is not None:
            self._port.send(self._key, line)
