"""A mission that is open in the editor."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import Page, browsing
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


@pytest.fixture
def page(editor: Served, tmp_path: Path) -> Iterator[Page]:
    with browsing(tmp_path / "profile") as page:
        page.go(editor.url)
        page.until("document.getElementById('relations-tree')?.textContent.includes('p1')")
        yield page
        # no script failed; a refusal of the server is told as the page's own message
        assert [one for one in page.logged if "status of 4" not in str(one)] == []
