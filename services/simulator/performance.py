"""Airframe performance: the flight profiles of its configuration, interpolated as in AMASE.

A profile holds for one airspeed and vertical speed. Level flight interpolates the level profiles over
airspeed; climbs and descents blend that with the least steep profile that is steeper than commanded.
"""

from __future__ import annotations

from math import isfinite
from typing import Any, NamedTuple

from cratous.spec.errors import BadInput

LEVEL_M_S = 0.01
"""A vertical speed below this counts as level flight."""


class Profile(NamedTuple):
    """Airspeed and vertical speed [m/s], pitch and greatest bank [deg], energy use [% / s]."""

    airspeed_m_s: float
    vertical_m_s: float
    pitch_deg: float
    max_bank_deg: float
    energy_percent_s: float


class Airframe(NamedTuple):
    """Speeds [m/s]; level profiles by airspeed, climbs and descents in order of steepness; the steepest of
    each (the nominal profile if there is none). compatible: AMASE's defects are reproduced.
    """

    min_speed_m_s: float
    max_speed_m_s: float
    levels: tuple[Profile, ...]
    climbs: tuple[Profile, ...]
    descents: tuple[Profile, ...]
    steepest_climb: Profile
    steepest_descent: Profile
    compatible: bool

    def within(self, speed_m_s: float) -> float:
        """The closest airspeed within its limits [m/s]."""
        return max(self.min_speed_m_s, min(self.max_speed_m_s, speed_m_s))


def airframe_of(configuration: Any, compatible: bool, where: str = "") -> Airframe:
    """The airframe of an AirVehicleConfiguration; BadInput for one that cannot fly."""
    item = f"AirVehicleConfiguration {configuration.ID}"
    nominal = configuration.NominalFlightProfile
    if nominal is None:
        raise BadInput("no nominal flight profile", where=where, item=item)
    profiles = [_profile(p, where, item) for p in (nominal, *configuration.AlternateFlightProfiles)]
    levels = sorted((p for p in profiles if p.vertical_m_s == 0), key=lambda p: p.airspeed_m_s)
    if not levels:
        raise BadInput(
            "no profile for level flight", where=where, item=item, expected="VerticalSpeed 0 in one"
        )
    low, high = configuration.MinimumSpeed, configuration.MaximumSpeed
    if not 0 <= low <= high or high == 0 or not isfinite(high):
        raise BadInput(
            "wrong speeds [m/s]",
            where=where,
            item=item,
            expected="0 <= MinimumSpeed <= MaximumSpeed, MaximumSpeed > 0",
            got=f"{low:g}, {high:g}",
        )
    climbs = sorted((p for p in profiles if p.vertical_m_s > 0), key=lambda p: p.vertical_m_s)
    descents = sorted((p for p in profiles if p.vertical_m_s < 0), key=lambda p: -p.vertical_m_s)
    return Airframe(
        low,
        high,
        tuple(levels),
        tuple(climbs),
        tuple(descents),
        climbs[-1] if climbs else profiles[0],
        descents[-1] if descents else profiles[0],
        compatible,
    )


def _profile(body: Any, where: str, item: str) -> Profile:
    profile = Profile(
        body.Airspeed, body.VerticalSpeed, body.PitchAngle, body.MaxBankAngle, body.EnergyRate
    )
    if not all(map(isfinite, profile)) or not 0 < profile.max_bank_deg < 90:
        raise BadInput(
            "wrong flight profile",
            where=where,
            item=item,
            expected="finite numbers, MaxBankAngle above 0 and below 90 deg",
            got=f"{body.Name!r}: {tuple(profile)}",
        )
    return profile


def profile_at(airframe: Airframe, speed_m_s: float, vertical_m_s: float) -> Profile:
    """The profile at an airspeed and a commanded vertical speed [m/s]."""
    level = _level(airframe, speed_m_s)
    if abs(vertical_m_s) < LEVEL_M_S:
        return level
    if vertical_m_s > airframe.steepest_climb.vertical_m_s:
        return airframe.steepest_climb
    if vertical_m_s < airframe.steepest_descent.vertical_m_s:
        return airframe.steepest_descent
    for steeper in airframe.climbs if vertical_m_s > 0 else airframe.descents:
        if abs(steeper.vertical_m_s) > abs(vertical_m_s):
            mixed = _between(level, steeper, vertical_m_s / steeper.vertical_m_s)
            return mixed._replace(vertical_m_s=vertical_m_s)
    # exactly as steep as the steepest: AMASE flies level, since its list has nothing steeper
    if airframe.compatible:
        return level
    return airframe.steepest_climb if vertical_m_s > 0 else airframe.steepest_descent


def _level(airframe: Airframe, speed_m_s: float) -> Profile:
    levels = airframe.levels
    if speed_m_s <= levels[0].airspeed_m_s:
        return levels[0]
    if speed_m_s >= levels[-1].airspeed_m_s:
        return levels[-1]
    above = next(k for k, p in enumerate(levels) if p.airspeed_m_s >= speed_m_s)
    low, high = levels[above - 1], levels[above]
    part = (speed_m_s - low.airspeed_m_s) / (high.airspeed_m_s - low.airspeed_m_s)
    mixed = _between(low, high, part)
    # AMASE omits the energy use of level flight between two profiles
    return mixed._replace(energy_percent_s=0.0) if airframe.compatible else mixed


def _between(one: Profile, other: Profile, part: float) -> Profile:
    """Interpolation between two profiles; part 0 is the first, 1 the other."""
    rest = 1 - part
    return Profile(
        rest * one[0] + part * other[0],
        rest * one[1] + part * other[1],
        rest * one[2] + part * other[2],
        rest * one[3] + part * other[3],
        rest * one[4] + part * other[4],
    )
