"""Compares the judge's rows with those of the flight's monitor in report.json.

- *disagree*: one has `holds` and the other `violated`; or a violation for which the monitor has no row
  or `unknown`; or an excused row that holds; or a row that the judge does not expect and that is not
  unknown.
- *claimed excused*: violated here, excused there. The judge has no excuses.
- *undecided*: one of the two is unknown.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

from cratous.judge.fields import Node
from cratous.judge.verdict import GUARANTEES, HOLDS, UNKNOWN, VIOLATED, Row, worst
from cratous.spec.errors import BadInput

NAME = "report.json"
LARGEST = 1 << 28
"""Maximum size of a report [bytes]: its parsed form takes many times as much."""
FORMATS = ("cratous-report/2", "cratous-report/1")
"""Supported formats: the compared entries are the same in both."""
EXCUSED = "excused"
DISAGREE, CLAIMED, UNDECIDED = "disagree", "claimed excused", "undecided"
NUMBER = r"(-?\d+)"
RELATIONS = "relations"
ITEMS = (
    ("G1", rf"zone: keep_(?:in|out) {NUMBER}, flight of vehicle {NUMBER}", "zone"),
    ("G1", rf"eligibility: task {NUMBER} in flight", "eligible"),
    ("G1", rf"separation at [A-Za-z0-9_-]+: vehicles {NUMBER} and {NUMBER}", "merge"),
    ("G1", r"flight: choice", "choice"),
    ("G1", r"flight: .*", RELATIONS),
    ("G2", rf"well clear of {NUMBER} and {NUMBER}", "pair"),
    ("G2", rf"well clear of {NUMBER}", "pair"),
    ("G3", rf"task {NUMBER} served", "served"),
    ("G3", r"end of mission", "end"),
    ("G4", rf"authority over vehicle {NUMBER}", "authority"),
    ("G4", rf"take-off of vehicle {NUMBER}", "take-off"),
    ("G4", rf"what vehicle {NUMBER} does after a failure", "failed"),
    ("G4", rf"failures of vehicle {NUMBER} are declared when due", "due"),
    ("G5", rf"what vehicle {NUMBER} flies without the link", "alone"),
    ("G5", rf"circle of vehicle {NUMBER} at the end", "circle"),
    ("G5", rf"heartbeat to the ICAROUS instance of {NUMBER}", "to"),
    ("G5", rf"heartbeat from the ICAROUS instance of {NUMBER}", "from"),
)


@dataclass(frozen=True)
class Difference:
    """A difference between judge and monitor."""

    kind: str
    guarantee: str
    item: str
    judge: str
    monitor: str
    note: str

    def line(self) -> str:
        """The difference as one line of text."""
        return f"{self.guarantee} {self.item}: judge {self.judge}, monitor {self.monitor} ({self.note})"


Key = tuple[str, ...]
CHOICE = ("G1", "choice")


def report_of(path: Path) -> Path | None:
    """The report beside a log; None if there is none."""
    folder = path if path.is_dir() else path.parent
    if not path.is_dir() and path.name != "log.sqlite":
        return None
    report = folder / NAME
    return report if report.is_file() else None


def read(path: Path) -> Node:
    """The report; BadInput if it is invalid."""
    try:
        if path.stat().st_size > LARGEST:
            raise BadInput("too large", where=str(path), expected=f"at most {LARGEST} bytes")
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise BadInput(f"not a report ({str(error)[:100]})", where=str(path)) from None
    report = Node(data, str(path), "report")
    report["format"].one_of(*FORMATS)
    return report


def differences(rows: list[Row], report: Node, digest: str) -> list[Difference]:
    """All differences, disagreements first."""
    theirs, strange = theirs_of(report)
    mine = by_key(rows)
    found = []
    if report["log"]["digest"].text != digest:
        note = "the report is about another log"
        found.append(Difference(DISAGREE, "", "log", digest[:12], "another digest", note))
    if CHOICE not in theirs:
        del mine[CHOICE]
    for key in sorted({*mine, *theirs}):
        one = _compare(key, mine.get(key, []), theirs.get(key, []), mine)
        if one is not None:
            found.append(one)
    for guarantee in GUARANTEES:
        bad = [item for g, item, verdict in strange if g == guarantee and verdict == VIOLATED]
        whole = worst([row.verdict for row in rows if row.guarantee == guarantee])
        if bad and whole != VIOLATED:
            note = "a row that the judge cannot read"
            found.append(Difference(DISAGREE, guarantee, bad[0], whole, VIOLATED, note))
    return sorted(found, key=lambda d: (DISAGREE, CLAIMED, UNDECIDED).index(d.kind))


def by_key(rows: list[Row]) -> dict[Key, list[Row]]:
    """The judge's rows by key, including those on the choice."""
    mine: dict[Key, list[Row]] = {}
    for row in rows:
        mine.setdefault(_key(row), []).append(row)
    mine[CHOICE] = _choice(rows)
    return mine


def _choice(rows: list[Row]) -> list[Row]:
    """The judge's rows for the monitor's item on the choice: whether it is a choice, and whether it was done."""
    return [row for row in rows if row.subject[0] == "served" or row.item.startswith("choice: ")]


def _key(row: Row) -> Key:
    return (row.guarantee, RELATIONS) if row.subject[0] == RELATIONS else (
        row.guarantee, *row.subject
    )  # fmt: skip


def theirs_of(report: Node) -> tuple[dict[Key, list[tuple[str, str]]], list[tuple[str, str, str]]]:
    """The monitor's verdicts by the judge's keys, and those without a key."""
    found: dict[Key, list[tuple[str, str]]] = {}
    strange = []
    for row in report["constraints"]:
        if row["source"].text != "flight":
            continue
        guarantee, item = row["requirement"].text, row["item"].text
        verdict = row["verdict"].one_of(HOLDS, VIOLATED, UNKNOWN, EXCUSED)
        key = _read_item(guarantee, item)
        if key is None:
            strange.append((guarantee, item, verdict))
        else:
            found.setdefault(key, []).append((verdict, item))
    return found, strange


def _read_item(guarantee: str, item: str) -> Key | None:
    for where, pattern, name in ITEMS:
        match = re.fullmatch(pattern, item, re.DOTALL)
        if where != guarantee or match is None:
            continue
        parts = match.groups()
        if name == "pair":
            parts = tuple(map(str, sorted(map(int, parts))))
        if name in ("to", "from"):
            return (guarantee, "beat", *parts, "Down" if name == "to" else "Up")
        return (guarantee, name, *parts)
    return None


def _compare(
    key: Key, mine: list[Row], theirs: list[tuple[str, str]], all_mine: dict[Key, list[Row]]
) -> Difference | None:
    here = worst([row.verdict for row in mine]) if mine else ""
    there = _worst_of([verdict for verdict, _ in theirs])
    if here == there:
        return None
    row = next((row for row in mine if row.verdict == here), None)
    item = row.item if row else theirs[0][1]
    note = row.note if row else "the judge expects no such row"
    kind = UNDECIDED
    if not here:
        if met_nobody(key, all_mine):
            return None
        kind = UNDECIDED if there == UNKNOWN else DISAGREE
    elif not there:
        if here == HOLDS:
            return None
        kind = DISAGREE if here == VIOLATED else UNDECIDED
    elif here == VIOLATED:
        kind = CLAIMED if there == EXCUSED else DISAGREE
    elif here == HOLDS and there != UNKNOWN:
        kind = DISAGREE
    return Difference(kind, key[0], item, here or "no row", there or "no row", note)


def _worst_of(verdicts: list[str]) -> str:
    return next((v for v in (VIOLATED, UNKNOWN, EXCUSED, HOLDS) if v in verdicts), "")


def met_nobody(key: Key, mine: dict[Key, list[Row]]) -> bool:
    """Whether this is a monitor row that a vehicle met no traffic, which the judge has pair by
    pair.

    The judge has no rows on vehicles that are not protected, or not part of the mission.
    """
    if key[:2] != ("G2", "pair") or len(key) != 3 or ("G4", "authority", key[2]) not in mine:
        return False
    pairs = [rows for other, rows in mine.items() if other[:2] == key[:2] and key[2] in other[2:]]
    return all(row.verdict == HOLDS for rows in pairs for row in rows)
