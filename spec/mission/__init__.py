"""What a mission is: vehicles, tasks, zones, relations and traffic, as plain frozen data.

Everything inside is SI in ONE local tangent frame per mission: north and east in metres from the frame's origin,
altitude in metres above mean sea level (MSL), headings in radians clockwise from north, times in integer milliseconds
after mission start (when the automation response is accepted). Degrees, feet and AGL altitudes exist only in loaders.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

from cratous.spec.mission.bridge_times import USUAL, BridgeTimes
from cratous.spec.mission.camera import Camera as Camera
from cratous.spec.mission.guidance import Guidance
from cratous.spec.mission.link_loss import LandingSite, WithoutLink
from cratous.spec.mission.merging import Merging
from cratous.spec.mission.on_failure import OnFailure
from cratous.spec.mission.pattern import Pattern as Pattern
from cratous.spec.mission.resolution import Resolution as Resolution
from cratous.spec.mission.sensing import Sensing
from cratous.spec.mission.simulation import FaultySimulation as FaultySimulation
from cratous.spec.mission.simulation import Simulation as Simulation
from cratous.spec.mission.zones import MovingZone as MovingZone
from cratous.spec.mission.zones import SweptZone as SweptZone
from cratous.spec.mission.zones import Zone as Zone
from cratous.spec.mission.zones import ZoneKind as ZoneKind


class Position(NamedTuple):
    """A point in the mission frame: north and east [m], altitude MSL [m]."""

    north_m: float
    east_m: float
    alt_m: float


class Velocity(NamedTuple):
    """Ground velocity: north, east, down [m/s]; down is positive towards the ground."""

    north_m_s: float
    east_m_s: float
    down_m_s: float


@dataclass(frozen=True)
class Frame:
    """Origin of the local tangent frame (WGS-84 degrees) and the height of the flat terrain."""

    latitude_deg: float
    longitude_deg: float
    terrain_m: float = 0.0


@dataclass(frozen=True)
class Vehicle:
    """One aircraft. `protected` ones get an ICAROUS instance and the guarantees G1 to G5. power_w: drawn in flight [W],
    None if not known.
    """

    id: int
    label: str
    position: Position
    heading_rad: float
    speed_m_s: float
    min_speed_m_s: float
    max_speed_m_s: float
    max_bank_rad: float
    max_climb_m_s: float
    protected: bool
    cameras: tuple[Camera, ...] = ()
    cruise_m: float | None = None
    power_w: float | None = None

    @property
    def cruise_alt_m(self) -> float:
        """The altitude at which it flies its tasks [m MSL]: its start altitude unless given."""
        return self.position.alt_m if self.cruise_m is None else self.cruise_m


@dataclass(frozen=True)
class GroundedVehicle(Vehicle):
    """A vehicle that stands on the ground at the start, below its position, and takes off first.

    ground_m: ground elevation there [m MSL]; its position, heading and speed are those at which its plan begins.
    """

    ground_m: float = 0.0

    @property
    def stands_at(self) -> Position:
        """The position at which it stands."""
        return self.position._replace(alt_m=self.ground_m)


class TaskKind(StrEnum):
    LINE_SEARCH = "line_search"
    POINT_SEARCH = "point_search"
    MUST_FLY = "must_fly"
    LOITER = "loiter"
    AREA_SEARCH = "area_search"
    PATTERN_SEARCH = "pattern_search"
    OTHER = "other"
    """A task known only from the messages of an external service; not in mission files."""


SEARCHES = (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH, TaskKind.AREA_SEARCH, TaskKind.PATTERN_SEARCH)  # fmt: skip
"""The kinds served by camera coverage."""
AREAS = (TaskKind.AREA_SEARCH, TaskKind.PATTERN_SEARCH)
"""The kinds for which an entire area has to be seen."""


@dataclass(frozen=True)
class View:
    """The direction from which the sensor looks at the target: boresight azimuth and elevation [rad].

    azimuth is clockwise from the direction of flight, or from north if `inertial`; elevation is negative downwards. A
    view of None means any. azimuth_extent_rad: width of the permitted sector of directions, centred on azimuth; 0:
    that direction alone.
    """

    azimuth_rad: float
    elevation_rad: float
    inertial: bool = False
    azimuth_extent_rad: float = 0.0


@dataclass(frozen=True)
class Loiter:
    """A closed path around `centre`: `circular`, `racetrack` or `figure_eight`.

    radius_m: turn radius (0: the vehicle's own); axis_rad: direction of the long axis, from north; length_m: of a
    racetrack's straights, or between a figure-eight's turn centres (at least 2 radius_m); direction: `clockwise`,
    `counter_clockwise` or `any`.
    """

    centre: Position
    radius_m: float
    shape: str = "circular"
    axis_rad: float = 0.0
    length_m: float = 0.0
    direction: str = "any"


@dataclass(frozen=True)
class Task:
    """One task. An empty `eligible` means every vehicle.

    points: the line (line_search), the target (point_search), the point to fly through (must_fly), the centre
    (loiter, pattern_search) or the corners of a polygon (area_search). duration_ms: loiter or dwell time. radius_m:
    loiter radius. views: permitted alternatives to `view`. standoff_m: minimum distance of the aircraft from a point
    that it searches. loiter: the path to fly in a loiter, or while looking at a point. gsd_m: coarsest permitted
    ground sample distance [m per pixel], 0: any. sweep_rad: direction of an area's lanes, None: any; start_point:
    where the search of an area has to begin. extent_m: extent of a pattern from its centre: over a disc (spiral,
    sector) or a square (square, sweep). priority: if not all tasks can be done, those of higher priority are.
    """

    id: int
    kind: TaskKind
    label: str
    points: tuple[Position, ...]
    eligible: tuple[int, ...] = ()
    duration_ms: int = 0
    radius_m: float = 0.0
    view: View | None = None
    wavelength: str = "AllAny"
    views: tuple[View, ...] = ()
    standoff_m: float = 0.0
    loiter: Loiter | None = None
    gsd_m: float = 0.0
    sweep_rad: float | None = None
    start_point: Position | None = None
    pattern: Pattern | None = None
    extent_m: float = 0.0
    priority: int = 0


@dataclass(frozen=True)
class Traffic:
    """An aircraft outside the control of the mission: in straight flight, or along `waypoints`."""

    id: int
    position: Position
    velocity: Velocity
    appears_ms: int = 0
    vanishes_ms: int | None = None


@dataclass(frozen=True)
class WellClear:
    """Well-clear volume (modified tau): DTHR and ZTHR [m], TTHR and TCOA [s]."""

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float


@dataclass(frozen=True)
class GuidedWellClear(WellClear):
    """A volume for which the mission sets the persistence and hysteresis of alerts and bands."""

    guidance: Guidance = field(default_factory=Guidance)


@dataclass(frozen=True)
class Daa:
    """How ICAROUS detects and avoids: the volume that it keeps clear and how far it looks ahead. close_starts: vehicles
    may start inside each other's volume."""

    well_clear: WellClear
    lookahead_s: float = 60.0
    buffer: float = 1.25
    close_starts: bool = False

    @property
    def looks_first(self) -> Resolution:
        """The kind of manoeuvre searched for first; other kinds are used only if it yields none."""
        if isinstance(self, OrderedDaa | OrderedSensedDaa):
            return self.resolution
        return Resolution.HEADING


@dataclass(frozen=True)
class OrderedDaa(Daa):
    """Detect and avoid in which a kind of manoeuvre other than turns is searched for first."""

    resolution: Resolution = Resolution.HEADING


@dataclass(frozen=True)
class SensedDaa(Daa):
    """Detect and avoid in which ICAROUS gets sensor measurements instead of true states."""

    sensing: Sensing = field(default_factory=lambda: Sensing(()))


@dataclass(frozen=True)
class OrderedSensedDaa(SensedDaa):
    """Both: another first kind of manoeuvre, and sensor measurements."""

    resolution: Resolution = Resolution.HEADING


@dataclass(frozen=True)
class LinkLoss:
    """What every vehicle with an ICAROUS instance flies once UxAS has been silent for more than after_ms [ms]. to: where
    to return to, None: where each vehicle started; name: of that place."""

    choice: WithoutLink
    after_ms: int = 5000
    to: Position | None = None
    name: str = ""


@dataclass(frozen=True)
class LandingLoss(LinkLoss):
    """Link loss with a landing. name: of the site, "" for the nearest; sites: all permitted landing sites."""

    sites: tuple[LandingSite, ...] = ()


@dataclass(frozen=True)
class LinkLossDaa(OrderedDaa):
    """Detect and avoid in a mission that specifies what is flown while UxAS is not heard."""

    link_loss: LinkLoss = field(default_factory=lambda: LinkLoss(WithoutLink.LOITER))


@dataclass(frozen=True)
class MergingDaa(OrderedDaa):
    """Detect and avoid of a mission in which vehicles merge at a fix."""

    merging: Merging = field(default_factory=Merging)


@dataclass(frozen=True)
class FailureDaa(OrderedDaa):
    """Detect and avoid in a mission that specifies what is flown after a declared failure."""

    on_failure: OnFailure = field(default_factory=OnFailure)


@dataclass(frozen=True)
class CombinedDaa(OrderedDaa):
    """Detect and avoid in a mission that specifies more than one of these; None: not specified."""

    sensing: Sensing | None = None
    link_loss: LinkLoss | None = None
    merging: Merging | None = None
    on_failure: OnFailure | None = None


@dataclass(frozen=True)
class Change:
    """A change that becomes known in flight; `kind` is one of those of `spec.mission.changes`."""

    at_ms: int
    kind: str
    zone: Zone | None = None
    vehicle: int = 0
    task: int = 0


@dataclass(frozen=True)
class Mission:
    """A whole mission. `relations` is the process-algebra text; empty means all tasks, any order.

    instances: ids of the vehicles with an ICAROUS instance (all protected ones unless avoidance is switched off).
    cost: a key of `spec.mission.plan.COST_UNITS`. order: "time" (precedence constrains times, design decision 1) or
    "order" (as UxAS: order of assignment only). node_limit: node limit of the assignment search (0: stop at its first
    leaf; None: the default); gap: the search may stop once (cost - bound) / cost is at most this.
    """

    name: str
    source: str
    frame: Frame
    vehicles: tuple[Vehicle, ...]
    tasks: tuple[Task, ...]
    daa: Daa
    zones: tuple[Zone, ...] = ()
    traffic: tuple[Traffic, ...] = ()
    relations: str = ""
    cost: str = "MINMAX"
    order: str = "time"
    instances: tuple[int, ...] = ()
    simulation: Simulation = field(default_factory=Simulation)
    seed: int = 0
    notes: tuple[str, ...] = ()
    node_limit: int | None = None
    gap: float = 0.0
    changes: tuple[Change, ...] = ()

    @property
    def sensing(self) -> Sensing | None:
        """The sensors of its ICAROUS instances; None: they get the true states."""
        return self.daa.sensing if isinstance(self.daa, SensedDaa | CombinedDaa) else None

    @property
    def link_loss(self) -> LinkLoss | None:
        """What is flown while UxAS is not heard; None: not specified."""
        return self.daa.link_loss if isinstance(self.daa, LinkLossDaa | CombinedDaa) else None

    @property
    def bridge_times(self) -> BridgeTimes:
        """How long the link may be silent, and a vehicle may circle without it."""
        return self.bridge if isinstance(self, TimedBridgeMission) else USUAL

    @property
    def live_planning(self) -> bool:
        """Whether an ICAROUS that commands its vehicle may ask UxAS for a path back."""
        return isinstance(self, LivePlanningMission) and self.uxas_route_planner

    def vehicle(self, vehicle_id: int) -> Vehicle:
        """The vehicle with this id; KeyError if there is none."""
        for vehicle in self.vehicles:
            if vehicle.id == vehicle_id:
                return vehicle
        raise KeyError(vehicle_id)

    def task(self, task_id: int) -> Task:
        """The task with this id; KeyError if there is none."""
        for task in self.tasks:
            if task.id == task_id:
                return task
        raise KeyError(task_id)


@dataclass(frozen=True)
class LivePlanningMission(Mission):
    """A mission in which UxAS plans in flight: an ICAROUS that commands its vehicle may request a path back."""

    uxas_route_planner: bool = True


@dataclass(frozen=True)
class TimedBridgeMission(LivePlanningMission):
    """A mission with other times of the bridge than the usual ones."""

    uxas_route_planner: bool = False
    bridge: BridgeTimes = USUAL
