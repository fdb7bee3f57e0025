"""Messages of DAIDALUS, version 1. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import daidalus as _daidalus
from cratous.bridge.lmcp.objects import LmcpEnum, LmcpObject

class BandsRegion(LmcpEnum):
    NEAR = 3
    MID = 4
    FAR = 5

class GroundHeadingInterval(LmcpObject):
    """larcfm.DAIDALUS.GroundHeadingInterval: DAIDALUS type 1."""

    GroundHeadings: list[float]
    """real64[2] [degrees], default all zero."""
    def __init__(
        self,
        *,
        GroundHeadings: Iterable[float] = ...,
    ) -> None: ...

class GroundSpeedInterval(LmcpObject):
    """larcfm.DAIDALUS.GroundSpeedInterval: DAIDALUS type 2."""

    GroundSpeeds: list[float]
    """real64[2] [meters/second], default all zero."""
    def __init__(
        self,
        *,
        GroundSpeeds: Iterable[float] = ...,
    ) -> None: ...

class VerticalSpeedInterval(LmcpObject):
    """larcfm.DAIDALUS.VerticalSpeedInterval: DAIDALUS type 3."""

    VerticalSpeeds: list[float]
    """real64[2] [meters/second], default all zero."""
    def __init__(
        self,
        *,
        VerticalSpeeds: Iterable[float] = ...,
    ) -> None: ...

class AltitudeInterval(LmcpObject):
    """larcfm.DAIDALUS.AltitudeInterval: DAIDALUS type 4."""

    Altitude: list[float]
    """real64[2] [meters], default all zero."""
    def __init__(
        self,
        *,
        Altitude: Iterable[float] = ...,
    ) -> None: ...

class GroundHeadingRecoveryInterval(LmcpObject):
    """larcfm.DAIDALUS.GroundHeadingRecoveryInterval: DAIDALUS type 5."""

    RecoveryGroundHeadings: list[float]
    """real64[2] [degrees], default all zero."""
    def __init__(
        self,
        *,
        RecoveryGroundHeadings: Iterable[float] = ...,
    ) -> None: ...

class GroundSpeedRecoveryInterval(LmcpObject):
    """larcfm.DAIDALUS.GroundSpeedRecoveryInterval: DAIDALUS type 6."""

    RecoveryGroundSpeeds: list[float]
    """real64[2] [meters/second], default all zero."""
    def __init__(
        self,
        *,
        RecoveryGroundSpeeds: Iterable[float] = ...,
    ) -> None: ...

class VerticalSpeedRecoveryInterval(LmcpObject):
    """larcfm.DAIDALUS.VerticalSpeedRecoveryInterval: DAIDALUS type 7."""

    RecoveryVerticalSpeed: list[float]
    """real64[2] [meters/second], default all zero."""
    def __init__(
        self,
        *,
        RecoveryVerticalSpeed: Iterable[float] = ...,
    ) -> None: ...

class AltitudeRecoveryInterval(LmcpObject):
    """larcfm.DAIDALUS.AltitudeRecoveryInterval: DAIDALUS type 8."""

    RecoveryAltitude: list[float]
    """real64[2] [meters], default all zero."""
    def __init__(
        self,
        *,
        RecoveryAltitude: Iterable[float] = ...,
    ) -> None: ...

class WellClearViolationIntervals(LmcpObject):
    """larcfm.DAIDALUS.WellClearViolationIntervals: DAIDALUS type 9."""

    EntityList: list[int]
    """int64[], default empty."""
    TimeToViolationList: list[float]
    """real64[] [seconds], default empty."""
    AlertLevelList: list[float]
    """real64[], default empty."""
    EntityId: int
    """uint32, default 0."""
    CurrentHeading: float
    """real64 [degrees], default 0.0."""
    CurrentGoundSpeed: float
    """real64 [m/s], default 0.0."""
    CurrentVerticalSpeed: float
    """real64 [m/s], default 0.0."""
    CurrentAltitude: float
    """real64 [m], default 0.0."""
    CurrentLatitude: float
    """real64 [degrees], default 0.0."""
    CurrentLongitude: float
    """real64 [degrees], default 0.0."""
    CurrentTime: float
    """real64 [seconds], default 0.0."""
    WCVGroundHeadingIntervals: list[_daidalus.GroundHeadingInterval]
    """DAIDALUS/GroundHeadingInterval[], default empty."""
    WCVGroundHeadingRegions: list[_daidalus.BandsRegion]
    """DAIDALUS/BandsRegion[], default empty."""
    WCVGroundSpeedIntervals: list[_daidalus.GroundSpeedInterval]
    """DAIDALUS/GroundSpeedInterval[], default empty."""
    WCVGroundSpeedRegions: list[_daidalus.BandsRegion]
    """DAIDALUS/BandsRegion[], default empty."""
    WCVVerticalSpeedIntervals: list[_daidalus.VerticalSpeedInterval]
    """DAIDALUS/VerticalSpeedInterval[], default empty."""
    WCVVerticalSpeedRegions: list[_daidalus.BandsRegion]
    """DAIDALUS/BandsRegion[], default empty."""
    WCVAlitudeIntervals: list[_daidalus.AltitudeInterval]
    """DAIDALUS/AltitudeInterval[], default empty."""
    WCVAltitudeRegions: list[_daidalus.BandsRegion]
    """DAIDALUS/BandsRegion[], default empty."""
    RecoveryGroundHeadingIntervals: list[_daidalus.GroundHeadingRecoveryInterval]
    """DAIDALUS/GroundHeadingRecoveryInterval[], default empty."""
    RecoveryGroundSpeedIntervals: list[_daidalus.GroundSpeedRecoveryInterval]
    """DAIDALUS/GroundSpeedRecoveryInterval[], default empty."""
    RecoveryVerticalSpeedIntervals: list[_daidalus.VerticalSpeedRecoveryInterval]
    """DAIDALUS/VerticalSpeedRecoveryInterval[], default empty."""
    RecoveryAltitudeIntervals: list[_daidalus.AltitudeRecoveryInterval]
    """DAIDALUS/AltitudeRecoveryInterval[], default empty."""
    def __init__(
        self,
        *,
        EntityList: Iterable[int] = ...,
        TimeToViolationList: Iterable[float] = ...,
        AlertLevelList: Iterable[float] = ...,
        EntityId: int = ...,
        CurrentHeading: float = ...,
        CurrentGoundSpeed: float = ...,
        CurrentVerticalSpeed: float = ...,
        CurrentAltitude: float = ...,
        CurrentLatitude: float = ...,
        CurrentLongitude: float = ...,
        CurrentTime: float = ...,
        WCVGroundHeadingIntervals: Iterable[_daidalus.GroundHeadingInterval] = ...,
        WCVGroundHeadingRegions: Iterable[_daidalus.BandsRegion | str] = ...,
        WCVGroundSpeedIntervals: Iterable[_daidalus.GroundSpeedInterval] = ...,
        WCVGroundSpeedRegions: Iterable[_daidalus.BandsRegion | str] = ...,
        WCVVerticalSpeedIntervals: Iterable[_daidalus.VerticalSpeedInterval] = ...,
        WCVVerticalSpeedRegions: Iterable[_daidalus.BandsRegion | str] = ...,
        WCVAlitudeIntervals: Iterable[_daidalus.AltitudeInterval] = ...,
        WCVAltitudeRegions: Iterable[_daidalus.BandsRegion | str] = ...,
        RecoveryGroundHeadingIntervals: Iterable[_daidalus.GroundHeadingRecoveryInterval] = ...,
        RecoveryGroundSpeedIntervals: Iterable[_daidalus.GroundSpeedRecoveryInterval] = ...,
        RecoveryVerticalSpeedIntervals: Iterable[_daidalus.VerticalSpeedRecoveryInterval] = ...,
        RecoveryAltitudeIntervals: Iterable[_daidalus.AltitudeRecoveryInterval] = ...,
    ) -> None: ...

class DAIDALUSConfiguration(LmcpObject):
    """larcfm.DAIDALUS.DAIDALUSConfiguration: DAIDALUS type 10."""

    EntityId: int
    """uint32, default 0."""
    LookAheadTime: float
    """real64 [seconds], default 0.0."""
    LeftTrack: float
    """real64 [degrees], default 0.0."""
    RightTrack: float
    """real64 [degrees], default 0.0."""
    MaxGroundSpeed: float
    """real64 [meters per second], default 0.0."""
    MinGroundSpeed: float
    """real64 [meters per second], default 0.0."""
    MaxVerticalSpeed: float
    """real64 [meters per second], default 0.0."""
    MinVerticalSpeed: float
    """real64 [meters per second], default 0.0."""
    MaxAltitude: float
    """real64 [meters], default 0.0."""
    MinAltitude: float
    """real64 [meters], default 0.0."""
    TrackStep: float
    """real64 [degrees], default 0.0."""
    GroundSpeedStep: float
    """real64 [meters per second], default 0.0."""
    VerticalSpeedStep: float
    """real64 [meters per second], default 0.0."""
    AltitudeStep: float
    """real64 [meters], default 0.0."""
    HorizontalAcceleration: float
    """real64 [meters per second per second], default 0.0."""
    VerticalAcceleration: float
    """real64 [G], default 0.0."""
    TurnRate: float
    """real64 [degrees per second], default 0.0."""
    BankAngle: float
    """real64 [degrees], default 0.0."""
    VerticalRate: float
    """real64 [meters per second], default 0.0."""
    RecoveryStabilityTime: float
    """real64 [seconds], default 0.0."""
    isRecoveryTrackBands: bool
    """bool, default false."""
    isRecoveryGroundSpeedBands: bool
    """bool, default false."""
    isRecoveryVerticalSpeedBands: bool
    """bool, default false."""
    isRecoveryAltitudeBands: bool
    """bool, default false."""
    isCollisionAvoidanceBands: bool
    """bool, default false."""
    CollisionAvoidanceBandsFactor: bool
    """bool, default false."""
    HorizontalNMAC: float
    """real64 [meters], default 0.0."""
    MinHorizontalRecovery: float
    """real64 [meters], default 0.0."""
    VerticalNMAC: float
    """real64 [meters], default 0.0."""
    MinVerticalRecovery: float
    """real64 [meters], default 0.0."""
    HorizontalContourThreshold: float
    """real64 [meters], default 0.0."""
    DTHR: float
    """real64 [meters], default 0.0."""
    ZTHR: float
    """real64 [meters], default 0.0."""
    TTHR: float
    """real64 [seconds], default 0.0."""
    RTCAAlertLevels: int
    """uint16, default 0."""
    AlertTime1: float
    """real64 [seconds], default 0.0."""
    EarlyAlertTime1: float
    """real64 [seconds], default 0.0."""
    AlertTime2: float
    """real64 [seconds], default 0.0."""
    EarlyAlertTime2: float
    """real64 [seconds], default 0.0."""
    AlertTime3: float
    """real64 [seconds], default 0.0."""
    EarlyAlertTime3: float
    """real64 [seconds], default 0.0."""
    HorizontalDetectionType: str
    """string, default ''."""
    def __init__(
        self,
        *,
        EntityId: int = ...,
        LookAheadTime: float = ...,
        LeftTrack: float = ...,
        RightTrack: float = ...,
        MaxGroundSpeed: float = ...,
        MinGroundSpeed: float = ...,
        MaxVerticalSpeed: float = ...,
        MinVerticalSpeed: float = ...,
        MaxAltitude: float = ...,
        MinAltitude: float = ...,
        TrackStep: float = ...,
        GroundSpeedStep: float = ...,
        VerticalSpeedStep: float = ...,
        AltitudeStep: float = ...,
        HorizontalAcceleration: float = ...,
        VerticalAcceleration: float = ...,
        TurnRate: float = ...,
        BankAngle: float = ...,
        VerticalRate: float = ...,
        RecoveryStabilityTime: float = ...,
        isRecoveryTrackBands: bool = ...,
        isRecoveryGroundSpeedBands: bool = ...,
        isRecoveryVerticalSpeedBands: bool = ...,
        isRecoveryAltitudeBands: bool = ...,
        isCollisionAvoidanceBands: bool = ...,
        CollisionAvoidanceBandsFactor: bool = ...,
        HorizontalNMAC: float = ...,
        MinHorizontalRecovery: float = ...,
        VerticalNMAC: float = ...,
        MinVerticalRecovery: float = ...,
        HorizontalContourThreshold: float = ...,
        DTHR: float = ...,
        ZTHR: float = ...,
        TTHR: float = ...,
        RTCAAlertLevels: int = ...,
        AlertTime1: float = ...,
        EarlyAlertTime1: float = ...,
        AlertTime2: float = ...,
        EarlyAlertTime2: float = ...,
        AlertTime3: float = ...,
        EarlyAlertTime3: float = ...,
        HorizontalDetectionType: str = ...,
    ) -> None: ...
