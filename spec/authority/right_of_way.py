"""When the ownship must act on a predicted loss of well clear. Seconds.

Right of way determines who gives way (`core.authority.gate.gives_way`); these definitions determine when giving way,
or acting despite having the right of way, is due. They apply to one intruder and one prediction.
"""

from __future__ import annotations


def trusted(persists: bool, in_turn: bool) -> bool:
    """The prediction can be relied on: it has persisted, or the intruder flies straight."""
    return persists or not in_turn


def loss_after(wait: float, first: float) -> float:
    """The time to the predicted loss after waiting [s]."""
    return first - wait


def must_act(
    first: float,
    last: float,
    hard: float,
    persist: float,
    persists: bool,
    in_turn: bool,
    has_to_give_way: bool,
) -> bool:
    """One of three cases applies: the loss is too near for any wait although the prediction is not trusted; a trusted
    loss is so near that right of way no longer counts; or the ownship has to give way in a trusted conflict, and the
    prediction has persisted, or waiting until it has would bring the loss that near.
    """
    too_near = not trusted(persists, in_turn) and loss_after(0, first) <= hard
    regardless = trusted(persists, in_turn) and loss_after(0, first) <= last
    by_right = trusted(persists, in_turn) and has_to_give_way
    return too_near or regardless or (by_right and (persists or loss_after(persist, first) <= last))
