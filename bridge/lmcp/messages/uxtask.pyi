"""Messages of UXTASK, version 8. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.messages import uxtask as _uxtask
from cratous.bridge.lmcp.objects import LmcpObject

class AssignmentCoordinatorTask(_cmasi.Task):
    """uxas.messages.task.AssignmentCoordinatorTask: UXTASK type 1."""
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

class RendezvousTask(_cmasi.Task):
    """uxas.messages.task.RendezvousTask: UXTASK type 2."""

    NumberOfParticipants: int
    """byte, default 0."""
    RendezvousStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
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
        NumberOfParticipants: int = ...,
        RendezvousStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class PlanningState(LmcpObject):
    """uxas.messages.task.PlanningState: UXTASK type 3."""

    EntityID: int
    """int64, default 0."""
    PlanningPosition: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    PlanningHeading: float
    """real32, default 0.0."""
    def __init__(
        self,
        *,
        EntityID: int = ...,
        PlanningPosition: _cmasi.Location3D = ...,
        PlanningHeading: float = ...,
    ) -> None: ...

class AssignmentCoordination(LmcpObject):
    """uxas.messages.task.AssignmentCoordination: UXTASK type 4."""

    CoordinatedAutomationRequestID: int
    """int64, default 0."""
    PlanningState: _uxtask.PlanningState
    """UXTASK/PlanningState, default a new UXTASK/PlanningState."""
    def __init__(
        self,
        *,
        CoordinatedAutomationRequestID: int = ...,
        PlanningState: _uxtask.PlanningState = ...,
    ) -> None: ...

class CoordinatedAutomationRequest(LmcpObject):
    """uxas.messages.task.CoordinatedAutomationRequest: UXTASK type 5."""

    RequestID: int
    """int64, default 0."""
    MaximumResponseTime: int
    """int64 [milliseconds], default -1."""
    OriginalRequest: _cmasi.AutomationRequest
    """CMASI/AutomationRequest, default a new CMASI/AutomationRequest."""
    PlanningStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        MaximumResponseTime: int = ...,
        OriginalRequest: _cmasi.AutomationRequest = ...,
        PlanningStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class TaskAutomationRequest(LmcpObject):
    """uxas.messages.task.TaskAutomationRequest: UXTASK type 6."""

    RequestID: int
    """int64, default 0."""
    OriginalRequest: _cmasi.AutomationRequest
    """CMASI/AutomationRequest, default a new CMASI/AutomationRequest."""
    SandBoxRequest: bool
    """bool, default false."""
    PlanningStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        OriginalRequest: _cmasi.AutomationRequest = ...,
        SandBoxRequest: bool = ...,
        PlanningStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class TaskAutomationResponse(LmcpObject):
    """uxas.messages.task.TaskAutomationResponse: UXTASK type 7."""

    ResponseID: int
    """int64, default 0."""
    OriginalResponse: _cmasi.AutomationResponse
    """CMASI/AutomationResponse, default a new CMASI/AutomationResponse."""
    FinalStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        OriginalResponse: _cmasi.AutomationResponse = ...,
        FinalStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class UniqueAutomationRequest(LmcpObject):
    """uxas.messages.task.UniqueAutomationRequest: UXTASK type 8."""

    RequestID: int
    """int64, default 0."""
    OriginalRequest: _cmasi.AutomationRequest
    """CMASI/AutomationRequest, default a new CMASI/AutomationRequest."""
    SandBoxRequest: bool
    """bool, default false."""
    PlanningStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        OriginalRequest: _cmasi.AutomationRequest = ...,
        SandBoxRequest: bool = ...,
        PlanningStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class UniqueAutomationResponse(LmcpObject):
    """uxas.messages.task.UniqueAutomationResponse: UXTASK type 9."""

    ResponseID: int
    """int64, default 0."""
    OriginalResponse: _cmasi.AutomationResponse
    """CMASI/AutomationResponse, default a new CMASI/AutomationResponse."""
    FinalStates: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        OriginalResponse: _cmasi.AutomationResponse = ...,
        FinalStates: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class SensorFootprintRequests(LmcpObject):
    """uxas.messages.task.SensorFootprintRequests: UXTASK type 10."""

    RequestID: int
    """int64, default 0."""
    Footprints: list[_uxtask.FootprintRequest]
    """UXTASK/FootprintRequest[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        Footprints: Iterable[_uxtask.FootprintRequest] = ...,
    ) -> None: ...

class FootprintRequest(LmcpObject):
    """uxas.messages.task.FootprintRequest: UXTASK type 11."""

    FootprintRequestID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    EligibleWavelengths: list[_cmasi.WavelengthBand]
    """CMASI/WavelengthBand[], default empty, the model says at most 8."""
    GroundSampleDistances: list[float]
    """real32[], default empty, the model says at most 8."""
    AglAltitudes: list[float]
    """real32[] [meters], default empty, the model says at most 8."""
    ElevationAngles: list[float]
    """real32[] [deg], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        FootprintRequestID: int = ...,
        VehicleID: int = ...,
        EligibleWavelengths: Iterable[_cmasi.WavelengthBand | str] = ...,
        GroundSampleDistances: Iterable[float] = ...,
        AglAltitudes: Iterable[float] = ...,
        ElevationAngles: Iterable[float] = ...,
    ) -> None: ...

class SensorFootprint(LmcpObject):
    """uxas.messages.task.SensorFootprint: UXTASK type 12."""

    FootprintResponseID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    CameraID: int
    """int64, default 0."""
    GimbalID: int
    """int64, default 0."""
    HorizontalFOV: float
    """real32 [degrees], default 0.0."""
    AglAltitude: float
    """real32 [meters], default 0.0."""
    GimbalElevation: float
    """real32 [degrees], default 0.0."""
    AspectRatio: float
    """real32, default 0.0."""
    AchievedGSD: float
    """real32 [meters/pixel], default 0.0."""
    CameraWavelength: _cmasi.WavelengthBand
    """CMASI/WavelengthBand, default AllAny."""
    HorizontalToLeadingEdge: float
    """real32 [meters], default 0.0."""
    HorizontalToTrailingEdge: float
    """real32 [meters], default 0.0."""
    HorizontalToCenter: float
    """real32 [meters], default 0.0."""
    WidthCenter: float
    """real32 [meters], default 0.0."""
    SlantRangeToCenter: float
    """real32 [meters], default 0.0."""
    def __init__(
        self,
        *,
        FootprintResponseID: int = ...,
        VehicleID: int = ...,
        CameraID: int = ...,
        GimbalID: int = ...,
        HorizontalFOV: float = ...,
        AglAltitude: float = ...,
        GimbalElevation: float = ...,
        AspectRatio: float = ...,
        AchievedGSD: float = ...,
        CameraWavelength: _cmasi.WavelengthBand | str = ...,
        HorizontalToLeadingEdge: float = ...,
        HorizontalToTrailingEdge: float = ...,
        HorizontalToCenter: float = ...,
        WidthCenter: float = ...,
        SlantRangeToCenter: float = ...,
    ) -> None: ...

class SensorFootprintResponse(LmcpObject):
    """uxas.messages.task.SensorFootprintResponse: UXTASK type 13."""

    ResponseID: int
    """int64, default 0."""
    Footprints: list[_uxtask.SensorFootprint]
    """UXTASK/SensorFootprint[], default empty, the model says at most 65535."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        Footprints: Iterable[_uxtask.SensorFootprint] = ...,
    ) -> None: ...

class TaskImplementationRequest(LmcpObject):
    """uxas.messages.task.TaskImplementationRequest: UXTASK type 14."""

    RequestID: int
    """int64, default 0."""
    CorrespondingAutomationRequestID: int
    """int64, default 0."""
    StartingWaypointID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    StartPosition: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    StartHeading: float
    """real32 [degrees], default 0.0."""
    StartTime: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    RegionID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    OptionID: int
    """int64, default 0."""
    TimeThreshold: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    NeighborLocations: list[_uxtask.PlanningState]
    """UXTASK/PlanningState[], default empty, the model says at most 65535."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        CorrespondingAutomationRequestID: int = ...,
        StartingWaypointID: int = ...,
        VehicleID: int = ...,
        StartPosition: _cmasi.Location3D = ...,
        StartHeading: float = ...,
        StartTime: int = ...,
        RegionID: int = ...,
        TaskID: int = ...,
        OptionID: int = ...,
        TimeThreshold: int = ...,
        NeighborLocations: Iterable[_uxtask.PlanningState] = ...,
    ) -> None: ...

class TaskImplementationResponse(LmcpObject):
    """uxas.messages.task.TaskImplementationResponse: UXTASK type 15."""

    ResponseID: int
    """int64, default 0."""
    CorrespondingAutomationRequestID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    OptionID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    TaskWaypoints: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    FinalLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    FinalHeading: float
    """real32 [degrees], default 0.0."""
    FinalTime: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        CorrespondingAutomationRequestID: int = ...,
        TaskID: int = ...,
        OptionID: int = ...,
        VehicleID: int = ...,
        TaskWaypoints: Iterable[_cmasi.Waypoint] = ...,
        FinalLocation: _cmasi.Location3D = ...,
        FinalHeading: float = ...,
        FinalTime: int = ...,
    ) -> None: ...

class AssignmentCostMatrix(LmcpObject):
    """uxas.messages.task.AssignmentCostMatrix: UXTASK type 16."""

    CorrespondingAutomationRequestID: int
    """int64, default 0."""
    TaskLevelRelationship: str
    """string, default ''."""
    TaskList: list[int]
    """int64[], default empty, the model says at most 16."""
    OperatingRegion: int
    """int64, default 0."""
    CostMatrix: list[_uxtask.TaskOptionCost]
    """UXTASK/TaskOptionCost[], default empty, the model says at most 18432."""
    def __init__(
        self,
        *,
        CorrespondingAutomationRequestID: int = ...,
        TaskLevelRelationship: str = ...,
        TaskList: Iterable[int] = ...,
        OperatingRegion: int = ...,
        CostMatrix: Iterable[_uxtask.TaskOptionCost] = ...,
    ) -> None: ...

class TaskOptionCost(LmcpObject):
    """uxas.messages.task.TaskOptionCost: UXTASK type 17."""

    VehicleID: int
    """int64, default 0."""
    IntialTaskID: int
    """int64, default 0."""
    IntialTaskOption: int
    """int64, default 0."""
    DestinationTaskID: int
    """int64, default 0."""
    DestinationTaskOption: int
    """int64, default 0."""
    TimeToGo: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        IntialTaskID: int = ...,
        IntialTaskOption: int = ...,
        DestinationTaskID: int = ...,
        DestinationTaskOption: int = ...,
        TimeToGo: int = ...,
    ) -> None: ...

class TaskAssignment(LmcpObject):
    """uxas.messages.task.TaskAssignment: UXTASK type 18."""

    TaskID: int
    """int64, default 0."""
    OptionID: int
    """int64, default 0."""
    AssignedVehicle: int
    """int64, default 0."""
    TimeThreshold: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    TimeTaskCompleted: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        OptionID: int = ...,
        AssignedVehicle: int = ...,
        TimeThreshold: int = ...,
        TimeTaskCompleted: int = ...,
    ) -> None: ...

class TaskAssignmentSummary(LmcpObject):
    """uxas.messages.task.TaskAssignmentSummary: UXTASK type 19."""

    CorrespondingAutomationRequestID: int
    """int64, default 0."""
    OperatingRegion: int
    """int64, default 0."""
    TaskList: list[_uxtask.TaskAssignment]
    """UXTASK/TaskAssignment[], default empty, the model says at most 256."""
    def __init__(
        self,
        *,
        CorrespondingAutomationRequestID: int = ...,
        OperatingRegion: int = ...,
        TaskList: Iterable[_uxtask.TaskAssignment] = ...,
    ) -> None: ...

class TaskOption(LmcpObject):
    """uxas.messages.task.TaskOption: UXTASK type 20."""

    TaskID: int
    """int64, default 0."""
    OptionID: int
    """int64, default 0."""
    EligibleEntities: list[int]
    """int64[], default empty, the model says at most 16."""
    Cost: int
    """int64 [milliseconds], default 0."""
    StartLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    StartHeading: float
    """real32 [degrees], default 0.0."""
    EndLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    EndHeading: float
    """real32 [degrees], default 0.0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        OptionID: int = ...,
        EligibleEntities: Iterable[int] = ...,
        Cost: int = ...,
        StartLocation: _cmasi.Location3D = ...,
        StartHeading: float = ...,
        EndLocation: _cmasi.Location3D = ...,
        EndHeading: float = ...,
    ) -> None: ...

class TaskPlanOptions(LmcpObject):
    """uxas.messages.task.TaskPlanOptions: UXTASK type 21."""

    CorrespondingAutomationRequestID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    Composition: str
    """string, default ''."""
    Options: list[_uxtask.TaskOption]
    """UXTASK/TaskOption[], default empty, the model says at most 64."""
    def __init__(
        self,
        *,
        CorrespondingAutomationRequestID: int = ...,
        TaskID: int = ...,
        Composition: str = ...,
        Options: Iterable[_uxtask.TaskOption] = ...,
    ) -> None: ...

class TaskPause(LmcpObject):
    """uxas.messages.task.TaskPause: UXTASK type 22."""

    TaskID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
    ) -> None: ...

class TaskResume(LmcpObject):
    """uxas.messages.task.TaskResume: UXTASK type 23."""

    TaskID: int
    """int64, default 0."""
    RestartCompletely: bool
    """bool, default false."""
    ReAssign: _uxtask.TaskAssignment | None
    """UXTASK/TaskAssignment, default null, may be null."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        RestartCompletely: bool = ...,
        ReAssign: _uxtask.TaskAssignment | None = ...,
    ) -> None: ...

class TaskProgress(LmcpObject):
    """uxas.messages.task.TaskProgress: UXTASK type 24."""

    ResponseID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    PercentComplete: float
    """real32, default 0.0."""
    EntitiesEngaged: list[int]
    """int64[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        TaskID: int = ...,
        PercentComplete: float = ...,
        EntitiesEngaged: Iterable[int] = ...,
    ) -> None: ...

class TaskProgressRequest(LmcpObject):
    """uxas.messages.task.TaskProgressRequest: UXTASK type 25."""

    RequestID: int
    """int64, default 0."""
    TaskID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        TaskID: int = ...,
    ) -> None: ...

class TaskInitialized(LmcpObject):
    """uxas.messages.task.TaskInitialized: UXTASK type 26."""

    TaskID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
    ) -> None: ...

class TaskActive(LmcpObject):
    """uxas.messages.task.TaskActive: UXTASK type 27."""

    TaskID: int
    """int64, default 0."""
    EntityID: int
    """int64, default 0."""
    TimeTaskActivated: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        EntityID: int = ...,
        TimeTaskActivated: int = ...,
    ) -> None: ...

class TaskComplete(LmcpObject):
    """uxas.messages.task.TaskComplete: UXTASK type 28."""

    TaskID: int
    """int64, default 0."""
    EntitiesInvolved: list[int]
    """int64[], default empty, the model says at most 16."""
    TimeTaskCompleted: int
    """int64 [milliseconds since 1 Jan 1970], default 0."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        EntitiesInvolved: Iterable[int] = ...,
        TimeTaskCompleted: int = ...,
    ) -> None: ...

class CancelTask(LmcpObject):
    """uxas.messages.task.CancelTask: UXTASK type 29."""

    Vehicles: list[int]
    """int64[], default empty, the model says at most 16."""
    CanceledTasks: list[int]
    """int64[], default empty, the model says at most 16."""
    def __init__(
        self,
        *,
        Vehicles: Iterable[int] = ...,
        CanceledTasks: Iterable[int] = ...,
    ) -> None: ...
