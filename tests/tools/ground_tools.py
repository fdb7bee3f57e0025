"""Flights on and off the ground or without the link, as those who watch them see them; diagrams in the guide."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from judge_tools import Message, write

from cratous.bridge import lmcp
from cratous.judge import judge
from cratous.services.bus import Bus
from cratous.services.flight.loop import fly
from cratous.services.flight.result import FlightResult
from cratous.services.loading import load
from cratous.services.logs.records import to_data
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Verdict


class Flown(NamedTuple):
    """A flight and its log; what is asked of another log is asked of that."""

    mission: Mission
    log: list[Any]
    result: FlightResult

    def told(self, topic: str) -> list[Any]:
        """The bodies of the messages of a kind."""
        return [one.body for one in self.log if one.topic.rpartition(".")[2] == topic]

    def verdicts(self, log: list[Any] | None = None) -> dict[str, Verdict]:
        """What the monitor says, by item or requirement."""
        monitor = Monitor(self.mission, make_plan(self.mission))
        for one in self.log if log is None else log:
            monitor.tap(one)
        return {v.item or v.requirement: v for v in monitor.verdicts()}

    def judged(self, folder: Path, log: list[Any] | None = None) -> dict[str, str]:
        """What the judge says, by item."""
        rows = (
            Message(one.time_ms, one.topic, json.loads(lmcp.to_json(one.body)))
            for one in (self.log if log is None else log)
        )
        file = write(folder / "log.sqlite", {"mission": to_data(self.mission)}, rows)
        return {row.item: row.verdict for row in judge(file).rows}


def flown_of(mission: Mission) -> Flown:
    """A mission planned and flown."""
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    return Flown(mission, log, fly(mission, make_plan(mission), bus))


def refusal(path: Path, check: Callable[[Mission], object]) -> str:
    """What a check of a mission file says that it refuses."""
    with pytest.raises(BadInput) as caught:
        check(load(path))
    return str(caught.value)


def assert_in_the_guide(root: Path, tool: str) -> None:
    """The diagram that a tool of the docs makes of a kernel is the one in the guide."""
    spec = importlib.util.spec_from_file_location("machine", root / "docs/tools" / tool)
    assert spec is not None
    assert spec.loader is not None
    machine = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(machine)
    assert machine.block() in (root / "docs/guides/detect-and-avoid.md").read_text("utf-8")
