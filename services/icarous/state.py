"""Everything that one ICAROUS instance remembers, and what does not change about it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.take_off import STANDING, Departure
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Choice
from cratous.core.permit.encounter import Encounter
from cratous.services.icarous.asking import Asking
from cratous.services.icarous.band_history import Bands
from cratous.services.icarous.course import Course
from cratous.services.icarous.ending import Beside
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.lost import LostLink, NoLink
from cratous.services.icarous.merge_state import Fix, Merging
from cratous.services.icarous.others import Ways
from cratous.services.icarous.traffic_monitor import Threat, Tracks
from cratous.services.mission.frames import Projection
from cratous.services.mission.take_off import TakeOff
from cratous.spec.authority.cycle import MONITOR
from cratous.spec.mission import Daa, Position

START = Cycle(MONITOR, 0, False, 0, False, 0)
"""UxAS flies, and has always done so."""


class Config(NamedTuple):
    """What does not change: whose instance, what it keeps clear of, and the heartbeat [ms].

    original: UxAS's end is the original's, whose WAYPT lines carry a running count; certifies: what it commands is
    offered to the gate with a certificate; records: alerts and bands go to a record; lost_link: what it does while UxAS
    is not heard, None where the mission does not say; take_off: what it takes off to, None where it starts in the air; merging: the fix
    where it merges with others, None for none."""

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


class Rising(NamedTuple):
    """departure: the mode of a vehicle that takes off, as the kernels have it; course: the way up that is rolled or
    flown, None while it stands; why: it stands, as was said last; tried_ms: when a way up was last looked for [ms]."""

    departure: Departure = Departure(STANDING, 0)
    course: Course | None = None
    why: str = ""
    tried_ms: int = 0


class Met(NamedTuple):
    """An intruder because of which ICAROUS has taken over. predicted: as it was seen when the way was permitted
    against it, at made_ms [ms]; way, its_way: as UxAS had told them, its own and the other's; why: the last permit did not last, "" while each has."""

    intruder_id: int
    encounter: Encounter
    predicted: Intruder | None = None
    made_ms: int = 0
    way: tuple[Position, ...] = ()
    why: str = ""
    its_way: tuple[Position, ...] = ()


class Search(NamedTuple):
    """The manoeuvre that is over soonest. at_ms: when it was last looked for; until_ms: for how long the one that is
    held is flown as it is, 0 if it is none of these [ms]; lasting: until then control goes back only on a way that is
    permitted to its end against everybody."""

    at_ms: int
    until_ms: int
    lasting: bool = False

    def waits(self, now_ms: int) -> bool:
        """Whether a way back that is free for the look-ahead alone is not taken yet."""
        return self.lasting and not lasted(self.until_ms, now_ms, 0)


IDLE = Search(0, 0)


@dataclass(frozen=True)
class State:
    """cycle: who flies, as the kernels have it; told: what has come over the bridge; threats and
    courses: of the last heartbeat; held: the manoeuvre being flown; goal: index of the waypoint that
    it makes for; beats: heartbeats so far; met: the intruders because of which it has taken over; search: of the
    manoeuvre that is over soonest; ways: of the other vehicles of ours; asking: UxAS for a way back; bands: what detect
    and avoid said last, while a loss is foreseen or ICAROUS flies; no_link: what it does while UxAS is not heard;
    beside: what was asked of zones for the hold at the end of the way; rising: how far it is off the ground, where it started there; pace_ms: until when UxAS, after a handback, may be bringing the vehicle to the speed that was told [ms];
    unheard: UxAS was not heard at the last heartbeat; merging: how it flies over a merge fix."""

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

    def paces(self, now_ms: int) -> bool:
        """Whether UxAS, which has just taken it back, may still bring the vehicle to the speed that was told."""
        return not lasted(self.pace_ms, now_ms, 0)

    @property
    def avoided(self) -> frozenset[int]:
        """The intruder because of which ICAROUS took over."""
        return frozenset(one.intruder_id for one in self.met)

    def find(self, intruder_id: int) -> Met | None:
        """What is known of an intruder because of which it has taken over."""
        return next((one for one in self.met if one.intruder_id == intruder_id), None)
