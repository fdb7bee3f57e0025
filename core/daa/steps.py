"""The steps of a manoeuvre in direction, speed or climb, and whether one conflicts.

Definitions: `spec.daa.meaning`. A manoeuvre goes through grid steps k = 0..K, one each step_s seconds, and from any
of them straight. Step k conflicts with an intruder if the volume is violated on a segment of the path to it (segments
are flown straight from step j for one step time), or on the straight flight from step k within the horizon. For
recovery another volume (a cylinder) applies before the instant begin_s, and the volume itself only from then on.
"""

import math

import numpy as np

from cratous.core.daa.coordination import step_is_repulsive
from cratous.core.daa.records import Intruders, Looking, Manoeuvres, Regaining, Relative
from cratous.core.daa.uncertainty import SUM_KIND, lost
from cratous.core.daa.volume import in_conflict
from cratous.core.kernel import Vec2, driver, fold, kernel
from cratous.core.well_clear.thresholds import Thresholds


@kernel(implements="daa.meaning.lost_on_piece")
def piece_counts(at_s: float, from_s: float, until_s: float) -> bool:
    """True iff a segment begun at at_s is checked: not before from_s, not after until_s [s]."""
    return at_s >= from_s and at_s <= until_s


@kernel(implements="daa.meaning.lost_from_step")
def straight_from(at_s: float, from_s: float) -> float:
    """How long after a step at at_s the check of the straight flight from it begins: from from_s on [s]."""
    return max(from_s - at_s, 0)


@kernel(supports="way_conflicts")
def lost_before(before: bool, piece: bool) -> bool:
    """Whether the path to a step loses a volume: it did before, or the next segment does."""
    return before or piece


way_conflicts = fold(
    name="way_conflicts", implements="daa.meaning.lost_somewhere", step=lost_before, start=False
)
"""Whether any of the segments (lost,) of a path loses a volume."""


@kernel(implements="daa.meaning.horizon")
def until(lookahead_s: float, horizon_s: float, manoeuvre_s: float, counted: bool) -> float:
    """The time until which a volume is checked [s]: horizon_s after a manoeuvre that takes manoeuvre_s, or in total
    if the manoeuvre is counted; at most the look-ahead.
    """
    if counted:
        return min(lookahead_s, horizon_s)
    return min(lookahead_s, horizon_s + manoeuvre_s)


def out_of_reach(
    intruders: Intruders, i: int, regaining: Regaining, piece_s: float, fastest_m_s: float
) -> tuple[float, float]:
    """Squared distances beyond which intruder i is not in conflict at a step, and not in the recovery cylinder on a
    segment: bounds on range and closing speed, a metre wider than any rounding. fastest_m_s: greatest speed of the
    ownship at any step [m/s].

    A violation needs |s| <= DTHR + TTHR |v|, and |s| shrinks by at most |v| per second.
    """
    w, other, horizon_s = intruders.volumes[i], intruders.states[i], intruders.horizons[i]
    sided = intruders.sides[i, 0] != 0 or intruders.sides[i, 1] != 0
    if intruders.kinds[i] == SUM_KIND or sided:
        return math.inf, math.inf
    closing_m_s = fastest_m_s + math.sqrt(other[3] * other[3] + other[4] * other[4])
    wide_m, looked_s = w[0] + closing_m_s * w[2], max(piece_s, horizon_s)
    beside_m = 1.0 + regaining.radius_m + closing_m_s * piece_s
    if regaining.begin_s > horizon_s:  # only the cylinder is checked, up to the horizon at most
        wide_m = 0.0
    if regaining.recovering:
        wide_m = max(wide_m, regaining.radius_m)
    far_m = 1.0 + wide_m + closing_m_s * looked_s
    return far_m * far_m, beside_m * beside_m


@driver(
    checked_by=(
        "in_conflict", "piece_counts", "straight_from", "lost_before", "until", "repels",
        "repels_vertically",
    )
)  # fmt: skip
def safe_steps(
    own: np.ndarray, ways: Manoeuvres, intruders: Intruders, chosen: np.ndarray,
    regaining: Regaining, looking: Looking, safe: np.ndarray,
):  # fmt: skip
    """Which steps of one side are free of conflict with all chosen intruders, into `safe`.

    own: the steps of that side, `ways.right` or `ways.left`; chosen: indices of intruders.
    Returns whether two neighbouring steps are safe, or any one if single.
    """
    step_s, piece_s = ways.step_s, ways.piece_s
    others, kinds, volumes = intruders.states, intruders.kinds, intruders.volumes
    horizons, sides = intruders.horizons, intruders.sides
    begin_s, radius_m, half_m = regaining.begin_s, regaining.radius_m, regaining.half_m
    recovering, lookahead_s, counted = regaining.recovering, looking.lookahead_s, looking.counted
    project_s, early, single = looking.project_s, looking.early, looking.single
    last = own.shape[0] - 1
    found = False
    first = 0
    kept_clear = Thresholds(radius_m, half_m, 0.0, 0.0, 0.0)
    fastest = 0.0
    for k in range(last + 1):
        safe[k] = True
        fastest = max(fastest, own[k, 3] * own[k, 3] + own[k, 4] * own[k, 4])
    far, beside = np.zeros(chosen.size), np.zeros(chosen.size)
    for c in range(chosen.size):
        far[c], beside[c] = out_of_reach(
            intruders, chosen[c], regaining, piece_s, math.sqrt(fastest)
        )
    for k in range(last + 1):
        at_s = k * step_s
        sx0 = own[k, 0] + own[0, 6] * project_s
        sy0 = own[k, 1] + own[0, 7] * project_s
        sz0 = own[k, 2] + own[0, 5] * project_s
        blocked = False
        red = False
        lead = first
        for c in range(chosen.size):
            # the intruder of the last conflict is checked first
            q = c
            if c == 0:
                q = lead
            elif c <= lead:
                q = c - 1
            i = chosen[q]
            if sides[i, 0] != 0 or sides[i, 1] != 0:
                repulsive = step_is_repulsive(own, k, step_s, others[i], sides[i, 0], sides[i, 1])
                if step_s == 0:
                    red = red or not repulsive
                else:
                    blocked = lost_before(blocked, not repulsive)
                if blocked or (red and step_s == 0):
                    first = q
                    break
            t = at_s + project_s
            s = Vec2(sx0 - others[i, 0] - others[i, 3] * t, sy0 - others[i, 1] - others[i, 4] * t)
            away = s.x * s.x + s.y * s.y
            if away > far[q]:
                continue
            final_s = lookahead_s
            if counted:
                final_s = horizons[i]
            # recovery later than the horizon: until there only the cylinder applies
            looked = begin_s <= horizons[i] and piece_counts(at_s, begin_s, final_s)
            # the step itself is already excluded: what remains is whether all later ones are
            settled = red and not looked
            if settled and (not recovering or away > beside[q]):
                continue
            v = Vec2(own[k, 3] - others[i, 3], own[k, 4] - others[i, 4])
            sz = sz0 - others[i, 2] - others[i, 5] * t
            vz = own[k, 5] - others[i, 5]
            state = Relative(s, v, sz, vz)
            clear = True
            end_s = until(lookahead_s, horizons[i], at_s, counted)
            if not settled and begin_s <= horizons[i]:
                clear = not lost(
                    kinds[i], state, volumes[i], at_s, straight_from(at_s, begin_s), end_s - at_s
                )
            # a segment within a clear straight flight is clear
            covered = clear and begin_s <= min(at_s, horizons[i]) and at_s + step_s <= end_s
            if step_s > 0 and not covered:
                on_piece = looked and lost(kinds[i], state, volumes[i], at_s, 0.0, piece_s)
                blocked = lost_before(blocked, on_piece)
            if recovering and not blocked:
                # kept clear until begin_s, or to the horizon as any volume where that is sooner
                held_s, until_s = begin_s, begin_s
                if begin_s > horizons[i]:
                    held_s, until_s = end_s, final_s
                if not settled and in_conflict(
                    3, s, v, sz, vz, kept_clear, straight_from(at_s, 0.0), held_s - at_s
                ):
                    clear = False
                if step_s > 0:
                    blocked = piece_counts(at_s, 0.0, until_s) and in_conflict(
                        3, s, v, sz, vz, kept_clear, 0.0, piece_s
                    )
            if not clear:
                red = True
                first = q
            if blocked or (red and step_s == 0):
                break
        if blocked:
            for j in range(k, last + 1):
                safe[j] = False
            break
        if red:
            safe[k] = False
        elif single or (k > 0 and safe[k - 1]):
            found = True
            if early:
                break
    return found
