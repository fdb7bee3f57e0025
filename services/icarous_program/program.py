"""The loop of `cratous icarous`: one connection to UxAS, its lines to the step, the answers back.

Either the program connects, or it waits for UxAS to connect to it, one UxAS at a time. The connection that ends comes again, and UxAS tells everything anew on it; epochs go on. Time is that of
POSTN, so nothing that is decided depends on the machine's clock.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

import zmq

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Report, Tally, is_due
from cratous.bridge.redial import Redial
from cratous.bridge.text_connection import REFUSED, Opened
from cratous.bridge.text_port import Came, TextPort
from cratous.bridge.text_protocol import Hello, Message, NotKnown, Skipped, WireError
from cratous.services.icarous_program.epochs import EpochFile
from cratous.services.icarous_program.step import Answer, IcarousEnd, Note, Refuse, State, Tell
from cratous.spec.errors import BadInput, CratousError

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
        epochs: EpochFile | None = None,
    ) -> None:
        """epochs: keeps the gate over a restart; BadInput if it is none."""
        self._end, self._port, self._report = end, port, report
        self._patience, self._clock = patience, clock
        self.state, self.stopping, self._epochs = State(), False, epochs
        if epochs is not None:
            self.state = replace(self.state, gate=epochs.resumed())
            epochs.keep(self.state.gate)
        self._tally = Tally(f"vehicle {end.craft.config.vehicle_id}", report)
        self._key: int | None = None
        self._open = False
        self._redial = Redial(port, () if port.listens else (port.where,))
        self._until_s, self._why = clock() + patience.wait_s, "it has not connected"

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
        self._redial.step(self._clock())
        self._wait()
        now_s = self._clock()
        for came in self._port.step(now_s):
            self._came(came, now_s)
        if not self._open and is_due(self._until_s, now_s):
            where = self._port.where.text
            raise UxasGone(f"{where}: no UxAS for {self._patience.wait_s:g} s ({self._why})")

    def _wait(self) -> None:
        poller = zmq.Poller()
        handles = self._port.handles()
        for handle, flags in handles:
            poller.register(handle, flags)
        if handles:
            with contextlib.suppress(InterruptedError):
                poller.poll(_LONGEST_POLL_MS)
        else:
            time.sleep(max(0.0, min(_LONGEST_POLL_MS / 1000, self._pause_s())))

    def _pause_s(self) -> float:
        due_s = self._redial.due_s
        return _LONGEST_POLL_MS / 1000 if due_s is None else due_s - self._clock()

    def _came(self, came: Came, now_s: float) -> None:
        if self._open and came.key != self._key:
            if isinstance(came.what, Opened):
                self._port.drop(came.key, "another UxAS is connected")
            elif isinstance(came.what, LinkEvent):
                self._tally.refuse("second connection", f"{came.what.kind} {came.what.detail}")
            return
        match came.what:
            case Opened(peer):
                self._open, self._key = True, came.key
                self._redial.opened(came.key, now_s)
                self._report("INFO", f"connected to UxAS at {peer}")
                self._say(Hello(self._end.craft.config.vehicle_id))
                state, answers = self._end.connected(self.state)
                self._keep(state, self.state)
                self._answer(answers)
            case LinkEvent() as event:
                self._ended(came.key, event, now_s)
            case Message() as line:
                self._line(line)
            case WireError(kind=kind) if kind:
                self._say(NotKnown(kind))
            case Skipped() as skipped:
                self._tally.refuse("not known", skipped.text)

    def _ended(self, key: int, event: LinkEvent, now_s: float) -> None:
        why = event.detail or event.kind
        said = self._redial.ended(key, why, now_s) or self._port.listens
        was_open, self._open, self._key, self._why = self._open, False, None, why
        if said or was_open:
            what = "has ended" if was_open else "has not come about"
            self._report("WARN", f"the connection to UxAS {what}: {why}")
        if was_open:
            if self._patience.once:
                raise UxasGone(f"{self._port.where.text}: {why}")
            if event.kind != REFUSED:  # an end of another dialect is none to go on waiting for
                self._until_s = now_s + self._patience.wait_s

    def _line(self, line: Message) -> None:
        try:
            state, answers = self._end.handle(self.state, line)
        except Exception as error:  # one line must not end the avoidance of the next ones
            self._tally.refuse("line that the step fails at", f"{line}: {error!r}")
            return
        self._keep(state, self.state)
        self._answer(answers)

    def _keep(self, state: State, before: State) -> None:
        """The state from now on; a gate that is another one is kept before anybody hears of it."""
        if self._epochs is not None and state.gate != before.gate:
            try:
                self._epochs.keep(state.gate)
            except BadInput as error:  # a full disk does not end the avoidance
                self._report("ERROR", f"the epoch is not kept over a restart: {error}")
        self.state = state

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
