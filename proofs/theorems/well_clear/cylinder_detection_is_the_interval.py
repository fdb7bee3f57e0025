"""The cylinder kernel that neither divides nor takes roots says `inside during [B, T]` exactly when
the interval kernel's span is not empty, so exactly when some instant is inside; and where it is not
empty the kernel that does not ask gives the same first and last instant."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    cylinder_during,
    cylinder_interval,
    cylinder_times,
    horizontal_interval_tep,
    layer_window,
    violation_during_tep,
    violation_interval_tep,
    violation_times_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_cylinder


def claim(c: Claim) -> None:
    s, v, sz, vz, radius, half = any_cylinder(c)
    begin, end, witness = c.reals("begin end witness")
    c.opaque(
        horizontal_interval_tep,
        layer_window,
        violation_during_tep,
        violation_interval_tep,
        violation_times_tep,
    )
    detected = c.use(cylinder_during, s, v, sz, vz, radius, half, begin, end)
    span = c.use(cylinder_interval, s, v, sz, vz, radius, half, begin, end)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    size = {"dthr": radius, "zthr": half, "tthr": 0, "tcoa": 0, "vmod": 0}
    k, low, high = c.use(layer_window, sz + begin * vz, vz, half, 0, 0, end - begin)
    at = Vec2(
        (s.x + begin * v.x) * k + low * v.x,
        (s.y + begin * v.y) * k + low * v.y,
    )
    scaled, _ = c.use(horizontal_interval_tep, at, v, radius * k, 0, low - low, high - low)
    # the instant that stands for a detection, named by the equation that defines it
    c.premise(c.implies(k > 0, k * (witness - begin) == low + scaled))
    c.lemma("well_clear_detection_tep_is_the_interval", witness=witness, **state, **size)
    some = span.first_s <= span.last_s
    c.show(c.same(detected, some), "detection")
    c.lemma("well_clear_times_tep_are_the_interval", **state, **size)
    times = c.use(cylinder_times, s, v, sz, vz, radius, half, begin, end)
    c.show(c.implies(some, c.same(times, span)), "times")
