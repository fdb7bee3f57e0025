"""A running scenario: clock, timed events, all vehicles, and their messages.

The clock ticks 100 times a second. A step of 1/30 s is executed on the tick by which it is due, as in AMASE:
messages, then events, then motion. `World.tick` returns the messages of one tick, in order; nothing in it
depends on the machine's time.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Mapping
from functools import partial
from math import cos, degrees, isfinite, radians, sin
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import payload
from cratous.services.simulator.above_ground import above_sea
from cratous.services.simulator.aircraft import (
    Aircraft,
    aircraft_of,
    circle_m,
    receive,
    state,
    step,
)
from cratous.services.simulator.commands import check_command, check_place, present
from cratous.services.simulator.driver import STATES, Driver, Drivers
from cratous.services.simulator.guidance import NOTHING
from cratous.services.simulator.locations import location_of
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.paths import Paths, check_times, is_over, path_of, steers
from cratous.services.simulator.perception import Body, perceptions
from cratous.services.simulator.performance import Airframe, airframe_of
from cratous.services.simulator.self_commands import circles, fall_back, stay
from cratous.services.simulator.tracking import Tracks
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.services.simulator.sensed import Sensed
    from cratous.services.simulator.terrain import Terrain

TICK_S = 0.01
STEP_S = 1 / 30
TELL_S = 0.5
HAIR = 1e-6
"""The clock is a sum of ticks, so it may be this part of an interval early; AMASE is then a tick late."""
GROUND_M = 0.0
"""Without terrain the ground is at mean sea level [m], as in AMASE without elevation data."""
MOST_VEHICLES = 1000


class Event(NamedTuple):
    """An object of a scenario, its time [s], and its position in the file."""

    time_s: float
    body: Any
    where: str


class World:
    """See the module.

    duration_s: of the scenario; start_s: its start time, earlier events occur then. compatible: AMASE's
    defects are reproduced. terrain: the ground, at mean sea level without one. sensed: sensors by which
    aircraft know themselves and others; without them states are true. unheard: counts of relayed message
    kinds that have no effect here.
    """

    def __init__(
        self,
        events: Iterable[Event],
        duration_s: float,
        *,
        start_s: float = 0.0,
        compatible: bool = False,
        terrain: Terrain | None = None,
        sensed: Sensed | None = None,
    ) -> None:
        self._sensed = sensed
        self.time_s = self.start_s = start_s
        self.ends_s = start_s + duration_s
        self.compatible = compatible
        self.unheard: Counter[str] = Counter()
        # events at the same time occur in the order of the file
        self._events = deque(sorted(events, key=lambda event: event.time_s))
        self._airframes: dict[int, Airframe] = {}
        self._mounted: dict[int, tuple[payload.Gimbal, ...]] = {}
        self.aircraft: dict[int, Aircraft] = {}
        self.terrain = terrain
        self._tracks = Tracks()
        self._paths = Paths()
        self.drivers = Drivers(terrain, self._tracks)
        self._said: list[str] = []
        self._grounded: set[int] = set()
        self.wind_m_s = 0.0, 0.0
        self._part = 0.0  # fraction of a step already due
        self._told_s = start_s

    @property
    def time_ms(self) -> int:
        """Scenario time in messages [ms]. AMASE cuts off what its sum of ticks lacks to the full millisecond."""
        return int(self.time_s * 1000) if self.compatible else round(self.time_s * 1000)

    @property
    def over(self) -> bool:
        """True when the scenario's duration has passed."""
        return self.time_s >= self.ends_s

    def begin(self) -> list[Any]:
        """Process the events at the start before the clock runs, as AMASE does; returns them."""
        return self._happen()

    def _happen(self) -> list[Any]:
        """Process and return the events due by now."""
        told = []
        while self._events and self._events[0].time_s <= self.time_s:
            event = self._events.popleft()
            self.receive(event.body, event.where)
            told.append(event.body)
        return told

    def tick(self) -> list[Any]:
        """Advance by one tick. Returns the objects to send: events at once, states and SessionStatus twice a
        second.
        """
        self.time_s += TICK_S
        told: list[Any] = []
        due = TICK_S / STEP_S + self._part
        steps = int(due if self.compatible else due + HAIR)
        self._part = due - steps
        if not steps:
            return told
        if self._sensed is not None:
            told += self._sense(self._sensed)
        if self._tells():
            self._told_s = self.time_s
            told += [self.status("Running"), *self.states(), *self._perceive()]
        told += self._happen()
        if self._paths:
            self._keep_to_times()
        self._move()
        return told

    def _tells(self) -> bool:
        """Whether states are sent now: at multiples of TELL_S. AMASE counts from the last ones, each a step late."""
        if self.compatible:
            return self.time_s - self._told_s > TELL_S
        return int(self.time_s / TELL_S + HAIR) > int(self._told_s / TELL_S + HAIR)

    def _move(self) -> None:
        wind, ground_m = self.wind_m_s, GROUND_M
        for key, one in self.aircraft.items():
            if self.terrain is not None:
                ground_m = self._ground_m(key, one.motion)
            one = step(one, wind, ground_m, STEP_S)
            if one.guidance.fired:
                for body in one.guidance.fired:
                    self._act(key, body)
                one = one._replace(guidance=one.guidance._replace(fired=()))
            self.aircraft[key] = one
            mounted = self._mounted.get(key, ())
            if any(gimbal.action is not None for gimbal in mounted):
                self._mounted[key] = tuple(payload.step(p, one.motion, STEP_S) for p in mounted)
        self.drivers.step(STEP_S)

    def _ground_m(self, key: int, m: Motion) -> float:
        """Terrain height below an aircraft [m]; ground contact, which stops the aircraft, is reported once."""
        ground_m = (
            GROUND_M if self.terrain is None else self.terrain.elevation(m.lat_rad, m.lon_rad)
        )
        if m.alt_m > ground_m:
            self._grounded.discard(key)
        elif key not in self._grounded:
            self._grounded.add(key)
            at = f"{degrees(m.lat_rad):.5f}, {degrees(m.lon_rad):.5f}, {m.alt_m:.0f} m MSL"
            self._said.append(
                f"vehicle {key} has met the terrain at {at}, {self.time_s:.1f} s: it stands"
            )
        return ground_m

    def status(self, state_name: str, rate: float = 1.0) -> Any:
        """The present SessionStatus."""
        return lmcp.new(
            "SessionStatus",
            State=state_name,
            ScenarioTime=self.time_ms,
            RealTimeMultiple=rate,
        )

    def states(self) -> list[Any]:
        """The present states of all vehicles."""
        told = []
        for key, one in self.aircraft.items():
            mounted = self._mounted.get(key, ())
            seen = ()
            if mounted:
                seen = payload.states(mounted, one.motion, GROUND_M, self.terrain)
            self.aircraft[key], body = state(one, self.wind_m_s, self.time_ms, seen)
            told.append(body if self._sensed is None else self._sensed.own(body))
        return [*told, *self.drivers.states(self.time_ms, GROUND_M)]

    def _sense(self, sensed: Sensed) -> list[Any]:
        """The sensor perceptions that have arrived, also passed to the trackers."""
        told = sensed.step(self.time_ms, {key: one.motion for key, one in self.aircraft.items()})
        for body in told:
            self._perceived(body)
        return told

    def _perceive(self) -> list[Any]:
        """The present camera perceptions, also passed to the trackers; AMASE has none."""
        told: list[Any] = []
        if not self.compatible:
            flying = (
                Body(key, one.motion, self._mounted.get(key, ()))
                for key, one in self.aircraft.items()
            )
            bodies = *flying, *self.drivers.bodies()
            told += perceptions(bodies, self.time_ms, self.terrain)
        for body in told:
            self._perceived(body)
        for key, track in list(self._tracks.lost(self.time_s)):
            said, body = fall_back(key, track, self.time_s, self._one(key))
            self._said.append(said)
            if body is not None:
                self._obey(body)
        return told

    def _perceived(self, body: Any) -> bool:
        """Point the gimbals that track an entity at its position; returns whether one does."""
        stares = list(self._tracks.perceived(body, self.time_s))
        for key, stare in stares:
            if key in self.drivers.there:
                self.drivers.stare(key, stare)
            else:
                self._mounted[key] = tuple(payload.act(g, stare) for g in self._mounted[key])
        return bool(stares)

    def warnings(self) -> list[str]:
        """Warnings since the last call about commands that were not executed as given; each is issued once."""
        said = [*self._said, *self.drivers.said]
        self._said, self.drivers.said = [], []
        if self.terrain is not None:
            said += self.terrain.said
            self.terrain.said = []
        return said

    def receive(self, body: Any, where: str = "") -> None:
        """Process a message, of the scenario or from outside; BadInput if it cannot be executed."""
        kind = type(body).__name__
        present(body, where)
        if kind == "AirVehicleConfiguration" or kind in STATES:
            self._configure(body, where)
        elif kind in STATES.values():
            self.drivers.place(body, where)
        elif kind == "AirVehicleState":
            airframe = self._airframes.get(body.ID)
            if airframe is None:
                raise BadInput(
                    "a state of a vehicle without configuration", where=where,
                    item=f"AirVehicleState {body.ID}", expected="its AirVehicleConfiguration before it",
                )  # fmt: skip
            body = self._above_sea(body)
            one = aircraft_of(body, airframe, self.aircraft.get(body.ID), where)
            if self.terrain is not None:  # a corrupt tile is refused with its state
                self.terrain.elevation(one.motion.lat_rad, one.motion.lon_rad)
            self.aircraft[body.ID] = one
            self._mounted[body.ID] = payload.placed(self._mounted[body.ID], body)
        elif kind in ("MissionCommand", "VehicleActionCommand") or self._follows(body):
            self._command(body, where)
        elif kind == "AutomationResponse":
            commands = (*body.MissionCommandList, *body.VehicleCommandList)
            for one in commands:  # all of them, or none
                self._check(one, where)
            for one in [self._above_sea(one) for one in commands]:
                self._command(one, where)
        elif kind == "WeatherReport":
            if not (isfinite(body.WindSpeed) and isfinite(body.WindDirection)):
                raise BadInput("wind that is no number", where=where, item=kind)
            at = radians(body.WindDirection)
            self.wind_m_s = body.WindSpeed * cos(at), body.WindSpeed * sin(at)
        elif kind == "RemoveEntities":
            for key in body.EntityList:
                self.drivers.remove(key)
                self.aircraft.pop(key, None)
                self._airframes.pop(key, None)
                self._mounted.pop(key, None)
                self._grounded.discard(key)
                self._tracks.removed(key)
                self._paths.drop(key)
        elif kind == "EntityPerception":
            check_place(body.Location, where, f"{kind} of {body.PerceivedEntityID}")
            if not self._perceived(self._above_sea(body)):
                self.unheard[kind] += 1
        else:
            self.unheard[kind] += 1

    def _configure(self, body: Any, where: str) -> None:
        """Add a new vehicle; a known one is left unchanged."""
        flies = type(body).__name__ == "AirVehicleConfiguration"
        if body.ID in (self.drivers if flies else self._airframes):
            raise BadInput(
                "the same vehicle of two kinds", where=where, item=f"{type(body).__name__} {body.ID}"
            )  # fmt: skip
        if body.ID in (self._airframes if flies else self.drivers):
            return
        if len(self._airframes) + len(self.drivers) >= MOST_VEHICLES:
            raise BadInput("too many vehicles", where=where, expected=f"{MOST_VEHICLES}")
        if not flies:
            self.drivers.configure(body, where)
        else:
            self._airframes[body.ID] = airframe_of(body, self.compatible, where)
            self._mounted[body.ID] = payload.gimbals_of(body, where)

    def _check(self, body: Any, where: str) -> None:
        """BadInput for a command that cannot be executed."""
        if type(body).__name__ == "FollowPathCommand":
            check_times(body, where)
        check_command(body, where, flies=body.VehicleID not in self.drivers.there)
        if body.VehicleID not in self.aircraft and body.VehicleID not in self.drivers.there:
            there = [*self.aircraft, *self.drivers.there]
            raise BadInput(
                "a command for a vehicle that is not there", where=where,
                item=f"{type(body).__name__} {body.CommandID}", got=str(body.VehicleID),
                expected=f"one of {sorted(there)[:20]}",
            )  # fmt: skip

    def _above_sea(self, body: Any) -> Any:
        """A message with altitudes above mean sea level; AMASE treats all altitudes as such."""
        if self.terrain is None or self.compatible:
            return body
        key = getattr(body, "VehicleID", 0)
        there = key in self.aircraft or key in self.drivers.there
        m = self._one(key).motion if there else None
        return above_sea(body, self.terrain, (0.0, 0.0) if m is None else (m.lat_rad, m.lon_rad))

    def _command(self, body: Any, where: str) -> None:
        self._check(body, where)
        body = self._above_sea(body)
        if steers(body):
            self._tracks.steered(body.VehicleID)
            self._paths.drop(body.VehicleID)
        if self._follows(body):
            self._paths.hold(body)
            self._keep_to_times()
        else:
            self._obey(body)
            if is_over(body) and not self.compatible:
                self._stay(body.VehicleID, body.CommandID)

    def _follows(self, body: Any) -> bool:
        """Whether an object is a path for a vehicle that follows paths: all except aircraft in compatibility
        mode.
        """
        if type(body).__name__ != "FollowPathCommand":
            return False
        flies = body.VehicleID in self.aircraft and not self.compatible
        return flies or body.VehicleID in self.drivers.there

    def _keep_to_times(self) -> None:
        """Begin and end the paths that are due."""
        for body, begins in self._paths.due(self.time_ms):
            key = body.VehicleID
            one = self._one(key)
            if begins:
                circle = partial(circle_m, one) if isinstance(one, Aircraft) else None
                path = path_of(body, circle)
                self._obey(path.mission, path.told)
            else:
                self._stay(key, body.CommandID)

    def _stay(self, key: int, command: int) -> None:
        """A vehicle stays where it is, unless it circles without a route already."""
        one = self._one(key)
        if not circles(one):
            at = location_of(one.motion) if isinstance(one, Aircraft) else self.drivers.halt(key)
            self._obey(stay(key, command, one, at))

    def _one(self, key: int) -> Aircraft | Driver:
        """A present vehicle."""
        return self.aircraft[key] if key in self.aircraft else self.drivers.there[key]

    def _obey(self, body: Any, told: Mapping[int, int] = NOTHING) -> None:
        if body.VehicleID in self.drivers.there:
            self.drivers.command(body, told)
            return
        one = receive(self.aircraft[body.VehicleID], body, told)
        for fired in one.guidance.fired:
            self._act(body.VehicleID, fired)
        self.aircraft[body.VehicleID] = one._replace(guidance=one.guidance._replace(fired=()))

    def _act(self, key: int, body: Any) -> None:
        """Execute an action for a vehicle's payloads."""
        mounted = self._mounted.get(key, ())
        if self._tracks.act(key, mounted, body):
            return
        if not payload.is_for(mounted, body):
            self.unheard[type(body).__name__] += 1
            return
        self._mounted[key] = tuple(payload.act(one, body) for one in mounted)
