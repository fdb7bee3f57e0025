"""A UxAS configuration (cfg XML) and the messages that it sends.

Message files lie under `PathToMessageFiles` (relative to a run folder beside the configuration)
or in a folder `inputs` beside it; both are searched, and a note says which was used.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.spec.errors import BadInput

PLAYED = frozenset(
    {
        "TaskManagerService",
        "AutomationRequestValidatorService",
        "RoutePlannerVisibilityService",
        "RouteAggregatorService",
        "AssignmentTreeBranchBoundService",
        "PlanBuilderService",
        "WaypointPlanManagerService",
        "SendMessagesService",
        "IcarousCommunicationService",
        "SensorManagerService",
        "MessageLoggerDataService",
    }
)
"""Services of UxAS whose part is played by ours."""


@dataclass(frozen=True)
class Sent:
    """A message file: its object, where it stands, and when it is sent [ms]."""

    body: Any
    where: str
    time_ms: int


@dataclass(frozen=True)
class Configuration:
    """What a cfg XML says: attributes of the root, services in order, messages by send time."""

    path: Path
    root: dict[str, str]
    services: tuple[tuple[str, dict[str, str], int], ...]
    messages: tuple[Sent, ...]
    notes: tuple[str, ...]

    def service(self, name: str) -> tuple[dict[str, str], str] | None:
        """Attributes and place (file:line) of the first service of a type, or None."""
        for kind, attributes, line in self.services:
            if kind == name:
                return attributes, f"{self.path}:{line}"
        return None


def find_cfg(path: Path) -> Path:
    """The configuration file of a folder: its only cfg*.xml."""
    if not path.is_dir():
        return path
    found = sorted(path.glob("cfg*.xml"))
    if len(found) != 1:
        raise BadInput(
            "no single UxAS configuration in this folder",
            where=str(path),
            expected="one file cfg*.xml (or name the file itself)",
            got=", ".join(entry.name for entry in found) or "none",
        )
    return found[0]


def read_cfg(path: Path) -> Configuration:
    """Read a configuration and all messages that it sends, in the order of sending."""
    from cratous.bridge.lmcp import xml

    path = find_cfg(path)
    try:
        text = path.read_bytes()
    except OSError as error:
        raise BadInput(f"the file cannot be read ({error.strerror})", where=str(path)) from None
    root = xml.parse(text, str(path))
    if root.tag != "UxAS":
        raise BadInput(
            "not a UxAS configuration", where=str(path), expected="<UxAS>", got=f"<{root.tag}>"
        )
    notes: list[str] = []
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
    """A note without the list of everything that would have been understood."""
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
        if not time.isdigit():
            raise BadInput(
                "not a time", where=place, item="SendTime_ms", expected="whole ms", got=time
            )
        for body in xml.read_file(found, notes, hash_comments=True):
            sent.append(Sent(body, str(found), int(time)))
    return sent


def _join(base: Path, name: str) -> Path:
    # the run folder of UxAS need not exist, so ".." is resolved in the text
    import os.path

    return Path(os.path.normpath(base / name))
