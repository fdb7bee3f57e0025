"""What a plan is: who flies which task by which route and when. Same frame and units as `mission`.

A vehicle's plan is a chain of items. Item k is: `transit` from where item k-1 ended to the start
pose of the task, then (if wait_ms > 0) a loiter of exactly wait_ms on `hold`, then `path`, the
task itself. Polylines are what is flown: arcs are already cut into short legs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from cratous.spec.constraint_rows import Row
from cratous.spec.mission import Position


class Pose(NamedTuple):
    """A position with a heading [rad, clockwise from north]."""

    north_m: float
    east_m: float
    alt_m: float
    heading_rad: float


@dataclass(frozen=True)
class Hold:
    """A loiter circle, tangent to the task's start pose: centre, radius, and direction."""

    north_m: float
    east_m: float
    alt_m: float
    radius_m: float
    clockwise: bool


@dataclass(frozen=True)
class PlanItem:
    """One task in one vehicle's chain; times are ms after mission start, start <= end."""

    task_id: int
    option_id: int
    vehicle_id: int
    transit: tuple[Position, ...]
    path: tuple[Position, ...]
    hold: Hold | None
    speed_m_s: float
    depart_ms: int
    arrive_ms: int
    wait_ms: int
    start_ms: int
    end_ms: int
    end_heading_rad: float
    view_elevation_rad: float | None = None
    view_azimuth_rad: float = 0.0


@dataclass(frozen=True)
class Plan:
    """A complete assignment: chains by vehicle, the constraints it was made for, and its cost.

    status: `optimal` only with a certificate, else `feasible`; bound: nothing costs less, as far as
    was proved; certificate: its digest; exhausted: whether it is optimal by its certificate.
    """

    mission: str
    items: tuple[PlanItem, ...]
    rows: tuple[Row, ...]
    chosen: tuple[int, ...]
    makespan_ms: int
    cost: str
    nodes: int
    exhausted: bool
    status: str = "feasible"
    bound: int = 0
    certificate: str = ""

    def chain(self, vehicle_id: int) -> tuple[PlanItem, ...]:
        """The items of one vehicle, in the order of flight."""
        return tuple(item for item in self.items if item.vehicle_id == vehicle_id)
