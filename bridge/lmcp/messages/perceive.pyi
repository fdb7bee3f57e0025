"""Messages of PERCEIVE, version 1. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.objects import LmcpObject

class EntityPerception(LmcpObject):
    """afrl.cmasi.perceive.EntityPerception: PERCEIVE type 1."""

    PerceivedEntityID: int
    """uint32, default 0."""
    PerceiverID: int
    """uint32, default 0."""
    PerceiverPayloads: list[int]
    """uint32[], default empty, the model says at most 8."""
    Velocity: list[float]
    """real32[3] [meter/sec], default all zero."""
    VelocityError: list[float]
    """real32[3] [meter/sec], default all zero."""
    VelocityValid: bool
    """bool, default false."""
    Attitude: list[float]
    """real32[3] [degree], default all zero."""
    AttitudeError: list[float]
    """real32[3] [degree], default all zero."""
    AttitudeValid: bool
    """bool, default false."""
    Location: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    LocationError: list[float]
    """real32[3] [meter], default all zero."""
    TimeLastSeen: int
    """int64 [millisecond], default 0."""
    def __init__(
        self,
        *,
        PerceivedEntityID: int = ...,
        PerceiverID: int = ...,
        PerceiverPayloads: Iterable[int] = ...,
        Velocity: Iterable[float] = ...,
        VelocityError: Iterable[float] = ...,
        VelocityValid: bool = ...,
        Attitude: Iterable[float] = ...,
        AttitudeError: Iterable[float] = ...,
        AttitudeValid: bool = ...,
        Location: _cmasi.Location3D = ...,
        LocationError: Iterable[float] = ...,
        TimeLastSeen: int = ...,
    ) -> None: ...

class TrackEntityAction(_cmasi.VehicleAction):
    """afrl.cmasi.perceive.TrackEntityAction: PERCEIVE type 2."""

    EntityID: int
    """uint32, default 0."""
    SensorID: int
    """uint32, default 0."""
    ReturnToWaypoint: int
    """uint32, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        EntityID: int = ...,
        SensorID: int = ...,
        ReturnToWaypoint: int = ...,
    ) -> None: ...

class TrackEntityTask(_cmasi.Task):
    """afrl.cmasi.perceive.TrackEntityTask: PERCEIVE type 3."""

    EntityID: int
    """uint32, default 0."""
    SensorModality: _cmasi.WavelengthBand
    """CMASI/WavelengthBand, default AllAny."""
    GroundSampleDistance: float
    """real32 [meter], default 0.0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        Label: str = ...,
        EligibleEntities: Iterable[int] = ...,
        RevisitRate: float = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        Priority: int = ...,
        Required: bool = ...,
        EntityID: int = ...,
        SensorModality: _cmasi.WavelengthBand | str = ...,
        GroundSampleDistance: float = ...,
    ) -> None: ...
