"""How alerts and bands follow one another in a mission's flight."""

from __future__ import annotations

from cratous.spec.mission import GuidedWellClear, WellClear
from cratous.spec.mission.guidance import Guidance

USUAL = Guidance()


def guidance_of(volume: WellClear) -> Guidance:
    """Of a volume: as its mission says, or as usual."""
    return volume.guidance if isinstance(volume, GuidedWellClear) else USUAL
