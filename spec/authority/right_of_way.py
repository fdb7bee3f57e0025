"""When the ownship must act on a predicted loss of well clear. Seconds.

Right of way says who gives way (`core.authority.gate.gives_way`); these definitions say when giving way, or
acting in spite of it, is due. They hold for one intruder and one prediction.
"""

from __future__ import annotations


def trusted(persists: bool, in_turn: bool) -> bool:
    """The prediction tells where the intruder will be: it has persisted, or flies straight on."""
    return persists or not in_turn


def loss_after(wait: float, first: float) -> float:
    """How far ahead the predicted loss is after a wait."""
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
    """One of three is so: the loss is too near for any wait although the prediction is not trusted;
    a trusted loss is so near that right of way counts no more; or a trusted one is ours to avoid,
    and it has persisted, or waiting until it has would bring it that near.
    """
    too_near = not trusted(persists, in_turn) and loss_after(0, first) <= hard
    regardless = trusted(persists, in_turn) and loss_after(0, first) <= last
    by_right = trusted(persists, in_turn) and has_to_give_way
    return too_near or regardless or (by_right and (persists or loss_after(persist, first) <= last))
