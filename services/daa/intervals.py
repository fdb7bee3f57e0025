"""WellClearViolationIntervals: a detect-and-avoid result as the message that DAIDALUS's services exchange."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.daa.session import Instant
from cratous.core.daa.state import UNKNOWN, Guidance
from cratous.spec.daa.parameters import FAR, NEAR, RECOVERY, REGIONS

DEGREES = 180 / math.pi
SERIES = {
    "hdir": ("GroundHeadingInterval", "GroundHeadings", "WCVGroundHeadingIntervals",
             "WCVGroundHeadingRegions", "GroundHeadingRecoveryInterval", "RecoveryGroundHeadings",
             "RecoveryGroundHeadingIntervals", DEGREES),
    "hs": ("GroundSpeedInterval", "GroundSpeeds", "WCVGroundSpeedIntervals",
           "WCVGroundSpeedRegions", "GroundSpeedRecoveryInterval", "RecoveryGroundSpeeds",
           "RecoveryGroundSpeedIntervals", 1.0),
    "vs": ("VerticalSpeedInterval", "VerticalSpeeds", "WCVVerticalSpeedIntervals",
           "WCVVerticalSpeedRegions", "VerticalSpeedRecoveryInterval", "RecoveryVerticalSpeed",
           "RecoveryVerticalSpeedIntervals", 1.0),
    "alt": ("AltitudeInterval", "Altitude", "WCVAlitudeIntervals", "WCVAltitudeRegions",
            "AltitudeRecoveryInterval", "RecoveryAltitude", "RecoveryAltitudeIntervals", 1.0),
}  # fmt: skip
"""Per dimension: interval, its field, the lists in the message; the same for recovery; and the unit. The
message spells "Alitude".
"""


class OwnState(NamedTuple):
    """The ownship's state in the message: id, heading [deg], speed and climb [m/s], altitude [m MSL],
    position [deg], time [s].
    """

    id: int
    heading_deg: float
    speed_m_s: float
    climb_m_s: float
    alt_m: float
    latitude_deg: float
    longitude_deg: float
    time_s: float


def interval_fields(g: Guidance) -> dict[str, list[Any]]:
    """The lists of one dimension in WellClearViolationIntervals."""
    interval, field, intervals, regions, recovery, recovery_field, recoveries, size = SERIES[
        g.dimension
    ]
    made: dict[str, list[Any]] = {intervals: [], regions: [], recoveries: []}
    for band in g.bands:
        ends = [max(0.0, band.low * size) if g.dimension == "hdir" else band.low, band.high]
        ends[1] = min(360.0, band.high * size) if g.dimension == "hdir" else band.high
        if band.region == RECOVERY:
            made[recoveries].append(lmcp.new(recovery, **{recovery_field: ends}))
        elif band.region == UNKNOWN or FAR <= band.region <= NEAR:
            made[intervals].append(lmcp.new(interval, **{field: ends}))
            made[regions].append("NEAR" if band.region == UNKNOWN else REGIONS[band.region])
    return made


def intervals_message(own: OwnState, instant: Instant) -> Any:
    """WellClearViolationIntervals: intruders by time to violation, then the bands."""
    found = []
    for alert in instant.alerts:
        first = alert.to_corrective_s
        if first is None and alert.level:
            first = alert.times[alert.level - 1].first_s
        if first is not None:
            found.append((first, int(alert.id), float(alert.level)))
    found.sort()
    fields: dict[str, Any] = {}
    for g in instant.guidance:
        fields |= interval_fields(g)
    return lmcp.new(
        "WellClearViolationIntervals",
        EntityList=[number for _, number, _ in found],
        TimeToViolationList=[first for first, _, _ in found],
        AlertLevelList=[level for _, _, level in found],
        EntityId=own.id,
        CurrentHeading=own.heading_deg,
        CurrentGoundSpeed=own.speed_m_s,
        CurrentVerticalSpeed=own.climb_m_s,
        CurrentAltitude=own.alt_m,
        CurrentLatitude=own.latitude_deg,
        CurrentLongitude=own.longitude_deg,
        CurrentTime=own.time_s,
        **fields,
    )
