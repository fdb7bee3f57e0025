"""Writes tests/slow.txt, which `make test-fast` leaves out, from what a whole run took.

    .venv/bin/python -m pytest -m "not long" --junit-xml=took.xml
    .venv/bin/python tests/programs/slow_tests.py took.xml

A function is slow if its cases take MEAN_S on average or TOTAL_S together; a file in which half of the
functions are is named as a whole, since what its fixtures cost would fall to the others.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

MEAN_S, TOTAL_S = 0.2, 3.0
LIST = Path(__file__).resolve().parents[1] / "slow.txt"


def listed(junit: Path) -> list[str]:
    """The lines of the list: files, and functions as FILE::FUNCTION."""
    took: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for case in ElementTree.parse(junit).iter("testcase"):
        file = case.attrib["classname"].replace(".", "/") + ".py"
        took[file][case.attrib["name"].partition("[")[0]].append(float(case.attrib["time"]))
    lines = []
    for file, functions in took.items():
        slow = [
            name
            for name, times in functions.items()
            if sum(times) >= TOTAL_S or sum(times) >= MEAN_S * len(times)
        ]
        if len(slow) > 1 and 2 * len(slow) >= len(functions):
            lines.append(file)
        else:
            lines += [f"{file}::{name}" for name in slow]
    return sorted(lines)


if __name__ == "__main__":
    LIST.write_text("\n".join(listed(Path(sys.argv[1]))) + "\n", encoding="utf-8")
