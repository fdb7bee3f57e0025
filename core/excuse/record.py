"""Whether a recorded loss of well clear could have been avoided, from the recorded positions.

Definitions: `spec.excuse`. The loss is examined from every recorded instant of the look-ahead before it: could the
ownship have flown any manoeuvre of its set and kept well clear for the look-ahead, with all other aircraft flying as
recorded? A way out at one instant suffices; only if there was none at any instant is the loss excused. Where the
record is insufficient, nothing is excused. Positions are east, north, up [m].
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from cratous.core.daa.state import Aircraft
from cratous.core.excuse.judgement import judged
from cratous.core.excuse.state import UNDECIDED, WAY_OUT, Judgement, Other
from cratous.core.excuse.way_out import is_excused, piece_lost, way_out
from cratous.core.kernel import Vec2
from cratous.core.well_clear.thresholds import Thresholds
from cratous.spec.daa.parameters import DEG, G_M_S2, TAUMOD, Parameters
from cratous.spec.mission import Vehicle, WellClear

Place = tuple[float, float, float]
ACCELERATION_M_S2 = 1.0
"""The acceleration of the aircraft of a mission, as the simulator flies them [m/s2]."""
CLIMB_CHANGE_M_S2 = 10 * G_M_S2
"""They change their climb rate from one step to the next; this is practically immediate."""
STEP_HDIR_RAD, STEP_HS_M_S, STEP_VS_M_S, STEP_ALT_M = DEG, 0.5, 0.25, 5.0
ROUNDING = 0.01
"""A speed beyond the declared limits by up to this share is attributed to differencing two positions."""


class Scene(NamedTuple):
    """The positions of all airborne aircraft at an instant."""

    time_ms: int
    places: Mapping[int, Place]


class Moment(NamedTuple):
    """An instant from which the loss was examined, and the judgement from there."""

    time_ms: int
    judgement: Judgement


class Loss(NamedTuple):
    """A loss, and whether its ownship could have avoided it.

    answer: WAY_OUT, UNDECIDED or NO_WAY over all moments; excused: no way out; why: what could not be decided;
    moments: the instants examined, up to the first with a way out.
    """

    own: int
    other: int
    lost_ms: int
    answer: int
    excused: bool
    why: str
    moments: tuple[Moment, ...]


def modelled(
    vehicle: Vehicle, speed_m_s: float, climb_m_s: float, alt_m: float, floor_m: float,
    lookahead_s: float,
) -> Parameters:  # fmt: skip
    """The manoeuvres of a vehicle of a mission, as parameters of detect and avoid.

    Turns at its greatest bank, speeds and climb rates within its limits, altitudes that it can reach in time and that
    are not below floor_m. An own value beyond a limit by at most ROUNDING is taken as the limit; one farther out
    stays outside, and then nothing is decided.
    """
    slow, fast, most = vehicle.min_speed_m_s, vehicle.max_speed_m_s, vehicle.max_climb_m_s
    if slow * (1 - ROUNDING) <= speed_m_s <= fast * (1 + ROUNDING):
        slow, fast = min(slow, speed_m_s), max(fast, speed_m_s)
    if abs(climb_m_s) <= most * (1 + ROUNDING) + 1e-9:
        most = max(most, abs(climb_m_s))
    reach = most * lookahead_s
    return dataclasses.replace(
        Parameters(),
        lookahead_time_s=lookahead_s,
        min_airspeed_m_s=0.0,
        min_hs_m_s=slow,
        max_hs_m_s=fast,
        min_vs_m_s=-most,
        max_vs_m_s=most,
        min_alt_m=min(max(floor_m, alt_m - reach), alt_m),
        max_alt_m=alt_m + reach,
        step_hdir_rad=STEP_HDIR_RAD,
        step_hs_m_s=STEP_HS_M_S,
        step_vs_m_s=STEP_VS_M_S,
        step_alt_m=STEP_ALT_M,
        horizontal_accel_m_s2=ACCELERATION_M_S2,
        vertical_accel_m_s2=CLIMB_CHANGE_M_S2,
        turn_rate_rad_s=0.0,
        bank_angle_rad=vehicle.max_bank_rad,
        vertical_rate_m_s=most,
        bands_add_time_to_maneuver=True,
    )


def _velocity(a: Place, b: Place, ms: int) -> Place:
    return (b[0] - a[0]) * 1000 / ms, (b[1] - a[1]) * 1000 / ms, (b[2] - a[2]) * 1000 / ms


def flown(scenes: Sequence[Scene], k: int, number: int, until_ms: int) -> np.ndarray:
    """The straight segments of one aircraft from scene k on; none where it is missing."""
    rows = []
    start_ms = scenes[k].time_ms
    for a, b in zip(scenes[k:], scenes[k + 1 :], strict=False):
        if a.time_ms >= until_ms:
            break
        if number in a.places and number in b.places:
            span_ms = b.time_ms - a.time_ms
            rows.append(
                [
                    (a.time_ms - start_ms) / 1000,
                    (b.time_ms - start_ms) / 1000,
                    *a.places[number],
                    *_velocity(a.places[number], b.places[number], span_ms),
                ]
            )
    return np.array(rows, dtype=np.float64).reshape(-1, 8)


def own_state(scenes: Sequence[Scene], k: int, number: int) -> Aircraft:
    """Its position at scene k and its velocity before it; at its first scene the velocity after it."""
    here = scenes[k].places[number]
    if k > 0 and number in scenes[k - 1].places:
        before = scenes[k - 1]
        v = _velocity(before.places[number], here, scenes[k].time_ms - before.time_ms)
    else:
        after = scenes[k + 1]
        v = _velocity(here, after.places[number], after.time_ms - scenes[k].time_ms)
    return Aircraft(str(number), *here, *v)


def lost_now(own: Aircraft, other: Other) -> bool:
    """Whether its volume is already violated at this instant."""
    first = other.pieces[0]
    s = Vec2(own.east_m - first[2], own.north_m - first[3])
    v = Vec2(own.ve_m_s - first[5], own.vn_m_s - first[6])
    return bool(
        piece_lost(
            other.kind,
            s,
            v,
            own.alt_m - first[4],
            own.vu_m_s - first[7],
            Thresholds(*other.thresholds),
            0.0,
        )
    )


class Record(NamedTuple):
    """Scenes in order of time. after_ms: the end of the preceding loss, if there was one; earlier: the aircraft known
    to have been airborne before the first scene.
    """

    scenes: Sequence[Scene]
    after_ms: int | None = None
    earlier: frozenset[int] = frozenset()


def window(
    record: Record, k: int, own: int, other: int, lookahead_s: float
) -> tuple[list[int], str]:
    """The scenes before the loss, in step k, from which it could have been avoided; and what is missing.

    They reach back to the look-ahead, to the end of the preceding loss, to the first appearance of one of the two, or
    to the beginning of the mission; a record that begins later leaves it undecided.
    """
    scenes, after_ms, earlier = record
    earliest_ms = scenes[k].time_ms - round(lookahead_s * 1000)
    first = k
    while first > 0:
        before = scenes[first - 1]
        if before.time_ms < earliest_ms or (after_ms is not None and before.time_ms < after_ms):
            return list(range(first, k + 1)), ""
        missing = [i for i in (own, other) if i not in before.places]
        if missing:
            seen = any(i in earlier or any(i in s.places for s in scenes[:first]) for i in missing)
            return list(range(first, k + 1)), "the record has a gap before the loss" if seen else ""
        first -= 1
    if scenes[0].time_ms > max(earliest_ms, 0) and scenes[0].time_ms != after_ms:
        return list(range(k + 1)), f"the record begins at {scenes[0].time_ms / 1000:g} s"
    return list(range(k + 1)), ""


def judge_loss(
    record: Record,
    k: int,
    vehicle: Vehicle,
    other: int,
    volume: WellClear,
    lookahead_s: float,
    floor_m: float,
) -> Loss:
    """Whether the vehicle could have avoided the loss of well clear of `other` in step k of the record.

    An aircraft whose volume is already violated at an instant does not rule out a manoeuvre from there, unless it is
    `other`; one that is not airborne then is not known yet.
    """
    own_id, scenes = vehicle.id, record.scenes
    indices, why = window(record, k, own_id, other, lookahead_s)
    limits = (volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s, 0.0)
    moments: list[Moment] = []
    for i in indices:
        own = own_state(scenes, i, own_id)
        until_ms = scenes[i].time_ms + math.ceil(lookahead_s * 1000)
        others = []
        for number in sorted(scenes[i].places):
            pieces = flown(scenes, i, number, until_ms)
            if number == own_id or not len(pieces) or pieces[0, 0] > 0:
                continue
            one = Other(str(number), pieces, TAUMOD, limits)
            if number == other or not lost_now(own, one):
                others.append(one)
        speed = math.hypot(own.ve_m_s, own.vn_m_s)
        p = modelled(vehicle, speed, own.vu_m_s, own.alt_m, floor_m, lookahead_s)
        moments.append(Moment(scenes[i].time_ms, judged(p, own, others, lookahead_s)))
        if moments[-1].judgement.answer == WAY_OUT:
            break
    items = [(m.judgement.answer,) for m in moments]
    if why:
        items.append((UNDECIDED,))
    answer = int(way_out(items))
    open_ = [m for m in moments if m.judgement.answer == UNDECIDED]
    if answer == UNDECIDED and not why and open_:
        why = f"at {open_[0].time_ms / 1000:.2f} s: {open_[0].judgement.why}"
    return Loss(
        own_id, other, scenes[k].time_ms, answer, bool(is_excused(answer)),
        why if answer == UNDECIDED else "", tuple(moments),
    )  # fmt: skip
