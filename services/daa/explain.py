"""Reasons for alerts, band edges and resolutions, in words and as data.

Every statement names the intruder, the volume, when it is violated and by how much. Values are recomputed by
the kernels that made the bands (`core.daa.reasons`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from cratous.core.daa.bands import Raw
from cratous.core.daa.reasons import Reason, reasons_at
from cratous.core.daa.session import Instant
from cratous.core.daa.state import DIMENSIONS, Alert, Guidance
from cratous.spec.daa.parameters import DETECTORS, NONE, RECOVERY, REGIONS, URGENCIES, Parameters

SHOW = {"hdir": ("deg", 180 / math.pi), "hs": ("m/s", 1.0), "vs": ("m/s", 1.0), "alt": ("m", 1.0)}


def value_text(dimension: str, value: float) -> str:
    """A value of a dimension with its unit."""
    unit, size = SHOW[dimension]
    return f"{value * size:.1f} {unit}"


def region_text(region: int) -> str:
    """The name of a region."""
    return REGIONS[region] if region >= 0 else "UNKNOWN"


def reason_text(reason: Reason) -> str:
    """One reason in words."""
    if reason.side:
        when = f" from {reason.first_s:.1f} s on" if reason.on_way else ""
        return (
            f"{reason.intruder}: coordination: a manoeuvre that does not keep to its side and away "
            f"counts as a {region_text(reason.region)} conflict{when}"
        )
    text = f"{reason.intruder}: {region_text(reason.region)} volume"
    if reason.first_s is None:
        return text + f" ({reason.limit_m:.0f} m, {reason.limit_z_m:.0f} m) is violated"
    where = "on the way" if reason.on_way else "after the manoeuvre"
    assert reason.last_s is not None
    assert reason.miss_m is not None
    assert reason.above_m is not None
    return (
        f"{text} is violated {where} from {reason.first_s:.1f} s to {reason.last_s:.1f} s; "
        f"least distance then {reason.miss_m:.0f} m (threshold {reason.limit_m:.0f} m), "
        f"{reason.above_m:.0f} m vertically (threshold {reason.limit_z_m:.0f} m)"
    )


def alert_text(p: Parameters, instant: Instant, alert: Alert) -> str:
    """Why there is an alert, or none."""
    if not alert.alerter:
        return f"{alert.id}: no alerter judges it"
    alerter = p.alerters[alert.alerter - 1]
    m = next(m for m in instant.metrics if m.id == alert.id)
    near = f"closest approach {m.dcpa_m:.0f} m in {m.tcpa_s:.1f} s, {m.vmd_m:.0f} m vertically"
    if not alert.level:
        soon = [t.first_s for t in alert.times if t.first_s is not None]
        if not soon:
            return f"{alert.id}: no alert; no volume of {alerter.name} is violated within {p.lookahead_time_s:.0f} s; {near}"
        return (
            f"{alert.id}: no alert yet; the first volume is violated in {min(soon):.1f} s; {near}"
        )
    level = alerter.levels[alert.level - 1]
    times = alert.times[alert.level - 1]
    held = ""
    if alert.level != alert.raw:
        held = f"; the level now is {alert.raw}, history (M of N, persistence) shows {alert.level}"
    when = "not violated any more"
    if times.first_s is not None and times.last_s is not None:
        when = f"violated from {times.first_s:.1f} s to {times.last_s:.1f} s, alerting time {level.alerting_time_s:.0f} s"
    v = level.volume
    return (
        f"{alert.id}: level {alert.level} of {alerter.name} ({region_text(level.region)}): "
        f"{DETECTORS[v.kind]} with {v.dthr_m:.0f} m, {v.zthr_m:.0f} m, {v.tthr_s:.0f} s is {when}; {near}{held}"
    )


def _unwrapped(g: Guidance, raw: Raw, value: float) -> float:
    """A direction unwrapped to within half a turn of the own one."""
    if g.dimension != "hdir":
        return value
    turn = 2 * math.pi
    return raw.grid.own + (value - raw.grid.own + math.pi) % turn - math.pi


def edges(p: Parameters, instant: Instant, g: Guidance, raw: Raw) -> Iterator[dict[str, Any]]:
    """Each edge between two bands, with the reasons on its more severe side."""
    step = raw.grid.step
    for left, right in zip(g.bands, g.bands[1:], strict=False):
        edge = left.high
        severe_right = _rank(right.region) > _rank(left.region)
        probe = _unwrapped(g, raw, edge + (step if severe_right else -step))
        found = reasons_at(p, instant.seen, raw, probe, DIMENSIONS.index(g.dimension))
        worst = right.region if severe_right else left.region
        yield {
            "edge": edge, "below": region_text(left.region), "above": region_text(right.region),
            "reasons": [r for r in found if r.region == worst] or found,
        }  # fmt: skip


def _rank(region: int) -> int:
    return 0 if region in (NONE, RECOVERY) else region


def resolution(p: Parameters, instant: Instant, g: Guidance, raw: Raw) -> list[str]:
    """What the preferred resolution resolves, and what was rejected."""
    name = g.dimension
    if g.why:
        return [f"{name}: {g.why}; no guidance"]
    if not g.needed:
        return [f"{name}: {value_text(name, g.own)} is free of conflict; nothing to resolve"]
    lines = []
    number = DIMENSIONS.index(name)
    solved = reasons_at(p, instant.seen, raw, g.own, number)
    for reason in solved:
        lines.append(f"{name}: now {value_text(name, g.own)}: {reason_text(reason)}")
    ways = {"right" if name == "hdir" else "up": g.up, "left" if name == "hdir" else "down": g.down}
    chosen = next(iter(ways)) if g.prefer_up else list(ways)[1]
    if ways[chosen] is None:
        r = g.recovery
        why = (
            "no manoeuvre in this dimension keeps even the NMAC cylinder clear"
            if r.saturated
            else "no value is free"
        )
        lines.append(f"{name}: no resolution; {why}")
        return lines
    for way, value in ways.items():
        if value is None:
            lines.append(f"{name}: {way} refused: no value that way is below the corrective region")
            continue
        change = abs(_unwrapped(g, raw, value) - raw.grid.own)
        sign = 1 if way in ("right", "up") else -1
        text = f"{name}: {way} to {value_text(name, value)}, a change of {value_text(name, change)}"
        if way != chosen:
            lines.append(f"{text}, refused: farther than {chosen}")
            continue
        rest = (
            "recovers"
            if g.recovery.computed
            else "is free of every volume of the corrective region"
        )
        lines.append(f"{text}, chosen: {rest}")
        nearer = _unwrapped(g, raw, value) - sign * raw.grid.step
        before = reasons_at(p, instant.seen, raw, nearer, number)
        lines += [f"{name}:   one step less is refused: {reason_text(r)}" for r in before[:3]]
    r = g.recovery
    if r.computed and not r.saturated and r.radius_m is not None and r.half_height_m is not None:
        lines.append(
            f"{name}: recovery: well clear again from {r.time_s:.1f} s on, keeping {r.radius_m:.0f} m "
            f"and {r.half_height_m:.0f} m until then (shrunk {r.shrunk} times)"
        )
    return lines


def coordination_text(p: Parameters, instant: Instant) -> list[str]:
    """With which intruder and how the ownship coordinates; empty without a coordination criterion."""
    if not (p.conflict_crit or p.recovery_crit):
        return []
    strategy, found = URGENCIES[p.urgency_strategy], instant.seen.coordination
    if found is None:
        return [f"coordination: nobody is most urgent now (urgency strategy {strategy})"]
    hand = "right" if found.horizontal > 0 else "left"
    level = "above" if found.vertical > 0 else "below"
    bands = [n for n, on in (("conflict", p.conflict_crit), ("recovery", p.recovery_crit)) if on]
    return [
        f"coordination: {found.id} is most urgent (urgency strategy {strategy}): pass it on the "
        f"{hand} hand of the relative flight, or go {level} it; asked of {' and '.join(bands)} bands"
    ]


def explain(p: Parameters, instant: Instant) -> list[str]:
    """Everything about one instant, in words."""
    lines = [f"time {instant.time_s:g} s, ownship {instant.own.id}"]
    lines += [f"alert {alert_text(p, instant, a)}" for a in instant.alerts]
    lines += coordination_text(p, instant)
    for g, held in zip(instant.guidance, instant.held, strict=True):
        raw = instant.raw[DIMENSIONS.index(g.dimension)]
        if raw is None:
            lines.append(f"{g.dimension}: {g.why}; no guidance")
            continue
        for edge in edges(p, instant, g, raw):
            lines.append(
                f"{g.dimension}: edge at {value_text(g.dimension, edge['edge'])} "
                f"({edge['below']} | {edge['above']})"
            )
            lines += [f"    {reason_text(r)}" for r in edge["reasons"][:3]]
            if not edge["reasons"]:
                lines.append(
                    "    the cylinder that recovery keeps clear is met, or history (M of N)"
                )
        lines += resolution(p, instant, g, raw)
        if g.needed and held != (g.up, g.down, g.prefer_up):
            value = held.up if held.prefer_up else held.down
            if value is not None:
                lines.append(
                    f"{g.dimension}: shown is {value_text(g.dimension, value)}, as before: a change "
                    "would be early or small, or keep a smaller distance"
                )
    return lines
