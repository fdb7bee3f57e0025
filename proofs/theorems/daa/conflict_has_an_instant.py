"""If the kernel that alerting and bands ask says that a volume of any kind is violated during [B, T],
then the times kernel gives an instant of [B, T] at which it is: the first one."""

from typing import Any

from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_taumod,
    horizontal_interval_tcpa,
    horizontal_interval_tep,
    layer_window,
    violation_during_taumod,
    violation_during_tcpa,
    violation_during_tep,
    violation_interval_taumod,
    violation_interval_tcpa,
    violation_interval_tep,
)
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state, any_thresholds, by_name
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning

HORIZONTAL = {
    "taumod": horizontal_interval_taumod,
    "tcpa": horizontal_interval_tcpa,
    "tep": horizontal_interval_tep,
}


def witnesses(
    c: Claim, label: str, state: tuple[Any, ...], limits: Thresholds, begin: Any, end: Any
) -> dict[str, Any]:
    """For each kind the instant that stands for a detection, named by the equation that defines it."""
    s, v, sz, vz = state
    c.opaque(*HORIZONTAL.values(), layer_window)
    dthr, zthr, *times = limits
    found = {}
    for part, name in (("a", "taumod"), ("b", "tcpa"), ("c", "tep")):
        tthr, tcoa, vmod = times
        witness = c.real(f"witness_{part}{label}")
        k, low, high = c.use(layer_window, sz + begin * vz, vz, zthr, tcoa, vmod, end - begin)
        at = Vec2(
            (s.x + begin * v.x) * k + low * v.x,
            (s.y + begin * v.y) * k + low * v.y,
        )
        scaled, _ = c.use(HORIZONTAL[name], at, v, dthr * k, tthr * k, low - low, high - low)
        c.premise(c.implies(k > 0, k * (witness - begin) == low + scaled))
        found[f"witness_{part}"] = witness
    return found


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    begin, end = c.reals("begin end")
    c.opaque(
        violation_during_taumod,
        violation_during_tcpa,
        violation_during_tep,
        violation_interval_taumod,
        violation_interval_tcpa,
        violation_interval_tep,
        well_clear.violation_taumod_at,
        well_clear.violation_tcpa_at,
        well_clear.violation_tep_at,
    )
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    full = by_name(limits)
    found = witnesses(c, "", (s, v, sz, vz), limits, begin, end)
    for part, name, size in (
        ("a", "taumod", full),
        ("b", "tcpa", full),
        ("c", "tep", full),
    ):
        witness = found[f"witness_{part}"]
        c.lemma(f"well_clear_detection_{name}_is_the_interval", witness=witness, **state, **size)
        c.lemma(f"well_clear_interval_{name}_first_and_last_violate", **state, **size)
    detected = c.use(in_conflict, kind, s, v, sz, vz, limits, begin, end)
    first, last = c.use(conflict_span, kind, s, v, sz, vz, limits, begin, end)
    for interval, at_instant in (
        (violation_interval_taumod, well_clear.violation_taumod_at),
        (violation_interval_tcpa, well_clear.violation_tcpa_at),
        (violation_interval_tep, well_clear.violation_tep_at),
    ):
        entry, _ = c.use(interval, s, v, sz, vz, limits, begin, end)
        one, other = (s, v, sz, vz, limits, entry), (s, v, sz, vz, limits, first)
        c.congruence(at_instant, one, other)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, first)
    c.show(c.same(detected, first <= last), "detection")
    c.show(c.implies(detected, c.all_of(begin <= first, first <= end, lost)), "first instant")
