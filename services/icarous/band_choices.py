"""Manoeuvres that the bands propose: resolutions, and recoveries where no manoeuvre keeps well clear.

Each lies one step of the bands beyond the edge of a band, the preferred side first: another direction,
another speed, or a climb or descent to another altitude within the airframe's ability. `core.avoidance` and
the permit decide which is flown, with the known routes and zones, which the bands do not consider.
"""

from __future__ import annotations

import math

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.resolution import Choice
from cratous.core.daa.state import ALT, HDIR, HS
from cratous.services.icarous.band_history import Bands
from cratous.services.icarous.bands import STEP_DEG, STEPS, reach_m, steered_by, values
from cratous.services.icarous.messages import Sensed
from cratous.spec.daa.parameters import DEG
from cratous.spec.mission import Daa


def of_bands(bands: Bands, daa: Daa, sensed: Sensed, level: Choice) -> tuple[Choice, ...]:
    """Resolutions of the kind that the mission prefers, on the heading of `level`; none where it prefers
    turns.
    """
    return tuple(
        one
        for dimension in steered_by(daa)
        if dimension != HDIR
        for one in _choices(bands, dimension, daa, sensed, level)
    )


def recovering(bands: Bands, daa: Daa, sensed: Sensed, level: Choice) -> tuple[Choice, ...]:
    """Resolutions that regain well clear, for kinds of manoeuvre without a conflict-free one; the kind preferred by
    the mission first."""
    return tuple(
        one
        for dimension in steered_by(daa)
        if dimension in bands.recovers
        for one in _choices(bands, dimension, daa, sensed, level)
    )


def _choices(
    bands: Bands, dimension: int, daa: Daa, sensed: Sensed, level: Choice
) -> tuple[Choice, ...]:
    ability = sensed.ability
    if dimension == HDIR:
        turned = values(bands, HDIR, STEP_DEG * DEG)
        return tuple(level._replace(heading_rad=heading) for heading in turned)
    if dimension == HS:
        low, high = ability.min_speed_m_s, ability.max_speed_m_s
        speeds = values(bands, HS, (high - low) / STEPS)
        return tuple(
            level._replace(kind="speed", speed_m_s=min(max(one, low), high)) for one in speeds
        )
    heights = values(bands, ALT, 2 * reach_m(daa, ability) / STEPS)
    return tuple(
        _climb(sensed.motion, ability, max(one, ability.floor_m), level) for one in heights
    )


def _climb(motion: Motion, ability: Ability, alt_m: float, level: Choice) -> Choice:
    """A climb or descent to an altitude at the airframe's greatest rate."""
    rise_m, most = alt_m - motion.position.alt_m, ability.max_climb_m_s
    climb = math.copysign(most, rise_m)
    return level._replace(kind="altitude", climb_m_s=climb, climb_for_s=abs(rise_m) / most)
