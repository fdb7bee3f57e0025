"""Renders `campaign.html` from campaign.json and flight maps as one file without external resources."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from math import ceil
from typing import Any

from cratous.services.campaign.outcomes import MEANING
from cratous.services.certify import templates

WIDTH, HEIGHT, EDGE = 520, 170, 44
BARS = 24
MOST_POINTS = 2000
MOST_PICTURES = 12


@cache
def _template() -> Any:
    folders = {
        "campaign.html": "cratous.services.campaign",
        "report.css": "cratous.services.certify",
    }
    environment = templates.environment(
        lambda name: files(folders[name]).joinpath(name).read_text("utf-8")
    )
    environment.filters["share"] = share
    return environment.get_template("campaign.html")


def share(rate: dict[str, Any]) -> str:
    """A rate in words, with its confidence interval."""
    text = f"{rate['count']} of {rate['of']}"
    if "at_most" in rate:
        return f"{text}: at most {100 * rate['at_most']:.3g} % (95 %)"
    if "interval" in rate:
        low, high = rate["interval"]
        return f"{text}: {100 * rate['share']:.3g} % ({100 * low:.3g} to {100 * high:.3g} %)"
    return text


def model_line(model: dict[str, int]) -> str:
    """How many logs are runs of the proved steps of authority, in words. model: as in campaign.json."""
    asked = model["fits"] + model["does_not_fit"]
    if not asked:
        return f"No log was held against the proved steps of authority: {model['not_asked']} without ICAROUS"
    words = f"Logs that fit the proved steps of authority: {model['fits']} of {asked}, {model['events']} events in these"
    return f"{words}; {model['not_asked']} without ICAROUS" if model["not_asked"] else words


def page(
    summary: dict[str, Any], links: dict[str, str], maps: Mapping[str, bytes] | None = None
) -> str:
    """The page. Both by the name of a run, links: its report, or otherwise its mission, relative to
    the page; maps: an SVG map of its flight, embedded in the page.
    """
    runs = {run["name"]: run for run in summary["runs"]}
    text: str = _template().render(
        c=summary,
        meaning=MEANING,
        model=model_line(summary["model"]) if summary["model"] else "",
        margins=list(_margins(summary)),
        places=list(_places(summary)),
        worst=[{**runs[name], "link": links.get(name)} for name in summary["worst"]],
        maps={name: b64encode(svg).decode() for name, svg in (maps or {}).items()},
        least=least_margin,
    )
    return text


def least_margin(run: dict[str, Any]) -> float | None:
    """The least margin in metres of any requirement of a run."""
    found = [
        row["margin"]
        for row in (run["result"] or {}).get("requirements", {}).values()
        if row["unit"] == "m" and row["margin"] is not None
    ]
    return min(found, default=None)


def _margins(summary: dict[str, Any]) -> Any:
    """Histograms: for each requirement and unit, a row of bars for each group."""
    for name in summary["requirements"]:
        units = {u for g in summary["groups"] for u in g["requirements"][name]["margins"]}
        for unit in sorted(units):
            groups = {
                f"{g['mission']}, {g['option']}": [
                    run["result"]["requirements"][name]["margin"]
                    for run in summary["runs"]
                    if (run["mission"], run["option"]) == (g["mission"], g["option"])
                    and run["result"] is not None
                    and run["result"]["kind"] == "flown"
                    and run["result"]["requirements"][name]["unit"] == unit
                    and run["result"]["requirements"][name]["margin"] is not None
                ]
                for g in summary["groups"]
            }
            yield from _histograms(name, unit, {key: v for key, v in groups.items() if v})


def _histograms(name: str, unit: str, groups: dict[str, list[float]]) -> Any:
    everything = [value for values in groups.values() for value in values]
    low, high = min(everything), max(everything)
    if not high > low:
        return
    for group, values in list(groups.items())[:MOST_PICTURES]:
        counts = [0] * BARS
        for value in values:
            counts[min(BARS - 1, int(BARS * (value - low) / (high - low)))] += 1
        top, wide = max(counts), (WIDTH - 2 * EDGE) / BARS
        bars = [
            {
                "x": round(EDGE + k * wide, 1),
                "y": round(HEIGHT - 24 - (HEIGHT - 40) * count / top, 1),
                "w": round(wide - 1, 1),
                "h": round((HEIGHT - 40) * count / top, 1),
                "bad": low + (k + 0.5) * (high - low) / BARS < 0,
            }
            for k, count in enumerate(counts)
            if count
        ]
        yield {
            "title": f"{name}, {group}", "unit": unit, "low": f"{low:.4g}", "high": f"{high:.4g}",
            "top": top, "bars": bars, "count": len(values), "width": WIDTH, "height": HEIGHT,
        }  # fmt: skip


def _places(summary: dict[str, Any]) -> Any:
    """For each drawn number: each run's value and least margin, coloured by outcome."""
    for name, span in list(summary["covered"].items())[:MOST_PICTURES]:
        points = [
            (run["drawn"][name], least, run["outcome"], run["name"])
            for run in summary["runs"]
            if isinstance(run["drawn"].get(name), (int, float))
            and (least := least_margin(run)) is not None
        ]
        if not points or not span["high"] > span["low"]:
            continue
        bottom = min(0.0, *(p[1] for p in points))
        top = max(1.0, *(p[1] for p in points))
        drawn = sorted(points, key=lambda p: p[2] == "holds")  # failures are never thinned out
        drawn = drawn[:: max(1, ceil(len(drawn) / MOST_POINTS))] if _all_hold(drawn) else drawn
        yield {
            "name": name, "low": f"{span['low']:.4g}", "high": f"{span['high']:.4g}",
            "top": f"{top:.4g}", "width": WIDTH, "height": HEIGHT,
            "zero": round(_y(0.0, bottom, top), 1),
            "points": [
                {
                    "x": round(_x(x, span["low"], span["high"]), 1), "y": round(_y(y, bottom, top), 1),
                    "outcome": outcome, "run": run,
                }
                for x, y, outcome, run in reversed(drawn)
            ],
        }  # fmt: skip


def _all_hold(points: list[Any]) -> bool:
    return all(point[2] == "holds" for point in points)


def _x(value: float, low: float, high: float) -> float:
    return EDGE + (WIDTH - 2 * EDGE) * (value - low) / (high - low)


def _y(value: float, low: float, high: float) -> float:
    return HEIGHT - 24 - (HEIGHT - 40) * (value - low) / (high - low)
