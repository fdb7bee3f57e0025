"""Renders `report.html` and `map.svg` from report.json alone; no external resource is loaded."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from cratous.core.kernel.names import short
from cratous.services.assumptions.observation_texts import measured
from cratous.services.certify import templates
from cratous.services.certify.alerts import level_name, none_said
from cratous.services.certify.blame_texts import sentence
from cratous.services.certify.charts import altitude_view, separation_view
from cratous.services.certify.command import flown_in_processes
from cratous.services.certify.gantt import gantt, plan_bars, plan_rows, tree
from cratous.services.certify.picture import map_view, time_view
from cratous.services.certify.proofs import statuses
from cratous.services.certify.requirement_texts import margin as own_margin
from cratous.services.certify.requirement_texts import sentence as own_blamed
from cratous.services.certify.requirement_views import own_requirements
from cratous.services.certify.trace import chains
from cratous.spec.algebra import parse
from cratous.spec.mission.plan import cost_text, percent

MAP = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {{ map.width }} {{ map.height }}" \
width="{{ map.width }}" height="{{ map.height }}" role="img" aria-label="Map of the flight">
<style>
{% include 'report.css' %}
svg { background: var(--panel); }
</style>
{% include 'map.svg' %}
</svg>
"""
MAP_PAGE = "the map alone"


@cache
def _environment() -> Any:
    folder = files("cratous.services.certify")
    environment = templates.environment(
        lambda name: MAP if name == MAP_PAGE else folder.joinpath(name).read_text("utf-8")
    )
    environment.filters["seconds"] = seconds
    environment.filters["margin"] = margin
    environment.filters["percent"] = percent
    environment.filters["measured"] = measured
    environment.filters["blamed"] = sentence
    environment.filters["own_blamed"] = own_blamed
    environment.filters["own_margin"] = own_margin
    environment.filters["alert_level"] = level_name
    environment.filters["no_alerts"] = none_said
    environment.filters["cost"] = lambda value, kind: cost_text(kind, value)
    return environment


def seconds(time_ms: float | None) -> str:
    """Milliseconds as seconds, formatted as in the notes of verdicts; a dash for None."""
    return "–" if time_ms is None else f"{time_ms / 1000:.1f} s"


def margin(row: dict[str, Any]) -> str:
    """A margin with its unit; a dash if there is none."""
    if row["margin"] is None:
        return "–"
    unit = row["unit"]
    if unit == "ms":
        return f"{row['margin'] / 1000:.1f} s"
    return f"{row['margin']:.4g} {unit}".strip()


def repeats(report: dict[str, Any]) -> bool:
    """Whether the command reproduces the log exactly: flights in processes run in real time and do not."""
    return not flown_in_processes(report["command"])


def render(report: dict[str, Any]) -> str:
    """The page; every text from the report is escaped."""
    text: str = _environment().get_template("report.html").render(
        r=report, map=map_view(report), time=time_view(report), near=separation_view(report),
        high=altitude_view(report), rows_of=_rows_of(report),
        late_zones=sum(bool(c.get("zone")) for c in report["mission"].get("changes", ())),
        gantt=_gantt(report), tree=_tree(report), losses=losses(report), names=_names(report),
        own=own_requirements(report), chains=chains(report), statuses=statuses(report["proofs"]), repeats=repeats(report),
    )  # fmt: skip
    return text


def _rows_of(report: dict[str, Any]) -> dict[str, int]:
    """For each requirement the number of the constraint that determines its verdict; 0 for none."""
    found = {}
    for wanted in report["requirements"]:
        rows = [
            k
            for k, row in enumerate(report["constraints"], 1)
            if row["requirement"] == wanted["requirement"] and row["verdict"] == wanted["verdict"]
        ]
        same = [k for k in rows if report["constraints"][k - 1]["item"] == wanted["item"]]
        found[wanted["requirement"]] = next(iter([*same, *rows]), 0)
    return found


def map_svg(report: dict[str, Any]) -> str:
    """The map of the flight as a stand-alone SVG with its style."""
    text: str = _environment().get_template(MAP_PAGE).render(map=map_view(report))
    return text


def _names(report: dict[str, Any]) -> dict[str, str]:
    """Display names of the page's kernels: the shortest that are unambiguous."""
    kernels = report["proofs"]["kernels"]
    named = {name for row in report["constraints"] for name in row["kernels"]}
    parts = {part for one in kernels.values() for part in (*one["within"], *one["checked_by"])}
    return short({*kernels, *named, *parts, *(one["step_of"] for one in kernels.values())})


def losses(report: dict[str, Any]) -> list[dict[str, Any]]:
    """The judged losses, with their manoeuvres grouped by dimension."""
    found = []
    for row in report["constraints"]:
        for loss in (row.get("evidence") or {}).get("losses", []):
            groups: dict[str, list[list[Any]]] = {}
            for one in loss.get("manoeuvres", []):
                groups.setdefault(one[0], []).append(one)
            found.append(
                {
                    "way_out": None,
                    **loss,
                    "tried": [sum(i[k] for i in loss["instants"]) for k in range(1, 5)],
                    "groups": [_group(name, rows) for name, rows in groups.items()],
                }
            )
    return found


def _group(name: str, rows: list[list[Any]]) -> dict[str, Any]:
    """A group of manoeuvre rows, with the columns of `services.monitor.excuses.COLUMNS`."""
    values, times = [r[1] for r in rows], [r[4] for r in rows]
    return {
        "dimension": name, "count": len(rows), "unit": rows[0][2],
        "low": f"{min(values):.1f}", "high": f"{max(values):.1f}",
        "by": sorted({r[3] for r in rows}), "first_s": f"{min(times):.1f}",
        "last_s": f"{max(times):.1f}", "apart_m": f"{min(r[5] for r in rows):.0f}",
    }  # fmt: skip


def _gantt(report: dict[str, Any]) -> str:
    plan = report["plan"]
    vehicles = [vehicle["id"] for vehicle in report["mission"]["vehicles"]]
    return gantt(plan_bars(plan), vehicles, plan_rows(plan))


def _tree(report: dict[str, Any]) -> str:
    """The tree of the task relations; empty if there are none."""
    text = report["mission"]["relations"].strip()
    return tree(parse(text)) if text else ""
