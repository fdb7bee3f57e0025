"""After how many encounters is a seeded fault found: by sampling, and by a search for small margins.

    python bench/seeded_faults.py [--starts 10] [--most 400] [--only zone]

A run counts only if it fails with the fault and not without. Each start has seeds of its own. Nothing is printed but
counts, medians and CPU seconds; a start in which nothing was found counts as more than `--most`.
"""

from __future__ import annotations

import argparse
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

from seeded_faults import seeded

from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.outcomes import Row, row_of
from cratous.services.campaign.runs import Run, runs_of
from cratous.services.campaign.search import BATCH, Search, fails
from cratous.services.cli.encounter_flight import fly_run

CAMPAIGNS = {
    "separation": (
        "G2",
        "generator: {kind: converging, ranges: {time_s: [35, 50]}}\n"
        "options: [{name: narrow, set: {daa.buffer: 1.02}}]\n",
    ),
    "zone": (
        "G1",
        "generator: {kind: converging, zones_beside: 2,\n"
        "            ranges: {time_s: [30, 50], zone_gap_m: [2, 25], zone_place: [-0.7, 0]}}\nduration_s: 50\n",
    ),
    "waypoint": (
        "G3",
        "generator: {kind: random, intruders: 0, bends: 45,\n"
        "            ranges: {time_s: [290, 300], bend_m: [-150, 150]}}\nduration_s: 600\n",
    ),
}
APART = 1_000_000
"""Between the first seeds of two starts."""


class Found(Exception):
    """A run fails with the fault and not without."""


def campaign(fault: str, start: int) -> Campaign:
    """The campaign of a fault, with the seeds of a start."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "campaign.yaml"
        file.write_text(f"name: {fault}\nkind: encounters\nseeds: [1, 2]\n{CAMPAIGNS[fault][1]}")
        found = load_campaign(file, None, ())
    return replace(found, seeds=range(1 + start * APART, (start + 1) * APART))


def is_found(row: Row, requirement: str) -> bool:
    """Whether a run that fails with the fault holds without it."""
    return fails(row, requirement) and not fails(
        row_of(row.run, fly_run(row.run.decides), (requirement,)), requirement
    )


def flown(runs: Iterable[Run], fault: str, requirement: str) -> list[Row]:
    """The rows of runs, with the fault."""
    with seeded(fault):
        return [row_of(run, fly_run(run.decides), (requirement,)) for run in runs]


def sampled(fault: str, start: int, most: int) -> int:
    """After how many seeds it is found; most + 1 if it is not."""
    requirement, runs = CAMPAIGNS[fault][0], runs_of(campaign(fault, start), "", True)
    size = 1 if fault == "separation" else BATCH
    for count in range(0, most, size):
        rows = flown(islice(runs, size), fault, requirement)
        for place, row in enumerate(rows, 1):
            if is_found(row, requirement):
                return count + place
    return most + 1


def searched(fault: str, start: int, most: int) -> int:
    """After how many runs of a search, whole batches, it is found; most + 1 if it is not."""
    requirement, count = CAMPAIGNS[fault][0], 0

    def fly(runs: Iterable[Run]) -> list[Row]:
        nonlocal count
        rows = flown(runs, fault, requirement)
        count += len(rows)
        if any(is_found(row, requirement) for row in rows):
            raise Found
        return [replace(row, result=_spared(row, requirement)) for row in rows]

    try:
        Search(campaign(fault, start), requirement, "", True).run(fly, most)
    except Found:
        return count
    return most + 1


def _spared(row: Row, requirement: str) -> dict[str, Any] | None:
    """The result, where it fails without the fault too: the search goes on, by its margin."""
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
    for fault in [asked.only] if asked.only else CAMPAIGNS:
        for how in (sampled, searched):
            if asked.how and how.__name__ != asked.how:
                continue
            before, counts = time.process_time(), []
            for start in range(asked.starts):
                counts.append(how(fault, start, asked.most))
                print(f"{fault}, {how.__name__}: {counts[-1]}", file=sys.stderr, flush=True)
            spent = time.process_time() - before
            print(
                f"{fault}, {how.__name__}: {counts}, median {median(counts):g}, {spent:.0f} CPU s",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
