"""Converts single CMASI objects (vehicle, zone, position, shape) to parts of a `Mission`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from math import hypot, isfinite, radians
from typing import Any

from cratous.services.loading.coordinates import Places, msl
from cratous.services.loading.polygons import circle, rectangle
from cratous.services.loading.uxas_cfg import Sent
from cratous.spec.errors import BadInput
from cratous.spec.mission import Camera, Position, Vehicle, View, Zone, ZoneKind

DEFAULT_CLIMB_M_S = 5.0
UNBOUNDED_M = (-1000.0, 100_000.0)
AHEAD = View(0.0, radians(-60.0), False)
"""View of a line from before it, as in UxAS: the path ends earlier by that distance."""
STRAIGHT_DOWN_RAD = radians(-85.0)


def safe_name(text: str) -> str:
    """A valid mission name from a folder's name: letters, digits, '_' and '-'."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", text).strip("-_") or "mission"


def locations(body: Any) -> Iterator[tuple[float, float]]:
    """Latitude and longitude [degrees] of every position inside an object."""
    if isinstance(body, (list, tuple)):
        for part in body:
            yield from locations(part)
    elif hasattr(body, "Latitude") and hasattr(body, "Longitude"):
        yield float(body.Latitude), float(body.Longitude)
    elif hasattr(body, "names"):
        for name in body.names:
            yield from locations(getattr(body, name))


def point(location: Any, places: Places, sent: Sent, item: str) -> Position:
    if location is None:
        raise BadInput("a place is missing", where=sent.where, item=item, expected="a Location3D")
    values = (location.Latitude, location.Longitude, location.Altitude)
    low, high = UNBOUNDED_M
    if not low <= location.Altitude <= high or not is_place(*values[:2]):
        raise BadInput(
            "not a place",
            where=sent.where,
            item=item,
            expected="a latitude within ±89 and a longitude within ±180 degrees, and an altitude "
            f"from {low:g} to {high:g} m",
            got=f"{values[0]:g}, {values[1]:g}, altitude {values[2]:g}",
        )
    north_m, east_m = places.local(location.Latitude, location.Longitude)
    kind = location.AltitudeType.name
    altitude = msl(location.Altitude, kind, places.terrain_m, sent.where, item)
    return Position(north_m, east_m, float(altitude))


def is_place(latitude_deg: float, longitude_deg: float) -> bool:
    """Whether a frame can represent the position; NaN is invalid."""
    return abs(latitude_deg) <= 89 and abs(longitude_deg) <= 180


def heading(degrees: float, where: str, item: str) -> float:
    """A heading [deg] in radians; BadInput if it is not finite."""
    if not isfinite(degrees):
        raise BadInput(
            "not a heading", where=where, item=item, expected="a finite number", got=f"{degrees:g}"
        )
    return radians(degrees)


def no_vehicle(configuration: Sent, item: str, what: str, expected: str, got: str) -> BadInput:
    """The error for a vehicle configuration with an invalid item."""
    text, where = f"vehicle {configuration.body.ID} {what}", configuration.where
    return BadInput(text, where=where, item=item, expected=expected, got=got)


def vehicle(configuration: Sent, state: Sent, places: Places, notes: list[str]) -> Vehicle:
    """A vehicle from its AirVehicleConfiguration and its AirVehicleState."""
    body = configuration.body
    profile = body.NominalFlightProfile
    if profile is None:
        item, what = "NominalFlightProfile", "has no nominal flight profile"
        raise no_vehicle(configuration, item, what, "a FlightProfile", "none")
    climbs = [abs(entry.VerticalSpeed) for entry in (profile, *body.AlternateFlightProfiles)]
    climb = max(climbs)
    if climb == 0:
        climb = DEFAULT_CLIMB_M_S
        notes.append(f"vehicle {body.ID} states no climb rate: {climb:g} m/s (our default)")
    bank = profile.MaxBankAngle
    if not 1 <= bank <= 80:
        item = "NominalFlightProfile.MaxBankAngle"
        what, expected = "cannot turn like that", "1 to 80 degrees"
        raise no_vehicle(configuration, item, what, expected, f"{bank:g}")
    speed = body.NominalSpeed if body.NominalSpeed > 0 else profile.Airspeed
    position = point(state.body.Location, places, state, "Location")
    nominal = msl(
        body.NominalAltitude,
        body.NominalAltitudeType.name,
        places.terrain_m,
        configuration.where,
        "NominalAltitude",
    )
    if abs(position.alt_m - nominal) > 1:
        notes.append(
            f"vehicle {body.ID} changes from the altitude of its state, {position.alt_m:g} m MSL, "
            f"to its nominal {nominal:g} m on the way to its first task"
        )
    return Vehicle(
        id=body.ID,
        label=body.Label or f"vehicle {body.ID}",
        position=position,
        heading_rad=heading(state.body.Heading, state.where, "Heading"),
        speed_m_s=float(speed),
        min_speed_m_s=float(body.MinimumSpeed),
        max_speed_m_s=float(body.MaximumSpeed),
        max_bank_rad=radians(bank),
        max_climb_m_s=float(climb),
        protected=True,
        cameras=_cameras(body, state.body),
        cruise_m=float(nominal),
    )


def _cameras(configuration: Any, state: Any) -> tuple[Camera, ...]:
    """Each camera on a gimbal, with the widest selectable field of view, or its present one."""
    payloads = list(configuration.PayloadConfigurationList)
    views = {
        part.PayloadID: part.HorizontalFieldOfView
        for part in state.PayloadStateList
        if type(part).__name__ == "CameraState"
    }
    found = []
    for gimbal in (part for part in payloads if type(part).__name__ == "GimbalConfiguration"):
        for camera in payloads:
            inside = camera.PayloadID in gimbal.ContainedPayloadList
            if type(camera).__name__ != "CameraConfiguration" or not inside:
                continue
            width = camera.VideoStreamHorizontalResolution
            height = camera.VideoStreamVerticalResolution
            discrete = camera.DiscreteHorizontalFieldOfViewList
            stepped = camera.FieldOfViewMode.name == "Discrete" and discrete
            widest = max(discrete) if stepped else camera.MaxHorizontalFieldOfView
            present = views.get(camera.PayloadID, 0)
            view = max(widest, present)
            # the present one counts as selectable, so that it can be changed
            fields = {camera.MinHorizontalFieldOfView, present, *discrete}
            narrower = tuple(sorted(radians(field) for field in fields if 0 < field < view))
            found.append(
                Camera(
                    payload_id=gimbal.PayloadID,
                    hfov_rad=radians(view),
                    aspect=width / height if width and height else 4 / 3,
                    min_elevation_rad=radians(gimbal.MinElevation),
                    max_elevation_rad=radians(gimbal.MaxElevation),
                    min_azimuth_rad=radians(gimbal.MinAzimuth),
                    max_azimuth_rad=radians(gimbal.MaxAzimuth),
                    wavelength=camera.SupportedWavelengthBand.name,
                    pixels=int(width),
                    zoom_rad=narrower,
                    zooms=camera.FieldOfViewMode.name == "Continuous",
                    camera_id=camera.PayloadID,
                )
            )
    return tuple(found)


def zone(sent: Sent, places: Places, terrain_m: float, notes: list[str]) -> Zone:
    """A keep-in or keep-out zone; a circle becomes a polygon that forbids at least as much."""
    body = sent.body
    kind = ZoneKind.KEEP_IN if type(body).__name__ == "KeepInZone" else ZoneKind.KEEP_OUT
    floor = msl(body.MinAltitude, body.MinAltitudeType.name, terrain_m, sent.where, "MinAltitude")
    top = msl(body.MaxAltitude, body.MaxAltitudeType.name, terrain_m, sent.where, "MaxAltitude")
    if body.MinAltitude == 0 and body.MaxAltitude == 0:
        floor, top = UNBOUNDED_M
        notes.append(f"zone {body.ZoneID} states no altitudes: it binds at every altitude")
    elif body.MinAltitude == 0 and body.MinAltitudeType.name == "AGL":
        # from the ground: no aircraft flies below it, and the ground is no ceiling
        floor = UNBOUNDED_M[0]
    if body.StartTime or body.EndTime:
        notes.append(f"zone {body.ZoneID} has times: it binds at all times")
    if body.AffectedAircraft:
        notes.append(f"zone {body.ZoneID} names aircraft: it binds all of them")
    return Zone(
        id=body.ZoneID,
        kind=kind,
        vertices=_vertices(sent, kind, places, notes),
        floor_m=float(floor),
        ceiling_m=float(top),
        padding_m=float(body.Padding),
        label=body.Label or f"zone {body.ZoneID}",
    )


def _vertices(
    sent: Sent, kind: ZoneKind, places: Places, notes: list[str]
) -> tuple[tuple[float, float], ...]:
    name, outside = f"zone {sent.body.ZoneID}", kind == ZoneKind.KEEP_OUT
    return corners_of(sent.body.Boundary, sent, "Boundary", name, places, notes, outside=outside)


def corners_of(
    shape: Any, sent: Sent, item: str, name: str, places: Places, notes: list[str], *, outside: bool
) -> tuple[tuple[float, float], ...]:
    """Corners of a Polygon, Rectangle or Circle; a circle's polygon encloses it if `outside`."""
    kind = type(shape).__name__
    if kind == "Polygon":
        corners = [
            point(place, places, sent, f"{item}.BoundaryPoints[{k}]")[:2]
            for k, place in enumerate(shape.BoundaryPoints)
        ]
        if (
            len(corners) > 3
            and hypot(corners[0][0] - corners[-1][0], corners[0][1] - corners[-1][1]) < 1e-6
        ):
            corners.pop()
            notes.append(f"{name} is closed by its first point: read once")
        return tuple(corners)
    if kind not in ("Rectangle", "Circle"):
        raise BadInput(
            f"{name} has no shape",
            where=sent.where,
            item=item,
            expected="a Polygon, Rectangle or Circle",
            got="nothing" if shape is None else kind,
        )
    centre = point(shape.CenterPoint, places, sent, f"{item}.CenterPoint")[:2]
    sizes = (shape.Width, shape.Height) if kind == "Rectangle" else (shape.Radius,)
    if not all(isfinite(size) and size > 0 for size in sizes):
        raise BadInput(
            f"{name} has no size",
            where=sent.where,
            item=item,
            expected="more than 0 m",
            got=", ".join(f"{size:g} m" for size in sizes),
        )
    if kind == "Rectangle":
        return tuple(rectangle(centre, shape.Width, shape.Height, radians(shape.Rotation)))
    return tuple(circle(centre, shape.Radius, outside=outside))


def looks_ahead(vehicles: Iterable[Vehicle]) -> bool:
    """Whether lines may be viewed ahead as well as straight down: every vehicle has cameras that tilt to both."""
    return all(
        vehicle.cameras
        and all(c.min_elevation_rad <= STRAIGHT_DOWN_RAD for c in vehicle.cameras)
        and all(c.max_elevation_rad >= AHEAD.elevation_rad for c in vehicle.cameras)
        for vehicle in vehicles
    )
