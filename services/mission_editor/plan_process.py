"""A process that plans the mission text of the page: its progress, the plan, and reasons for assignments."""

from __future__ import annotations

import threading
from typing import Any

from cratous.services.ground_station.json_process import JsonProcess

ENDING_S = 5.0


class PlanProcess:
    """Starts immediately; `told` returns the current result."""

    def __init__(self, module: str, number: int, asked: dict[str, Any]) -> None:
        """module: argument of `python -m` for the planner; number: of the plan; asked: its first
        request, including the text to plan.
        """
        self.text: str = asked["text"]
        self._told: dict[str, Any] = {
            "plan_number": number, "state": "planning", "text": "starting", "why": {},
        }  # fmt: skip
        self._lock = threading.Lock()
        self._waiting: set[str] = set()
        self._over = False
        self._process = JsonProcess(module, self._heard, self._ended)
        self._process.say(asked)

    def _heard(self, told: dict[str, Any], line: str) -> None:
        with self._lock:
            if self._told["state"] != "stopped":
                new = told.pop("why", {})
                self._waiting -= set(new)
                self._told = {**self._told, **told, "why": {**self._told["why"], **new}}

    def _ended(self, how: str) -> None:
        text = f"The process that plans ended without a word ({how})."
        with self._lock:
            self._over = True
            if self._told["state"] == "planning":
                self._told = {**self._told, "state": "failed", "text": text}
            # waiting requests are answered that no answer will come
            why = {**self._told["why"], **{task: [text] for task in self._waiting}}
            self._told = {**self._told, "why": why}

    def told(self) -> dict[str, Any]:
        """plan_number; state: planning, planned, failed or stopped; text; the plan, once there is
        one; why: reasons by task.
        """
        with self._lock:
            return dict(self._told)

    def why(self, task: int) -> bool:
        """Request why a task is assigned to its vehicle; False if there is no plan."""
        with self._lock:
            if self._told["state"] != "planned" or self._over:
                return False
            self._waiting.add(str(task))
        self._process.say({"why": task})
        return True

    def end(self) -> None:
        """End the process, whatever its state; a finished plan is kept."""
        with self._lock:
            if self._told["state"] == "planning":
                self._told = {**self._told, "state": "stopped", "text": "Planning was stopped."}
        self._process.end(ENDING_S)
