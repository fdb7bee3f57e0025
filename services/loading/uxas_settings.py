"""A UxAS configuration as typed data: every attribute checked, every error with file and line.

    <UxAS FormatVersion="1.0" EntityID="100" EntityType="Aircraft" RunDuration_s="60">
        <Service Type="..." .../>
        <Bridge Type="..." ...><SubscribeToMessage MessageType="afrl.cmasi"/></Bridge>
    </UxAS>

An unknown name is an error, not a remark: it is refused, with the nearest known name.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.loading.problems import refuse
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DIGITS
from cratous.spec.files.text_file import bytes_of

DEFAULT_FILE = "cfg.xml"


SEVERITIES = ("DEBUG", "INFO", "WARN", "ERROR")


class Attr(NamedTuple):
    """An attribute: its kind, default, range or choices. Kinds: text, int, number, flag, choice."""

    kind: str = "text"
    default: Any = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    needed: bool = False


def flag(default: bool) -> Attr:
    """An attribute that is TRUE or FALSE."""
    return Attr("flag", default)


def whole(default: int | None, low: int = 0, high: int | None = None) -> Attr:
    """An attribute that is an integer within bounds."""
    return Attr("int", default, low, high)


def number(default: float | None, low: float | None = 0.0, high: float | None = None) -> Attr:
    """An attribute that is a number within bounds."""
    return Attr("number", default, low, high)


def choice(default: str, *choices: str) -> Attr:
    """An attribute that takes one of several words, ignoring case."""
    return Attr("choice", default, choices=choices)


ROOT: Mapping[str, Attr] = {
    "FormatVersion": Attr(default="1.0"),
    "EntityID": whole(0, 0, 2**32 - 1),
    "EntityType": Attr(default="Aircraft"),
    "ConsoleLoggerSeverityLevel": choice("WARN", *SEVERITIES),
    "MainFileLoggerSeverityLevel": choice("DEBUG", *SEVERITIES),
    "StartDelay_ms": whole(0),
    "RunDuration_s": number(None),
    "isLoggingThreadId": flag(False),
    "isDataTimestamp": flag(False),
    # extensions: how missions are interpreted, and the bus over several processes
    "Compatibility": choice("", "uxas", "cratous"),
    "FirstServiceID": whole(None, 1, 2**31),
    "HubPUB": Attr(),
    "HubPULL": Attr(),
    "HubSUB": Attr(),
    "HubPUSH": Attr(),
    "CurveSecretKeyFile": Attr(),
    "CurveServerKeyFile": Attr(),
    "CurveClientKeys": Attr(),
}


@dataclass(frozen=True)
class Entry:
    """A Service or Bridge element: type, attributes, children, and its position in the file."""

    kind: str
    type: str
    attributes: Mapping[str, str]
    children: tuple[Any, ...]
    where: str

    def place(self, element: Any) -> str:
        """file:line of a child."""
        file = self.where.rpartition(":")[0]
        return f"{file}:{element.sourceline}" if file else self.where

    def refusal(self, what: str, attribute: str, expected: str, got: str) -> BadInput:
        """The error that says what is wrong with an attribute."""
        item = f"{self.type}.{attribute}"
        return BadInput(what, where=self.where, item=item, expected=expected, got=got)


@dataclass(frozen=True)
class Configuration:
    """Content of a file: the root's attributes as values, then services and bridges in order.

    notes: what was read leniently; strict: nothing may be.
    """

    path: Path
    root: Mapping[str, Any]
    entries: tuple[Entry, ...]
    where: str = ""
    notes: tuple[str, ...] = ()
    strict: bool = False


def read(path: Path, *, strict: bool = False) -> Configuration:
    """Read a configuration; BadInput (with all errors found) if it is invalid.

    strict: refuse what is otherwise read leniently and noted.
    """
    from cratous.bridge.lmcp import xml

    text = bytes_of(path, expected="a UxAS configuration (-cfgPath FILE; cfg.xml by default)")
    notes: list[str] = []
    root = xml.parse(xml.mended(text, str(path), notes), str(path))
    if strict and notes:
        raise BadInput(notes[0], expected="XML as it is defined, or no --strict")
    if root.tag != "UxAS":
        raise BadInput(
            "not a UxAS configuration", where=str(path), expected="<UxAS>", got=f"<{root.tag}>"
        )
    where = f"{path}:{root.sourceline}"
    problems: list[BadInput] = []
    values = values_of(ROOT, root.attrib, where, "UxAS", problems)
    entries: list[Entry] = []
    for element in root:
        if element.tag in ("Service", "Bridge"):
            try:
                entries.append(entry(element, f"{path}:{element.sourceline}"))
            except BadInput as error:
                problems.append(error)
        else:
            problems.append(
                BadInput(
                    "unknown element",
                    where=f"{path}:{element.sourceline}",
                    item=f"<{element.tag}>",
                    expected="<Service> or <Bridge>",
                )
            )
    refuse(problems)
    return Configuration(path, values, tuple(entries), where, tuple(notes), strict)


def entry(element: Any, where: str) -> Entry:
    """A Service or Bridge element; BadInput if it has no Type."""
    attributes = {str(k): str(v) for k, v in element.attrib.items() if k != "Type"}
    kind = element.get("Type", "")
    if not kind:
        raise BadInput(
            "no Type", where=where, item=f"<{element.tag}>", expected=f'<{element.tag} Type="...">'
        )
    return Entry(element.tag, kind, attributes, tuple(element), where)


def nearest(name: str, known: Iterable[str]) -> str:
    """The known names similar to a name, or all of them."""
    by_lower = {k.lower(): k for k in known}
    near = [by_lower[n] for n in get_close_matches(name.lower(), by_lower, 3)]
    return " or ".join(near) if near else ", ".join(by_lower.values()) or "none"


def values_of(
    known: Mapping[str, Attr],
    given: Mapping[Any, Any],
    where: str,
    owner: str,
    problems: list[BadInput],
) -> dict[str, Any]:
    """Attributes as values, with defaults; errors are added to `problems`."""
    values = {name: attr.default for name, attr in known.items()}
    for key, text in given.items():
        name = str(key)
        if name not in known:
            problems.append(
                BadInput(
                    "unknown attribute",
                    where=where,
                    item=f"{owner}.{name}",
                    expected=nearest(name, known),
                    got=name,
                )
            )
            continue
        try:
            values[name] = _value(known[name], str(text))
        except ValueError as error:
            problems.append(
                BadInput(
                    "wrong value",
                    where=where,
                    item=f"{owner}.{name}",
                    expected=str(error),
                    got=text,
                )
            )
    problems += [
        BadInput("attribute missing", where=where, item=f"{owner}.{name}", expected=f'{name}="..."')
        for name, attr in known.items()
        if attr.needed and name not in given
    ]
    return values


def _value(attr: Attr, text: str) -> Any:
    text = text.strip()
    if attr.kind == "text":
        return text
    if attr.kind == "flag":
        if text.lower() in ("true", "1", "yes", "t", "y"):
            return True
        if text.lower() in ("false", "0", "no", "f", "n"):
            return False
        raise ValueError("TRUE or FALSE")
    if attr.kind == "choice":
        for word in attr.choices:
            if text.lower() == word.lower():
                return word
        raise ValueError(" or ".join(attr.choices))
    span = "a whole number" if attr.kind == "int" else "a number"
    if attr.low is not None:
        span += f" from {attr.low:g}" + ("" if attr.high is None else f" to {attr.high:g}")
    try:
        value: float = int(text[: DIGITS + 1]) if attr.kind == "int" else float(text)
    except ValueError:
        raise ValueError(span) from None
    small = attr.low is not None and value < attr.low
    if small or (attr.high is not None and value > attr.high) or value != value:
        raise ValueError(span)
    return value
