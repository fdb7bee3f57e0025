"""Sections 5, 6 and 8: trajectories, run-time observations, assumptions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.services.assumptions.observation_texts import measured
from cratous.services.certify.alerts import level_name, none_said
from cratous.services.certify.html import margin, seconds
from cratous.services.full_report import document
from cratous.services.full_report.first_pages import loss_parts
from cratous.services.full_report.pictures import flight_pictures

Data = dict[str, Any]
ZONES = "zone: "
CONFLICT = "cratous.Conflict"
BETWEEN = (
    "Between two samples an aircraft is taken to fly straight. On such a piece the kernel named beside a row says "
    "whether something is violated at any instant, not at the samples only; the theorems below say so over the "
    "reals, for every instant. The simulator's tracks are pieces of that kind; of others it is an assumption."
)


def trajectory(report: Data, chains: Data) -> document.Section:
    """Section 5. chains: of `trace.traced`."""
    return document.Section(
        "trajectory", "5 Trajectory evidence", tuple(_trajectory(report, chains))
    )


def _trajectory(report: Data, chains: Data) -> Iterator[document.Part]:
    rows = list(zip(report["constraints"], chains["rows"], strict=True))
    zones = [pair for pair in rows if pair[0]["item"].startswith(ZONES)]
    clear = [pair for pair in rows if pair[0]["requirement"] == "G2"]
    yield flight_pictures(report)
    yield document.Head("Containment")
    yield _table(zones, chains, "No row: the mission has no zone, or nothing of it was observed.")
    yield document.Head("Well clear")
    yield _table(clear, chains, document.NOT_OBSERVED)
    yield document.Head("Between the samples")
    yield document.Words(BETWEEN)
    names = {t for _, row in (*zones, *clear) for chain in row["chains"] for t in chain["theorems"]}
    theorems = report["proofs"]["theorems"]
    told = [(n, theorems[n]["sentence"], theorems[n]["status"]) for n in sorted(names) if n in theorems]  # fmt: skip
    yield document.Table(("Theorem", "What it says", "Status"), tuple(told), (34, 54, 12))
    yield document.Head("Alerts and manoeuvres")
    takeovers = report["flight"]["takeovers"]
    first = seconds(min(t["from_ms"] for t in takeovers)) if takeovers else document.NOT_OBSERVED
    alerts = report["flight"].get("alerts", [])
    alerted = seconds(min(a["from_ms"] for a in alerts)) if alerts else document.NOT_OBSERVED
    yield document.Words(
        f"Conflict messages: {report['log']['by_topic'].get(CONFLICT, 0)}. First takeover: {first}. "
        f"First alert: {alerted}. " + ("" if alerts else none_said(report))
    )
    if alerts:
        spans = [
            (str(a["vehicle"]), str(a["intruder"]), seconds(a["from_ms"]), seconds(a["to_ms"]),
             level_name(a["level"]), f"{a['least_s']:.1f} s")
            for a in alerts
        ]  # fmt: skip
        columns = (
            "Vehicle",
            "Intruder",
            "From",
            "To",
            "Highest level",
            "Least time to a violation",
        )
        yield document.Table(columns, tuple(spans), (12, 12, 14, 14, 24, 24), (2, 3, 5))
    yield _authority(report)
    yield from loss_parts(report)


def _table(rows: list[tuple[Data, Data]], chains: Data, empty: str) -> document.Table:
    found = [
        (f"{row['item']}\n{row['note']}", row["verdict"], margin(row), seconds(row["time_ms"]),
         str(row["checks"]), ", ".join(chains["names"][c["kernel"]] for c in chain["chains"]) or document.DASH)
        for row, chain in rows
    ]  # fmt: skip
    head = ("Constraint", "Verdict", "Margin", "At", "Checks", "Decided by")
    return document.Table(head, tuple(found), (36, 10, 12, 10, 9, 23), (2, 3, 4), empty)


def _authority(report: Data) -> document.Table:
    rows = [
        (seconds(a["time_ms"]), str(a["vehicle"]), a["owner"], str(a["epoch"]), a["reason"])
        for a in report["flight"]["authority"]
    ]
    head = ("At", "Vehicle", "Owner from then on", "Epoch", "Reason")
    return document.Table(
        head, tuple(rows), (12, 10, 20, 10, 48), (0,), "No change of command is in the log."
    )


def runtime(report: Data) -> document.Section:
    """Section 6."""
    return document.Section("runtime", "6 Runtime evidence", tuple(_runtime(report)))


def _runtime(report: Data) -> Iterator[document.Part]:
    log, flight = report["log"], report["flight"]
    yield document.Words(
        f"{log['messages']} messages, {flight['outcome']} at {seconds(flight['end_ms'])}."
    )
    yield document.Words("The verdicts of the monitor are those of section 3; that they came while it flew is not recorded here.")  # fmt: skip
    yield document.Head("Bridge: heartbeats and delay")
    rows: list[tuple[str, ...]] = [
        (f"{r['item']}\n{r['note']}", r["verdict"], margin(r), str(r["checks"]))
        for r in report["constraints"]
        if r["requirement"] == "G5"
    ]
    yield document.Table(("Constraint", "Verdict", "Margin", "Checks"), tuple(rows), (58, 14, 16, 12), (2, 3))  # fmt: skip
    yield document.Words(
        "Messages lost or late: see the assumptions on the link in section 8.", "soft"
    )
    yield document.Head("Events")
    rows = [
        (
            seconds(e["time_ms"]),
            document.DASH if e["vehicle"] is None else str(e["vehicle"]),
            e["text"],
        )
        for e in flight["events"]
    ]
    yield document.Table(("At", "Vehicle", "Event"), tuple(rows), (14, 12, 74), (0,))
    yield document.Head("Messages by topic")
    rows = [(topic, str(number)) for topic, number in sorted(log["by_topic"].items())]
    yield document.Table(("Topic", "Messages"), tuple(rows), (80, 20), (1,))


def assumptions(report: Data) -> document.Section:
    """Section 8."""
    return document.Section("assumptions", "8 Assumptions, and whether they held", tuple(_assumptions(report)))  # fmt: skip


def _assumptions(report: Data) -> Iterator[document.Part]:
    yield document.Words(
        "What the theorems on the whole system assume, as it was watched in the messages of this flight. No verdict "
        "depends on it: where one is broken, no theorem speaks for the guarantees beside it from then on. Justified "
        "in docs/proofs/assumptions.md; an owner is not recorded."
    )
    rows = []
    for one in report["assumptions"]:
        lost = f"; without ground since: {one['lost']}; still holds: {one['stands']}" if one["lost"] else ""  # fmt: skip
        since = f" since {seconds(one['since_ms'])}" if one["since_ms"] is not None else ""
        rows.append(
            (f"{one['text']}\n{one['name']}", one["state"] + ("\n" + since if since else ""), measured(one) or document.DASH,
             str(one["checks"]), ", ".join(one["guarantees"]), f"{one['note'] or document.DASH}{lost}")
        )  # fmt: skip
    head = ("Assumption", "State", "Worst seen", "Checks", "About", "Note")
    yield document.Table(head, tuple(rows), (32, 13, 15, 8, 9, 23), (3,))
    yield document.Head("Limits of the report")
    for text in report["limits"]:
        yield document.Words(text, "item")
    yield document.Head("Assumed by single theorems")
    theorems = report["proofs"]["theorems"]
    told = [(name, text) for name in sorted(theorems) for text in theorems[name]["assumptions"]]
    yield document.Table(("Theorem", "Assumes"), tuple(told), (40, 60), empty="None.")
