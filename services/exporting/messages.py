"""Converts a mission to the messages for UxAS and the simulator: the inverse of `loading.uxas`.

Altitudes are MSL. What the messages cannot represent is found by reading them again
(`differences`).
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.mission.frames import Projection, compass
from cratous.spec import mission as spec
from cratous.spec.errors import BadInput

REGION = 1
"""Id of the only operating region, which contains all zones."""
SLEW_DEG_S = 60.0
"""Gimbal slew rate [deg/s], not part of a mission file."""
SHAPES = {"circular": "Circular", "racetrack": "Racetrack", "figure_eight": "FigureEight"}
DIRECTIONS = {
    "clockwise": "Clockwise",
    "counter_clockwise": "CounterClockwise",
    "any": "VehicleDefault",
}

PATTERNS = {
    spec.Pattern.SPIRAL: "Spiral",
    spec.Pattern.SECTOR: "Sector",
    spec.Pattern.SWEEP: "Sweep",
}


class Told(NamedTuple):
    """All messages of a mission, in sending order. request: the last one."""

    configurations: tuple[Any, ...]
    states: tuple[Any, ...]
    zones: tuple[Any, ...]
    region: Any
    tasks: tuple[Any, ...]
    request: Any

    def all(self) -> tuple[Any, ...]:
        """All messages in sequence."""
        return (
            *self.configurations, *self.states, *self.zones, self.region, *self.tasks, self.request,
        )  # fmt: skip


def messages_of(mission: spec.Mission) -> Told:
    """The messages; BadInput for a task of an unsupported kind."""
    plane = Projection(mission.frame)
    return Told(
        tuple(configuration_of(v) for v in mission.vehicles),
        tuple(
            state_of(v.id, v.position, v.heading_rad, v.speed_m_s, plane, _mounted(v))
            for v in mission.vehicles
        ),
        tuple(_zone(zone, plane) for zone in mission.zones),
        lmcp.new(
            "OperatingRegion",
            ID=REGION,
            KeepInAreas=[z.id for z in mission.zones if z.kind.value == "keep_in"],
            KeepOutAreas=[z.id for z in mission.zones if z.kind.value == "keep_out"],
        ),
        tuple(_task(k, task, plane) for k, task in enumerate(mission.tasks)),
        lmcp.new(
            "AutomationRequest",
            EntityList=[v.id for v in mission.vehicles],
            TaskList=[t.id for t in mission.tasks],
            TaskRelationships=mission.relations,
            OperatingRegion=REGION,
        ),
    )


# vehicles --------------------------------------------------------------------------------------


def configuration_of(vehicle: spec.Vehicle) -> Any:
    """An AirVehicleConfiguration with profiles for level flight, and for the steepest climb and descent."""
    bank = degrees(vehicle.max_bank_rad)

    def profile(name: str, climb_m_s: float) -> Any:
        return lmcp.new(
            "FlightProfile",
            Name=name,
            Airspeed=vehicle.speed_m_s,
            VerticalSpeed=climb_m_s,
            MaxBankAngle=bank,
        )

    climb = vehicle.max_climb_m_s
    return lmcp.new(
        "AirVehicleConfiguration",
        ID=vehicle.id,
        Label=vehicle.label,
        NominalSpeed=vehicle.speed_m_s,
        NominalAltitude=vehicle.cruise_alt_m,
        NominalAltitudeType="MSL",
        MinimumSpeed=vehicle.min_speed_m_s,
        MaximumSpeed=vehicle.max_speed_m_s,
        NominalFlightProfile=profile("Cruise", 0.0),
        AlternateFlightProfiles=[profile("Climb", climb), profile("Descent", -climb)],
        PayloadConfigurationList=[part for pair in payloads_of(vehicle) for part in pair],
    )


def payloads_of(vehicle: spec.Vehicle) -> list[tuple[Any, Any]]:
    """Gimbal and camera for each camera, in order; a camera without an id gets an unused one."""
    taken = {camera.payload_id for camera in vehicle.cameras}
    found = []
    for camera in vehicle.cameras:
        number = camera.camera_id or next(n for n in range(1, 2**31) if n not in taken)
        taken.add(number)
        gimbal = lmcp.new(
            "GimbalConfiguration",
            PayloadID=camera.payload_id,
            MinAzimuth=degrees(camera.min_azimuth_rad),
            MaxAzimuth=degrees(camera.max_azimuth_rad),
            MinElevation=degrees(camera.min_elevation_rad),
            MaxElevation=degrees(camera.max_elevation_rad),
            MaxAzimuthSlewRate=SLEW_DEG_S,
            MaxElevationSlewRate=SLEW_DEG_S,
            ContainedPayloadList=[number],
        )
        wide = degrees(camera.hfov_rad)
        narrow = [degrees(one) for one in camera.zoom_rad]
        pixels = camera.pixels
        seen = lmcp.new(
            "CameraConfiguration",
            PayloadID=number,
            SupportedWavelengthBand=camera.wavelength,
            FieldOfViewMode="Continuous" if camera.zooms else "Discrete",
            MinHorizontalFieldOfView=min([wide, *narrow]),
            MaxHorizontalFieldOfView=wide,
            DiscreteHorizontalFieldOfViewList=[*narrow, wide],
            VideoStreamHorizontalResolution=pixels,
            VideoStreamVerticalResolution=round(pixels / camera.aspect),
        )
        found.append((gimbal, seen))
    return found


def _mounted(vehicle: spec.Vehicle) -> list[Any]:
    """The states of the payloads at the start: each gimbal looks ahead, tilted down as far as possible."""
    found = []
    for gimbal, camera in payloads_of(vehicle):
        turn = {"Azimuth": 0.0, "Elevation": gimbal.MinElevation}
        wide = camera.MaxHorizontalFieldOfView
        found += [
            lmcp.new("GimbalState", PayloadID=gimbal.PayloadID, **turn),
            lmcp.new("CameraState", PayloadID=camera.PayloadID, HorizontalFieldOfView=wide, **turn),
        ]
    return found


def state_of(
    number: int,
    place: spec.Position,
    heading_rad: float,
    speed_m_s: float,
    plane: Projection,
    payloads: list[Any] | None = None,
) -> Any:
    """The AirVehicleState of an aircraft in level flight."""
    heading = compass(heading_rad)
    return lmcp.new(
        "AirVehicleState",
        ID=number,
        u=speed_m_s,
        Airspeed=speed_m_s,
        Groundspeed=speed_m_s,
        Heading=heading,
        Course=heading,
        EnergyAvailable=100.0,
        Location=_place(place, plane),
        PayloadStateList=payloads or [],
    )


def _place(place: spec.Position, plane: Projection) -> Any:
    latitude, longitude = plane.to_geodetic(place.north_m, place.east_m)
    return lmcp.new(
        "Location3D",
        Latitude=latitude,
        Longitude=longitude,
        Altitude=place.alt_m,
        AltitudeType="MSL",
    )


# zones and tasks -------------------------------------------------------------------------------


def _polygon(corners: list[spec.Position], plane: Projection) -> Any:
    return lmcp.new("Polygon", BoundaryPoints=[_place(corner, plane) for corner in corners])


def _zone(zone: spec.Zone, plane: Projection) -> Any:
    return lmcp.new(
        "KeepInZone" if zone.kind.value == "keep_in" else "KeepOutZone",
        ZoneID=zone.id,
        Label=zone.label,
        MinAltitude=zone.floor_m,
        MinAltitudeType="MSL",
        MaxAltitude=zone.ceiling_m,
        MaxAltitudeType="MSL",
        Padding=zone.padding_m,
        Boundary=_polygon([spec.Position(*v, 0.0) for v in zone.vertices], plane),
    )


def _task(k: int, task: spec.Task, plane: Projection) -> Any:
    if task.kind not in WRITERS:
        raise BadInput(
            f"a task of kind {task.kind} cannot be told to UxAS",
            item=f"tasks[{k}].kind",
            expected="one of " + ", ".join(WRITERS),
            got=task.kind,
        )
    name, fields = WRITERS[task.kind](task, plane)
    return lmcp.new(
        name,
        TaskID=task.id,
        Label=task.label,
        EligibleEntities=list(task.eligible),
        Priority=task.priority,
        **fields,
    )


Written = tuple[str, dict[str, Any]]


def _search(task: spec.Task) -> dict[str, Any]:
    """Common fields of all search tasks."""
    return {
        "DwellTime": task.duration_ms,
        "GroundSampleDistance": task.gsd_m,
        "DesiredWavelengthBands": [] if task.wavelength == "AllAny" else [task.wavelength],
        "ViewAngleList": [_wedge(v) for v in (task.view, *task.views) if v is not None],
    }


def _wedge(view: spec.View) -> Any:
    return lmcp.new(
        "Wedge",
        AzimuthCenterline=degrees(view.azimuth_rad),
        VerticalCenterline=degrees(view.elevation_rad),
        AzimuthExtent=degrees(view.azimuth_extent_rad),
    )


def _line(task: spec.Task, plane: Projection) -> Written:
    inertial = task.view is not None and task.view.inertial
    points = [_place(point, plane) for point in task.points]
    fields = {"PointList": points, "UseInertialViewAngles": inertial}
    return "LineSearchTask", {**_search(task), **fields}


def _point(task: spec.Task, plane: Projection) -> Written:
    spot = {
        "SearchLocation": _place(task.points[0], plane),
        "StandoffDistance": task.standoff_m,
    }
    return "PointSearchTask", {**_search(task), **spot}


def _must_fly(task: spec.Task, plane: Projection) -> Written:
    return "MustFlyTask", {"Position": _place(task.points[0], plane), "UseAltitude": True}


def _area(task: spec.Task, plane: Projection) -> Written:
    return "AreaSearchTask", {**_search(task), "SearchArea": _polygon(list(task.points), plane)}


def _loiter(task: spec.Task, plane: Projection) -> Written:
    loiter = task.loiter or spec.Loiter(task.points[0], task.radius_m)
    action = lmcp.new(
        "LoiterAction",
        LoiterType=SHAPES[loiter.shape],
        Radius=loiter.radius_m,
        Axis=degrees(loiter.axis_rad),
        Length=loiter.length_m,
        Direction=DIRECTIONS[loiter.direction],
        Duration=task.duration_ms,
        Location=_place(loiter.centre, plane),
    )
    return "LoiterTask", {"DesiredAction": action}


def _pattern(task: spec.Task, plane: Projection) -> Written:
    if task.pattern not in PATTERNS:
        raise BadInput(
            f"the pattern {task.pattern} cannot be told to UxAS",
            item=f"task {task.id}",
            expected="one of " + ", ".join(PATTERNS),
            got=str(task.pattern),
        )
    spot = {"SearchLocation": _place(task.points[0], plane), "Extent": task.extent_m}
    said = {name: value for name, value in _search(task).items() if name != "ViewAngleList"}
    return "PatternSearchTask", {**said, **spot, "Pattern": PATTERNS[task.pattern]}


WRITERS: dict[spec.TaskKind, Callable[[spec.Task, Projection], Written]] = {
    spec.TaskKind.LINE_SEARCH: _line,
    spec.TaskKind.POINT_SEARCH: _point,
    spec.TaskKind.MUST_FLY: _must_fly,
    spec.TaskKind.AREA_SEARCH: _area,
    spec.TaskKind.LOITER: _loiter,
    spec.TaskKind.PATTERN_SEARCH: _pattern,
}
