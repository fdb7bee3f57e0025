"""How alerts and bands of a flight follow one another in time. Defaults: RTCA DO-365B."""

from __future__ import annotations

from dataclasses import dataclass

KNOT, FOOT = 1852.0 / 3600.0, 0.3048
"""In m/s, and in m."""


@dataclass(frozen=True)
class Guidance:
    """alerting_m, alerting_n: a level is shown once it was found in so many of the last so many looks, a second apart;
    hysteresis_s: a level or band that was shown stays for so long; persistence_s, and the preferred changes: the side that is
    preferred is held for so long, and unless another one differs by more, with bands_persistence; recovery_shrinks: where
    recovery keeps no cylinder it is looked for with one that is smaller by recovery_factor of it, and it is shown
    recovery_stable_s after the earliest time; conflict_crit, recovery_crit: bands of conflict, of recovery keep to the side that both choose."""

    alerting_m: int = 2
    alerting_n: int = 4
    hysteresis_s: float = 5.0
    persistence_s: float = 4.0
    bands_persistence: bool = True
    preferred_heading_deg: float = 15.0
    preferred_speed_m_s: float = 100 * KNOT
    preferred_climb_m_s: float = 250 * FOOT / 60
    preferred_alt_m: float = 250 * FOOT
    recovery_shrinks: bool = True
    recovery_factor: float = 0.1
    recovery_stable_s: float = 3.0
    conflict_crit: bool = False
    recovery_crit: bool = True
