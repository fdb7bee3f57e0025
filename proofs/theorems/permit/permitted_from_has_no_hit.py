"""A trajectory that is permitted from an instant on does not enter the cylinder of the intruder at that instant or
any after it, whatever places the vehicle has within rho of its reference and the intruder in its tube, for
every number of pieces."""

from typing import Any

from cratous.core.kernel import Fold, Vec2
from cratous.core.permit.pieces import Flight, Growth, Meeting, permitted_from, piece_clear
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import along_items
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    wide = Growth(*c.reals("wide_start wide_rate wide_gain"))
    high = Growth(*c.reals("high_start high_rate high_gain"))
    s, w = c.vector("s"), c.vector("w")
    sz, wz, radius, half, at, gone = c.reals("sz wz radius half at gone")
    meeting = Meeting(s, sz, w, wz, wide, high, radius, half)
    own, other = (motion.Off(*c.reals(f"{n}_x {n}_y {n}_z")) for n in ("own", "other"))
    for growth in (wide, high):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(radius >= 0, half >= 0))
    c.premise(at >= gone)
    v = c.vector("v")
    vz, d, rho = c.reals("vz duration rho")
    c.opaque(piece_clear, motion.enters_at)

    def seen(north: Any, east: Any, up: Any, begin: Any) -> dict[str, Any]:
        """What the kernel of a piece is asked, of the part of it that is not over."""
        flown = c.when(gone - begin >= 0, gone - begin, 0)
        time = begin + flown
        north, east, up = north + flown * v.x, east + flown * v.y, up + flown * vz
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
            "d": d - flown,
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
        begin = way.time + c.when(gone - way.time >= 0, gone - way.time, 0)
        t = at - begin
        inside = c.all_of(t >= 0, at - way.time <= d)
        for growth in (wide, high):
            faster = begin * growth.gain_m_s2
            c.step(c.all_of(faster >= 0, begin * growth.rate_m_s >= 0), "no growth below 0")
            c.step(begin * faster >= 0, "nor what it adds")
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
        [
            (
                permitted_from,
                Flight(c.boolean("clear"), *c.reals("north east up time")),
                (meeting, gone),
            )
        ],
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
