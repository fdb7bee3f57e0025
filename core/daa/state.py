"""Input and output of detect and avoid: plain data, SI, one local frame.

Positions are metres east, north and up (altitude MSL) in a frame that all aircraft share; velocities are relative to
the air mass, so directions are headings and speeds are airspeeds. Angles are clockwise from north.
"""

from __future__ import annotations

from typing import NamedTuple

HDIR, HS, VS, ALT = 0, 1, 2, 3
DIMENSIONS = ("hdir", "hs", "vs", "alt")
"""Direction, horizontal speed, vertical speed, altitude."""
UNKNOWN = -1
"""Region of values for which no statement is possible, e.g. when the own value is out of range."""


class Sigma(NamedTuple):
    """Standard deviations of a state: east, north, their covariance root, up; position and speed."""

    s_ew_m: float = 0.0
    s_ns_m: float = 0.0
    s_en_m: float = 0.0
    sz_m: float = 0.0
    v_ew_m_s: float = 0.0
    v_ns_m_s: float = 0.0
    v_en_m_s: float = 0.0
    vz_m_s: float = 0.0


class Aircraft(NamedTuple):
    """An aircraft now. alerter: number of its alerter, from 1; 0: none, so that it raises no alert."""

    id: str
    east_m: float
    north_m: float
    alt_m: float
    ve_m_s: float
    vn_m_s: float
    vu_m_s: float
    alerter: int = 1
    sigma: Sigma = Sigma()


class Band(NamedTuple):
    """Values from low to high (rad, m/s or m) and their region (`spec.daa.parameters.REGIONS`, or UNKNOWN)."""

    low: float
    high: float
    region: int


class Recovery(NamedTuple):
    """Whether recovery was needed, and if so how the volume is regained.

    saturated: no manoeuvre keeps even the NMAC cylinder clear; time_s: when the volume is regained; shrunk: how often
    the cylinder was reduced; its size then.
    """

    computed: bool = False
    saturated: bool = False
    time_s: float | None = None
    shrunk: int = 0
    radius_m: float | None = None
    half_height_m: float | None = None


class Guidance(NamedTuple):
    """Bands of one dimension and what follows from them.

    own: present value; region: of the present value; up, down: nearest value that resolves to the right or up and to
    the left or down, None if there is none on that side or none is needed; prefer_up: which of them is nearer;
    needed: whether the present value is in conflict; why: why there are no bands; peripheral: per region, the
    intruders with which some manoeuvre conflicts.
    """

    dimension: str
    own: float
    bands: tuple[Band, ...]
    region: int
    needed: bool
    up: float | None
    down: float | None
    prefer_up: bool
    recovery: Recovery
    peripheral: dict[int, tuple[str, ...]]
    why: str = ""


class Coordination(NamedTuple):
    """Implicit coordination with the most urgent intruder: its id; horizontal: 1 if it is to be passed on the right
    of the relative flight path, -1 on the left; vertical: 1 above it, -1 below it.
    """

    id: str
    horizontal: int
    vertical: int


class LevelTimes(NamedTuple):
    """First and last time within the look-ahead at which a level's volume is violated [s]."""

    first_s: float | None
    last_s: float | None


class Alert(NamedTuple):
    """The alert about one intruder: level shown (0: none), level now without history, times per
    level, and time to the corrective volume [s]."""

    id: str
    alerter: int
    level: int
    raw: int
    times: tuple[LevelTimes, ...]
    to_corrective_s: float | None
    region: int


class Metrics(NamedTuple):
    """Separation and closest approach of one intruder; None where not defined."""

    id: str
    hsep_m: float
    vsep_m: float
    hclose_m_s: float
    vclose_m_s: float
    tcpa_s: float
    dcpa_m: float
    hmd_m: float
    vmd_m: float
    tcoa_s: float | None
    tau_mod_s: float | None
