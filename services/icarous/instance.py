"""The ICAROUS instance of one vehicle: `handle(state, message) -> (state, messages)`.

MONITOR: UxAS flies; the predicted route, up to the hold that ends it, is checked against traffic and zones.
AVOID: ICAROUS has taken over and flies the turn after which the way back is free soonest, or the manoeuvre
that deviates least from the course. HANDBACK: the way back has been free for a while and control is offered;
ICAROUS steers until UxAS takes it, and withdraws the offer on a new conflict. Own state and traffic come from
the vehicle itself; the bridge delivers zones and waypoints, and carries away SETMOD, SETVEL and HBEAT.
Without the bridge there is no offer: the instance flies along the waypoints it knows. The kernels of
`core.authority.cycle` decide who flies and every change of authority; `services.icarous.cognition` has the mode that
decides what is flown, and why.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from cratous.bridge.text_protocol import Heartbeat, SetMode, SetVelocity
from cratous.core.authority.cognition import mode_lets_go, mode_takes
from cratous.core.authority.cycle import (
    Cycled,
    cycle_begun,
    cycle_flown,
    cycle_watched,
    gate_wished,
)
from cratous.core.authority.gate import ICAROUS, gate_accepts
from cratous.core.authority.link_loss import FINAL, LANDED, LINKED, loss_lets_go, loss_takes
from cratous.core.authority.take_off import departure_lets_go, departure_takes
from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.manoeuvre import velocity_of
from cratous.core.avoidance.resolution import Choice
from cratous.core.merging.stages import merging_lets_go, merging_takes
from cratous.services.icarous import (
    cognition,
    link_loss,
    merging,
    messages,
    permits,
    route_requests,
    take_off,
)
from cratous.services.icarous.failing import noted
from cratous.services.icarous.forbidden import BY_ZONE, FREE, by_traffic
from cratous.services.icarous.foresight import (
    looked_s,
    points_back,
    predicted,
    scene_of,
    way_back_forbidden,
    way_is_free,
)
from cratous.services.icarous.geofence_monitor import zone_ahead_s
from cratous.services.icarous.inbox import beaten, hear
from cratous.services.icarous.offers import Refused, certified
from cratous.services.icarous.other_vehicles import to_their_ends, with_ways
from cratous.services.icarous.pace import change_ms, pace_of
from cratous.services.icarous.proposal import describe
from cratous.services.icarous.return_to_path import PERSIST_MS, RELAPSE_MS, onto
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.icarous.state import IDLE, Config, State
from cratous.services.icarous.traffic_monitor import (
    courses,
    loose_courses,
    most_urgent,
    nearest,
    threats,
    turning,
)
from cratous.spec.authority.cycle import MONITOR, NOTHING, OFFER, WITHDRAW
from cratous.spec.mission.plan import Pose
from cratous.spec.records import replace

LINK_LOST_MS = 2000
"""The bridge counts as lost when nothing has been heard for this long [ms]: four heartbeats."""
REASONS = {
    OFFER: "the way back is free",
    WITHDRAW: "offer withdrawn: the way back is no longer free",
}
ZONE = "zone"
NO_LINK = "link: UxAS is not heard"
FAILED = "failure: declared"
TAKES_OFF = "take-off: it is on the ground"
UXAS_WAY = "the way back that UxAS's planner has found is free"

Step = tuple[State, tuple[messages.FromInstance, ...]]


class Conflict(NamedTuple):
    """Why to take over: "traffic" or "zone", the intruder (0 for a zone), and the predicted time to violation
    [s].
    """

    why: str
    intruder_id: int
    first_s: float


@dataclass(frozen=True)
class Instance:
    """The service of one ICAROUS instance. config: its fixed configuration."""

    config: Config

    def handle(self, state: State, message: messages.ToInstance) -> Step:
        """One step: the state that results, and the messages to send, in order."""
        match message:
            case messages.Line(now_ms, line):
                config = self.config
                told = hear(state.told, line, config.projection, now_ms, config.original)
                asked = route_requests.heard(state.asking, line, config.projection)
                if told is state.told and asked is state.asking:
                    return state, ()
                # a waypoint index is meaningless for another route
                goal = state.goal if told.waypoints is state.told.waypoints else 0
                return replace(state, told=told, goal=goal, asking=asked), ()
            case messages.Talk():
                return merging.heard(self.config, state, message), ()
            case messages.Sensed():
                return self._beat(state, message)

    def _beat(self, state: State, sensed: messages.Sensed) -> Step:
        """One heartbeat: read the gate, then monitor or fly, and send a sign of life."""
        commands = gate_accepts(sensed.gate, ICAROUS, sensed.gate.epoch)
        cycle = cycle_begun(state.cycle, commands, sensed.now_ms)
        flew, watches = state.cycle.mode != MONITOR, cycle.mode == MONITOR
        now, beat_s = courses(sensed.intruders), self.config.heartbeat_ms / 1000
        # on the ground, its turn ability is that at take-off speed
        able = sensed
        if sensed.on_ground:
            able = sensed._replace(
                motion=sensed.motion._replace(speed_m_s=sensed.ability.min_speed_m_s)
            )
        until_s = self._needed_s(state, watches, sensed.now_ms)
        told = merging.with_members(self.config, state, sensed.now_ms)
        ways, others = with_ways(
            state.ways, told, able, self.config.daa, beat_s, state.courses, until_s
        )
        state, sensed = replace(state, told=beaten(state.told)), sensed._replace(intruders=others)
        # an intruder with a known route is predicted along it, in a turn as well
        loose = loose_courses(sensed.intruders)
        in_turn = turning(now, state.courses, beat_s, loose) - {o.id for o in others if o.way}
        if flew and watches:
            beats_ms = 2 * self.config.heartbeat_ms
            fresh = state.asking.idle()
            pace_ms = sensed.now_ms + beats_ms + change_ms(sensed, pace_of(state.told, sensed))
            state = replace(
                state, held=None, search=IDLE, threats=(), asking=fresh, pace_ms=pace_ms
            )
            state = permits.resumed(self.config, state, sensed, in_turn)
        state = replace(state, cycle=cycle, courses=now, ways=ways, beats=state.beats + 1)
        state, fails = link_loss.declared(self.config, state, sensed)
        state, up = take_off.heartbeat(self.config, state, sensed)
        state, lost = link_loss.heartbeat(self.config, state, sensed)
        state, merges = merging.heartbeat(self.config, state, sensed)
        if watches:
            after, out = self._watch(state, sensed, in_turn)
        else:
            after, out = self._fly(state, sensed, in_turn)
        state, decides = cognition.told(self.config, after, state, sensed)
        beat = Heartbeat(sequence=state.beats, time_s=sensed.now_ms / 1000)
        sign = messages.Up(self.config.vehicle_id, beat)
        if self.config.on_failure is not None:
            state = replace(state, failing=noted(state.failing, sensed, out))
        state, hears = self._hears(state, sensed.now_ms)
        return state, (*fails, *up, *lost, *merges, *hears, *decides, *out, sign)

    def _hears(self, state: State, now_ms: int) -> tuple[State, tuple[messages.Hears, ...]]:
        """A change of whether UxAS is heard, for the record; not reported here if the mission sets a lost-link
        behaviour alone, which reports it itself.
        """
        last_ms = state.told.heard_ms
        heard = in_time(last_ms, now_ms, LINK_LOST_MS)
        plan = self.config.lost_link
        says_so = plan is not None and not plan.in_hand and self.config.on_failure is None
        if says_so or not self.config.records or heard != state.unheard:
            return state, ()
        told = messages.Hears(self.config.vehicle_id, now_ms, heard, last_ms)
        return replace(state, unheard=not heard), (told,)

    def _needed_s(self, state: State, watches: bool, now_ms: int) -> float:
        """How far ahead the routes of others are needed at a heartbeat [s]: the look-ahead, or without limit
        where permits or courses are checked against them.
        """
        daa, plan = self.config.daa, self.config.alone(state.failing.failure)
        linked = plan is None or in_time(state.told.heard_ms, now_ms, plan.after_ms)
        linked = linked or (plan is not None and plan.in_hand)
        linked = linked and state.no_link.loss.mode == LINKED
        linked = linked and (self.config.on_failure is None or not state.told.stopped)
        if not watches or state.met or not linked or take_off.departs(self.config, state):
            return math.inf
        return looked_s(daa) + 1.0

    def _watch(self, state: State, sensed: messages.Sensed, in_turn: frozenset[int]) -> Step:
        """MONITOR: take over on a predicted conflict that requires own action, on loss of the link, or to
        take off.
        """
        if take_off.departs(self.config, state):
            departure = take_off.rising(self.config, state).departure
            state = cognition.decided(self.config, state, sensed, FREE)
            takes = departure_takes(departure, mode_takes(state.decided.mode))
            cycled = cycle_watched(state.cycle, takes, sensed.now_ms, RELAPSE_MS)
            return self._by_itself(state, sensed, in_turn, cycled, TAKES_OFF)
        state, conflict, off_plan = self._foreseen(state, sensed, in_turn)
        state, said = self._guided(state, sensed, bool(state.threats))
        alone = state.no_link.loss.mode != LINKED
        forbidden = FREE
        if conflict is not None and not alone:
            forbidden = BY_ZONE if conflict.why == ZONE else by_traffic(conflict.intruder_id)
        elif merging_takes(state.merging.stage, alone):
            forbidden = cognition.course_forbidden(self.config, state, sensed)
        state = cognition.decided(self.config, state, sensed, forbidden, off_plan)
        takes = loss_takes(state.no_link.loss, mode_takes(state.decided.mode))
        takes = merging_takes(state.merging.stage, takes)
        cycled = cycle_watched(state.cycle, takes, sensed.now_ms, RELAPSE_MS)
        if cycled.act == NOTHING:
            return replace(state, cycle=cycled.cycle), said
        sensed = sensed._replace(intruders=to_their_ends(state.ways, sensed.intruders))
        if conflict is None or alone:
            why = FAILED if state.failing.declared else NO_LINK
            why = why if alone else merging.reason(state.merging)
            state, out = self._by_itself(state, sensed, in_turn, cycled, why)
            return state, (*said, *out)
        vid, first_s = self.config.vehicle_id, conflict.first_s
        reason = f"{conflict.why}: loss predicted in {first_s:.1f} s"
        if conflict.intruder_id:
            reason += permits.told_why(state, conflict.intruder_id)
            state = permits.taken_over(state, conflict.intruder_id)
        state = replace(state, cycle=cycled.cycle, goal=state.told.next_index)
        state, choice = cognition.flown(self.config, state, sensed, in_turn)
        foresees = messages.Foresees(
            vid, sensed.now_ms, conflict.intruder_id, first_s, describe(choice)
        )
        wish = messages.Wish(vid, cycled.act, reason, conflict.intruder_id)
        offer = self._offer(state, sensed, choice)
        commands = self._commands(sensed, choice, cycled.act)
        return state, (*said, wish, foresees, *offer, *commands)

    def _by_itself(
        self,
        state: State,
        sensed: messages.Sensed,
        in_turn: frozenset[int],
        cycled: Cycled,
        why: str,
    ) -> Step:
        """Take over because UxAS is not heard, to take off, or to merge."""
        state = replace(state, cycle=cycled.cycle, goal=state.told.next_index)
        state, choice = cognition.flown(self.config, state, sensed, in_turn)
        wish = messages.Wish(self.config.vehicle_id, cycled.act, why, 0)
        offer = self._offer(state, sensed, choice)
        return state, (wish, *offer, *self._commands(sensed, choice, cycled.act))

    def _foreseen(
        self, state: State, sensed: messages.Sensed, in_turn: frozenset[int]
    ) -> tuple[State, Conflict | None, bool]:
        """Predict losses of well clear and re-check the permits. Returns the conflict to act on, None if
        there is none, and whether the vehicle is off its plan.
        """
        scene = scene_of(self.config, state, sensed)
        ahead = predicted(self.config, state, sensed, scene)
        if ahead.beside is not None and ahead.beside is not state.beside:
            state = replace(state, beside=ahead.beside)
        limits = nearest(sensed.ability, scene.volume, self.config.heartbeat_ms)
        own, seen = self.config.vehicle_id, sensed.intruders
        found = threats(own, ahead, seen, state.threats, sensed.now_ms, limits, in_turn)
        state = permits.looked(self.config, replace(state, threats=found), sensed, ahead)
        urgent = most_urgent(permits.acting(state, found))
        if urgent is not None:
            told = Conflict("traffic", urgent.intruder_id, urgent.first_violation_s)
            return state, told, ahead.off_plan
        if len(ahead.pieces) == 1 and not ahead.holds:
            zone_s = zone_ahead_s(sensed.motion, sensed.ability, ahead.pieces, state.told.zones)
            if zone_s is not None:
                return state, Conflict(ZONE, 0, zone_s), ahead.off_plan
        return state, None, ahead.off_plan

    def _fly(self, state: State, sensed: messages.Sensed, in_turn: frozenset[int]) -> Step:
        """AVOID and HANDBACK: fly the manoeuvre, and check whether the way back is free."""
        state, guides = self._guided(state, sensed, not (sensed.landed or sensed.on_ground))
        departure = take_off.rising(self.config, state).departure
        config, departs = self.config, take_off.departs(self.config, state)
        proposed, asked = None, list[messages.FromInstance]()
        if cognition.by_itself(config, state):
            forbidden = cognition.course_forbidden(config, state, sensed)
        else:
            lasting = state.search.waits(sensed.now_ms)
            forbidden = way_back_forbidden(config, state, sensed, in_turn, lasting)
            state, proposed, asked = self._proposed(state, sensed, in_turn, forbidden.free)
            forbidden = forbidden if proposed is None else FREE
        state = cognition.decided(config, state, sensed, forbidden)
        heard_ms, before = state.told.heard_ms, state.held
        free = loss_lets_go(state.no_link.loss, mode_lets_go(state.decided.mode))
        free = merging_lets_go(state.merging.stage, departure_lets_go(departure, free))
        cycled = cycle_flown(state.cycle, free, heard_ms, sensed.now_ms, LINK_LOST_MS, PERSIST_MS)
        state = replace(state, cycle=cycled.cycle)
        state, choice = cognition.flown(config, state, sensed, in_turn)
        out: list[messages.FromInstance] = [*guides]
        vid, text = self.config.vehicle_id, describe(choice)
        if cycled.act != NOTHING:
            of_uxas = cycled.act == OFFER and proposed is not None
            reason = f"{UXAS_WAY} (request {proposed})" if of_uxas else REASONS[cycled.act]
            out.append(messages.Wish(vid, cycled.act, reason, 0))
        # along a course the heading changes at each heartbeat: not recorded
        lost = state.no_link.loss.mode != LINKED
        course = state.no_link.course if lost else state.merging.course
        on_course = departs or course is not None
        changed = not on_course and (before is None or describe(before) != text)
        said = f"offer withdrawn; {text}" if cycled.act == WITHDRAW else text
        if changed or cycled.act == WITHDRAW:
            out.append(messages.Foresees(vid, sensed.now_ms, 0, -1.0, said))
        offer = self._offer(state, sensed, choice)
        return state, (*out, *asked, *offer, *self._commands(sensed, choice, cycled.act, proposed))

    def _proposed(
        self, state: State, sensed: messages.Sensed, in_turn: frozenset[int], free: bool
    ) -> tuple[State, int | None, list[messages.FromInstance]]:
        """Handle requests for a way back, where the own one is not free and UxAS plans live.

        Returns the state, the number of the request whose answer is free (None if none is), and the messages
        to send.
        """
        now_ms, motion, before = sensed.now_ms, sensed.motion, state.asking
        if free or not (before.allowed and state.told.waypoints):
            return replace(state, asking=before._replace(proposal=())), None, []
        points, found = points_back(state, sensed), route_requests.waited(before, now_ms)
        number = None
        if found.proposal:
            radius_m = TURN_MARGIN * motion.speed_m_s / sensed.ability.turn_rate_rad_s
            way = (*onto(found.proposal, motion, radius_m), *points[1:])
            lasting = state.search.waits(now_ms)
            if way_is_free(self.config, state, sensed, in_turn, way, lasting):
                number = found.answered
        speed_m_s, start = (
            state.told.speed_m_s or motion.speed_m_s,
            Pose(*motion.position, motion.heading_rad),
        )
        found, line = route_requests.asks(
            found, now_ms, start, speed_m_s, points[0], self.config.projection
        )
        vid, out = self.config.vehicle_id, list[messages.FromInstance]()
        out += [messages.Foresees(vid, now_ms, 0, -1.0, text) for text in found.said]
        out += [messages.Up(vid, line)] if line is not None else []
        return replace(state, asking=found._replace(said=())), number, out

    def _guided(
        self, state: State, sensed: messages.Sensed, wanted: bool
    ) -> tuple[State, tuple[messages.FromInstance, ...]]:
        """The state with alerts and bands evaluated, once a second while wanted, and their record."""
        if not wanted:
            return replace(state, bands=None), ()
        # not needed in a flight without conflicts
        from cratous.services.icarous.bands import Whose, watched

        config = self.config
        whose = Whose(config.vehicle_id, config.daa, config.heartbeat_ms, config.records)
        bands, instant = watched(whose, state.bands, sensed)
        state = replace(state, bands=bands)
        if instant is None or not config.records:
            return state, ()
        return state, (messages.Guides(config.vehicle_id, sensed.now_ms, sensed.motion, instant),)

    def _offer(
        self, state: State, sensed: messages.Sensed, choice: Choice
    ) -> tuple[messages.FromInstance, ...]:
        """The certificate of a manoeuvre, for the gate, or why there is none."""
        if not self.config.certifies:
            return ()
        vid, scene = self.config.vehicle_id, scene_of(self.config, state, sensed)
        if state.no_link.loss.mode in (FINAL, LANDED):
            return (messages.Uncertified(vid, 0, "the last descent to the ground ends in no hold"),)
        if sensed.on_ground:
            return (messages.Uncertified(vid, 0, "it is on the ground"),)
        found = certified(sensed, scene, choice, self.config.daa)
        return (
            messages.Uncertified(vid, *found)
            if isinstance(found, Refused)
            else messages.Offers(vid, found),
        )

    def _commands(
        self, sensed: messages.Sensed, choice: Choice, act: int, proposed: int | None = None
    ) -> tuple[messages.FromInstance, ...]:
        """The manoeuvre's velocity, for the autopilot and for UxAS, and the mode, repeated at each heartbeat
        so that a lost line does no harm.
        """
        vid, gate = self.config.vehicle_id, gate_wished(sensed.gate, act)
        v = velocity_of(choice.heading_rad, choice.speed_m_s, choice.climb_m_s)
        mode = SetMode("ACTIVE", gate.epoch)
        if gate.offered:
            mode = SetMode("PASSIVE", gate.epoch, proposed)
        told = SetVelocity(north_mps=v.north_m_s, east_mps=v.east_m_s, down_mps=v.down_m_s)
        return (messages.Steer(vid, gate.epoch, v), messages.Up(vid, mode), messages.Up(vid, told))
