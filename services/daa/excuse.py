"""Whether a resolution existed: the judgement of a step of an encounter, in words and as data.

`core.excuse.judgement` judges; this module reports it: how many manoeuvres are free, and which intruder, when
and how closely rules out the others.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

from cratous.core.excuse.judgement import from_state
from cratous.core.excuse.state import ANSWERS, FREE, REFUSED, Judgement, Tried
from cratous.services.daa import Step, aircraft
from cratous.services.daa.explain import value_text

__all__ = ["as_data", "excuse_text", "judge_step"]


def judge_step(step: Step) -> Judgement:
    """Whether a resolution exists at this step, if all others fly straight on."""
    found, _ = aircraft(step.rows)
    return from_state(step.parameters, found[0], found[1:])


def _groups(tried: tuple[Tried, ...]) -> dict[str, list[Tried]]:
    groups: dict[str, list[Tried]] = {}
    for one in tried:
        groups.setdefault(one.dimension, []).append(one)
    return groups


def excuse_text(time_s: float, judgement: Judgement) -> list[str]:
    """The judgement in words: one line, and one per dimension."""
    head = f"time {time_s:g} s: {ANSWERS[judgement.answer]}"
    if judgement.why:
        head += f" ({judgement.why})"
    lines = [head]
    everything = judgement.bands + judgement.check
    if everything and all(t.at_s == 0.0 for t in everything):
        names = ", ".join(sorted({t.by for t in everything}))
        return [f"{head}: well clear of {names} is lost already"]
    check = _groups(judgement.check)
    for dimension, group in _groups(judgement.bands).items():
        again = sum(t.answer == REFUSED for t in check.get(dimension, []))
        refused = [t for t in group if t.answer == REFUSED]
        text = (
            f"  {dimension}: {len(group)} manoeuvres, {len(refused)} refused by the bands, "
            f"{again} by the check"
        )
        free = [t for t in group if t.answer == FREE]
        if free:
            text += f"; free: {value_text(dimension, free[0].value)}"
            if len(free) > 1:
                text += f" and {len(free) - 1} more"
        elif refused:
            by = ", ".join(
                f"{name} {count}" for name, count in Counter(t.by for t in refused).items()
            )
            latest = max(refused, key=lambda t: t.at_s or 0.0)
            text += (
                f" (by {by}); the latest: {value_text(dimension, latest.value)} loses "
                f"{latest.by} after {latest.at_s or 0.0:.1f} s, {latest.apart_m or 0.0:.0f} m apart "
                f"and {latest.above_m or 0.0:.0f} m vertically"
            )
        lines.append(text)
    return lines


def as_data(time_s: float, judgement: Judgement) -> dict[str, Any]:
    """The judgement as data: all manoeuvres of both judges."""

    def rows(tried: tuple[Tried, ...]) -> list[dict[str, Any]]:
        return [t._asdict() for t in tried]

    assert math.isfinite(time_s)
    return {
        "time_s": time_s,
        "answer": ANSWERS[judgement.answer],
        "by_bands": ANSWERS[judgement.by_bands],
        "by_check": ANSWERS[judgement.by_check],
        "why": judgement.why,
        "bands": rows(judgement.bands),
        "check": rows(judgement.check),
    }
