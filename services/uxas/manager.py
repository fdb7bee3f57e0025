"""The service manager: creates services and bridges from a configuration, and at run time.

Ids increase in file order from FirstServiceID (50, the manager's own), services first. All errors of a configuration
are found before anything is opened, and reported together. CreateNewService creates a service (a task's, or any of
the registry); KillService ends one and releases its resources; KillService with the manager's own id ends all
services, with -1 the process.
"""

from __future__ import annotations

import html
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import partial
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope
from cratous.services.following.cordon import CordonTaskService
from cratous.services.following.rendezvous import RendezvousTaskService
from cratous.services.following.service import FollowingTaskService
from cratous.services.loading.problems import refuse
from cratous.services.loading.uxas_settings import (
    Attr,
    Configuration,
    Entry,
    entry,
    nearest,
    values_of,
)
from cratous.services.pipeline import coordinator
from cratous.services.pipeline.relative_tasks import (
    CORDON,
    FOLLOWED,
    RENDEZVOUS,
    WATCH,
    WATCH_SERVICE,
)
from cratous.services.pipeline.status import status
from cratous.services.pipeline.tasks import TASKS, TaskService
from cratous.services.pipeline.world import World
from cratous.services.uxas import bridge_kinds, registry, user_services
from cratous.services.uxas.bridge_entry import Given
from cratous.services.uxas.bridges import CREATE, KILL, Bridge
from cratous.services.uxas.frame import Host
from cratous.spec.errors import BadInput, CratousError

FIRST_ID = 50
SLIP = 0.85
"""Similarity (difflib's ratio) from which an unknown name counts as a misspelling, not as another service."""
_COMMON = {"MessageGroup": Attr()}  # for every service: the group and address of its messages


class ServiceManager:
    """A service itself (id FirstServiceID), so that it receives CreateNewService and KillService."""

    name = "ServiceManager"
    subscribes: tuple[str, ...] = (CREATE, KILL)
    prefixes = ("eid",)  # UxAS sends KillService to the service's own address

    def __init__(self, host: Host, config: Configuration, context: Any) -> None:
        self._host, self._config, self._context = host, config, context
        self.first_id: int = config.root["FirstServiceID"] or FIRST_ID
        self._last_id = self.first_id
        self._names: dict[int, str] = {}
        self.bridges: dict[int, Bridge] = {}
        self.ended = False
        self.on_change: Callable[[], None] = lambda: None
        host.shared["new_id"] = self.new_id
        # what the mission loader needs from a configuration
        host.shared["services"] = tuple(
            (e.type, dict(e.attributes), int(e.where.rpartition(":")[2] or 0))
            for e in config.entries
            if e.kind == "Service"
        )

    def new_id(self) -> int:
        """The next unused id of this process."""
        self._last_id += 1
        while self._last_id in self._names:
            self._last_id += 1
        return self._last_id

    @property
    def services(self) -> dict[int, str]:
        """The names of services and bridges by id."""
        return dict(self._names)

    def build(self, without: frozenset[str] = frozenset()) -> None:
        """Create all services and bridges of the configuration; BadInput lists its errors.

        without: types that the user has excluded.
        """
        notes: list[str] = []
        entries = check(self._config, without, notes)
        for note in notes:
            self._host.log("WARN", note)
        for left_out in self._config.entries:
            if left_out.type in without:
                self._host.log("WARN", f"{left_out.where}: {left_out.type} is left out, as asked")
        self._host.bus.add(self, self._host.identity(self.first_id))
        self._names[self.first_id] = self.name
        ordered = [e for e in entries if e.kind == "Service"]
        ordered += [e for e in entries if e.kind == "Bridge"]
        try:
            for item in ordered:
                self._make(item, self.new_id())
        except BaseException:
            self.close()
            raise

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        if envelope.topic == KILL:
            self.kill(envelope.body.ServiceID)
            return None, ()
        if envelope.topic != CREATE:
            return None, ()
        try:
            return None, self._create(envelope)
        except CratousError as error:
            self._host.log("ERROR", f"CreateNewService from {envelope.source} is refused: {error}")
            facts = [("CreateNewService", str(envelope.body.ServiceID)), ("reason", str(error))]
            return None, [status(0, "Error", facts)]

    def kill(self, number: int) -> None:
        """End a service or bridge: -1 the process, the manager's id all services."""
        if number in (-1, self.first_id):
            self._host.log("INFO", "KillService: all services end")
            for other in [n for n in self._names if n != self.first_id]:
                self._end(other)
            self.ended = self.ended or number == -1
            return
        if number not in self._names:
            # with several processes on one bus it may be another's
            self._host.log("DEBUG", f"KillService: no service {number} in this process")
            return
        self._end(number)

    def close(self) -> None:
        """End all services, bridges first."""
        for number in [*self.bridges, *[n for n in self._names if n != self.first_id]]:
            if number in self._names:
                self._end(number)

    def _end(self, number: int) -> None:
        name = self._names.pop(number)
        self.bridges.pop(number, None)
        self._host.bus.remove(name)
        self._host.log("INFO", f"service {number} ({name}) has ended")
        self.on_change()

    def _make(self, item: Entry, number: int) -> None:
        if item.kind == "Bridge":
            self._make_bridge(item, number)
            return
        kind = user_services.kind_of(item.type)
        assert kind is not None, item.type
        problems: list[BadInput] = []
        known = {**kind.attributes, **_COMMON}
        values = values_of(known, item.attributes, item.where, item.type, problems)
        refuse(problems)
        for name in kind.ignored:
            if name in item.attributes and values[name] != kind.attributes[name].default:
                text = f"{item.where}: {item.type}.{name}={item.attributes[name]}"
                self._host.log("WARN", f"{text}: {kind.ignored[name]}")
        name = self._name(item.type, number)
        service = kind.make(self._host, item, values, name, number)
        self._add(service, number, values["MessageGroup"])
        if hasattr(service, "pump"):  # it has a port of its own
            self.bridges[number] = service
            self.on_change()

    def _make_bridge(self, item: Entry, number: int) -> None:
        kind = bridge_kinds.BRIDGES[item.type]
        problems: list[BadInput] = []
        values, children = bridge_kinds.check(item, kind, problems)
        refuse(problems)
        name = self._name(item.type, number)
        identity = self._host.identity(number)
        try:
            bridge = kind.make(
                Given(self._host, item, values, children, identity, name, self._context)
            )
        except BadInput as error:
            if error.where == item.where:
                raise
            raise BadInput(
                error.what,
                where=item.where,
                item=error.where or error.item,
                expected=error.expected,
                got=error.got,
            ) from None
        self._add(bridge, number)
        self.bridges[number] = bridge
        self.on_change()

    def _add(self, service: Any, number: int, group: str = "") -> None:
        if service.name in self._host.bus.names():
            raise BadInput("such a service runs already", item=service.name)
        self._names[number] = service.name
        self._host.bus.add(service, self._host.identity(number, group))
        self._host.log("INFO", f"service {number} is {service.name}")

    def _name(self, kind: str, number: int) -> str:
        return f"{kind}[{number}]" if kind in self._host.bus.names() else kind

    def _create(self, envelope: Envelope) -> list[Any]:
        """Create the service; returns what to report about it."""
        body = envelope.body
        number = body.ServiceID
        where = f"CreateNewService {number}"
        item, task = _parsed(body.XmlConfiguration, where)
        if number <= 0:
            number = self.new_id()
        if number in self._names:
            raise BadInput(
                "the id is taken", where=where, item="ServiceID", got=self._names[number]
            )
        if item.type in TASKS or item.type in FOLLOWED or item.type == coordinator.KIND:
            world = registry.source_of(self._host).world
            if task is None:
                raise BadInput(
                    "no task", where=where, item="<TaskRequest>", expected=f"a {item.type}"
                )
            known = world.task(task.TaskID)
            if known is None or known.body != task:
                world.add(task, where)
            for field in ("EntityConfigurations", "EntityStates", "KeepInZones", "KeepOutZones"):
                for part in getattr(body, field):
                    if not world.knows(part):
                        world.add(part, where)
            self._add(self._task_service(item.type, task, partial(_forget, world, task)), number)
            return []
        if task is not None and item.type == task.all_names[0]:
            # not an error: another process may have it, and a request reports if none does
            text = f"task {task.TaskID} is a {item.type}: no service here does this kind"
            self._host.log("WARN", text)
            return [status(0, "Warning", [("TaskID", str(task.TaskID)), ("reason", text)])]
        problems: list[BadInput] = []
        running = set(self._names.values())
        _check(item, [*(e for e in self._config.entries if e.type in running), item], problems)
        refuse(problems)
        self._make(item, number)
        return []

    def _task_service(self, kind: str, task: Any, ended: Callable[[], None]) -> Any:
        if kind == coordinator.KIND:
            entity, world = self._host.entity_id, registry.source_of(self._host).world
            return coordinator.AssignmentCoordinatorTaskService(task.TaskID, entity, world, ended)
        contexts = registry.contexts_of(self._host)
        if kind == WATCH or kind in FOLLOWED:
            name = FOLLOWED.get(kind, WATCH_SERVICE)
            own = {RENDEZVOUS: RendezvousTaskService, CORDON: CordonTaskService}
            return own.get(kind, FollowingTaskService)(contexts, task, name, ended)
        return TaskService(contexts, task.TaskID, TASKS[kind], ended)


def _forget(world: World, task: Any) -> None:
    """Remove a task, unless a newer task has its id by now."""
    known = world.task(task.TaskID)
    if known is not None and known.body == task:
        world.forget("task", task.TaskID)


def check(
    config: Configuration, without: frozenset[str] = frozenset(), notes: list[str] | None = None
) -> list[Entry]:
    """The entries to create; BadInput with all errors in types, attributes and elements.

    without: types that the user has excluded. notes: receives what was read leniently, and the services that are not
    available here; a strict configuration is refused for them.
    """
    entries = [e for e in config.entries if e.type not in without]
    problems: list[BadInput] = []
    user_services.load(config, problems)
    refuse(problems)
    said = list(config.notes)
    if not config.strict:
        absent = [e for e in entries if e.kind == "Service" and _nobody_has(e.type)]
        said += [f"{e.where}: no service {e.type} here; what it does is not done" for e in absent]
        entries = [e for e in entries if e not in absent]
    if notes is not None:
        notes.extend(said)
    for item in entries:
        _check(item, entries, problems)
    refuse(problems)
    return entries


def _check(item: Entry, entries: list[Entry], problems: list[BadInput]) -> None:
    if item.kind == "Bridge":
        kind = bridge_kinds.BRIDGES.get(item.type)
        if kind is None:
            problems.append(_unknown(item, bridge_kinds.BRIDGES))
            return
        bridge_kinds.check(item, kind, problems)
        return
    service = user_services.kind_of(item.type)
    if service is None:
        problems.append(_unknown(item, registry.KINDS))
        return
    known = {**service.attributes, **_COMMON}
    values_of(known, item.attributes, item.where, item.type, problems)
    for element in item.children:
        if element.tag not in service.children:
            expected = nearest(str(element.tag), service.children)
            problems.append(
                BadInput(
                    "unknown element",
                    where=item.place(element),
                    item=f"{item.type}.<{element.tag}>",
                    expected=expected,
                )
            )
    same = [e for e in entries if e.type == item.type]
    if service.single and same[0] is not item:
        problems.append(
            BadInput(
                "a second one in one process",
                where=item.where,
                item=item.type,
                expected=f"one; the first stands at {same[0].where}",
            )
        )


def _parsed(text: str, where: str) -> tuple[Entry, Any]:
    """The Service element of a CreateNewService, and the task inside, if any.

    UxAS escapes the angle brackets and leaves the closing tag to the receiver.
    """
    text = text.strip()
    if text.startswith("&lt;"):
        text = html.unescape(text)
    if not text.endswith("</Service>") and not _whole(text):
        text += "</Service>"
    element = lmcp.xml.parse(text, where)
    if element.tag != "Service":
        raise BadInput("not a service", where=where, expected="<Service>", got=f"<{element.tag}>")
    item = entry(element, where)
    requests = [child for child in element if child.tag == "TaskRequest"]
    task = None
    if requests and len(requests[0]):
        from lxml import etree

        notes: list[str] = []
        task = lmcp.xml.loads(etree.tostring(requests[0][0]), where, notes)[0]
    return item, task


def _whole(text: str) -> bool:
    try:
        lmcp.xml.parse(text)
    except BadInput:
        return False
    return True


def _nobody_has(kind: str) -> bool:
    """True for a name that resembles no known one."""
    known = [*registry.KINDS, *TASKS, *FOLLOWED, *bridge_kinds.BRIDGES]
    slip = get_close_matches(kind, known, 1, SLIP) or ":" in kind
    return user_services.kind_of(kind) is None and not slip


def _unknown(item: Entry, known: Any) -> BadInput:
    return BadInput(
        f"unknown {item.kind.lower()} type",
        where=item.where,
        item=f"{item.kind}.Type",
        expected=nearest(item.type, known),
        got=item.type,
    )


def startup(bus: Bus) -> None:
    """Publish that all services of the configuration are running."""
    bus.publish(lmcp.new("StartupComplete"), ServiceManager.name)
