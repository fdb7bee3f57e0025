"""Whether segments of flight are clear of an intruder at every instant. No division, no root.

A segment (piece) is a moving disc, an intruder a tube of growing radius; see `spec.permit.motion`. The radius is
convex in time, so on a segment its chord is above it: the horizontal test is a quadratic whose leading term has any
sign. Clear means beside, or above, or below, during the whole segment; the pilot divides segments where the layer is
crossed. The fold is over the segments, for one intruder.
"""

from typing import NamedTuple

from cratous.core.kernel import Vec2, fold, kernel
from cratous.core.well_clear.during import dips_to_zero


class Growth(NamedTuple):
    """A radius of start_m + rate_m_s t + gain_m_s2 t^2 after t seconds, none below 0."""

    start_m: float
    rate_m_s: float
    gain_m_s2: float


class Tube(NamedTuple):
    """Bounds on the deviation of an intruder from its straight prediction: horizontally, and in altitude."""

    wide: Growth
    high: Growth


class Margins(NamedTuple):
    """The separation required, each >= 0: radius_m, half_m: of the cylinder about the intruder [m]; rho_m: bound on
    the vehicle's deviation from its reference, also in altitude [m].
    """

    radius_m: float
    half_m: float
    rho_m: float


class Meeting(NamedTuple):
    """The intruder when a trajectory begins: the own reference minus its prediction s [m], sz [m, up]; its velocity w
    [m/s], wz [m/s, up]; its tube; radius_m, half_height_m: of the cylinder to keep clear.
    """

    s: Vec2
    sz: float
    w: Vec2
    wz: float
    wide: Growth
    high: Growth
    radius_m: float
    half_height_m: float


class Piece(NamedTuple):
    """The vehicle is within rho_m [m], also in altitude, of a reference that moves straight at velocity
    [m/s] and climb_m_s [m/s, up] for duration_s [s]."""

    velocity: Vec2
    climb_m_s: float
    duration_s: float
    rho_m: float


@kernel(implements="permit.motion.reach")
def reach_after(growth: Growth, t_s: float) -> float:
    """The radius t_s seconds later [m]."""
    return growth.start_m + t_s * (growth.rate_m_s + t_s * growth.gain_m_s2)


@kernel(implements="permit.motion.later")
def growth_after(growth: Growth, t_s: float) -> Growth:
    """The same radius, with time counted from t_s seconds later on."""
    rate = growth.rate_m_s + 2 * t_s * growth.gain_m_s2
    return Growth(reach_after(growth, t_s), rate, growth.gain_m_s2)


@kernel(implements="permit.motion.reached_at", nonnegative=("d_s",))
def beside_during(s: Vec2, v: Vec2, growth: Growth, d_s: float) -> bool:
    """True only if the centres are farther apart than the radius at every instant of [0, d_s].

    s, v: relative position [m] and velocity [m/s]. Exact where the radius grows steadily.
    """
    # the chord of the radius over [0, d_s] starts at it and is never below it
    rate = growth.rate_m_s + d_s * growth.gain_m_s2
    a = v.x * v.x + v.y * v.y - rate * rate
    b = 2 * (s.x * v.x + s.y * v.y - growth.start_m * rate)
    return not dips_to_zero(a, b, s.x * s.x + s.y * s.y - growth.start_m * growth.start_m, d_s)


@kernel(implements="permit.motion.levelled_at", nonnegative=("d_s",))
def above_during(sz: float, vz: float, growth: Growth, d_s: float) -> bool:
    """True iff the altitude above the other is more than the radius at every instant of [0, d_s].

    sz, vz: relative altitude [m] and climb rate [m/s].
    """
    # the remaining expression is concave in time, so the ends decide
    return sz > growth.start_m and sz + d_s * vz > reach_after(growth, d_s)


@kernel(implements="permit.motion.hit_at", nonnegative=("margins", "d_s"))
def piece_clear(
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    tube: Tube,
    margins: Margins,
    d_s: float,
) -> bool:
    """True only if the cylinder is not entered at any instant of [0, d_s], for every position of the vehicle within
    rho_m and of the intruder in its tube. s, v, sz, vz: own reference minus prediction [m, m/s].
    """
    wide, high = tube
    radius_m, half_m, rho_m = margins
    around = Growth(wide.start_m + radius_m + rho_m, wide.rate_m_s, wide.gain_m_s2)
    layer = Growth(high.start_m + half_m + rho_m, high.rate_m_s, high.gain_m_s2)
    if above_during(sz, vz, layer, d_s) or above_during(0 - sz, 0 - vz, layer, d_s):
        return True
    return beside_during(s, v, around, d_s)


class Flight(NamedTuple):
    """clear: of the intruder so far; north_m, east_m, up_m: how far the reference has moved; time_s."""

    clear: bool
    north_m: float
    east_m: float
    up_m: float
    time_s: float


@kernel(supports="permitted")
def flight_step(
    flight: Flight, v: Vec2, climb_m_s: float, d_s: float, rho_m: float, meeting: Meeting
) -> Flight:
    """Add a segment: its fields as in `Piece`, and `meeting`."""
    t = flight.time_s
    clear = flight.clear and piece_clear(
        Vec2(
            meeting.s.x + flight.north_m - t * meeting.w.x,
            meeting.s.y + flight.east_m - t * meeting.w.y,
        ),
        Vec2(v.x - meeting.w.x, v.y - meeting.w.y),
        meeting.sz + flight.up_m - t * meeting.wz,
        climb_m_s - meeting.wz,
        Tube(growth_after(meeting.wide, t), growth_after(meeting.high, t)),
        Margins(meeting.radius_m, meeting.half_height_m, rho_m),
        d_s,
    )
    up = flight.up_m + d_s * climb_m_s
    return Flight(clear, flight.north_m + d_s * v.x, flight.east_m + d_s * v.y, up, t + d_s)


@kernel(supports="permitted")
def flight_result(flight: Flight) -> bool:
    """Whether all pieces are clear."""
    return flight.clear


permitted = fold(
    name="permitted",
    implements="permit.motion.way_step",
    step=flight_step,
    start=Flight(True, 0, 0, 0, 0),
    finish=flight_result,
)


@kernel(supports="permitted_from")
def part_step(
    flight: Flight,
    v: Vec2,
    climb_m_s: float,
    d_s: float,
    rho_m: float,
    meeting: Meeting,
    gone_s: float,
) -> Flight:
    """Add a segment, of which only the part after gone_s [s from the beginning] counts."""
    t = flight.time_s
    clear = flight.clear
    if t + d_s >= gone_s:
        flown = max(gone_s - t, 0)
        at = t + flown
        clear = clear and piece_clear(
            Vec2(
                meeting.s.x + (flight.north_m + flown * v.x) - at * meeting.w.x,
                meeting.s.y + (flight.east_m + flown * v.y) - at * meeting.w.y,
            ),
            Vec2(v.x - meeting.w.x, v.y - meeting.w.y),
            meeting.sz + (flight.up_m + flown * climb_m_s) - at * meeting.wz,
            climb_m_s - meeting.wz,
            Tube(growth_after(meeting.wide, at), growth_after(meeting.high, at)),
            Margins(meeting.radius_m, meeting.half_height_m, rho_m),
            d_s - flown,
        )
    up = flight.up_m + d_s * climb_m_s
    return Flight(clear, flight.north_m + d_s * v.x, flight.east_m + d_s * v.y, up, t + d_s)


permitted_from = fold(
    name="permitted_from",
    implements="permit.motion.way_step",
    step=part_step,
    start=Flight(True, 0, 0, 0, 0),
    finish=flight_result,
)
