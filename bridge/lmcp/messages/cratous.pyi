"""Messages of CRATOUS, version 1. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cratous as _cratous
from cratous.bridge.lmcp.objects import LmcpEnum, LmcpObject

class Authority(LmcpEnum):
    UxAS = 0
    ICAROUS = 1

class TaskPhase(LmcpEnum):
    Planned = 0
    Transit = 1
    Waiting = 2
    Active = 3
    Suspended = 4
    Complete = 5
    Failed = 6

class Direction(LmcpEnum):
    Down = 0
    Up = 1

class HandChange(LmcpEnum):
    Offered = 0
    Refused = 1
    Known = 2
    Left = 3
    Flown = 4
    Expired = 5
    Missing = 6

class WithoutLink(LmcpEnum):
    Linked = 0
    Finish = 1
    Loiter = 2
    Return = 3
    Over = 4
    Land = 5
    Final = 6
    Landed = 7

class TakeOff(LmcpEnum):
    Standing = 0
    Rolling = 1
    Climbing = 2
    Up = 3

class MergeStage(LmcpEnum):
    Away = 0
    Asking = 1
    InSlot = 2
    Holding = 3

class DeclaredFailure(LmcpEnum):
    NotDeclared = 0
    Blocked = 1
    Expiring = 2
    Surprised = 3
    Ended = 4

class CognitionMode(LmcpEnum):
    Nominal = 0
    Deviation = 1
    ReturnToPath = 2
    NextWaypoint = 3
    Merging = 4
    LostLink = 5
    Failed = 6
    Ditch = 7
    FenceConflict = 8
    TrafficConflict = 9
    TakeOff = 10
    Land = 11
    Landed = 12

class ConflictResolution(LmcpEnum):
    NoResolution = 0
    Turn = 1
    Altitude = 2
    Speed = 3
    Combined = 4
    LeastBad = 5

class Verdict(LmcpEnum):
    Holds = 0
    Violated = 1
    Unknown = 2
    Excused = 3

class AuthorityChange(LmcpObject):
    """cratous.AuthorityChange: CRATOUS type 1."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Owner: _cratous.Authority
    """CRATOUS/Authority, default UxAS."""
    Epoch: int
    """int64, default 0."""
    Reason: str
    """string, default ''."""
    IntruderID: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Owner: _cratous.Authority | str = ...,
        Epoch: int = ...,
        Reason: str = ...,
        IntruderID: int = ...,
    ) -> None: ...

class CommandDropped(LmcpObject):
    """cratous.CommandDropped: CRATOUS type 2."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Sender: _cratous.Authority
    """CRATOUS/Authority, default UxAS."""
    Epoch: int
    """int64, default 0."""
    GateEpoch: int
    """int64, default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Sender: _cratous.Authority | str = ...,
        Epoch: int = ...,
        GateEpoch: int = ...,
        Reason: str = ...,
    ) -> None: ...

class TaskProgress(LmcpObject):
    """cratous.TaskProgress: CRATOUS type 3."""

    TaskID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Phase: _cratous.TaskPhase
    """CRATOUS/TaskPhase, default Planned."""
    Served: float
    """real64 [fraction], default 0.0."""
    Note: str
    """string, default ''."""
    def __init__(
        self,
        *,
        TaskID: int = ...,
        VehicleID: int = ...,
        Time: int = ...,
        Phase: _cratous.TaskPhase | str = ...,
        Served: float = ...,
        Note: str = ...,
    ) -> None: ...

class Heartbeat(LmcpObject):
    """cratous.Heartbeat: CRATOUS type 4."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Direction: _cratous.Direction
    """CRATOUS/Direction, default Down."""
    Sequence: int
    """int64, default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Direction: _cratous.Direction | str = ...,
        Sequence: int = ...,
    ) -> None: ...

class BridgeStatus(LmcpObject):
    """cratous.BridgeStatus: CRATOUS type 5."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Alive: bool
    """bool, default false."""
    Note: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Alive: bool = ...,
        Note: str = ...,
    ) -> None: ...

class Conflict(LmcpObject):
    """cratous.Conflict: CRATOUS type 6."""

    VehicleID: int
    """int64, default 0."""
    IntruderID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    TimeToViolation_s: float
    """real64 [seconds], default -1.0."""
    Resolution: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        IntruderID: int = ...,
        Time: int = ...,
        TimeToViolation_s: float = ...,
        Resolution: str = ...,
    ) -> None: ...

class PlanAccepted(LmcpObject):
    """cratous.PlanAccepted: CRATOUS type 7."""

    Time: int
    """int64 [milliseconds], default 0."""
    Makespan: int
    """int64 [milliseconds], default 0."""
    PlanHash: str
    """string, default ''."""
    Tasks: list[int]
    """int64[], default empty."""
    def __init__(
        self,
        *,
        Time: int = ...,
        Makespan: int = ...,
        PlanHash: str = ...,
        Tasks: Iterable[int] = ...,
    ) -> None: ...

class TruthState(LmcpObject):
    """cratous.TruthState: CRATOUS type 8."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    North: float
    """real64 [meters], default 0.0."""
    East: float
    """real64 [meters], default 0.0."""
    Altitude: float
    """real64 [meters], default 0.0."""
    VelocityNorth: float
    """real64 [meters/second], default 0.0."""
    VelocityEast: float
    """real64 [meters/second], default 0.0."""
    VelocityDown: float
    """real64 [meters/second], default 0.0."""
    Heading: float
    """real64 [degrees], default 0.0."""
    Cooperative: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        North: float = ...,
        East: float = ...,
        Altitude: float = ...,
        VelocityNorth: float = ...,
        VelocityEast: float = ...,
        VelocityDown: float = ...,
        Heading: float = ...,
        Cooperative: bool = ...,
    ) -> None: ...

class SafetyVerdict(LmcpObject):
    """cratous.SafetyVerdict: CRATOUS type 9."""

    Requirement: str
    """string, default ''."""
    Verdict: _cratous.Verdict
    """CRATOUS/Verdict, default Holds."""
    Time: int
    """int64 [milliseconds], default 0."""
    Vehicles: list[int]
    """int64[], default empty."""
    Margin: float
    """real64, default 0.0."""
    Unit: str
    """string, default ''."""
    Note: str
    """string, default ''."""
    def __init__(
        self,
        *,
        Requirement: str = ...,
        Verdict: _cratous.Verdict | str = ...,
        Time: int = ...,
        Vehicles: Iterable[int] = ...,
        Margin: float = ...,
        Unit: str = ...,
        Note: str = ...,
    ) -> None: ...

class MissionEnd(LmcpObject):
    """cratous.MissionEnd: CRATOUS type 10."""

    Time: int
    """int64 [milliseconds], default 0."""
    Outcome: str
    """string, default ''."""
    def __init__(
        self,
        *,
        Time: int = ...,
        Outcome: str = ...,
    ) -> None: ...

class GatedCommand(LmcpObject):
    """cratous.GatedCommand: CRATOUS type 11."""

    VehicleID: int
    """int64, default 0."""
    Epoch: int
    """int64, default 0."""
    Sender: _cratous.Authority
    """CRATOUS/Authority, default UxAS."""
    Command: LmcpObject | None
    """LmcpObject, default null, may be null."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Epoch: int = ...,
        Sender: _cratous.Authority | str = ...,
        Command: LmcpObject | None = ...,
    ) -> None: ...

class GateState(LmcpObject):
    """cratous.GateState: CRATOUS type 12."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Owner: _cratous.Authority
    """CRATOUS/Authority, default UxAS."""
    Epoch: int
    """int64, default 0."""
    Offered: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Owner: _cratous.Authority | str = ...,
        Epoch: int = ...,
        Offered: bool = ...,
    ) -> None: ...

class MissionChange(LmcpObject):
    """cratous.MissionChange: CRATOUS type 13."""

    Time: int
    """int64 [milliseconds], default 0."""
    What: str
    """string, default ''."""
    Consequence: str
    """string, default ''."""
    def __init__(
        self,
        *,
        Time: int = ...,
        What: str = ...,
        Consequence: str = ...,
    ) -> None: ...

class ModeRefused(LmcpObject):
    """cratous.ModeRefused: CRATOUS type 14."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Owner: _cratous.Authority
    """CRATOUS/Authority, default UxAS."""
    Epoch: int
    """int64, default 0."""
    GateEpoch: int
    """int64, default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Owner: _cratous.Authority | str = ...,
        Epoch: int = ...,
        GateEpoch: int = ...,
        Reason: str = ...,
    ) -> None: ...

class OwnRoutePlanner(LmcpObject):
    """cratous.OwnRoutePlanner: CRATOUS type 15."""

    Plans: bool
    """bool, default false."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        Plans: bool = ...,
        Reason: str = ...,
    ) -> None: ...

class SensedState(LmcpObject):
    """cratous.SensedState: CRATOUS type 16."""

    ObserverID: int
    """int64, default 0."""
    TrackID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    North: float
    """real64 [meters], default 0.0."""
    East: float
    """real64 [meters], default 0.0."""
    Altitude: float
    """real64 [meters], default 0.0."""
    VelocityNorth: float
    """real64 [meters/second], default 0.0."""
    VelocityEast: float
    """real64 [meters/second], default 0.0."""
    VelocityDown: float
    """real64 [meters/second], default 0.0."""
    HorizontalBound: float
    """real64 [meters], default 0.0."""
    VerticalBound: float
    """real64 [meters], default 0.0."""
    HorizontalRateBound: float
    """real64 [meters/second], default 0.0."""
    VerticalRateBound: float
    """real64 [meters/second], default 0.0."""
    def __init__(
        self,
        *,
        ObserverID: int = ...,
        TrackID: int = ...,
        VehicleID: int = ...,
        Time: int = ...,
        North: float = ...,
        East: float = ...,
        Altitude: float = ...,
        VelocityNorth: float = ...,
        VelocityEast: float = ...,
        VelocityDown: float = ...,
        HorizontalBound: float = ...,
        VerticalBound: float = ...,
        HorizontalRateBound: float = ...,
        VerticalRateBound: float = ...,
    ) -> None: ...

class HandState(LmcpObject):
    """cratous.HandState: CRATOUS type 17."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Change: _cratous.HandChange
    """CRATOUS/HandChange, default Offered."""
    Base: int
    """int64, default 0."""
    BaseExpiry: int
    """int64 [milliseconds], default 0."""
    ID: int
    """int64, default 0."""
    Sigma: int
    """int64 [milliseconds], default 0."""
    Knowledge: int
    """int64, default 0."""
    Expiry: int
    """int64 [milliseconds], default 0."""
    Surprises: int
    """int64, default 0."""
    Permitted: bool
    """bool, default false."""
    IntruderID: int
    """int64, default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Change: _cratous.HandChange | str = ...,
        Base: int = ...,
        BaseExpiry: int = ...,
        ID: int = ...,
        Sigma: int = ...,
        Knowledge: int = ...,
        Expiry: int = ...,
        Surprises: int = ...,
        Permitted: bool = ...,
        IntruderID: int = ...,
        Reason: str = ...,
    ) -> None: ...

class LinkLossState(LmcpObject):
    """cratous.LinkLossState: CRATOUS type 18."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Mode: _cratous.WithoutLink
    """CRATOUS/WithoutLink, default Linked."""
    Chosen: _cratous.WithoutLink
    """CRATOUS/WithoutLink, default Linked."""
    Heard: int
    """int64 [milliseconds], default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Mode: _cratous.WithoutLink | str = ...,
        Chosen: _cratous.WithoutLink | str = ...,
        Heard: int = ...,
        Reason: str = ...,
    ) -> None: ...

class TakeOffState(LmcpObject):
    """cratous.TakeOffState: CRATOUS type 19."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Mode: _cratous.TakeOff
    """CRATOUS/TakeOff, default Standing."""
    Heard: int
    """int64 [milliseconds], default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Mode: _cratous.TakeOff | str = ...,
        Heard: int = ...,
        Reason: str = ...,
    ) -> None: ...

class UxasHeard(LmcpObject):
    """cratous.UxasHeard: CRATOUS type 20."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Heard: bool
    """bool, default false."""
    Last: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Heard: bool = ...,
        Last: int = ...,
    ) -> None: ...

class MergeState(LmcpObject):
    """cratous.MergeState: CRATOUS type 21."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Stage: _cratous.MergeStage
    """CRATOUS/MergeStage, default Away."""
    Term: int
    """int64, default 0."""
    Leader: int
    """int64, default 0."""
    Request: int
    """int64, default 0."""
    Slot: int
    """int64 [milliseconds], default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Stage: _cratous.MergeStage | str = ...,
        Term: int = ...,
        Leader: int = ...,
        Request: int = ...,
        Slot: int = ...,
        Reason: str = ...,
    ) -> None: ...

class FailureState(LmcpObject):
    """cratous.FailureState: CRATOUS type 22."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Failure: _cratous.DeclaredFailure
    """CRATOUS/DeclaredFailure, default NotDeclared."""
    IntruderID: int
    """int64, default 0."""
    Reason: str
    """string, default ''."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Failure: _cratous.DeclaredFailure | str = ...,
        IntruderID: int = ...,
        Reason: str = ...,
    ) -> None: ...

class FailureCheck(LmcpObject):
    """cratous.FailureCheck: CRATOUS type 23."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    OnGround: bool
    """bool, default false."""
    Stopped: bool
    """bool, default false."""
    Flies: bool
    """bool, default false."""
    Without: bool
    """bool, default false."""
    Since: int
    """int64 [milliseconds], default 0."""
    Surprised: bool
    """bool, default false."""
    Expiry: int
    """int64 [milliseconds], default 0."""
    Failure: _cratous.DeclaredFailure
    """CRATOUS/DeclaredFailure, default NotDeclared."""
    DueBy: int
    """int64 [milliseconds], default 0."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        OnGround: bool = ...,
        Stopped: bool = ...,
        Flies: bool = ...,
        Without: bool = ...,
        Since: int = ...,
        Surprised: bool = ...,
        Expiry: int = ...,
        Failure: _cratous.DeclaredFailure | str = ...,
        DueBy: int = ...,
    ) -> None: ...

class CognitionState(LmcpObject):
    """cratous.CognitionState: CRATOUS type 24."""

    VehicleID: int
    """int64, default 0."""
    Time: int
    """int64 [milliseconds], default 0."""
    Mode: _cratous.CognitionMode
    """CRATOUS/CognitionMode, default Nominal."""
    Resolution: _cratous.ConflictResolution
    """CRATOUS/ConflictResolution, default NoResolution."""
    IntruderID: int
    """int64, default 0."""
    Skipped: int
    """int64, default 0."""
    Landed: bool
    """bool, default false."""
    Descends: bool
    """bool, default false."""
    Departs: bool
    """bool, default false."""
    Traffic: bool
    """bool, default false."""
    Fence: bool
    """bool, default false."""
    Lands: bool
    """bool, default false."""
    Failed: bool
    """bool, default false."""
    Alone: bool
    """bool, default false."""
    Merges: bool
    """bool, default false."""
    Has: bool
    """bool, default false."""
    Skips: bool
    """bool, default false."""
    Deviates: bool
    """bool, default false."""
    def __init__(
        self,
        *,
        VehicleID: int = ...,
        Time: int = ...,
        Mode: _cratous.CognitionMode | str = ...,
        Resolution: _cratous.ConflictResolution | str = ...,
        IntruderID: int = ...,
        Skipped: int = ...,
        Landed: bool = ...,
        Descends: bool = ...,
        Departs: bool = ...,
        Traffic: bool = ...,
        Fence: bool = ...,
        Lands: bool = ...,
        Failed: bool = ...,
        Alone: bool = ...,
        Merges: bool = ...,
        Has: bool = ...,
        Skips: bool = ...,
        Deviates: bool = ...,
    ) -> None: ...
