"""Kinds of resolution manoeuvres that a mission may have searched for first."""

from __future__ import annotations

from enum import StrEnum


class Resolution(StrEnum):
    """Kinds of resolution manoeuvres: heading: turns; altitude: climbs and descents; speed: slower or faster flight."""

    HEADING = "heading"
    ALTITUDE = "altitude"
    SPEED = "speed"
