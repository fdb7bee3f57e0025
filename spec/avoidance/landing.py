"""Landing: what is on the ground, and how much of it a roll takes. Metres, seconds."""


def is_on_ground(north: float, east: float, radius: float, height: float, slack: float) -> bool:
    """A place is on the ground of a site: within the disc of the site, and not above its ground by more than the slack.

    north, east: from the middle of the site; height: above its ground."""
    return north * north + east * east <= radius * radius and height <= slack


def has_room(radius: float, speed: float, braking: float, off: float) -> bool:
    """A roll in a straight line that begins at the speed and brakes evenly fits into the disc of a site, if its middle
    is aimed at the site's and it begins by `off` too early or too late: half of it, and that, reach no farther."""
    return speed * speed / (4 * braking) + off <= radius
