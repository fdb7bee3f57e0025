"""Whether a vehicle is on the ground of a landing site, and whether its landing roll fits into it.

Definitions: `spec.avoidance.landing`.
"""

from cratous.core.kernel import kernel


@kernel(
    implements="avoidance.landing.is_on_ground",
    restates="what a monitor and an autopilot call on the ground, by its own definition",
)
def on_ground(north: float, east: float, radius: float, height: float, slack: float) -> bool:
    """True iff a position is within a site's disc, and at most `slack` above its ground.

    north, east: from the centre of the site [m]; radius: of its disc [m]; height: above its ground [m]; slack: [m].
    """
    return north * north + east * east <= radius * radius and height <= slack


@kernel(implements="avoidance.landing.has_room")
def roll_fits(radius: float, speed: float, braking: float, off: float) -> bool:
    """True iff a landing roll centred on a site fits into its disc. Written with one division less than the
    definition.

    radius: of the disc [m]; speed: at the touch-down [m/s]; braking: [m/s2], above 0; off: how much too early or too
    late it may touch down [m].
    """
    return speed * speed + 4 * braking * off <= 4 * braking * radius
