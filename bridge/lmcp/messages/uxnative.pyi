"""Messages of UXNATIVE, version 9. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.messages import impact as _impact
from cratous.bridge.lmcp.messages import uxnative as _uxnative
from cratous.bridge.lmcp.objects import LmcpObject

class VideoRecord(LmcpObject):
    """uxas.messages.uxnative.VideoRecord: UXNATIVE type 1."""

    Record: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        Record: bool = ...,
    ) -> None: ...

class StartupComplete(LmcpObject):
    """uxas.messages.uxnative.StartupComplete: UXNATIVE type 2."""
    def __init__(self) -> None: ...

class CreateNewService(LmcpObject):
    """uxas.messages.uxnative.CreateNewService: UXNATIVE type 3."""

    ServiceID: int
    """int64, default 0."""
    XmlConfiguration: str
    """string, default ''."""
    EntityConfigurations: list[_cmasi.EntityConfiguration]
    """CMASI/EntityConfiguration[], default empty, the model says at most 16."""
    EntityStates: list[_cmasi.EntityState]
    """CMASI/EntityState[], default empty, the model says at most 16."""
    MissionCommands: list[_cmasi.MissionCommand]
    """CMASI/MissionCommand[], default empty, the model says at most 16."""
    Areas: list[_impact.AreaOfInterest]
    """IMPACT/AreaOfInterest[], default empty, the model says at most 64."""
    Lines: list[_impact.LineOfInterest]
    """IMPACT/LineOfInterest[], default empty, the model says at most 64."""
    Points: list[_impact.PointOfInterest]
    """IMPACT/PointOfInterest[], default empty, the model says at most 64."""
    KeepInZones: list[_cmasi.KeepInZone]
    """CMASI/KeepInZone[], default empty, the model says at most 64."""
    KeepOutZones: list[_cmasi.KeepOutZone]
    """CMASI/KeepOutZone[], default empty, the model says at most 64."""
    OperatingRegions: list[_cmasi.OperatingRegion]
    """CMASI/OperatingRegion[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        ServiceID: int = ...,
        XmlConfiguration: str = ...,
        EntityConfigurations: Iterable[_cmasi.EntityConfiguration] = ...,
        EntityStates: Iterable[_cmasi.EntityState] = ...,
        MissionCommands: Iterable[_cmasi.MissionCommand] = ...,
        Areas: Iterable[_impact.AreaOfInterest] = ...,
        Lines: Iterable[_impact.LineOfInterest] = ...,
        Points: Iterable[_impact.PointOfInterest] = ...,
        KeepInZones: Iterable[_cmasi.KeepInZone] = ...,
        KeepOutZones: Iterable[_cmasi.KeepOutZone] = ...,
        OperatingRegions: Iterable[_cmasi.OperatingRegion] = ...,
    ) -> None: ...

class KillService(LmcpObject):
    """uxas.messages.uxnative.KillService: UXNATIVE type 4."""

    ServiceID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        ServiceID: int = ...,
    ) -> None: ...

class IncrementWaypoint(LmcpObject):
    """uxas.messages.uxnative.IncrementWaypoint: UXNATIVE type 5."""

    VehicleID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
    ) -> None: ...

class SafeHeadingAction(_cmasi.VehicleAction):
    """uxas.messages.uxnative.SafeHeadingAction: UXNATIVE type 6."""

    VehicleID: int
    """int64, default 0."""
    OperatingRegion: int
    """int64, default 0."""
    LeadAheadDistance: float
    """real32 [meters], default 1000.0."""
    LoiterRadius: float
    """real32 [meters], default 0.0."""
    DesiredHeading: float
    """real32 [degrees], default 0.0."""
    DesiredHeadingRate: float
    """real32 [degrees/sec], default 0.0."""
    UseHeadingRate: bool
    """bool, default false."""
    Altitude: float
    """real32 [meter], default 0.0."""
    AltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default MSL."""
    UseAltitude: bool
    """bool, default false."""
    Speed: float
    """real32 [mps], default 0.0."""
    UseSpeed: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        VehicleID: int = ...,
        OperatingRegion: int = ...,
        LeadAheadDistance: float = ...,
        LoiterRadius: float = ...,
        DesiredHeading: float = ...,
        DesiredHeadingRate: float = ...,
        UseHeadingRate: bool = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
        UseAltitude: bool = ...,
        Speed: float = ...,
        UseSpeed: bool = ...,
    ) -> None: ...

class EntityLocation(LmcpObject):
    """uxas.messages.uxnative.EntityLocation: UXNATIVE type 7."""

    EntityID: int
    """int64, default 0."""
    Position: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Time: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        Position: _cmasi.Location3D = ...,
        Time: int = ...,
    ) -> None: ...

class BandwidthTest(EntityLocation):
    """uxas.messages.uxnative.BandwidthTest: UXNATIVE type 8."""

    MessageID: int
    """int64, default 0."""
    Payload: str
    """string, default ''."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        Position: _cmasi.Location3D = ...,
        Time: int = ...,
        MessageID: int = ...,
        Payload: str = ...,
    ) -> None: ...

class BandwidthReceiveReport(LmcpObject):
    """uxas.messages.uxnative.BandwidthReceiveReport: UXNATIVE type 9."""

    EntitySender: _uxnative.EntityLocation
    """UXNATIVE/EntityLocation, default a new UXNATIVE/EntityLocation."""
    EntityReceiver: _uxnative.EntityLocation
    """UXNATIVE/EntityLocation, default a new UXNATIVE/EntityLocation."""
    TransferPayloadSize: int
    """uint32, default 0."""
    def __init__(
        self,
        *,
        EntitySender: _uxnative.EntityLocation = ...,
        EntityReceiver: _uxnative.EntityLocation = ...,
        TransferPayloadSize: int = ...,
    ) -> None: ...

class SubTaskExecution(LmcpObject):
    """uxas.messages.uxnative.SubTaskExecution: UXNATIVE type 10."""

    SubTasks: list[_cmasi.Task]
    """CMASI/Task[], default empty, the model says at most 16."""
    StrictOrder: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        SubTasks: Iterable[_cmasi.Task] = ...,
        StrictOrder: bool = ...,
    ) -> None: ...

class SubTaskAssignment(LmcpObject):
    """uxas.messages.uxnative.SubTaskAssignment: UXNATIVE type 11."""

    SubTasks: list[_cmasi.Task]
    """CMASI/Task[], default empty, the model says at most 16."""
    Neighbors: list[_cmasi.EntityState]
    """CMASI/EntityState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        SubTasks: Iterable[_cmasi.Task] = ...,
        Neighbors: Iterable[_cmasi.EntityState] = ...,
    ) -> None: ...

class AutopilotKeepAlive(LmcpObject):
    """uxas.messages.uxnative.AutopilotKeepAlive: UXNATIVE type 12."""

    AutopilotEnabled: bool
    """bool, default true."""
    SpeedAuthorized: bool
    """bool, default true."""
    GimbalEnabled: bool
    """bool, default true."""
    TimeSent: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    SpeedOverride: float
    """real32 [meters/sec], default -1.0."""
    AltOverride: float
    """real32 [meters MSL], default -1.0."""
    def __init__(
        self,
        *,
        AutopilotEnabled: bool = ...,
        SpeedAuthorized: bool = ...,
        GimbalEnabled: bool = ...,
        TimeSent: int = ...,
        SpeedOverride: float = ...,
        AltOverride: float = ...,
    ) -> None: ...

class OnboardStatusReport(LmcpObject):
    """uxas.messages.uxnative.OnboardStatusReport: UXNATIVE type 13."""

    VehicleID: int
    """int64, default 0."""
    ConnectedEntities: list[int]
    """int64[], default empty."""
    CurrentTaskList: list[int]
    """int64[], default empty."""
    ValidState: bool
    """bool, default false."""
    ValidAuthorization: bool
    """bool, default false."""
    SpeedAuthorization: bool
    """bool, default false."""
    GimbalAuthorization: bool
    """bool, default false."""
    VehicleTime: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        ConnectedEntities: Iterable[int] = ...,
        CurrentTaskList: Iterable[int] = ...,
        ValidState: bool = ...,
        ValidAuthorization: bool = ...,
        SpeedAuthorization: bool = ...,
        GimbalAuthorization: bool = ...,
        VehicleTime: int = ...,
    ) -> None: ...

class EntityJoin(LmcpObject):
    """uxas.messages.uxnative.EntityJoin: UXNATIVE type 14."""

    EntityID: int
    """int64, default 0."""
    Label: str
    """string, default ''."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        Label: str = ...,
    ) -> None: ...

class EntityExit(LmcpObject):
    """uxas.messages.uxnative.EntityExit: UXNATIVE type 15."""

    EntityID: int
    """int64, default 0."""
    Label: str
    """string, default ''."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        Label: str = ...,
    ) -> None: ...

class SimulationTimeStepAcknowledgement(LmcpObject):
    """uxas.messages.uxnative.SimulationTimeStepAcknowledgement: UXNATIVE type 16."""

    VehicleID: int
    """int64, default 0."""
    ReportedTime: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        ReportedTime: int = ...,
    ) -> None: ...

class SpeedOverrideAction(_cmasi.VehicleAction):
    """uxas.messages.uxnative.SpeedOverrideAction: UXNATIVE type 17."""

    VehicleID: int
    """int64, default 0."""
    Speed: float
    """real32 [mps], default 0.0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        VehicleID: int = ...,
        Speed: float = ...,
    ) -> None: ...
