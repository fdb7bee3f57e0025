"""Chooses the frame of a mission made from UxAS messages."""

from __future__ import annotations

from cratous.services.loading import uxas_parts as parts
from cratous.services.loading.uxas_cfg import Configuration
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

BESIDE_DEG = 0.02
"""Frames no farther apart than this are equivalent [deg of latitude and longitude]."""


def frame_of(cfg: Configuration, earlier: Frame | None = None) -> Frame:
    """A frame in the middle of all positions, so that projection errors stay small.

    The earlier frame is kept if it is near the middle, so that a task has the same coordinates in
    the next request. BadInput if there is no position.
    """
    places = [place for sent in cfg.messages for place in sent.places]
    if not places:
        raise BadInput("no message has a place", where=str(cfg.path), expected="vehicles")
    # invalid positions are refused where they are needed
    found = [place for place in places if parts.is_place(*place)] or [(0.0, 0.0)]
    # unset positions are at 0, 0; the choice of the frame has no effect on meaning
    latitudes, longitudes = zip(*([p for p in found if p != (0.0, 0.0)] or found), strict=True)
    middle = Frame(
        round((min(latitudes) + max(latitudes)) / 2, 6),
        round((min(longitudes) + max(longitudes)) / 2, 6),
    )
    return earlier if earlier is not None and _beside(earlier, middle) else middle


def _beside(one: Frame, other: Frame) -> bool:
    """Whether two frames are so close that projection errors are equally small in both."""
    north_deg = one.latitude_deg - other.latitude_deg
    east_deg = one.longitude_deg - other.longitude_deg
    return max(abs(north_deg), abs(east_deg)) <= BESIDE_DEG
