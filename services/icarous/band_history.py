"""An instance's alert and band history between evaluations, as plain values."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Ability
from cratous.core.daa.state import Band


class AlertHistory(NamedTuple):
    """Alert history of one intruder: the latest raw levels, the level shown, and since when [s]; see
    `core.daa.history.Shown`."""

    intruder: str
    alerter: int
    values: tuple[int, ...]
    level: int
    raised_s: float


class DimensionHistory(NamedTuple):
    """History of one dimension.

    last: the last bands; held: the bands shown, since held_s [s]; up, down: the resolutions shown; prefer_up:
    the preferred side; shrunk_up, shrunk_down: how often recovery was shrunk; since_s: since when the side
    has been preferred [s]. See `core.daa.history.BandMemory` and `core.daa.persistence.Ways`.
    """

    last: tuple[tuple[Band, ...], ...]
    held: tuple[Band, ...]
    held_s: float
    up: float | None
    down: float | None
    prefer_up: bool
    shrunk_up: int
    shrunk_down: int
    since_s: float | None


class Bands(NamedTuple):
    """Result of the last evaluation.

    at_ms: when [ms]; ability: the airframe's ability then; loose: some intruder was known only within bounds;
    alerts, dimensions: history by intruder and by dimension (heading first); recovers: dimensions in which no
    manoeuvre keeps well clear, so that their resolutions regain it.
    """

    at_ms: int
    ability: Ability
    loose: bool
    alerts: tuple[AlertHistory, ...]
    dimensions: tuple[DimensionHistory, ...]
    recovers: tuple[int, ...] = ()
