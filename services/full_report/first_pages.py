"""Page one, with the verdict and its basis, and page two, on the flight."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.services.certify.html import losses, margin, repeats, seconds
from cratous.services.certify.requirement_views import own_requirements
from cratous.services.full_report.document import DASH, Head, Part, Section, Table, Words
from cratous.services.full_report.pictures import flight_pictures, time_line

Data = dict[str, Any]
ACCEPTED = "cratous.PlanAccepted"
WORDS = {
    "holds": "All requirements hold", "violated": "A requirement is violated",
    "unknown": "Something is unknown", "excused": "A loss is excused",
}  # fmt: skip
HONEST = (
    "This is evidence, not certification credit: Python and z3 are not qualified tools. What mitigates it: "
    "cratous certify makes every verdict again from the log, cratous judge does so with a program that "
    "shares no code, and cratous prove --recheck puts the proofs to a second solver."
)
TRUSTED = (
    "Trusted: z3 and CPython, numba's machine code, the prover that lifts kernels into formulas, the definitions "
    "in spec/, the services that call the kernels, the projection to a local frame, straight flight between two "
    "samples, the operating system. docs/proofs/trusted-base.md says why, and what checks each."
)


def verdict_page(report: Data) -> Section:
    """The verdict and its basis, the requirements, the pictures, and how to reproduce the report."""
    return Section("verdict", "0 Verdict", tuple(_verdict(report)))


def _verdict(report: Data) -> Iterator[Part]:
    counts, flight = report["counts"], report["flight"]
    yield Words(
        f"{report['verdict'].upper()}: {WORDS[report['verdict']]}. {counts['holds']} constraints hold, "
        f"{counts['violated']} violated, {counts['unknown']} unknown, {counts['excused']} excused.{_own(report)}\n"
        f"{flight['outcome']}, {seconds(flight['end_ms'])} of flight, takeovers: {len(flight['takeovers'])}; "
        f"exit code {report['exit_code']}",
        report["verdict"],
    )
    yield from alarms(report)
    yield Words(HONEST)
    yield requirement_table(report)
    yield flight_pictures(report)
    yield Words(TRUSTED, "soft")
    yield Words(not_covered(report), "soft")
    yield Words(
        f"{'Made again' if repeats(report) else 'Flown, in real time,'} by {report['command']}: log digest {report['log']['digest']}, "
        f"{report['log']['messages']} messages; mission {report['mission_hash']}; ledger "
        f"{report['proofs']['seal'] or 'none'}. Not signed here: a signed statement stands beside it, if any.",
        "soft",
    )


def _own(report: Data) -> str:
    """Number of user requirements that hold, are violated, or unknown; empty if there are none."""
    words = [one["verdict"] for one in own_requirements(report)]
    said = ", ".join(
        f"{words.count(w)} {'hold' if w == 'holds' else w}" for w in WORDS if w in words
    )
    return f" Requirements of one's own: {said}." if words else ""


def alarms(report: Data) -> Iterator[Words]:
    """Facts that invalidate or weaken the verdicts, if any."""
    problems = report["proofs"]["problems"]
    if problems:
        yield Words(
            f"Flown with --allow-unproved: the ledger does not vouch for {len(problems)} kernels "
            f"({', '.join(p['kernel'] for p in problems[:8])}). No verdict here is better than unknown.",
            "alarm",
        )
    if not report["avoidance"]:
        yield Words("Avoidance was switched off (--no-daa). The requirements stay.", "alarm")
    for row in report["assumptions"]:
        if row["state"] == "broken":
            yield Words(
                f"Assumption broken since {seconds(row['since_ms'])} ({', '.join(row['guarantees'])}): {row['text']}",
                "alarm",
            )


def requirement_table(report: Data) -> Table:
    """The requirements, including the user's, with their verdicts and the location of the least margin."""
    rows: list[tuple[str, ...]] = []
    for one in report["requirements"]:
        place = one["item"] or DASH
        place += "" if one["time_ms"] is None else f" at {seconds(one['time_ms'])}"
        of = f"one of {one['constraints']} rows; " if one["constraints"] else "no row; "
        rows.append(
            (f"{one['requirement']} {one['title']}\n{one['text']}", one["verdict"], margin(one),
             f"{place}\n{of}{one['note']}")
        )  # fmt: skip
    for one in own_requirements(report):
        at = "" if one["time_ms"] is None else f" at {seconds(one['time_ms'])}"
        title = f"{one['requirement']} {one['title']}".strip()
        rows.append(
            (f"{title}\n{one['text']}", one["verdict"], margin(one),
             f"{one['file']}{at}\nof one's own; {one['note']}")
        )  # fmt: skip
    head = ("Requirement", "Verdict", "Least margin", "Where it is least")
    return Table(head, tuple(rows), (40, 10, 14, 36), (2,))


def not_covered(report: Data) -> str:
    """Which vehicles the mission does not protect, in words."""
    numbers = ", ".join(map(str, report["not_covered"]))
    said = (
        f"Not covered, as the mission does not protect them: vehicles {numbers}."
        if numbers
        else "Every vehicle is protected."
    )
    return said + (" Traffic is avoided, not judged." if report["mission"]["traffic"] else "")


def flight_page(report: Data) -> Section:
    """The flight: time line, tasks, takeovers, losses, changes."""
    return Section("flight", "The flight", tuple(_flight(report)))


def _flight(report: Data) -> Iterator[Part]:
    flight = report["flight"]
    yield from time_line(report)
    yield Head("Tasks served")
    rows: list[tuple[str, ...]] = [
        (f"p{s['task']}", str(s["vehicle"] or DASH), s["phase"], seconds(s["time_ms"]),
         f"{100 * s['served']:.1f} %", s["note"])
        for s in flight["served"]
    ]  # fmt: skip
    rows += [(f"p{t}", DASH, "never ended", DASH, DASH, "") for t in flight["unserved"]]
    head = ("Task", "Vehicle", "Ended as", "At", "Served", "Note")
    yield Table(head, tuple(rows), (9, 9, 18, 12, 12, 40), (3, 4), "The mission has no task.")
    yield Head("Plan before the flight")
    yield plan_table(report)
    yield from later_plans(report)
    yield Head("Takeovers")
    taken = [
        (str(t["vehicle"]), seconds(t["from_ms"]), seconds(t["to_ms"]),
         str(t["intruder"]) if str(t["intruder"]) in flight["tracks"] else DASH, t["reason"])
        for t in flight["takeovers"]
    ]  # fmt: skip
    columns = ("Vehicle", "From", "To", "Because of", "Reason")
    yield Table(columns, tuple(taken), (10, 12, 12, 16, 50), (1, 2), "None.")
    yield from loss_parts(report)
    if flight["changes"]:
        yield Head("Changes during the flight")
        changed = [(seconds(c["time_ms"]), c["what"], c["consequence"]) for c in flight["changes"]]
        yield Table(("At", "What", "What follows"), tuple(changed), (12, 44, 44), (0,))
    yield Head("Limits")
    for text in (*report["limits"], *report["mission"]["notes"]):
        yield Words(text, "item")


def plan_table(report: Data) -> Table:
    """The schedule of the plan."""
    names = ("depart_ms", "arrive_ms", "wait_ms", "start_ms", "end_ms")
    rows = [
        (f"p{i['task_id']}", str(i["vehicle_id"]), *(seconds(i[name]) for name in names))
        for i in report["plan"]["items"]
    ]
    head = ("Task", "Vehicle", "Departs", "Arrives", "Waits", "Starts", "Ends")
    return Table(head, tuple(rows), (10, 10, 16, 16, 16, 16, 16), (2, 3, 4, 5, 6), "Nothing is planned.")  # fmt: skip


def later_plans(report: Data) -> Iterator[Words]:
    """The statement that plans other than the one shown were flown; nothing if there were none."""
    more = report["log"]["by_topic"].get(ACCEPTED, 0) - 1
    if more > 0:
        yield Words(
            f"In flight {more} more plan{'' if more == 1 else 's'} took the place of this one. Of a later plan no "
            "certificate is written and no row of the plan check speaks; what was flown by it is judged as flown.",
            "soft",
        )


def loss_parts(report: Data) -> Iterator[Part]:
    """Losses of well clear, with the manoeuvres tried before each; empty if there are none."""
    found = losses(report)
    if found:
        yield Head("Losses of well clear")
    for loss in found:
        tried = loss["tried"]
        way = loss["way_out"]
        out = f"; at {seconds(way['time_ms'])}, {way['manoeuvre']}" if way else ""
        yield Words(
            f"{seconds(loss['lost_ms'])} vehicle {loss['own']} of {loss['other']}: {loss['answer']}{out}. Looked "
            f"at from {len(loss['instants'])} instants; the bands tried {tried[0]} manoeuvres and refused "
            f"{tried[1]}, the check tried {tried[2]} and refused {tried[3]}."
        )
        rows = [
            (g["dimension"], str(g["count"]), f"{g['low']} to {g['high']} {g['unit']}", ", ".join(g["by"]),
             f"{g['first_s']} to {g['last_s']} s", f"{g['apart_m']} m")
            for g in loss["groups"]
        ]  # fmt: skip
        head = ("Changes", "Number", "From, to", "Refused by", "Lost after", "Nearest")
        if rows:
            yield Table(head, tuple(rows), (16, 10, 24, 18, 18, 14), (1,))
