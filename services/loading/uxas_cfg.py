"""A UxAS configuration (cfg XML) and the messages that it sends.

Message files are in `PathToMessageFiles` (relative to a run folder beside the configuration) or in
a folder `inputs` beside it; both are searched, and a note says which was used.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from cratous.services.loading.request_kinds import is_request
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of
from cratous.spec.files.text_file import bytes_of
from cratous.spec.schedule import TIME_LIMIT_MS

PIPELINE = (
    "TaskManagerService",
    "AutomationRequestValidatorService",
    "RoutePlannerVisibilityService",
    "RouteAggregatorService",
    "AssignmentTreeBranchBoundService",
    "PlanBuilderService",
)
"""Services that plan a request."""
PLAYED = frozenset(
    {
        *PIPELINE,
        "WaypointPlanManagerService",
        "SendMessagesService",
        "IcarousCommunicationService",
        "SensorManagerService",
        "MessageLoggerDataService",
    }
)
"""Services of UxAS whose role is taken by CRATOUS services."""


def locations(body: Any) -> Iterator[tuple[float, float]]:
    """Latitude and longitude [degrees] of every position inside an object."""
    if isinstance(body, (list, tuple)):
        for part in body:
            yield from locations(part)
    elif hasattr(body, "Latitude") and hasattr(body, "Longitude"):
        yield float(body.Latitude), float(body.Longitude)
    elif hasattr(body, "names"):
        for name in body.names:
            yield from locations(getattr(body, name))


@dataclass(frozen=True)
class Sent:
    """A message file: its object, its position in the configuration, and when it is sent [ms]."""

    body: Any
    where: str
    time_ms: int

    @cached_property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Latitude and longitude [degrees] of every position inside the object, but not of what its cameras
        see, which reaches to the horizon.
        """
        names = (name for name in self.body.names if name != "PayloadStateList")
        return tuple(locations([getattr(self.body, name) for name in names]))


@dataclass(frozen=True)
class Configuration:
    """Content of a cfg XML: root attributes, services in order, messages by send time."""

    path: Path
    root: dict[str, str]
    services: tuple[tuple[str, dict[str, str], int], ...]
    messages: tuple[Sent, ...]
    notes: tuple[str, ...]

    def service(self, name: str) -> tuple[dict[str, str], str] | None:
        """Attributes and position (file:line) of the first service of a type, or None."""
        for kind, attributes, line in self.services:
            if kind == name:
                return attributes, f"{self.path}:{line}"
        return None


def find_cfgs(path: Path) -> tuple[Path, ...]:
    """The configurations of a folder: its files cfg*.xml, otherwise its XML files with root <UxAS>."""
    if not path.is_dir():
        return (path,)
    found = sorted(path.glob("cfg*.xml"))
    if not found:
        found = [entry for entry in sorted(path.glob("*.xml")) if _is_uxas(entry)]
    if not found:
        raise BadInput(
            "no single UxAS configuration in this folder",
            where=str(path),
            expected="a file cfg*.xml (or name the file itself)",
            got="none",
        )
    return tuple(found)


def read_all(path: Path) -> Configuration:
    """The configuration of a file or folder; several in a folder are processes of one system.

    They are merged if they agree on services and requests; otherwise BadInput asks which one is
    meant.
    """
    paths = find_cfgs(path)
    found = [read_cfg(one) for one in paths]
    first = found[0]
    if len(found) == 1:
        return first
    # the same request from two processes counts once
    requests = {
        sent.where for one in found for sent in one.messages if is_request(type(sent.body).__name__)
    }
    planning = {
        (kind, tuple(sorted(attributes.items())))
        for one in found
        for kind, attributes, _ in one.services
        if kind in ("AssignmentTreeBranchBoundService", "IcarousCommunicationService")
    }
    if len(requests) > 1 or len({kind for kind, _ in planning}) < len(planning):
        raise BadInput(
            "no single UxAS configuration in this folder",
            where=str(path),
            expected="processes of one system, with one request (or name the file itself)",
            got=", ".join(one.name for one in paths),
        )
    messages: dict[tuple[str, int, str], Sent] = {}
    for one in found:
        for k, sent in enumerate(one.messages):
            messages.setdefault((sent.where, sent.time_ms, _nth(one.messages, k)), sent)
    names = ", ".join(one.name for one in paths)
    notes = [f"{names} are read as processes of one system", *(n for c in found for n in c.notes)]
    return Configuration(
        first.path,
        first.root,
        tuple(service for one in found for service in one.services),
        tuple(sorted(messages.values(), key=lambda sent: sent.time_ms)),
        tuple(dict.fromkeys(notes)),
    )


def _nth(messages: tuple[Sent, ...], k: int) -> str:
    """Index of a message's object in its file, so that each object of a file counts once."""
    return str([m.where for m in messages[: k + 1]].count(messages[k].where))


def _is_uxas(path: Path) -> bool:
    from cratous.bridge.lmcp import xml

    try:
        return bool(xml.parse(xml.mended(bytes_of(path), str(path), []), str(path)).tag == "UxAS")
    except BadInput:
        return False


def read_cfg(path: Path) -> Configuration:
    """Read a configuration and all messages that it sends, in sending order."""
    from cratous.bridge.lmcp import xml

    notes: list[str] = []
    root = xml.parse(xml.mended(bytes_of(path), str(path), notes), str(path))
    if root.tag != "UxAS":
        raise BadInput(
            "not a UxAS configuration", where=str(path), expected="<UxAS>", got=f"<{root.tag}>"
        )
    services, messages = [], []
    for element in root:
        if element.tag != "Service":
            notes.append(f"{path.name}: <{element.tag}> is not used")
            continue
        attributes = {str(name): str(value) for name, value in element.attrib.items()}
        kind = attributes.get("Type", "")
        services.append((kind, attributes, int(element.sourceline or 1)))
        if kind == "SendMessagesService":
            messages.extend(_messages(path, element, notes))
    unused = sorted({kind for kind, _, _ in services if kind not in PLAYED})
    if unused:
        notes.append(f"{path.name}: services not used: {', '.join(unused)}")
    messages.sort(key=lambda sent: sent.time_ms)
    return Configuration(
        path,
        {str(k): str(v) for k, v in root.attrib.items()},
        tuple(services),
        tuple(messages),
        tuple(dict.fromkeys(_short(note) for note in notes)),
    )


def _short(note: str) -> str:
    """A note without its list of alternatives."""
    return re.sub(r"; expected .*?; got .*?;", ";", note)


def _messages(cfg: Path, service: Any, notes: list[str]) -> list[Sent]:
    from cratous.bridge.lmcp import xml

    declared = service.get("PathToMessageFiles", "./")
    bases = (cfg.parent / "rundir" / declared, cfg.parent / declared, cfg.parent / "inputs")
    sent: list[Sent] = []
    for element in service:
        name = element.get("MessageFileName", "")
        place = f"{cfg}:{element.sourceline}"
        if element.tag != "Message" or not name:
            raise BadInput(
                "not a message entry",
                where=place,
                item=element.tag,
                expected="<Message MessageFileName=... SendTime_ms=.../>",
            )
        found = next((path for path in (_join(b, name) for b in bases) if path.is_file()), None)
        if found is None:
            raise BadInput(
                "a message file is missing",
                where=place,
                item="MessageFileName",
                expected=" or ".join(str(_join(base, name)) for base in bases[1:]),
                got=name,
            )
        if found == _join(bases[2], name):
            notes.append(f"{cfg.name}: message files are read from inputs/, not from {declared}")
        time = element.get("SendTime_ms", "0")
        time_ms = integer_of(time, 0, TIME_LIMIT_MS - 1)
        if time_ms is None:
            raise BadInput(
                "not a time", where=place, item="SendTime_ms", expected="whole ms", got=time
            )
        for body in xml.read_messages(found, notes):
            sent.append(Sent(body, str(found), time_ms))
    return sent


def scenario_states(cfg: Configuration) -> tuple[list[Sent], list[str]]:
    """The AirVehicleStates of the AMASE scenarios beside a configuration, and notes.

    Some examples of OpenUxAS leave it to the simulator to give the vehicles' positions.
    """
    from cratous.bridge.lmcp import xml

    found: list[Sent] = []
    notes: list[str] = []
    for path in sorted(cfg.path.parent.glob("*.xml")):
        try:
            root = xml.parse(bytes_of(path), str(path))
        except BadInput:
            continue
        if root.tag != "AMASE":
            continue
        for element in root.iter("AirVehicleState"):
            body = xml.read_element(element, str(path), notes)
            found.append(Sent(body, f"{path}:{element.sourceline}", 0))
    return found, [_short(note) for note in notes]


def _join(base: Path, name: str) -> Path:
    # UxAS's run folder may not exist, so ".." is resolved textually
    import os.path

    return Path(os.path.normpath(base / name))
