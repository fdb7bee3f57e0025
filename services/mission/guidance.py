"""Persistence and hysteresis of a mission's alerts and bands."""

from __future__ import annotations

from cratous.spec.mission import GuidedWellClear, WellClear
from cratous.spec.mission.guidance import Guidance

USUAL = Guidance()


def guidance_of(volume: WellClear) -> Guidance:
    """The guidance given with a volume, or the default."""
    return volume.guidance if isinstance(volume, GuidedWellClear) else USUAL
