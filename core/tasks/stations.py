"""Following a moving entity: who can, who is on station, and whether that has lasted. Definitions: `spec.stations`."""

from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.core.geofence.distance import apart_squared, edge_against
from cratous.core.kernel import Vec2, kernel


@kernel(implements="stations.outruns_in", nonnegative=("speed_m_s",))
def outruns(velocity: Vec2, speed_m_s: float) -> bool:
    """True iff this speed [m/s], >= 0, exceeds that of an entity with this velocity [m/s]."""
    return velocity.x * velocity.x + velocity.y * velocity.y < speed_m_s * speed_m_s


@kernel(
    implements="stations.in_ring_at",
    nonnegative=("least_m", "most_m"),
    restates="two bounds of a Euclidean distance, compared by their squares",
)
def in_ring(p: Vec2, q: Vec2, least_m: float, most_m: float) -> bool:
    """True iff q is at least least_m [m], >= 0, and at most most_m [m], >= least_m, from p."""
    apart = apart_squared(p, q)
    return not (apart < least_m * least_m or apart > most_m * most_m)


@kernel(implements="geofence.within_at", nonnegative=("width_m",))
def beside(p: Vec2, a: Vec2, b: Vec2, width_m: float) -> bool:
    """True iff p is at most width_m [m], >= 0, from some point of the straight segment from a to b."""
    return edge_against(p, a, b, width_m) <= 0


class Kept(NamedTuple):
    """since: from when on the required number of vehicles have kept station [ms], -1: they do not; done: they have
    for the required time.
    """

    since: int
    done: bool


@kernel(implements="stations.long_enough", nonnegative=("now", "least"))
def kept_step(kept: Kept, there: int, needed: int, now: int, least: int) -> Kept:
    """Update at the instant `now` [ms], >= 0, with the number of vehicles on station, `there`.

    needed: how many have to be at one time; least: for how long without a break [ms], >= 0; 0: no time ends it. Once
    done it stays so.
    """
    if there < needed:
        return Kept(-1, kept.done)
    if kept.since == -1:
        return Kept(now, kept.done)
    return Kept(kept.since, kept.done or (least > 0 and lasted(kept.since, now, least)))
