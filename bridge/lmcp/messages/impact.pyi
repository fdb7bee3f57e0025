"""Messages of IMPACT, version 14. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.messages import impact as _impact
from cratous.bridge.lmcp.objects import LmcpEnum, LmcpObject

class AreaSearchPattern(LmcpEnum):
    Spiral = 0
    Sector = 1
    Sweep = 2

class PowerPlant(LmcpEnum):
    Gasoline = 0
    JP5 = 1
    JP8 = 2
    FuelCell = 3
    Hybrid = 4
    Electric = 5

class AreaActionOptions(LmcpEnum):
    Created = 0
    Destroyed = 1
    Modified = 2

class ImpactPayloadType(LmcpEnum):
    Unknown = 0
    EO = 1
    FLIR = 2
    MWIR = 3
    LFIR = 4
    Track = 5
    Tag = 6
    Megaphone = 7
    Siren = 8
    SearchLight = 9
    FiftyCal = 10
    M240B = 11
    Flashbang = 12
    TearGas = 13
    Taser = 14
    HeatBeam = 15
    SEGM = 16
    CommRelay = 17
    GMTI = 18
    LaserDesignator = 19
    LWIR = 20

class PowerConfiguration(_cmasi.PayloadConfiguration):
    """afrl.impact.PowerConfiguration: IMPACT type 1."""

    NominalPowerConfiguration: _impact.PowerPlant
    """IMPACT/PowerPlant, default Gasoline."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        NominalPowerConfiguration: _impact.PowerPlant | str = ...,
    ) -> None: ...

class RadioConfiguration(_cmasi.PayloadConfiguration):
    """afrl.impact.RadioConfiguration: IMPACT type 2."""

    Range: float
    """real32 [meters], default 1500.0."""
    RallyPoint: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    Timeout: int
    """int64 [milliseconds], default 120000."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        Range: float = ...,
        RallyPoint: _cmasi.Location3D | None = ...,
        Timeout: int = ...,
    ) -> None: ...

class RadioTowerConfiguration(_cmasi.EntityConfiguration):
    """afrl.impact.RadioTowerConfiguration: IMPACT type 3."""

    Position: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Range: float
    """real32 [meters], default 1500.0."""
    Enabled: bool
    """bool, default true."""
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
        Position: _cmasi.Location3D = ...,
        Range: float = ...,
        Enabled: bool = ...,
    ) -> None: ...

class RadioState(_cmasi.PayloadState):
    """afrl.impact.RadioState: IMPACT type 4."""

    Enabled: bool
    """bool, default true."""
    InRange: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        Enabled: bool = ...,
        InRange: bool = ...,
    ) -> None: ...

class RadioTowerState(_cmasi.EntityState):
    """afrl.impact.RadioTowerState: IMPACT type 5."""

    Enabled: bool
    """bool, default true."""
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
        Enabled: bool = ...,
    ) -> None: ...

class ImpactPayloadConfiguration(_cmasi.PayloadConfiguration):
    """afrl.impact.ImpactPayloadConfiguration: IMPACT type 6."""

    AvailablePayloads: list[_impact.ImpactPayloadType]
    """IMPACT/ImpactPayloadType[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        PayloadKind: str = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        AvailablePayloads: Iterable[_impact.ImpactPayloadType | str] = ...,
    ) -> None: ...

class DeployImpactPayload(_cmasi.VehicleAction):
    """afrl.impact.DeployImpactPayload: IMPACT type 7."""

    VehicleID: int
    """int64, default 0."""
    DeployedPayload: _impact.ImpactPayloadType
    """IMPACT/ImpactPayloadType, default Unknown."""
    TargetEntityID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        AssociatedTaskList: Iterable[int] = ...,
        VehicleID: int = ...,
        DeployedPayload: _impact.ImpactPayloadType | str = ...,
        TargetEntityID: int = ...,
    ) -> None: ...

class PowerPlantState(_cmasi.PayloadState):
    """afrl.impact.PowerPlantState: IMPACT type 8."""

    ActivePowerPlant: _impact.PowerPlant
    """IMPACT/PowerPlant, default Gasoline."""
    def __init__(
        self,
        *,
        PayloadID: int = ...,
        Parameters: Iterable[_cmasi.KeyValuePair] = ...,
        ActivePowerPlant: _impact.PowerPlant | str = ...,
    ) -> None: ...

class BatchRoutePlanRequest(LmcpObject):
    """afrl.impact.BatchRoutePlanRequest: IMPACT type 9."""

    RequestID: int
    """int64, default 0."""
    Vehicles: list[int]
    """int64[], default empty, the model says at most 16."""
    TaskList: list[int]
    """int64[], default empty, the model says at most 16."""
    OperatingRegion: int
    """int64, default 0."""
    ComputeTaskToTaskTiming: bool
    """bool, default false."""
    ComputeInterTaskToTaskTiming: bool
    """bool, default false."""
    InterTaskPercentage: list[float]
    """real32[], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        Vehicles: Iterable[int] = ...,
        TaskList: Iterable[int] = ...,
        OperatingRegion: int = ...,
        ComputeTaskToTaskTiming: bool = ...,
        ComputeInterTaskToTaskTiming: bool = ...,
        InterTaskPercentage: Iterable[float] = ...,
    ) -> None: ...

class BatchRoutePlanResponse(LmcpObject):
    """afrl.impact.BatchRoutePlanResponse: IMPACT type 10."""

    ResponseID: int
    """int64, default 0."""
    VehicleTiming: list[_impact.TaskTimingPair]
    """IMPACT/TaskTimingPair[], default empty, the model says at most 8192."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        VehicleTiming: Iterable[_impact.TaskTimingPair] = ...,
    ) -> None: ...

class TaskTimingPair(LmcpObject):
    """afrl.impact.TaskTimingPair: IMPACT type 11."""

    VehicleID: int
    """int64, default 0."""
    InitialTaskID: int
    """int64, default 0."""
    InitialTaskPercentage: float
    """real32, default 0.0."""
    DestinationTaskID: int
    """int64, default 0."""
    TimeToGo: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        InitialTaskID: int = ...,
        InitialTaskPercentage: float = ...,
        DestinationTaskID: int = ...,
        TimeToGo: int = ...,
    ) -> None: ...

class BatchSummaryRequest(LmcpObject):
    """afrl.impact.BatchSummaryRequest: IMPACT type 12."""

    RequestID: int
    """int64, default 0."""
    Vehicles: list[int]
    """int64[], default empty, the model says at most 16."""
    TaskList: list[int]
    """int64[], default empty, the model says at most 16."""
    TaskRelationships: str
    """string, default ''."""
    InterTaskPercentage: list[float]
    """real32[], default empty, the model says at most 32."""
    OperatingRegion: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        Vehicles: Iterable[int] = ...,
        TaskList: Iterable[int] = ...,
        TaskRelationships: str = ...,
        InterTaskPercentage: Iterable[float] = ...,
        OperatingRegion: int = ...,
    ) -> None: ...

class BatchSummaryResponse(LmcpObject):
    """afrl.impact.BatchSummaryResponse: IMPACT type 13."""

    ResponseID: int
    """int64, default 0."""
    Summaries: list[_impact.TaskSummary]
    """IMPACT/TaskSummary[], default empty, the model says at most 512."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        Summaries: Iterable[_impact.TaskSummary] = ...,
    ) -> None: ...

class TaskSummary(LmcpObject):
    """afrl.impact.TaskSummary: IMPACT type 14."""

    TaskID: int
    """int64, default 0."""
    PerformingVehicles: list[_impact.VehicleSummary]
    """IMPACT/VehicleSummary[], default empty, the model says at most 16."""
    BestEffort: float
    """real32 [%], default 100.0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        PerformingVehicles: Iterable[_impact.VehicleSummary] = ...,
        BestEffort: float = ...,
    ) -> None: ...

class VehicleSummary(LmcpObject):
    """afrl.impact.VehicleSummary: IMPACT type 15."""

    VehicleID: int
    """int64, default 0."""
    DestinationTaskID: int
    """int64, default 0."""
    InitialTaskID: int
    """int64, default 0."""
    InitialTaskPercentage: float
    """real32, default 0.0."""
    EstimateTimeToTaskPercentage: int
    """int64 [milliseconds], default 0."""
    TimeToArrive: int
    """int64 [milliseconds], default 0."""
    TimeOnTask: int
    """int64 [milliseconds], default 0."""
    EnergyRemaining: float
    """real32 [%], default 0.0."""
    BeyondCommRange: bool
    """bool, default false."""
    ConflictsWithROZ: bool
    """bool, default false."""
    ROZIDs: list[int]
    """int64[], default empty, the model says at most 64."""
    WaypointList: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    FirstWaypoint: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        DestinationTaskID: int = ...,
        InitialTaskID: int = ...,
        InitialTaskPercentage: float = ...,
        EstimateTimeToTaskPercentage: int = ...,
        TimeToArrive: int = ...,
        TimeOnTask: int = ...,
        EnergyRemaining: float = ...,
        BeyondCommRange: bool = ...,
        ConflictsWithROZ: bool = ...,
        ROZIDs: Iterable[int] = ...,
        WaypointList: Iterable[_cmasi.Waypoint] = ...,
        FirstWaypoint: int = ...,
    ) -> None: ...

class SpeedAltPair(LmcpObject):
    """afrl.impact.SpeedAltPair: IMPACT type 16."""

    VehicleID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    Speed: float
    """real32 [meter/sec], default 0.0."""
    Altitude: float
    """real32 [meter], default 0.0."""
    AltitudeType: _cmasi.AltitudeType
    """CMASI/AltitudeType, default AGL."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        TaskID: int = ...,
        Speed: float = ...,
        Altitude: float = ...,
        AltitudeType: _cmasi.AltitudeType | str = ...,
    ) -> None: ...

class ImpactAutomationRequest(LmcpObject):
    """afrl.impact.ImpactAutomationRequest: IMPACT type 17."""

    RequestID: int
    """int64, default 0."""
    TrialRequest: _cmasi.AutomationRequest
    """CMASI/AutomationRequest, default a new CMASI/AutomationRequest."""
    OverridePlanningConditions: list[_impact.SpeedAltPair]
    """IMPACT/SpeedAltPair[], default empty, the model says at most 16."""
    PlayID: int
    """int64, default 0."""
    SolutionID: int
    """int64, default 0."""
    Sandbox: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        TrialRequest: _cmasi.AutomationRequest = ...,
        OverridePlanningConditions: Iterable[_impact.SpeedAltPair] = ...,
        PlayID: int = ...,
        SolutionID: int = ...,
        Sandbox: bool = ...,
    ) -> None: ...

class ImpactAutomationResponse(LmcpObject):
    """afrl.impact.ImpactAutomationResponse: IMPACT type 18."""

    ResponseID: int
    """int64, default 0."""
    TrialResponse: _cmasi.AutomationResponse
    """CMASI/AutomationResponse, default a new CMASI/AutomationResponse."""
    PlayID: int
    """int64, default 0."""
    SolutionID: int
    """int64, default 0."""
    Sandbox: bool
    """bool, default false."""
    Summaries: list[_impact.TaskSummary]
    """IMPACT/TaskSummary[], default empty, the model says at most 512."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        TrialResponse: _cmasi.AutomationResponse = ...,
        PlayID: int = ...,
        SolutionID: int = ...,
        Sandbox: bool = ...,
        Summaries: Iterable[_impact.TaskSummary] = ...,
    ) -> None: ...

class PointOfInterest(LmcpObject):
    """afrl.impact.PointOfInterest: IMPACT type 19."""

    PointID: int
    """int64, default 0."""
    Location: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    PointAction: _impact.AreaActionOptions
    """IMPACT/AreaActionOptions, default Created."""
    PointLabel: str
    """string, default ''."""
    BackgroundBehaviorPoint: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        PointID: int = ...,
        Location: _cmasi.Location3D = ...,
        PointAction: _impact.AreaActionOptions | str = ...,
        PointLabel: str = ...,
        BackgroundBehaviorPoint: bool = ...,
    ) -> None: ...

class LineOfInterest(LmcpObject):
    """afrl.impact.LineOfInterest: IMPACT type 20."""

    LineID: int
    """int64, default 0."""
    Line: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 1024."""
    LineAction: _impact.AreaActionOptions
    """IMPACT/AreaActionOptions, default Created."""
    LineLabel: str
    """string, default ''."""
    BackgroundBehaviorLine: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        LineID: int = ...,
        Line: Iterable[_cmasi.Location3D] = ...,
        LineAction: _impact.AreaActionOptions | str = ...,
        LineLabel: str = ...,
        BackgroundBehaviorLine: bool = ...,
    ) -> None: ...

class AreaOfInterest(LmcpObject):
    """afrl.impact.AreaOfInterest: IMPACT type 21."""

    AreaID: int
    """int64, default 0."""
    Area: _cmasi.AbstractGeometry
    """CMASI/AbstractGeometry, default a new CMASI/AbstractGeometry."""
    AreaAction: _impact.AreaActionOptions
    """IMPACT/AreaActionOptions, default Created."""
    AreaLabel: str
    """string, default ''."""
    BackgroundBehaviorArea: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        AreaID: int = ...,
        Area: _cmasi.AbstractGeometry = ...,
        AreaAction: _impact.AreaActionOptions | str = ...,
        AreaLabel: str = ...,
        BackgroundBehaviorArea: bool = ...,
    ) -> None: ...

class ImpactPointSearchTask(_cmasi.SearchTask):
    """afrl.impact.ImpactPointSearchTask: IMPACT type 22."""

    SearchLocationID: int
    """int64, default 0."""
    SearchLocation: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    StandoffDistance: float
    """real32 [meter], default 0.0."""
    ViewAngleList: list[_cmasi.Wedge]
    """CMASI/Wedge[], default empty, the model says at most 64."""
    DesiredAction: _cmasi.LoiterAction | None
    """CMASI/LoiterAction, default null, may be null."""
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
        SearchLocationID: int = ...,
        SearchLocation: _cmasi.Location3D | None = ...,
        StandoffDistance: float = ...,
        ViewAngleList: Iterable[_cmasi.Wedge] = ...,
        DesiredAction: _cmasi.LoiterAction | None = ...,
    ) -> None: ...

class PatternSearchTask(_cmasi.SearchTask):
    """afrl.impact.PatternSearchTask: IMPACT type 23."""

    SearchLocationID: int
    """int64, default 0."""
    SearchLocation: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    Pattern: _impact.AreaSearchPattern
    """IMPACT/AreaSearchPattern, default Spiral."""
    Extent: float
    """real32 [meters], default 0.0."""
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
        SearchLocationID: int = ...,
        SearchLocation: _cmasi.Location3D | None = ...,
        Pattern: _impact.AreaSearchPattern | str = ...,
        Extent: float = ...,
    ) -> None: ...

class AngledAreaSearchTask(_cmasi.SearchTask):
    """afrl.impact.AngledAreaSearchTask: IMPACT type 24."""

    SearchAreaID: int
    """int64, default 0."""
    SweepAngle: float
    """real32 [degrees], default 0.0."""
    StartPoint: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
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
        SearchAreaID: int = ...,
        SweepAngle: float = ...,
        StartPoint: _cmasi.Location3D | None = ...,
    ) -> None: ...

class ImpactLineSearchTask(_cmasi.SearchTask):
    """afrl.impact.ImpactLineSearchTask: IMPACT type 25."""

    LineID: int
    """int64, default 0."""
    ViewAngleList: list[_cmasi.Wedge]
    """CMASI/Wedge[], default empty, the model says at most 64."""
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
        LineID: int = ...,
        ViewAngleList: Iterable[_cmasi.Wedge] = ...,
        UseInertialViewAngles: bool = ...,
    ) -> None: ...

class WatchTask(_cmasi.SearchTask):
    """afrl.impact.WatchTask: IMPACT type 26."""

    WatchedEntityID: int
    """int64, default 0."""
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
        WatchedEntityID: int = ...,
    ) -> None: ...

class MultiVehicleWatchTask(_cmasi.SearchTask):
    """afrl.impact.MultiVehicleWatchTask: IMPACT type 27."""

    WatchedEntityID: int
    """int64, default 0."""
    NumberVehicles: int
    """byte, default 1."""
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
        WatchedEntityID: int = ...,
        NumberVehicles: int = ...,
    ) -> None: ...

class CommRelayTask(_cmasi.Task):
    """afrl.impact.CommRelayTask: IMPACT type 28."""

    SupportedEntityID: int
    """int64, default 0."""
    DestinationLocation: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
    TowerID: int
    """int64, default 0."""
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
        SupportedEntityID: int = ...,
        DestinationLocation: _cmasi.Location3D | None = ...,
        TowerID: int = ...,
    ) -> None: ...

class CordonTask(_cmasi.Task):
    """afrl.impact.CordonTask: IMPACT type 29."""

    CordonLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    StandoffDistance: float
    """real32 [meters], default 100.0."""
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
        CordonLocation: _cmasi.Location3D = ...,
        StandoffDistance: float = ...,
    ) -> None: ...

class BlockadeTask(_cmasi.Task):
    """afrl.impact.BlockadeTask: IMPACT type 30."""

    BlockedEntityID: int
    """int64, default 0."""
    StandoffDistance: float
    """real32 [meters], default 0.0."""
    NumberVehicles: int
    """byte, default 1."""
    ProtectedLocation: _cmasi.Location3D | None
    """CMASI/Location3D, default null, may be null."""
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
        BlockedEntityID: int = ...,
        StandoffDistance: float = ...,
        NumberVehicles: int = ...,
        ProtectedLocation: _cmasi.Location3D | None = ...,
    ) -> None: ...

class EscortTask(_cmasi.SearchTask):
    """afrl.impact.EscortTask: IMPACT type 31."""

    SupportedEntityID: int
    """int64, default 0."""
    RouteID: int
    """int64, default 0."""
    PrescribedWaypoints: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    StandoffDistance: float
    """real32 [meters], default 100.0."""
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
        SupportedEntityID: int = ...,
        RouteID: int = ...,
        PrescribedWaypoints: Iterable[_cmasi.Waypoint] = ...,
        StandoffDistance: float = ...,
    ) -> None: ...

class ConfigurationRequest(LmcpObject):
    """afrl.impact.ConfigurationRequest: IMPACT type 32."""

    VehicleID: list[int]
    """int64[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        VehicleID: Iterable[int] = ...,
    ) -> None: ...

class WaterReport(LmcpObject):
    """afrl.impact.WaterReport: IMPACT type 33."""

    Area: _cmasi.AbstractGeometry
    """CMASI/AbstractGeometry, default a new CMASI/AbstractGeometry."""
    CurrentSpeed: float
    """real32 [meters/sec], default 0.0."""
    CurrentDirection: float
    """real32 [degree], default 0.0."""
    WaveDirection: float
    """real32 [degree], default 0.0."""
    WaveHeight: float
    """real32 [meters], default 0.0."""
    def __init__(
        self,
        *,
        Area: _cmasi.AbstractGeometry = ...,
        CurrentSpeed: float = ...,
        CurrentDirection: float = ...,
        WaveDirection: float = ...,
        WaveHeight: float = ...,
    ) -> None: ...

class WaterZone(_cmasi.AbstractZone):
    """afrl.impact.WaterZone: IMPACT type 34."""
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

class PayloadDropTask(_cmasi.Task):
    """afrl.impact.PayloadDropTask: IMPACT type 35."""

    DropLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    BDALocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
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
        DropLocation: _cmasi.Location3D = ...,
        BDALocation: _cmasi.Location3D = ...,
    ) -> None: ...
