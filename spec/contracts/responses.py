"""Responding to a predicted loss of well clear, on the bus, and returning to the mission: what must hold.

A vehicle is in one of five states, which describe the present situation: it flies its mission (MISSION); it has to
avoid a conflict itself (CONFLICT); others have to avoid a conflict (RIGHT_OF_WAY); there is no conflict any more but
the vehicle is off its mission (HOLD); it has been sent back (RESUME). Sources of the five states: the response
service of OpenUxAS and the resolution logic of ICAROUS; the requirements on them are this project's own.

The inputs at an instant are: `conflict`, a loss is predicted soon; `ours`, this vehicle has to act; `good`, the
manoeuvre being flown is still free of zones and of conflicts that are ours; `found`, some manoeuvre is free of both;
`free`, the way back is free; `lasted`, it has been free, or a command has been without effect, for long enough;
`taken`, the vehicle reports that it flies its mission.
"""

MISSION, CONFLICT, HOLD, RIGHT_OF_WAY, RESUME = 0, 1, 2, 3, 4
STATES = ("on mission", "in conflict", "on hold", "right of way", "resume")

NOTHING, DIVERT, KEEP, REFUSE, LEAVE, SEND_BACK = 0, 1, 2, 3, 4, 5
"""Do nothing; command a manoeuvre; continue the one being flown; report that there is none, with the reasons; leave
the conflict to the others, without a manoeuvre; command the mission.
"""


def waits(state: int) -> bool:
    """The vehicle is off its mission without a conflict: holding, or sent back."""
    if state == HOLD:
        return True
    return state == RESUME


def consistent(state: int, off: bool) -> bool:
    """State and flag agree: in MISSION the vehicle is not off its mission; holding or sent back it is."""
    if state == MISSION:
        return not off
    if waits(state):
        return off
    if state == CONFLICT:
        return True
    return state == RIGHT_OF_WAY


def says_what_is_so(state: int, off: bool, conflict: bool, ours: bool) -> bool:
    """The state describes the present situation."""
    if conflict and ours:
        return state == CONFLICT
    if conflict:
        return state == RIGHT_OF_WAY
    if off:
        return waits(state)
    return state == MISSION


def answered(ours: bool, off: bool, good: bool, found: bool, act: int) -> bool:
    """A conflict is answered by a free manoeuvre, the present one or a new one, and by a refusal only if there is
    none. A conflict that is not ours is left to the others, unless the vehicle is off its mission and what it flies
    is no longer free of zones.
    """
    if not ours and (good or not off):
        return act == LEAVE
    if off and good:
        return act == KEEP
    if found:
        return act == DIVERT
    return act == REFUSE


def held(good: bool, found: bool, act: int) -> bool:
    """Off its mission without a conflict, the vehicle flies a free manoeuvre, or reports that there is none."""
    if good:
        return act == KEEP
    if found:
        return act == DIVERT
    return act == REFUSE


def may_be_sent_back(conflict: bool, free: bool, lasted: bool) -> bool:
    """The mission is commanded only without a conflict, and when the way back has been free for long enough."""
    return not conflict and free and lasted


def back(state: int, conflict: bool, taken: bool) -> bool:
    """A vehicle that was sent back has returned once it reports so, unless a conflict intervenes."""
    return state == RESUME and not conflict and taken


def apart(value: float, low: float, high: float) -> float:
    """The distance of a value from an interval; 0 inside it and at its ends."""
    return max(low - value, value - high, 0)


def in_band(heading: float, low: float, high: float) -> bool:
    """A direction lies in an interval if one of its representations (plus 0 or 360) has distance 0 from it.

    The heading is in [0, 360), the interval within [0, 360]. Degrees.
    """
    return min(apart(heading, low, high), apart(heading + 360, low, high)) == 0


def soon(first: float, limit: float, early: float, answering: bool) -> bool:
    """The time left is at most the alerting time; during a conflict the greater of the two times applies, so that it
    ends later than it began (hysteresis).
    """
    spare = first - limit
    if answering and early > limit:
        spare = first - early
    return not spare > 0
