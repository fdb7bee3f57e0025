"""Attributes of DAIDALUS_WCV_Detection, the DAA parameters they define, and the message that
reports them.

Names, units and defaults are those of OpenUxAS. Values that OpenUxAS drops silently because they
are inconsistent are refused. `Configuration` is an extension: a preset or a .conf file, which
attributes then modify.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.loading.uxas_settings import Attr, Entry, choice, flag, number, whole
from cratous.spec.daa.parameters import (
    DEG,
    DETECTORS,
    FAR,
    G_M_S2,
    MID,
    NEAR,
    NONE,
    Alerter,
    Level,
    Parameters,
    Volume,
)
from cratous.spec.daa.presets import named_or_file
from cratous.spec.errors import BadInput

CONFIGURATION = "Configuration"
TINY = 1e-6


class Told(NamedTuple):
    """An attribute: how it is read, the field of `Parameters`, its scale there, and the message's field."""

    attr: Attr
    field: str
    size: float = 1.0
    sent: str = ""


FOOT = 0.3048
PARTS: dict[str, Told] = {
    "LookAheadTime": Told(number(180.0, TINY), "lookahead_time_s"),
    "LeftTrack": Told(number(180.0, 0.0, 180.0), "left_hdir_rad", DEG),
    "RightTrack": Told(number(180.0, 0.0, 180.0), "right_hdir_rad", DEG),
    "MinGroundSpeed": Told(number(5.1444), "min_hs_m_s"),
    "MaxGroundSpeed": Told(number(360.111), "max_hs_m_s"),
    "MinVerticalSpeed": Told(number(-30.48, None), "min_vs_m_s"),
    "MaxVerticalSpeed": Told(number(30.48, None), "max_vs_m_s"),
    "MinAltitude": Told(number(100 * FOOT, None), "min_alt_m"),
    "MaxAltitude": Told(number(50000 * FOOT, None), "max_alt_m"),
    "TrackStep": Told(number(1.0, TINY), "step_hdir_rad", DEG),
    "GroundSpeedStep": Told(number(2.57222, TINY), "step_hs_m_s"),
    "VerticalSpeedStep": Told(number(100 * FOOT / 60, TINY), "step_vs_m_s"),
    "AltitudeStep": Told(number(100 * FOOT, TINY), "step_alt_m"),
    "HorizontalAcceleration": Told(number(0.0), "horizontal_accel_m_s2"),
    "VerticalAcceleration": Told(number(0.0), "vertical_accel_m_s2", G_M_S2),
    "TurnRate": Told(number(0.0), "turn_rate_rad_s", DEG),
    "BankAngle": Told(number(0.0, 0.0, 89.0), "bank_angle_rad", DEG),
    "VerticalRate": Told(number(0.0), "vertical_rate_m_s"),
    "RecoveryStabilityTime": Told(number(0.0), "recovery_stability_time_s"),
    "MinHorizontalRecovery": Told(number(1222.32), "min_horizontal_recovery_m"),
    "MinVerticalRecovery": Told(number(450 * FOOT), "min_vertical_recovery_m"),
    "isRecoveryTrack": Told(flag(True), "recovery_hdir", sent="isRecoveryTrackBands"),
    "isRecoveryGroundSpeed": Told(flag(True), "recovery_hs", sent="isRecoveryGroundSpeedBands"),
    "isRecoveryVerticalSpeed": Told(flag(True), "recovery_vs", sent="isRecoveryVerticalSpeedBands"),
    "isRecoveryAltitude": Told(flag(True), "recovery_alt", sent="isRecoveryAltitudeBands"),
    "isCollisionAvoidance": Told(flag(False), "ca_bands", sent="isCollisionAvoidanceBands"),
    "CollisionAvoidanceFactor": Told(
        number(0.2, TINY, 1 - TINY), "ca_factor", sent="CollisionAvoidanceBandsFactor"
    ),
    "HorizontalNMAC": Told(number(500 * FOOT), "horizontal_nmac_m"),
    "VerticalNMAC": Told(number(100 * FOOT), "vertical_nmac_m"),
    "HorizontalContourThreshold": Told(number(180.0, 0.0, 180.0), "contour_thr_rad", DEG),
}
"""Attributes that correspond to one parameter each."""

ALERTING: dict[str, Attr] = {
    "TTHR": number(35.0),
    "RTCAAlertLevels": whole(3, 1, 3),
    "AlertTime1": number(180.0),
    "EarlyAlertTime1": number(200.0),
    "AlertTime2": number(55.0),
    "EarlyAlertTime2": number(75.0),
    "AlertTime3": number(25.0),
    "EarlyAlertTime3": number(55.0),
    "HorizontalDetectionType": choice("TAUMOD", "TAUMOD", "TCPA", "TEP"),
}
"""Attributes that define the alerter: one volume, three levels."""

ATTRIBUTES: dict[str, Attr] = {
    "VehicleID": whole(-1, -1),
    CONFIGURATION: Attr(),
    **{name: part.attr for name, part in PARTS.items()},
    **ALERTING,
}

ORDERED = (
    ("MinGroundSpeed", "MaxGroundSpeed"),
    ("MinVerticalSpeed", "MaxVerticalSpeed"),
    ("MinAltitude", "MaxAltitude"),
    ("HorizontalNMAC", "MinHorizontalRecovery"),
    ("VerticalNMAC", "MinVerticalRecovery"),
    ("AlertTime1", "EarlyAlertTime1"),
    ("AlertTime2", "EarlyAlertTime2"),
    ("AlertTime3", "EarlyAlertTime3"),
    ("AlertTime3", "AlertTime2"),
    ("AlertTime2", "AlertTime1"),
)
"""Pairs whose first value must not exceed the second; ranges must not be empty."""
STRICT = 3


def parameters_of(entry: Entry, values: Mapping[str, Any]) -> Parameters:
    """The parameters from a service's attributes; BadInput for inconsistent values."""
    if values[CONFIGURATION]:
        return _changed(entry, values)
    for k, (low, high) in enumerate(ORDERED):
        if values[low] > values[high] or (k < STRICT and values[low] == values[high]):
            _refuse(entry, low, f"at most {high} = {values[high]:g}", f"{values[low]:g}")
    if values["TurnRate"] and values["BankAngle"]:
        _refuse(
            entry, "BankAngle", "TurnRate or BankAngle, the other one 0", f"{values['BankAngle']:g}"
        )
    fields = {part.field: values[name] * part.size for name, part in PARTS.items()}
    flags = {part.field: values[name] for name, part in PARTS.items() if part.attr.kind == "flag"}
    levels = values["RTCAAlertLevels"]
    return Parameters(
        **{**fields, **flags},
        corrective_region=NEAR + 1 - levels,
        alerters=(_alerter(values, levels),),
    )


def _alerter(v: Mapping[str, Any], levels: int) -> Alerter:
    """An alerter with three levels of one volume; bands are computed for the `levels` most severe ones."""
    kind = DETECTORS.index(f"WCV_{v['HorizontalDetectionType']}")
    volume = Volume(kind, v["MinHorizontalRecovery"], v["MinVerticalRecovery"], v["TTHR"])
    return Alerter(
        "OpenUxAS",
        tuple(
            Level(
                "det_1",
                volume,
                v[f"AlertTime{n}"],
                v[f"EarlyAlertTime{n}"],
                region if n > 3 - levels else NONE,
            )
            for n, region in ((1, FAR), (2, MID), (3, NEAR))
        ),
    )


def _changed(entry: Entry, values: Mapping[str, Any]) -> Parameters:
    """A DAIDALUS configuration modified by the given attributes; its alerters are kept."""
    given = [name for name in entry.attributes if name in ALERTING]
    if given:
        _refuse(entry, given[0], f"alerters from {CONFIGURATION} alone", values[CONFIGURATION])
    name = values[CONFIGURATION]
    folder = Path(entry.where.rpartition(":")[0] or ".").parent
    try:
        found = named_or_file(str(folder / name) if (folder / name).is_file() else name).parameters
    except BadInput as error:
        at = error.where or entry.where
        item = error.item if error.where else f"{entry.type}.{CONFIGURATION}"
        raise BadInput(
            error.what, where=at, item=item, expected=error.expected, got=error.got or name
        ) from error
    changes = {
        part.field: values[name] if part.attr.kind == "flag" else values[name] * part.size
        for name, part in PARTS.items()
        if name in entry.attributes
    }
    made = replace(found, **changes)
    from cratous.spec.daa.consistency import check

    check(made, entry.where)
    if not made.alerters or not made.alerters[0].levels:
        _refuse(entry, CONFIGURATION, "a configuration with an alerter", name)
    return made


def _refuse(entry: Entry, item: str, expected: str, got: str) -> None:
    raise entry.refusal("values do not fit together", item, expected, got)


def configuration_message(vehicle: int, p: Parameters) -> Any:
    """DAIDALUSConfiguration with the parameters in use, in the message's units. Levels are those of
    the first alerter, the volume that of its most severe level; CollisionAvoidanceBandsFactor is a
    flag there.
    """
    fields = {
        part.sent or name: getattr(p, part.field) / part.size
        for name, part in PARTS.items()
        if part.attr.kind != "flag"
    }
    fields |= {
        part.sent: getattr(p, part.field) for part in PARTS.values() if part.attr.kind == "flag"
    }
    fields["CollisionAvoidanceBandsFactor"] = bool(p.ca_factor)
    levels = p.alerters[0].levels
    volume = levels[-1].volume
    for n, level in zip((3, 2, 1), reversed(levels), strict=False):
        fields[f"AlertTime{n}"] = level.alerting_time_s
        fields[f"EarlyAlertTime{n}"] = level.early_alerting_time_s
    return lmcp.new(
        "DAIDALUSConfiguration",
        EntityId=vehicle,
        **fields,
        DTHR=volume.dthr_m,
        ZTHR=volume.zthr_m,
        TTHR=volume.tthr_s,
        RTCAAlertLevels=sum(level.region != NONE for level in levels),
        HorizontalDetectionType=DETECTORS[volume.kind].removeprefix("WCV_"),
    )


def turn_rate_deg_s(p: Any, speed: float) -> float:
    """Turn rate in a DAIDALUSConfiguration at a speed [m/s]; 0 for instantaneous turns [deg/s]."""
    if p.TurnRate or not p.BankAngle or not speed:
        return float(p.TurnRate)
    return math.degrees(G_M_S2 * math.tan(math.radians(p.BankAngle)) / speed)
