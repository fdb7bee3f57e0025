"""The judge's answers to the rows of a report on the flight, and rows that the report lacks.

Every row on which the judge has a verdict is expected in a report. Where nothing had to be decided
(a task of another choice that was never begun, aircraft never in the air at the same time) the
report may omit it. A row that no monitor writes for the mission is foreign: it has other words,
names something that the mission does not have, or is a duplicate.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from cratous.judge.compare import CHOICE, RELATIONS, Key, by_key, met_nobody, theirs_of
from cratous.judge.fields import Node
from cratous.judge.verdict import HOLDS, UNKNOWN, Row, worst

FLIGHT = "flight: "
ANOTHER_CHOICE = f"{FLIGHT}no task of another choice of the relations"
TASKS = "p[0-9]+(?: p[0-9]+)*(?: …)?"
EVENT = f"(?:p[0-9]+|the (?:last|first) of {TASKS}) (?:starts|ends)"
SENTENCE = re.compile(
    f"{FLIGHT}`[^`]+`: p[0-9]+ (?:starts no earlier than {EVENT}|starts at least [0-9]+ ms after {EVENT}"
    f"|ends at most [0-9]+ ms after {EVENT}|starts at [0-9]+ ms or later|ends at [0-9]+ ms or earlier)"
)
"""Pattern of a row on order or timing."""


class Answer(NamedTuple):
    """Verdicts of monitor and judge on the same subject, each empty if it has no such row.

    foreign: no monitor writes such a row for this mission.
    """

    guarantee: str
    item: str
    monitor: str
    judge: str
    foreign: bool = False

    @property
    def confirmed(self) -> bool:
        """Whether the judge agrees."""
        return self.monitor == self.judge


def answers_to(rows: list[Row], report: Node) -> list[Answer]:
    """The judge's verdict on every flight row of the report, then those that the report lacks."""
    theirs, strange = theirs_of(report)
    mine = by_key(rows)
    del mine[CHOICE]  # its rows are those on the relations and on service
    found = [Answer(guarantee, item, verdict, "", True) for guarantee, item, verdict in strange]
    key: Key = ("G1", RELATIONS)
    found += _on_relations(theirs.pop(key, []), mine.pop(key, []))
    for key, said in theirs.items():
        found += _on(key, said, mine)
    for key in sorted(mine.keys() - theirs.keys()):
        found += [Answer(r.guarantee, r.item, "", r.verdict) for r in mine[key] if _expected(r)]
    return found


def _on(key: Key, said: list[tuple[str, str]], mine: dict[Key, list[Row]]) -> list[Answer]:
    here = worst([row.verdict for row in mine[key]]) if key in mine else ""
    if not here and met_nobody(key, mine):
        here = HOLDS
    return [
        Answer(key[0], item, verdict, "" if number else here, number > 0)
        for number, (verdict, item) in enumerate(said)
    ]


def _expected(row: Row) -> bool:
    """Whether a report without this row omits something that had to be decided."""
    alone = row.subject[0] == "pair" and len(row.subject) == 2
    return row.checks > 0 or row.verdict != HOLDS or alone


def _on_relations(said: list[tuple[str, str]], rows: list[Row]) -> list[Answer]:
    """Answers on the relations, sentence by sentence.

    With a `+` in the relations the monitor may have resolved it differently, so that a sentence of
    this form that the judge does not have is not foreign, although nothing confirms it.
    """
    known = {f"{FLIGHT}{text}": verdict for row in rows for text, verdict in _parts(row)}
    choices = [row.verdict for row in rows if row.subject[1].startswith("choice ")]
    if rows:
        known[ANOTHER_CHOICE] = worst(choices or [row.verdict for row in rows])
    found, seen = [], set()
    for verdict, item in said:
        again = item in seen
        strange = item not in known and not (choices and SENTENCE.fullmatch(item))
        here = "" if again else known.get(item, "")
        found.append(Answer("G1", item, verdict, here, again or strange))
        seen.add(item)
    return found + [Answer("G1", item, "", v) for item, v in known.items() if item not in seen]


def _parts(row: Row) -> list[tuple[str, str]]:
    """The sentences of a row with their verdicts, each at most as certain as the whole row."""
    sure = row.verdict == worst([verdict for _, verdict in row.parts])
    return [(text, verdict if sure else UNKNOWN) for text, verdict in row.parts]
