"""The crossing over a faulty bridge, in both topologies: the gate on board, and behind UxAS in separate processes.

    python bench/bridge_faults.py [--rate 4] [--only rough ...] [--processes-only]

Each set of faults of `examples/campaigns/bridge-faults.yaml` is flown by `cratous run`, in one process and with
`--processes`; a row gives the outcome, which requirements hold, and how often ICAROUS commanded a vehicle. A flight
in processes takes a minute for 240 s of flight at four times real time, and more where faults prolong it.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
CAMPAIGN = EXAMPLES / "campaigns" / "bridge-faults.yaml"
MISSION = EXAMPLES / "crossing" / "mission.yaml"
SIGNS = {"holds": "yes", "violated": "no", "excused": "excused", "unknown": "?"}


def sets() -> dict[str, dict[str, Any]]:
    """The section `simulation` of each option of the campaign, by name."""
    found = {}
    for option in yaml.safe_load(CAMPAIGN.read_text())["options"]:
        items = option["set"].items()
        found[option["name"]] = {key.removeprefix("simulation."): value for key, value in items}
    return found


def flown(simulation: dict[str, Any], folder: Path, *more: str) -> str:
    """Fly once; returns the result as cells of the table."""
    mission = yaml.safe_load(MISSION.read_text())
    mission.pop("expect")
    folder.mkdir(parents=True)
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump({**mission, "simulation": simulation}, sort_keys=False))
    command = [sys.executable, "-m", "cratous", "run", str(file), "--json", "--quiet", *more]
    done = subprocess.run([*command, "--out", str(folder)], capture_output=True, text=True)
    try:
        found = json.loads(done.stdout)
        rows = {row["requirement"]: row["verdict"] for row in found["requirements"]}
    except (ValueError, KeyError):
        said = (done.stderr or done.stdout).strip().splitlines() or ["nothing"]
        return f"exit code {done.returncode}: {said[-1][:80]} | | "
    held = " ".join(SIGNS[rows[name]] for name in sorted(rows))
    return f"{found['outcome'] or 'cut off'} | {held} | {found['takeovers']}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rate", default="4")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--processes-only", action="store_true")
    asked = parser.parse_args()
    ways = {"one process": (), "processes": ("--processes", "--rate", asked.rate)}
    if asked.processes_only:
        del ways["one process"]
    print("| faults | flown in | ends | G1 to G5 | takeovers |\n|---|---|---|---|--:|")
    with tempfile.TemporaryDirectory() as scratch:
        for name, simulation in sets().items():
            if asked.only and name not in asked.only:
                continue
            for way, words in ways.items():
                cells = flown(simulation, Path(scratch) / name / way.replace(" ", "_"), *words)
                print(f"| {name} | {way} | {cells} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
