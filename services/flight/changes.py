"""Mission changes in flight: they are announced, checked against the plan, and answered with a new plan if
needed.
"""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.routing.visibility import name_of
from cratous.services.flight.dynamics import limits_of
from cratous.services.flight.executive_outputs import command_all
from cratous.services.flight.executive_state import Asked, Config, Out, State
from cratous.services.flight.messages import AskPlan, LimitsAre, NotPlanned, Say, ZonesKnown
from cratous.services.flight.notices import mission_change, plan_accepted
from cratous.services.flight.replan_triggers import (
    handed_over,
    left_by,
    nobody_may,
    orders_missed,
    touched_by,
    undone_by,
)
from cratous.services.flight.task_transitions import begin, give_up, progress
from cratous.services.loading.polygons import hard_zones
from cratous.services.mission.availability import absent, without
from cratous.services.mission.wind import all_in_wind, in_wind, known_at, told, wind_at
from cratous.spec.algebra.meaning import tasks
from cratous.spec.executive import FOR_CHANGE
from cratous.spec.mission import Change, SweptZone, ZoneKind
from cratous.spec.mission.asked import asked, term_of
from cratous.spec.mission.changes import (
    DIRECT,
    ZONE_ENDS,
    ZoneEnd,
    in_force,
    split,
    with_choices,
    words,
)
from cratous.spec.mission.plan import Plan, left_out_of
from cratous.spec.records import replace

NAME = "uxas"
"""Sender of messages about the mission and the plan."""


def known_from_the_start(config: Config, state: State, out: Out) -> State:
    """Announce the changes known at mission start, and the plan, which was made with them."""
    state, blown = blow(config, state, out)
    begun_with, _ = split((c for c in config.mission.changes if c.kind not in DIRECT), state.now_ms)
    if begun_with:
        what = "; ".join(words(change) for change in begun_with)
        answer = "; ".join(filter(None, ("planned with it", blown)))
        out.append(Say(mission_change(state.now_ms, what, answer), NAME))
    accept(state, out)
    return state


def blow(config: Config, state: State, out: Out) -> tuple[State, str]:
    """Apply the present wind to all vehicles. Returns the state and what changed, in words; "" if nothing
    did.
    """
    before, now = state.wind, wind_at(config.mission, state.now_ms)
    if now == before:
        return state, ""
    for vehicle in config.mission.vehicles:
        out.append(LimitsAre(vehicle.id, limits_of(in_wind(vehicle, now) or vehicle)))
    state = replace(state, wind=now, mission=all_in_wind(config.mission, now))
    return state, told(config.mission, before, now)


def accept(state: State, out: Out) -> None:
    """Announce the plan that is in force from now on."""
    done = frozenset(dict(state.ends))
    out.append(Say(plan_accepted(state.now_ms, state.plan, done), NAME))


def change(config: Config, state: State, due: Sequence[Change], out: Out) -> State:
    """Apply mission changes that have become known; request a new plan if they require one."""
    known = without(known_at(config.mission, state.now_ms, dict(state.ends)), dict(state.landed))
    state, blown = blow(config, replace(state, known=known), out)
    ended = {c.zone_id for c in due if isinstance(c, ZoneEnd)}
    zones = hard_zones(tuple(c.zone for c in due if c.zone and c.zone.id not in ended))
    kept = tuple(zone for zone in state.zones if zone.id not in ended)
    # every route is sent to ICAROUS again, since it avoids the zones as well
    chains = tuple(replace(chain, told_version=-1) for chain in state.chains)
    state = replace(state, zones=in_force(kept, zones), chains=chains)
    out.append(ZonesKnown(state.zones))
    what = "; ".join(words(c) for c in due)
    settled = dict(state.ends).keys() | dict(state.failed).keys()
    undone = {
        c: undone_by(c, state.plan, settled)
        for c in due
        if c.kind == ZONE_ENDS or isinstance(c.zone, SweptZone)
    }
    aircraft = {vid: state.from_where(vid) for vid, _ in state.aircraft}
    touched = touched_by(due, zones, state.by_vehicle(), dict(state.ends), aircraft, undone)
    missed = orders_missed(known, due, dict(state.starts), dict(state.ends)) if touched else ""
    why = "; ".join(text for text in (blown, touched, missed) if text)
    if not why:
        _tell(state, what, "the plan holds as it is", out)
        return state
    return replace(state, asked=Asked(FOR_CHANGE, what, why))


def _absent(config: Config, state: State) -> dict[int, str]:
    """The vehicles that take no part at present, with the reasons."""
    return {**absent(config.mission, state.now_ms), **dict(state.landed)}


def ask(config: Config, state: State) -> AskPlan:
    """Request for a plan for the remaining tasks, from the vehicles' present poses."""
    here = {vehicle.id for vehicle in state.known.vehicles}
    starts, ends = dict(state.starts), dict(state.ends)
    return AskPlan(
        state.now_ms,
        state.known,
        tuple((vid, state.from_where(vid).pose) for vid, _ in state.aircraft if vid in here),
        tuple((task, starts[task], ends[task]) for task in sorted(ends)),
        tuple(_absent(config, state).items()),
        state.failed,
        tuple(sorted(starts.keys() - ends.keys())),
    )


def planned(config: Config, state: State, plan: Plan, asked_for: Asked, out: Out) -> State:
    """Put another plan in force. The change is announced before anything that follows from it."""
    begun: Out = []
    before, state = state, replace(state, plan=plan, replans=state.replans + 1)
    after = begin(config, state, begun)
    if asked_for.kind == FOR_CHANGE:
        moved = handed_over(left_by(before.by_vehicle()), plan)
        why = "; ".join(filter(None, (asked_for.why, moved, _leaving(config, before, after))))
        _tell(state, asked_for.what, f"planned anew: {why}", out)
    accept(state, out)
    note = f"planned anew, because of {asked_for.what or asked_for.why}"
    gone = {one.task_id for one in left_out_of(plan)}
    out.extend(
        progress(chain, state.now_ms, "Planned", note)
        for chain in state.chains
        if chain.item is not None and chain.item.task_id not in gone
    )
    out.extend(begun)
    return after


def unplanned(
    config: Config, state: State, no_plan: NotPlanned, asked_for: Asked, out: Out
) -> State:
    """After a change no remaining task can be planned: each fails with its reason."""
    todo = _open(state)
    none = nobody_may(state.known, todo, _absent(config, state))
    of = dict(no_plan.of)
    told = [(task, of.get(task) or f"{asked_for.what}: {no_plan.why}") for task in todo]
    begun: Out = []
    after = give_up(config, state, told, begun)
    why = "; ".join(filter(None, (asked_for.why, none, _leaving(config, state, after))))
    _tell(state, asked_for.what, f"no plan for what is left ({no_plan.why}): {why}", out)
    out.extend(begun)
    return command_all(config, after, out)


def _leaving(config: Config, state: State, after: State) -> str:
    """Which vehicles are inside newly binding zones, and how each leaves them.

    after: the state with their new routes. The length of a shortest way out is stated only where that way is
    flown.
    """
    ways, said = config.ways(state.zones), []
    for chain in state.chains:
        if chain.suspended:
            continue
        inside, out = ways.out_of(chain, state.from_where(chain.vehicle.id))
        if out is not None:
            kept = [f"leaves {name_of(z)}" for z in inside if z.kind is ZoneKind.KEEP_OUT]
            kept += [f"enters {name_of(z)}" for z in inside if z.kind is ZoneKind.KEEP_IN]
            told = f"vehicle {chain.vehicle.id} first {' and '.join(kept)}, level, by the shortest way found"
            if after.chain(chain.vehicle.id).track.points[: len(out.points)] == out.points:
                told += f", {out.inside_m:.0f} m"
            else:
                told = f"vehicle {chain.vehicle.id} {' and '.join(kept)} on its way"
            said.append(told)
    return "; ".join(said)


def left(state: State) -> list[int]:
    """The tasks that are asked for and not complete."""
    ends = dict(state.ends).keys()
    return [task for task in _asked(state) if task not in ends]


def _open(state: State) -> list[int]:
    """The incomplete tasks of all choices still open, sorted by id."""
    term = term_of(with_choices(state.known, dict(state.starts).keys()))
    ends = dict(state.ends).keys()
    return [] if term is None else sorted(set(tasks(term)) - ends)


def unserved(state: State) -> list[int]:
    """The tasks that are asked for and not completely served."""
    ends = dict(state.ends).keys()
    return [task for task in _asked(state) if task not in ends or task in state.in_part]


def _asked(state: State) -> tuple[int, ...]:
    ends = dict(state.ends).keys()
    return asked(state.known, ends, ends | {item.task_id for item in state.plan.items})


def _tell(state: State, what: str, answer: str, out: Out) -> None:
    out.append(Say(mission_change(state.now_ms, what, answer), NAME))
