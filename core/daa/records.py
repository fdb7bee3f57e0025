"""Input records of the guidance drivers: manoeuvres of a dimension, intruders, volumes, times.

Records of arrays; machine code takes a record as its fields one by one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cratous.core.kernel import Vec2


class Manoeuvres(NamedTuple):
    """The manoeuvres of one dimension that are examined.

    right, left: (K + 1, 11) positions [m] and velocities [m/s] at the steps to each side, the velocity east and north
    before the manoeuvre, and the mean velocity from the step to the next one; row 0 is the state now; step_s: time
    from step to step, 0: at once; piece_s: for how long a segment is checked, step_s, or 0 to sample the path at the
    steps; targets: altitudes [m], empty in other dimensions; rate_m_s, accel_m_s2: of climbs, 0: at once; sample_s:
    sampling interval of changes of altitude while the vertical speed changes.
    """

    right: np.ndarray
    left: np.ndarray
    step_s: float
    piece_s: float
    targets: np.ndarray
    rate_m_s: float
    accel_m_s2: float
    sample_s: float


class Intruders(NamedTuple):
    """Intruders and the volume about each.

    states: (n, 6) now; kinds: (n), volumes: (n, 11) as in `core.daa.uncertainty.lost`; horizons: (n)
    [s]; sides: (n, 2) that the manoeuvre has to keep to, horizontal and vertical, 0: none.
    """

    states: np.ndarray
    kinds: np.ndarray
    volumes: np.ndarray
    horizons: np.ndarray
    sides: np.ndarray


class Regaining(NamedTuple):
    """If recovering, the cylinder (radius_m, half_m) is to be kept clear before begin_s [s], and the
    volumes from then on; begin_s 0: the volumes at all times."""

    begin_s: float
    radius_m: float
    half_m: float
    recovering: bool


class Looking(NamedTuple):
    """The extent and detail of the examination.

    counted: the time of a manoeuvre counts towards the horizon; project_s: the manoeuvre begins after this much
    straight flight; early: stop as soon as a safe value is known; single: one safe value is enough, not two
    neighbours.
    """

    lookahead_s: float
    counted: bool
    project_s: float
    early: bool
    single: bool


class Looked(NamedTuple):
    """The time interval in which a change of altitude is checked [s]; whole: until_s applies to all phases (the
    recovery cylinder), else it counts from the end of each phase's manoeuvre unless counted.
    """

    from_s: float
    until_s: float
    whole: bool


class Regions(NamedTuple):
    """Intruders by region (row 1 FAR, 2 MID, 3 NEAR).

    states: (n, 6) now; mapped, conflict: (4, n); kinds, alerting_s: (4, n); volumes: (4, n, 11); sides,
    recovery_sides: (n, 2) to keep to in conflict and recovery bands, 0: none.
    """

    states: np.ndarray
    mapped: np.ndarray
    conflict: np.ndarray
    kinds: np.ndarray
    volumes: np.ndarray
    alerting_s: np.ndarray
    sides: np.ndarray
    recovery_sides: np.ndarray


class RecoverySizes(NamedTuple):
    """The cylinder to keep clear until recovery, the NMAC cylinder down to which it is reduced if shrinking, by
    `factor` each time; stability_s: how long after the earliest time recovery is shown.
    """

    radius_m: float
    half_m: float
    nmac_m: float
    nmac_half_m: float
    shrinking: bool
    factor: float
    stability_s: float


class Guided(NamedTuple):
    """The guidance found, written in place.

    safe_r, safe_l: (5, K + 1) by region, row 4 for recovery; peripheral: (4, n); recovery: (5,) saturated, time [s],
    times shrunk, radius [m], half height [m]; state: (5,) per region 0 not examined, 1 has safe values, 2 has none;
    [4] 1 if recovery was computed.
    """

    safe_r: np.ndarray
    safe_l: np.ndarray
    peripheral: np.ndarray
    recovery: np.ndarray
    state: np.ndarray


class Tables(NamedTuple):
    """The levels of all alerters as arrays: counts (A), kinds, alerting and early times (A, L),
    volumes (A, L, 5)."""

    counts: np.ndarray
    kinds: np.ndarray
    volumes: np.ndarray
    alerting_s: np.ndarray
    early_s: np.ndarray


class Relative(NamedTuple):
    """Ownship minus intruder: horizontal position and velocity, altitude and climb rate [m, m/s]."""

    s: Vec2
    v: Vec2
    sz: float
    vz: float
