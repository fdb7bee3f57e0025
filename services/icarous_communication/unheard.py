"""What a vehicle flies while UxAS does not hear its ICAROUS, as the kernel `loss_step` decides.

This is the lost-link procedure where ICAROUS steers through UxAS, so UxAS's end flies and reports it (`LinkLossState`).
A vehicle that ICAROUS has can only hold. One that UxAS has goes on with its mission, unless the mission asks for more.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cratous.core.authority.link_loss import (
    FINISH,
    LINKED,
    LOITER,
    OVER,
    RETURN,
    LossStep,
    loss_step,
)
from cratous.core.authority.timeliness import in_time
from cratous.services.flight.messages import Say
from cratous.services.flight.notices import link_loss_state
from cratous.services.icarous.messages import WithoutLink as Alone
from cratous.services.icarous_communication.holding import Sender, Step, hold, icarous_has, off_plan
from cratous.services.icarous_communication.returning import is_there, sent, way_to
from cratous.services.icarous_communication.state import Out, State
from cratous.services.loading.lost_link_attributes import AFTER_MS, Place
from cratous.spec.authority.link_loss import NOTHING, REJOIN
from cratous.spec.mission import Position
from cratous.spec.mission.link_loss import WithoutLink

WATCH_MS = 500
"""Interval of the check for silent instances [ms]."""
CHOICES = {
    WithoutLink.FINISH.value: FINISH,
    WithoutLink.LOITER.value: LOITER,
    WithoutLink.RETURN.value: RETURN,
}
"""What a vehicle that UxAS has can be made to fly."""


class LostLink(NamedTuple):
    """The procedure. choice: code of `core.authority.link_loss`; after_ms: silence that begins it [ms]; in_hand: only
    for a vehicle that ICAROUS has; to: where to return to, None: where each vehicle was first seen.
    """

    choice: int = FINISH
    after_ms: int = AFTER_MS
    in_hand: bool = True
    to: Place | None = None


class Beat(NamedTuple):
    """A step of the procedure. way: on which the vehicle returns from now on; said: what is reported."""

    step: LossStep
    way: tuple[Position, ...]
    said: list[Say]


IN_HAND = LostLink()
"""The procedure of a mission that asks for none."""


def heartbeat(
    name: str, lost: LostLink, state: State, vid: int, now_ms: int, beats: bool
) -> tuple[State, Beat]:
    """The state with the procedure of a vehicle at now_ms, and what follows.

    name: of the sender; beats: its instance sends heartbeats, so that its silence shows.
    """
    craft, peer, has = state.craft(vid), state.link.peer(vid), icarous_has(state, vid)
    if peer is None or (lost.in_hand and not has):
        heard_ms = now_ms
    else:
        heard_ms = peer.heard_ms if beats or not peer.end.alive else now_ms
    way, mode, returns = tuple[Position, ...](), craft.loss.mode, lost.choice == RETURN
    silent = not in_time(heard_ms, now_ms, lost.after_ms)
    if returns and not has and silent and mode == LINKED:
        way = way_to(state, vid, lost.to)
    # the way of a vehicle that ICAROUS has is not known here, so it can only hold
    permitted = not has and (not returns or bool(way) or mode == RETURN)
    ended = mode == RETURN and is_there(state, vid, lost.to)
    bound = heard_ms, now_ms, lost.after_ms
    step = loss_step(craft.loss, lost.choice, *bound, permitted, ended)
    said = _told(name, lost, state, vid, now_ms, step)
    return state.put(vid, replace(craft, loss=step.loss)), Beat(step, way, said)


def flown(sender: Sender, state: State, vid: int, beat: Beat) -> Step:
    """Command what a vehicle flies without the link: a way from now on, or a hold."""
    mode, out = beat.step.loss.mode, list[Out]()
    if beat.way:
        state, out = off_plan(sender, state, vid)
        state, more = sent(sender, state, vid, beat.way)
        return state, [*out, *more]
    if mode not in (LOITER, OVER) or state.craft(vid).holds:
        return state, []
    if not icarous_has(state, vid):
        state, out = off_plan(sender, state, vid)
    return hold(sender, state, vid, out, "its ICAROUS is not heard")


def _told(
    name: str, lost: LostLink, state: State, vid: int, now_ms: int, step: LossStep
) -> list[Say]:
    """The report of a change; nothing without one."""
    peer = state.link.peer(vid)
    if step.act == NOTHING or peer is None:
        return []
    silent = f"nothing was heard of its ICAROUS for {(now_ms - peer.heard_ms) / 1000:g} s"
    why = {
        LINKED: "its ICAROUS is heard again",
        FINISH: f"{silent}: it goes on with its mission",
        LOITER: f"{silent}: it holds in a circle",
        RETURN: f"{silent}: it returns",
        OVER: f"{silent}: it has returned, and holds in a circle",
    }[step.loss.mode]
    if step.act == REJOIN and not icarous_has(state, vid):
        why += ": its mission goes on"
    said = Alone(vid, now_ms, step.loss.mode, lost.choice, peer.heard_ms, why)
    return [Say(link_loss_state(said), name)]
