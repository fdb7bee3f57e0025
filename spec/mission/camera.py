"""A camera that a vehicle carries."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Camera:
    """A camera on a gimbal. Angles in radians; azimuth clockwise from the nose, elevation up."""

    payload_id: int = 1
    hfov_rad: float = 0.785398
    aspect: float = 4 / 3
    min_elevation_rad: float = -1.5708
    max_elevation_rad: float = 0.0
    min_azimuth_rad: float = -3.14159265
    max_azimuth_rad: float = 3.14159265
    wavelength: str = "AllAny"
    pixels: int = 0
    """Image width in pixels; 0: not known."""
    zoom_rad: tuple[float, ...] = ()
    """Narrower fields of view available [rad]; with `zooms`, all between the narrowest and hfov as well."""
    zooms: bool = False
    camera_id: int = 0
    """The payload id of the camera itself; `payload_id` is that of its gimbal."""
