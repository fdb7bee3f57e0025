"""Checks that a report's rows on its plan are those that the plan check writes for mission and
plan.

Mission and plan are recorded in the log and determine which rows must exist; whether a row holds is
decided by kernels (`cratous certify`). The rows on order and timing are those of the flight, which
the judge knows, unless the mission changes or leaves a choice.
"""

from __future__ import annotations

import re
from collections import Counter

from cratous.services.attestation.findings import Data
from cratous.services.results.names import REPORT_NAME
from cratous.spec.mission.guarantees import Outcome

WHOLE = "plan: every task of one choice, once"
PART = "plan: a part that the relations permit"
AT_ONCE = "plan: all order and timing rows at once"
PLAN, FLIGHT = "plan: ", "flight: "
SENTENCE = re.compile(r"plan: `[^`]+`: p[0-9]+ (starts|ends) ")
"""Prefix of a row on order or timing."""


def plan_faults(report: Data) -> list[str]:
    """Rows on the plan that are missing, or that no check writes."""
    there = {row["item"] for row in report["constraints"] if row["source"] == "plan"}
    must = _expected(report)
    said = {item for item in there if SENTENCE.match(item)}
    found = [f"G1 lacks the row on the plan: {item}" for item in sorted(must - there)]
    if len(there & {WHOLE, PART}) != 1:
        found.append(f"G1 has to have one row on the plan of these: {WHOLE}; {PART}")
    strange = sorted(there - must - said - {WHOLE, PART})
    found += [f"G1 has a row on the plan that no check writes: {item}" for item in strange]
    found += _tasks(report, there)
    if is_settled(report) and WHOLE in there:
        found += _sentences(report, said)
    return [f"{REPORT_NAME}: {text}" for text in found]


def is_settled(report: Data) -> bool:
    """Whether plan and flight have the same rows on order and timing: no change, no choice."""
    mission = report["mission"]
    return not mission["changes"] and "+" not in mission["relations"]


def _expected(report: Data) -> set[str]:
    """The rows that must exist, apart from those on tasks, order and timing as a whole."""
    mission, items = report["mission"], report["plan"]["items"]
    vehicles = {item["vehicle_id"] for item in items}
    must = {AT_ONCE} | {f"chain: vehicle {number}" for number in vehicles}
    must |= {f"eligibility: task {item['task_id']}" for item in items}
    # the plan is made with what is known at the start
    begun = [change for change in mission["changes"] if change["at_ms"] <= 0]
    over = {change["zone_id"] for change in begun if change.get("zone_id")}
    appeared = [change["zone"] for change in begun if change.get("zone")]
    return must | {
        f"zone: {zone['kind']} {zone['id']}{', region at the start' if 'moving' in zone else ''}, "
        f"planned route of vehicle {number}"
        for zone in (*mission["zones"], *appeared)
        for number in vehicles
        if zone["id"] not in over
    }


def _tasks(report: Data, there: set[str]) -> list[str]:
    """Faults of the rows on completeness: a plan without all tasks stated as whole, or a whole one
    stated as partial. Empty if the mission leaves a choice.
    """
    if not is_settled(report):
        return []
    plan = report["plan"]
    planned = Counter(item["task_id"] for item in plan["items"])
    tasks = Counter(task["id"] for task in report["mission"]["tasks"])
    whole = planned == tasks and not plan.get("in_part")
    if PART in there:
        return [f"the plan is whole, and G1 has the row on it: {PART}"] if whole else []
    holds = any(
        row["item"] == WHOLE and row["source"] == "plan" and row["verdict"] == Outcome.HOLDS
        for row in report["constraints"]
    )
    return [f"by the tasks of the plan this does not hold: {WHOLE}"] if holds and not whole else []


def _sentences(report: Data, said: set[str]) -> list[str]:
    """Differences between plan and flight in the rows on order and timing."""
    flown = {
        PLAN + row["item"].removeprefix(FLIGHT)
        for row in report["constraints"]
        if row["source"] == "flight" and SENTENCE.match(PLAN + row["item"].removeprefix(FLIGHT))
        and row["item"].startswith(FLIGHT)
    }  # fmt: skip
    found = [f"G1 lacks the row on the plan, which the flight has: {i}" for i in flown - said]
    found += [f"G1 has a row on the plan, which the flight has not: {i}" for i in said - flown]
    return sorted(found)


def plan_not_judged(report: Data) -> list[str]:
    """The parts of the plan that were not checked here, in words."""
    number = sum(row["source"] == "plan" for row in report["constraints"])
    found = [f"{number} verdicts on the plan (cratous certify makes them again)"]
    if not is_settled(report):
        found.append(
            "which rows on order and timing the plan has: the mission changes, or leaves a choice "
            "(cratous certify)"
        )
    return found
