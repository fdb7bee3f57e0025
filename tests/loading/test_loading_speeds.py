"""Speeds that exclude each other, and nobody who is eligible."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from loading_tools import small

from cratous.services.loading import load
from cratous.spec.errors import BadInput


@pytest.mark.parametrize(
    ("speeds", "item", "expected"),
    [
        ({"speed_m_s": 50, "max_speed_m_s": 33}, "speed_m_s", "at most 33 m/s"),
        ({"speed_m_s": 10, "min_speed_m_s": 33}, "speed_m_s", "at least 33 m/s"),
        ({"speed_m_s": 50, "min_speed_m_s": 20, "max_speed_m_s": 33}, "speed_m_s", "20 to 33 m/s"),
        (
            {"speed_m_s": 40, "min_speed_m_s": 50, "max_speed_m_s": 33},
            "max_speed_m_s",
            "at least 50 m/s",
        ),
    ],
)
def test_speeds_that_exclude_each_other(
    speeds: dict, item: str, expected: str, tmp_path: Path
) -> None:
    data = small()
    for name in ("speed_m_s", "min_speed_m_s", "max_speed_m_s"):
        data["vehicles"][0].pop(name)
    data["vehicles"][0].update(speeds)
    (tmp_path / "m.yaml").write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput) as error:
        load(tmp_path / "m.yaml")
    assert error.value.item == f"vehicles[0].{item}"
    assert error.value.expected == expected


def test_nobody_eligible_is_refused_and_not_read_as_all(tmp_path: Path) -> None:
    data = small()
    data["tasks"][0]["eligible"] = []
    (tmp_path / "m.yaml").write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput, match="too few entries") as error:
        load(tmp_path / "m.yaml")
    assert error.value.item == "tasks[0].eligible"
    assert "left out: all" in error.value.expected
