"""Persistence and hysteresis of alerts and bands are set by the mission, or by an imported parameter file."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from icarous_tools import ABILITY, NORTH, VOLUME

from cratous.core.authority.gate import UXAS, Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.services.daa import named_or_file
from cratous.services.icarous.bands import Whose, parameters_of, watched
from cratous.services.icarous.messages import Sensed
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.guidance import guidance_of
from cratous.services.parameters.listing import parameters_of as listed
from cratous.services.parameters.mapping import settings_of
from cratous.services.parameters.parameter_file import parse
from cratous.spec.daa.parameters import FOOT, KNOT
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa, GuidedWellClear, Mission, Position, Velocity
from cratous.spec.mission.guidance import Guidance

OF_GUIDANCE = (
    "alerting_m", "alerting_n", "hysteresis_time_s", "persistence_time_s", "bands_persistence",
    "persistence_preferred_hdir_rad", "persistence_preferred_hs_m_s", "persistence_preferred_vs_m_s",
    "persistence_preferred_alt_m", "ca_bands", "ca_factor", "recovery_stability_time_s", "conflict_crit",
)  # fmt: skip
CROSSING = Intruder(9, Position(1100.0, 850.0, 300.0), Velocity(0.0, -20.0, 0.0))


def whose(guidance: Guidance | None) -> Whose:
    sizes = VOLUME.dthr_m, VOLUME.zthr_m, VOLUME.tthr_s, VOLUME.tcoa_s
    volume = VOLUME if guidance is None else GuidedWellClear(*sizes, guidance)
    return Whose(1, Daa(volume, buffer=1.25), 500, True)


def levels(guidance: Guidance, looks: int) -> list[int]:
    """The shown levels for an intruder in conflict, at each evaluation after four in which it is far away."""
    bands, shown = None, []
    for k in range(4 + looks):
        other = CROSSING if k >= 4 else CROSSING._replace(position=Position(9e4, 9e4, 300.0))
        sensed = Sensed(1000 * k, NORTH, ABILITY, (other,), Gate(UXAS, 1, False))
        bands, instant = watched(whose(guidance), bands, sensed)
        assert instant is not None
        shown.append(instant.alerts[0].level)
    return shown[4:]


def test_what_a_mission_does_not_say_is_that_of_do_365b_with_recovery_coordinated() -> None:
    usual = parameters_of(whose(None), ABILITY, False)
    preset = named_or_file("do_365b").parameters
    for name in OF_GUIDANCE:
        assert getattr(usual, name) == pytest.approx(getattr(preset, name)), name
    assert usual.recovery_crit
    assert not preset.recovery_crit
    assert usual == parameters_of(whose(Guidance()), ABILITY, False)


def test_each_item_reaches_the_engine() -> None:
    said = Guidance(1, 3, 6.0, 7.0, False, 8.0, 9.0, 10.0, 11.0, False, 0.3, 12.0, True, False)
    p = parameters_of(whose(said), ABILITY, False)
    assert (p.alerting_m, p.alerting_n, p.hysteresis_time_s) == (1, 3, 6.0)
    assert (p.persistence_time_s, p.bands_persistence) == (7.0, False)
    assert p.persistence_preferred_hdir_rad == pytest.approx(math.radians(8.0))
    assert p.persistence_preferred_hs_m_s == 9.0
    assert (p.persistence_preferred_vs_m_s, p.persistence_preferred_alt_m) == (10.0, 11.0)
    assert (p.ca_bands, p.ca_factor, p.recovery_stability_time_s) == (False, 0.3, 12.0)
    assert (p.conflict_crit, p.recovery_crit) == (True, False)
    # and none of them has its default
    usual = asdict(Guidance())
    assert all(value != usual[name] for name, value in asdict(said).items())


def test_an_alert_is_shown_after_so_many_looks() -> None:
    at_once = Guidance(alerting_m=1, alerting_n=1)
    assert levels(at_once, 1) == [1]
    assert levels(replace(at_once, alerting_n=4), 1) == [1]
    assert levels(replace(at_once, alerting_m=3, alerting_n=4), 4) == [0, 0, 1, 1]
    assert levels(Guidance(), 3) == [0, 1, 1]


def mission_file(root: Path, folder: Path, guidance: dict[str, Any]) -> Path:
    data = yaml.safe_load((root / "examples/crossing/mission.yaml").read_text())
    data["daa"]["guidance"] = guidance
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(data))
    return path


def test_a_mission_says_it_and_is_read_back(root: Path, tmp_path: Path) -> None:
    path = mission_file(root, tmp_path, {"alerting_m": 1, "hysteresis_s": 8})
    mission = load(path)
    guidance = guidance_of(mission.daa.well_clear)
    assert guidance == Guidance(alerting_m=1, hysteresis_s=8.0)
    assert from_data(Mission, to_data(mission)) == mission
    rows = {one.name: one for one in listed(mission, path)}
    said = rows["daa.guidance.hysteresis_s"]
    assert (said.value, said.origin) == (8, "given")
    assert rows["daa.guidance.alerting_n"].origin == "default"
    for bad, item in (({"alerting_m": 5}, "alerting_m"), ({"hysteresis_s": -1}, "hysteresis_s")):
        with pytest.raises(BadInput, match=item):
            load(mission_file(root, tmp_path, bad))


def test_a_parameter_file_sets_it() -> None:
    text = """
        hysteresis_time = 3 [s]
        persistence_preferred_hdir = 5 [deg]
        persistence_preferred_hs = 2 [knot]
        persistence_preferred_alt = 30 [ft]
        alerting_m = 2
        ca_bands = false
    """
    found = {one.item: one.value for one in settings_of(parse(text, "file"), 20.0).values()}
    assert found["daa.guidance.hysteresis_s"] == 3
    assert found["daa.guidance.preferred_heading_deg"] == pytest.approx(5)
    assert found["daa.guidance.preferred_speed_m_s"] == pytest.approx(2 * KNOT)
    assert found["daa.guidance.preferred_alt_m"] == pytest.approx(30 * FOOT)
    assert found["daa.guidance.alerting_m"] == 2
    assert isinstance(found["daa.guidance.alerting_m"], int)
    assert found["daa.guidance.recovery_shrinks"] is False
