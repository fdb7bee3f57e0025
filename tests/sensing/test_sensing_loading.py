"""The section `sensing` of a mission file: what it says, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from loading_tools import small

from cratous.judge import mission_file
from cratous.services.flight.encounter import ways_of
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.processes.coverage import told_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, SensedDaa
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind

GPS = {"kind": "gps", "horizontal_m": 3, "vertical_m": 5, "velocity_m_s": 0.3}
ADSB = {"kind": "adsb", "horizontal_m": 10, "vertical_m": 8, "velocity_m_s": 1}


def file_of(folder: Path, sensing: Any, **more: Any) -> Path:
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump({**small(), "sensing": sensing, **more}))
    return file


def test_what_it_says(tmp_path: Path) -> None:
    adsb = {**ADSB, "latency_s": 0.4, "period_s": 0.5, "drop_out": 0.1, "range_m": 20000}
    file = file_of(tmp_path, {"sensors": [GPS, adsb], "seed": 7, "sigmas": 3, "coast_s": 2.5})
    mission = load(file)
    assert mission.sensing == Sensing(
        (
            Sensor(SensorKind.GPS, 3.0, 5.0, 0.3),
            Sensor(SensorKind.ADSB, 10.0, 8.0, 1.0, 400, 500, 0.1, 20000.0),
        ),
        seed=7, sigmas=3.0, coast_ms=2500,
    )  # fmt: skip
    (note,) = mission.notes
    assert note.startswith("ICAROUS is given sensed states, not the true ones (seed 7): gps (")
    assert "adsb (standard deviations 10 m beside, 8 m in altitude, 1 m/s; every 0.5 s" in note
    again = from_data(Mission, to_data(mission))
    assert again == mission
    assert isinstance(again.daa, SensedDaa)
    # the judge knows the mission by its file and does not care
    assert mission_file.read(file).name == "small"
    without = file_of(tmp_path, None)
    without.write_text(yaml.safe_dump(small()))
    assert load(without).sensing is None
    assert load(without).notes == ()


@pytest.mark.parametrize(
    ("sensing", "item", "what", "got"),
    [
        ({"sensors": []}, "sensing.sensors", "too few entries", "[]"),
        ({"sensors": [GPS]}, "sensing.sensors", "no sensor sees traffic", "gps alone"),
        ({"sensors": [ADSB, GPS, dict(GPS)]}, "sensing.sensors[2].kind", "two sensors of the own", "another"),
        ({"sensors": [{**GPS, "range_m": 500}, ADSB]}, "sensing.sensors[0].range_m", "has no range", "500 m"),
        ({"sensors": [{**ADSB, "kind": "lidar"}]}, "sensing.sensors[0].kind", "unknown value", '"lidar"'),
        ({"sensors": [{**ADSB, "horizontal_m": 0}]}, "sensing.sensors[0].horizontal_m", "out of range", "0"),
        ({"sensors": [{**ADSB, "drop_out": 1}]}, "sensing.sensors[0].drop_out", "out of range", "1"),
        ({"sensors": [{**ADSB, "latency_s": 9}]}, "sensing.sensors[0].latency_s", "out of range", "9"),
        ({"sensors": [{**ADSB, "period_s": 0.1}]}, "sensing.sensors[0].period_s", "more often than", "0.1 s"),
        ({"sensors": [{"kind": "adsb"}]}, "sensing.sensors[0]", "missing", "nothing"),
        ({"sensors": [ADSB], "coast_s": 0.9}, "sensing.coast_s", "end between two measurements", "0.9 s"),
        ({"sensors": [ADSB], "confirm_hits": 4}, "sensing.confirm_hits", "no track would ever", "4"),
        ({"sensors": [ADSB], "sigma": 3}, "sensing.sigma", "unknown entry", "sigma"),
        ({"sensors": [ADSB], "seed": -1}, "sensing.seed", "out of range", "-1"),
        ([], "sensing", "wrong type", "[]"),
    ],
)  # fmt: skip
def test_what_is_refused(tmp_path: Path, sensing: Any, item: str, what: str, got: str) -> None:
    with pytest.raises(BadInput) as refused:
        load(file_of(tmp_path, sensing))
    text = str(refused.value)
    assert item in text
    assert what in text
    assert got in text
    assert "mission.yaml:" in text


def test_nobody_carries_sensors_where_nobody_avoids(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="nobody carries these sensors"):
        load(file_of(tmp_path, {"sensors": [ADSB]}, bridge={"instances": 0}))


def test_who_flies_without_sensors_refuses_them(tmp_path: Path) -> None:
    mission = load(file_of(tmp_path, {"sensors": [ADSB]}))
    with pytest.raises(BadInput, match="which separate processes cannot fly") as refused:
        told_of(mission)
    assert refused.value.item == "sensing"
    with pytest.raises(BadInput) as refused:
        ways_of(mission)
    assert refused.value.expected == "none"
