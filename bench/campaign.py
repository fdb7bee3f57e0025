"""The overhead of a campaign beyond its flights, in CPU time of both of its processes.

    python bench/campaign.py [FILE ...] [--runs 20]

A flight comprises planning, flying, monitoring and logging; the overhead is what a campaign adds: making and reading
the mission, the report, the judge, and in the process that stores the results the draws, the pipe, the store and the
summary. The first run of a campaign, which loads everything, is left out.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve()
FILES = ("crossing/mission.yaml", "campaigns/traffic.yaml", "campaigns/encounters.yaml")
TIMES = "BENCH_CAMPAIGN_TIMES"
FLIGHT, NOT_FLIGHT = ("fly_mission", "fly_encounter", "verdicts_of"), ("build_report",)
OTHERS = ("judgement", "encounter_rows", "load", "report_text")
_spent: dict[str, float] = {}


def _timed(module: Any, name: str) -> None:
    """Replace a function by one that sums its CPU time."""
    right: Callable[..., Any] = getattr(module, name)

    def timed(*args: Any, **named: Any) -> Any:
        before = time.process_time()
        try:
            return right(*args, **named)
        finally:
            _spent[name] = _spent.get(name, 0.0) + time.process_time() - before

    setattr(module, name, timed)


def fly(task: dict[str, Any]) -> dict[str, Any]:
    """A run in the process that flies; writes the CPU time of its parts so far."""
    from cratous.services import loading
    from cratous.services.campaign import encounters
    from cratous.services.certify import report
    from cratous.services.cli import campaign_flight, encounter_flight, judge
    from cratous.services.flight import encounter

    if not _spent:
        for module, names in (
            (campaign_flight, ("fly_mission",)), (encounter, ("fly_encounter",)), (loading, ("load",)),
            (encounters, ("verdicts_of",)), (report, ("build_report", "report_text")),
            (judge, ("judgement", "encounter_rows")),
        ):  # fmt: skip
            for name in names:
                _timed(module, name)
                _spent[name] = 0.0
    kind = encounter_flight if task["kind"] == "encounters" else campaign_flight
    result = kind.fly_run(task)
    with open(os.environ[TIMES], "a") as file:
        file.write(json.dumps({**_spent, "all": time.process_time()}) + "\n")
    return result


def measured(file: Path, runs: int) -> str:
    """One line with the results for a campaign file."""
    from cratous.services.campaign.campaign import Conduct, Course
    from cratous.services.campaign.definition import load_campaign
    from cratous.services.campaign.engine import engine
    from cratous.services.campaign.identity import version_digest
    from cratous.services.campaign.pages import page
    from cratous.services.campaign.store import Store
    from cratous.services.campaign.summary import build, text_of
    from cratous.services.campaign.tables import csv_text, junit_text

    version = version_digest()
    ours = resource.getrusage(resource.RUSAGE_SELF)
    with tempfile.TemporaryDirectory() as folder:
        os.environ[TIMES] = str(Path(folder) / "times")
        campaign = load_campaign(file, range(1, runs + 2), ())
        with Store(Path(folder)) as store, engine(1, None) as made:
            conduct = Conduct(campaign, store, f"{HERE.stem}:fly", version, False)
            conduct.fly(made, Course(runs + 1), lambda _line: None)
            rows = list(conduct.rows())
        summary = build(campaign, rows, version)
        for text in (page(summary, {}), csv_text(summary), junit_text(summary), text_of(summary)):
            assert text
        times = [json.loads(line) for line in Path(os.environ[TIMES]).read_text().splitlines()]
    now = resource.getrusage(resource.RUSAGE_SELF)
    stores = (now.ru_utime + now.ru_stime - ours.ru_utime - ours.ru_stime) / (runs + 1)
    each = {name: (times[-1][name] - times[0][name]) / (len(times) - 1) for name in times[0]}
    flight = sum(each[name] for name in FLIGHT) - sum(each[name] for name in NOT_FLIGHT)
    whole = each["all"] + stores
    parts = {**{name: each[name] for name in (*OTHERS, *NOT_FLIGHT)}, "stores": stores}
    told = ", ".join(f"{name} {1000 * t:.1f}" for name, t in parts.items() if t > 1e-4)
    return (
        f"{file.parent.name}/{file.name}: {runs} runs, {1000 * whole:.0f} ms each, flight {1000 * flight:.0f} ms, "
        f"beside it {1 - flight / whole:.1%} ({told})"
    )


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--runs", type=int, default=20)
    asked = parser.parse_args()
    gc.set_threshold(100_000, 10, 10)  # as in the command
    os.environ["PYTHONPATH"] = os.pathsep.join([str(HERE.parent), os.environ.get("PYTHONPATH", "")])
    examples = HERE.parents[1] / "examples"
    for file in asked.files or [examples / name for name in FILES]:
        print(measured(file, asked.runs), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
