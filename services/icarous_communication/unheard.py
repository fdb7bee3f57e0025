"""What a vehicle flies while UxAS does not hear its ICAROUS, as the kernel `loss_step` decides.

This is the lost-link procedure where ICAROUS steers through UxAS, so UxAS's end flies and reports it (`LinkLossState`).
A vehicle that ICAROUS has can only hold. One that UxAS has goes on with its mission, unless the mission asks for more.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cratous.core.authority.gate import ICAROUS, gate_accepts
from cratous.core.authority.link_loss import FINISH, LINKED, LOITER, LossStep, loss_step
from cratous.services.flight.messages import Say
from cratous.services.flight.notices import link_loss_state
from cratous.services.icarous.messages import WithoutLink as Alone
from cratous.services.icarous_communication.state import State
from cratous.spec.authority.link_loss import NOTHING, REJOIN
from cratous.spec.mission.bridge_times import USUAL
from cratous.spec.mission.link_loss import WithoutLink

AFTER_MS = USUAL.lost_link_after_ms
"""Silence after which the link to an instance counts as lost, if nothing else is configured [ms]."""
CHOICES = {WithoutLink.FINISH.value: FINISH, WithoutLink.LOITER.value: LOITER}
"""What a vehicle that UxAS has can be made to fly."""


class LostLink(NamedTuple):
    """The procedure. choice: code of `core.authority.link_loss`; after_ms: silence that begins it [ms]; in_hand: only
    for a vehicle that ICAROUS has.
    """

    choice: int = FINISH
    after_ms: int = AFTER_MS
    in_hand: bool = True


IN_HAND = LostLink()
"""The procedure of a mission that asks for none."""


def icarous_has(state: State, vid: int) -> bool:
    """Whether a vehicle's gate obeys its ICAROUS."""
    peer = state.link.peer(vid)
    return peer is not None and gate_accepts(peer.gate, ICAROUS, peer.gate.epoch)


def stepped(lost: LostLink, state: State, vid: int, now_ms: int, beats: bool) -> LossStep:
    """The procedure of a vehicle now. beats: its instance sends heartbeats, so that its silence shows."""
    craft, peer, has = state.craft(vid), state.link.peer(vid), icarous_has(state, vid)
    if peer is None or (lost.in_hand and not has):
        heard_ms = now_ms
    else:
        heard_ms = peer.heard_ms if beats or not peer.end.alive else now_ms
    # ICAROUS's way is not known here, so one that it has cannot finish it
    permitted = not has
    return loss_step(craft.loss, lost.choice, heard_ms, now_ms, lost.after_ms, permitted, False)


def told(
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
    }[step.loss.mode]
    if step.act == REJOIN and not icarous_has(state, vid):
        why += ": its mission goes on"
    said = Alone(vid, now_ms, step.loss.mode, lost.choice, peer.heard_ms, why)
    return [Say(link_loss_state(said), name)]


def heartbeat(
    name: str, lost: LostLink, state: State, vid: int, now_ms: int, beats: bool
) -> tuple[State, LossStep, list[Say]]:
    """The state with the procedure of a vehicle at now_ms, its step, and what is reported. See `stepped`."""
    step = stepped(lost, state, vid, now_ms, beats)
    said = told(name, lost, state, vid, now_ms, step)
    return state.put(vid, replace(state.craft(vid), loss=step.loss)), step, said
