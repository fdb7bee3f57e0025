"""Small services: messages from files, simulated time, status reports, and HelloWorld."""

from __future__ import annotations

import os.path
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope, Send, Wake
from cratous.services.loading.uxas_settings import Attr, Entry, values_of, whole
from cratous.services.uxas.frame import STATE, Host
from cratous.spec.errors import BadInput

STARTUP = "uxas.messages.uxnative.StartupComplete"
Step = tuple[Any, Iterable[Any]]

MESSAGE_ATTRIBUTES = {
    "MessageFileName": Attr(needed=True),
    "MessageKey": Attr(),
    "SendTime_ms": whole(None),
    "SendPeriod_ms": whole(None, 1),
    "NumberTimesToSend": whole(None, 1),
}


class Planned(NamedTuple):
    """A message to send: body, address ("" for its type), first time, period, and count (0: unlimited)."""

    body: Any
    address: str
    time_ms: int
    period_ms: int
    times: int


class SendMessagesService:
    """Sends messages from files at times relative to StartupComplete, once or periodically."""

    subscribes: tuple[str, ...] = (STARTUP,)

    def __init__(self, name: str, planned: tuple[Planned, ...]) -> None:
        self.name, self._planned = name, planned

    def start(self) -> bool:
        return False

    def handle(self, state: bool, envelope: Envelope, now_ms: int) -> Step:
        """Start the schedule; only the first StartupComplete counts."""
        if state:
            return state, ()
        return True, [Wake(plan.time_ms, (k, 1)) for k, plan in enumerate(self._planned)]

    def wake(self, state: bool, key: tuple[int, int], now_ms: int) -> Step:
        """Send a message of the schedule; key: its index and its repetition."""
        k, sent = key
        plan = self._planned[k]
        out: list[Any] = [Send(plan.body, plan.address)]
        if plan.period_ms and (not plan.times or sent < plan.times):
            out.append(Wake(plan.period_ms, (k, sent + 1)))
        return state, out


def send_messages(host: Host, entry: Entry, values: dict[str, Any], name: str) -> Any:
    """The service of a configuration's entry; reads all files now, so that errors are found at
    start-up.

    A relative path is relative to the working directory, as in UxAS; if the files are not there,
    the configuration's folder, its `rundir` and its `inputs` are searched (and this is logged).
    """
    problems: list[BadInput] = []
    planned: list[Planned] = []
    folder = values["PathToMessageFiles"] or "."
    for element in entry.children:
        where = entry.place(element)
        found = values_of(MESSAGE_ATTRIBUTES, element.attrib, where, "Message", problems)
        if not found["MessageFileName"]:
            continue
        try:
            bodies = _bodies(host, folder, found["MessageFileName"], where)
        except BadInput as error:
            problems.append(error)
            continue
        timed = found["SendTime_ms"] is not None  # a period is used only without a time
        planned += [
            Planned(
                body,
                found["MessageKey"],
                found["SendTime_ms"] or 0,
                0 if timed else found["SendPeriod_ms"] or 0,
                found["NumberTimesToSend"] or 0,
            )
            for body in bodies
        ]
    from cratous.services.loading.problems import refuse

    refuse(problems)
    return SendMessagesService(name, tuple(planned))


def data_of(host: Host, entry: Entry) -> Path:
    """The folder in which the services of a process write; BadInput if it has none."""
    folder: Path | None = host.shared.get("data")
    if folder is None:
        raise BadInput("no folder to write to", where=entry.where, item=entry.type)
    return folder


def looked_for(host: Host, name: str, where: str, folder: str = ".") -> tuple[Path | None, str]:
    """Path of a file that a configuration names, None if not found; and the searched places in
    words.

    folder: of the name; relative to the working directory, otherwise to the folders of
    `send_messages`.
    """
    beside = host.config.parent
    bases = (Path(folder), beside / folder, beside / "rundir" / folder, beside / "inputs")
    paths = [Path(os.path.normpath(base / name)) for base in bases]
    # an invalid file name counts as not found
    path = next((p for p in paths if os.path.isfile(p)), None)
    if path not in (None, paths[0]):
        host.log("INFO", f"{where}: {name} is read from {path}")
    return path, " or ".join(dict.fromkeys(map(str, paths)))


def _bodies(host: Host, folder: str, name: str, where: str) -> list[Any]:
    path, expected = looked_for(host, name, where, folder)
    if path is None:
        raise BadInput(
            "a message file is missing",
            where=where,
            item="MessageFileName",
            expected=expected,
            got=name,
        )
    notes: list[str] = []
    bodies = lmcp.xml.read_messages(path, notes)
    if notes and host.root.get("strict"):
        raise BadInput(notes[0], expected="a message file without this, or no --strict")
    for note in notes:
        host.log("WARN", note)
    return bodies


class SimulationTime:
    """Test_SimulationTime: the bus clock advances only with the times in entity states."""

    subscribes: tuple[str, ...] = (STATE,)

    def __init__(self, name: str, host: Host) -> None:
        self.name, self._host = name, host

    def start(self) -> int:
        self._host.clock.discrete = True
        return 0

    def handle(self, state: int, envelope: Envelope, now_ms: int) -> Step:
        self._host.tell(envelope.body, self.name)
        return envelope.body.Time, ()

    def stop(self, state: int) -> None:
        """Return to the machine's clock."""
        self._host.clock.discrete = False


class HelloWorld:
    """Sends a text periodically, and prints the texts received."""

    subscribes: tuple[str, ...] = ("afrl.cmasi.KeyValuePair",)

    def __init__(self, name: str, service_id: int, text: str, period_ms: int, host: Host) -> None:
        self.name, self._id, self._text = name, service_id, text
        self._period_ms, self._host = period_ms, host

    def start(self) -> int:
        return 0

    def begin(self, state: int) -> Step:
        """The first greeting is sent immediately."""
        return state, [Wake(0)]

    def handle(self, state: int, envelope: Envelope, now_ms: int) -> Step:
        pair = envelope.body
        self._host.say(
            f"*** RECEIVED:: Received Id[{self._id}] Sent Id[{pair.Key}] Message[{pair.Value}] *** "
        )
        return state + 1, ()

    def wake(self, state: int, key: Any, now_ms: int) -> Step:
        greeting = lmcp.new("KeyValuePair", Key=str(self._id), Value=self._text)
        return state, [greeting, Wake(self._period_ms)]


class Report(NamedTuple):
    """The current report, and the numbers of states and keep-alive messages received."""

    report: Any
    states: int = 0
    alive: int = 0


class StatusReportService:
    """Reports a vehicle's status periodically: connected entities, tasks, age of its state,
    authority.

    A state older than `stale_ms`, or an autopilot keep-alive older than `expires_ms`, is reported
    as invalid.
    """

    subscribes: tuple[str, ...] = (
        "afrl.cmasi.EntityState",
        "uxas.messages.uxnative.EntityJoin",
        "uxas.messages.uxnative.EntityExit",
        "uxas.messages.uxnative.AutopilotKeepAlive",
    )

    def __init__(
        self, name: str, vehicle_id: int, period_ms: int, stale_ms: int, expires_ms: int
    ) -> None:
        self.name, self._vehicle = name, vehicle_id
        self._period_ms, self._stale_ms, self._expires_ms = period_ms, stale_ms, expires_ms

    def start(self) -> Report:
        return Report(lmcp.new("OnboardStatusReport", VehicleID=self._vehicle))

    def begin(self, state: Report) -> Step:
        """The first report is sent after one period."""
        return state, [Wake(self._period_ms, ("report", 0))]

    def handle(self, state: Report, envelope: Envelope, now_ms: int) -> Step:
        body, kind = envelope.body, envelope.topic.rpartition(".")[2]
        if kind in ("EntityJoin", "EntityExit"):
            here = set(state.report.ConnectedEntities)
            here = here | {body.EntityID} if kind == "EntityJoin" else here - {body.EntityID}
            report = state.report.copy(ConnectedEntities=sorted(here))
            return state._replace(report=report), ()
        if kind == "AutopilotKeepAlive":
            report = state.report.copy(
                ValidAuthorization=body.AutopilotEnabled,
                SpeedAuthorization=body.SpeedAuthorized,
                GimbalAuthorization=body.GimbalEnabled,
            )
            made = state._replace(report=report, alive=state.alive + 1)
            return made, [Wake(self._expires_ms, ("alive", made.alive))]
        if self._vehicle != body.ID:
            return state, ()
        report = state.report.copy(
            VehicleTime=body.Time, CurrentTaskList=list(body.AssociatedTasks), ValidState=True
        )
        made = state._replace(report=report, states=state.states + 1)
        return made, [Wake(self._stale_ms, ("state", made.states))]

    def wake(self, state: Report, key: tuple[str, int], now_ms: int) -> Step:
        what, count = key
        if what == "report":
            return state, [state.report.copy(), Wake(self._period_ms, key)]
        if what == "state" and count == state.states:
            return state._replace(report=state.report.copy(ValidState=False)), ()
        if what == "alive" and count == state.alive:
            off = state.report.copy(
                ValidAuthorization=False, SpeedAuthorization=False, GimbalAuthorization=False
            )
            return state._replace(report=off), ()
        return state, ()
