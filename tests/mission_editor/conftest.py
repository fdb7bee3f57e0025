"""A mission that is open in the editor."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from ground_station_tools import Served, editing

CROSSING = Path(__file__).resolve().parents[2] / "examples/crossing/mission.yaml"


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    """The crossing, in a file of its own."""
    path = tmp_path / "mission.yaml"
    path.write_text(CROSSING.read_text(encoding="utf-8"), encoding="utf-8")
    return path


@pytest.fixture
def editor(mission: Path) -> Iterator[Served]:
    """`cratous serve MISSION --edit`."""
    with editing(mission) as served:
        yield served
