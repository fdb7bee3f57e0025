"""Whether a way out existed from one state: by the bands' manoeuvres and by the independent check.

Definitions: `spec.excuse`. The answer is the one that both give; if they differ, or if one could not decide, it is
undecided, and `why` gives the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cratous.core.daa.engine import alerter_index, errors_of, region_level, states, thresholds
from cratous.core.daa.session import checked
from cratous.core.daa.state import Aircraft
from cratous.core.excuse import bands as excuse_bands
from cratous.core.excuse import exhaustive_check as excuse_check
from cratous.core.excuse.state import ANSWERS, OPEN, Judgement, Other, Tried, straight
from cratous.core.excuse.way_out import both_say
from cratous.spec.daa.parameters import TAUMOD, TAUMOD_SUM, Parameters


def judged(
    p: Parameters, own: Aircraft, others: Sequence[Other], horizon_s: float, why: str = ""
) -> Judgement:
    """The judgement from a state, with other aircraft flying as given; why: what is undecided from the outset."""
    by_bands, bands, outside = excuse_bands.judge(p, own, others, horizon_s)
    by_check, check, beyond = excuse_check.judge(p, own, others, horizon_s)
    reasons = [why, outside] if outside == beyond else [why, outside, beyond]
    if by_bands != by_check:
        said = f"the bands say {ANSWERS[by_bands]}, the check says {ANSWERS[by_check]}"
        reasons.append(said)
    elif by_bands == OPEN:
        reasons.append(_open(bands))
    answer = OPEN if why else both_say(by_bands, by_check)
    found = "; ".join(r for r in reasons if r) if answer == OPEN else ""
    return Judgement(answer, by_bands, by_check, bands, check, found)


def _open(tried: Iterable[Tried]) -> str:
    count = sum(t.answer == OPEN for t in tried)
    if not count:
        return ""
    return (
        f"{count} manoeuvres meet a volume by a hair only, or another aircraft is not known there"
    )


def from_state(p: Parameters, own: Aircraft, aircraft: Sequence[Aircraft]) -> Judgement:
    """The judgement from a state, with all other aircraft in straight flight: for the corrective volumes, within the
    look-ahead.

    An aircraft without an alerter, or whose alerter has no corrective region, is ignored, as in the bands. With
    uncertainties the result is undecided, because a state known only within bounds cannot be judged. Raises BadInput
    for unusable states.
    """
    checked(own, aircraft)
    found, unsure = [], []
    for other, state in zip(aircraft, states(aircraft).tolist(), strict=True):
        index = alerter_index(p, own, other)
        level = region_level(p.alerters[index], p.corrective_region) if index >= 0 else None
        if level is None:
            continue
        volume = thresholds(level[1].volume, own.alt_m)
        kind = volume.kind
        if kind == TAUMOD_SUM:
            kind = TAUMOD
            if errors_of(p, own, other)[:5].any():
                unsure.append(other.id)
        pieces = straight(tuple(state), p.lookahead_time_s)
        found.append(Other(other.id, pieces, kind, volume[1:]))
    why = f"known only within bounds: {', '.join(unsure)}" if unsure else ""
    return judged(p, own, found, p.lookahead_time_s, why)
