"""What is derived from vehicle and mission, and what is said when a parameter by hand does not fit it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from loading_tools import small

from cratous.services.icarous.derived import derived
from cratous.services.loading import load
from cratous.services.loading.fitness import NAME, warnings_of
from cratous.spec.errors import BadInput

ZONE = {"id": 1, "kind": "keep_out", "vertices": [[5000, 0], [5000, 100], [5100, 0]]}


def written(folder: Path, change: Callable[[dict], Any]) -> Path:
    """A small mission of which something is changed, as a file."""
    data = small()
    change(data)
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return path


def daa(**values: Any) -> Callable[[dict], Any]:
    return lambda data: data.update(daa=values)


def vehicle(**values: Any) -> Callable[[dict], Any]:
    return lambda data: data["vehicles"][0].update(values)


def beats(**values: Any) -> Callable[[dict], Any]:
    return lambda data: data.update(simulation=values)


def zoned(**values: Any) -> Callable[[dict], Any]:
    return lambda data: data.update(daa=values, zones=[ZONE])


REFUSED = [
    (daa(lookahead_s=0), "daa.lookahead_s"),
    (daa(buffer=0.99), "daa.buffer"),
    (daa(well_clear={"tthr_s": -1}), "daa.well_clear.tthr_s"),
    (vehicle(max_bank_deg=0), "vehicles[0].max_bank_deg"),
    (vehicle(max_climb_m_s=0), "vehicles[0].max_climb_m_s"),
    (vehicle(min_speed_m_s=21), "vehicles[0].speed_m_s"),
    (vehicle(max_speed_m_s=19), "vehicles[0].speed_m_s"),
    (beats(heartbeat_ms=0), "simulation.heartbeat_ms"),
    (beats(step_ms=0), "simulation.step_ms"),
]
FLAGGED = [
    (daa(lookahead_s=5), "daa.lookahead_s", 8.55),
    (zoned(lookahead_s=12), "daa.lookahead_s", 14.7),
    (vehicle(max_bank_deg=1), "daa.lookahead_s", 187),
    (daa(buffer=1), "daa.buffer", 1.11),
    (daa(buffer=1.05), "daa.buffer", 1.11),
    (daa(well_clear={"dthr_m": 30, "zthr_m": 30, "tthr_s": 5}), "daa.buffer", 1.53),
    (daa(well_clear={"dthr_m": 0}), "daa.well_clear.dthr_m", 1),
    (daa(well_clear={"zthr_m": 0}), "daa.well_clear.zthr_m", 1),
    (vehicle(max_climb_m_s=0.001), "vehicles[0].max_climb_m_s", 0.625),
    (vehicle(cruise_m=-5), "vehicles[0].cruise_m", 0),
    (beats(heartbeat_ms=5000), "simulation.heartbeat_ms", 1000),
    (beats(heartbeat_ms=300, step_ms=1000), "simulation.heartbeat_ms", 1000),
]


@pytest.mark.parametrize(("change", "item"), REFUSED, ids=[item for _, item in REFUSED])
def test_what_is_unusable_is_refused(change: Any, item: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load(written(tmp_path, change))
    assert caught.value.item == item
    assert caught.value.expected
    assert caught.value.where.startswith(str(tmp_path / "mission.yaml:"))


@pytest.mark.parametrize(
    ("change", "item", "wanted"), FLAGGED, ids=[f"{k}-{row[1]}" for k, row in enumerate(FLAGGED)]
)
def test_what_does_not_fit_is_a_note_of_the_mission(
    change: Any, item: str, wanted: float, tmp_path: Path
) -> None:
    """The note asks for a value, and with it the note is gone."""
    notes = load(written(tmp_path, change)).notes
    mine = [note for note in notes if note.startswith(f"{NAME}: {item} is ")]
    assert len(mine) == 1
    assert f" {wanted:g}" in mine[0].partition("expected ")[2]
    assert warnings_of(load(written(tmp_path, change))) == notes

    def mended(data: dict) -> None:
        change(data)
        place, names = data, item.replace("[0]", ".0").split(".")
        for name in names[:-1]:
            place = place[int(name)] if name.isdigit() else place.setdefault(name, {})
        place[names[-1]] = wanted

    after = load(written(tmp_path, mended)).notes
    assert not [note for note in after if f": {item} is " in note]


def test_nothing_is_said_where_nothing_is_given_or_nobody_is_guarded(tmp_path: Path) -> None:
    assert load(written(tmp_path, lambda data: None)).notes == ()

    def unguarded(data: dict) -> None:
        data.update(daa={"lookahead_s": 1}, bridge={"instances": 0})

    assert load(written(tmp_path, unguarded)).notes == ()


def test_what_is_derived_is_what_the_formulas_say(tmp_path: Path) -> None:
    """20 m/s and 30 degrees of bank, with the default volume: worked by hand."""
    mission = load(written(tmp_path, lambda data: None))
    found = derived(mission, mission.vehicles[0])
    assert found.turn_radius_m == pytest.approx(70.648, abs=1e-3)
    assert found.turn_rate_rad_s == pytest.approx(0.28309, abs=1e-5)
    assert found.hard_limit_s == pytest.approx(6.5486, abs=1e-4)
    assert found.last_time_s == pytest.approx(6.5486 + 18.75, abs=1e-4)
    assert (found.room_m, found.room_high_m, found.horizon_s) == (18.75, 3.75, 78.75)
    assert found.drift_m == pytest.approx(20 * 0.25 * 1.5708, abs=1e-3)
    assert found.hold_m == pytest.approx(1.1 * 70.648 + 20, abs=1e-2)
