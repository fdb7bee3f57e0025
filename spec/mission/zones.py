"""Zones of a mission: standing polygons, keep-outs that move, and the regions that stand for them for a while."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class ZoneKind(StrEnum):
    KEEP_IN = "keep_in"
    KEEP_OUT = "keep_out"


@dataclass(frozen=True)
class Zone:
    """A polygon in the horizontal plane, between floor and ceiling (MSL), for all vehicles.

    vertices: (north, east) [m], simple, at least three, either orientation, the first not repeated at the end. A
    keep-out contains its own boundary, a keep-in does not. padding_m widens a keep-out and narrows a keep-in.
    """

    id: int
    kind: ZoneKind
    vertices: tuple[tuple[float, float], ...]
    floor_m: float
    ceiling_m: float
    padding_m: float = 0.0
    label: str = ""


@dataclass(frozen=True)
class MovingZone:
    """A keep-out that moves straight at velocity_m_s (north, east) [m/s], boundary included.

    It is in force from from_ms on, when its vertices (north, east) [m] are where they say, until until_ms, or to the
    end of the flight if None [ms]. Deliberately no `Zone`: what checks a standing polygon cannot be given it.
    """

    id: int
    vertices: tuple[tuple[float, float], ...]
    floor_m: float
    ceiling_m: float
    velocity_m_s: tuple[float, float]
    from_ms: int = 0
    until_ms: int | None = None

    @property
    def kind(self) -> ZoneKind:
        """Always a keep-out."""
        return ZoneKind.KEEP_OUT


@dataclass(frozen=True)
class SweptZone(Zone):
    """A standing region that contains a moving zone for a while: plans and manoeuvres keep out of it.

    It has the moving zone's id and is replaced, in place, by the region of the next span of time. The
    guarantee is about the moving zone itself; no verdict is about its regions.
    """

    moving: MovingZone = MovingZone(0, (), 0.0, 0.0, (0.0, 0.0))
