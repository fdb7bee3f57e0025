"""A flight in progress: publishes new display data as JSON lines, and executes commands.

It reads the messages and calls no kernel, so that the flight's counts and log are unaffected. For
the same reason the monitor is asked for interim verdicts in a fork of the process.
"""

from __future__ import annotations

import json
import os
import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from cratous.bridge import lmcp
from cratous.services.certify.verdicts import constraint_rows, plan_rows, requirement_rows
from cratous.services.ground_station.deferred_signals import held_back
from cratous.services.ground_station.direct_orders import DirectOrders
from cratous.services.ground_station.flight_display import FlownRecording
from cratous.services.ground_station.pace import RATES, Pace
from cratous.services.ground_station.verdicts import shown
from cratous.services.logs.entry import Entry
from cratous.spec.files.printable import json_text
from cratous.spec.mission import Change, Mission
from cratous.spec.mission.guarantees import Outcome, Verdict, worst

TOLD_S = 0.1
"""Minimum interval of updates [s]."""
JUDGED_S = 1.0
"""Minimum interval of interim verdicts from the monitor [s]."""
GROWING = ("authority", "phases", "events", "routes", "links")
CHANGED = "cratous.MissionChange"
DIRECT = "direct"
"""Kind of order that contains a command for direct execution."""
Send = Callable[[dict[str, Any]], None]


class LiveFlight:
    """Taps a bus, paces the flight and sends updates.

    send: called with each update, from any thread; judged: descriptor of a pipe for verdict lines;
    orders: direct commands of the operator.
    """

    def __init__(
        self, mission: Mission, send: Send, judged: int, orders: DirectOrders | None = None
    ) -> None:
        self.pace = Pace()
        self._orders, self._ordered_ms = orders, -1
        self._send, self._judged = send, judged
        self._recording = FlownRecording(mission)
        self._sent: dict[str, int] = dict.fromkeys(GROWING, 0)
        self._points: dict[int, int] = {}
        self._seen: dict[str, str] = {}
        self._now_ms = 0
        self._told_s = self._asked_s = 0.0
        self._asked_ms = -1
        self._judge = 0
        self._checks: list[Verdict] = []
        self._monitor: Any = None
        send({"begin": self._begin()})

    def _begin(self) -> dict[str, Any]:
        empty: dict[str, Any] = {key: [] for key in (*GROWING, "takeovers", "footprints")}
        return {
            **self._recording.first(), **empty, "tracks": {}, "bands": {}, "end_ms": 0, "outcome": "in flight", "unread": 0,
            "verdicts": {"why_none": "the flight has not begun"},
        }  # fmt: skip

    def joined(self, bus: Any) -> None:
        """See `job.Onlooker`."""
        bus.tap(self._tap)

    def planned(self, checks: list[Verdict], monitor: Any) -> None:
        """See `job.Onlooker`."""
        self._checks, self._monitor = checks, monitor
        self.tell()

    def command(self, asked: dict[str, Any]) -> None:
        """Execute an operator command: play, pause, step or rate; a direct command at the next step."""
        what = asked.get("do")
        if what == "play":
            self.pace.play()
        elif what == "pause":
            self.pace.pause()
        elif what == "step":
            self.pace.step()
        elif what == "rate" and asked.get("rate") in RATES:
            self.pace.set_rate(float(asked["rate"]))
        elif what == DIRECT and self._orders is not None:
            self._orders.give(asked.get("command"))
        self.state()

    def directed(self, now_ms: int) -> tuple[Change, ...]:
        """See `job.Onlooker`."""
        found = () if self._orders is None else self._orders.due(now_ms, self._send)
        self._ordered_ms = now_ms if found else self._ordered_ms
        return found

    def commanded(self) -> Mission | None:
        """See `job.Onlooker`."""
        return None if self._orders is None else self._orders.mission

    def state(self) -> None:
        """Send whether it flies, and its rate."""
        state = "paused" if self.pace.paused else "flying"
        if self._monitor is not None:
            self._send({"status": {"state": state, "rate": self.pace.rate}})

    def _tap(self, envelope: Any) -> None:
        if envelope.time_ms > self._now_ms:  # the first message of a step
            if time.monotonic() - self._told_s >= TOLD_S:
                self.tell()
                if time.monotonic() - self._asked_s >= JUDGED_S:
                    self._ask()
            self.pace.wait(envelope.time_ms, self._standing)
            self._now_ms = envelope.time_ms
        if envelope.topic == CHANGED and envelope.time_ms == self._ordered_ms:
            said = envelope.body
            self._send(
                {"status": {"text": f"At {said.Time / 1000:g} s {said.What}: {said.Consequence}."}}
            )
        body = lmcp.to_json(envelope.body)
        self._recording.add(
            Entry(envelope.seq, envelope.time_ms, envelope.source, envelope.topic, body)
        )

    def _standing(self) -> None:
        """Publish and judge everything up to the current instant, when paused."""
        self._reap(wait=True)
        self.tell()
        self._ask()

    def tell(self) -> None:
        """Send what is new since the last call."""
        self._told_s = time.monotonic()
        recording, flight = self._recording, self._recording.reader.flight
        lists: dict[str, list[Any]] = {
            "authority": flight.authority, "phases": flight.phases, "events": flight.events,
            "routes": recording.shapes.routes, "links": recording.links.found,
        }  # fmt: skip
        more = {key: rows[self._sent[key] :] for key, rows in lists.items()}
        self._sent = {key: len(rows) for key, rows in lists.items()}
        tracks = {
            str(number): track[self._points.get(number, 0) :]
            for number, track in flight.tracks.items()
        }
        self._points = {number: len(track) for number, track in flight.tracks.items()}
        update: dict[str, Any] = {
            "more": {key: rows for key, rows in more.items() if rows},
            "tracks": {number: rows for number, rows in tracks.items() if rows},
            "heads": {str(number): row for number, row in recording.reader.last.items()},
            "set": {"end_ms": flight.end_ms, "unread": recording.unread},
        }
        if bands := recording.bands.take_new():
            update["bands"] = bands
        seen = [(task, rows[-1]["time_ms"]) for task, rows in flight.footprints.items()]
        for key, mark, rows_of in (
            ("takeovers", json_text(flight.takeovers), lambda: flight.takeovers),
            ("footprints", json_text(seen), recording.footprints),
        ):
            if self._seen.get(key, "[]") != mark:
                self._seen[key] = mark
                update["set"][key] = rows_of()
        self._send(update)
        self.state()

    def verdicts(self, report: dict[str, Any]) -> None:
        """Send the verdicts of the report of the whole flight."""
        self._send({"set": {"verdicts": shown(report, "report")}})

    def _ask(self) -> None:
        """Request interim verdicts in a fork; no effect while one is still running."""
        if self._monitor is None or self._now_ms == self._asked_ms or not self._reap(wait=False):
            return
        self._asked_s, self._asked_ms = time.monotonic(), self._now_ms
        with held_back():
            child = os.fork()
        if child:
            self._judge = child
            return
        code = 1
        try:
            _keep_open(self._judged)
            self._write(self._so_far())
            code = 0
        finally:
            os._exit(code)  # the child must not run the flight's cleanup

    def _write(self, update: dict[str, Any]) -> None:
        """Write a line to the verdict pipe; it starts on a new line, whatever was written before."""
        data = b"\n" + json_text(update).encode() + b"\n"
        while data:
            data = data[os.write(self._judged, data) :]

    def _so_far(self) -> dict[str, Any]:
        rows = plan_rows(self._checks) + constraint_rows(self._monitor.verdicts(), "flight")
        found = {
            "requirements": requirement_rows(rows),
            "constraints": rows,
            "verdict": worst([Outcome(row["verdict"]) for row in rows]),
        }
        return {"set": {"verdicts": {**shown(found, "monitor"), "so_far_ms": self._now_ms}}}

    def _reap(self, *, wait: bool) -> bool:
        """True iff no child is running any more."""
        if self._judge:
            done, how = os.waitpid(self._judge, 0 if wait else os.WNOHANG)
            if not done:
                return False
            self._judge = 0
            code = os.waitstatus_to_exitcode(how)
            if code:
                ended = f"signal {-code}" if code < 0 else f"exit code {code}"
                why = f"at {self._asked_ms / 1000:.1f} s the monitor could not be asked: its process failed ({ended})"
                # through the same pipe, so that no older verdicts follow it
                self._write({"set": {"verdicts": {"why_none": why}}})
        return True

    def end_judge(self) -> None:
        """Terminate the judging child, if any; its result is no longer needed."""
        self._monitor = None  # no further verdicts are requested
        if self._judge:
            os.kill(self._judge, signal.SIGKILL)
            os.waitpid(self._judge, 0)
            self._judge = 0


def _keep_open(kept: int) -> None:
    """Close all other descriptors in the child: locks and pipe ends belong to the flight."""
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    for number in map(int, os.listdir("/dev/fd")):
        if number > 2 and number != kept:
            with suppress(OSError):  # the descriptor used for listing
                os.close(number)


def forward(source: int, send: Send) -> threading.Thread:
    """A thread that forwards each line of a pipe until it is closed; an incomplete line is dropped."""

    def run() -> None:
        with os.fdopen(source, "rb") as lines, suppress(BrokenPipeError):
            for line in lines:
                with suppress(ValueError):
                    send(json.loads(line))

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return thread
