"""SensorManagerService: the footprints of a vehicle's cameras, on request.

SensorFootprintRequests -> SensorFootprintResponse: one footprint for each suitable camera and each
combination of altitude, elevation and ground sample distance. An empty list means: any wavelength; no
required sample distance (widest view); the nominal altitude; the steepest elevation of the gimbal. With a
required sample distance, the widest view that meets it is used; AchievedGSD reports the result.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from math import atan, degrees, radians, sin, tan
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.mission.sensor import Look, footprints
from cratous.services.pipeline.status import status
from cratous.spec.mission import Camera

NAME = "SensorManagerService"
REQUESTS = "uxas.messages.task.SensorFootprintRequests"
LEVEL_DEG = -0.5
"""A boresight above this elevation counts as seeing no ground [deg]."""


class Mount(NamedTuple):
    """A camera on a gimbal, from the configuration."""

    gimbal: Any
    camera: Any

    @property
    def steepest_deg(self) -> float:
        """The gimbal elevation closest to straight down [deg]."""
        return float(max(self.gimbal.MinElevation, min(-90.0, self.gimbal.MaxElevation)))

    def clipped_deg(self, elevation_deg: float) -> float:
        """An elevation limited to the gimbal's range [deg]."""
        return float(max(self.gimbal.MinElevation, min(self.gimbal.MaxElevation, elevation_deg)))

    @property
    def aspect(self) -> float:
        """Width of the image over its height; 4:3 if not configured."""
        width, height = (
            self.camera.VideoStreamHorizontalResolution,
            self.camera.VideoStreamVerticalResolution,
        )
        return float(width / height) if width and height else 4 / 3

    def view_deg(self, gsd: float, slant: float) -> float:
        """The widest field of view [deg] that meets a sample distance [m] at a slant range [m]; 0: any
        distance.
        """
        widest, narrowest = (
            self.camera.MaxHorizontalFieldOfView,
            self.camera.MinHorizontalFieldOfView,
        )
        if not gsd:
            return float(widest)
        pixels = self.camera.VideoStreamHorizontalResolution
        fits = degrees(2 * atan(gsd * pixels / (2 * slant)))
        discrete = sorted(self.camera.DiscreteHorizontalFieldOfViewList)
        if self.camera.FieldOfViewMode.name == "Discrete" and discrete:
            return float(max((view for view in discrete if view <= fits), default=discrete[0]))
        return float(max(narrowest, min(widest, fits)))


def mounts_of(configuration: Any) -> list[Mount]:
    """All cameras that are on gimbals."""
    payloads = configuration.PayloadConfigurationList
    gimbals = [p for p in payloads if type(p).__name__ == "GimbalConfiguration"]
    cameras = [p for p in payloads if type(p).__name__ == "CameraConfiguration"]
    return [Mount(g, c) for g in gimbals for c in cameras if c.PayloadID in g.ContainedPayloadList]


def footprint(
    mount: Mount, altitude: float, elevation_deg: float, gsd: float
) -> dict[str, Any] | None:
    """The fields of a SensorFootprint from a height above ground [m], or None if it sees no ground."""
    elevation = mount.clipped_deg(elevation_deg)
    if elevation > LEVEL_DEG or altitude <= 0:
        return None
    slant = altitude / sin(radians(-elevation))
    centre = altitude / tan(radians(-elevation))
    view = mount.view_deg(gsd, slant)
    limits = (radians(elevation), radians(elevation), 0.0, 0.0)
    camera = Camera(0, radians(view), mount.aspect, *limits, wavelength="AllAny", pixels=1)
    # only the image's position is needed here, not what counts as seen
    look = Look(0.0, 0.0, 0.0, centre, 0.0)
    corners = footprints([look], altitude, camera, flattest_rad=0.0)[0]
    if corners[0, 0] != corners[0, 0]:
        return None  # its upper edge is above the horizon
    width = 2 * slant * tan(radians(view / 2))
    pixels = mount.camera.VideoStreamHorizontalResolution
    return {
        "CameraID": mount.camera.PayloadID,
        "GimbalID": mount.gimbal.PayloadID,
        "HorizontalFOV": view,
        "AglAltitude": altitude,
        "GimbalElevation": elevation,
        "AspectRatio": mount.aspect,
        "AchievedGSD": width / pixels if pixels else 0.0,
        "CameraWavelength": mount.camera.SupportedWavelengthBand,
        "HorizontalToLeadingEdge": float(corners[0, 0]),
        "HorizontalToTrailingEdge": float(corners[2, 0]),
        "HorizontalToCenter": centre,
        "WidthCenter": width,
        "SlantRangeToCenter": slant,
    }


class SensorManagerService:
    """Answers every request; combinations without a footprint are reported in a status."""

    name = NAME
    subscribes: tuple[str, ...] = (REQUESTS,)
    knows = ("EntityConfiguration",)

    def __init__(self, configuration_of: Callable[[int], Any], radian: bool = False) -> None:
        """configuration_of(vehicle): its newest configuration, or None.

        radian: ElevationAngles of requests are in radians, as OpenUxAS's own tasks send them; the message's
        definition says degrees.
        """
        self._configuration_of, self._radian = configuration_of, radian

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        made: list[Any] = []
        out: list[Any] = []
        for request in envelope.body.Footprints:
            found, why = self._of(request)
            made += found
            if why:
                number = ("FootprintRequestID", str(request.FootprintRequestID))
                out.append(status(0, "Warning", [number, *(("reason", text) for text in why)]))
        answer = lmcp.new(
            "SensorFootprintResponse", ResponseID=envelope.body.RequestID, Footprints=made
        )
        return None, [*out, answer]

    def _of(self, request: Any) -> tuple[list[Any], list[str]]:
        configuration = self._configuration_of(request.VehicleID)
        name = f"vehicle {request.VehicleID}"
        if configuration is None:
            return [], [f"{name} has no configuration"]
        bands = {band.name for band in request.EligibleWavelengths} or {"AllAny"}
        mounts = [
            mount
            for mount in mounts_of(configuration)
            if bands & {"AllAny", mount.camera.SupportedWavelengthBand.name}
            or mount.camera.SupportedWavelengthBand.name == "AllAny"
        ]
        if not mounts:
            return [], [f"{name} has no camera for {', '.join(sorted(bands))} on a gimbal"]
        made, why = [], []
        altitudes = list(request.AglAltitudes) or [configuration.NominalAltitude]
        for mount in mounts:
            elevations = list(request.ElevationAngles) or [mount.steepest_deg]
            if self._radian and request.ElevationAngles:
                elevations = [degrees(angle) for angle in elevations]
            gsds = list(request.GroundSampleDistances) or [0.0]
            for altitude, elevation, gsd in product(altitudes, elevations, gsds):
                fields = footprint(mount, altitude, elevation, gsd)
                if fields is None:
                    why.append(
                        f"{name}: no ground in view from {altitude:g} m at {elevation:g} deg"
                    )
                    continue
                made.append(
                    lmcp.new(
                        "SensorFootprint",
                        FootprintResponseID=request.FootprintRequestID,
                        VehicleID=request.VehicleID,
                        **fields,
                    )
                )
        return made, why
