"""What a task's service knows of its requests and of the vehicle that flies it."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.tasks import Task as Kernel
from cratous.services.pipeline.off_plan import WITH_UXAS
from cratous.services.pipeline.passing import Passing
from cratous.services.pipeline.questions import Asked
from cratous.services.pipeline.steering import Steering


class State(NamedTuple):
    """The kernel's state; the implementation request in progress; the assigned vehicle, and its camera
    steering (None: none).

    The kernel identifies requests by increasing tickets, since RequestIDs need not increase; tickets: the
    newest ones with their RequestIDs. asked: other services' answers about the options. away: whether ICAROUS
    has the vehicle, it circles without the link, or either is just over: the tasks in its states then do not
    refer to the plan. passing: where the task stands in its vehicle's plan, if that is sent out.
    """

    task: Kernel = Kernel(0, 0, 0)
    chosen: Any = None
    vehicle: int = 0
    steering: Steering | None = None
    tickets: tuple[tuple[int, int], ...] = ((0, 0),)
    asked: Asked = Asked()
    away: int = WITH_UXAS
    passing: Passing | None = None

    def number(self, ticket: int) -> int:
        """The RequestID of a ticket."""
        return dict(self.tickets)[ticket]

    def ticket(self, number: int) -> int:
        """The ticket of the request in progress, or of the next one, that has this RequestID; -1 for neither."""
        mine = (self.task.request, self.task.kept)
        return next((t for t, n in self.tickets if n == number and t in mine), -1)

    def arrived(self, number: int) -> tuple[State, int]:
        """The state with a ticket for a request, and that ticket."""
        ticket = self.ticket(number)
        if ticket >= 0:
            return self, ticket
        ticket = self.tickets[-1][0] + 1
        mine = (self.task.request, self.task.kept)
        kept = tuple(pair for pair in self.tickets if pair[0] in mine)
        return self._replace(tickets=(*kept, (ticket, number))), ticket
