"""Whether a way out existed: judging manoeuvres segment by segment, and all of them together.

Definitions: `spec.excuse`. Answers are 1 (free; a way out), 0 (open; undecided) and -1 (refused; no way out). The
caller supplies the segments and what is known of the other aircraft: `core.excuse.bands` flies the manoeuvres of the
bands, `core.excuse.exhaustive_check` integrates its own.
"""

from cratous.core.daa.volume import in_conflict
from cratous.core.kernel import Vec2, fold, kernel
from cratous.core.well_clear.thresholds import Thresholds


@kernel(implements="excuse.lost_at")
def piece_lost(
    kind: int, s: Vec2, v: Vec2, sz: float, vz: float, thresholds: Thresholds, piece_s: float
) -> bool:
    """True iff the volume is violated at some instant of a straight segment of piece_s seconds.

    Relative state at its beginning, ownship minus other; kind and thresholds as for `in_conflict`.
    """
    return in_conflict(kind, s, v, sz, vz, thresholds, 0, piece_s)


@kernel(implements="excuse.flown_step")
def after_piece(so_far: int, known: bool, lost: bool, surely: bool) -> int:
    """A manoeuvre after one more segment: -1 refused, 0 open, 1 free.

    known: whether the other aircraft's position then is known; lost: the volume is violated at some instant; surely:
    a slightly smaller volume is, too.
    """
    if so_far < 0:
        return so_far
    if known and not lost:
        return so_far
    if known and surely:
        return -1
    return 0


manoeuvre_judged = fold(
    name="manoeuvre_judged", implements="excuse.flown_step", step=after_piece, start=1
)
"""Judge a manoeuvre from its segments (known, lost, surely)."""


@kernel(implements="excuse.tried_step")
def after_manoeuvre(so_far: int, manoeuvre: int) -> int:
    """The answer after one more manoeuvre: 1, 0, -1, or 2 before the first.

    A verdict that is neither 1 (free) nor -1 (refused) is open.
    """
    if so_far == 1 or manoeuvre == 1:
        return 1
    if so_far == 0 or manoeuvre != -1:
        return 0
    return -1


@kernel(implements="excuse.answer")
def answer_result(so_far: int) -> int:
    """1 a way out, -1 none, 0 undecided; nothing tried is undecided."""
    if so_far == 1 or so_far == -1:
        return so_far
    return 0


way_out = fold(
    name="way_out",
    implements="excuse.tried_step",
    step=after_manoeuvre,
    start=2,
    finish=answer_result,
)
"""Whether there is a way out among manoeuvres (answer,), or at any of several instants."""


@kernel(implements="excuse.agreed")
def both_say(one: int, other: int) -> int:
    """The common answer of two independent judges; 0 if they differ."""
    if one == other and (one == 1 or one == -1):
        return one
    return 0


@kernel(
    implements="excuse.excuses",
    restates="which answer excuses a loss: the code that stands for `no way out`",
)
def is_excused(answer: int) -> bool:
    """True iff the answer excuses a loss: only -1, that there was no way out, does."""
    return answer == -1
