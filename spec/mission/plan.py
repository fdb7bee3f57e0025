"""What a plan is: who flies which task by which route and when. Same frame and units as `mission`.

A vehicle's plan is a chain of items. Item k consists of: `transit` from the end of item k-1 to the start pose of the
task, then (if wait_ms > 0) a loiter of exactly wait_ms on `hold`, then `path`, the task itself. Polylines are what is
flown: arcs are already divided into short legs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import NamedTuple

from cratous.spec.constraint_rows import Row
from cratous.spec.mission import Position

COST_UNITS = {"MINMAX": "ms", "CUMULATIVE": "ms", "DISTANCE": "mm", "ENERGY": "mJ"}
"""Costs that a plan can minimise: the latest end, the sum of the vehicles' last ends, the distance flown on transits
and tasks, the energy used on them; and the unit of each.
"""


def cost_text(cost: str, value: int) -> str:
    """A cost as text: in seconds, kilometres or kilojoules."""
    if COST_UNITS[cost] == "ms":
        return f"{value / 1000:.1f} s"
    return f"{value / 1e6:.3f} km" if COST_UNITS[cost] == "mm" else f"{value / 1e6:.1f} kJ"


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

    status: `optimal` only with a certificate, else `feasible`; bound: the proved lower bound of the cost;
    certificate: its digest; exhausted: whether the certificate shows it to be optimal.
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


ZONE, ELIGIBILITY, TIME, WIND, VEHICLE, ORDER = (
    "zone", "eligibility", "time", "wind", "vehicle", "order",
)  # fmt: skip
"""Kinds of obstacles to a task. No mission bounds energy, so energy is not one."""


class Remedy(NamedTuple):
    """A minimal set of changes that would make a left-out task possible.

    kinds: kinds of obstacles concerned; text: in words; zones, tasks, vehicles: those concerned; tried: it was
    computed that a vehicle could then do the task (not whether a schedule with it exists).
    """

    kinds: tuple[str, ...]
    text: str
    zones: tuple[int, ...] = ()
    tasks: tuple[int, ...] = ()
    vehicles: tuple[int, ...] = ()
    tried: bool = False


NOT_THERE_YET = "no vehicle that may do it is there yet"
"""The reason for leaving a task out for now until its vehicle joins."""


class LeftOut(NamedTuple):
    """A task that is required but not planned.

    reason: why it cannot be done; waiting: the tasks that are left out because they wait for it; instead: the planned
    tasks with which it cannot be scheduled; remedies: possible changes, each sufficient by itself as far as is known.
    """

    task_id: int
    reason: str
    waiting: tuple[int, ...] = ()
    instead: tuple[int, ...] = ()
    remedies: tuple[Remedy, ...] = ()

    @property
    def waits(self) -> bool:
        """Whether it is left out only until an eligible vehicle joins."""
        return self.reason.startswith(NOT_THERE_YET)

    @property
    def text(self) -> str:
        """In words: the task, the reason, and what else is left out because of it."""
        waiting = f"; what waits for it: {', '.join(map(str, self.waiting))}"
        return f"task {self.task_id} ({self.reason}{waiting if self.waiting else ''})"


class InPart(NamedTuple):
    """A line or an area of which only a part is planned, because zones cover the rest.

    share: lower bound of the share that the planned path sees, from 0 to 1 (without a camera: of the length that is
    flown); outside: lower bound of the share outside the zones at the vehicle's altitude; zones: their ids; names:
    the zones in words.
    """

    task_id: int
    share: float
    outside: float
    zones: tuple[int, ...]
    names: str

    @property
    def text(self) -> str:
        """In words: the task, the shares, and the zones responsible."""
        return (
            f"task {self.task_id} (planned: {percent(self.share)} of it; "
            f"{percent(self.outside)} of it lies outside of {self.names}; "
            "for the rest no way was found that keeps the zones)"
        )


def percent(share: float) -> str:
    """A share as a percentage, rounded down to a tenth."""
    return f"{math.floor(1000 * share + 1e-9) / 10:.1f} %"


@dataclass(frozen=True)
class PartialPlan(Plan):
    """A plan for the feasible part of the required tasks.

    chosen: the tasks of that part; sure: no more can be done, as far as was searched; in_part: the planned tasks of
    which only a part is done.
    """

    left_out: tuple[LeftOut, ...] = ()
    sure: bool = True
    in_part: tuple[InPart, ...] = ()


def partial(
    plan: Plan, left_out: tuple[LeftOut, ...], sure: bool, in_part: tuple[InPart, ...] = ()
) -> PartialPlan:
    """A plan that leaves these tasks out, and does those of `in_part` in part."""
    known = {f.name: getattr(plan, f.name) for f in fields(Plan)}
    return PartialPlan(**known, left_out=left_out, sure=sure, in_part=in_part)


def in_part_of(plan: Plan) -> tuple[InPart, ...]:
    """The tasks that a plan does in part; none if the plan covers everything required."""
    return plan.in_part if isinstance(plan, PartialPlan) else ()


def left_out_of(plan: Plan) -> tuple[LeftOut, ...]:
    """The tasks that a plan leaves out; none if the plan covers everything required."""
    return plan.left_out if isinstance(plan, PartialPlan) else ()


def left_out_text(plan: Plan) -> str:
    """One line of text: the tasks that a plan leaves out or does in part, and why; empty if there are none."""
    said = [left.text for left in left_out_of(plan)]
    told = [f"in part: {'; '.join(one.text for one in in_part_of(plan))}"] * bool(in_part_of(plan))
    if said:
        doubt = "" if isinstance(plan, PartialPlan) and plan.sure else "; more may be possible"
        told.insert(0, f"left out: {'; '.join(said)}{doubt}")
    return "; ".join(told)
