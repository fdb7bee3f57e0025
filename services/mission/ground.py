"""The lowest altitude at which ICAROUS manoeuvres."""

from __future__ import annotations

from cratous.spec.mission import Mission

GROUND_MARGIN = 2.0
"""Margin of manoeuvres above the ground, in vertical thresholds."""


def floor_of(mission: Mission) -> float:
    """The altitude below which no manoeuvre of ICAROUS goes [m MSL]."""
    return mission.frame.terrain_m + GROUND_MARGIN * mission.daa.well_clear.zthr_m
