"""Landing: when a vehicle is on the ground, and how much room its landing roll takes. Metres, seconds."""


def is_on_ground(north: float, east: float, radius: float, height: float, slack: float) -> bool:
    """A position is on the ground of a site: within the disc of the site, and above its ground by at most the slack.

    north, east: relative to the centre of the site; height: above its ground.
    """
    return north * north + east * east <= radius * radius and height <= slack


def has_room(radius: float, speed: float, braking: float, off: float) -> bool:
    """A straight landing roll that begins at the speed and brakes evenly fits into the disc of a site, if its
    midpoint is aimed at the site's centre and it begins by up to `off` too early or too late: half the roll plus
    `off` is at most the radius.
    """
    return speed * speed / (4 * braking) + off <= radius
