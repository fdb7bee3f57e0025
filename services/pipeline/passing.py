"""Whether a vehicle has flown past a task between two of its states, so that none of them lists the task."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from cratous.services.pipeline.off_plan import on_its_way


class Passing(NamedTuple):
    """A task in its vehicle's plan. order: positions by waypoint number; last: that of the task's last waypoint;
    before: the command that the vehicle had reported when the plan came, which is none of this plan's (None: not
    known); at: the command under which it was last seen on its way to the task.

    A vehicle that is sent on past the task, as by IncrementWaypoint, reports another command then.
    """

    order: Mapping[int, int]
    last: int
    before: int | None
    at: int | None

    def after(self, body: Any) -> tuple[Passing, bool]:
        """What is known after a state of the vehicle, and whether it shows that the task was passed."""
        here = self.order.get(body.CurrentWaypoint)
        if here is None or not on_its_way(body) or body.CurrentCommand == self.before:
            return self, False
        if here <= self.last:
            return self._replace(at=body.CurrentCommand), False
        return self, body.CurrentCommand == self.at


def passing_of(command: Any, task: int, before: int | None) -> Passing | None:
    """A task in a MissionCommand; None if it has no waypoint there. before: as in `Passing`."""
    order = {w.Number: k for k, w in enumerate(command.WaypointList)}
    own = [k for k, w in enumerate(command.WaypointList) if task in w.AssociatedTasks]
    if not own:
        return None
    begins = order.get(command.FirstWaypoint, 0) <= own[-1]
    return Passing(order, own[-1], before, command.CommandID if begins else None)
