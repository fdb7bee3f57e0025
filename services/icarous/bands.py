"""Alerts and bands of a vehicle in flight: predicted losses of well clear and the manoeuvres that avoid them.

Once a second, while a loss of well clear is predicted or ICAROUS flies, the proved detect-and-avoid engine
(`core.daa.session`) evaluates the present motion and all traffic in straight flight. Two levels: corrective
(MID) is the mission's buffered volume within the look-ahead; warning (NEAR) is the unbuffered volume within
the time at which even the vehicle with the right of way acts. M of N, hysteresis, persistence and recovery
follow the mission's `daa.guidance`, by default the preset `do_365b` with `recovery_crit`. An intruder known only
within bounds is evaluated with the SUM volume, with the bounds as deviations. Directions and speeds are over
ground. Zones and announced routes are not considered here: `core.avoidance` and the permit decide what is flown.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import Ability, Motion, smallest_turn, velocity_of
from cratous.core.avoidance.prediction import EXACT, Intruder, buffered
from cratous.core.daa.history import Shown
from cratous.core.daa.persistence import Held
from cratous.core.daa.session import Instant, Session
from cratous.core.daa.state import ALT, HDIR, HS, VS, Aircraft, Sigma
from cratous.services.icarous.band_history import AlertHistory, Bands, DimensionHistory
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.traffic_monitor import nearest
from cratous.services.mission.guidance import guidance_of
from cratous.spec.daa.parameters import (
    DCPA,
    DEG,
    MID,
    NEAR,
    NMAC_HALF_HEIGHT_M,
    NMAC_RADIUS_M,
    TAUMOD,
    TAUMOD_SUM,
    Alerter,
    Level,
    Parameters,
    Volume,
)
from cratous.spec.mission import (
    Daa,
    Position,
    Resolution,
    Velocity,
    WellClear,
)

PERIOD_MS = 1000
"""Interval of the evaluation [ms]."""
STEP_DEG = 5.0
"""Step of the headings, the same as for manoeuvres [deg]."""
STEPS = 12
"""Number of steps over the range of speeds, climb rates and altitudes."""
HIGHEST_M = 1e5
"""No ceiling: altitudes are bounded by what is reachable within the look-ahead [m MSL]."""
FIRST = {Resolution.ALTITUDE: ALT, Resolution.SPEED: HS}
"""The band dimension of a manoeuvre kind that a mission may prefer."""


class Whose(NamedTuple):
    """Parameters of a vehicle's evaluation: id, volume to keep clear of, heartbeat [ms]. told: the bands are
    recorded, so all dimensions are evaluated, not only those used for manoeuvres.
    """

    vehicle_id: int
    daa: Daa
    heartbeat_ms: int
    told: bool


def parameters_of(whose: Whose, ability: Ability, sum_volumes: bool) -> Parameters:
    """The parameters of detect and avoid. sum_volumes: whether an intruder is known only within bounds."""
    daa, heartbeat_ms = whose.daa, whose.heartbeat_ms
    own, kind = daa.well_clear, TAUMOD_SUM if sum_volumes else TAUMOD
    wide = buffered(own, daa.buffer)
    acts_s = nearest(ability, wide, heartbeat_ms).last_s
    climb, reach = ability.max_climb_m_s, reach_m(daa, ability)
    told = guidance_of(own)

    def level(volume: WellClear, time_s: float, region: int) -> Level:
        v = Volume(kind, volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s)
        return Level("mission", v, time_s, time_s, region)

    within_s = min(acts_s, daa.lookahead_s)
    levels = (level(wide, daa.lookahead_s, MID), level(own, within_s, NEAR))
    return Parameters(
        lookahead_time_s=daa.lookahead_s,
        min_airspeed_m_s=ability.min_speed_m_s,
        min_hs_m_s=ability.min_speed_m_s,
        max_hs_m_s=ability.max_speed_m_s,
        min_vs_m_s=-climb,
        max_vs_m_s=climb,
        min_alt_m=ability.floor_m,
        max_alt_m=HIGHEST_M,
        below_relative_alt_m=reach,
        above_relative_alt_m=reach,
        step_hdir_rad=STEP_DEG * DEG,
        step_hs_m_s=(ability.max_speed_m_s - ability.min_speed_m_s) / STEPS,
        step_vs_m_s=2 * climb / STEPS,
        step_alt_m=2 * reach / STEPS,
        horizontal_accel_m_s2=ability.acceleration_m_s2,
        vertical_accel_m_s2=0.0,
        turn_rate_rad_s=ability.turn_rate_rad_s,
        vertical_rate_m_s=climb,
        min_horizontal_recovery_m=own.dthr_m,
        min_vertical_recovery_m=own.zthr_m,
        ca_bands=told.recovery_shrinks,
        ca_factor=told.recovery_factor,
        horizontal_nmac_m=min(NMAC_RADIUS_M, own.dthr_m),
        vertical_nmac_m=min(NMAC_HALF_HEIGHT_M, own.zthr_m),
        recovery_stability_time_s=told.recovery_stable_s,
        hysteresis_time_s=told.hysteresis_s,
        persistence_time_s=told.persistence_s,
        bands_persistence=told.bands_persistence,
        persistence_preferred_hdir_rad=told.preferred_heading_deg * DEG,
        persistence_preferred_hs_m_s=told.preferred_speed_m_s,
        persistence_preferred_vs_m_s=told.preferred_climb_m_s,
        persistence_preferred_alt_m=told.preferred_alt_m,
        alerting_m=told.alerting_m,
        alerting_n=told.alerting_n,
        conflict_crit=told.conflict_crit,
        recovery_crit=told.recovery_crit,
        urgency_strategy=DCPA,
        h_pos_z_score=1.0,
        h_vel_z_score_min=1.0,
        h_vel_z_score_max=1.0,
        v_pos_z_score=1.0,
        v_vel_z_score=1.0,
        corrective_region=MID,
        alerters=(Alerter("mission", levels),),
    )


def reach_m(daa: Daa, ability: Ability) -> float:
    """Altitude range evaluated above and below the vehicle [m]."""
    return max(ability.max_climb_m_s * daa.lookahead_s, daa.well_clear.zthr_m)


def watched(
    whose: Whose, before: Bands | None, sensed: Sensed
) -> tuple[Bands | None, Instant | None]:
    """The history, and the result if an evaluation was due.

    The history is returned unchanged within PERIOD_MS of the last evaluation, and is None while there are no
    intruders.
    """
    if before is not None and not lasted(before.at_ms, sensed.now_ms, PERIOD_MS):
        return before, None
    if not sensed.intruders:
        return None, None
    loose = any(other.spread != EXACT for other in sensed.intruders)
    session = Session(parameters_of(whose, sensed.ability, loose))
    if before is not None and (before.ability, before.loose) == (sensed.ability, loose):
        _remember(session, before)
    own = _own(whose.vehicle_id, sensed.motion)
    others = [_other(one) for one in sensed.intruders]
    dimensions, steered = _dimensions(sensed.ability), steered_by(whose.daa)
    dimensions = [d for d in dimensions if whose.told or d in steered]
    instant = session.step(sensed.now_ms / 1000, own, others, dimensions)
    lost = tuple(
        d for d, g in zip(dimensions, instant.guidance, strict=True) if g.recovery.computed
    )
    return _history(session, sensed, loose)._replace(recovers=lost), instant


def steered_by(daa: Daa) -> tuple[int, ...]:
    """The dimensions used for manoeuvres, the one that the mission prefers first."""
    first = FIRST.get(daa.looks_first)
    return (HDIR,) if first is None else (first, HDIR)


def _history(session: Session, sensed: Sensed, loose: bool) -> Bands:
    """The session's history as plain values."""
    alerts = tuple(
        AlertHistory(*key, tuple(one.values), one.level, one.raised_s)
        for key, one in sorted(session.shown.items())
    )
    dimensions = tuple(
        DimensionHistory(
            tuple(bands.last), bands.held, bands.held_s,
            *ways.held, ways.shrunk_up, ways.shrunk_down, ways.since_s,
        )
        for bands, ways in zip(session.bands, session.ways, strict=True)
    )  # fmt: skip
    return Bands(sensed.now_ms, sensed.ability, loose, alerts, dimensions)


def _remember(session: Session, before: Bands) -> None:
    """Restore a session's history from one under the same parameters."""
    p = session.parameters
    session.time_s = before.at_ms / 1000
    for one in before.alerts:
        session.shown[one.intruder, one.alerter] = Shown(
            p.alerting_m, p.alerting_n, deque(one.values), one.level, one.raised_s
        )
    for bands, ways, old in zip(session.bands, session.ways, before.dimensions, strict=True):
        bands.last, bands.held, bands.held_s = deque(old.last), old.held, old.held_s
        ways.held = Held(old.up, old.down, old.prefer_up)
        ways.shrunk_up, ways.shrunk_down = old.shrunk_up, old.shrunk_down
        ways.since_s = old.since_s


def _dimensions(ability: Ability) -> list[int]:
    """The dimensions that the airframe can change."""
    found = [HDIR, HS] if ability.max_speed_m_s - ability.min_speed_m_s else [HDIR]
    return [*found, VS, ALT] if ability.max_climb_m_s else found


def resolutions(bands: Bands | None, course_rad: float) -> tuple[float, ...]:
    """The turns off a course that the heading bands propose, the preferred side first [rad].

    Each is one step beyond the nearest conflict-free value, which is the edge of a band.
    """
    found = () if bands is None else values(bands, HDIR, STEP_DEG * DEG)
    return tuple(smallest_turn(course_rad, value) for value in found)


def values(bands: Bands, dimension: int, beyond: float) -> tuple[float, ...]:
    """The values that a dimension proposes, `beyond` past the edge of a band, the preferred side first."""
    held = bands.dimensions[dimension]
    sides = [(held.up, beyond), (held.down, -beyond)]
    if not held.prefer_up:
        sides.reverse()
    return tuple(value + more for value, more in sides if value is not None)


def _own(number: int, motion: Motion) -> Aircraft:
    v = velocity_of(motion.heading_rad, motion.speed_m_s, motion.climb_m_s)
    return _aircraft(number, motion.position, v)


def _other(one: Intruder) -> Aircraft:
    spread = one.spread
    sigma = Sigma(
        spread.wide_m,
        spread.wide_m,
        0.0,
        spread.high_m,
        spread.wide_m_s,
        spread.wide_m_s,
        0.0,
        spread.high_m_s,
    )
    return _aircraft(one.id, one.position, one.velocity)._replace(sigma=sigma)


def _aircraft(number: int, place: Position, v: Velocity) -> Aircraft:
    return Aircraft(
        str(number),
        place.east_m,
        place.north_m,
        place.alt_m,
        v.east_m_s,
        v.north_m_s,
        -v.down_m_s,
    )
