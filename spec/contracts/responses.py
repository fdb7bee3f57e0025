"""Answering a predicted loss of well clear, on the bus, and coming back to the mission: what must hold.

A vehicle is in one of five states, which say what is so now: it flies its mission (MISSION); a
conflict is its own to avoid (CONFLICT); a conflict is for others to avoid (RIGHT_OF_WAY); there is
no conflict any more but the vehicle is off its mission (HOLD); it has been sent back (RESUME).
Sources of the five states: the response service of OpenUxAS and the resolution logic of ICAROUS;
what is required of them is ours.

An instant brings facts: `conflict`, a loss is predicted soon; `ours`, it is for us to act; `good`,
the manoeuvre that is flown is still free of zones and of conflicts that are ours; `found`, some
manoeuvre is free of both; `free`, the way back is; `lasted`, it has been so, or a command has been without
effect, for long enough; `taken`, the vehicle says that it flies its mission.
"""

MISSION, CONFLICT, HOLD, RIGHT_OF_WAY, RESUME = 0, 1, 2, 3, 4
STATES = ("on mission", "in conflict", "on hold", "right of way", "resume")

NOTHING, DIVERT, KEEP, REFUSE, LEAVE, SEND_BACK = 0, 1, 2, 3, 4, 5
"""Do nothing; command a manoeuvre; go on with the one that is flown; say that there is none, with
the reasons; leave it to the others, without a manoeuvre; command the mission."""


def waits(state: int) -> bool:
    """Off its mission without a conflict: held, or sent back."""
    if state == HOLD:
        return True
    return state == RESUME


def consistent(state: int, off: bool) -> bool:
    """On its mission it is not off it, held or sent back it is."""
    if state == MISSION:
        return not off
    if waits(state):
        return off
    if state == CONFLICT:
        return True
    return state == RIGHT_OF_WAY


def says_what_is_so(state: int, off: bool, conflict: bool, ours: bool) -> bool:
    """The state is the one that its words describe."""
    if conflict and ours:
        return state == CONFLICT
    if conflict:
        return state == RIGHT_OF_WAY
    if off:
        return waits(state)
    return state == MISSION


def answered(ours: bool, off: bool, good: bool, found: bool, act: int) -> bool:
    """A conflict is answered: by a manoeuvre that is free, the one that is flown or a new one, by a
    refusal only if there is none. One that is not ours is left to the others, unless the vehicle is
    off its mission and what it flies is no longer free of zones."""
    if not ours and (good or not off):
        return act == LEAVE
    if off and good:
        return act == KEEP
    if found:
        return act == DIVERT
    return act == REFUSE


def held(good: bool, found: bool, act: int) -> bool:
    """Off its mission without a conflict the vehicle flies what is free, or it is said that nothing is."""
    if good:
        return act == KEEP
    if found:
        return act == DIVERT
    return act == REFUSE


def may_be_sent_back(conflict: bool, free: bool, lasted: bool) -> bool:
    """The mission is commanded only without a conflict, on a way that has been free for long enough."""
    return not conflict and free and lasted


def back(state: int, conflict: bool, taken: bool) -> bool:
    """A vehicle that was sent back is back when it says so, unless a conflict comes between."""
    return state == RESUME and not conflict and taken


def apart(value: float, low: float, high: float) -> float:
    """How far a value is from an interval, 0 inside of it and at its ends."""
    return max(low - value, value - high, 0)


def in_band(heading: float, low: float, high: float) -> bool:
    """A direction is in an interval if it is, in one of the ways to write it, at no distance from it.

    The heading is written in [0, 360), the interval lies within [0, 360].
    """
    return min(apart(heading, low, high), apart(heading + 360, low, high)) == 0


def soon(first: float, limit: float, early: float, answering: bool) -> bool:
    """No more time is left than the alerting time; a conflict that is there ends later than it began,
    with the greater of the two times."""
    spare = first - limit
    if answering and early > limit:
        spare = first - early
    return not spare > 0
