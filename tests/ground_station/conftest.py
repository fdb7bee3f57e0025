from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

CROSSING = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"


@pytest.fixture
def crossing(fly_once: Callable[[Path], Path]) -> Path:
    """The results of a flight in which ICAROUS takes over vehicle 2 and hands it back."""
    return fly_once(CROSSING)
