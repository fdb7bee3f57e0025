"""Where the frame of a mission lies that UxAS messages make."""

from __future__ import annotations

from cratous.services.loading import uxas_parts as parts
from cratous.services.loading.uxas_cfg import Configuration
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

BESIDE_DEG = 0.02
"""Frames that are no farther apart than this are as good as each other [deg of latitude and longitude]."""


def frame_of(cfg: Configuration, earlier: Frame | None = None) -> Frame:
    """A frame in the middle of everything that has a place, so that errors stay small.

    The earlier one where that is near the middle: so a task is at the same place in the next request.
    BadInput if nothing has a place.
    """
    places = [place for sent in cfg.messages for place in parts.locations(sent.body)]
    if not places:
        raise BadInput("no message has a place", where=str(cfg.path), expected="vehicles")
    # what is no place is refused where it is needed
    found = [place for place in places if parts.is_place(*place)] or [(0.0, 0.0)]
    # places that nobody has filled in lie at 0, 0; where the frame lies changes no meaning
    latitudes, longitudes = zip(*([p for p in found if p != (0.0, 0.0)] or found), strict=True)
    middle = Frame(
        round((min(latitudes) + max(latitudes)) / 2, 6),
        round((min(longitudes) + max(longitudes)) / 2, 6),
    )
    return earlier if earlier is not None and _beside(earlier, middle) else middle


def _beside(one: Frame, other: Frame) -> bool:
    """Whether two frames are so near to each other that errors are as small in both."""
    north_deg = one.latitude_deg - other.latitude_deg
    east_deg = one.longitude_deg - other.longitude_deg
    return max(abs(north_deg), abs(east_deg)) <= BESIDE_DEG
