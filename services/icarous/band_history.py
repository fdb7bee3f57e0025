"""What an instance remembers of its alerts and bands from look to look, as plain values."""

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
    """Of one dimension: the last bands, the one that is held since held_s [s]; the resolutions that are shown, the
    preferred side, how often recovery was shrunk for each, and since when the side is preferred [s]. See
    `core.daa.history.BandMemory` and `core.daa.persistence.Ways`."""

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
    """When was looked last [ms], what the airframe could do then, whether some intruder was known within bounds only, the
    history by intruder and by dimension (heading first), and the dimensions in which nothing keeps well clear: what
    they resolve with regains it."""

    at_ms: int
    ability: Ability
    loose: bool
    alerts: tuple[AlertHistory, ...]
    dimensions: tuple[DimensionHistory, ...]
    recovers: tuple[int, ...] = ()
