"""An hour of ten vehicles, flown, reported, certified and opened: CPU seconds of each step.

    python bench/hour_of_ten.py [--minutes 60] [--folder FOLDER]

Five vehicles fly east on lanes 8 km apart, five north; the two on lanes with the same number meet where these cross,
at one altitude, and ICAROUS takes over. Each passes four points. With --folder the mission and its results are kept.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml

SPEED_M_S, LANE_M, POINTS, LANES = 22.0, 8000.0, 4, 5
CERTIFIED = "from cratous.services.cli import main; raise SystemExit(main(['certify', {!r}]))"
OPENED = (
    "from pathlib import Path; from cratous.services.ground_station.recording import recording; "
    "recording(Path({!r}))"
)


def mission(minutes: float) -> dict[str, Any]:
    """The content of the mission file."""
    length_m = SPEED_M_S * 60 * minutes
    vehicles, tasks = [], list[dict[str, Any]]()
    for number in range(1, 2 * LANES + 1):
        lane_m, east = LANE_M * ((number - 1) % LANES + 1), number <= LANES
        start = {"north_m": lane_m, "east_m": 0.0} if east else {"north_m": 0.0, "east_m": lane_m}
        vehicles.append(
            {
                "id": number, "position": {**start, "alt_m": 300}, "heading_deg": 90 if east else 0,
                "speed_m_s": SPEED_M_S, "min_speed_m_s": 15, "max_speed_m_s": 33, "max_bank_deg": 30,
                "max_climb_m_s": 5,
            }
        )  # fmt: skip
        for k in range(1, POINTS + 1):
            along = {"east_m" if east else "north_m": length_m * k / POINTS}
            point = {**start, **along, "alt_m": 300}
            one = {"id": len(tasks) + 1, "kind": "must_fly", "eligible": [number]}
            tasks.append({**one, "points": [point]})
    return {
        "name": "hour",
        "frame": {"latitude_deg": 37.1, "longitude_deg": -76.4, "terrain_m": 0},
        "vehicles": vehicles,
        "tasks": tasks,
        "relations": "|(" + " ".join(f"p{task['id']}" for task in tasks) + ")",
        "daa": {"well_clear": {"dthr_m": 150, "zthr_m": 30, "tthr_s": 15, "tcoa_s": 0}},
        "simulation": {"limit_s": 90 * minutes},
    }


def spent(what: str, *command: str) -> None:
    """Run a command and print its CPU time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([sys.executable, *command], stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{what:32} {cpu_s:6.1f} s of CPU, exit code {done.returncode}", flush=True)


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--minutes", type=float, default=60.0)
    options.add_argument("--folder", type=Path)
    asked = options.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = asked.folder or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        file, run = folder / "hour.yaml", folder / "hour"
        file.write_text(yaml.safe_dump(mission(asked.minutes), sort_keys=False))
        spent(
            "planned, flown and reported",
            "-m",
            "cratous",
            "run",
            str(file),
            "--quiet",
            "--out",
            str(folder),
        )
        print(f"{'its log':32} {(run / 'log.sqlite').stat().st_size / 1e6:6.0f} MB")
        spent("certified from its log", "-c", CERTIFIED.format(str(run)))
        spent("opened by the ground station", "-c", OPENED.format(str(run)))


if __name__ == "__main__":
    main()
