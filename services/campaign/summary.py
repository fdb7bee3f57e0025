"""`campaign.json`: the complete result of a campaign, from its definition and the runs' results
alone.

The same definition and results give the same bytes, whatever the order, number of workers and
losses; so losses are recorded in the store, not here.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from cratous import __version__
from cratous.services.campaign.definition import Campaign
from cratous.services.campaign.outcomes import IMPOSSIBLE, LOST, ORDER, Row, code_of
from cratous.services.campaign.statistics import LEVEL, distribution, paired, rate
from cratous.spec.mission.guarantees import Outcome

FORMAT = "cratous-campaign/1"
HOLDS, VIOLATED = str(Outcome.HOLDS), str(Outcome.VIOLATED)
WORST = 10
BINS = 10
MOST_REASONS = 20


def build(campaign: Campaign, rows: list[Row], version: str) -> dict[str, Any]:
    """The whole summary as plain data."""
    outcomes = Counter(row.outcome for row in rows)
    model = _model(rows) if campaign.model else None
    groups = [
        _group(campaign, mission, option, group)
        for (mission, option), group in _grouped(rows, lambda r: (r.run.mission, r.run.option))
    ]
    return {
        "format": FORMAT,
        "product": {"name": "CRATOUS", "version": __version__, "digest": version},
        "name": campaign.name,
        "description": campaign.description,
        "requirements": list(campaign.requirements),
        "own": [file.named for file in campaign.own],
        "judged": campaign.judge,
        "disagreements": _disagreements(rows),
        "model": model,
        "runs_in_all": len(rows),
        "outcomes": {name: outcomes[name] for name in ORDER if outcomes[name]},
        "exit_code": code_of(set(outcomes), asked=model is None or model["fits"] > 0),
        "limits": list(_limits(campaign, rows)),
        "groups": groups,
        "comparisons": _comparisons(campaign, rows),
        "covered": _covered(rows),
        "reasons": _reasons(rows),
        "worst": [row.run.name for row in worst(rows, campaign.requirements)],
        "runs": [_run(row) for row in rows],
    }


def text_of(summary: dict[str, Any]) -> str:
    """The text of campaign.json, with one run per line."""
    said = json.JSONEncoder(sort_keys=True, ensure_ascii=False, allow_nan=False)
    runs = ",".join(f"\n  {said.encode(run)}" for run in summary["runs"])
    whole = {**summary, "runs": []}
    text = json.dumps(whole, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False)
    before, mark, after = text.partition('\n "runs": [')
    return f"{before}{mark}{runs}{after}\n"


def worst(rows: list[Row], requirements: tuple[str, ...]) -> list[Row]:
    """The worst flights: by outcome, then by the least margin in metres of a requirement."""

    def place(row: Row) -> tuple[int, float]:
        found = [row.requirement(name) for name in requirements]
        margins = [r["margin"] for r in found if r and r["unit"] == "m" and r["margin"] is not None]
        return ORDER.index(row.outcome), min(margins, default=float("inf"))

    return sorted((row for row in rows if row.flown), key=place)[:WORST]


def _grouped(rows: list[Row], key: Callable[[Row], Any]) -> list[tuple[Any, list[Row]]]:
    """Rows grouped by a key, in order of first occurrence."""
    found: dict[Any, list[Row]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return list(found.items())


def _disagreements(rows: list[Row]) -> int:
    """Number of runs in which judge and monitor disagree, on any requirement."""
    return sum(bool(((row.result or {}).get("judge") or {}).get("disagreements")) for row in rows)


def _model(rows: list[Row]) -> dict[str, int]:
    """Number of logs that fit the proved steps, that do not, and without ICAROUS; and the events in
    those that fit.
    """
    found = [r.result["model"] for r in rows if r.flown and r.result and r.result["model"]]
    fits = [one for one in found if one["fits"]]
    return {
        "fits": len(fits),
        "does_not_fit": sum(one["fits"] is False for one in found),
        "not_asked": sum(one["fits"] is None for one in found),
        "events": sum(one["events"] for one in fits),
    }


def _limits(campaign: Campaign, rows: list[Row]) -> Iterator[str]:
    """Caveats needed to interpret the numbers."""
    if campaign.random:
        yield (
            f"Intervals are exact binomial ones ({LEVEL:.0%}, Clopper and Pearson), rounded outwards. "
            "They speak of the distribution that the seeds draw from, not of flights in general."
        )
    else:
        yield "Nothing was drawn at random, so shares are counts and say nothing beyond these runs."
    lost = sum(row.outcome == LOST for row in rows)
    if lost:
        yield f"{lost} runs were lost and count as not holding; they may be unlike those that were flown."
    refused = sum(row.outcome == IMPOSSIBLE for row in rows)
    if refused:
        yield f"{refused} missions were refused as they were made; rates are over the others."
    if not campaign.judge:
        yield "The independent judge was not asked."
    elif campaign.own:
        yield "Requirements of one's own were judged by the monitor alone; the judge knows G1 to G5."
    if any(row.result and not row.result.get("proved", True) for row in rows):
        yield "Kernels without proof were flown, so no run is better than unknown."


def _group(campaign: Campaign, mission: str, option: str, rows: list[Row]) -> dict[str, Any]:
    """One mission (or generator) under one option."""
    asked = [row for row in rows if row.outcome != IMPOSSIBLE]
    flown = [row for row in rows if row.flown]
    outcomes = Counter(row.outcome for row in rows)
    return {
        "mission": mission,
        "option": option,
        "runs": len(rows),
        "flown": len(flown),
        "outcomes": {name: outcomes[name] for name in ORDER if outcomes[name]},
        "not_holding": rate(
            sum(row.outcome != HOLDS for row in asked), len(asked), campaign.random
        ),
        "requirements": {
            name: _requirement(flown, name, campaign.random) for name in campaign.requirements
        },
        "takeovers": distribution([row.result["takeovers"] for row in flown if row.result]),
        "disagreements": _disagreements(rows),
    }


def _requirement(flown: list[Row], name: str, random: bool) -> dict[str, Any]:
    found = [row for row in (r.requirement(name) for r in flown) if row is not None]
    margins: dict[str, list[float]] = {}
    for row in found:
        if row["margin"] is not None:
            margins.setdefault(row["unit"], []).append(row["margin"])
    return {
        "violated": rate(sum(r["verdict"] == VIOLATED for r in found), len(found), random),
        "not_holding": rate(sum(r["verdict"] != HOLDS for r in found), len(found), random),
        "margins": {unit: distribution(values) for unit, values in sorted(margins.items())},
    }


def _comparisons(campaign: Campaign, rows: list[Row]) -> list[dict[str, Any]]:
    """Each further option compared with the first, on the same missions and seeds."""
    by = {(row.run.mission, row.run.seed, row.run.option): row for row in rows}
    first, *others = (option.name for option in campaign.options)
    found = []
    for other in others:
        pairs = [
            (row, by[mission, seed, other])
            for (mission, seed, option), row in by.items()
            if option == first and row.flown and by[mission, seed, other].flown
        ]
        found.append(
            {
                "first": first,
                "second": other,
                "left_out": len(rows) // len(campaign.options) - len(pairs),
                "requirements": {
                    name: _compared(pairs, name, campaign.random) for name in campaign.requirements
                },
            }
        )
    return found


def _compared(pairs: list[tuple[Row, Row]], name: str, random: bool) -> dict[str, Any]:
    kept, gains = [], []
    for one, two in pairs:
        a, b = one.requirement(name), two.requirement(name)
        if a is None or b is None:
            continue
        kept.append((a["verdict"] == HOLDS, b["verdict"] == HOLDS))
        if a["margin"] is not None and b["margin"] is not None and a["unit"] == b["unit"] == "m":
            gains.append(round(b["margin"] - a["margin"], 6))
    return {**paired(kept, random), "gain_m": distribution(gains)}


def _covered(rows: list[Row]) -> dict[str, Any]:
    """For each drawn number the range covered, and the part of it with failures."""
    values: dict[str, list[tuple[float, bool]]] = {}
    for row in rows:
        if row.flown:
            for name, value in row.drawn.items():
                if isinstance(value, (int, float)) and not isinstance(value, bool):
                    values.setdefault(name, []).append((value, row.outcome == HOLDS))
    found = {}
    for name, drawn in sorted(values.items()):
        low, high = min(value for value, _ in drawn), max(value for value, _ in drawn)
        bins = [[0, 0] for _ in range(BINS)]
        for value, holds in drawn:
            share = (value - low) / (high - low) if high > low else 0.0
            place = bins[min(BINS - 1, int(BINS * share))]
            place[0] += 1
            place[1] += not holds
        found[name] = {"low": low, "high": high, "bins": bins}
    return found


def _reasons(rows: list[Row]) -> list[dict[str, Any]]:
    """Why missions were not flown to an end, most frequent reasons first."""
    told = Counter((row.outcome, row.why) for row in rows if not row.flown)
    ranked = sorted(told.items(), key=lambda item: (-item[1], item[0]))
    return [
        {"outcome": outcome, "why": why, "count": count}
        for (outcome, why), count in ranked[:MOST_REASONS]
    ]


def _run(row: Row) -> dict[str, Any]:
    return {
        "id": row.run.id,
        "name": row.run.name,
        "mission": row.run.mission,
        "option": row.run.option,
        "seed": row.run.seed,
        "drawn": row.drawn,
        "outcome": row.outcome,
        "why": "" if row.outcome == HOLDS else row.why,
        "result": row.result,
    }
