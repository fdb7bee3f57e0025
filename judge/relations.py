"""G1, order, timing and eligibility: whether the flown tasks fit one resolution of every `+`.

A task runs from its first Active to its last Complete. By definition, on composites:
- `.`: every task of an operand starts at or after the latest end of the previous operand;
- `~`: at or after its earliest start;
- `+`: exactly one operand; no task of another one starts;
- timing: each task lies in the innermost window that applies to it. A relative window on `.` (`~`) counts
  from the latest end (earliest start) of the previous operand, and does not apply to the first operand.
Of several resolutions the best one counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import islice, product

from cratous.judge.algebra import Term, Window, all_of, parse, without
from cratous.judge.bounds import Bound, bounded, counts_from_before, event, quoted
from cratous.judge.log import Log
from cratous.judge.mission import Mission, away_because
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, doubted, seconds, worst
from cratous.spec.errors import BadInput

WAYS = 2000
"""Maximum number of resolutions of `+` that are examined."""


@dataclass
class Deed:
    """Logged execution of a task. active: vehicle, start, end (None: never)."""

    active: list[tuple[int, int, int | None]] = field(default_factory=list)
    complete_ms: int | None = None
    fault: str = ""

    @property
    def start_ms(self) -> int | None:
        """Time of its first start [ms]."""
        return self.active[0][1] if self.active else None


@dataclass(frozen=True)
class Found:
    """One constraint of a resolution: its text, and its verdict. parts: of `Row`."""

    kind: str
    text: str
    verdict: str
    note: str
    at_ms: int | None = None
    parts: tuple[tuple[str, str], ...] = ()


def deeds(mission: Mission, log: Log) -> dict[int, Deed]:
    """Executions by task, from the logged phases."""
    found: dict[int, Deed] = {}
    for said in log.progress:
        deed = found.setdefault(said.task, Deed())
        late = said.logged_ms - said.time_ms
        if not 0 <= late <= 2 * mission.step_ms:
            deed.fault = (
                f"task {said.task} is said at {seconds(said.logged_ms)} to be {said.phase} since "
                f"{seconds(said.time_ms)}"
            )
        if deed.active and deed.active[-1][2] is None:
            vehicle, start, _ = deed.active[-1]
            if said.phase == "Active" and said.vehicle == vehicle:
                continue
            deed.active[-1] = (vehicle, start, max(start, said.time_ms))
        if said.phase == "Active":
            deed.active.append((said.vehicle, said.time_ms, None))
        elif said.phase == "Complete":
            deed.complete_ms = said.time_ms
    return found


def asked(mission: Mission, done: dict[int, Deed], end_ms: int | None) -> Term | None:
    """The relations over the tasks that take part at the end; None if there are none.

    A removed task takes part if it had been done before, or if it is requested again, even after
    the end.
    """
    text = mission.relations.strip()
    whole = parse(text) if text else all_of(sorted(mission.tasks))
    _refuse_strangers(mission, whole)
    gone = set()
    for task, entries in mission.task_said.items():
        deed = done.get(task, Deed())
        known = [entry for entry in entries if end_ms is None or entry[0] <= end_ms]
        if not known or known[-1][1] or any(there for _, there in entries[len(known) :]):
            continue
        at = known[-1][0]
        if deed.complete_ms is None or deed.complete_ms > at:
            gone.add(task)
    return without(whole, gone)


def _refuse_strangers(mission: Mission, term: Term) -> None:
    differ = set(term.tasks()) ^ set(mission.tasks)
    if differ:
        raise BadInput(
            "the relations do not name just the mission's tasks", item="relations",
            expected=" ".join(f"p{t}" for t in sorted(mission.tasks))[:200],
            got=str(term)[:200],
        )  # fmt: skip


def ways(term: Term, started: set[int]) -> Iterator[tuple[Term, tuple[Found, ...]]]:
    """The term with every `+` resolved, with the constraints on the choice.

    An operand that lacks a started task is examined only if every operand lacks one.
    """
    if not term.operator:
        yield term, ()
        return
    if term.operator != "+":
        parts = [list(islice(ways(operand, started), WAYS)) for operand in term.operands]
        for choice in islice(product(*parts), WAYS):
            operands = tuple(one for one, _ in choice)
            said = tuple(f for _, found in choice for f in found)
            yield Term(term.operator, 0, operands, term.window), said
        return
    begun = started & set(term.tasks())
    fitting = [o for o in term.operands if begun <= set(o.tasks())]
    verdict, note = HOLDS, "exactly one operand was begun" if begun else "none was begun"
    if not fitting:
        names = ", ".join(f"p{t}" for t in sorted(begun))
        verdict, note = VIOLATED, f"tasks of more than one operand were begun: {names}"
    elif not begun:
        verdict = UNKNOWN
    one_of = Found("choice", str(term), verdict, note)
    for operand in fitting or term.operands:
        for one, found in ways(operand, started):
            # the window of a + applies to all tasks of the chosen operand
            outer = Window(False, term.window.first, term.window.last) if term.window else None
            yield bounded(one, outer), (one_of, *found)


class _Way:
    """One resolution, checked against the times of its tasks."""

    def __init__(self, done: dict[int, Deed]) -> None:
        self.done = done
        self.found: list[Found] = []

    def start(self, task: int) -> int | None:
        deed = self.done.get(task)
        return deed.start_ms if deed else None

    def end(self, task: int) -> int | None:
        deed = self.done.get(task)
        return deed.complete_ms if deed else None

    def look(self, term: Term, bound: Bound | None) -> None:
        """Check all constraints of a term; bound: the innermost window around it."""
        window = term.window
        relative = counts_from_before(term)
        if window is not None and not relative:
            bound = Bound(term, 0, window)
        if not term.operator:
            if bound is not None:
                self._in_window(term.task, bound)
            return
        before: Term | None = None
        for operand in term.operands:
            inner = bound
            if before is not None and term.operator in (".", "~"):
                moment = self._moment(term.operator, before)
                for task in operand.tasks():
                    self._after(term, task, before, moment)
                if relative and window is not None:
                    inner = Bound(term, moment, window, event(term.operator, before))
            self.look(operand, inner)
            before = operand

    def _moment(self, operator: str, before: Term) -> int | None:
        """Time at which the previous operand had ended, or had begun; None if never."""
        tasks = before.tasks()
        if operator == ".":
            ends = [self.end(t) for t in tasks]
            return None if None in ends else max(e for e in ends if e is not None)
        starts = [s for s in map(self.start, tasks) if s is not None]
        return min(starts) if starts else None

    def _after(self, term: Term, task: int, before: Term, moment: int | None) -> None:
        start = self.start(task)
        ended = "ended" if term.operator == "." else "begun"
        part = f"{quoted(term)}: p{task} starts no earlier than {event(term.operator, before)}"
        if start is None:
            said = Found("order", str(term), UNKNOWN, f"task {task} was not begun")
        elif moment is None:
            note = f"task {task} began at {seconds(start)}, though {before} had never {ended}"
            said = Found("order", str(term), VIOLATED, note, start)
        else:
            verdict = HOLDS if start >= moment else VIOLATED
            note = (
                f"task {task} began at {seconds(start)}, {before} had {ended} at {seconds(moment)}"
            )
            said = Found("order", str(term), verdict, note, start)
        self.found.append(replace(said, parts=((part, said.verdict),)))

    def _in_window(self, task: int, bound: Bound) -> None:
        text, ref, window = str(bound.term), bound.ref_ms, bound.window
        asks_start, asks_end = bound.parts(task)
        start, end = self.start(task), self.end(task)
        if ref is None or start is None or end is None:
            note = f"task {task} was not flown to its end" if ref is not None else (
                f"what the times of task {task} count from never came"
            )  # fmt: skip
            parts = ((asks_start, UNKNOWN), (asks_end, UNKNOWN))
            self.found.append(Found("timing", text, UNKNOWN, note, parts=parts))
            return
        late_enough, early_enough = start >= ref + window.first, end <= ref + window.last
        note = (
            f"task {task} ran from {seconds(start)} to {seconds(end)}, allowed is "
            f"{seconds(ref + window.first)} to {seconds(ref + window.last)}"
        )
        verdict = HOLDS if late_enough and early_enough and start <= end else VIOLATED
        parts = (
            (asks_start, HOLDS if late_enough else VIOLATED),
            (asks_end, HOLDS if early_enough else VIOLATED),
        )
        self.found.append(Found("timing", text, verdict, note, start, parts))


def best_way(
    term: Term, done: dict[int, Deed], served: set[int], planned: frozenset[int] = frozenset()
) -> tuple[Term, list[Found], bool]:
    """The best-fitting resolution: its term, its constraints, and whether all resolutions were
    examined.

    Of equally good ones it is the one closest to the last plan, `planned`.
    """
    started = {t for t, deed in done.items() if deed.active}
    order = (HOLDS, UNKNOWN, VIOLATED)
    best: tuple[tuple[int, ...], Term, list[Found]] | None = None
    count = 0
    for one, said in islice(ways(term, started), WAYS):
        count += 1
        way = _Way(done)
        way.look(one, None)
        found = [*said, *way.found]
        verdict = worst([f.verdict for f in found]) if found else HOLDS
        missing = len(set(one.tasks()) - served)
        mine = set(one.tasks())
        unlike = -len(mine & planned), len(mine - planned)
        rank = (
            order.index(verdict), missing, sum(f.verdict != HOLDS for f in found), *unlike,
        )  # fmt: skip
        if best is None or rank < best[0]:
            best = (rank, one, found)
    assert best is not None
    return best[1], best[2], count < WAYS


def rows(mission: Mission, log: Log, done: dict[int, Deed], served: set[int]) -> Iterator[Row]:
    """Order, timing and choice, then eligibility."""
    term = asked(mission, done, log.end_ms)
    if term is not None:
        yield from _relation_rows(term, done, served, log.planned)
    elif mission.tasks:
        note = "no task is asked for any more"
        yield Row("G1", ("relations", ""), "relations: none", HOLDS, note)
    for task, deed in sorted(done.items()):
        if deed.active:
            yield _eligible(mission, task, deed)
    for task in sorted(mission.tasks):
        deed = done.get(task, Deed())
        if not deed.active and deed.complete_ms is None and log.end_ms is not None:
            subject, item = ("eligible", str(task)), f"eligibility: task {task} in flight"
            verdict, note = (UNKNOWN, log.lossy) if log.lossy else (HOLDS, "nobody began it")
            yield Row("G1", subject, item, verdict, note)


def _relation_rows(
    term: Term, done: dict[int, Deed], served: set[int], planned: frozenset[int]
) -> Iterator[Row]:
    _, found, whole = best_way(term, done, served, planned)
    faults = [done[t].fault for t in term.tasks() if t in done and done[t].fault]
    merged: dict[tuple[str, str], list[Found]] = {}
    for one in found:
        merged.setdefault((one.kind, one.text), []).append(one)
    if not merged:
        note = "the mission states no order, timing or choice"
        yield Row("G1", ("relations", ""), "relations: none", HOLDS, note)
    for (kind, text), parts in merged.items():
        verdict = worst([p.verdict for p in parts])
        telling = next(p for p in parts if p.verdict == verdict)
        if not whole and verdict == VIOLATED:
            verdict = UNKNOWN
        note = telling.note if whole else f"{telling.note}; not all ways to choose were looked at"
        row = Row(
            "G1", ("relations", f"{kind} {text}"), f"{kind}: {text}", verdict, note,
            telling.at_ms if verdict == VIOLATED else None, len(parts),
            tuple(part for one in parts for part in one.parts),
        )  # fmt: skip
        yield doubted(row, faults[0] if faults else "")


def _eligible(mission: Mission, number: int, deed: Deed) -> Row:
    subject, item = ("eligible", str(number)), f"eligibility: task {number} in flight"
    task = mission.tasks.get(number)
    if task is None:
        note = "the mission has no such task"
        return Row("G1", subject, item, VIOLATED, note, deed.start_ms, 1)
    for vehicle, start, _ in deed.active:
        wrong = ""
        if vehicle not in mission.vehicles or (task.eligible and vehicle not in task.eligible):
            wrong = f"vehicle {vehicle} may not do it"
        elif why := away_because(mission.vehicle_said, vehicle, start):
            gone = "was lost before" if why == "left" else "had not joined"
            wrong = f"vehicle {vehicle} {gone}"
        elif away_because(mission.task_said, number, start) == "to come":
            wrong = "it had not been asked for"
        if wrong:
            return Row(
                "G1", subject, item, VIOLATED, f"{wrong}: begun at {seconds(start)}", start, 1
            )
    flown = ", ".join(str(v) for v in dict.fromkeys(v for v, *_ in deed.active))
    return Row("G1", subject, item, HOLDS, f"flown by vehicle {flown}", None, len(deed.active))
