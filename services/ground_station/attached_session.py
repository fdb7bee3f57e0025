"""State of a running UxAS or AMASE for the page: aircraft, plans, zones and tasks.

Nothing is sent to it. Times are arrival times, ms since the first connection. The stored data are
bounded: the last hour, or less if there is more in it; what is dropped is reported. A lost
connection is reported, and re-established.
"""

from __future__ import annotations

import math
import threading
from collections import deque
from typing import Any

from cratous.bridge.port import Address
from cratous.core.authority.timeliness import in_time, lasted
from cratous.services.ground_station.bands import Bands
from cratous.services.ground_station.bounded_rows import Bounded
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.ground_station.positions import Positions
from cratous.services.ground_station.recording import is_told, told_text
from cratous.services.ground_station.shapes import SHAPED, Shapes
from cratous.services.logs.entry import Entry
from cratous.services.logs.records import to_data
from cratous.services.logs.selection import names_of
from cratous.services.mission.frames import Projection
from cratous.services.requirements.attached import Attached
from cratous.spec.mission import Frame

WINDOW_MS, MOST_ROWS, LOOK_MS = 3_600_000, 200_000, 5000
"""Length of the stored window [ms], maximum number of track and band rows together, and interval of
the check [ms].
"""
AIRCRAFT, ROUTES, SHAPES, PLACES, EVENTS, WAITING = 1000, 2000, 2000, 100_000, 1000, 1000
UPDATES = 600
"""Number of updates that a page may lag behind; beyond that it starts anew."""
UPDATE_MS = 100
"""Messages within this time form one update [ms]."""
SILENT_MS = 3000
"""Time without messages after which silence is reported [ms]."""
CONNECTED = "connected"
"""Status text of the port when connected."""
WATCHING = "a running system is watched; `cratous monitor --attach` judges it"


class AttachedSession:
    """Watches in its own thread from its creation; `close` ends it."""

    token = ""
    """No token: there are no commands."""

    def __init__(self, where: Address) -> None:
        self._where = where
        self._changed = threading.RLock()
        self._positions, self._bands = Positions(AIRCRAFT), Bands()
        self._routes = Bounded(ROUTES, PLACES)
        self._zones, self._tasks = (Bounded(SHAPES, PLACES, _number) for _ in range(2))
        self._shapes: Shapes | None = None
        self._waiting: deque[tuple[Entry, int]] = deque(maxlen=WAITING)
        self._events: deque[dict[str, Any]] = deque(maxlen=EVENTS)
        self._new_events: deque[dict[str, Any]] = deque(maxlen=EVENTS)
        self._updates: deque[dict[str, Any]] = deque(maxlen=UPDATES)
        self._count = self._shown = self._looked_ms = self._last_ms = self._refused = 0
        self._flushed_ms = 0
        self._window_ms = WINDOW_MS
        self._vehicles: list[dict[str, Any]] = []
        self._framed: Frame | None = None
        self._said = "nobody listens there yet; trying"
        self._connected = self._ending = self._shorter = False
        self._failed = ""
        self._attached = Attached(where, self._report, self._find)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            for entry in self._attached.messages(math.inf, self._is_over):
                with self._changed:
                    self._add(entry)
        except Exception as error:
            with self._changed:
                self._failed = f"internal error of CRATOUS: {type(error).__name__}: {error}"

    def _is_over(self, now_ms: int) -> bool:
        with self._changed:
            if lasted(self._flushed_ms, now_ms, UPDATE_MS):
                self._flush(now_ms)
            return self._ending

    def _report(self, _severity: str, said: str) -> None:
        with self._changed:
            text = said.partition(f"{self._where.text}: ")[2] or said
            if text == CONNECTED and not self._connected:
                self._connected = True
                self._event(text)
            if not self._connected or text == CONNECTED:
                self._said = text  # why there is no connection; refused messages are counted

    def _find(self, kind: str, _time_ns: int) -> None:
        with self._changed:
            self._refused += kind == "refused"
            if kind == "cut" and self._connected:
                self._connected, self._said = False, "the connection is lost; trying again"
                self._event("the connection is lost")

    def _event(self, text: str) -> None:
        event = {"time_ms": self._attached.now_ms(), "vehicle": None, "text": text}
        self._events.append(event)
        self._new_events.append(event)

    def _add(self, entry: Entry) -> None:
        time_ms = self._last_ms = entry.time_ms
        self._positions.add(entry, time_ms)
        self._bands.add(entry, time_ms)
        if self._shapes is None and self._positions.frame is not None:
            to_local = Projection(self._positions.frame).to_local
            self._shapes = Shapes(to_local, self._routes, self._zones, self._tasks)
            for before in self._waiting:
                self._shapes.add(*before)
            self._waiting.clear()
        if self._shapes is not None:
            self._shapes.add(entry, time_ms)
        elif not SHAPED.isdisjoint(names_of(entry.topic)):
            self._waiting.append((entry, time_ms))
        if is_told(entry):
            self._event(told_text(entry))

    def _flush(self, now_ms: int) -> None:
        """Collect new data into an update."""
        self._flushed_ms = now_ms
        self._forget(now_ms)
        fixed: dict[str, Any] = {"end_ms": now_ms, "unread": self._unread()}
        fixed["window_ms"] = self._window_ms
        if self._shapes is not None and self._shapes.changes != self._shown:
            self._shown = self._shapes.changes
            fixed |= {"zones": [dict(one) for one in self._zones]}
            fixed |= {"tasks": [dict(one) for one in self._tasks]}
        if (frame := self._positions.frame) != self._framed:
            self._framed = frame
            fixed["frame"] = to_data(frame)
        if (vehicles := self._positions.vehicles()) != self._vehicles:
            self._vehicles = fixed["vehicles"] = vehicles
        more = {"events": list(self._new_events), "routes": self._routes.take_new()}
        self._new_events.clear()
        update = {
            "more": {key: rows for key, rows in more.items() if rows},
            "tracks": self._positions.take_new(),
            "bands": self._bands.take_new(),
            "set": fixed,
        }
        self._updates.append(update)
        self._count += 1

    def _forget(self, now_ms: int) -> None:
        if not lasted(self._looked_ms, now_ms, LOOK_MS):
            return
        self._looked_ms = now_ms
        if self._positions.size + self._bands.size > MOST_ROWS:
            self._window_ms, self._shorter = int(0.8 * self._window_ms), True
        for one in (self._positions, self._bands):
            one.forget(now_ms - self._window_ms)

    def _unread(self) -> int:
        shapes = 0 if self._shapes is None else self._shapes.unread
        return self._refused + self._positions.unread + self._bands.unread + shapes

    @property
    def status(self) -> dict[str, Any]:
        """State (connecting, watching, silent, cut off or failed) and text for the page."""
        with self._changed:
            now_ms = self._attached.now_ms()
            state, text = "watching" if self._connected else "cut off", self._said
            if self._failed:
                state, text = "failed", self._failed
            elif not self._connected and not self._attached.seq and not self._events:
                state = "connecting"
            elif self._connected and not in_time(self._last_ms, now_ms, SILENT_MS):
                state, text = "silent", f"nothing has come since {self._last_ms / 1000:.1f} s"
            left = self._positions.left_out
            gone = self._routes.let_go + self._zones.let_go + self._tasks.let_go
            rest = [f"{self._attached.seq} messages"]
            rest += [f"{left} states of more than {AIRCRAFT} aircraft are not shown"] * bool(left)
            rest += [f"{gone} of the oldest routes, zones and tasks are gone"] * bool(gone)
            if self._shorter:
                rest.append(f"the last {self._window_ms / 60000:.0f} minutes are kept")
            return {"state": state, "rate": 1.0, "text": "; ".join([text, *rest])}

    def begun(self) -> dict[str, Any]:
        """All stored data, for a page that opens; next: the first update that it should request."""
        with self._changed:
            self._flush(self._attached.now_ms())
            return {
                "live": True, "flight": 0, "attached": self._where.text, "next": self._count,
                "name": self._where.text, "source": "messages",
                "frame": to_data(self._positions.frame or Frame(0.0, 0.0)),
                "located": self._positions.frame is not None,
                "end_ms": self._attached.now_ms(), "outcome": "watched", "volume": None,
                "window_ms": self._window_ms, "vehicles": self._vehicles,
                "zones": [dict(one) for one in self._zones],
                "tasks": [dict(one) for one in self._tasks],
                "routes": list(self._routes), "tracks": self._positions.tracks(),
                "bands": self._bands.found, "events": list(self._events), "absences": [],
                "footprints": [], "authority": None, "takeovers": [], "phases": [], "links": None,
                "unread": self._unread(), "verdicts": {"why_none": WATCHING},
            }  # fmt: skip

    def told(self, first: int) -> dict[str, Any]:
        """The updates from a number on, and the status; again: the page lags too far behind and must start anew."""
        with self._changed:
            oldest = self._count - len(self._updates)
            again = not oldest <= first <= self._count
            found = [] if again else list(self._updates)[first - oldest :]
            return {
                "updates": found, "next": self._count, "more": False, "again": again, "flight": 0,
                "status": self.status,
            }  # fmt: skip

    def who(self, _token: str, _page: str) -> str:
        """Every page may only watch."""
        return "watch"

    def order(self, _token: str, _page: str, _asked: Any) -> None:
        """Raises NotObeyed: a running system is only watched."""
        raise NotObeyed(403, "a running system is watched, and not commanded")

    def close(self) -> None:
        """Stop watching."""
        with self._changed:
            self._ending = True
        self._thread.join()


def _number(row: dict[str, Any]) -> Any:
    return row["id"]
