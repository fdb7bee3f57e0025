"""The evidence for an excused loss, or for an available way out, in words and as data for the report."""

from __future__ import annotations

import math
from typing import Any

from cratous.core.excuse.record import Loss, Moment
from cratous.core.excuse.state import ANSWERS, FREE, NO_WAY, REFUSED, WAY_OUT, Tried

SHOW = {"hdir": ("deg", 180 / math.pi), "hs": ("m/s", 1.0), "vs": ("m/s", 1.0), "alt": ("m", 1.0)}
COLUMNS = (
    "dimension", "value", "unit", "refused by", "lost after s", "apart m", "above m",
    "lost after s (check)",
)  # fmt: skip


def target(one: Tried) -> str:
    """The manoeuvre in words."""
    unit, size = SHOW[one.dimension]
    return f"{one.dimension} to {one.value * size:.1f} {unit}"


def _free(moment: Moment) -> Tried | None:
    return next((t for t in moment.judgement.bands if t.answer == FREE), None)


def sentence(losses: list[Loss]) -> str:
    """Text on the losses of a pair for the note of a verdict."""
    for loss in losses:
        if loss.answer == WAY_OUT:
            moment = loss.moments[-1]
            free = _free(moment)
            how = f": {target(free)}" if free else ""
            return f"vehicle {loss.own} had a way out at {moment.time_ms / 1000:.2f} s{how}"
    for loss in losses:
        if loss.answer != NO_WAY:
            return f"no evidence that no way out existed: {loss.why}"
    if not losses:
        return "whether a way out existed is judged when what followed is known"
    moments = [m for loss in losses for m in loss.moments]
    tried = sum(len(m.judgement.bands) + len(m.judgement.check) for m in moments)
    return (
        f"no way out existed: {tried} manoeuvres from {len(moments)} instants, "
        "by the bands and by an independent check, all refused"
    )


def _counts(tried: tuple[Tried, ...]) -> list[int]:
    return [len(tried), sum(t.answer == REFUSED for t in tried)]


def _row(one: Tried, checked: Tried | None) -> list[Any]:
    unit, size = SHOW[one.dimension]
    again = checked.at_s if checked is not None else None
    numbers = (one.at_s, one.apart_m, one.above_m)
    return [
        one.dimension, round(one.value * size, 3), unit, one.by,
        *(None if x is None else round(x, 2) for x in numbers),
        None if again is None else round(again, 2),
    ]  # fmt: skip


def _same(moment: Moment) -> dict[tuple[str, float], Tried]:
    return {(t.dimension, round(t.value, 6)): t for t in moment.judgement.check}


def evidence(losses: list[Loss]) -> dict[str, Any]:
    """The evidence as data: each loss with the instants from which it was examined, and, where it
    is excused, every manoeuvre at the first instant with who refuses it, when, and how near.

    instants: [time_ms, tried and refused by the bands, tried and refused by the check].
    """
    found = []
    for loss in losses:
        first, last = loss.moments[0], loss.moments[-1]
        data: dict[str, Any] = {
            "own": loss.own,
            "other": loss.other,
            "lost_ms": loss.lost_ms,
            "answer": ANSWERS[loss.answer],
            "why": loss.why,
            "instants": [
                [m.time_ms, *_counts(m.judgement.bands), *_counts(m.judgement.check)]
                for m in loss.moments
            ],
        }
        if loss.answer == NO_WAY:
            check = _same(first)
            data["columns"] = list(COLUMNS)
            data["manoeuvres"] = [
                _row(t, check.get((t.dimension, round(t.value, 6)))) for t in first.judgement.bands
            ]
        elif loss.answer == WAY_OUT:
            free = _free(last)
            data["way_out"] = {
                "time_ms": last.time_ms,
                "manoeuvre": target(free) if free else "",
            }
        found.append(data)
    return {"losses": found}
