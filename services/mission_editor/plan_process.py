"""A process that plans a text of a mission, as the page has it: how far it is, the plan, and why it is so."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from contextlib import suppress
from typing import Any

ENDING_S = 5.0


class PlanProcess:
    """Starts at once; `told` says what has come of it."""

    def __init__(self, module: str, asked: dict[str, Any]) -> None:
        """module: what plans, as `python -m` takes it; asked: what it is told first."""
        self._told: dict[str, Any] = {"state": "planning", "text": "starting", "why": {}}
        self._lock = threading.Lock()
        self._process = subprocess.Popen(
            [sys.executable, "-m", module],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8",
        )  # fmt: skip
        self._say(asked)
        threading.Thread(target=self._listen, daemon=True).start()

    @property
    def pid(self) -> int:
        """Of the process that plans."""
        return self._process.pid

    def _listen(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                told = json.loads(line)
            except ValueError:
                break  # it was cut off in the middle of a line
            with self._lock:
                if self._told["state"] != "stopped":
                    why = {**self._told["why"], **told.pop("why", {})}
                    self._told = {**self._told, **told, "why": why}
        code = self._process.wait()
        with self._lock:
            if self._told["state"] == "planning":
                how = f"signal {-code}" if code < 0 else f"exit code {code}"
                text = f"The process that plans ended without a word ({how})."
                self._told = {**self._told, "state": "failed", "text": text}

    def told(self) -> dict[str, Any]:
        """state: planning, planned, failed or stopped; text; the plan, once there is one; why, by task."""
        with self._lock:
            return dict(self._told)

    def why(self, task: int) -> bool:
        """Ask why a task is given to its vehicle; False where there is no plan to ask about."""
        if self.told()["state"] != "planned" or self._process.poll() is not None:
            return False
        self._say({"why": task})
        return True

    def _say(self, asked: dict[str, Any]) -> None:
        assert self._process.stdin is not None
        with suppress(OSError, ValueError):  # gone: `_listen` says so
            self._process.stdin.write(json.dumps(asked) + "\n")
            self._process.stdin.flush()

    def end(self) -> None:
        """End it, whatever it does; a plan that was told is kept."""
        with self._lock:
            if self._told["state"] == "planning":
                self._told = {**self._told, "state": "stopped", "text": "Planning was stopped."}
        self._process.terminate()
        try:
            self._process.wait(ENDING_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
