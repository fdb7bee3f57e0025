"""Sections 1 to 4: subject, requirements, constraints, assignment certificate."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.services.certify.html import margin, repeats, seconds
from cratous.services.certify.requirement_views import own_requirements
from cratous.services.full_report import document
from cratous.services.full_report.first_pages import later_plans, not_covered, plan_table
from cratous.services.full_report.user_requirements import margins_of_own, of_own
from cratous.spec.mission.plan import cost_text, percent

Data = dict[str, Any]
KINDS = {"G1": "safety, timing", "G2": "safety", "G3": "liveness", "G4": "safety, liveness", "G5": "timing"}  # fmt: skip
SOURCE = "spec/mission/guarantees.py"


def sections(report: Data, chains: Data) -> Iterator[document.Section]:
    """The four sections. chains: of `trace.traced`."""
    yield document.Section("subject", "1 Subject", tuple(_subject(report)))
    yield document.Section("requirements", "2 Requirements", tuple(_requirements(report, chains)))
    yield document.Section("constraints", "3 Constraints", tuple(_constraints(report, chains)))
    yield document.Section("assignment", "4 Assignment certificate", tuple(_assignment(report)))


def _subject(report: Data) -> Iterator[document.Part]:
    mission = report["mission"]
    frame, simulation = mission["frame"], mission["simulation"]
    yield document.Words(
        f"Mission {mission['name']} ({mission['source']}), hash {report['mission_hash']}, flown by "
        f"{report['product']['name']} {report['product']['version']}: {report['command']}"
    )
    yield document.Words(
        f"Frame: north, east [m] of latitude {frame['latitude_deg']}, longitude {frame['longitude_deg']} degrees; "
        f"altitudes [m] above mean sea level, ground at {frame['terrain_m']} m. Times [ms] after mission start, "
        f"{'virtual, in steps of' if repeats(report) else 'real, states at most'} {simulation['step_ms']} ms"
        f"{'' if repeats(report) else ' apart'}. Seed {mission['seed']}. Well clear: "
        f"{', '.join(f'{k} {v:g}' for k, v in sorted(mission['daa']['well_clear'].items()))}."
    )
    yield document.Words(f"Relations: {mission['relations'] or 'none'}", "code")
    yield document.Words(not_covered(report))
    yield document.Head("Vehicles")
    rows: list[tuple[str, ...]] = [
        (str(v["id"]), v["label"], "yes" if v["protected"] else "no",
         f"{v['min_speed_m_s']:g} to {v['max_speed_m_s']:g} m/s", _at(v["position"]))
        for v in mission["vehicles"]
    ]  # fmt: skip
    yield document.Table(
        ("Id", "Label", "Protected", "Speeds", "Starts at"), tuple(rows), (10, 20, 12, 23, 35)
    )
    yield document.Head("Tasks")
    rows = [
        (f"p{t['id']}", t["label"], t["kind"].replace("_", " "),
         ", ".join(map(str, t["eligible"])) or "all", _at(t["points"][0]) if t["points"] else document.DASH)
        for t in mission["tasks"]
    ]  # fmt: skip
    head = ("Id", "Label", "Kind", "Eligible", "First place")
    yield document.Table(head, tuple(rows), (10, 20, 20, 15, 35), empty="No task.")
    yield document.Head("Zones and traffic")
    rows = [(str(z["id"]), z["kind"].replace("_", "-"), f"{len(z['vertices'])} corners") for z in mission["zones"]]  # fmt: skip
    rows += [
        (str(c["zone"]["id"]), c["zone"]["kind"].replace("_", "-"),
         f"{len(c['zone']['vertices'])} corners, from {seconds(c['at_ms'])} on")
        for c in mission["changes"] if c["zone"]
    ]  # fmt: skip
    rows += [(str(t["id"]), "traffic", t.get("label", "")) for t in mission["traffic"]]
    yield document.Table(("Id", "Kind", "What"), tuple(rows), (20, 30, 50), empty="Neither zones nor traffic.")  # fmt: skip


def _at(place: Data) -> str:
    return f"{place['north_m']:.0f} m north, {place['east_m']:.0f} m east, {place['alt_m']:.0f} m"


def _requirements(report: Data, chains: Data) -> Iterator[document.Part]:
    formal: dict[str, set[str]] = {}
    for row in chains["rows"]:
        found = {chain["definition"] for chain in row["chains"] if chain["definition"]}
        formal.setdefault(row["requirement"], set()).update(found)
    rows = [
        (one["requirement"], f"{one['title']}\n{one['text']}", KINDS.get(one["requirement"], document.DASH),
         ", ".join(sorted(formal.get(one["requirement"], ()))) or document.NOT_OBSERVED, one["verdict"])
        for one in report["requirements"]
    ]  # fmt: skip
    head = ("Id", "Requirement", "Kind", "Formal form: definitions its rows reach", "Verdict")
    yield document.Table(head, tuple(rows), (6, 36, 12, 34, 12))
    yield document.Words(f"Source of the five: {SOURCE}; the constraints of the mission: {report['mission']['source']}.")  # fmt: skip
    own = own_requirements(report)
    if not own:
        yield document.Words(
            f"Lint: {document.NOT_ASKED}. The five are fixed; requirements of users over a trace are linted where they "
            "are judged (cratous monitor), and are no part of this report."
        )
        return
    yield from of_own(report)


def _constraints(report: Data, chains: Data) -> Iterator[document.Part]:
    rows = []
    for number, (row, chain) in enumerate(zip(report["constraints"], chains["rows"], strict=True), 1):  # fmt: skip
        by = [chains["names"][one["kernel"]] for one in chain["chains"]]
        how = f"{'plan check' if row['source'] == 'plan' else 'monitor'}, {row['kind']}"
        rows.append(
            (str(number), row["requirement"], f"{row['item']}\n{row['note']}", row["verdict"], margin(row),
             seconds(row["time_ms"]), str(row["checks"]), f"{', '.join(by) or 'no kernel: the messages say it'}\n{how}")
        )  # fmt: skip
    head = ("No", "", "Constraint", "Verdict", "Margin", "At", "Checks", "Decided by")
    yield document.Words(
        "At: the first violation, or where the margin is least. Exact: on the given doubles; observed: as the "
        "messages say it; real-only: over the reals."
    )
    yield document.Table(head, tuple(rows), (5, 5, 30, 10, 11, 10, 8, 21), (4, 5, 6))
    yield from margins_of_own(report)


def _assignment(report: Data) -> Iterator[document.Part]:
    plan = report["plan"]
    bound = cost_text(plan["cost"], plan["bound"]) if plan.get("bound") else "none known"
    yield document.Words(
        f"Makespan {seconds(plan['makespan_ms'])}, cost {plan['cost']}, bound {bound}, status "
        f"{plan.get('status') or document.NOT_OBSERVED}; {plan['nodes']} nodes searched, "
        f"{'exhausted' if plan.get('exhausted') else 'not exhausted'}. Plan {plan['hash']}."
    )
    if plan.get("certificate"):
        yield document.Words(
            f"Certificate {plan['certificate']}: schedule, costs and the argument for the bound are checked again, "
            "without the search, by:"
        )
        yield document.Words("cratous certify-plan certificate.json", "code")
    else:
        yield document.Words("Certificate: none was written, so no optimality is claimed here.")
    yield document.Words(f"Two solvers on the optimum: {document.NOT_ASKED}.")
    yield plan_table(report)
    yield from later_plans(report)
    if plan.get("left_out"):
        yield document.Head("Left out")
        rows = [(f"p{o['task_id']}", o["reason"], ", ".join(f"p{t}" for t in o["waiting"])) for o in plan["left_out"]]  # fmt: skip
        yield document.Table(("Task", "Why", "Waits for it"), tuple(rows), (12, 68, 20))
    if plan.get("in_part"):
        yield document.Head("Done in part")
        rows = [(f"p{o['task_id']}", percent(o["share"]), percent(o["outside"])) for o in plan["in_part"]]  # fmt: skip
        yield document.Table(
            ("Task", "Planned", "Outside of the zones"), tuple(rows), (20, 40, 40), (1, 2)
        )
