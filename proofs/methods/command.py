"""Arbitrary values for theorems on authority: a gate, an ICAROUS instance, the UxAS end of a link, times."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.cognition import Conditions
from cratous.core.authority.cycle import Cycle
from cratous.core.authority.failure import Asked, Failure, Seen
from cratous.core.authority.gate import Gate
from cratous.core.authority.link_end import LinkEnd
from cratous.core.authority.link_loss import Loss
from cratous.core.authority.take_off import Departure
from cratous.proofs.claim import Claim
from cratous.spec.authority import cognition, failure, link_loss, take_off


def any_gate(c: Claim) -> Gate:
    """An arbitrary gate: who commands (`owner`), since which epoch (`gate_epoch`), and whether that is `offered`."""
    return Gate(c.integer("owner"), c.integer("gate_epoch"), c.boolean("offered"))


def any_cycle(c: Claim) -> Cycle:
    """An arbitrary state of an ICAROUS instance between two heartbeats."""
    return Cycle(
        c.integer("mode"),
        c.integer("relapses"),
        c.boolean("handed"),
        c.integer("handed_ms"),
        c.boolean("free"),
        c.integer("free_ms"),
    )


def any_link_end(c: Claim) -> LinkEnd:
    """An arbitrary state of the UxAS end of the link to one instance."""
    return LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))


def any_times(c: Claim) -> tuple[Any, ...]:
    """Arbitrary times [ms]: `now`; `soon`, within which a loss is acted on; `heard`, when UxAS was last heard, and
    `bound`, for how long that counts; `least`, the time to the next offer. Durations are not negative."""
    now, soon, heard, bound, least = (
        c.integer(name) for name in ("now", "soon", "heard", "bound", "least")
    )
    c.premise(c.all_of(soon >= 0, bound >= 0, least >= 0, least <= 2**56))
    return now, soon, heard, bound, least


def any_loss(c: Claim) -> tuple[Loss, tuple[Any, ...]]:
    """An arbitrary mode of a vehicle whose link may be lost, with arbitrary inputs of `loss_step` at a heartbeat:
    what is chosen, when UxAS was heard, the time, the bound, whether a course is permitted, and whether it is
    ended."""
    loss = Loss(c.integer("mode_without"), c.integer("since_ms"))
    chosen, heard, now, bound = (c.integer(n) for n in ("chosen", "heard", "now", "silence"))
    c.premise(c.define(link_loss.is_mode, loss.mode))
    c.premise(c.all_of(c.define(link_loss.may_be_chosen, chosen), bound >= 0))
    return loss, (chosen, heard, now, bound, c.boolean("permitted"), c.boolean("ended"))


def any_failure(c: Claim) -> tuple[Failure, tuple[Any, ...]]:
    """An arbitrary declared failure, or none, with arbitrary inputs of `failure_step` at a heartbeat: which failures are
    asked about, what is seen, what the vehicle flies by itself, the time and the reserve."""
    before = Failure(c.integer("failure"), c.integer("declared_ms"))
    asked = Asked(*(c.boolean(f"asks_{name}") for name in Asked._fields))
    since, expiry = c.integer("without_since"), c.integer("expiry")
    stopped, flies, without = (c.boolean(name) for name in ("stopped", "flies", "without"))
    seen = Seen(stopped, flies, without, since, c.boolean("surprised"), expiry)
    mode, now, reserve = c.integer("mode_alone"), c.integer("now"), c.integer("reserve")
    c.premise(c.define(failure.is_kind, before.kind))
    c.premise(reserve >= 0)
    return before, (asked, seen, mode, now, reserve)


def any_departure(c: Claim) -> tuple[Departure, tuple[Any, ...]]:
    """An arbitrary mode of a vehicle that takes off, with arbitrary inputs of `departure_step` at a heartbeat: when
    UxAS was heard, the time, the bound, whether the climb is permitted, whether the vehicle is off the ground, and
    at its end."""
    departure = Departure(c.integer("mode_up"), c.integer("since_ms"))
    heard, now, bound = (c.integer(n) for n in ("heard", "now", "silence"))
    c.premise(c.all_of(c.define(take_off.is_mode, departure.mode), bound >= 0))
    told = (c.boolean("permitted"), c.boolean("airborne"), c.boolean("ended"))
    return departure, (heard, now, bound, *told)


def any_other(c: Claim, step: Any, mode: Any) -> Any:
    """An arbitrary result of a heartbeat: records of the types `step` and `mode`."""
    return step(mode(c.integer("other_mode"), c.integer("other_since")), c.integer("other_act"))


def heartbeat_as_defined(
    c: Claim, step: Any, meant: Any, given: tuple[Any, ...], other: Any
) -> Any:
    """Show that the result of a heartbeat satisfies its definition for `given`, and that no `other` result does."""
    stepped = c.use(step, *given)
    c.show(c.define(meant, *given, stepped), "a heartbeat")
    another = c.define(meant, *given, other)
    c.show(c.implies(another, c.same(other, stepped)), "and it can be no other: never two modes")
    return stepped


def takes_and_goes_as_defined(
    c: Claim, before: Any, takes: tuple[Any, Any], goes: tuple[Any, Any], when: str
) -> None:
    """Show that ICAROUS takes the vehicle and releases it by its definitions. takes, goes: kernel and definition."""
    reason = c.boolean("reason")
    for (kernel, meant), text in ((takes, "why ICAROUS has the vehicle"), (goes, when)):
        c.show(c.same(c.use(kernel, before, reason), c.define(meant, before, reason)), text)


def any_conditions(c: Claim) -> tuple[Any, Conditions]:
    """An arbitrary mode of the decision logic, and arbitrary conditions at a heartbeat."""
    mode = c.integer("decided")
    c.premise(c.define(cognition.is_mode, mode))
    return mode, Conditions(*(c.boolean(f"is_{name}") for name in Conditions._fields))
