"""Evidence on last times to manoeuvre: why another system's differs, computed again here.

Two causes of differences in DAIDALUS are known, and each is claimed only where it is shown:
- a last time of 0 is reported as none: shown by a grid value that is free of conflict now, decided
  by the exact readings of the kernels;
- positions on the globe are moved along great circles and projected again at every time that is
  tried: shown by computing the same, which then gives the same number.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np

from cratous.core.daa.bands import Traffic, last_free, manoeuvres
from cratous.core.daa.climb import altitude_conflict, safe_altitudes
from cratous.core.daa.frame import RADIUS_M, project
from cratous.core.daa.grid import grid
from cratous.core.daa.guidance import evaluate
from cratous.core.daa.records import Intruders, Looking, Regaining
from cratous.core.daa.state import Aircraft
from cratous.core.daa.steps import safe_steps
from cratous.core.daa.uncertainty import lost
from cratous.core.daa.volume import in_conflict
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.readings.machine.compiled import machine
from cratous.core.well_clear.thresholds import Thresholds
from cratous.services.conform.values import finite, numbers
from cratous.spec.daa.parameters import Parameters


def _with(driver: Any, **kernels: Any) -> Any:
    """The driver with other functions for names that it uses."""
    return FunctionType(driver.__code__, {**driver.__globals__, **kernels}, driver.__name__)


def _exact_conflict(
    kind: int, s: Vec2, v: Vec2, sz: float, vz: float, thresholds: Thresholds, *span: float
) -> bool:
    """`in_conflict` on the rationals that the doubles are."""
    state = (Vec2(*map(float, s)), Vec2(*map(float, v)), float(sz), float(vz))
    limits = Thresholds(*map(float, thresholds))
    return bool(exact(in_conflict, int(kind), *state, limits, *map(float, span)))


def exact_evaluate() -> Callable[..., bool]:
    """`daa_guide.evaluate` over the exact readings of its kernels."""
    exactly_lost = _with(lost, in_conflict=_exact_conflict)
    steps = _with(safe_steps, lost=exactly_lost)
    climbing = _with(altitude_conflict, lost=exactly_lost)
    heights = _with(safe_altitudes, altitude_conflict=climbing)
    made: Callable[..., bool] = _with(evaluate, safe_steps=steps, safe_altitudes=heights)
    return made


class Asked(NamedTuple):
    """The last time to manoeuvre in question: out of conflict with intruder i, in one dimension."""

    p: Parameters
    own: Aircraft
    traffic: Traffic
    i: int
    dimension: int


def has_way(asked: Asked, judge: Callable[..., bool]) -> bool:
    """Whether some grid value of the dimension is free of conflict with the intruder now."""
    p, own, traffic, i, dimension = asked
    g, region = grid(p, own, dimension), p.corrective_region
    horizons = np.full(len(traffic.ids), p.lookahead_time_s)
    safe_r = np.ones(len(g.targets) or len(g.right), dtype=np.bool_)
    safe_l = np.ones(len(g.left), dtype=np.bool_)
    intruders = Intruders(
        traffic.states, traffic.kinds[region], traffic.volumes[region], horizons,
        np.zeros_like(traffic.sides),
    )  # fmt: skip
    looking = Looking(p.lookahead_time_s, p.bands_add_time_to_maneuver, 0.0, True, True)
    always = Regaining(0.0, 0.0, 0.0, False)
    found = judge(
        manoeuvres(g, 0.0), intruders, np.array([i]), always, looking, safe_r, safe_l
    )  # fmt: skip
    return bool(found)


def _moved(state: dict[str, Any], lat0: float, lon0: float, t_s: float) -> tuple[float, ...]:
    """Position and velocity after t_s along a great circle, in the plane at (lat0, lon0)."""
    lat, lon = finite(state["lat_rad"], "lat_rad"), finite(state["lon_rad"], "lon_rad")
    ve, vn, vu = numbers(state["gv"], "gv", 3)
    angle, track = math.hypot(ve, vn) * t_s / RADIUS_M, math.atan2(ve, vn)
    there = math.asin(
        math.sin(lat) * math.cos(angle) + math.cos(lat) * math.sin(angle) * math.cos(track)
    )
    across = math.atan2(
        math.sin(track) * math.sin(angle) * math.cos(lat),
        math.cos(angle) - math.sin(lat) * math.sin(there),
    )
    local = project(lat0, lon0, there, lon + across, ve, vn)
    alt = finite(state["alt"], "alt") + vu * t_s
    return (local.east_m, local.north_m, alt, local.ve_m_s, local.vn_m_s, vu)


def along_great_circles(asked: Asked, out: dict[str, Any], entry_s: float) -> float | None:
    """The last time to manoeuvre if both move along great circles until then [s]; None if there is none."""
    own, traffic, i = asked.own, asked.traffic, asked.i
    state, other = out["own"], out["traffic"][i]["state"]
    lat0, lon0 = finite(state["lat_rad"], "lat_rad"), finite(state["lon_rad"], "lon_rad")

    def free(t_s: float) -> bool:
        there = traffic.states.copy()
        there[i] = _moved(other, lat0, lon0, t_s)
        e, n, alt, ve, vn, vu = _moved(state, lat0, lon0, t_s)
        moved = Aircraft(own.id, e, n, alt, ve, vn, vu, own.alerter)
        then = asked._replace(own=moved, traffic=traffic._replace(states=there))
        return has_way(then, machine(evaluate))

    return last_free(free, entry_s)


def explained(
    asked: Asked,
    out: dict[str, Any],
    ours: float | None,
    theirs: float | None,
    entry_s: float | None,
) -> str:
    """The known cause in the other system that explains the difference; "" if none is shown to."""
    if ours == 0 and theirs is None and has_way(asked, exact_evaluate()):
        return "last time 0"
    if "lat_rad" in out["own"] and entry_s is not None:
        again = along_great_circles(asked, out, entry_s)
        if again is None or theirs is None:
            return "great circle" if again is theirs else ""
        return "great circle" if abs(again - theirs) <= 1e-4 else ""
    return ""
