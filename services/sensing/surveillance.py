"""The sensors of one vehicle and its tracker: ICAROUS's input for its own state and for traffic."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.avoidance.drift import Off
from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.avoidance.prediction import Intruder, Spread
from cratous.services.icarous.messages import Sensed
from cratous.services.mission.frames import place_and_velocity
from cratous.services.sensing import vehicle_sensors
from cratous.services.sensing.filter import Cov, Estimate, Flown, deviations
from cratous.services.sensing.own_state import Own
from cratous.services.sensing.sensors import Detection
from cratous.services.sensing.tracks import Tracks, estimate, tracked
from cratous.services.sensing.vehicle_sensors import Carried, Sensors
from cratous.spec.mission import Mission
from cratous.spec.mission.sensing import Sensing


class Carrier(NamedTuple):
    """A vehicle with sensors and its fixed configuration. lookahead_s: of detect and avoid; seed: of the mission's
    variant; cooperating: vehicles with an ICAROUS instance, as reported by ADS-B.
    """

    own_id: int
    sensing: Sensing
    lookahead_s: float
    seed: int
    step_ms: int
    cooperating: frozenset[int]


class Surveillance(NamedTuple):
    """under_way: measurements that have not arrived yet; own: None before the first step, or without a GPS."""

    under_way: tuple[Detection, ...] = ()
    own: Own | None = None
    tracks: Tracks = Tracks()


class Shown(NamedTuple):
    """An aircraft as shown to the vehicle's ICAROUS. track: its track number; source: true target of the last
    measurement; known: estimated state; spread: its uncertainty.
    """

    track: int
    source: int
    known: Estimate
    spread: Spread


def carriers(mission: Mission, instances: Iterable[int]) -> dict[int, Carrier]:
    """The vehicles with sensors: each that has an ICAROUS instance, if the mission defines sensors."""
    sensing, seed, step_ms = mission.sensing, mission.seed, mission.simulation.step_ms
    if sensing is None:
        return {}
    ours, lookahead_s = frozenset(instances), mission.daa.lookahead_s
    return {vid: Carrier(vid, sensing, lookahead_s, seed, step_ms, ours) for vid in sorted(ours)}


def stepped(
    carrier: Carrier, before: Surveillance, now_ms: int, aircraft: Mapping[int, Flown]
) -> Surveillance:
    """The state after a simulation step: new measurements are in transit, and the own state has moved on."""
    sensors = Sensors(carrier.own_id, carrier.sensing, carrier.seed, carrier.step_ms)
    after = vehicle_sensors.stepped(
        sensors, Carried(before.under_way, before.own), now_ms, aircraft
    )
    return Surveillance(*after, before.tracks)


def all_stepped(
    carriers: Mapping[int, Carrier],
    before: Mapping[int, Surveillance],
    now_ms: int,
    aircraft: Mapping[int, Flown],
    unseen: frozenset[int],
) -> dict[int, Surveillance]:
    """`stepped` for each carrier. unseen: vehicles on the ground, which are no traffic to others."""
    return {
        vid: stepped(
            carrier,
            before[vid],
            now_ms,
            {
                number: one
                for number, one in aircraft.items()
                if number == vid or number not in unseen
            },
        )
        for vid, carrier in carriers.items()
    }


def arrived(carrier: Carrier, before: Surveillance, now_ms: int) -> Surveillance:
    """Process the measurements that have arrived by the heartbeat at now_ms [ms]."""
    known = Carried(before.under_way, before.own)
    after, others = vehicle_sensors.came(carrier.own_id, known, now_ms)
    return Surveillance(*after, tracked(before.tracks, others, carrier.sensing, now_ms))


def beat(
    carrier: Carrier, before: Surveillance, true: Sensed, air: Flown
) -> tuple[Surveillance, tuple[Shown, ...], Sensed]:
    """Process a heartbeat. Returns the state, the aircraft shown to ICAROUS, and its input in place of the
    true states.
    """
    after = arrived(carrier, before, true.now_ms)
    seen = shown(carrier, after, true.now_ms, air)
    return after, seen, given(carrier, seen, true)


def shown(carrier: Carrier, now: Surveillance, now_ms: int, air: Flown) -> tuple[Shown, ...]:
    """The own state first, then the confirmed tracks. air: the true own state, used without a GPS."""
    known = now.own.estimate if now.own is not None else exactly(now_ms, air)
    found = [_shown(carrier, carrier.own_id, carrier.own_id, known)]
    for track in now.tracks.tracks:
        if track.shown:
            known = estimate(track, now_ms, carrier.sensing.manoeuvre_m_s2)
            found.append(_shown(carrier, track.number, track.source, known))
    return tuple(found)


def exactly(now_ms: int, air: Flown) -> Estimate:
    """An estimate without errors."""
    nothing = Cov(0.0, 0.0, 0.0)
    return Estimate(now_ms, air.position, air.velocity, nothing, nothing)


def _shown(carrier: Carrier, number: int, source: int, known: Estimate) -> Shown:
    sigmas = carrier.sensing.sigmas
    (wide, wide_rate), (high, high_rate) = deviations(known.wide), deviations(known.high)
    off = Spread(sigmas * wide, sigmas * wide_rate, sigmas * high, sigmas * high_rate)
    return Shown(number, source, known, off._replace(steady_s=carrier.lookahead_s))


def given(carrier: Carrier, seen: tuple[Shown, ...], true: Sensed) -> Sensed:
    """ICAROUS's input in place of the true states. seen: the aircraft shown, its own first. Ability and gate
    are known exactly.
    """
    own, low, high = seen[0], true.ability.min_speed_m_s, true.ability.max_speed_m_s
    v, off = own.known.velocity, own.spread.wide_m_s
    seen_m_s = math.hypot(v.north_m_s, v.east_m_s)
    # it flies within its speed limits, unless wind has just changed them
    speed_m_s = min(max(min(max(seen_m_s, low), high), seen_m_s - off), seen_m_s + off)
    course = math.atan2(v.east_m_s, v.north_m_s)
    motion = Motion(own.known.position, course, speed_m_s, -v.down_m_s)
    others = tuple(
        Intruder(
            one.track,
            one.known.position,
            one.known.velocity,
            one.track in carrier.cooperating,
            spread=_both(own.spread, one.spread),
        )
        for one in seen[1:]
    )
    here = Off(own.spread.wide_m, own.spread.high_m)
    return true._replace(motion=motion, intruders=others, here=here)


def _both(own: Spread, other: Spread) -> Spread:
    """Uncertainty of the other aircraft relative to the own estimate."""
    return Spread(
        own.wide_m + other.wide_m,
        own.wide_m_s + other.wide_m_s,
        own.high_m + other.high_m,
        own.high_m_s + other.high_m_s,
        other.steady_s,
    )


def sensed_state(carrier: Carrier, one: Shown) -> Any:
    """An aircraft as shown to a vehicle's ICAROUS, as a `SensedState`."""
    at_ms, p, v = one.known[:3]
    wide, wide_rate, high, high_rate, _ = one.spread
    return lmcp.new(
        "SensedState",
        ObserverID=carrier.own_id,
        TrackID=one.track,
        VehicleID=one.source,
        Time=at_ms,
        **place_and_velocity(p, v),
        HorizontalBound=wide,
        VerticalBound=high,
        HorizontalRateBound=wide_rate,
        VerticalRateBound=high_rate,
    )
