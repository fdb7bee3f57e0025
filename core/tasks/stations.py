"""Who can follow what moves, who is at his place about it, and whether that has lasted. Definitions:
`spec.stations`."""

from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.core.geofence.distance import apart_squared, edge_against
from cratous.core.kernel import Vec2, kernel


@kernel(implements="stations.outruns_in", nonnegative=("speed_m_s",))
def outruns(velocity: Vec2, speed_m_s: float) -> bool:
    """True iff who flies at this speed [m/s], >= 0, is faster than what moves with this velocity [m/s]."""
    return velocity.x * velocity.x + velocity.y * velocity.y < speed_m_s * speed_m_s


@kernel(
    implements="stations.in_ring_at",
    nonnegative=("least_m", "most_m"),
    restates="two bounds of a Euclidean distance, compared by their squares",
)
def in_ring(p: Vec2, q: Vec2, least_m: float, most_m: float) -> bool:
    """True iff q is no nearer to p than least_m [m], >= 0, and no farther than most_m [m], >= least_m."""
    apart = apart_squared(p, q)
    return not (apart < least_m * least_m or apart > most_m * most_m)


@kernel(implements="geofence.within_at", nonnegative=("width_m",))
def beside(p: Vec2, a: Vec2, b: Vec2, width_m: float) -> bool:
    """True iff p is no farther than width_m [m], >= 0, from some point of the straight way from a to b."""
    return edge_against(p, a, b, width_m) <= 0


class Kept(NamedTuple):
    """since: from when on as many as have to have kept to their places [ms], -1: they do not; done: they
    have for as long as is asked for."""

    since: int
    done: bool


@kernel(implements="stations.long_enough", nonnegative=("now", "least"))
def kept_step(kept: Kept, there: int, needed: int, now: int, least: int) -> Kept:
    """At the instant `now` [ms], >= 0, so many are at their places.

    needed: how many have to be at one time; least: for how long without a break [ms], >= 0; 0: no time ends
    it. Once done it stays so.
    """
    if there < needed:
        return Kept(-1, kept.done)
    if kept.since == -1:
        return Kept(now, kept.done)
    return Kept(kept.since, kept.done or (least > 0 and lasted(kept.since, now, least)))
