"""One heartbeat of an ICAROUS instance, composed of the kernels that fly: notice the gate, then monitor or fly.

Follows `services.icarous.instance`, for one arbitrary intruder; all others enter as one truth value.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.cycle import (
    Cycle,
    cycle_begun,
    cycle_flown,
    cycle_watched,
    gate_wished,
)
from cratous.core.authority.gate import Gate, gate_accepts
from cratous.core.authority.link_loss import Loss, loss_lets_go, loss_takes
from cratous.core.authority.right_of_way import must_act
from cratous.core.permit.encounter import (
    Encounter,
    encounter_looked,
    encounter_resumed,
    encounter_watched,
)
from cratous.proofs.claim import Claim
from cratous.spec.authority import cycle as instance
from cratous.spec.permit import hand as permit
from cratous.spec.system import clear as system


class Beat(NamedTuple):
    """What one heartbeat determines about the intruder.

    loss: a loss is predicted, in first_s [s]; ahead_s: look-ahead of the prediction; last_s, hard_s, persist_s,
    persists, in_turn, gives: as for `must_act`; t_s: the instant relative to now (as an arbitrary number, for any
    number of milliseconds). allowed: what was permitted still is; anew: because it was asked again, up to kept_ms;
    back: a course was permitted at the handback, up to resumed_ms [ms]. free: the way back is free. way, again,
    whole, home: the vehicle is clear at the instant on the predicted course, on the one permitted again, on the whole
    course permitted at a handback, on the way back.
    """

    loss: Any
    first_s: Any
    ahead_s: Any
    last_s: Any
    hard_s: Any
    persist_s: Any
    persists: Any
    in_turn: Any
    gives: Any
    t_s: Any
    allowed: Any
    anew: Any
    kept_ms: Any
    back: Any
    resumed_ms: Any
    free: Any
    way: Any
    again: Any
    whole: Any
    home: Any


class Around(NamedTuple):
    """The other inputs of a heartbeat. others: another intruder or a zone requires action; chosen: the takeover names
    this intruder; loss: the mode of link loss; the times are those of `cycle_watched` and `cycle_flown` [ms]."""

    others: Any
    chosen: Any
    loss: Loss
    heard: Any
    bound: Any
    least: Any
    soon: Any


class Beaten(NamedTuple):
    """State after a heartbeat: gate, instance, encounter, and the fields of `Sure` that a heartbeat changes."""

    gate: Gate
    cycle: Cycle
    met: Encounter
    looked: Any
    way: Any
    permit: Any
    until_ms: Any


def any_beat(c: Claim) -> Beat:
    """An arbitrary heartbeat, its values named as in `Beat`."""
    first, ahead, last, hard, persist, t = c.reals("first ahead last hard persist t")
    persists, turn, gives = (c.boolean(n) for n in ("persists", "in_turn", "gives"))
    allowed, anew, kept = c.boolean("allowed"), c.boolean("anew"), c.whole("kept")
    back, resumed, free = c.boolean("back"), c.whole("resumed"), c.boolean("way_free")
    truths = [c.boolean(f"clear_{name}") for name in ("way", "again", "whole", "home")]
    return Beat(
        c.boolean("loss"), first, ahead, last, hard, persist, persists, turn, gives, t,
        allowed, anew, kept, back, resumed, free, *truths,
    )  # fmt: skip


def any_surroundings(c: Claim) -> Around:
    """Arbitrary other inputs of a heartbeat."""
    loss = Loss(c.whole("mode_without"), c.whole("since"))
    times = [c.whole(name) for name in ("heard", "bound", "least", "soon")]
    return Around(c.boolean("others"), c.boolean("chosen"), loss, *times)


def each_beat(c: Claim, b: Beat, around: Around, now: Any, at: Any) -> Any:
    """Condition on every heartbeat: durations are not negative, numbers are within counting range, and predictions
    and permits are correct."""
    numbers = (b.kept_ms, b.resumed_ms, now, around.heard, around.loss.mode, around.loss.since_ms)
    lengths = (around.bound, around.least, around.soon)
    return c.all_of(
        *[c.all_of(n >= -permit.MOST, n <= permit.MOST) for n in numbers],
        *[c.all_of(n >= 0, n <= 2**56) for n in lengths],
        b.hard_s <= b.last_s,
        c.define(system.predicted, b.loss, b.first_s, b.ahead_s, b.way, b.t_s),
        c.implies(b.free, c.define(system.predicted, False, b.first_s, b.ahead_s, b.home, b.t_s)),
        c.implies(b.allowed, c.define(permit.certified, b.kept_ms, b.again, now, at)),
        c.implies(b.back, c.define(permit.certified, b.resumed_ms, b.whole, now, at)),
    )


def beaten(
    c: Claim,
    state: tuple[Gate, Cycle, Encounter],
    sure: Any,
    b: Beat,
    around: Around,
    at: Any,
) -> Beaten:
    """The state after a heartbeat at sure.now_ms. at: the instant considered [ms]."""
    (gate, cycle, met), now = state, sure.now_ms

    noticed = c.use(cycle_begun, cycle, c.use(gate_accepts, gate, 1, gate.epoch), now)
    watches, flew = noticed.mode == instance.MONITOR, cycle.mode != instance.MONITOR
    back = c.all_of(watches, flew)
    met = c.when(back, c.use(encounter_resumed, met, b.back, b.resumed_ms), met)
    asked = c.all_of(b.allowed, b.anew)
    permitted = c.when(asked, b.again, c.when(back, b.whole, sure.permit))
    until = c.when(asked, b.kept_ms, c.when(back, b.resumed_ms, sure.until_ms))
    # if it monitors
    seen = c.use(encounter_looked, met, b.allowed, now)
    near = c.use(
        must_act, b.first_s, b.last_s, b.hard_s, b.persist_s, b.persists, b.in_turn, b.gives
    )
    ours = c.all_of(b.loss, near)
    acts = c.use(encounter_watched, seen, ours).acts
    takes = c.use(loss_takes, around.loss, c.any_of(acts, around.others))
    cycled = c.use(cycle_watched, noticed, takes, now, around.soon)
    named = c.use(encounter_watched, seen, True).encounter
    taken = c.when(c.all_of(acts, around.chosen), named, seen)
    # if it flies
    free = c.use(loss_lets_go, around.loss, b.free)
    flown = c.use(cycle_flown, noticed, free, around.heard, now, around.bound, around.least)
    after = c.when(watches, cycled, flown)
    soon = c.all_of(b.t_s >= 0, b.t_s < b.hard_s, b.t_s < b.ahead_s)
    rests = c.all_of(watches, ours, seen.permitted)
    return Beaten(
        c.use(gate_wished, gate, after.act),
        after.cycle,
        c.when(watches, taken, met),
        c.all_of(soon, c.implies(rests, c.all_of(at >= now, at < until))),
        c.when(rests, permitted, c.when(watches, b.way, b.home)),
        permitted,
        until,
    )
