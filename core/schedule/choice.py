"""Whether what is planned or flown is one choice of a mission's tasks: each task as often as permitted.

Definition: `spec.schedule.flown_as_asked`.
"""

from cratous.core.kernel import fold, kernel


@kernel(implements="schedule.flown_as_asked")
def as_asked_step(ok: bool, least: int, most: int, times: int) -> bool:
    """Whether all tasks so far, and one more, are done as often as required.

    least, most: how often the task is to be done; times: how often it is, >= 0.
    """
    return ok and least <= times and times <= most


as_asked = fold(
    name="as_asked", implements="schedule.flown_as_asked", step=as_asked_step, start=True
)
