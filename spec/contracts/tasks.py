"""The nine states of a task service and its transitions, as a table.

Source: Rasmussen, Kingston, Humphrey, "A Brief Introduction to Unmanned Systems Autonomy Services (UxAS)", ICUAS
2018, VI.B.2. Where the paper is silent: a request that arrives before the task is initialised, or while it completes,
is kept and begun afterwards; a request that ends without having chosen this task releases it; a task whose plan is
withdrawn before or while it is flown completes; and completion reports whether the task was served. Requests are
numbered in increasing order; a newer one overrides, an older one does not. A reply to a request other than the task's
current one is stale.
"""

INIT, IDLE, SENSOR_REQUEST, OPTION_ROUTES, OPTIONS_PUBLISHED = 0, 1, 2, 3, 4
FINAL_ROUTES, OPTION_SELECTED, ACTIVE, COMPLETED = 5, 6, 7, 8
STATES = tuple(range(9))

INITIALISED, REQUESTED, SENSORS_KNOWN, ROUTES_KNOWN, CHOSEN, FINAL_KNOWN = 1, 2, 3, 4, 5, 6
LISTED, UNLISTED, ENDED, WITHDRAWN, PROCEED = 7, 8, 9, 10, 11
EVENTS = tuple(range(1, 12))
"""The task is ready; a newer request names it; sensor footprints, option routes, the choice of an option and final
routes arrive for its request; a vehicle's state lists the task or no longer does; the request was answered; the plan
that contains it is withdrawn; no further event at this instant.
"""

NOTHING, ANNOUNCE, ASK_SENSORS, ASK_ROUTES, PUBLISH_OPTIONS = 0, 1, 2, 3, 4
ASK_FINAL, PUBLISH_PLAN, STEER, COMPLETE, STALE = 5, 6, 7, 8, 9

TABLE = {
    (INIT, INITIALISED): (IDLE, ANNOUNCE),
    (INIT, REQUESTED): (INIT, NOTHING),
    (IDLE, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (SENSOR_REQUEST, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (OPTION_ROUTES, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (OPTIONS_PUBLISHED, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (FINAL_ROUTES, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (OPTION_SELECTED, REQUESTED): (SENSOR_REQUEST, ASK_SENSORS),
    (ACTIVE, REQUESTED): (COMPLETED, COMPLETE),
    (COMPLETED, REQUESTED): (COMPLETED, NOTHING),
    (SENSOR_REQUEST, SENSORS_KNOWN): (OPTION_ROUTES, ASK_ROUTES),
    (OPTION_ROUTES, ROUTES_KNOWN): (OPTIONS_PUBLISHED, PUBLISH_OPTIONS),
    (OPTIONS_PUBLISHED, CHOSEN): (FINAL_ROUTES, ASK_FINAL),
    (FINAL_ROUTES, FINAL_KNOWN): (OPTION_SELECTED, PUBLISH_PLAN),
    (OPTION_SELECTED, LISTED): (ACTIVE, STEER),
    (ACTIVE, UNLISTED): (COMPLETED, COMPLETE),
    (SENSOR_REQUEST, ENDED): (IDLE, NOTHING),
    (OPTION_ROUTES, ENDED): (IDLE, NOTHING),
    (OPTIONS_PUBLISHED, ENDED): (IDLE, NOTHING),
    (FINAL_ROUTES, ENDED): (IDLE, NOTHING),
    (OPTION_SELECTED, WITHDRAWN): (COMPLETED, COMPLETE),
    (ACTIVE, WITHDRAWN): (COMPLETED, COMPLETE),
}
"""(state, event) -> (next state, act), for replies and answers to the task's current request. A reply without a row,
or to another request, is stale and changes nothing; any other event without a row is ignored silently. PROCEED begins
a request that was kept, in IDLE and COMPLETED; without one, COMPLETED becomes IDLE.
"""

REPLIES = (SENSORS_KNOWN, ROUTES_KNOWN, CHOSEN, FINAL_KNOWN)
ABOUT_ITS_REQUEST = (*REPLIES, ENDED)
KEPT_IN = (INIT, COMPLETED)
"""States in which a newer request is kept; the task is in ACTIVE for one step before COMPLETED."""


def row(state: int, event: int) -> tuple[int, int]:
    """Next state and act for an event of the task's current request."""
    for (before, met), (after, act) in TABLE.items():
        if state == before and event == met:
            return after, act
    return state, STALE if event in REPLIES else NOTHING
