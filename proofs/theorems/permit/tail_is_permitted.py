"""The tail of a permitted trajectory is permitted: what is permitted against an intruder is permitted against it
from every instant on, for every number of pieces."""

from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import (
    Flight,
    Growth,
    Meeting,
    permitted,
    permitted_from,
    piece_clear,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import along_items
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    wide = Growth(*c.reals("wide_start wide_rate wide_gain"))
    high = Growth(*c.reals("high_start high_rate high_gain"))
    s, w = c.vector("s"), c.vector("w")
    sz, wz, radius, half, gone = c.reals("sz wz radius half gone")
    meeting = Meeting(s, sz, w, wz, wide, high, radius, half)
    for growth in (wide, high):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(radius >= 0, half >= 0))
    v = c.vector("v")
    vz, d, rho = c.reals("vz duration rho")
    c.opaque(piece_clear)

    def seen(flight: Any, flown: Any) -> tuple[Any, ...]:
        """What the kernel of a piece is asked after part of it has been flown."""
        at = flight.time_s + flown
        north, east = flight.north_m + flown * v.x, flight.east_m + flown * v.y
        return (
            Vec2(s.x + north - at * w.x, s.y + east - at * w.y),
            Vec2(v.x - w.x, v.y - w.y),
            sz + (flight.up_m + flown * vz) - at * wz,
            vz - wz,
            c.define(motion.later, wide, at),
            c.define(motion.later, high, at),
            radius,
            half,
            rho,
            d - flown,
        )

    def invariant(state: list[Any]) -> Any:
        whole, part = state
        same = c.same(
            (whole.north_m, whole.east_m, whole.up_m, whole.time_s),
            (part.north_m, part.east_m, part.up_m, part.time_s),
        )
        return c.all_of(same, whole.time_s >= 0, c.implies(whole.clear, part.clear))

    def known(state: list[Any]) -> None:
        whole, part = state
        time = whole.time_s
        flown, its = (
            c.when(gone - f.time_s >= 0, gone - f.time_s, f.time_s - f.time_s) for f in state
        )
        inside = time + d >= gone
        begun = seen(whole, time - time)
        for growth in (wide, high):
            faster = time * growth.gain_m_s2
            c.step(c.all_of(faster >= 0, time * growth.rate_m_s >= 0), "no growth below 0")
            c.step(time * faster >= 0, "nor what it adds")
        tubes = {
            f"{name}_{field}": value
            for name, growth in (("wide", begun[4]), ("high", begun[5]))
            for field, value in zip(("start", "rate", "gain"), growth, strict=True)
        }
        at, rel, z, wrel = begun[:4]
        asked = {"s": at, "v": rel, "sz": z, "vz": wrel, "radius": radius, "half": half, "rho": rho}
        c.lemma(
            "permit_piece_that_is_clear_has_a_clear_tail",
            when=inside,
            d=d,
            k=flown,
            **asked,
            **tubes,
        )
        shifted = (
            Vec2(at.x + flown * rel.x, at.y + flown * rel.y), rel, z + flown * wrel, wrel,
            c.define(motion.later, begun[4], flown), c.define(motion.later, begun[5], flown),
            radius, half, rho, d - flown,
        )  # fmt: skip
        c.congruence(piece_clear, shifted, seen(whole, flown))
        c.congruence(piece_clear, seen(part, its), seen(whole, flown))

    names = ("whole", "part")
    states = [Flight(c.boolean(n), *c.reals(f"{n}_n {n}_e {n}_u {n}_t")) for n in names]
    along_items(
        c,
        [(permitted, states[0], (meeting,)), (permitted_from, states[1], (meeting, gone))],
        item=(v, vz, d, rho),
        invariant=invariant,
        each=lambda state: c.all_of(d >= 0, rho >= 0),
        known=known,
        goal=lambda results: c.implies(results[0], results[1]),
        text="the tail",
    )
