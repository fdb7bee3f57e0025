"""Attributes of IcarousCommunicationService on what is flown while an ICAROUS instance is not heard.

| attribute | default | meaning |
|---|---|---|
| LostLink | none | `finish`, `loiter` or `return`; without it, a vehicle that UxAS has goes on with its mission |
| LostLinkAfter_s | 30 | the silence after which that begins, and one that ICAROUS has is without the link [s] |
| LostLinkTo | none | the place of `return`: latitude, longitude [deg], altitude [m MSL]; none: its first place |
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from cratous.services.loading.uxas_settings import Attr, Entry, choice, number
from cratous.spec.mission.bridge_times import USUAL
from cratous.spec.mission.link_loss import WithoutLink

CHOICES = (WithoutLink.FINISH.value, WithoutLink.LOITER.value, WithoutLink.RETURN.value)
AFTER_MS = USUAL.lost_link_after_ms
"""Silence after which the link to an instance counts as lost, if nothing else is configured [ms]."""
ATTRIBUTES: Mapping[str, Attr] = {
    "LostLink": choice("", "", *CHOICES),
    "LostLinkAfter_s": number(AFTER_MS / 1000, 1.0, 3600.0),
    "LostLinkTo": Attr(),
}


class Place(NamedTuple):
    """A place in degrees and metres above mean sea level."""

    lat_deg: float
    long_deg: float
    alt_m: float

    @property
    def is_on_earth(self) -> bool:
        """Whether its numbers are those of a place."""
        return abs(self.lat_deg) <= 90 and abs(self.long_deg) <= 180 and math.isfinite(self.alt_m)


class LostLinkAttributes(NamedTuple):
    """The values. choice: None if not given; to: the place of `return`, None if not given."""

    choice: WithoutLink | None
    after_ms: int
    to: Place | None


def lost_link_attributes(entry: Entry, values: Mapping[str, Any]) -> LostLinkAttributes:
    """The attributes' values together. BadInput for a place that is none, or to which nothing returns."""
    asked = WithoutLink(values["LostLink"]) if values["LostLink"] else None
    to = None
    if text := values["LostLinkTo"]:
        try:
            to = Place(*map(float, text.split()))
        except (TypeError, ValueError):
            to = None
        if asked is not WithoutLink.RETURN or to is None or not to.is_on_earth:
            expected = 'LATITUDE LONGITUDE ALTITUDE [deg, deg, m MSL], with LostLink="return"'
            raise entry.refusal("no place to return to", "LostLinkTo", expected, text[:80])
    return LostLinkAttributes(asked, round(1000 * values["LostLinkAfter_s"]), to)
