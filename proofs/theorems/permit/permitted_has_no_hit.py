"""A permitted trajectory does not enter the cylinder of the intruder at any instant, whatever places the vehicle
has within rho of its reference and the intruder in its tube, for every number of pieces."""

from typing import Any

from cratous.core.kernel import Fold, Vec2
from cratous.core.permit.pieces import Flight, Growth, Meeting, permitted, piece_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import along_items
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    wide = Growth(*c.reals("wide_start wide_rate wide_gain"))
    high = Growth(*c.reals("high_start high_rate high_gain"))
    s, w = c.vector("s"), c.vector("w")
    sz, wz, radius, half, at = c.reals("sz wz radius half at")
    meeting = Meeting(s, sz, w, wz, wide, high, radius, half)
    own, other = (motion.Off(*c.reals(f"{n}_x {n}_y {n}_z")) for n in ("own", "other"))
    for growth in (wide, high):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(radius >= 0, half >= 0))
    v = c.vector("v")
    vz, d, rho = c.reals("vz duration rho")
    c.opaque(piece_clear, motion.enters_at)

    def seen(north: Any, east: Any, up: Any, time: Any) -> dict[str, Any]:
        """What the kernel of a piece is asked, from where the reference is."""
        now, layer = (c.define(motion.later, growth, time) for growth in (wide, high))
        return {
            "s": Vec2(s.x + north - time * w.x, s.y + east - time * w.y),
            "v": Vec2(v.x - w.x, v.y - w.y),
            "sz": sz + up - time * wz,
            "vz": vz - wz,
            "wide": Growth(*now),
            "high": Growth(*layer),
            "radius": radius,
            "half": half,
            "rho": rho,
            "d": d,
        }

    def invariant(state: list[Any]) -> Any:
        flight, way = state
        place = (flight.north_m, flight.east_m, flight.up_m, flight.time_s)
        same = c.same(place, (way.north, way.east, way.up, way.time))
        return c.all_of(same, way.time >= 0, c.implies(flight.clear, c.negation(way.hit)))

    def known(state: list[Any]) -> None:
        flight, way = state
        mine = seen(flight.north_m, flight.east_m, flight.up_m, flight.time_s)
        asked = seen(way.north, way.east, way.up, way.time)
        c.congruence(piece_clear, tuple(mine.values()), tuple(asked.values()))
        t = at - way.time
        inside = c.all_of(t >= 0, t <= d)
        for growth in (wide, high):
            faster = way.time * growth.gain_m_s2
            c.step(c.all_of(faster >= 0, way.time * growth.rate_m_s >= 0), "no growth below 0")
            c.step(way.time * faster >= 0, "nor what it adds")
        tubes = {
            f"{name}_{part}": value
            for name in ("wide", "high")
            for part, value in zip(("start", "rate", "gain"), asked[name], strict=True)
        }
        offs = {
            f"{name}_{part}": value
            for name, off in (("own", own), ("other", other))
            for part, value in zip("xyz", off, strict=True)
        }
        rest = {name: value for name, value in asked.items() if name not in ("wide", "high")}
        c.lemma("permit_piece_clear_is_not_hit", when=inside, t=t, **rest, **tubes, **offs)

    start = motion.Way(False, 0, 0, 0, 0)
    way = motion.Way(c.boolean("hit"), *c.reals("w_north w_east w_up w_time"))
    along_items(
        c,
        [(permitted, Flight(c.boolean("clear"), *c.reals("north east up time")), (meeting,))],
        item=(v, vz, d, rho),
        invariant=invariant,
        each=lambda state: c.all_of(d >= 0, rho >= 0),
        known=known,
        goal=lambda results: c.implies(results[0], c.negation(results[1])),
        text="no hit",
        models=[
            (
                Fold("way", "permit.motion.way_step", motion.way_step, start, motion.way_result),
                way,
                (meeting, own, other, at),
            )
        ],
    )
