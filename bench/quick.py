"""How long a planner waits for the everyday commands: wall and CPU time of each as a process of its own.

    python bench/quick.py [--rounds 5] [--only WORD] [--cold]

Each command is run several times in a new folder, and medians are reported; its CPU time is that of the process
and of all its children. "After its last line" is from the last byte of its output to the end of the process.
--cold also plans the search example once with an empty cache, as on a new machine. Bytecode of modules is kept,
as in an installation, whatever PYTHONDONTWRITEBYTECODE says. Targets are wall times on an idle machine. The load
is printed first: under load, compare CPU times.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
CRATOUS = (sys.executable, "-m", "cratous")
CROSSING = str(ROOT / "examples" / "crossing" / "mission.yaml")
SEARCH = str(ROOT / "examples" / "search" / "mission.yaml")
BAD = "name: bad\nvehicles: 3\n"
BYTECODE = Path(tempfile.gettempdir()) / f"cratous-quick-{os.getuid()}"
"""The folder where bytecode is kept between runs."""


class Took(NamedTuple):
    """One run: wall and CPU time, and time from its last output to its end [s]; code: exit code."""

    wall_s: float
    cpu_s: float
    after_s: float
    code: int


class Line(NamedTuple):
    """A measured command: its name, the arguments of `cratous`, the permitted exit codes, its target [s]."""

    name: str
    arguments: tuple[str, ...]
    codes: tuple[int, ...]
    target_s: float


def timed(arguments: Sequence[str], folder: Path, cache: Path | None = None) -> Took:
    """Run `cratous` once in a folder. cache: a separate cache folder, by default the user's."""
    kept = {"CRATOUS_CACHE": str(cache)} if cache else {}
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(BYTECODE), **kept}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    read, write = os.pipe()
    begun = last = time.monotonic()
    with subprocess.Popen(
        [*CRATOUS, *arguments], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
        stdout=write, stderr=write,
    ) as process:  # fmt: skip
        os.close(write)
        while os.read(read, 65536):
            last = time.monotonic()
        os.close(read)
        _, status, used = os.wait4(process.pid, 0)
        ended = time.monotonic()
        process.returncode = os.waitstatus_to_exitcode(status)
    cpu_s = used.ru_utime + used.ru_stime
    return Took(ended - begun, cpu_s, ended - last, process.returncode)


def lines(log: Path, bad: Path) -> tuple[Line, ...]:
    """The everyday commands. log: of a flight of the crossing; bad: a mission file with mistakes."""
    return (
        Line("cratous --help", ("--help",), (0,), 0.1),
        Line("a bad file is refused", ("plan", str(bad)), (2,), 0.5),
        Line("plan examples/crossing", ("plan", CROSSING), (0,), 1.0),
        Line("run examples/crossing", ("run", CROSSING, "--quiet"), (0,), 2.0),
        Line("monitor of its log", ("monitor", str(log)), (0,), 1.0),
        Line("plan examples/search", ("plan", SEARCH), (0,), 10.0),
    )


def measured(line: Line, rounds: int, *, cold: bool = False) -> list[Took]:
    """The runs of a command; SystemExit for an unexpected exit code. cold: each with an empty cache."""
    found = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            took = timed(line.arguments, place, place / "cache" if cold else None)
        if took.code not in line.codes:
            sys.exit(f"{line.name}: exit code {took.code}, expected {line.codes}")
        found.append(took)
    return found


def row(name: str, target_s: float, runs: Sequence[Took]) -> str:
    """A line of the table: medians."""
    wall, cpu, after = (statistics.median(r[k] for r in runs) for k in range(3))
    return f"| {name} | {target_s:g} | {wall:.2f} | {cpu:.2f} | {after:.2f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else "")
    parser.add_argument("--rounds", type=int, default=5, choices=range(1, 101), metavar="1-100")
    parser.add_argument("--only", default="", help="commands with this word in their name")
    parser.add_argument(
        "--cold", action="store_true", help="also the first plan with an empty cache"
    )
    given = parser.parse_args()
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the start\n")
    print(
        "| command | target, wall [s] | wall [s] | CPU [s] | after its last line [s], target 0.2 |"
    )
    print("|---|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        bad = place / "bad.yaml"
        bad.write_text(BAD, encoding="utf-8")
        out = place / "out"
        flight = ("run", CROSSING, "--quiet", "--out", str(out))
        measured(Line("the flight to be judged", flight, (0,), 0.0), 1)
        (log,) = out.rglob("log.sqlite")
        for line in lines(log, bad):
            if given.only in line.name:
                print(row(line.name, line.target_s, measured(line, given.rounds)), flush=True)
        if given.cold:
            first = Line("first plan examples/search", ("plan", SEARCH), (0,), 10.0)
            print(row(first.name, first.target_s, measured(first, 1, cold=True)), flush=True)


if __name__ == "__main__":
    main()
