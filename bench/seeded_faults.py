"""The number of encounters until a seeded fault is found: by sampling, and by a search for small margins.

    python bench/seeded_faults.py [--starts 10] [--most 400] [--only far]

A run counts only if it fails with the fault and not without. Each start has seeds of its own. Only counts, medians
and CPU seconds are printed; a start in which nothing was found counts as more than `--most`.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from collections.abc import Iterable
from dataclasses import replace
from itertools import islice
from pathlib import Path
from statistics import median
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "tools"))

import yaml
from seeded_faults import seeded

from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.outcomes import Row, row_of
from cratous.services.campaign.runs import Run, runs_of
from cratous.services.campaign.search import BATCH, Search, fails
from cratous.services.cli.encounter_flight import fly_run
from cratous.services.loading.yaml_daa import DEFAULT_WELL_CLEAR

CAMPAIGNS = {
    "separation": (
        "separation",
        "G2",
        "generator: {kind: converging, intruders: 2, ranges: {time_s: [20, 50]}}\n"
        "options: [{name: narrow, set: {daa.buffer: 1.02}}]\n",
    ),
    "far": (
        "separation",
        "G2",
        "generator: {kind: converging, intruders: 2, ranges: {time_s: [30, 1000], miss_m: [-500, 500]}}\n"
        "options: [{name: narrow, set: {daa.buffer: 1.02}}]\n",
    ),
    "zone": (
        "zone",
        "G1",
        "generator: {kind: converging, zones_beside: 2,\n"
        "            ranges: {time_s: [30, 50], zone_gap_m: [2, 25], zone_place: [-0.7, 0]}}\nduration_s: 50\n",
    ),
    "waypoint": (
        "waypoint",
        "G3",
        "generator: {kind: random, intruders: 0, bends: 45,\n"
        "            ranges: {time_s: [290, 300], bend_m: [-150, 150]}}\nduration_s: 600\n",
    ),
}
"""By case: the fault, the requirement that it breaks, and the encounters. In `far` most of the intruder pairs are
still far away when the 60 s are over, so the fault seldom matters."""
APART = 1_000_000
"""The difference between the first seeds of two starts."""


class Found(Exception):
    """A run fails with the fault and not without."""


def campaign(case: str, start: int) -> Campaign:
    """The campaign of a case, with the seeds of a start."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "campaign.yaml"
        file.write_text(f"name: {case}\nkind: encounters\nseeds: [1, 2]\n{CAMPAIGNS[case][2]}")
        found = load_campaign(file, None, ())
    return replace(found, seeds=range(1 + start * APART, (start + 1) * APART))


def is_found(row: Row, requirement: str) -> bool:
    """Whether a run that fails with the fault satisfies the requirement without it."""
    return fails(row, requirement) and not fails(
        row_of(row.run, fly_run(row.run.decides), (requirement,)), requirement
    )


def flown(runs: Iterable[Run], fault: str, requirement: str) -> list[Row]:
    """The rows of these runs with the fault."""
    with seeded(fault):
        return [row_of(run, fly_run(run.decides), (requirement,)) for run in runs]


def sampled(case: str, start: int, most: int) -> int:
    """The number of samples until the fault is found; most + 1 if it is not."""
    (fault, requirement, _), runs = CAMPAIGNS[case], runs_of(campaign(case, start), "", True)
    many, near = islice(runs, most), list[tuple[int, Run]]()
    for place, run in enumerate(many, 1):
        if requirement != "G2" or can_meet(run):
            near.append((place, run))
        if near and (len(near) == BATCH or place == most):
            for (at, _), row in zip(
                near, flown((one for _, one in near), fault, requirement), strict=True
            ):
                if is_found(row, requirement):
                    return at
            near.clear()
    return most + 1


def can_meet(run: Run) -> bool:
    """Whether well clear could be lost before the encounter is over, whatever is flown; otherwise it need not be
    flown.

    The closing speed is at most the sum of the greatest speeds, and range over closing speed bounds modified tau from
    below.
    """
    data = yaml.load(run.decides["mission"], Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    (own,), duration_s = data["vehicles"], data["simulation"]["limit_s"]
    for other in data["traffic"]:
        speed_m_s = own["max_speed_m_s"] + math.hypot(*other["velocity"].values())
        places = [[one["position"][key] for key in ("north_m", "east_m")] for one in (own, other)]
        reach_m = DEFAULT_WELL_CLEAR.dthr_m + speed_m_s * (duration_s + DEFAULT_WELL_CLEAR.tthr_s)
        if math.dist(*places) <= reach_m:
            return True
    return False


def searched(case: str, start: int, most: int) -> int:
    """The number of runs of a search, in whole batches, until the fault is found; most + 1 if it is not."""
    (fault, requirement, _), count = CAMPAIGNS[case], 0

    def fly(runs: Iterable[Run]) -> list[Row]:
        nonlocal count
        rows = flown(runs, fault, requirement)
        count += len(rows)
        if any(is_found(row, requirement) for row in rows):
            raise Found
        return [replace(row, result=_spared(row, requirement)) for row in rows]

    try:
        Search(campaign(case, start), requirement, "", True).run(fly, most)
    except Found:
        return count
    return most + 1


def _spared(row: Row, requirement: str) -> dict[str, Any] | None:
    """The result for the search; if the run fails without the fault too, its verdict is changed to `holds`."""
    if row.result is None or not fails(row, requirement):
        return row.result
    found = row.result["requirements"]
    return {
        **row.result,
        "judge": None,
        "requirements": {**found, requirement: {**found[requirement], "verdict": "holds"}},
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=10)
    parser.add_argument("--most", type=int, default=400)
    parser.add_argument("--only", choices=sorted(CAMPAIGNS))
    parser.add_argument("--how", choices=("sampled", "searched"))
    asked = parser.parse_args()
    for case in [asked.only] if asked.only else CAMPAIGNS:
        for how in (sampled, searched):
            if asked.how and how.__name__ != asked.how:
                continue
            before, counts = time.process_time(), []
            for start in range(asked.starts):
                counts.append(how(case, start, asked.most))
                print(f"{case}, {how.__name__}: {counts[-1]}", file=sys.stderr, flush=True)
            spent = time.process_time() - before
            print(
                f"{case}, {how.__name__}: {counts}, median {median(counts):g}, {spent:.0f} CPU s",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
