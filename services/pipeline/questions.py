"""A task's questions to other services before it offers its options, and the options left by the answers.

In state SensorRequest: to the SensorManagerService, whether a vehicle's sensors see the ground; a vehicle
without a footprint is not offered. In state OptionRoutes: to the RoutePlannerVisibilityService, for the route
from each option's start to its end; an option without a route is not offered. Only services on the same bus
are asked; without them a state is passed at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.planning.options import Option
from cratous.services.planning.performance_classes import camera_for, flyer_of
from cratous.spec.mission import SEARCHES, Task

SENSORS = "uxas.messages.task.SensorFootprintResponse"
_SENSORS_FROM, _OPTIONS_FROM = 2**60, 2**61
_TICKETS, _TASKS = 2**20, 2**39


class Asked(NamedTuple):
    """blind: vehicles without a footprint; waiting: vehicles whose routes are still to come; refused: options
    without a route, each with its reason.
    """

    blind: frozenset[int] = frozenset()
    waiting: tuple[int, ...] = ()
    refused: tuple[tuple[int, str], ...] = ()

    def left(self, options: Iterable[Option]) -> list[Option]:
        """The options still offered, each with its remaining vehicles."""
        no = {number for number, _ in self.refused}
        found = [
            replace(o, vehicles=tuple(v for v in o.vehicles if v not in self.blind))
            for o in options
            if o.option_id not in no
        ]
        return [option for option in found if option.vehicles]

    def reasons(self, task_id: int) -> list[str]:
        """Why options or vehicles are not offered."""
        made = [
            f"vehicle {vehicle} is not offered for task {task_id}: no footprint of its sensors came"
            for vehicle in sorted(self.blind)
        ]
        return made + [
            f"option {number} of task {task_id} is not offered: {why}"
            for number, why in self.refused
        ]

    def plus(self, response: Any) -> Asked:
        """Add a planner's response; unrequested and duplicate responses change nothing."""
        if response.VehicleID not in self.waiting:
            return self
        more = tuple(
            (plan.RouteID, next((pair.Value for pair in plan.RouteError), "no way was found"))
            for plan in response.RouteResponses
            if plan.RouteCost < 0
        )
        waiting = tuple(v for v in self.waiting if v != response.VehicleID)
        return self._replace(waiting=waiting, refused=(*self.refused, *more))


def sensor_id(task_id: int, ticket: int) -> int:
    """The RequestID of a task's question for footprints, distinct for each task on a bus."""
    return _SENSORS_FROM + task_id % _TASKS * _TICKETS + ticket % _TICKETS


def ticket_of_sensors(task_id: int, number: int, tickets: Iterable[int]) -> int:
    """The ticket that a ResponseID answers; -1 if it is not one of this task's."""
    return next((t for t in tickets if sensor_id(task_id, t) == number), -1)


def option_routes_id(ticket: int) -> int:
    """The RequestID of a task's question for the routes of its options."""
    return _OPTIONS_FROM + ticket


def sensors_asked(context: Context, task: Task) -> list[int]:
    """The vehicles whose footprint is needed: those eligible to search that have a suitable camera."""
    if task.kind not in SEARCHES:
        return []
    return [
        vehicle.id
        for vehicle in context.inputs.mission.vehicles
        if (not task.eligible or vehicle.id in task.eligible)
        and camera_for(task, flyer_of(vehicle).cameras) is not None
    ]


def sensor_request(context: Context, task: Task, ticket: int) -> Any | None:
    """SensorFootprintRequests for a task, or None if it needs none."""
    vehicles = sensors_asked(context, task)
    if not vehicles:
        return None
    mission = context.inputs.mission
    bands = [] if task.wavelength == "AllAny" else [task.wavelength]
    return lmcp.new(
        "SensorFootprintRequests",
        RequestID=sensor_id(task.id, ticket),
        Footprints=[
            lmcp.new(
                "FootprintRequest",
                FootprintRequestID=k,
                VehicleID=vehicle,
                EligibleWavelengths=bands,
                AglAltitudes=[flyer_of(mission.vehicle(vehicle)).alt_m - mission.frame.terrain_m],
            )
            for k, vehicle in enumerate(vehicles, 1)
        ],
    )


def blind(context: Context, task: Task, response: Any) -> frozenset[int]:
    """The vehicles asked about for which no footprint came."""
    seen = {footprint.VehicleID for footprint in response.Footprints}
    return frozenset(sensors_asked(context, task)) - seen


def route_requests(context: Context, task_id: int, options: list[Option], ticket: int) -> list[Any]:
    """One RoutePlanRequest per vehicle that represents its class; the RouteID is the option's id."""
    of: dict[int, list[Option]] = {}
    for option in options:
        of.setdefault(option.vehicles[0], []).append(option)
    return [
        lmcp.new(
            "RoutePlanRequest",
            RequestID=option_routes_id(ticket),
            AssociatedTaskID=task_id,
            VehicleID=vehicle,
            OperatingRegion=context.region,
            RouteRequests=[_through(context.places, option) for option in mine],
            IsCostOnlyRequest=True,
        )
        for vehicle, mine in of.items()
    ]


def _through(places: RequestPlaces, option: Option) -> Any:
    """The route from an option's start to its end."""
    ends = places.ends(option.start, option.end)
    return lmcp.new("RouteConstraints", RouteID=option.option_id, **ends)
