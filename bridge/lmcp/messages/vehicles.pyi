"""Messages of VEHICLES, version 1. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi

class GroundVehicleConfiguration(_cmasi.EntityConfiguration):
    """afrl.vehicles.GroundVehicleConfiguration: VEHICLES type 1."""

    RoadGraphID: int
    """int64, default 0."""
    MinimumSpeed: float
    """real32 [meter/sec], default 0.0."""
    MaximumSpeed: float
    """real32 [meter/sec], default 0.0."""
    EnergyRate: float
    """real32 [%/sec], default 0.0."""
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
        RoadGraphID: int = ...,
        MinimumSpeed: float = ...,
        MaximumSpeed: float = ...,
        EnergyRate: float = ...,
    ) -> None: ...

class GroundVehicleState(_cmasi.EntityState):
    """afrl.vehicles.GroundVehicleState: VEHICLES type 2."""
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

class SurfaceVehicleConfiguration(_cmasi.EntityConfiguration):
    """afrl.vehicles.SurfaceVehicleConfiguration: VEHICLES type 3."""

    WaterArea: int
    """int64, default 0."""
    MinimumSpeed: float
    """real32 [meter/sec], default 0.0."""
    MaximumSpeed: float
    """real32 [meter/sec], default 0.0."""
    EnergyRate: float
    """real32 [%/sec], default 0.0."""
    MaxBankAngle: float
    """real32 [degree], default 0.0."""
    MaxBankRate: float
    """real32 [degree/sec], default 0.0."""
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
        WaterArea: int = ...,
        MinimumSpeed: float = ...,
        MaximumSpeed: float = ...,
        EnergyRate: float = ...,
        MaxBankAngle: float = ...,
        MaxBankRate: float = ...,
    ) -> None: ...

class SurfaceVehicleState(_cmasi.EntityState):
    """afrl.vehicles.SurfaceVehicleState: VEHICLES type 4."""

    BankAngle: float
    """real32 [degree], default 0.0."""
    Speed: float
    """real32 [meter/sec], default 0.0."""
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
        BankAngle: float = ...,
        Speed: float = ...,
    ) -> None: ...

class StationarySensorConfiguration(_cmasi.EntityConfiguration):
    """afrl.vehicles.StationarySensorConfiguration: VEHICLES type 5."""
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

class StationarySensorState(_cmasi.EntityState):
    """afrl.vehicles.StationarySensorState: VEHICLES type 6."""
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
