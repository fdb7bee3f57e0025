"""When the ownship must act on a predicted loss of well clear rather than wait.

Definition: `spec.authority.right_of_way`. The thresholds `last_s` and `hard_s` are derived from the vehicle's turn
rate in `services.icarous.traffic_monitor`.
"""

from cratous.core.kernel import kernel


@kernel(implements="authority.right_of_way.must_act")
def must_act(
    first_s: float,
    last_s: float,
    hard_s: float,
    persist_s: float,
    persists: bool,
    in_turn: bool,
    has_to_give_way: bool,
) -> bool:
    """True iff the ownship must act now on a loss that is predicted in first_s seconds.

    first_s: time to the predicted loss [s]; last_s: at or below this even the one with the right of way acts [s];
    hard_s: at or below this nobody waits for a turning intruder to fly straight [s]; persist_s: how long a prediction
    has to persist [s]; persists: it has; in_turn: the intruder turns; has_to_give_way: the right of way is the
    intruder's.
    """
    if in_turn and not persists:
        return first_s <= hard_s
    if first_s <= last_s:
        return True
    return has_to_give_way and (persists or first_s <= last_s + persist_s)
