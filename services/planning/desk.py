"""What the planning services share besides messages: exact poses, polylines and found routes.

Messages carry degrees and costs; the desk keeps, per request, the exact inputs in the mission
frame and remembers what the pure stages computed from them. It decides nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from cratous.bridge import lmcp
from cratous.core.assignment import Assignment, Branch, Fixed
from cratous.services.bus import Envelope
from cratous.services.frames import Projection
from cratous.services.planning import stages
from cratous.services.planning.mission_assign import problem_of
from cratous.services.planning.options import Dropped, Option, expand
from cratous.services.planning.routes import Routes
from cratous.services.planning.zones import hard_zones
from cratous.spec.algebra import Term
from cratous.spec.algebra_meaning import tasks
from cratous.spec.assignment import AssignmentProblem
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.plan import Pose
from cratous.spec.schedule import AFTER_END


@dataclass
class Inputs:
    """One planning request in the mission frame, and what follows from it (computed once).

    absent: the vehicles that take no part, with the reasons; assigned, certificate: what the
    assignment service has found for it.
    """

    mission: Mission
    starts: dict[int, Pose]
    fixed: tuple[Fixed, ...]
    now_ms: int
    absent: Mapping[int, str] = field(default_factory=dict)
    assigned: Assignment | None = None
    certificate: dict[str, Any] | None = None

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        return hard_zones(self.mission.zones)

    @cached_property
    def _branches(self) -> tuple[tuple[Branch, ...], bool]:
        return stages.branches_of(self.mission, self.fixed)

    @property
    def branches(self) -> tuple[Branch, ...]:
        return self._branches[0]

    @property
    def all_branches(self) -> bool:
        """False if there were more ways to resolve `+` than were looked at here."""
        return self._branches[1]

    @cached_property
    def term(self) -> Term:
        """The mission's relations."""
        return stages.term_of(self.mission)

    @cached_property
    def wanted(self) -> tuple[int, ...]:
        """The tasks of any branch that are not yet flown, by id."""
        done = {f.task_id for f in self.fixed}
        if not self.all_branches:
            return tuple(sorted(set(tasks(self.term)) - done))
        return tuple(sorted({t for branch in self.branches for t in branch.tasks} - done))

    @cached_property
    def _by_task(self) -> dict[int, tuple[tuple[Option, ...], tuple[Dropped, ...]]]:
        return {
            task: expand(self.mission, [self.mission.task(task)], self.zones)
            for task in self.wanted
        }

    def options_of(self, task_id: int) -> tuple[Option, ...]:
        """The options of one task."""
        return self._by_task[task_id][0]

    @cached_property
    def options(self) -> tuple[Option, ...]:
        """All options; their order is the numbering of the assignment's candidates."""
        return tuple(option for task in self.wanted for option in self.options_of(task))

    @cached_property
    def dropped(self) -> tuple[Dropped, ...]:
        return tuple(drop for task in self.wanted for drop in self._by_task[task][1])

    @cached_property
    def index(self) -> dict[tuple[int, int], int]:
        """Candidate index by (task id, option id)."""
        return {(o.task_id, o.option_id): k for k, o in enumerate(self.options)}

    @cached_property
    def may_follow(self) -> frozenset[tuple[int, int]]:
        """(before, after): tasks that some branch lets one vehicle fly in this order."""
        found: set[tuple[int, int]] = set()
        if not self.all_branches:
            return frozenset((a, b) for a in self.wanted for b in self.wanted if a != b)
        for branch in self.branches:
            earlier: dict[int, set[int]] = {task: set() for task in branch.tasks}
            for row in branch.rows:
                if row.kind == AFTER_END:
                    earlier[row.i] |= set(row.group)
            # all predecessors of predecessors; a task's own are complete after as many rounds
            for _ in branch.tasks:
                for task in branch.tasks:
                    for before in tuple(earlier[task]):
                        earlier[task] |= earlier.get(before, set())
            found |= {
                (a, b) for a in branch.tasks for b in branch.tasks if a != b and b not in earlier[a]
            }
        return frozenset(found)

    @cached_property
    def vehicle_index(self) -> dict[int, int]:
        return {vehicle.id: k for k, vehicle in enumerate(self.mission.vehicles)}

    @cached_property
    def routes(self) -> Routes:
        return Routes(self.mission, self.starts, self.options, self.zones)

    def problem(self, travel_ms: Callable[[int, int, int], int | None]) -> AssignmentProblem:
        """The assignment problem with travel times from elsewhere (the cost matrix)."""
        return problem_of(self.mission, self.term, self.options, travel_ms, self.fixed, self.now_ms)


class Desk:
    """The requests so far; a service without subscriptions, so that it is found on its bus."""

    name = "PlanningDesk"
    subscribes: tuple[str, ...] = ()

    def __init__(self, mission: Mission) -> None:
        self.mission = mission
        self.projection = Projection(mission.frame)
        self.requests: list[Inputs] = []

    def start(self) -> Any:
        return self

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        return state, ()

    def open(self, inputs: Inputs) -> int:
        """Put a request on the desk; its id, from 1."""
        self.requests.append(inputs)
        return len(self.requests)

    def inputs(self, request_id: int) -> Inputs:
        """The request with this id."""
        return self.requests[request_id - 1]

    def location(self, point: Position | Pose) -> Any:
        """A point as Location3D (degrees, metres MSL)."""
        lat, lon = self.projection.to_geodetic(point.north_m, point.east_m)
        return lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=point.alt_m)

    def waypoints(
        self, points: Sequence[Position], first: int, speed_m_s: float, tasks: Sequence[int]
    ) -> list[Any]:
        """Waypoints numbered from `first`, each leading to the next."""
        lats, lons = self.projection.to_geodetic_many(
            [p.north_m for p in points], [p.east_m for p in points]
        )
        return [
            lmcp.new(
                "Waypoint",
                Latitude=float(lat),
                Longitude=float(lon),
                Altitude=point.alt_m,
                Number=first + k,
                NextWaypoint=first + k + 1,
                Speed=speed_m_s,
                AssociatedTasks=list(tasks),
            )
            for k, (point, lat, lon) in enumerate(zip(points, lats, lons, strict=True))
        ]


def status(request_id: int, kind: str, facts: Iterable[tuple[str, str]]) -> Any:
    """A ServiceStatus about a request: kind is Information, Warning or Error."""
    pairs = [("RequestID", str(request_id)), *facts]
    return lmcp.new(
        "ServiceStatus",
        StatusType=kind,
        PercentComplete=100.0 if kind == "Information" else 0.0,
        Info=[lmcp.new("KeyValuePair", Key=key, Value=value) for key, value in pairs],
    )
