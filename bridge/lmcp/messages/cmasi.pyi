"""Messages of CMASI, version 3. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.objects import LmcpEnum, LmcpObject

class WavelengthBand(LmcpEnum):
    AllAny = 0
    EO = 1
    LWIR = 2
    SWIR = 3
    MWIR = 4
    Other = 5

class NavigationMode(LmcpEnum):
    Waypoint = 0
    Loiter = 1
    FlightDirector = 2
    TargetTrack = 3
    FollowLeader = 4
    LostComm = 5

class FOVOperationMode(LmcpEnum):
    Continuous = 0
    Discrete = 1

class GimbalPointingMode(LmcpEnum):
    Unknown = 0
    AirVehicleRelativeAngle = 1
    AirVehicleRelativeSlewRate = 2
    LatLonSlaved = 3
    InertialRelativeSlewRate = 4
    Scan = 5
    Stowed = 6

class ZoneAvoidanceType(LmcpEnum):
    Physical = 1
    Regulatory = 2
    Acoustic = 3
    Threat = 4
    Visual = 5

class LoiterType(LmcpEnum):
    VehicleDefault = 0
    Circular = 1
    Racetrack = 2
    FigureEight = 3
    Hover = 4

class LoiterDirection(LmcpEnum):
    VehicleDefault = 0
    CounterClockwise = 1
    Clockwise = 2

class ServiceStatusType(LmcpEnum):
    Information = 0
    Warning = 1
    Error = 2

class SimulationStatusType(LmcpEnum):
    Stopped = 0
    Running = 1
    Paused = 2
    Reset = 3

class SpeedType(LmcpEnum):
    Airspeed = 0
    Groundspeed = 1

class TurnType(LmcpEnum):
    TurnShort = 0
    FlyOver = 1

class CommandStatusType(LmcpEnum):
    Pending = 0
    Approved = 1
    InProcess = 2
    Executed = 3
    Cancelled = 4

class AltitudeType(LmcpEnum):
    AGL = 0
    MSL = 1

class TravelMode(LmcpEnum):
    SinglePass = 0
    ReverseCourse = 1
    Loop = 2

class WaypointTransferMode(LmcpEnum):
    RequestWaypoints = 0
    AddWaypoints = 1
    ClearWaypoints = 2
    ReportWaypoints = 3

class AbstractGeometry(LmcpObject):
    """afrl.cmasi.AbstractGeometry: CMASI type 1."""
    def __init__(self) -> None: ...

class KeyValuePair(LmcpObject):
    """afrl.cmasi.KeyValuePair: CMASI type 2."""

    Key: str
    """string, default ''."""
    Value: str
    """string, default ''."""
    def __init__(
        self,
        *,
        Key: str = ...,
        Value: str = ...,
    ) -> None: ...

class Location3D(LmcpObject):
    """afrl.cmasi.Location3D: CMASI type 3."""

    Latitude: float
    """real64 [degree], default 0.0."""
    Longitude: float
    """real64 [degree], default 0.0."""
    Altitude: float
    """real32 [meter], default 0.0."""
    AltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default MSL."""
    def __init__(
        self,
        *,
        Latitude: float = ...,
        Longitude: float = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
    ) -> None: ...

class VehicleAction(LmcpObject):
    """afrl.cmasi.VehicleAction: CMASI type 7."""

    AssociatedTaskList: list[int]
    """int64[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
    ) -> None: ...

class PayloadAction(VehicleAction):
    """afrl.cmasi.PayloadAction: CMASI type 4."""

    PayloadID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        PayloadID: int = ...,
    ) -> None: ...

class PayloadConfiguration(LmcpObject):
    """afrl.cmasi.PayloadConfiguration: CMASI type 5."""

    PayloadID: int
    """int64, default 0."""
    PayloadKind: str
    """string, default ''."""
    Parameters: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class PayloadState(LmcpObject):
    """afrl.cmasi.PayloadState: CMASI type 6."""

    PayloadID: int
    """int64, default 0."""
    Parameters: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class Task(LmcpObject):
    """afrl.cmasi.Task: CMASI type 8."""

    TaskID: int
    """int64, default 0."""
    Label: str
    """string, default ''."""
    EligibleEntities: list[int]
    """int64[], default empty, the model says at most 32."""
    RevisitRate: float
    """real32 [sec], default 0.0."""
    Parameters: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    Priority: int
    """byte, default 0."""
    Required: bool
    """bool, default true."""
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
    ) -> None: ...

class SearchTask(Task):
    """afrl.cmasi.SearchTask: CMASI type 9."""

    DesiredWavelengthBands: list[_cmasi.WavelengthBand]
    """CMASI/WavelengthBand[], default empty, the model says at most 8."""
    DwellTime: int
    """int64 [milliseconds], default 0."""
    GroundSampleDistance: float
    """real32 [meters/pixel], default 0.0."""
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
        DesiredWavelengthBands: Iterable[_cmasi.WavelengthBand | str] = ...,
        DwellTime: int = ...,
        GroundSampleDistance: float = ...,
    ) -> None: ...

class AbstractZone(LmcpObject):
    """afrl.cmasi.AbstractZone: CMASI type 10."""

    ZoneID: int
    """int64, default 0."""
    MinAltitude: float
    """real32 [meter], default 0.0."""
    MinAltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default AGL."""
    MaxAltitude: float
    """real32 [meter], default 0.0."""
    MaxAltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default MSL."""
    AffectedAircraft: list[int]
    """int64[], default empty, the model says at most 32."""
    StartTime: int
    """int64 [milliseconds], default 0."""
    EndTime: int
    """int64 [milliseconds], default 0."""
    Padding: float
    """real32 [meters], default 0.0."""
    Label: str
    """string, default ''."""
    Boundary: _cmasi.AbstractGeometry
    """CMASI/AbstractGeometry, default a new CMASI/AbstractGeometry."""
    def __init__(
        self,
        *,
        ZoneID: int = ...,
        MinAltitude: float = ...,
        MinAltitudeType: _cmasi.AltitudeType | str = ...,
        MaxAltitude: float = ...,
        MaxAltitudeType: _cmasi.AltitudeType | str = ...,
        AffectedAircraft: Iterable[int] = ...,
        StartTime: int = ...,
        EndTime: int = ...,
        Padding: float = ...,
        Label: str = ...,
        Boundary: _cmasi.AbstractGeometry = ...,
    ) -> None: ...

class EntityConfiguration(LmcpObject):
    """afrl.cmasi.EntityConfiguration: CMASI type 11."""

    ID: int
    """int64, default 0."""
    Affiliation: str
    """string, default 'Unknown'."""
    EntityType: str
    """string, default ''."""
    Label: str
    """string, default ''."""
    NominalSpeed: float
    """real32 [meter/sec], default 0.0."""
    NominalAltitude: float
    """real32 [meter], default 0.0."""
    NominalAltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default AGL."""
    PayloadConfigurationList: list[_cmasi.PayloadConfiguration]
    """CMASI/PayloadConfiguration[], default empty, the model says at most 8."""
    Info: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        ID: int = ...,
        Affiliation: str = ...,
        EntityType: str = ...,
        Label: str = ...,
        NominalSpeed: float = ...,
        NominalAltitude: float = ...,
        NominalAltitudeType: _cmasi.AltitudeType | str = ...,
        PayloadConfigurationList: Iterable[_cmasi.PayloadConfiguration] = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class FlightProfile(LmcpObject):
    """afrl.cmasi.FlightProfile: CMASI type 12."""

    Name: str
    """string, default ''."""
    Airspeed: float
    """real32 [meter/sec], default 0.0."""
    PitchAngle: float
    """real32 [degree], default 0.0."""
    VerticalSpeed: float
    """real32 [meter/sec], default 0.0."""
    MaxBankAngle: float
    """real32 [degree], default 0.0."""
    EnergyRate: float
    """real32 [%/sec], default 0.0."""
    def __init__(
        self,
        *,
        Name: str = ...,
        Airspeed: float = ...,
        PitchAngle: float = ...,
        VerticalSpeed: float = ...,
        MaxBankAngle: float = ...,
        EnergyRate: float = ...,
    ) -> None: ...

class AirVehicleConfiguration(EntityConfiguration):
    """afrl.cmasi.AirVehicleConfiguration: CMASI type 13."""

    MinimumSpeed: float
    """real32 [meter/sec], default 0.0."""
    MaximumSpeed: float
    """real32 [meter/sec], default 0.0."""
    NominalFlightProfile: _cmasi.FlightProfile
    """CMASI/FlightProfile, default a new CMASI/FlightProfile."""
    AlternateFlightProfiles: list[_cmasi.FlightProfile]
    """CMASI/FlightProfile[], default empty, the model says at most 8."""
    AvailableLoiterTypes: list[_cmasi.LoiterType]
    """CMASI/LoiterType[], default empty, the model says at most 8."""
    AvailableTurnTypes: list[_cmasi.TurnType]
    """CMASI/TurnType[], default empty, the model says at most 8."""
    MinimumAltitude: float
    """real32 [meter], default 0.0."""
    MinAltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default AGL."""
    MaximumAltitude: float
    """real32 [meter], default 1000000.0."""
    MaxAltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default MSL."""
    def __init__(
        self,
        *,
        ID: int = ...,
        Affiliation: str = ...,
        EntityType: str = ...,
        Label: str = ...,
        NominalSpeed: float = ...,
        NominalAltitude: float = ...,
        NominalAltitudeType: _cmasi.AltitudeType | str = ...,
        PayloadConfigurationList: Iterable[_cmasi.PayloadConfiguration] = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
        MinimumSpeed: float = ...,
        MaximumSpeed: float = ...,
        NominalFlightProfile: _cmasi.FlightProfile = ...,
        AlternateFlightProfiles: Iterable[_cmasi.FlightProfile] = ...,
        AvailableLoiterTypes: Iterable[_cmasi.LoiterType | str] = ...,
        AvailableTurnTypes: Iterable[_cmasi.TurnType | str] = ...,
        MinimumAltitude: float = ...,
        MinAltitudeType: _cmasi.AltitudeType | str = ...,
        MaximumAltitude: float = ...,
        MaxAltitudeType: _cmasi.AltitudeType | str = ...,
    ) -> None: ...

class EntityState(LmcpObject):
    """afrl.cmasi.EntityState: CMASI type 14."""

    ID: int
    """int64, default 0."""
    u: float
    """real32 [meter/sec], default 0.0."""
    v: float
    """real32 [meter/sec], default 0.0."""
    w: float
    """real32 [meter/sec], default 0.0."""
    udot: float
    """real32 [meter/sec/sec], default 0.0."""
    vdot: float
    """real32 [meter/sec/sec], default 0.0."""
    wdot: float
    """real32 [meter/sec/sec], default 0.0."""
    Heading: float
    """real32 [degree], default 0.0."""
    Pitch: float
    """real32 [degree], default 0.0."""
    Roll: float
    """real32 [degree], default 0.0."""
    p: float
    """real32 [degree/sec], default 0.0."""
    q: float
    """real32 [degree/sec], default 0.0."""
    r: float
    """real32 [degree/sec], default 0.0."""
    Course: float
    """real32 [degrees], default 0.0."""
    Groundspeed: float
    """real32 [m/s], default 0.0."""
    Location: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    EnergyAvailable: float
    """real32 [%], default 0.0."""
    ActualEnergyRate: float
    """real32 [%/sec], default 0.0."""
    PayloadStateList: list[_cmasi.PayloadState]
    """CMASI/PayloadState[], default empty, the model says at most 8."""
    CurrentWaypoint: int
    """int64, default 0."""
    CurrentCommand: int
    """int64, default 0."""
    Mode: _cmasi.NavigationMode
    """CMASI/NavigationMode, default Waypoint."""
    AssociatedTasks: list[int]
    """int64[], default empty, the model says at most 8."""
    Time: int
    """int64 [millisecond], default 0."""
    Info: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        ID: int = ...,
        u: float = ...,
        v: float = ...,
        w: float = ...,
        udot: float = ...,
        vdot: float = ...,
        wdot: float = ...,
        Heading: float = ...,
        Pitch: float = ...,
        Roll: float = ...,
        p: float = ...,
        q: float = ...,
        r: float = ...,
        Course: float = ...,
        Groundspeed: float = ...,
        Location: _cmasi.Location3D = ...,
        EnergyAvailable: float = ...,
        ActualEnergyRate: float = ...,
        PayloadStateList: Iterable[_cmasi.PayloadState] = ...,
        CurrentWaypoint: int = ...,
        CurrentCommand: int = ...,
        Mode: _cmasi.NavigationMode | str = ...,
        AssociatedTasks: Iterable[int] = ...,
        Time: int = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class AirVehicleState(EntityState):
    """afrl.cmasi.AirVehicleState: CMASI type 15."""

    Airspeed: float
    """real32 [meter/sec], default 0.0."""
    VerticalSpeed: float
    """real32 [meter/sec], default 0.0."""
    WindSpeed: float
    """real32 [meter/sec], default 0.0."""
    WindDirection: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        ID: int = ...,
        u: float = ...,
        v: float = ...,
        w: float = ...,
        udot: float = ...,
        vdot: float = ...,
        wdot: float = ...,
        Heading: float = ...,
        Pitch: float = ...,
        Roll: float = ...,
        p: float = ...,
        q: float = ...,
        r: float = ...,
        Course: float = ...,
        Groundspeed: float = ...,
        Location: _cmasi.Location3D = ...,
        EnergyAvailable: float = ...,
        ActualEnergyRate: float = ...,
        PayloadStateList: Iterable[_cmasi.PayloadState] = ...,
        CurrentWaypoint: int = ...,
        CurrentCommand: int = ...,
        Mode: _cmasi.NavigationMode | str = ...,
        AssociatedTasks: Iterable[int] = ...,
        Time: int = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
        Airspeed: float = ...,
        VerticalSpeed: float = ...,
        WindSpeed: float = ...,
        WindDirection: float = ...,
    ) -> None: ...

class Wedge(LmcpObject):
    """afrl.cmasi.Wedge: CMASI type 16."""

    AzimuthCenterline: float
    """real32 [degree], default 0.0."""
    VerticalCenterline: float
    """real32 [degree], default 0.0."""
    AzimuthExtent: float
    """real32 [degree], default 0.0."""
    VerticalExtent: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        AzimuthCenterline: float = ...,
        VerticalCenterline: float = ...,
        AzimuthExtent: float = ...,
        VerticalExtent: float = ...,
    ) -> None: ...

class AreaSearchTask(SearchTask):
    """afrl.cmasi.AreaSearchTask: CMASI type 17."""

    SearchArea: _cmasi.AbstractGeometry
    """CMASI/AbstractGeometry, default a new CMASI/AbstractGeometry."""
    ViewAngleList: list[_cmasi.Wedge]
    """CMASI/Wedge[], default empty, the model says at most 16."""
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
        DesiredWavelengthBands: Iterable[_cmasi.WavelengthBand | str] = ...,
        DwellTime: int = ...,
        GroundSampleDistance: float = ...,
        SearchArea: _cmasi.AbstractGeometry = ...,
        ViewAngleList: Iterable[_cmasi.Wedge] = ...,
    ) -> None: ...

class CameraAction(PayloadAction):
    """afrl.cmasi.CameraAction: CMASI type 18."""

    HorizontalFieldOfView: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        PayloadID: int = ...,
        HorizontalFieldOfView: float = ...,
    ) -> None: ...

class CameraConfiguration(PayloadConfiguration):
    """afrl.cmasi.CameraConfiguration: CMASI type 19."""

    SupportedWavelengthBand: _cmasi.WavelengthBand
    """CMASI/WavelengthBand, default EO."""
    FieldOfViewMode: _cmasi.FOVOperationMode
    """CMASI/FOVOperationMode, default Continuous."""
    MinHorizontalFieldOfView: float
    """real32 [degree], default 0.0."""
    MaxHorizontalFieldOfView: float
    """real32 [degree], default 0.0."""
    DiscreteHorizontalFieldOfViewList: list[float]
    """real32[] [degree], default empty, the model says at most 16."""
    VideoStreamHorizontalResolution: int
    """uint32 [pixel], default 0."""
    VideoStreamVerticalResolution: int
    """uint32 [pixel], default 0."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        SupportedWavelengthBand: _cmasi.WavelengthBand | str = ...,
        FieldOfViewMode: _cmasi.FOVOperationMode | str = ...,
        MinHorizontalFieldOfView: float = ...,
        MaxHorizontalFieldOfView: float = ...,
        DiscreteHorizontalFieldOfViewList: Iterable[float] = ...,
        VideoStreamHorizontalResolution: int = ...,
        VideoStreamVerticalResolution: int = ...,
    ) -> None: ...

class GimballedPayloadState(PayloadState):
    """afrl.cmasi.GimballedPayloadState: CMASI type 20."""

    PointingMode: _cmasi.GimbalPointingMode
    """CMASI/GimbalPointingMode, default Unknown."""
    Azimuth: float
    """real32 [degree], default 0.0."""
    Elevation: float
    """real32 [degree], default 0.0."""
    Rotation: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        PointingMode: _cmasi.GimbalPointingMode | str = ...,
        Azimuth: float = ...,
        Elevation: float = ...,
        Rotation: float = ...,
    ) -> None: ...

class CameraState(GimballedPayloadState):
    """afrl.cmasi.CameraState: CMASI type 21."""

    HorizontalFieldOfView: float
    """real32 [degree], default 0.0."""
    VerticalFieldOfView: float
    """real32 [degree], default 0.0."""
    Footprint: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 8."""
    Centerpoint: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        PointingMode: _cmasi.GimbalPointingMode | str = ...,
        Azimuth: float = ...,
        Elevation: float = ...,
        Rotation: float = ...,
        HorizontalFieldOfView: float = ...,
        VerticalFieldOfView: float = ...,
        Footprint: Iterable[_cmasi.Location3D] = ...,
        Centerpoint: _cmasi.Location3D | None = ...,
    ) -> None: ...

class Circle(AbstractGeometry):
    """afrl.cmasi.Circle: CMASI type 22."""

    CenterPoint: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Radius: float
    """real32 [meter], default 0.0."""
    def __init__(
        self,
        *,
        CenterPoint: _cmasi.Location3D = ...,
        Radius: float = ...,
    ) -> None: ...

class GimbalAngleAction(PayloadAction):
    """afrl.cmasi.GimbalAngleAction: CMASI type 23."""

    Azimuth: float
    """real32 [degree], default 0.0."""
    Elevation: float
    """real32 [degree], default 0.0."""
    Rotation: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        PayloadID: int = ...,
        Azimuth: float = ...,
        Elevation: float = ...,
        Rotation: float = ...,
    ) -> None: ...

class GimbalConfiguration(PayloadConfiguration):
    """afrl.cmasi.GimbalConfiguration: CMASI type 24."""

    SupportedPointingModes: list[_cmasi.GimbalPointingMode]
    """CMASI/GimbalPointingMode[], default empty, the model says at most 8."""
    MinAzimuth: float
    """real32 [degree], default -180.0."""
    MaxAzimuth: float
    """real32 [degree], default 180.0."""
    IsAzimuthClamped: bool
    """bool, default false."""
    MinElevation: float
    """real32 [degree], default -180.0."""
    MaxElevation: float
    """real32 [degree], default 180.0."""
    IsElevationClamped: bool
    """bool, default false."""
    MinRotation: float
    """real32 [degree], default 0.0."""
    MaxRotation: float
    """real32 [degree], default 0.0."""
    IsRotationClamped: bool
    """bool, default true."""
    MaxAzimuthSlewRate: float
    """real32 [degree/sec], default 0.0."""
    MaxElevationSlewRate: float
    """real32 [degree/sec], default 0.0."""
    MaxRotationRate: float
    """real32 [degree/sec], default 0.0."""
    ContainedPayloadList: list[int]
    """int64[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        SupportedPointingModes: Iterable[_cmasi.GimbalPointingMode | str] = ...,
        MinAzimuth: float = ...,
        MaxAzimuth: float = ...,
        IsAzimuthClamped: bool = ...,
        MinElevation: float = ...,
        MaxElevation: float = ...,
        IsElevationClamped: bool = ...,
        MinRotation: float = ...,
        MaxRotation: float = ...,
        IsRotationClamped: bool = ...,
        MaxAzimuthSlewRate: float = ...,
        MaxElevationSlewRate: float = ...,
        MaxRotationRate: float = ...,
        ContainedPayloadList: Iterable[int] = ...,
    ) -> None: ...

class GimbalScanAction(PayloadAction):
    """afrl.cmasi.GimbalScanAction: CMASI type 25."""

    AzimuthSlewRate: float
    """real32 [degree/second], default 0.0."""
    ElevationSlewRate: float
    """real32 [degree/second], default 0.0."""
    StartAzimuth: float
    """real32 [degree], default 0.0."""
    EndAzimuth: float
    """real32 [degree], default 0.0."""
    StartElevation: float
    """real32 [degree], default 0.0."""
    EndElevation: float
    """real32 [degree], default 0.0."""
    Cycles: int
    """uint32, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        PayloadID: int = ...,
        AzimuthSlewRate: float = ...,
        ElevationSlewRate: float = ...,
        StartAzimuth: float = ...,
        EndAzimuth: float = ...,
        StartElevation: float = ...,
        EndElevation: float = ...,
        Cycles: int = ...,
    ) -> None: ...

class GimbalStareAction(PayloadAction):
    """afrl.cmasi.GimbalStareAction: CMASI type 26."""

    Starepoint: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Duration: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        PayloadID: int = ...,
        Starepoint: _cmasi.Location3D = ...,
        Duration: int = ...,
    ) -> None: ...

class GimbalState(PayloadState):
    """afrl.cmasi.GimbalState: CMASI type 27."""

    PointingMode: _cmasi.GimbalPointingMode
    """CMASI/GimbalPointingMode, default Unknown."""
    Azimuth: float
    """real32 [degree], default 0.0."""
    Elevation: float
    """real32 [degree], default 0.0."""
    Rotation: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        PointingMode: _cmasi.GimbalPointingMode | str = ...,
        Azimuth: float = ...,
        Elevation: float = ...,
        Rotation: float = ...,
    ) -> None: ...

class NavigationAction(VehicleAction):
    """afrl.cmasi.NavigationAction: CMASI type 32."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
    ) -> None: ...

class GoToWaypointAction(NavigationAction):
    """afrl.cmasi.GoToWaypointAction: CMASI type 28."""

    WaypointNumber: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        WaypointNumber: int = ...,
    ) -> None: ...

class KeepInZone(AbstractZone):
    """afrl.cmasi.KeepInZone: CMASI type 29."""
    def __init__(
        self,
        *,
        ZoneID: int = ...,
        MinAltitude: float = ...,
        MinAltitudeType: _cmasi.AltitudeType | str = ...,
        MaxAltitude: float = ...,
        MaxAltitudeType: _cmasi.AltitudeType | str = ...,
        AffectedAircraft: Iterable[int] = ...,
        StartTime: int = ...,
        EndTime: int = ...,
        Padding: float = ...,
        Label: str = ...,
        Boundary: _cmasi.AbstractGeometry = ...,
    ) -> None: ...

class KeepOutZone(AbstractZone):
    """afrl.cmasi.KeepOutZone: CMASI type 30."""

    ZoneType: _cmasi.ZoneAvoidanceType
    """CMASI/ZoneAvoidanceType, default Physical."""
    def __init__(
        self,
        *,
        ZoneID: int = ...,
        MinAltitude: float = ...,
        MinAltitudeType: _cmasi.AltitudeType | str = ...,
        MaxAltitude: float = ...,
        MaxAltitudeType: _cmasi.AltitudeType | str = ...,
        AffectedAircraft: Iterable[int] = ...,
        StartTime: int = ...,
        EndTime: int = ...,
        Padding: float = ...,
        Label: str = ...,
        Boundary: _cmasi.AbstractGeometry = ...,
        ZoneType: _cmasi.ZoneAvoidanceType | str = ...,
    ) -> None: ...

class LineSearchTask(SearchTask):
    """afrl.cmasi.LineSearchTask: CMASI type 31."""

    PointList: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 1024."""
    ViewAngleList: list[_cmasi.Wedge]
    """CMASI/Wedge[], default empty, the model says at most 16."""
    UseInertialViewAngles: bool
    """bool, default false."""
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
        DesiredWavelengthBands: Iterable[_cmasi.WavelengthBand | str] = ...,
        DwellTime: int = ...,
        GroundSampleDistance: float = ...,
        PointList: Iterable[_cmasi.Location3D] = ...,
        ViewAngleList: Iterable[_cmasi.Wedge] = ...,
        UseInertialViewAngles: bool = ...,
    ) -> None: ...

class LoiterAction(NavigationAction):
    """afrl.cmasi.LoiterAction: CMASI type 33."""

    LoiterType: _cmasi.LoiterType
    """CMASI/LoiterType, default VehicleDefault."""
    Radius: float
    """real32 [meter], default 0.0."""
    Axis: float
    """real32 [degree], default 0.0."""
    Length: float
    """real32 [meter], default 0.0."""
    Direction: _cmasi.LoiterDirection
    """CMASI/LoiterDirection, default VehicleDefault."""
    Duration: int
    """int64 [milliseconds], default 0."""
    Airspeed: float
    """real32 [meter/sec], default 0.0."""
    Location: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        LoiterType: _cmasi.LoiterType | str = ...,
        Radius: float = ...,
        Axis: float = ...,
        Length: float = ...,
        Direction: _cmasi.LoiterDirection | str = ...,
        Duration: int = ...,
        Airspeed: float = ...,
        Location: _cmasi.Location3D = ...,
    ) -> None: ...

class LoiterTask(Task):
    """afrl.cmasi.LoiterTask: CMASI type 34."""

    DesiredAction: _cmasi.LoiterAction
    """CMASI/LoiterAction, default a new CMASI/LoiterAction."""
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
        DesiredAction: _cmasi.LoiterAction = ...,
    ) -> None: ...

class Waypoint(Location3D):
    """afrl.cmasi.Waypoint: CMASI type 35."""

    Number: int
    """int64, default 0."""
    NextWaypoint: int
    """int64, default 0."""
    Speed: float
    """real32 [meter/sec], default 0.0."""
    SpeedType: _cmasi.SpeedType
    """CMASI/SpeedType, default Airspeed."""
    ClimbRate: float
    """real32 [meter/sec], default 0.0."""
    TurnType: _cmasi.TurnType
    """CMASI/TurnType, default TurnShort."""
    VehicleActionList: list[_cmasi.VehicleAction]
    """CMASI/VehicleAction[], default empty, the model says at most 8."""
    ContingencyWaypointA: int
    """int64, default 0."""
    ContingencyWaypointB: int
    """int64, default 0."""
    AssociatedTasks: list[int]
    """int64[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        Latitude: float = ...,
        Longitude: float = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
        Number: int = ...,
        NextWaypoint: int = ...,
        Speed: float = ...,
        SpeedType: _cmasi.SpeedType | str = ...,
        ClimbRate: float = ...,
        TurnType: _cmasi.TurnType | str = ...,
        VehicleActionList: Iterable[_cmasi.VehicleAction] = ...,
        ContingencyWaypointA: int = ...,
        ContingencyWaypointB: int = ...,
        AssociatedTasks: Iterable[int] = ...,
    ) -> None: ...

class VehicleActionCommand(LmcpObject):
    """afrl.cmasi.VehicleActionCommand: CMASI type 47."""

    CommandID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    VehicleActionList: list[_cmasi.VehicleAction]
    """CMASI/VehicleAction[], default empty, the model says at most 8."""
    Status: _cmasi.CommandStatusType
    """CMASI/CommandStatusType, default Pending."""
    def __init__(
        self,
        *,
        CommandID: int = ...,
        VehicleID: int = ...,
        VehicleActionList: Iterable[_cmasi.VehicleAction] = ...,
        Status: _cmasi.CommandStatusType | str = ...,
    ) -> None: ...

class MissionCommand(VehicleActionCommand):
    """afrl.cmasi.MissionCommand: CMASI type 36."""

    WaypointList: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    FirstWaypoint: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        CommandID: int = ...,
        VehicleID: int = ...,
        VehicleActionList: Iterable[_cmasi.VehicleAction] = ...,
        Status: _cmasi.CommandStatusType | str = ...,
        WaypointList: Iterable[_cmasi.Waypoint] = ...,
        FirstWaypoint: int = ...,
    ) -> None: ...

class MustFlyTask(Task):
    """afrl.cmasi.MustFlyTask: CMASI type 37."""

    Position: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    UseAltitude: bool
    """bool, default true."""
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
        Position: _cmasi.Location3D = ...,
        UseAltitude: bool = ...,
    ) -> None: ...

class OperatorSignal(LmcpObject):
    """afrl.cmasi.OperatorSignal: CMASI type 38."""

    Signals: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        Signals: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class OperatingRegion(LmcpObject):
    """afrl.cmasi.OperatingRegion: CMASI type 39."""

    ID: int
    """int64, default 0."""
    KeepInAreas: list[int]
    """int64[], default empty, the model says at most 32."""
    KeepOutAreas: list[int]
    """int64[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        ID: int = ...,
        KeepInAreas: Iterable[int] = ...,
        KeepOutAreas: Iterable[int] = ...,
    ) -> None: ...

class AutomationRequest(LmcpObject):
    """afrl.cmasi.AutomationRequest: CMASI type 40."""

    EntityList: list[int]
    """int64[], default empty, the model says at most 16."""
    TaskList: list[int]
    """int64[], default empty, the model says at most 32."""
    TaskRelationships: str
    """string, default ''."""
    OperatingRegion: int
    """int64, default 0."""
    RedoAllTasks: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        EntityList: Iterable[int] = ...,
        TaskList: Iterable[int] = ...,
        TaskRelationships: str = ...,
        OperatingRegion: int = ...,
        RedoAllTasks: bool = ...,
    ) -> None: ...

class PointSearchTask(SearchTask):
    """afrl.cmasi.PointSearchTask: CMASI type 41."""

    SearchLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    StandoffDistance: float
    """real32 [meter], default 0.0."""
    ViewAngleList: list[_cmasi.Wedge]
    """CMASI/Wedge[], default empty, the model says at most 64."""
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
        DesiredWavelengthBands: Iterable[_cmasi.WavelengthBand | str] = ...,
        DwellTime: int = ...,
        GroundSampleDistance: float = ...,
        SearchLocation: _cmasi.Location3D = ...,
        StandoffDistance: float = ...,
        ViewAngleList: Iterable[_cmasi.Wedge] = ...,
    ) -> None: ...

class Polygon(AbstractGeometry):
    """afrl.cmasi.Polygon: CMASI type 42."""

    BoundaryPoints: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 64."""
    def __init__(
        self,
        *,
        BoundaryPoints: Iterable[_cmasi.Location3D] = ...,
    ) -> None: ...

class Rectangle(AbstractGeometry):
    """afrl.cmasi.Rectangle: CMASI type 43."""

    CenterPoint: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Width: float
    """real32 [meter], default 0.0."""
    Height: float
    """real32 [meter], default 0.0."""
    Rotation: float
    """real32 [degree], default 0.0."""
    def __init__(
        self,
        *,
        CenterPoint: _cmasi.Location3D = ...,
        Width: float = ...,
        Height: float = ...,
        Rotation: float = ...,
    ) -> None: ...

class RemoveTasks(LmcpObject):
    """afrl.cmasi.RemoveTasks: CMASI type 44."""

    TaskList: list[int]
    """int64[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        TaskList: Iterable[int] = ...,
    ) -> None: ...

class ServiceStatus(LmcpObject):
    """afrl.cmasi.ServiceStatus: CMASI type 45."""

    PercentComplete: float
    """real32, default 0.0."""
    Info: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    StatusType: _cmasi.ServiceStatusType
    """CMASI/ServiceStatusType, default Information."""
    def __init__(
        self,
        *,
        PercentComplete: float = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
        StatusType: _cmasi.ServiceStatusType | str = ...,
    ) -> None: ...

class SessionStatus(LmcpObject):
    """afrl.cmasi.SessionStatus: CMASI type 46."""

    State: _cmasi.SimulationStatusType
    """CMASI/SimulationStatusType, default Stopped."""
    StartTime: int
    """int64 [millisecond], default 0."""
    ScenarioTime: int
    """int64 [millisecond], default 0."""
    RealTimeMultiple: float
    """real32, default 0.0."""
    Parameters: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        State: _cmasi.SimulationStatusType | str = ...,
        StartTime: int = ...,
        ScenarioTime: int = ...,
        RealTimeMultiple: float = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class VideoStreamAction(VehicleAction):
    """afrl.cmasi.VideoStreamAction: CMASI type 48."""

    VideoStreamID: int
    """int32, default 0."""
    ActiveSensor: int
    """int32, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        VideoStreamID: int = ...,
        ActiveSensor: int = ...,
    ) -> None: ...

class VideoStreamConfiguration(PayloadConfiguration):
    """afrl.cmasi.VideoStreamConfiguration: CMASI type 49."""

    AvailableSensorList: list[int]
    """int64[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        AvailableSensorList: Iterable[int] = ...,
    ) -> None: ...

class VideoStreamState(PayloadState):
    """afrl.cmasi.VideoStreamState: CMASI type 50."""

    ActiveSensor: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        ActiveSensor: int = ...,
    ) -> None: ...

class AutomationResponse(LmcpObject):
    """afrl.cmasi.AutomationResponse: CMASI type 51."""

    MissionCommandList: list[_cmasi.MissionCommand]
    """CMASI/MissionCommand[], default empty, the model says at most 16."""
    VehicleCommandList: list[_cmasi.VehicleActionCommand]
    """CMASI/VehicleActionCommand[], default empty, the model says at most 64."""
    Info: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        MissionCommandList: Iterable[_cmasi.MissionCommand] = ...,
        VehicleCommandList: Iterable[_cmasi.VehicleActionCommand] = ...,
        Info: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class RemoveZones(LmcpObject):
    """afrl.cmasi.RemoveZones: CMASI type 52."""

    ZoneList: list[int]
    """int64[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        ZoneList: Iterable[int] = ...,
    ) -> None: ...

class RemoveEntities(LmcpObject):
    """afrl.cmasi.RemoveEntities: CMASI type 53."""

    EntityList: list[int]
    """int64[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        EntityList: Iterable[int] = ...,
    ) -> None: ...

class FlightDirectorAction(NavigationAction):
    """afrl.cmasi.FlightDirectorAction: CMASI type 54."""

    Speed: float
    """real32 [meter/sec], default 0.0."""
    SpeedType: _cmasi.SpeedType
    """CMASI/SpeedType, default Airspeed."""
    Heading: float
    """real32 [degree], default 0.0."""
    Altitude: float
    """real32 [meter], default 0.0."""
    AltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default MSL."""
    ClimbRate: float
    """real32 [meter/sec], default 0.0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        Speed: float = ...,
        SpeedType: _cmasi.SpeedType | str = ...,
        Heading: float = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
        ClimbRate: float = ...,
    ) -> None: ...

class WeatherReport(LmcpObject):
    """afrl.cmasi.WeatherReport: CMASI type 55."""

    Area: _cmasi.AbstractZone | None
    """CMASI/AbstractZone, default null, may be null."""
    WindSpeed: float
    """real32 [meter/sec], default 0.0."""
    WindDirection: float
    """real32 [degree], default 0.0."""
    Visibility: float
    """real32 [meter], default 0.0."""
    CloudCeiling: float
    """real32 [meter], default 0.0."""
    CloudCoverage: float
    """real32, default 0.0."""
    def __init__(
        self,
        *,
        Area: _cmasi.AbstractZone | None = ...,
        WindSpeed: float = ...,
        WindDirection: float = ...,
        Visibility: float = ...,
        CloudCeiling: float = ...,
        CloudCoverage: float = ...,
    ) -> None: ...

class FollowPathCommand(VehicleActionCommand):
    """afrl.cmasi.FollowPathCommand: CMASI type 56."""

    FirstWaypoint: int
    """int64, default 0."""
    WaypointList: list[_cmasi.PathWaypoint]
    """CMASI/PathWaypoint[], default empty, the model says at most 1024."""
    StartTime: int
    """int64 [milliseconds], default 0."""
    StopTime: int
    """int64 [milliseconds], default 0."""
    RepeatMode: _cmasi.TravelMode
    """CMASI/TravelMode, default SinglePass."""
    def __init__(
        self,
        *,
        CommandID: int = ...,
        VehicleID: int = ...,
        VehicleActionList: Iterable[_cmasi.VehicleAction] = ...,
        Status: _cmasi.CommandStatusType | str = ...,
        FirstWaypoint: int = ...,
        WaypointList: Iterable[_cmasi.PathWaypoint] = ...,
        StartTime: int = ...,
        StopTime: int = ...,
        RepeatMode: _cmasi.TravelMode | str = ...,
    ) -> None: ...

class PathWaypoint(Waypoint):
    """afrl.cmasi.PathWaypoint: CMASI type 57."""

    PauseTime: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        Latitude: float = ...,
        Longitude: float = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
        Number: int = ...,
        NextWaypoint: int = ...,
        Speed: float = ...,
        SpeedType: _cmasi.SpeedType | str = ...,
        ClimbRate: float = ...,
        TurnType: _cmasi.TurnType | str = ...,
        VehicleActionList: Iterable[_cmasi.VehicleAction] = ...,
        ContingencyWaypointA: int = ...,
        ContingencyWaypointB: int = ...,
        AssociatedTasks: Iterable[int] = ...,
        PauseTime: int = ...,
    ) -> None: ...

class StopMovementAction(VehicleAction):
    """afrl.cmasi.StopMovementAction: CMASI type 58."""

    Location: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        Location: _cmasi.Location3D | None = ...,
    ) -> None: ...

class WaypointTransfer(LmcpObject):
    """afrl.cmasi.WaypointTransfer: CMASI type 59."""

    EntityID: int
    """int64, default 0."""
    Waypoints: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    TransferMode: _cmasi.WaypointTransferMode
    """CMASI/WaypointTransferMode, default AddWaypoints."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        Waypoints: Iterable[_cmasi.Waypoint] = ...,
        TransferMode: _cmasi.WaypointTransferMode | str = ...,
    ) -> None: ...

class PayloadStowAction(LmcpObject):
    """afrl.cmasi.PayloadStowAction: CMASI type 60."""

    PayloadID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
    ) -> None: ...
