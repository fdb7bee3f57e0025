"""Vehicles that start inside each other's well-clear volume: refused, unless the mission says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.services.loading import load
from cratous.spec.errors import BadInput

MISSION = Path(__file__).resolve().parents[1] / "missions" / "lost_vehicle.yaml"


def starting(folder: Path, north_m: float, alt_m: float, **more: Any) -> Path:
    """Vehicle 2 before vehicle 1, which flies north, the two head to head or as `more` says."""
    data = yaml.safe_load(MISSION.read_text(encoding="utf-8"))
    one, two = data["vehicles"]
    two["position"] = {"north_m": north_m, "east_m": 0, "alt_m": alt_m}
    two["heading_deg"] = more.pop("heading_deg", 180)
    if not more.pop("protected", True):
        one["protected"] = two["protected"] = False
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump({**data, **more}), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("north_m", "alt_m", "heading_deg"),
    [(100.0, 410.0, 0), (150.0, 430.0, 0), (760.0, 400.0, 180)],
)
def test_close_starts_are_refused_by_name(
    tmp_path: Path, north_m: float, alt_m: float, heading_deg: float
) -> None:
    with pytest.raises(BadInput, match="vehicles 1 and 2 start inside each other's") as caught:
        load(starting(tmp_path, north_m, alt_m, heading_deg=heading_deg))
    assert caught.value.item == "vehicles[1].position"
    assert "close_starts: true" in caught.value.expected
    assert f"{north_m:.1f} m apart, {alt_m - 400:.1f} m in altitude" in caught.value.got


@pytest.mark.parametrize(
    "more",
    [
        {"north_m": 150.1, "alt_m": 400.0, "heading_deg": 0},
        {"north_m": 0.0, "alt_m": 430.1},
        {"north_m": 780.0, "alt_m": 400.0},
        {"north_m": 100.0, "alt_m": 400.0, "protected": False},
        {"north_m": 100.0, "alt_m": 400.0, "daa": {"close_starts": True}},
    ],
)
def test_who_is_well_clear_or_allowed_may_start(tmp_path: Path, more: dict[str, Any]) -> None:
    mission = load(starting(tmp_path, **more))
    assert len(mission.vehicles) == 2
