"""AMASE scenario files: events with their times, and the duration.

`<AMASE>` holds `<ScenarioData>` (name, duration and start time [s]) and `<ScenarioEventList>`: LMCP objects,
each with an attribute Time [s] (default 0), and `<Link Source="file"/>` to another such file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from cratous.bridge.lmcp import model, xml
from cratous.services.simulator.world import Event
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import bytes_of

DAY_S = 86_400.0
MOST_EVENTS = 100_000
MOST_LINKS = 100
LATEST_S = 1e9
"""Latest start of a scenario [s]: thirty years; ticks are exact until then."""


@dataclass
class Scenario:
    """name, duration and start time [s]; events in the order of the file; notes: what was left out, with its
    place.
    """

    name: str
    duration_s: float = DAY_S
    start_s: float = 0.0
    events: list[Event] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def read(path: Path) -> Scenario:
    """The scenario of a file; BadInput with file and line for an invalid one."""
    scenario = Scenario(path.stem)
    _read(bytes_of(path), str(path), path.parent, scenario, [path.resolve()])
    return scenario


def of_text(text: str, where: str) -> Scenario:
    """The scenario of a text without links to files."""
    scenario = Scenario(where)
    _read(text.encode(), where, None, scenario, [])
    return scenario


def _read(
    data: bytes, where: str, folder: Path | None, scenario: Scenario, files: list[Path]
) -> None:
    root = xml.parse(data, where)
    if root.tag != "AMASE":
        raise BadInput(
            "not an AMASE scenario", where=where, expected="<AMASE>", got=f"<{root.tag}>"
        )
    data_of = root.find("ScenarioData")
    if data_of is not None and len(files) <= 1:
        scenario.name = (data_of.findtext("ScenarioName") or "").strip() or scenario.name
        place = f"{where}:{data_of.sourceline}"
        scenario.duration_s = (
            _seconds(data_of.findtext("ScenarioDuration"), place, "ScenarioDuration") or DAY_S
        )
        start_s = _seconds(data_of.findtext("ScenarioStartTime"), place, "ScenarioStartTime")
        scenario.start_s = start_s or 0.0
        if scenario.start_s > LATEST_S:
            raise BadInput("a start too late", where=place, item="ScenarioStartTime",
                           expected=f"at most {LATEST_S:g} s", got=f"{start_s:g}")  # fmt: skip
    for events in root.iterfind("ScenarioEventList"):
        for element in events.iterchildren("*"):
            _event(element, f"{where}:{element.sourceline}", where, folder, scenario, files)


def _event(
    element: Any, place: str, where: str, folder: Path | None, scenario: Scenario, files: list[Path]
) -> None:
    if element.tag == "Link":
        source = element.get("Source") or ""
        if folder is None or not source:
            raise BadInput("a link without a file", where=place, item="Source", got=source)
        linked = folder / source
        if linked.resolve() in files or len(files) >= MOST_LINKS:
            raise BadInput("links that go in a circle, or too many", where=place, got=source)
        files.append(linked.resolve())
        _read(bytes_of(linked), str(linked), linked.parent, scenario, files)
        return
    if element.get("Series") is None and not model.series_with(element.tag):
        scenario.notes.append(f"{place}: <{element.tag}> is no message that is known: left out")
        return
    if len(scenario.events) >= MOST_EVENTS:
        raise BadInput("too many events", where=place, expected=f"at most {MOST_EVENTS}")
    time_s = _seconds(element.get("Time"), place, "Time") or 0.0
    body = xml.read_element(element, where, scenario.notes)
    scenario.events.append(Event(time_s, body, place))


def _seconds(text: str | None, where: str, item: str) -> float | None:
    if text is None or not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not isfinite(value) or value < 0:
        raise BadInput(
            "not a time", where=where, item=item, expected="seconds, at least 0", got=text
        )
    return value
