"""The loop of `cratous icarous`: one connection to UxAS, its lines to the step, the answers back.

The program either connects or waits for UxAS to connect, one UxAS at a time. A closed connection is
re-established, and UxAS then sends everything again; epochs continue. Time is that of POSTN, so no decision
depends on the machine's clock.

With a direct connection to the autopilot, the program continues when POSTN stops: state and time then come
from the autopilot, and steering goes there, until POSTN resumes. With a direct link, it sends the other
vehicles each accepted own state, and receives theirs.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import zmq

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Report, Tally, is_due
from cratous.bridge.redial import Redial
from cratous.bridge.text_connection import REFUSED, Opened
from cratous.bridge.text_port import Came, TextPort
from cratous.bridge.text_protocol import (
    Hello,
    Message,
    NotKnown,
    OwnPosition,
    Skipped,
    WireError,
)
from cratous.core.authority.timeliness import lasted
from cratous.services.icarous.other_vehicles import LINK_LOST_MS
from cratous.services.icarous_program.autopilot import Autopilot, Reported
from cratous.services.icarous_program.direct import DirectLink
from cratous.services.icarous_program.epochs import EpochFile
from cratous.services.icarous_program.step import (
    Answer,
    IcarousEnd,
    Note,
    Refuse,
    State,
    Step,
    Tell,
)
from cratous.spec.errors import BadInput, CratousError

_LONGEST_POLL_MS = 200  # bounded so that a signal is noticed


class UxasGone(CratousError):
    """UxAS could not be reached, or was lost, for longer than the configured wait."""

    exit_code = 3


class Patience(NamedTuple):
    """wait_s: how long to wait for UxAS, at the start and after each loss [s]; once: end after the first
    connection.
    """

    wait_s: float = 60.0
    once: bool = False


class Besides(NamedTuple):
    """Optional connections besides UxAS: the direct link to the other vehicles, and the autopilot."""

    direct: DirectLink | None = None
    autopilot: Autopilot | None = None

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets to poll, each with its flags."""
        found = [] if self.autopilot is None else self.autopilot.handles()
        return found if self.direct is None else [*found, (self.direct.fileno(), zmq.POLLIN)]

    def close(self) -> None:
        """Close both."""
        for one in self:
            if one is not None:
                one.close()


class Program:
    """One vehicle's ICAROUS. `run` returns when `stopping` is set, and raises UxasGone if UxAS stays away."""

    def __init__(
        self,
        end: IcarousEnd,
        port: TextPort,
        report: Report,
        patience: Patience = Patience(),
        clock: Callable[[], float] = time.monotonic,
        epochs: EpochFile | None = None,
        besides: Besides = Besides(),
    ) -> None:
        """epochs: keeps the gate over a restart; BadInput if the file is invalid."""
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
        self._besides, self._alone = besides, False
        self._told_ms = self._passed = self._waypoints = 0

    def run(self) -> None:
        """Run until `stopping`. UxasGone if UxAS cannot be reached or stays away."""
        try:
            while not self.stopping:
                self.turn()
        finally:
            self._port.close()
            self._besides.close()
            if self._besides.direct is not None:
                self._report("INFO", f"direct link: {self._besides.direct.counts.line()}")
            refused = self._tally.counts.refused
            lines = ", ".join(f"{why}: {n}" for why, n in sorted(refused.items())) or "none"
            self._report("INFO", f"ended; {self._port.counts.line()}; not acted upon: {lines}")

    def turn(self) -> None:
        """Wait for input and process all that is available."""
        self._redial.step(self._clock())
        self._wait()
        now_s = self._clock()
        for came in self._port.step(now_s):
            self._came(came, now_s)
        if self._besides.direct is not None:
            for state in self._besides.direct.step():
                self._made(state.line, partial(self._end.peer, self.state, *state))
        autopilot = self._besides.autopilot
        for reported in () if autopilot is None else autopilot.step(now_s):
            self._flown(reported)
        if autopilot is not None and autopilot.there:
            return  # the vehicle is still under control
        if not self._open and is_due(self._until_s, now_s):
            where = self._port.where.text
            raise UxasGone(f"{where}: no UxAS for {self._patience.wait_s:g} s ({self._why})")

    def _wait(self) -> None:
        poller = zmq.Poller()
        handles = [*self._port.handles(), *self._besides.handles()]
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
                self._step(self._end.connected(self.state))
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
            if event.kind != REFUSED:  # a peer of another dialect does not extend the wait
                self._until_s = now_s + self._patience.wait_s

    def _line(self, line: Message) -> None:
        before = self.state
        self._made(line, lambda: self._end.handle(self.state, line))
        if isinstance(line, OwnPosition) and self.state is not before:
            self._told_ms, self._waypoints = round(1000 * line.time_s), self._passed
            if self._alone:
                self._alone = False
                self._report("INFO", f"{self._told_ms} ms: POSTN comes again")
            self._say_directly(line)

    def _flown(self, reported: Reported) -> None:
        """Handle a state from the autopilot; it is used once a plan is in force and POSTN has been missing
        for a while.
        """
        line, self._passed = reported
        now_ms, told = round(1000 * line.time_s), self.state.instance.told
        if not told.started or not lasted(self._told_ms, now_ms, LINK_LOST_MS):
            return
        if not self._alone:
            self._alone = True
            self._report("WARN", f"{now_ms} ms: no POSTN of UxAS; the state is the autopilot's")
        before = self.state
        passed, self._waypoints = self._passed - self._waypoints, self._passed
        self._made(line, lambda: self._end.alone(self.state, line, passed))
        if self.state is not before:
            self._say_directly(line)

    def _say_directly(self, line: OwnPosition) -> None:
        if self._besides.direct is not None:
            self._besides.direct.say(replace(line, vehicle_id=self._end.craft.config.vehicle_id))

    def _made(self, line: Message, made: Callable[[], Step]) -> None:
        """Execute a step; an exception at one line must not end the avoidance."""
        try:
            step = made()
        except Exception as error:
            self._tally.refuse("line that the step fails at", f"{line}: {error!r}")
            return
        self._step(step)

    def _step(self, step: Step) -> None:
        state, answers = step
        self._keep(state, self.state)
        self._answer(answers)

    def _keep(self, state: State, before: State) -> None:
        """Store the state; a changed gate is written to the file before it is told to anyone."""
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
        if self._alone and self._besides.autopilot is not None:
            self._besides.autopilot.steer(line)
        if self._key is not None:
            self._port.send(self._key, line)
