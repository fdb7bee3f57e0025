"""A roll of even braking fits into the disc of a landing site exactly when, however much too early or too late the
vehicle touches down within what is allowed for, it is within the disc from the touch-down to where it stands."""

from cratous.core.avoidance.landing import on_ground, roll_fits
from cratous.proofs.claim import Claim
from cratous.spec.avoidance import landing


def claim(c: Claim) -> None:
    radius, speed, braking, off = c.reals("radius speed braking off")
    roll, touch, rolled, height, slack = c.reals("roll touch rolled height slack")
    c.premise(c.all_of(radius >= 0, speed >= 0, braking > 0, off >= 0))
    # to a stand: speed^2 = 2 braking roll
    c.premise(c.all_of(roll >= 0, speed * speed == 2 * braking * roll))
    fits = c.use(roll_fits, radius, speed, braking, off)
    room = c.define(landing.has_room, radius, speed, braking, off)
    c.show(c.same(fits, room), "its definition")
    enough = roll + 2 * off <= 2 * radius
    c.show(c.same(fits, enough), "half of the roll, and what it is off")
    within = c.all_of(-off <= touch + roll / 2, touch + roll / 2 <= off)
    on_it = c.all_of(rolled >= 0, rolled <= roll)
    place = touch + rolled
    stays = c.all_of(-radius <= place, place <= radius)
    c.show(c.implies(c.all_of(enough, within, on_it), stays), "it stays on the site")
    early = -off - roll / 2
    c.show(c.implies(c.negation(enough), early < -radius), "else it may touch down before the site")

    north, east = c.reals("north east")
    said = c.use(on_ground, north, east, radius, height, slack)
    there = c.define(landing.is_on_ground, north, east, radius, height, slack)
    c.show(c.same(said, there), "what is on the ground")
