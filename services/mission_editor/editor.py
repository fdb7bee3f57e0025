"""A mission file open in the browser: the requests of the page, and their answers."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import write_atomically
from cratous.services.exporting.exported import ALL, ROUTED, beside_document, exported
from cratous.services.exporting.icarous import QGC
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.logs.records import from_data
from cratous.services.mission_editor.completed import LISTS, VEHICLES, completed
from cratous.services.mission_editor.plan_process import PlanProcess
from cratous.services.mission_editor.relations import relations
from cratous.services.mission_editor.sketch import sketch
from cratous.services.mission_editor.text_edits import PLACE, MissionText
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import MISSION_BYTES
from cratous.spec.files.text_file import text_of
from cratous.spec.mission.plan import Plan

LONGEST = 2 * MISSION_BYTES
"""Maximum size of a request with the text as JSON [bytes]."""
FARTHEST_M = 1e7
"""Maximum distance of an object from the frame's origin [m]."""
Order = Callable[[str, str, Any], dict[str, Any]]


class Editor:
    """Holds the file as last read or written, and the planning process.

    token: whoever has it may edit. Raises BadInput if the file cannot be read.
    """

    def __init__(self, path: Path, module: str, allow_unproved: bool) -> None:
        """module: argument of `python -m` for the planner; allow_unproved: permit unproved kernels."""
        self._path, self._module, self._allow_unproved = path, module, allow_unproved
        self.token = secrets.token_urlsafe(24)
        self._plan: PlanProcess | None = None
        self._plans = 0
        self._lock = threading.Lock()
        self._read()
        named: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
            "/sketch": self._sketch, "/relations": self._relations, "/change": self._change,
            "/plan": self._start, "/stop": self._stop, "/why": self._why, "/save": self._save,
            "/export": self._export,
        }  # fmt: skip
        self.orders = {name: self._guarded(order) for name, order in named.items()}

    def _guarded(self, order: Callable[[dict[str, Any]], dict[str, Any]]) -> Order:
        def obey(token: str, page: str, asked: Any) -> dict[str, Any]:
            if not hmac.compare_digest(token.encode(), self.token.encode()):
                raise NotObeyed(403, "editing needs the token of the address that was printed")
            if not isinstance(asked, dict):
                raise NotObeyed(400, "expected a JSON object")
            return order(asked)

        return obey

    def _read(self) -> str:
        return text_of(self._path, MISSION_BYTES, "a mission file")

    def opened(self) -> dict[str, Any]:
        """The current file, for a page that opens."""
        text = self._read()
        return {
            "file": str(self._path),
            "text": text,
            "digest": _digest(text),
            **sketch(text, str(self._path)),
        }

    def planned(self) -> dict[str, Any]:
        """Status and result of planning; plan_number: identifies the plan."""
        with self._lock:
            return {"state": "none"} if self._plan is None else self._plan.told()

    def _sketch(self, asked: dict[str, Any]) -> dict[str, Any]:
        return sketch(_text(asked), str(self._path))

    def _relations(self, asked: dict[str, Any]) -> dict[str, Any]:
        tasks = asked.get("tasks")
        if not isinstance(tasks, list) or not all(type(task) is int for task in tasks):
            raise NotObeyed(400, "expected tasks: a list of ids")
        return relations(_text(asked), tasks)

    def _change(self, asked: dict[str, Any]) -> dict[str, Any]:
        """The text with one change: move, number, add, remove or put."""
        mission, do = MissionText(_text(asked), str(self._path)), asked.get("do")
        if do == "add":
            name, item = asked.get("list"), asked.get("item")
            if name not in LISTS or not isinstance(item, dict):
                raise NotObeyed(400, f"expected list: one of {', '.join(LISTS)}, and item")
            if name == VEHICLES:
                place = item.get("position")
                if set(item) != {"position"} or not isinstance(place, dict):
                    raise NotObeyed(400, "expected item: the position of a vehicle")
                item = {"position": {axis: _number(place, axis) for axis in PLACE}}
            return {"text": mission.added(name, completed(mission, name, item))}
        key = asked.get("key")
        if not isinstance(key, list) or not all(type(part) in (str, int) for part in key):
            raise NotObeyed(400, "expected key: a list of names and numbers")
        if do == "remove":
            return {"text": mission.removed(tuple(key))}
        if do == "put":
            return {"text": mission.put(tuple(key), _text(asked, "value"))}
        if do == "move":
            north_m, east_m = (_number(asked, name) for name in ("north_m", "east_m"))
            return {"text": mission.moved(tuple(key), north_m, east_m)}
        if do == "number":
            return {"text": mission.with_number(tuple(key), _number(asked, "value"))}
        raise NotObeyed(400, "expected do: add, move, number, put or remove")

    def _start(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Plan a text; a plan in progress, of any page, is cancelled. plan_number: of this plan."""
        told = {
            "text": _text(asked), "where": str(self._path), "allow_unproved": self._allow_unproved,
        }  # fmt: skip
        with self._lock:
            self._plans += 1
            number, before = self._plans, self._plan
            self._plan = PlanProcess(self._module, number, told)
        if before is not None:
            before.end()
        return {"plan_number": number}

    def _of(self, asked: dict[str, Any]) -> PlanProcess:
        """The plan with the requested number, if it is the newest one."""
        number = asked.get("plan_number")
        if type(number) is not int:
            raise NotObeyed(400, "expected plan_number: that of a plan")
        with self._lock:
            if self._plan is None or number != self._plans:
                raise NotObeyed(409, "there is no such plan any more: plan again")
            return self._plan

    def _stop(self, asked: dict[str, Any]) -> dict[str, Any]:
        plan = self._of(asked)
        if plan.told()["state"] != "planning":
            raise NotObeyed(409, "nothing is being planned")
        plan.end()
        return {"done": True}

    def _why(self, asked: dict[str, Any]) -> dict[str, Any]:
        task = asked.get("task")
        if type(task) is not int:
            raise NotObeyed(400, "expected task: its id")
        if not self._of(asked).why(task):
            raise NotObeyed(409, "there is no plan")
        return {"done": True}

    def _save(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Write the file, unless it has changed since the page read it; digest: of the version read."""
        text = _text(asked)
        with self._lock:
            if _digest(self._read()) != asked.get("digest"):
                raise NotObeyed(409, f"{self._path} has been changed since by something else")
            write_atomically(self._path, text, "the mission")
        return {"digest": _digest(text)}

    def _export(self, asked: dict[str, Any]) -> dict[str, Any]:
        """A text in another format: files by name, and what they do not represent; plan_number:
        plan whose routes it gets, if any; vehicle: of a flight plan.
        """
        form, vehicle, text = asked.get("format"), asked.get("vehicle"), _text(asked)
        if form not in ALL:
            raise NotObeyed(400, f"expected format: one of {', '.join(ALL)}")
        if vehicle is not None and (form != QGC or type(vehicle) is not int):
            raise NotObeyed(400, f"expected vehicle: its id, with format {QGC} alone")
        document = parse_document(text, str(self._path))
        made = exported(loaded(document), form, self._routes(asked, form, text), vehicle=vehicle)
        return {"files": made.files, "unsaid": [*made.unsaid, *beside_document(document)]}

    def _routes(self, asked: dict[str, Any], form: str, text: str) -> Plan | None:
        """The requested plan, which must be of this text."""
        if "plan_number" not in asked:
            return None
        if form not in ROUTED:
            raise NotObeyed(400, f"a plan goes with format {' or '.join(ROUTED)}")
        process = self._of(asked)
        told = process.told()
        if told["state"] != "planned" or process.text != text:
            raise NotObeyed(409, "there is no such plan of this text: plan again")
        return from_data(Plan, told["plan"], "plan")

    def close(self) -> None:
        """Stop the planning process."""
        with self._lock:
            if self._plan is not None:
                self._plan.end()


def _text(asked: dict[str, Any], name: str = "text") -> str:
    text = asked.get(name)
    if not isinstance(text, str):
        raise NotObeyed(400, f"expected {name}: a text")
    try:
        length = len(text.encode("utf-8"))
    except UnicodeEncodeError as error:
        raise BadInput(
            "half a character", item=name, expected="text", got=f"at character {error.start}"
        ) from None
    if length > MISSION_BYTES:
        raise BadInput("a text that is too long", item=name, expected=f"{MISSION_BYTES} bytes")
    return text


def _number(asked: dict[str, Any], name: str) -> float:
    value: Any = asked.get(name)
    if type(value) not in (int, float) or not abs(value) < FARTHEST_M:
        raise NotObeyed(400, f"expected {name}: a number of metres or degrees")
    return float(value)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
