"""One planning request in the mission frame, and the results of the pure stages, each computed once.

Messages carry degrees and costs; here are the exact poses, polylines and found routes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice

from cratous.core.assignment.problem import Branch, Fixed
from cratous.services.loading.ground import drives
from cratous.services.loading.polygons import hard_zones
from cratous.services.planning import stages
from cratous.services.planning.mission_assign import problem_of
from cratous.services.planning.options import Dropped, Option, expand, flyer_of
from cratous.services.planning.routes import Routes
from cratous.spec.algebra import Term
from cratous.spec.algebra.meaning import tasks
from cratous.spec.assignment.search import AssignmentProblem
from cratous.spec.constraint_rows import AFTER_END
from cratous.spec.mission import Mission, Zone
from cratous.spec.mission.plan import Pose

WAYS_AT_ONCE = 4096
WAYS_AHEAD_MOST = 200_000
"""Most routes found in advance: about 100 MB."""
Offers = tuple[tuple[Option, ...], tuple[Dropped, ...]]
"""The options of a task, and the dropped ones."""


@dataclass
class Inputs:
    """A mission from given poses at an instant [ms], with the tasks already flown.

    flying: the poses are actual positions in flight, not the user's input; absent: vehicles that take no
    part, with the reasons; undone: tasks that ended undone, with the reasons; begun: tasks that have begun
    but not ended.
    """

    mission: Mission
    starts: dict[int, Pose]
    fixed: tuple[Fixed, ...] = ()
    now_ms: int = 0
    flying: bool = False
    absent: Mapping[int, str] = field(default_factory=dict)
    undone: Mapping[int, str] = field(default_factory=dict)
    begun: frozenset[int] = frozenset()
    _taken: dict[int, Offers] = field(default_factory=dict, compare=False, repr=False)

    def take_over(self, earlier: Inputs) -> None:
        """Reuse options and routes of an earlier request where all that they depend on is the same: task,
        vehicles and their performance, zones, terrain; not the vehicles' positions.
        """
        made: Mapping[int, Offers] = {**earlier._taken, **earlier.__dict__.get("_by_task", {})}
        if not made or earlier._surroundings != self._surroundings:
            return
        for task in self.mission.tasks:
            if task.id in made and earlier.mission.task(task.id) == task:
                self._taken.setdefault(task.id, made[task.id])
        options = [option for made, _ in self._taken.values() for option in made]
        known = {pose for option in options for pose in (option.start, option.end)}
        self.finder.take_over(
            earlier.finder, known
        )  # not those of other tasks: they would accumulate

    def make_options(self, task_id: int) -> None:
        """Compute the options of one task in advance."""
        if task_id not in self._taken:
            self._taken[task_id] = expand(self.mission, [self.mission.task(task_id)], self.zones)

    def find_ways(self) -> Iterator[None]:
        """Compute travel times between options in advance, a block at a time, up to WAYS_AHEAD_MOST routes."""
        left = WAYS_AHEAD_MOST
        for index, vehicle in enumerate(self.mission.vehicles):
            mine = [k for k, option in enumerate(self.options) if vehicle.id in option.vehicles]
            pairs = ((a, b) for a in mine for b in mine if self._differ(a, b))
            while some := list(islice(pairs, min(left, WAYS_AT_ONCE))):
                self.routes.prepare(index, some)
                left -= len(some)
                yield

    def _differ(self, one: int, other: int) -> bool:
        return self.options[one].task_id != self.options[other].task_id

    @property
    def _surroundings(self) -> tuple[object, tuple[Zone, ...], float]:
        """What options depend on besides their task."""
        flyers = [(one.id, drives(one), flyer_of(one)) for one in self.mission.vehicles]
        return flyers, self.zones, self.mission.frame.terrain_m

    def check_starts(self) -> None:
        """BadInput if the user placed a vehicle where it may not be."""
        if not self.flying:
            stages.check_starts(self.mission, self.starts, self.zones)

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        return hard_zones(self.mission.zones)

    @cached_property
    def resolved(self) -> tuple[tuple[Branch, ...], bool]:
        """The branches found, and whether these are all of them."""
        return stages.branches_of(self.mission, self.fixed)

    @property
    def branches(self) -> tuple[Branch, ...]:
        return self.resolved[0]

    @property
    def all_branches(self) -> bool:
        """False if there are more resolutions of `+` than were examined here."""
        return self.resolved[1]

    @cached_property
    def term(self) -> Term:
        """The term of the mission's relations."""
        return stages.term_of(self.mission)

    @cached_property
    def wanted(self) -> tuple[int, ...]:
        """Ids of the tasks of any branch that are not flown and have not ended undone."""
        done = {f.task_id for f in self.fixed} | self.undone.keys()
        if not self.all_branches:
            return tuple(sorted(set(tasks(self.term)) - done))
        return tuple(sorted({t for branch in self.branches for t in branch.tasks} - done))

    @cached_property
    def _by_task(self) -> dict[int, Offers]:
        made = {}
        for task in self.wanted:
            known = self._taken.get(task)
            made[task] = known or expand(self.mission, [self.mission.task(task)], self.zones)
        return made

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
            # transitive closure, reached after as many rounds as there are tasks
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
    def finder(self) -> Routes:
        """Routes of the mission's vehicles, not yet bound to options."""
        return Routes(self.mission, self.starts, (), self.zones, self.flying)

    @cached_property
    def routes(self) -> Routes:
        """Routes from the starts and between the options."""
        return self.finder.between(self.options)

    def problem(self, travel_ms: Callable[[int, int, int], int | None]) -> AssignmentProblem:
        """The assignment problem with external travel times (the cost matrix)."""
        return problem_of(self.mission, self.term, self.options, travel_ms, self.fixed, self.now_ms)
