"""Persistence and hysteresis of alerts and bands in flight. Defaults: the preset `do_365b`, with `recovery_crit`."""

from __future__ import annotations

from dataclasses import dataclass

KNOT, FOOT = 1852.0 / 3600.0, 0.3048
"""One knot [m/s] and one foot [m]."""


@dataclass(frozen=True)
class Guidance:
    """alerting_m, alerting_n: a level is shown if found in alerting_m of the last alerting_n evaluations, 1 s apart.
    hysteresis_s: time for which a shown level or band stays. With bands_persistence, a preferred resolution is held for
    persistence_s, and unless another one differs by more than preferred_heading_deg, preferred_speed_m_s,
    preferred_climb_m_s or preferred_alt_m. recovery_shrinks: if no recovery keeps the cylinder, one is searched with a
    cylinder smaller by the share recovery_factor. recovery_stable_s: recovery is shown this much after the earliest
    time at which it is possible. conflict_crit, recovery_crit: conflict bands, or recovery bands, keep to the side that
    both aircraft choose (coordination).
    """

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
