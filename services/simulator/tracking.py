"""Entity tracking: gimbals that stare at an entity's last perceived position, and its loss."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import payload

LOST_S = 2.0
"""An entity not perceived for this long is lost [s]: four perceptions are missed."""


class Track(NamedTuple):
    """entity: its id; return_to: number of the waypoint to go to on loss, 0: none, None: the vehicle got
    another command since; at: last perceived position, seen_s: when [s]; lost: whether it is lost.
    """

    entity: int
    return_to: int | None
    at: Any = None
    seen_s: float = 0.0
    lost: bool = False


class Tracks:
    """All tracks, by vehicle and gimbal."""

    def __init__(self) -> None:
        self._held: dict[tuple[int, int], Track] = {}

    def act(self, key: int, mounted: tuple[payload.Gimbal, ...], body: Any) -> bool:
        """Begin a track by a TrackEntityAction, or end one by another action for its gimbal; returns whether
        a track began.
        """
        kind = type(body).__name__
        if kind != "TrackEntityAction":
            if kind in ("GimbalAngleAction", "GimbalStareAction", "GimbalScanAction"):
                self._held.pop((key, body.PayloadID), None)
            return False
        gimbal = payload.gimbal_with(mounted, body.SensorID)
        if gimbal is None:
            return False
        self._held[key, gimbal] = Track(body.EntityID, body.ReturnToWaypoint)
        return True

    def steered(self, key: int) -> None:
        """A vehicle was directed elsewhere: it continues even if it loses what it tracks."""
        for held, track in self._held.items():
            if held[0] == key:
                self._held[held] = track._replace(return_to=None)

    def removed(self, key: int) -> None:
        """Drop the tracks of a removed vehicle."""
        for held in [one for one in self._held if one[0] == key]:
            del self._held[held]

    def perceived(self, body: Any, time_s: float) -> Iterator[tuple[int, Any]]:
        """Process an EntityPerception at time_s [s]: update its tracks; yields (vehicle, gimbal command that
        points at it).
        """
        for held, track in self._held.items():
            if track.entity and track.entity == body.PerceivedEntityID:
                self._held[held] = track._replace(at=body.Location, seen_s=time_s, lost=False)
                key, gimbal = held
                stare = lmcp.new("GimbalStareAction", PayloadID=gimbal, Starepoint=body.Location)
                yield key, stare

    def lost(self, time_s: float) -> Iterator[tuple[int, Track]]:
        """Tracks lost since the last call, by vehicle."""
        for held, track in self._held.items():
            if track.at is not None and not track.lost and time_s - track.seen_s > LOST_S:
                self._held[held] = track._replace(lost=True)
                yield held[0], track
