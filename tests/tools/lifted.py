"""The comparison of a lifted term with what runs, on rational inputs (`proofs.running.lifted`)."""

from cratous.proofs.mutation.inputs import inputs
from cratous.proofs.running import lifted

SAMPLES = 200
MASKS = {
    "eligible": {0, 1},
    "tasks_with": {0, 1},
    "operand_fits": {0, 1, 2},
    "stands_in": {0, 1},
    "stands_in_one_of": {0, 1, 2},
    "none_beside": {0, 1, 2, 3},
    "opened": {0, 1},
    "all_needed_done": {0, 1},
    "vehicle_is_eligible": {0, 1, 2},
    "masks": {0, 1, 2},
}


def differences(function, count=SAMPLES):
    """Inputs on which the lifted term, or what it owes, disagrees with the running function."""
    masks = frozenset(MASKS.get(function.__name__, ()))
    return lifted.differences(function, inputs(function, masks, count), masks)
