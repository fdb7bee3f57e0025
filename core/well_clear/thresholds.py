"""The thresholds of a well-clear volume, as records."""

from typing import NamedTuple


class StandardThresholds(NamedTuple):
    """Thresholds of the standard's volume (DO-365), by tau_mod and without VMOD, each >= 0.

    dthr_m: horizontal distance [m]; zthr_m: altitude [m]; tthr_s: on tau_mod [s]; tcoa_s: on the time
    to co-altitude [s].
    """

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float


class Thresholds(NamedTuple):
    """Thresholds of a well-clear volume, each >= 0; 0 switches off tthr_s, tcoa_s and vmod_s.

    dthr_m: horizontal distance [m]; zthr_m: altitude [m]; tthr_s: on the volume's time variable [s];
    tcoa_s: on the time to co-altitude [s]; vmod_s: time that the closing climb rate is multiplied
    by [s].
    """

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float
    vmod_s: float
