"""Messages of ROUTE, version 4. Generated; do not edit."""

from collections.abc import Iterable

from cratous.bridge.lmcp.messages import cmasi as _cmasi
from cratous.bridge.lmcp.messages import impact as _impact
from cratous.bridge.lmcp.messages import route as _route
from cratous.bridge.lmcp.objects import LmcpObject

class GraphNode(LmcpObject):
    """uxas.messages.route.GraphNode: ROUTE type 1."""

    NodeID: int
    """int64, default 0."""
    Coordinates: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    AssociatedEdges: list[int]
    """int64[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        NodeID: int = ...,
        Coordinates: _cmasi.Location3D = ...,
        AssociatedEdges: Iterable[int] = ...,
    ) -> None: ...

class GraphEdge(LmcpObject):
    """uxas.messages.route.GraphEdge: ROUTE type 2."""

    EdgeID: int
    """int64, default 0."""
    StartNode: int
    """int64, default 0."""
    EndNode: int
    """int64, default 0."""
    Waypoints: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 1024."""
    def __init__(
        self,
        *,
        EdgeID: int = ...,
        StartNode: int = ...,
        EndNode: int = ...,
        Waypoints: Iterable[_cmasi.Location3D] = ...,
    ) -> None: ...

class GraphRegion(LmcpObject):
    """uxas.messages.route.GraphRegion: ROUTE type 3."""

    ID: int
    """int64, default 0."""
    NodeList: list[_route.GraphNode]
    """ROUTE/GraphNode[], default empty, 32-bit count, the model says at most 16777216."""
    EdgeList: list[_route.GraphEdge]
    """ROUTE/GraphEdge[], default empty, 32-bit count, the model says at most 16777216."""
    def __init__(
        self,
        *,
        ID: int = ...,
        NodeList: Iterable[_route.GraphNode] = ...,
        EdgeList: Iterable[_route.GraphEdge] = ...,
    ) -> None: ...

class RouteConstraints(LmcpObject):
    """uxas.messages.route.RouteConstraints: ROUTE type 4."""

    RouteID: int
    """int64, default 0."""
    StartLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    StartHeading: float
    """real32 [degrees], default 0.0."""
    UseStartHeading: bool
    """bool, default true."""
    EndLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    EndHeading: float
    """real32 [degrees], default 0.0."""
    UseEndHeading: bool
    """bool, default true."""
    def __init__(
        self,
        *,
        RouteID: int = ...,
        StartLocation: _cmasi.Location3D = ...,
        StartHeading: float = ...,
        UseStartHeading: bool = ...,
        EndLocation: _cmasi.Location3D = ...,
        EndHeading: float = ...,
        UseEndHeading: bool = ...,
    ) -> None: ...

class RouteRequest(LmcpObject):
    """uxas.messages.route.RouteRequest: ROUTE type 5."""

    RequestID: int
    """int64, default 0."""
    AssociatedTaskID: int
    """int64, default 0."""
    VehicleID: list[int]
    """int64[], default empty, the model says at most 16."""
    OperatingRegion: int
    """int64, default 0."""
    RouteRequests: list[_route.RouteConstraints]
    """ROUTE/RouteConstraints[], default empty, the model says at most 256."""
    IsCostOnlyRequest: bool
    """bool, default true."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        AssociatedTaskID: int = ...,
        VehicleID: Iterable[int] = ...,
        OperatingRegion: int = ...,
        RouteRequests: Iterable[_route.RouteConstraints] = ...,
        IsCostOnlyRequest: bool = ...,
    ) -> None: ...

class RoutePlanRequest(LmcpObject):
    """uxas.messages.route.RoutePlanRequest: ROUTE type 6."""

    RequestID: int
    """int64, default 0."""
    AssociatedTaskID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    OperatingRegion: int
    """int64, default 0."""
    RouteRequests: list[_route.RouteConstraints]
    """ROUTE/RouteConstraints[], default empty, the model says at most 256."""
    IsCostOnlyRequest: bool
    """bool, default true."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        AssociatedTaskID: int = ...,
        VehicleID: int = ...,
        OperatingRegion: int = ...,
        RouteRequests: Iterable[_route.RouteConstraints] = ...,
        IsCostOnlyRequest: bool = ...,
    ) -> None: ...

class RoutePlan(LmcpObject):
    """uxas.messages.route.RoutePlan: ROUTE type 7."""

    RouteID: int
    """int64, default 0."""
    Waypoints: list[_cmasi.Waypoint]
    """CMASI/Waypoint[], default empty, the model says at most 1024."""
    RouteCost: int
    """int64 [milliseconds], default -1."""
    RouteError: list[_cmasi.KeyValuePair]
    """CMASI/KeyValuePair[], default empty, the model says at most 8."""
    def __init__(
        self,
        *,
        RouteID: int = ...,
        Waypoints: Iterable[_cmasi.Waypoint] = ...,
        RouteCost: int = ...,
        RouteError: Iterable[_cmasi.KeyValuePair] = ...,
    ) -> None: ...

class RoutePlanResponse(LmcpObject):
    """uxas.messages.route.RoutePlanResponse: ROUTE type 8."""

    ResponseID: int
    """int64, default 0."""
    AssociatedTaskID: int
    """int64, default 0."""
    VehicleID: int
    """int64, default 0."""
    OperatingRegion: int
    """int64, default 0."""
    RouteResponses: list[_route.RoutePlan]
    """ROUTE/RoutePlan[], default empty, the model says at most 256."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        AssociatedTaskID: int = ...,
        VehicleID: int = ...,
        OperatingRegion: int = ...,
        RouteResponses: Iterable[_route.RoutePlan] = ...,
    ) -> None: ...

class RouteResponse(LmcpObject):
    """uxas.messages.route.RouteResponse: ROUTE type 9."""

    ResponseID: int
    """int64, default 0."""
    Routes: list[_route.RoutePlanResponse]
    """ROUTE/RoutePlanResponse[], default empty, the model says at most 4096."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        Routes: Iterable[_route.RoutePlanResponse] = ...,
    ) -> None: ...

class EgressRouteRequest(LmcpObject):
    """uxas.messages.route.EgressRouteRequest: ROUTE type 10."""

    RequestID: int
    """int64, default 0."""
    StartLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    Radius: float
    """real32 [meters], default 60.0."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        StartLocation: _cmasi.Location3D = ...,
        Radius: float = ...,
    ) -> None: ...

class EgressRouteResponse(LmcpObject):
    """uxas.messages.route.EgressRouteResponse: ROUTE type 11."""

    ResponseID: int
    """int64, default 0."""
    NodeLocations: list[_cmasi.Location3D]
    """CMASI/Location3D[], default empty, the model says at most 32."""
    Headings: list[float]
    """real32[] [degrees], default empty, the model says at most 32."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        NodeLocations: Iterable[_cmasi.Location3D] = ...,
        Headings: Iterable[float] = ...,
    ) -> None: ...

class RoadPointsConstraints(LmcpObject):
    """uxas.messages.route.RoadPointsConstraints: ROUTE type 12."""

    RoadPointsID: int
    """int64, default 0."""
    StartLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    EndLocation: _cmasi.Location3D
    """CMASI/Location3D, default a new CMASI/Location3D."""
    def __init__(
        self,
        *,
        RoadPointsID: int = ...,
        StartLocation: _cmasi.Location3D = ...,
        EndLocation: _cmasi.Location3D = ...,
    ) -> None: ...

class RoadPointsRequest(LmcpObject):
    """uxas.messages.route.RoadPointsRequest: ROUTE type 13."""

    RequestID: int
    """int64, default 0."""
    RoadPointsRequests: list[_route.RoadPointsConstraints]
    """ROUTE/RoadPointsConstraints[], default empty."""
    def __init__(
        self,
        *,
        RequestID: int = ...,
        RoadPointsRequests: Iterable[_route.RoadPointsConstraints] = ...,
    ) -> None: ...

class RoadPointsResponse(LmcpObject):
    """uxas.messages.route.RoadPointsResponse: ROUTE type 14."""

    ResponseID: int
    """int64, default 0."""
    RoadPointsResponses: list[_impact.LineOfInterest]
    """IMPACT/LineOfInterest[], default empty."""
    def __init__(
        self,
        *,
        ResponseID: int = ...,
        RoadPointsResponses: Iterable[_impact.LineOfInterest] = ...,
    ) -> None: ...
