"""What no report can show (stated in every report), and how ICAROUS obtained its traffic states."""

from __future__ import annotations

from cratous.spec.mission import Mission
from cratous.spec.mission.sensing import EXACT_STATES

LIMITS = (
    "Python and z3 are not qualified tools, so this is evidence, not certification credit.",
    "Proofs hold for the kernels in real arithmetic; the compiled kernels compute in doubles.",
    "The flight is a simulation with point-mass aircraft that hold their speed over the ground as the "
    "known wind allows, without gusts.",
    "Distances are taken in one local tangent frame; its scale error is stated below.",
    "Terrain is flat at the stated height.",
    "A loss is excused only if every manoeuvre of its set fails from every instant of the look-ahead "
    "before it, others flying as recorded. The set is one change at a time: direction, speed, climb "
    "rate or altitude, on a grid; zones and the ground below flight are no reason to refuse one.",
)


def of_states(mission: Mission) -> list[str]:
    """How ICAROUS obtained its traffic states, so that they are not mistaken for measurements of real sensors."""
    return said_of_states(bool(mission.instances), mission.sensing is not None)


def said_of_states(avoids: bool, sensed: bool) -> list[str]:
    """The same text. avoids: some vehicle avoids traffic; sensed: by simulated sensors, else by the true states."""
    if not avoids:
        return []
    if not sensed:
        return [f"{EXACT_STATES}."]
    return [
        "The sensors' errors are normal, independent of each other and known; those of real ones are not. "
        "UxAS, the autopilots and the verdicts have the true states."
    ]
