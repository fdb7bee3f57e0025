"""The server's view of the flight process: its output so far, its status, and who commands it."""

from __future__ import annotations

import hmac
import json
import secrets
import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.services.ground_station.json_process import JsonProcess
from cratous.services.ground_station.pace import RATES
from cratous.spec.errors import BadInput

ABSENT_S = 3.0
"""Time without requests after which a page loses command [s]."""
MOST_TOLD = 300
"""Maximum number of updates in one answer."""
OVER = ("ended", "stopped", "failed", "lost")
ORDERS = ("play", "pause", "step", "rate", "stop", "take")
COMMAND = "command"
"""An order that changes the mission: the flight is flown again up to now, and then with the change."""
ENDING_S = 20.0


Amend = Callable[[int, Any], dict[str, Any]]


class Direct(NamedTuple):
    """Commands for direct execution. kinds: their names; checked(now_ms, command): raises NotObeyed
    or BadInput for an invalid one; flown: receives the mission's text with the executed commands.
    """

    kinds: tuple[str, ...]
    checked: Callable[[int, Any], None]
    flown: Callable[[str], None]


class NotObeyed(Exception):
    """A command that is not executed; status: of HTTP."""

    def __init__(self, status: int, why: str) -> None:
        super().__init__(why)
        self.status, self.why = status, why


class LiveSession:
    """Starts the flight process and stores all its output, in order.

    token: whoever has it may command, one page at a time. status: state and text for the page.
    """

    def __init__(
        self,
        module: str,
        asked: dict[str, Any],
        commanded: Amend | None = None,
        direct: Direct | None = None,
    ) -> None:
        """module: argument of `python -m` for the flight; asked: its request; commanded: for a
        flight time [ms] and a command, returns the request for the flight with it, which has
        `until_ms`, or raises NotObeyed or BadInput; direct: commands that need no new flight.
        """
        self.token = secrets.token_urlsafe(24)
        self.status: dict[str, Any] = {"state": "loading", "rate": 1.0, "text": ""}
        self._updates: list[str] = []
        self._begin: dict[str, Any] | None = None
        self._changed = threading.Condition()
        self._commanding = threading.Lock()
        self._operator, self._seen_s = "", 0.0
        self._module, self._commanded, self._direct = module, commanded, direct
        self._given = 0
        """Number of direct commands not yet executed."""
        self._flight = self._now_ms = self._until_ms = 0
        self._process = self._start(asked)

    def _start(self, asked: dict[str, Any]) -> JsonProcess:
        """Start a flight process; later output of a previous one is ignored."""
        number = self._flight

        def heard(told: dict[str, Any], line: str) -> None:
            if number == self._flight:
                self._heard(told, line)

        def ended(how: str) -> None:
            if number == self._flight:
                self._ended(how)

        process = JsonProcess(self._module, heard, ended, json.dumps({**asked, "text": None}))
        if "text" in asked:
            process.say({"text": asked["text"]})
        return process

    def _heard(self, told: dict[str, Any], line: str) -> None:
        with self._changed:
            self._now_ms = told.get("set", {}).get("end_ms", self._now_ms)
            if "directed" in told:
                self._taken_up(told["directed"])
            elif "begin" in told:
                self._begin = told["begin"]
            elif "status" in told:
                self.status = {**self.status, **told["status"]}
            else:
                self._updates.append(line)
            self._changed.notify_all()

    def _taken_up(self, told: dict[str, Any]) -> None:
        self._given = max(0, self._given - 1)
        if self._direct is not None:
            self._direct.flown(told["text"])
        if told["refused"]:
            self.status = {**self.status, "text": f"Not done: {told['refused']}"}

    def _ended(self, how: str) -> None:
        with self._changed:
            if self.status["state"] not in OVER:
                self.status = {
                    **self.status, "state": "lost",
                    "text": f"The process that flies ended without a word ({how}). What is shown is "
                    "what it told before; the flight has no results.",
                }  # fmt: skip
            self._changed.notify_all()

    def begun(self) -> dict[str, Any]:
        """The data from the mission, for a page that opens; waits for it. Raises BadInput if there is none."""
        with self._changed:
            self._changed.wait_for(lambda: self._begin is not None or self.status["state"] in OVER)
            if self._begin is None:
                error = self.status.get("error") or {"error": self.status["text"]}
                known = {
                    key: str(error.get(key, "")) for key in ("where", "item", "expected", "got")
                }
                raise BadInput(str(error.get("error")), **known)
            return {**self._begin, "flight": self._flight}

    def told(self, first: int) -> dict[str, Any]:
        """The updates from a number on, some hundreds at most, and the flight's status."""
        with self._changed:
            found = self._updates[first : first + MOST_TOLD]
            total, status = len(self._updates), dict(self.status)
        return {
            "updates": [json.loads(line) for line in found],
            "next": first + len(found),
            "more": first + len(found) < total,
            "flight": self._flight,
            "status": status,
        }

    def knows(self, token: str) -> bool:
        """True iff the token is right."""
        return hmac.compare_digest(token.encode(), self.token.encode())

    def who(self, token: str, page: str) -> str:
        """Role of a page: "you" command, "other" commands, or "watch" only."""
        if not self.knows(token) or not page:
            return "watch"
        with self._changed:
            now_s = time.monotonic()
            if self._operator != page and now_s - self._seen_s < ABSENT_S:
                return "other"
            self._operator, self._seen_s = page, now_s
            return "you"

    def order(self, token: str, page: str, asked: Any) -> None:
        """Execute a command of a page. Raises NotObeyed, with the reason."""
        if not self.knows(token):
            raise NotObeyed(
                403, "commands need the token of the address that `cratous serve` printed"
            )
        if not isinstance(asked, dict) or asked.get("do") not in (*ORDERS, COMMAND) or not page:
            raise NotObeyed(400, f"expected one of {', '.join(ORDERS)}")
        if asked["do"] == "rate" and asked.get("rate") not in RATES:
            raise NotObeyed(400, f"expected a rate of {', '.join(f'{rate:g}' for rate in RATES)}")
        if asked["do"] == "take":
            with self._changed:
                self._operator, self._seen_s = page, time.monotonic()
            return
        if self.who(token, page) != "you":
            raise NotObeyed(409, "another page commands this flight")
        if self.status["state"] in OVER:
            raise NotObeyed(409, "the flight is over")
        if asked["do"] == COMMAND:
            self._command(asked.get("command"))
            return
        self._process.say({key: asked[key] for key in ("do", "rate") if key in asked})

    def _command(self, command: Any) -> None:
        """Restart the flight with a command, and fly it up to the time of the command."""
        if self._commanded is None:
            raise NotObeyed(409, "this flight takes no commands that change its mission")
        if self._direct is not None and self._is_direct(command):
            self._give(self._direct, command)
            return
        with self._commanding:
            if self.status["state"] != "paused":
                raise NotObeyed(409, "the flight has to be paused for a command")
            self._refuse_on_the_way()
            if self._given:
                raise NotObeyed(409, "the command before has to be flown first: fly on by a step")
            asked = self._commanded(self._now_ms, command)
            with self._changed:
                before = self._process
                self._flight, self._now_ms, self._until_ms = self._flight + 1, 0, asked["until_ms"]
                self._updates, self._begin = [], None
                self.status = {
                    **self.status,
                    "state": "loading",
                    "text": "flying anew up to the command",
                }
            before.end(ENDING_S)
            self._process = self._start(asked)

    def _refuse_on_the_way(self) -> None:
        if not lasted(0, self._now_ms, self._until_ms):
            raise NotObeyed(
                409, f"the flight is flown anew up to {self._until_ms / 1000:g} s first"
            )

    def _is_direct(self, command: Any) -> bool:
        kinds = () if self._direct is None else self._direct.kinds
        return isinstance(command, dict) and command.get("what") in kinds

    def _give(self, direct: Direct, command: Any) -> None:
        """Let the flight execute a command at its next step."""
        with self._commanding:
            if self.status["state"] not in ("paused", "flying"):
                raise NotObeyed(409, "the flight has not begun")
            self._refuse_on_the_way()
            direct.checked(self._now_ms, command)
            with self._changed:
                self._given += 1
            self._process.say({"do": "direct", "command": command})

    def close(self) -> None:
        """End the process; an unfinished flight leaves no results."""
        self._process.end(ENDING_S)
