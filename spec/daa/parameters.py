"""Parameters of detect and avoid: the contents of a configuration, in SI units.

Names are those of DAIDALUS configurations (the key, then the unit); `KEYS` gives for each its unit in files, its
default and its range. Alerters are lists of levels, from least to most severe. Older names of keys are in
`OLD_NAMES`. Sources: RTCA DO-365B; the DAIDALUS v2 reference manual.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import NamedTuple

KNOT = 1852.0 / 3600.0
FOOT = 0.3048
NMI = 1852.0
G_M_S2 = 9.80665
DEG = math.pi / 180.0

UNITS: dict[str, tuple[str, float]] = {
    "s": ("s", 1.0), "ms": ("s", 0.001), "min": ("s", 60.0), "h": ("s", 3600.0),
    "m": ("m", 1.0), "km": ("m", 1000.0), "nmi": ("m", NMI), "ft": ("m", FOOT),
    "m/s": ("m_s", 1.0), "mps": ("m_s", 1.0), "knot": ("m_s", KNOT), "knots": ("m_s", KNOT),
    "kn": ("m_s", KNOT), "kph": ("m_s", 1.0 / 3.6), "km/h": ("m_s", 1.0 / 3.6),
    "fpm": ("m_s", FOOT / 60.0), "ft/min": ("m_s", FOOT / 60.0), "fps": ("m_s", FOOT),
    "m/s^2": ("m_s2", 1.0), "mps2": ("m_s2", 1.0), "G": ("m_s2", G_M_S2),
    "rad": ("rad", 1.0), "deg": ("rad", DEG),
    "rad/s": ("rad_s", 1.0), "deg/s": ("rad_s", DEG),
}  # fmt: skip
"""Unit names in files: their dimension (the suffix of names here), and their size in SI."""

NONE, FAR, MID, NEAR, RECOVERY = 0, 1, 2, 3, 4
REGIONS = ("NONE", "FAR", "MID", "NEAR", "RECOVERY")
"""Regions by severity; RECOVERY is used only for bands."""

TAUMOD, TCPA, TEP, CYLINDER, TAUMOD_SUM, TCAS = 0, 1, 2, 3, 4, 5
DETECTORS = ("WCV_TAUMOD", "WCV_TCPA", "WCV_TEP", "CDCylinder", "WCV_TAUMOD_SUM", "TCAS3D")
"""Kinds of volumes, by their names in files."""

NOBODY, FIXED, DCPA = 0, 1, 2
URGENCIES = ("none", "fixed", "dcpa")
"""Urgency strategies: how the most urgent intruder, with whom to coordinate, is chosen."""

NMAC_RADIUS_M, NMAC_HALF_HEIGHT_M = 500 * FOOT, 100 * FOOT
"""The cylinder that decides sides and urgency: the same for all aircraft, whatever their parameters, so that their
choices are compatible. Source: RTCA SC-147.
"""


class Volume(NamedTuple):
    """A volume that is to be kept clear: kind (`DETECTORS`) and thresholds.

    A cylinder has radius dthr_m and half height zthr_m, and no times. TCAS takes its thresholds
    from the table of sensitivity levels.
    """

    kind: int
    dthr_m: float
    zthr_m: float
    tthr_s: float = 0.0
    tcoa_s: float = 0.0
    vmod_s: float = 0.0


class Spread(NamedTuple):
    """How far from the present value a manoeuvre is examined for alerts; 0: not at all."""

    hdir_rad: float = 0.0
    hs_m_s: float = 0.0
    vs_m_s: float = 0.0
    alt_m: float = 0.0


class Level(NamedTuple):
    """One alert level: its volume, the lead times that raise and that keep the alert [s], and the region in which it
    shows in bands.
    """

    detector: str
    volume: Volume
    alerting_time_s: float
    early_alerting_time_s: float
    region: int
    spread: Spread = Spread()


class Alerter(NamedTuple):
    """A named list of levels, least severe first; level numbers begin at 1."""

    name: str
    levels: tuple[Level, ...]


@dataclass(frozen=True)
class Parameters:
    """All parameters in SI; the defaults are those of a new DAIDALUS without alerters."""

    lookahead_time_s: float = 180.0
    left_hdir_rad: float = math.pi
    right_hdir_rad: float = math.pi
    min_airspeed_m_s: float = 10 * KNOT
    min_hs_m_s: float = 10 * KNOT
    max_hs_m_s: float = 700 * KNOT
    min_vs_m_s: float = -6000 * FOOT / 60
    max_vs_m_s: float = 6000 * FOOT / 60
    min_alt_m: float = 100 * FOOT
    max_alt_m: float = 50000 * FOOT
    below_relative_hs_m_s: float = 0.0
    above_relative_hs_m_s: float = 0.0
    below_relative_vs_m_s: float = 0.0
    above_relative_vs_m_s: float = 0.0
    below_relative_alt_m: float = 0.0
    above_relative_alt_m: float = 0.0
    step_hdir_rad: float = DEG
    step_hs_m_s: float = 5 * KNOT
    step_vs_m_s: float = 100 * FOOT / 60
    step_alt_m: float = 100 * FOOT
    horizontal_accel_m_s2: float = 2.0
    vertical_accel_m_s2: float = 0.25 * G_M_S2
    turn_rate_rad_s: float = 3 * DEG
    bank_angle_rad: float = 0.0
    vertical_rate_m_s: float = 500 * FOOT / 60
    min_horizontal_recovery_m: float = 0.0
    min_vertical_recovery_m: float = 0.0
    recovery_hdir: bool = True
    recovery_hs: bool = True
    recovery_vs: bool = True
    recovery_alt: bool = True
    ca_bands: bool = False
    ca_factor: float = 0.1
    horizontal_nmac_m: float = 500 * FOOT
    vertical_nmac_m: float = 100 * FOOT
    recovery_stability_time_s: float = 3.0
    hysteresis_time_s: float = 0.0
    persistence_time_s: float = 0.0
    bands_persistence: bool = False
    persistence_preferred_hdir_rad: float = 0.0
    persistence_preferred_hs_m_s: float = 0.0
    persistence_preferred_vs_m_s: float = 0.0
    persistence_preferred_alt_m: float = 0.0
    alerting_m: int = 0
    alerting_n: int = 0
    conflict_crit: bool = False
    recovery_crit: bool = False
    urgency_strategy: int = NOBODY
    most_urgent_aircraft: str = ""
    h_pos_z_score: float = 0.0
    h_vel_z_score_min: float = 0.0
    h_vel_z_score_max: float = 0.0
    h_vel_z_distance_m: float = 0.0
    v_pos_z_score: float = 0.0
    v_vel_z_score: float = 0.0
    contour_thr_rad: float = math.pi
    dta_logic: int = 0
    dta_latitude_rad: float = 0.0
    dta_longitude_rad: float = 0.0
    dta_radius_m: float = 0.0
    dta_height_m: float = 0.0
    dta_alerter: int = 0
    hdir_bands_below_min_as: int = 0
    ownship_centric_alerting: bool = True
    bands_add_time_to_maneuver: bool = False
    corrective_region: int = NEAR
    alerters: tuple[Alerter, ...] = ()


class Key(NamedTuple):
    """A configuration key: its field, the unit in which it is written, and its permitted values."""

    name: str
    field: str
    kind: str
    unit: str
    low: float
    high: float


_SUFFIXES = ("_m_s2", "_rad_s", "_m_s", "_rad", "_m", "_s")
_UNIT_OF = {
    "_m_s2": "m/s^2",
    "_rad_s": "deg/s",
    "_m_s": "knot",
    "_rad": "deg",
    "_m": "ft",
    "_s": "s",
}
_NMI = {"min_horizontal_recovery", "h_vel_z_distance", "dta_radius"}
_POSITIVE = {"step_hdir", "step_hs", "step_vs", "step_alt", "lookahead_time"}
_RANGES = {
    "left_hdir": (0.0, math.pi), "right_hdir": (0.0, math.pi), "ca_factor": (0.0, 1.0),
    "bank_angle": (0.0, math.pi / 2), "dta_logic": (-1, 1), "hdir_bands_below_min_as": (-1, 1),
    "dta_latitude": (-math.pi / 2, math.pi / 2), "dta_longitude": (-math.pi, math.pi),
    "contour_thr": (0.0, math.pi),
}  # fmt: skip
_SIGNED = {"min_vs", "max_vs", "min_alt", "max_alt", "min_hs"}


def _key(field: str, value: object) -> Key:
    if field == "corrective_region":
        return Key(field, field, "region", "", FAR, NEAR)
    if field == "urgency_strategy":
        return Key(field, field, "urgency", "", NOBODY, DCPA)
    if isinstance(value, str):
        return Key(field, field, "id", "", 0, 0)
    if isinstance(value, bool):
        return Key(field, field, "bool", "", 0, 1)
    if isinstance(value, int):
        low, high = _RANGES.get(field, (0, 1000))
        return Key(field, field, "int", "", low, high)
    suffix = next((s for s in _SUFFIXES if field.endswith(s)), "")
    if field.startswith("h_vel_z_score") or field == "ca_factor":
        suffix = ""
    name = field.removesuffix(suffix) if suffix else field
    unit = _UNIT_OF.get(suffix, "")
    if name in _NMI:
        unit = "nmi"
    if suffix == "_m_s" and ("vs" in name.split("_") or name == "vertical_rate"):
        unit = "fpm"
    if name == "vertical_accel":
        unit = "G"
    low, high = _RANGES.get(name, (0.0, math.inf))
    if name in _SIGNED or "relative" in name:
        low = -math.inf
    if name in _POSITIVE:
        low = math.nextafter(0.0, 1.0)
    return Key(name, field, "float", unit, low, high)


KEYS: dict[str, Key] = {
    key.name: key
    for key in (_key(f.name, f.default) for f in fields(Parameters) if f.name != "alerters")
}
"""All keys except those of alerters, by name."""

OLD_NAMES = {
    "left_trk": "left_hdir", "right_trk": "right_hdir", "min_gs": "min_hs", "max_gs": "max_hs",
    "trk_step": "step_hdir", "gs_step": "step_hs", "vs_step": "step_vs", "alt_step": "step_alt",
    "recovery_trk": "recovery_hdir", "recovery_gs": "recovery_hs",
    "resolution_hysteresis_time": "hysteresis_time",
    "max_delta_resolution_hdir": "persistence_preferred_hdir",
    "max_delta_resolution_hs": "persistence_preferred_hs",
    "max_delta_resolution_vs": "persistence_preferred_vs",
    "max_delta_resolution_alt": "persistence_preferred_alt",
}  # fmt: skip
"""Key names used by older configurations."""


class SensitivityLevel(NamedTuple):
    """TCAS II resolution-advisory thresholds up to and including an altitude [m]."""

    below_m: float
    tau_s: float
    dmod_m: float
    zthr_m: float
    hmd_m: float


TCAS_LEVELS = (
    SensitivityLevel(1000 * FOOT, 0.0, 0.0, 0.0, 0.0),
    SensitivityLevel(2350 * FOOT, 15.0, 0.20 * NMI, 600 * FOOT, 1215 * FOOT),
    SensitivityLevel(5000 * FOOT, 20.0, 0.35 * NMI, 600 * FOOT, 2126 * FOOT),
    SensitivityLevel(10000 * FOOT, 25.0, 0.55 * NMI, 600 * FOOT, 3342 * FOOT),
    SensitivityLevel(20000 * FOOT, 30.0, 0.80 * NMI, 600 * FOOT, 4861 * FOOT),
    SensitivityLevel(42000 * FOOT, 35.0, 1.10 * NMI, 700 * FOOT, 6683 * FOOT),
    SensitivityLevel(math.inf, 35.0, 1.10 * NMI, 800 * FOOT, 6683 * FOOT),
)
"""Source: RTCA DO-185B; below 1,000 ft (level 2) there is no resolution advisory."""


def sensitivity(alt_m: float) -> SensitivityLevel:
    """The TCAS II sensitivity level at an altitude [m]."""
    return next(level for level in TCAS_LEVELS if alt_m <= level.below_m)
