"""Search for small margins: values of the drawn parameters for which a requirement fails, and a
simplified mission.

Cross-entropy method: a first batch of missions is drawn uniformly from the whole space; then the
best so far (those with the least margins) determine mean and spread for the next batch; non-numeric
parameters (sides, values of a list) are drawn with their frequency among the best. A batch is
complete before the next begins, and its draws depend only on its number, so that workers and losses
have no influence.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from random import Random
from statistics import fmean, pstdev
from typing import Any

from cratous.services.campaign.definition import Campaign
from cratous.services.campaign.generators import CASES
from cratous.services.campaign.outcomes import Row
from cratous.services.campaign.runs import Made, Run
from cratous.spec.errors import BadInput
from cratous.spec.mission.guarantees import Outcome

BATCH, ELITE = 10, 3
LEAST_SPREAD = 0.03
"""Minimum spread as a fraction of a range, so that the search continues."""
UNIFORM = 2
"""Missions per batch drawn from the whole space, so that no part of it is abandoned."""
OTHERWISE = 0.1
"""Probability of drawing a choice uniformly again."""
DIGITS = (-1, 0, 1, 2)
PARTS = ("traffic", "zones", "changes")

Fly = Callable[[Iterable[Run]], list[Row]]
"""Flies runs and returns their rows in order."""


@dataclass
class Found:
    """The result of a search: every point with its margin, and the failing run if there is one."""

    requirement: str
    points: list[dict[str, Any]] = field(default_factory=list)
    failing: Row | None = None
    small: dict[str, Any] | None = None
    """The simplified mission of the failing run, which fails too."""


class Search:
    """One search: for a requirement, under the first option, over the first mission or the
    generator.

    Its missions are numbered from the campaign's first seed on; another first seed gives another
    search.
    """

    def __init__(
        self, campaign: Campaign, requirement: str, version: str, allow_unproved: bool
    ) -> None:
        if len(campaign.missions) > 1 or len(campaign.options) > 1:
            raise BadInput(
                "a search is in one space", item="missions, options",
                expected="one mission or a generator, and one option",
                got=f"{len(campaign.missions)} missions, {len(campaign.options)} options",
            )  # fmt: skip
        generator = campaign.generator or {}
        if generator.get("apart_m", 0):
            raise BadInput(
                "a search draws no intruder anew", item="generator.apart_m",
                expected="none, and ranges in which intruders start far enough away",
                got=f"{generator['apart_m']:g} m",
            )  # fmt: skip
        made = generator.get(CASES, {})
        if any(set(case) - {"set"} for cases in made.values() for case in cases.values()):
            raise BadInput(
                "a search is in one space", item=f"generator.{CASES}",
                expected="cases that set values of the mission alone", got="other ranges or counts",
            )  # fmt: skip
        self._campaign, self._requirement = campaign, requirement
        self._version, self._allow_unproved = version, allow_unproved
        self._first = campaign.seeds.start if campaign.seeds else 1
        made = self._made(self._first, {})
        self._space = {
            name: (low, high) for name, (low, high) in sorted(made.bounds.items()) if low < high
        }
        self._choices = dict(sorted(made.choices.items()))
        if not self._space:
            raise BadInput(
                "nothing to search in",
                item="vary",
                expected="a generator, or values with a range in `vary`",
            )

    def _made(self, number: int, point: dict[str, Any]) -> Made:
        source = self._campaign.missions[0] if self._campaign.missions else None
        return Made(self._campaign, source, self._campaign.options[0], number, point)

    def run(self, fly: Fly, budget: int) -> Found:
        """Search with at most `budget` runs, then simplify a failing run with at most half as many more."""
        found = Found(self._requirement)
        while len(found.points) < budget and found.failing is None:
            count = len(found.points)
            numbers = range(self._first + count, self._first + min(budget, count + BATCH))
            points = [self._point(number, found) for number in numbers]
            made = [self._made(n, p) for n, p in zip(numbers, points, strict=True)]
            rows = fly(one.run(self._version, self._allow_unproved) for one in made)
            for point, row in zip(points, rows, strict=True):
                entry = {"run": row.run.name, "outcome": row.outcome, "values": point}
                found.points.append({**entry, "margin": margin(row, self._requirement)})
            bad = [k for k, row in enumerate(rows) if fails(row, self._requirement)]
            if bad:
                worst = min(bad, key=lambda k: _rank(found.points[k - len(rows)]))
                found.failing = rows[worst]
                found.small = self._small(
                    fly, made[worst], points[worst], numbers[worst], budget // 2
                )
        return found

    def _point(self, number: int, found: Found) -> dict[str, Any]:
        """The values of a point: of a batch, around the best so far."""
        batch, place = divmod(number - self._first, BATCH)
        told = [p for p in found.points[: batch * BATCH] if p["margin"] is not None]
        best = sorted(told, key=_rank)[:ELITE]
        drawn = place < UNIFORM or not best
        point: dict[str, Any] = {}
        for name, (low, high) in self._space.items():
            random = Random(f"search {number} {name}")
            part = random.random() if batch else (self._part(name, place) + random.random()) / BATCH
            value = low + part * (high - low)
            if not drawn:
                values = [p["values"][name] for p in best]
                spread = max(pstdev(values), LEAST_SPREAD * (high - low))
                value = min(high, max(low, random.gauss(fmean(values), spread)))
            point[name] = round(value, 3)
        for name, choices in self._choices.items():
            random = Random(f"search {number} {name}")
            anew = drawn or random.random() < OTHERWISE
            point[name] = random.choice(choices if anew else [p["values"][name] for p in best])
        return point

    def _part(self, name: str, place: int) -> int:
        """The stratum of a range for a point of the first batch: each is used once (Latin hypercube)."""
        parts = list(range(BATCH))
        Random(f"search {self._first} parts {name}").shuffle(parts)
        return parts[place]

    def _small(
        self, fly: Fly, made: Made, point: dict[str, Any], number: int, budget: int
    ) -> dict[str, Any]:
        """The failing mission with rounder values and fewer parts, as long as it fails."""
        left = [budget]

        def still(one: Made) -> bool:
            left[0] -= 1
            (row,) = fly([one.run(self._version, self._allow_unproved)])
            return fails(row, self._requirement)

        for name in self._space:
            for digits in DIGITS:
                value = float(round(point[name], digits))
                rounder = {**point, name: value}
                low, high = self._space[name]
                if value == point[name] or left[0] <= 0 or not low <= value <= high:
                    continue
                one = self._made(number, rounder)
                if still(one):
                    made, point = one, rounder
                    break
        for part in PARTS:
            for k in reversed(range(len(made.data.get(part, [])))):
                one = made.of(_without(made.data, part, k))
                if left[0] > 0 and still(one):
                    made = one
        return made.data


def _without(mission: dict[str, Any], part: str, k: int) -> dict[str, Any]:
    """The mission without one element."""
    data = copy.deepcopy(mission)
    del data[part][k]
    if not data[part]:
        del data[part]
    return data


def margin(row: Row, requirement: str) -> float | None:
    """Margin of a run to failure; None if it was not flown or nothing was measured."""
    found = row.requirement(requirement)
    return None if found is None else found["margin"]


def fails(row: Row, requirement: str) -> bool:
    """Whether a run was flown and violates the requirement, or judge and monitor disagree on it."""
    found = row.requirement(requirement)
    if found is None:
        return False
    judge = (row.result or {}).get("judge") or {}
    disputed = any(d["guarantee"] == requirement for d in judge.get("disagreements", []))
    return found["verdict"] == Outcome.VIOLATED or disputed


def _rank(point: dict[str, Any]) -> float:
    return float("inf") if point["margin"] is None else point["margin"]
