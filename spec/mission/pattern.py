"""Patterns of a pattern search."""

from __future__ import annotations

from enum import StrEnum


class Pattern(StrEnum):
    """How a pattern search covers the surroundings of its centre."""

    SPIRAL = "spiral"
    SQUARE = "square"
    SECTOR = "sector"
    SWEEP = "sweep"
