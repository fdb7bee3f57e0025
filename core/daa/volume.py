"""Whether and when a volume is violated in straight flight, for the kinds of volume that alert.

Definitions: `spec.daa.meaning`. The volumes are those of `core.well_clear`; a kind is a number as
in `spec.daa.parameters.DETECTORS`. Relative state is ownship minus intruder, in any horizontal frame.
"""

from cratous.core.kernel import Vec2, kernel
from cratous.core.well_clear.during import (
    violation_during_taumod,
    violation_during_tcpa,
    violation_during_tep,
)
from cratous.core.well_clear.interval import (
    Span,
    violation_interval_taumod,
    violation_interval_tcpa,
    violation_interval_tep,
)
from cratous.core.well_clear.thresholds import Thresholds


@kernel(implements="daa.meaning.violated_at")
def in_conflict(
    kind: int,
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> bool:
    """True iff the volume is violated at some t in [b_s, t_s] of straight flight.

    kind: 1 by tcpa, 2 by tep, 3 cylinder (tep with all times 0), any other by tau_mod;
    thresholds >= 0.
    """
    if kind == 1:
        return violation_during_tcpa(s, v, sz, vz, thresholds, b_s, t_s)
    if kind == 2 or kind == 3:
        return violation_during_tep(s, v, sz, vz, thresholds, b_s, t_s)
    return violation_during_taumod(s, v, sz, vz, thresholds, b_s, t_s)


@kernel(implements="daa.meaning.violated_at")
def conflict_span(
    kind: int,
    s: Vec2,
    v: Vec2,
    sz: float,
    vz: float,
    thresholds: Thresholds,
    b_s: float,
    t_s: float,
) -> Span:
    """First and last instant of [b_s, t_s] at which it is violated; Span(1, 0) if none.

    Arguments as for `in_conflict`.
    """
    if kind == 1:
        return violation_interval_tcpa(s, v, sz, vz, thresholds, b_s, t_s)
    if kind == 2 or kind == 3:
        return violation_interval_tep(s, v, sz, vz, thresholds, b_s, t_s)
    return violation_interval_taumod(s, v, sz, vz, thresholds, b_s, t_s)
