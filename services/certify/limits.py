"""What no report shows, whatever was flown: every report says it."""

from __future__ import annotations

LIMITS = (
    "Python and z3 are not qualified tools, so this is evidence, not certification credit.",
    "Proofs hold for the kernels in real arithmetic; the compiled kernels compute in doubles.",
    "The flight is a simulation with point-mass aircraft that hold their speed over the ground as the "
    "known wind allows, without gusts and sensor error.",
    "Distances are taken in one local tangent frame; its scale error is stated below.",
    "Terrain is flat at the stated height.",
    "A loss is excused only if every manoeuvre of its set fails from every instant of the look-ahead "
    "before it, others flying as recorded. The set is one change at a time: direction, speed, climb "
    "rate or altitude, on a grid; zones and the ground below flight are no reason to refuse one.",
)
