"""One vehicle's part in a task that follows an entity: its commands and its state."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.loiter_discs import broken_by
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.stations import in_ring
from cratous.services.following.chase import is_chase, slot_of, slows_down_m, speed_of
from cratous.services.following.motion import Motion
from cratous.services.following.stations import Station, at_station, camera_of, station
from cratous.services.following.task_parameters import Asked
from cratous.services.loading.coordinates import Places
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.task_state import State
from cratous.services.planning.options import Option
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

COMMANDS_FROM = 2**40
"""CommandIDs of these tasks start here, beyond those of plans."""


class Part(NamedTuple):
    """One vehicle's part.

    state: task state for this vehicle; option: the one it flies, in the context of its request; begins:
    number of the waypoint from which it follows; then: the waypoint at which it continues; held: the circle
    commanded last; seen_ms: when it was last heard; there: whether it then did what the task requires;
    blocked: reported reason why it does not reach its circle; hurries: it chases, and is not yet so near its circle
    that it slows down.
    """

    state: State
    option: Option
    context: Context
    begins: int
    then: int
    held: Station | None = None
    seen_ms: int = 0
    there: bool = False
    blocked: str = ""
    hurries: bool = False

    @property
    def vehicle(self) -> int:
        """The vehicle's id."""
        return self.state.vehicle


def command_id(task: int, ticket: int) -> int:
    """The CommandID by which a vehicle's state shows that it executes this task's command."""
    return COMMANDS_FROM + task % 2**20 * 2**10 + ticket % 2**10


def follows(part: Part, body: Any, number: int) -> bool:
    """True if a state belongs to a vehicle that flies the circle commanded by this task."""
    return bool(
        part.held is not None and body.CurrentCommand == number and body.Mode.name == "Loiter"
    )


def heard(part: Part, body: Any, asked: Asked, motion: Motion, fresh: bool, now_ms: int) -> Part:
    """The part after a state of the vehicle: its circle, and whether it does what the task requires.

    motion: of the entity at that time; fresh: False if the entity's position is unknown, so that no vehicle
    counts as there.
    """
    context, flyer, slot = part.context, part.option.flyer, slot_of(part.option)
    frame = context.inputs.mission.frame
    here = context.places.pose(body.Location, 0.0, f"state of vehicle {body.ID}", "Location")
    at, camera = Vec2(here.north_m, here.east_m), camera_of(asked, flyer)
    now = station(asked, slot, flyer, motion, frame.terrain_m)
    places = Places(frame)
    there = fresh and at_station(asked, slot, body, at, now, motion, places, camera)
    # aim at where the entity will be after about the duration of a turn
    led = motion._replace(at=motion.after(flyer.radius_m / flyer.speed_m_s))
    goal = station(asked, slot, flyer, led, frame.terrain_m)
    slow_m = slows_down_m(part.option, context.inputs.mission.vehicle(part.vehicle))
    near = in_ring(now.at, at, 0, now.radius_m + slow_m)
    part = part._replace(hurries=is_chase(part.option) and not near)
    zone = _in_the_way(part, here, goal)
    if zone:
        return part._replace(there=there, seen_ms=now_ms, blocked=zone)
    return part._replace(there=there, seen_ms=now_ms, held=goal, blocked="")


def _in_the_way(part: Part, here: Pose, goal: Station) -> str:
    """The zone that a circle, or the straight way to its centre, breaks; "" if none."""
    zones, middle = part.context.inputs.zones, Position(*goal.at, part.option.flyer.alt_m)
    zone = broken_by(middle, goal.radius_m, zones)
    if zone is None:
        leg = first_bad_leg((Position(*here[:3]), middle), zones)
        zone = None if leg is None else leg[1]
    return "" if zone is None else name_of(zone)


def circling(part: Part, task: int, number: int, asked: Asked, motion: Motion) -> Any:
    """The VehicleActionCommand that keeps a vehicle on its circle and its camera on the entity."""
    assert part.held is not None
    flyer = part.option.flyer
    actions = [loiter(part, task)]
    camera = camera_of(asked, flyer)
    if camera is not None:
        ground = Position(*motion.at, part.context.inputs.mission.frame.terrain_m)
        actions.append(
            lmcp.new(
                "GimbalStareAction",
                AssociatedTaskList=[task],
                PayloadID=camera.payload_id,
                Starepoint=_location(part.context, ground),
            )
        )
    return lmcp.new(
        "VehicleActionCommand",
        CommandID=number,
        VehicleID=part.vehicle,
        VehicleActionList=actions,
    )


def loiter(part: Part, task: int) -> Any:
    """The LoiterAction of the circle commanded last, of unlimited duration."""
    assert part.held is not None
    middle, speed = Position(*part.held.at, part.option.flyer.alt_m), part.option.flyer.speed_m_s
    if part.hurries:
        speed = speed_of(part.option, part.context.inputs.mission.vehicle(part.vehicle))
    return lmcp.new(
        "LoiterAction",
        AssociatedTaskList=[task],
        LoiterType="Circular",
        Radius=part.held.radius_m,
        Direction="Clockwise",
        Duration=-1,
        Airspeed=speed,
        Location=_location(part.context, middle),
    )


def at_speed(part: Part, made: Any) -> Any:
    """A TaskImplementationResponse with the speed of a chase on the way from its beginning; others as they are."""
    if type(made).__name__ != "TaskImplementationResponse" or not is_chase(part.option):
        return made
    speed = speed_of(part.option, part.context.inputs.mission.vehicle(part.vehicle))
    own = [w for w in made.TaskWaypoints if w.AssociatedTasks]
    there = [w.copy(Speed=speed) for w in own[1:]]
    return made.copy(TaskWaypoints=[*made.TaskWaypoints[: -len(own)], own[0], *there])


def _location(context: Context, at: Position) -> Any:
    """A place as a Location3D; not cached, since there are many."""
    lat, lon = context.places.projection.to_geodetic(at.north_m, at.east_m)
    return lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=at.alt_m)


def released(part: Part, task: int, number: int, points: Mapping[int, Position]) -> tuple[Any, str]:
    """The command to the next waypoint of a vehicle's plan, or None and why it cannot continue.

    points: the waypoints of its plan by number. The loiter action is added for autopilots, such as AMASE's,
    that take a GoToWaypointAction alone as the end of all commands.
    """
    goal = points.get(part.then)
    if goal is None or part.held is None:
        return None, "no waypoint of its plan comes after the task"
    here = Position(*part.held.at, part.option.flyer.alt_m)
    leg = first_bad_leg((here, goal), part.context.inputs.zones)
    if leg is not None:
        return None, f"{name_of(leg[1])} keeps it from its plan"
    on = lmcp.new("GoToWaypointAction", WaypointNumber=part.then)
    return lmcp.new(
        "VehicleActionCommand",
        CommandID=number,
        VehicleID=part.vehicle,
        VehicleActionList=[loiter(part, task), on],
    ), ""
