from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CROSSING, POPUP = (EXAMPLES / name / "mission.yaml" for name in ("crossing", "popup"))


@pytest.fixture(scope="session")
def crossing(fly_once: Callable[[Path], Path]) -> Path:
    """The results of a flight in which ICAROUS takes over vehicle 2 and hands it back."""
    return fly_once(CROSSING)


@pytest.fixture
def popup(fly_once: Callable[[Path], Path]) -> Path:
    """The results of a flight in which vehicle 2 is lost at 60 s."""
    return fly_once(POPUP)


@pytest.fixture(scope="session")
def crossing_alone(fly_once: Callable[..., Path]) -> Path:
    """The results of the same mission without ICAROUS: the two are not well clear."""
    return fly_once(CROSSING, "--no-daa")


@pytest.fixture(scope="session")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A message log of one state."""
    place = {"$type": "CMASI/Location3D", "Latitude": 45.0, "Longitude": 9.0, "Altitude": 100.0}
    body = {"$type": "CMASI/AirVehicleState", "ID": 1, "Location": place}
    entry = {"seq": 0, "time_ms": 0, "source": "a", "topic": "afrl.cmasi.AirVehicleState"}
    file = tmp_path_factory.mktemp("log") / "told.jsonl"
    file.write_text(json.dumps({**entry, "body": body}) + "\n")
    return file
