"""Payloads of an aircraft: gimbals with slew rates, and their cameras with footprints.

Angles of messages and of this module are degrees: azimuth from the nose to the right, elevation up.
"""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, isfinite, radians, sin, tan
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator.earth import EQUATOR_M, Place, bearing_rad, distance_m, horizon_m
from cratous.services.simulator.motion import Motion
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.services.simulator.terrain import Terrain

Axes = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]


class Camera(NamedTuple):
    """The configuration of a camera, and its horizontal field of view [deg]."""

    configuration: Any
    fov_deg: float


class Gimbal(NamedTuple):
    """State of a gimbal: configuration, pointing direction [deg], current action, corner and cycle of a scan; its
    cameras."""

    configuration: Any
    azimuth_deg: float
    elevation_deg: float
    action: Any
    corner: int
    cycle: int
    cameras: tuple[Camera, ...]


def gimbals_of(configuration: Any, where: str) -> tuple[Gimbal, ...]:
    """The gimbals of an aircraft with their cameras; BadInput for an invalid one."""
    loads = configuration.PayloadConfigurationList
    cameras = {c.PayloadID: c for c in loads if type(c).__name__ == "CameraConfiguration"}
    found = []
    for g in (c for c in loads if type(c).__name__ == "GimbalConfiguration"):
        limits = (g.MinAzimuth, g.MaxAzimuth, g.MinElevation, g.MaxElevation)
        rates = (g.MaxAzimuthSlewRate, g.MaxElevationSlewRate)
        if (
            not all(map(isfinite, (*limits, *rates)))
            or g.MinAzimuth > g.MaxAzimuth
            or g.MinElevation > g.MaxElevation
            or min(rates) < 0
        ):
            raise BadInput(
                "wrong limits of a gimbal [deg, deg/s]",
                where=where,
                item=f"AirVehicleConfiguration {configuration.ID}, payload {g.PayloadID}",
                expected="finite numbers, Min at most Max, slew rates at least 0",
                got=f"{limits}, {rates}",
            )
        mounted = tuple(
            Camera(c, _fov(c, (c.MinHorizontalFieldOfView + c.MaxHorizontalFieldOfView) / 2))
            for key, c in cameras.items()
            if key in g.ContainedPayloadList
        )
        middle = (limits[0] + limits[1]) / 2, (limits[2] + limits[3]) / 2
        found.append(Gimbal(g, *middle, None, 0, 0, mounted))
    return tuple(found)


def placed(mounted: tuple[Gimbal, ...], told: Any) -> tuple[Gimbal, ...]:
    """The gimbals and cameras set by the payload states of an AirVehicleState."""
    known = {one.PayloadID: one for one in told.PayloadStateList if one is not None}
    return tuple(_placed(g, known) for g in mounted)


def _placed(g: Gimbal, known: dict[int, Any]) -> Gimbal:
    c = g.configuration
    one: Any = known.get(c.PayloadID)
    if type(one).__name__ == "GimbalState" and isfinite(one.Azimuth + one.Elevation):
        g = g._replace(
            azimuth_deg=_clamp(one.Azimuth, c.MinAzimuth, c.MaxAzimuth),
            elevation_deg=_clamp(one.Elevation, c.MinElevation, c.MaxElevation),
        )
    return g._replace(cameras=tuple(_with_fov(c, known) for c in g.cameras))


def _with_fov(c: Camera, known: dict[int, Any]) -> Camera:
    one: Any = known.get(c.configuration.PayloadID)
    wide = one.HorizontalFieldOfView if type(one).__name__ == "CameraState" else 0.0
    return c._replace(fov_deg=_fov(c.configuration, wide)) if wide and isfinite(wide) else c


def _fov(camera: Any, wanted_deg: float) -> float:
    """The closest field of view [deg] that a camera supports."""
    steps = camera.DiscreteHorizontalFieldOfViewList
    if camera.FieldOfViewMode.name == "Discrete" and steps:
        return float(min(steps, key=lambda one: abs(one - wanted_deg)))
    return _clamp(wanted_deg, camera.MinHorizontalFieldOfView, camera.MaxHorizontalFieldOfView)


def _clamp(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))


def gimbal_with(mounted: tuple[Gimbal, ...], number: int) -> int | None:
    """The id of the gimbal that a sensor is, or is on; None for a sensor that is not mounted."""
    for g in mounted:
        on_it = (c.configuration.PayloadID for c in g.cameras)
        if number in (g.configuration.PayloadID, *on_it):
            return int(g.configuration.PayloadID)
    return None


def is_for(mounted: tuple[Gimbal, ...], body: Any) -> bool:
    """Whether an action is for a mounted gimbal or camera."""
    number = getattr(body, "PayloadID", None)
    kind = type(body).__name__
    if kind == "CameraAction":
        return any(c.configuration.PayloadID == number for g in mounted for c in g.cameras)
    known = kind in ("GimbalAngleAction", "GimbalStareAction", "GimbalScanAction")
    return known and any(g.configuration.PayloadID == number for g in mounted)


def act(g: Gimbal, body: Any) -> Gimbal:
    """The gimbal after an action, which may be for another one."""
    if type(body).__name__ == "CameraAction":
        cameras = tuple(
            c._replace(fov_deg=_fov(c.configuration, body.HorizontalFieldOfView))
            if c.configuration.PayloadID == body.PayloadID
            else c
            for c in g.cameras
        )
        return g._replace(cameras=cameras)
    if g.configuration.PayloadID != body.PayloadID:
        return g
    return g._replace(action=body, corner=0, cycle=0)


def step(g: Gimbal, m: Motion, dt_s: float) -> Gimbal:
    """The gimbal after a step."""
    body = g.action
    if body is None:
        return g
    kind = type(body).__name__
    c = g.configuration
    rates = c.MaxAzimuthSlewRate, c.MaxElevationSlewRate
    if kind == "GimbalAngleAction":
        return _slew(g, (body.Azimuth, body.Elevation), rates, dt_s)[0]
    if kind == "GimbalStareAction":
        return _slew(g, aim(m, body.Starepoint), rates, dt_s)[0]
    if body.Cycles > 0 and g.cycle >= body.Cycles:
        return g
    wanted = (
        body.StartAzimuth if g.corner < 2 else body.EndAzimuth,
        body.EndElevation if g.corner in (1, 2) else body.StartElevation,
    )
    rates = min(rates[0], body.AzimuthSlewRate), min(rates[1], body.ElevationSlewRate)
    g, there = _slew(g, wanted, rates, dt_s)
    if not there:
        return g
    return g._replace(corner=(g.corner + 1) % 4, cycle=g.cycle + (g.corner == 3))


def _slew(
    g: Gimbal, wanted: tuple[float, float], rates: tuple[float, float], dt_s: float
) -> tuple[Gimbal, bool]:
    """A step towards an azimuth and elevation within the limits, and whether they are reached."""
    c = g.configuration
    turn = wanted[0] - g.azimuth_deg
    if c.MaxAzimuth - c.MinAzimuth >= 360:
        turn = (turn + 180) % 360 - 180
        azimuth = g.azimuth_deg + _clamp(turn, -rates[0] * dt_s, rates[0] * dt_s)
        azimuth = (azimuth + 180) % 360 - 180
    else:
        turn = _clamp(wanted[0], c.MinAzimuth, c.MaxAzimuth) - g.azimuth_deg
        azimuth = g.azimuth_deg + _clamp(turn, -rates[0] * dt_s, rates[0] * dt_s)
    lift = _clamp(wanted[1], c.MinElevation, c.MaxElevation) - g.elevation_deg
    elevation = g.elevation_deg + _clamp(lift, -rates[1] * dt_s, rates[1] * dt_s)
    there = abs(turn) <= rates[0] * dt_s and abs(lift) <= rates[1] * dt_s
    return g._replace(azimuth_deg=azimuth, elevation_deg=elevation), there


def axes(heading: float, pitch: float, roll: float) -> Axes:
    """North, east and down components of the body axes forward, right and down, for Euler angles [rad]."""
    ch, sh, cp, sp, cr, sr = (
        cos(heading), sin(heading), cos(pitch), sin(pitch), cos(roll), sin(roll),
    )  # fmt: skip
    return (
        (ch * cp, sh * cp, -sp),
        (ch * sp * sr - sh * cr, sh * sp * sr + ch * cr, cp * sr),
        (ch * sp * cr + sh * sr, sh * sp * cr - ch * sr, cp * cr),
    )


def aim(m: Motion, point: Any) -> tuple[float, float]:
    """Azimuth and elevation [deg] at which an aircraft sees a place, over the curved earth."""
    lat, lon = radians(point.Latitude), radians(point.Longitude)
    away = distance_m(m.lat_rad, m.lon_rad, lat, lon)
    course = bearing_rad(m.lat_rad, m.lon_rad, lat, lon)
    down = m.alt_m - point.Altitude + EQUATOR_M * (1 - cos(away / EQUATOR_M))
    north, east = away * cos(course), away * sin(course)
    x, y, z = (
        a * north + b * east + c * down for a, b, c in axes(m.heading_rad, m.pitch_rad, m.roll_rad)
    )
    return degrees(atan2(y, x)), degrees(atan2(-z, hypot(x, y)))


def states(
    mounted: tuple[Gimbal, ...], m: Motion, ground_m: float, terrain: Terrain | None = None
) -> tuple[Any, ...]:
    """GimbalState and CameraState of all payloads, over terrain, or else flat ground at a height."""
    told: list[Any] = []
    for g in mounted:
        pointing = {
            "Azimuth": g.azimuth_deg,
            "Elevation": g.elevation_deg,
            "PointingMode": _POINTING[type(g.action).__name__],
        }
        told.append(lmcp.new("GimbalState", PayloadID=g.configuration.PayloadID, **pointing))
        for c in g.cameras:
            ratio = _ratio(c.configuration)
            corners = footprint(g, c, m, ground_m, terrain)
            told.append(
                lmcp.new(
                    "CameraState",
                    PayloadID=c.configuration.PayloadID,
                    HorizontalFieldOfView=c.fov_deg,
                    VerticalFieldOfView=c.fov_deg / ratio,
                    Footprint=[_place(p) for p in corners[:4]],
                    Centerpoint=_place(corners[4]),
                    **pointing,
                )
            )
    return tuple(told)


_POINTING = {
    "NoneType": "AirVehicleRelativeAngle",
    "GimbalAngleAction": "AirVehicleRelativeAngle",
    "GimbalStareAction": "LatLonSlaved",
    "GimbalScanAction": "Scan",
}


def _ratio(camera: Any) -> float:
    wide, high = camera.VideoStreamHorizontalResolution, camera.VideoStreamVerticalResolution
    return wide / high if wide and high else 4 / 3


class Picture(NamedTuple):
    """The camera axes ahead, right and down as north, east and down components; half of the image's width and
    height at depth 1.
    """

    ahead: tuple[float, float, float]
    right: tuple[float, float, float]
    down: tuple[float, float, float]
    wide: float
    high: float


def picture(g: Gimbal, c: Camera, m: Motion) -> Picture:
    """The image of a camera, consistent with its footprint."""
    (a0, a1, a2), (b0, b1, b2), (c0, c1, c2) = axes(m.heading_rad, m.pitch_rad, m.roll_rad)
    sensor = axes(radians(g.azimuth_deg), radians(g.elevation_deg), 0.0)
    ahead, right, down = (
        (x * a0 + y * b0 + z * c0, x * a1 + y * b1 + z * c1, x * a2 + y * b2 + z * c2)
        for x, y, z in sensor
    )
    wide = tan(radians(c.fov_deg) / 2)
    high = tan(radians(c.fov_deg / _ratio(c.configuration)) / 2)
    return Picture(ahead, right, down, wide, high)


def _place(point: Place) -> Any:
    return lmcp.new(
        "Location3D", Latitude=degrees(point[0]), Longitude=degrees(point[1]), Altitude=point[2]
    )


def footprint(
    g: Gimbal, c: Camera, m: Motion, ground_m: float, terrain: Terrain | None = None
) -> list[Place]:
    """Where the corners and the centre of an image meet the terrain, or flat ground; at most at the horizon.

    Order: top left, top right, bottom right, bottom left, centre.
    """
    b0, b1, b2 = axes(m.heading_rad, m.pitch_rad, m.roll_rad)
    s0, s1, s2 = axes(radians(g.azimuth_deg), radians(g.elevation_deg), 0.0)
    wide = tan(radians(c.fov_deg) / 2)
    high = tan(radians(c.fov_deg / _ratio(c.configuration)) / 2)
    height = max(0.0, m.alt_m - ground_m)
    horizon = horizon_m(height)
    corners: list[Place] = []
    for right, down in ((-wide, -high), (wide, -high), (wide, high), (-wide, high), (0.0, 0.0)):
        x, y, z = (s0[k] + right * s1[k] + down * s2[k] for k in range(3))
        north = x * b0[0] + y * b1[0] + z * b2[0]
        east = x * b0[1] + y * b1[1] + z * b2[1]
        below = x * b0[2] + y * b1[2] + z * b2[2]
        if terrain is not None:
            from cratous.services.simulator.sight import meets

            corners.append(meets(terrain, m, (north, east, below)))
            continue
        level = hypot(north, east)
        along = level * height / below if below > 0 else horizon
        part = min(along, horizon) / level if level else 0.0
        corners.append(
            (
                m.lat_rad + north * part / EQUATOR_M,
                m.lon_rad + east * part / (EQUATOR_M * cos(m.lat_rad)),
                ground_m,
            )
        )
    return corners
