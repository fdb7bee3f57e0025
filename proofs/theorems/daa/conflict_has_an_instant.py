"""If the kernel that alerting and bands ask says that a volume of any kind is violated during [B, T],
then the times kernel gives an instant of [B, T] at which it is: the first one."""

from typing import Any

from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.core.well_clear import layer_window
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import named_instant
from cratous.proofs.methods.encounters import any_loss, by_name
from cratous.proofs.methods.kinds import TAUMOD, TCPA, TEP
from cratous.spec.daa import meaning as daa_meaning

VOLUMES = (("a", TAUMOD), ("b", TCPA), ("c", TEP))


def witnesses(
    c: Claim, label: str, state: tuple[Any, ...], limits: Thresholds, begin: Any, end: Any
) -> dict[str, Any]:
    """For each kind the instant that stands for a detection, named by the equation that defines it."""
    c.opaque(*(volume.flat.interval for _, volume in VOLUMES), layer_window)
    found = {}
    for part, volume in VOLUMES:
        witness = c.real(f"witness_{part}{label}")
        named_instant(c, volume, (*state, begin, end), limits, witness)
        found[f"witness_{part}"] = witness
    return found


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz, limits = any_loss(c)
    begin, end = c.reals("begin end")
    for _, volume in VOLUMES:
        c.opaque(volume.space.during, volume.space.interval, volume.meant.at)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    full = by_name(limits)
    found = witnesses(c, "", (s, v, sz, vz), limits, begin, end)
    for part, volume in VOLUMES:
        name, witness = volume.name, found[f"witness_{part}"]
        c.lemma(f"well_clear_detection_{name}_is_the_interval", witness=witness, **state, **full)
        c.lemma(f"well_clear_interval_{name}_first_and_last_violate", **state, **full)
    detected = c.use(in_conflict, kind, s, v, sz, vz, limits, begin, end)
    first, last = c.use(conflict_span, kind, s, v, sz, vz, limits, begin, end)
    for _, volume in VOLUMES:
        entry, _ = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
        one, other = (s, v, sz, vz, limits, entry), (s, v, sz, vz, limits, first)
        c.congruence(volume.meant.at, one, other)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, first)
    c.show(c.same(detected, first <= last), "detection")
    c.show(c.implies(detected, c.all_of(begin <= first, first <= end, lost)), "first instant")
