"""Detection on the bus: intervals, what each attribute changes, and what cannot be said."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from daidalus_sky import SEES, Sky, head_on, intervals, state

from cratous.bridge import lmcp
from cratous.core.daa.session import Session
from cratous.services.daa.intervals import SERIES
from cratous.services.uxas.daidalus import parameters
from cratous.services.uxas.daidalus.states import aircraft, wind_of
from cratous.spec.daa.parameters import NEAR, Parameters
from cratous.spec.errors import BadInput

DETECTION = "DAIDALUS_WCV_Detection"


@pytest.mark.shows(
    DETECTION,
    "AirVehicleState",
    "RemoveEntities",
    "WellClearViolationIntervals",
    "VehicleID",
)
def test_intervals_are_those_of_the_engine_at_each_state_of_the_ownship(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES)
    sky.tell(head_on()[0])
    assert sky.got("WellClearViolationIntervals") == []
    other, own = head_on()
    sky.tell(own)
    said = intervals(sky)
    still = wind_of(own)
    instant = Session(parameters_with("")).step(
        1.0, aircraft(own, own, still), [aircraft(own, other, still)]
    )
    assert (said.EntityId, said.EntityList, said.AlertLevelList) == (2, [1], [3.0])
    assert said.TimeToViolationList == [instant.alerts[0].to_corrective_s]
    assert (said.CurrentHeading, said.CurrentGoundSpeed, said.CurrentTime) == (0.0, 50.0, 1.0)
    expected = {"WCVGroundHeadingIntervals", "WCVGroundSpeedIntervals", "WCVVerticalSpeedIntervals",
                "WCVAlitudeIntervals"}  # fmt: skip
    for g, name in zip(instant.guidance, sorted(expected, key=list(_lists()).index), strict=True):
        size = 180 / math.pi if g.dimension == "hdir" else 1.0
        want = [[b.low * size, b.high * size] for b in g.bands if 1 <= b.region <= NEAR]
        got = [list(getattr(i, _lists()[name])) for i in getattr(said, name)]
        assert want, name
        assert got == [pytest.approx(ends) for ends in want], name
    sky.tell(lmcp.new("RemoveEntities", EntityList=[1]), state(2, 50.0, 0.0, 0.0, 50.0, 2000))
    assert intervals(sky).EntityList == []
    assert intervals(sky).WCVGroundHeadingIntervals == []


def _lists() -> dict[str, str]:
    return {parts[2]: parts[1] for parts in SERIES.values()}


def parameters_with(text: str) -> Parameters:
    """The parameters of a service with attributes given as text."""
    from cratous.services.loading.uxas_settings import Entry, values_of

    given = dict(pair.split("=") for pair in text.split())
    given = {"TurnRate": "3", **given}
    problems: list[BadInput] = []
    entry = Entry("Service", DETECTION, given, (), "cfg.xml:2")
    values = values_of(parameters.ATTRIBUTES, given, entry.where, DETECTION, problems)
    assert problems == []
    return parameters.parameters_of(entry, values)


CHANGED = {
    "LookAheadTime": ("30", "LookAheadTime", 30.0),
    "LeftTrack": ("10", "LeftTrack", 10.0),
    "RightTrack": ("60", "RightTrack", 60.0),
    "MinGroundSpeed": ("30", "MinGroundSpeed", 30.0),
    "MaxGroundSpeed": ("70", "MaxGroundSpeed", 70.0),
    "MinVerticalSpeed": ("-2", "MinVerticalSpeed", -2.0),
    "MaxVerticalSpeed": ("6", "MaxVerticalSpeed", 6.0),
    "MinAltitude": ("900", "MinAltitude", 900.0),
    "MaxAltitude": ("1100", "MaxAltitude", 1100.0),
    "TrackStep": ("10", "TrackStep", 10.0),
    "GroundSpeedStep": ("7", "GroundSpeedStep", 7.0),
    "VerticalSpeedStep": ("2.5", "VerticalSpeedStep", 2.5),
    "AltitudeStep": ("50", "AltitudeStep", 50.0),
    "HorizontalAcceleration": ("1", "HorizontalAcceleration", 1.0),
    "VerticalAcceleration": ("0.1", "VerticalAcceleration", 0.1),
    "TurnRate": ("6", "TurnRate", 6.0),
    "VerticalRate": ("5", "VerticalRate", 5.0),
    "MinHorizontalRecovery": ("800", "DTHR", 800.0),
    "MinVerticalRecovery": ("100", "ZTHR", 100.0),
    "TTHR": ("20", "TTHR", 20.0),
    "HorizontalDetectionType": ("TEP", "HorizontalDetectionType", "TEP"),
    "RTCAAlertLevels": ("1", "RTCAAlertLevels", 1),
    "AlertTime1": ("56", "AlertTime1", 56.0),
    "AlertTime2": ("30", "AlertTime2", 30.0),
    "AlertTime3": ("10", "AlertTime3", 10.0),
}
"""Attributes that change the intervals of the scene below: value, field of the message, value told."""


@pytest.mark.shows(
    DETECTION,
    "LookAheadTime", "LeftTrack", "RightTrack", "MinGroundSpeed", "MaxGroundSpeed",
    "MinVerticalSpeed", "MaxVerticalSpeed", "MinAltitude", "MaxAltitude", "TrackStep",
    "GroundSpeedStep", "VerticalSpeedStep", "AltitudeStep", "HorizontalAcceleration",
    "VerticalAcceleration", "TurnRate", "VerticalRate", "MinHorizontalRecovery",
    "MinVerticalRecovery", "TTHR", "HorizontalDetectionType", "RTCAAlertLevels", "AlertTime1",
    "AlertTime2", "AlertTime3", "DAIDALUSConfiguration",
)  # fmt: skip
def test_each_attribute_is_told_and_changes_what_is_found(tmp_path: Path) -> None:
    def seen(name: str, text: str) -> tuple[Any, str]:
        folder = tmp_path / (name or "none")
        folder.mkdir()
        sky = Sky(folder, f'Type="{DETECTION}" VehicleID="2" {text}')
        near = state(1, 7000.0, 900.0, 190.0, 50.0, 1000, alt_m=1050.0)
        far = state(3, 4000.0, 11000.0, 250.0, 60.0, 1000, alt_m=980.0)
        sky.tell(near, far, state(2, 0.0, 0.0, 0.0, 50.0, 1000))
        (told,) = sky.got("DAIDALUSConfiguration")
        return told, repr(intervals(sky))

    _, plain = seen("", "")
    # a climb takes time only with both of the two
    climb = {
        "VerticalRate": 'VerticalAcceleration="0.1"',
        "VerticalAcceleration": 'VerticalRate="3"',
    }
    unmoved = []
    for name, (value, field, expected) in CHANGED.items():
        more = climb.get(name, "")
        told, changed = seen(name, f'{name}="{value}" {more}')
        assert getattr(told, field) == pytest.approx(expected), name
        before = seen(f"no {name}", more)[1] if more else plain
        unmoved += [name] if changed == before else []
    assert not unmoved, str(unmoved)


@pytest.mark.shows(
    DETECTION,
    "BankAngle",
    "RecoveryStabilityTime",
    "isRecoveryTrack",
    "isRecoveryGroundSpeed",
    "isRecoveryVerticalSpeed",
    "isRecoveryAltitude",
    "isCollisionAvoidance",
    "CollisionAvoidanceFactor",
    "HorizontalNMAC",
    "VerticalNMAC",
)
def test_recovery_attributes_are_told_and_change_what_is_found(tmp_path: Path) -> None:
    def seen(name: str, text: str, other: Any) -> tuple[Any, Any]:
        folder = tmp_path / name
        folder.mkdir()
        sky = Sky(folder, f'Type="{DETECTION}" VehicleID="2" {text}')
        sky.tell(other, state(2, 0.0, 0.0, 0.0, 50.0, 1000))
        return sky.got("DAIDALUSConfiguration")[0], intervals(sky)

    # inside of the volume already: values that regain it are recovery intervals
    lost = state(1, 1000.0, 0.0, 180.0, 50.0, 1000)
    base = 'TurnRate="3" HorizontalAcceleration="2" VerticalAcceleration="0.25" VerticalRate="5" '
    base += 'isCollisionAvoidance="true" MinHorizontalRecovery="1222"'
    _, plain = seen("plain", base, lost)
    lists = {
        "isRecoveryTrack": "RecoveryGroundHeadingIntervals",
        "isRecoveryGroundSpeed": "RecoveryGroundSpeedIntervals",
        "isRecoveryVerticalSpeed": "RecoveryVerticalSpeedIntervals",
        "isRecoveryAltitude": "RecoveryAltitudeIntervals",
    }
    for name, found in lists.items():
        told, changed = seen(name, f'{base} {name}="false"', lost)
        assert not getattr(told, f"{name}Bands"), name
        if getattr(plain, found):
            assert getattr(changed, found) == [], name
    assert any(getattr(plain, found) for found in lists.values())
    values = {
        "RecoveryStabilityTime": ("30", "RecoveryStabilityTime", 30.0),
        "CollisionAvoidanceFactor": ("0.9", "CollisionAvoidanceBandsFactor", True),
        "HorizontalNMAC": ("1200", "HorizontalNMAC", 1200.0),
        "VerticalNMAC": ("137", "VerticalNMAC", 137.0),
    }
    for name, (value, field, expected) in values.items():
        told, changed = seen(name, f'{base} {name}="{value}"', lost)
        assert getattr(told, field) == pytest.approx(expected), name
        assert repr(changed) != repr(plain), name
    told, changed = seen("ca", base.replace("true", "false"), lost)
    assert not told.isCollisionAvoidanceBands
    assert repr(changed) != repr(plain)
    told, turned = seen("bank", base.replace('TurnRate="3"', 'BankAngle="45"'), lost)
    assert told.BankAngle == pytest.approx(45.0)
    assert repr(turned) != repr(plain)


@pytest.mark.shows(
    DETECTION,
    "StartupComplete",
    "EarlyAlertTime1",
    "EarlyAlertTime2",
    "EarlyAlertTime3",
    "HorizontalContourThreshold",
    "Configuration",
)
def test_the_configuration_is_told_once_at_the_start(tmp_path: Path) -> None:
    early = 'EarlyAlertTime1="190" EarlyAlertTime2="70" EarlyAlertTime3="50" '
    sky = Sky(tmp_path, f'{SEES} {early} HorizontalContourThreshold="90"')
    sky.tell(lmcp.new("StartupComplete"), *head_on())
    (told,) = sky.got("DAIDALUSConfiguration")
    times = (told.EarlyAlertTime1, told.EarlyAlertTime2, told.EarlyAlertTime3)
    assert (times, told.HorizontalContourThreshold) == ((190.0, 70.0, 50.0), 90.0)
    assert (told.EntityId, told.RTCAAlertLevels, told.LookAheadTime) == (2, 3, 180.0)
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "mine.conf").write_text("lookahead_time = 60 [s]\n" + _ALERTER)
    sky = Sky(tmp_path / "own", f'Type="{DETECTION}" VehicleID="2" Configuration="mine.conf"')
    sky.tell(*head_on())
    (told,) = sky.got("DAIDALUSConfiguration")
    assert (told.LookAheadTime, told.HorizontalDetectionType, told.AlertTime3) == (60.0, "TCPA", 50)
    assert intervals(sky).WCVGroundHeadingRegions[0].name == "NEAR"


_ALERTER = """alerters = A
A_alert_1_alerting_time = 50 [s]
A_alert_1_detector = d
A_alert_1_region = NEAR
A_load_core_detection_d = WCV_TCPA
A_d_WCV_DTHR = 1000 [m]
A_d_WCV_ZTHR = 100 [m]
A_d_WCV_TTHR = 20 [s]
"""


@pytest.mark.parametrize(
    ("text", "item", "expected"),
    [
        ("MinGroundSpeed=400", "MinGroundSpeed", "at most MaxGroundSpeed = 360.111"),
        ("AlertTime3=60", "AlertTime3", "at most EarlyAlertTime3 = 55"),
        ("AlertTime2=190 EarlyAlertTime2=190", "AlertTime2", "at most AlertTime1 = 180"),
        ("BankAngle=30", "BankAngle", "TurnRate or BankAngle"),
        ("HorizontalNMAC=2000", "HorizontalNMAC", "at most MinHorizontalRecovery"),
        ("Configuration=do_365b TTHR=20", "TTHR", "alerters from Configuration alone"),
        ("Configuration=nosuch", "Configuration", "a .conf file, or cd3d or do_365_non"),
    ],
)
def test_values_that_do_not_fit_together_are_refused(text: str, item: str, expected: str) -> None:
    with pytest.raises(BadInput) as caught:
        parameters_with(text)
    assert expected in str(caught.value)
    assert item in caught.value.item


@pytest.mark.shows(DETECTION, "ServiceStatus")
def test_what_cannot_be_said_is_no_free_interval_and_is_told(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES)
    sky.tell(head_on()[0], state(2, 0.0, 0.0, 0.0, 2.0, 1000))  # slower than MinGroundSpeed
    said = intervals(sky)
    assert [list(i.GroundSpeeds) for i in said.WCVGroundSpeedIntervals] == [[5.1444, 360.111]]
    assert [r.name for r in said.WCVGroundSpeedRegions] == ["NEAR"]
    assert sky.reasons("Warning") == ["hs: own hs 2 is outside of [5.1444, 360.111]"]
    sky.tell(state(2, 0.0, 0.0, 0.0, 2.1, 2000))
    assert len(sky.reasons("Warning")) == 1
    sky.tell(state(2, 0.0, 0.0, 0.0, 50.0, 300_000))
    assert sky.reasons("Warning")[1] == "vehicle 1: its state is too old, it is left out"
    assert intervals(sky).EntityList == []
    broken = state(1, 6000.0, 0.0, 180.0, float("nan"), 300_000)
    sky.tell(broken, state(2, 0.0, 0.0, 0.0, 50.0, 301_000))
    assert sky.reasons("Warning")[2] == "vehicle 1: its state is not finite, it is left out"
    agl = state(1, 6000.0, 0.0, 180.0, 50.0, 302_000, alt_m=5000.0)
    agl = agl.copy(Location=agl.Location.copy(AltitudeType="AGL"))
    sky.tell(agl, state(2, 0.0, 0.0, 0.0, 50.0, 302_000))
    assert intervals(sky).EntityList == [1]  # altitudes that cannot be compared miss no conflict
    assert "an altitude of another type" in sky.reasons("Warning")[3]


def test_wind_is_taken_from_every_velocity(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES)
    # 30 m/s from the north: over ground 50 m/s northward is 80 m/s through the air
    own = state(2, 0.0, 0.0, 0.0, 50.0, 1000, WindSpeed=30.0, WindDirection=0.0)
    sky.tell(head_on()[0], own)
    assert (intervals(sky).CurrentGoundSpeed, intervals(sky).CurrentHeading) == (80.0, 0.0)
    in_wind = intervals(sky)
    sky.tell(head_on()[0], head_on()[1].copy(Time=2000))
    # both are carried alike: the loss is as soon as in still air, the speeds are not
    assert in_wind.TimeToViolationList[0] == pytest.approx(
        intervals(sky).TimeToViolationList[0], abs=0.6
    )
    assert in_wind.WCVGroundHeadingIntervals != intervals(sky).WCVGroundHeadingIntervals


def test_states_of_other_times_are_moved_to_the_ownships(tmp_path: Path) -> None:
    def first(time_ms: int, north: float) -> float:
        folder = tmp_path / str(time_ms)
        folder.mkdir()
        sky = Sky(folder, SEES)
        sky.tell(state(1, north, 0.0, 180.0, 50.0, time_ms), head_on()[1].copy(Time=10_000))
        return float(intervals(sky).TimeToViolationList[0])

    assert first(6000, 6000.0) == pytest.approx(first(10_000, 5800.0), abs=0.01)
    assert first(12_000, 6000.0) == pytest.approx(first(10_001, 6100.0), abs=0.02)


@pytest.mark.shows(DETECTION, "Period_s")
def test_with_a_period_vehicles_look_by_turns(tmp_path: Path) -> None:
    sky = Sky(tmp_path, *(f'Type="{DETECTION}" VehicleID="{n}" Period_s="1"' for n in (1, 2)))
    for at_ms in range(0, 4000, 500):
        sky.tell(*(state(n, 3000.0 * n, 0.0, 0.0, 50.0, at_ms) for n in (1, 2)))
    looked = [(i.EntityId, i.CurrentTime) for i in sky.got("WellClearViolationIntervals")]
    assert [at for n, at in looked if n == 1] == [0.5, 1.5, 2.5, 3.5]
    assert [at for n, at in looked if n == 2] == [0.0, 1.0, 2.0, 3.0]
