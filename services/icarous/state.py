"""The state of one ICAROUS instance, and its fixed configuration."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.failure import Failure, procedure
from cratous.core.authority.take_off import STANDING, Departure
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Choice
from cratous.core.permit.encounter import Encounter
from cratous.services.icarous.band_history import Bands
from cratous.services.icarous.course import Course
from cratous.services.icarous.decided import Decided
from cratous.services.icarous.failing import Failing
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.lost_link import LostLink, NoLink, OnFailure
from cratous.services.icarous.merge_state import Fix, Merging
from cratous.services.icarous.other_vehicles import Ways
from cratous.services.icarous.route_end import Beside
from cratous.services.icarous.route_requests import Asking
from cratous.services.icarous.timed_way import Timed
from cratous.services.icarous.traffic_monitor import Threat, Tracks
from cratous.services.mission.frames import Projection
from cratous.services.mission.take_off import TakeOff
from cratous.spec.authority.cycle import MONITOR
from cratous.spec.mission import Daa, Position

START = Cycle(MONITOR, 0, False, 0, False, 0)
"""UxAS flies, and always has."""


class Config(NamedTuple):
    """Fixed configuration: vehicle id, detect-and-avoid parameters, projection, heartbeat [ms].

    original: the UxAS end is the original's, whose WAYPT lines carry a running count; certifies: each command
    comes with a certificate for the gate; records: alerts and bands are recorded; lost_link: behaviour while
    UxAS is not heard, None for none; take_off: its take-off, None if it starts in the air;
    merging: the fix at which it merges, None for none; on_failure: what is flown after a declared failure, None
    if the mission sets nothing.
    """

    vehicle_id: int
    daa: Daa
    projection: Projection
    heartbeat_ms: int
    original: bool = False
    certifies: bool = False
    records: bool = False
    lost_link: LostLink | None = None
    take_off: TakeOff | None = None
    merging: Fix | None = None
    on_failure: OnFailure | None = None

    def alone(self, failure: Failure) -> LostLink | None:
        """What the vehicle flies by itself: without the link, or after a declared failure."""
        if self.on_failure is None:
            return self.lost_link
        return (self.lost_link, self.on_failure.flies)[procedure(failure, 0, 1)]


class Rising(NamedTuple):
    """departure: the take-off mode, as the kernels have it; course: the climb-out being rolled or flown, None
    while it stands; why: why it stands, as last reported; tried_ms: when a climb-out was last searched for
    [ms].
    """

    departure: Departure = Departure(STANDING, 0)
    course: Course | None = None
    why: str = ""
    tried_ms: int = 0


class Met(NamedTuple):
    """An intruder for which ICAROUS has taken over.

    predicted: its state when the route was checked against it, at made_ms [ms]; way, its_way: the own and the
    intruder's route at that time; why: why the last permit ended, "" while none has.
    """

    intruder_id: int
    encounter: Encounter
    predicted: Intruder | None = None
    made_ms: int = 0
    way: tuple[Position, ...] = ()
    why: str = ""
    its_way: tuple[Position, ...] = ()


class Search(NamedTuple):
    """The search for the manoeuvre that is over soonest. at_ms: when it was last run; until_ms: how long its
    result is flown, 0 if another manoeuvre is flown [ms]; lasting: until then, control goes back only on a
    way that is permitted to its end against everybody.
    """

    at_ms: int
    until_ms: int
    lasting: bool = False

    def waits(self, now_ms: int) -> bool:
        """Whether a way back that is free for the look-ahead alone is not accepted yet."""
        return self.lasting and not lasted(self.until_ms, now_ms, 0)


IDLE = Search(0, 0)


@dataclass(frozen=True)
class State:
    """State of an instance.

    cycle: who flies, as the kernels have it; told: messages received over the bridge; threats, courses: of
    the last heartbeat; held: the manoeuvre being flown; goal: index of its goal waypoint; beats: heartbeats
    so far; met: intruders for which it has taken over; search: for the manoeuvre that is over soonest; ways:
    routes of other own vehicles; asking: requests for a way back; bands: last alerts and bands; no_link:
    state without the link; pace_ms: until when UxAS may be accelerating after a handback [ms]; unheard: UxAS
    was not heard at the last heartbeat; rising: state of the take-off; beside: last zone check for the final
    hold; merging: state of the merge; failing: a declared failure, and what led to it; timed: the way in time that is
    flown, None for none; decided: the mode, and why.
    """

    cycle: Cycle = START
    told: Told = field(default_factory=Told)
    threats: tuple[Threat, ...] = ()
    courses: Tracks = ()
    held: Choice | None = None
    goal: int = 0
    beats: int = 0
    met: tuple[Met, ...] = ()
    search: Search = IDLE
    ways: Ways = ()
    asking: Asking = field(default_factory=Asking)
    bands: Bands | None = None
    no_link: NoLink = field(default_factory=NoLink)
    pace_ms: int = 0
    unheard: bool = False
    rising: Rising = field(default_factory=Rising)
    beside: Beside | None = None
    merging: Merging = field(default_factory=Merging)
    failing: Failing = field(default_factory=Failing)
    timed: Timed | None = None
    decided: Decided = field(default_factory=Decided)

    def paces(self, now_ms: int) -> bool:
        """Whether UxAS may still be accelerating the vehicle to the announced speed after a handback."""
        return not lasted(self.pace_ms, now_ms, 0)

    @property
    def avoided(self) -> frozenset[int]:
        """The intruders for which ICAROUS has taken over."""
        return frozenset(one.intruder_id for one in self.met)

    def find(self, intruder_id: int) -> Met | None:
        """The record of an intruder; None if ICAROUS has never taken over for it."""
        return next((one for one in self.met if one.intruder_id == intruder_id), None)
