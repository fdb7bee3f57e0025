"""Bands of one dimension from safe grid values: guidance, colours, resolutions.

Definitions: `spec.daa.meaning`. This is bookkeeping on arrays around the drivers of `core.daa.guidance`, whose
kernels decide which grid values are safe.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from cratous.core.daa.grid import SLACK, Grid, grid, own_value, sides_in, value_range
from cratous.core.daa.guidance import guide, last_time
from cratous.core.daa.records import Guided, Intruders, Manoeuvres, RecoverySizes, Regions
from cratous.core.daa.state import (
    ALT,
    DIMENSIONS,
    HDIR,
    UNKNOWN,
    VS,
    Aircraft,
    Band,
    Guidance,
    Recovery,
)
from cratous.core.readings.tiered import swift
from cratous.spec.daa.parameters import NEAR, NONE, RECOVERY, Parameters, sensitivity

SAMPLE_S = 1.0
"""Sampling interval of changes of altitude while the vertical speed changes [s]."""
EDGE = 1e-7
"""A value this near to an edge counts as on it (rad, m/s, m): the own value is a grid value."""


class Traffic(NamedTuple):
    """Intruders as arrays: states (n, 6); per region: mapped, kinds, volumes, alerting times, whether in
    conflict within them; sides (n, 2) to keep to, horizontal and vertical, 0: none."""

    ids: tuple[str, ...]
    states: np.ndarray
    mapped: np.ndarray
    kinds: np.ndarray
    volumes: np.ndarray
    alerting_s: np.ndarray
    conflict: np.ndarray
    violated: np.ndarray
    sides: np.ndarray


def _recovery_size(p: Parameters, alt_m: float) -> tuple[float, float]:
    """The cylinder to keep clear before recovery: as given, or of the TCAS level at this altitude."""
    table = sensitivity(alt_m)
    radius = p.min_horizontal_recovery_m or table.hmd_m
    half = p.min_vertical_recovery_m or table.zthr_m
    return max(radius, p.horizontal_nmac_m), max(half, p.vertical_nmac_m)


def colours(safe: np.ndarray, state: np.ndarray, recovered: bool) -> np.ndarray:
    """Regions of the cells between neighbouring grid values: (K + 1) values give K cells.

    A cell is safe in a region iff both of its ends are. Its colour is the most severe region in which it is not;
    RECOVERY where recovery is possible.
    """
    cells = np.zeros(safe.shape[1] - 1, dtype=np.int64)
    for region in range(1, NEAR + 1):
        if state[region]:
            cells[~(safe[region, 1:] & safe[region, :-1])] = region
    if recovered:
        cells[safe[4, 1:] & safe[4, :-1]] = RECOVERY
    return cells


def merged(edges: np.ndarray, cells: np.ndarray, low: float, high: float) -> list[Band]:
    """Merge neighbouring cells of one colour into bands, clipped to [low, high]."""
    begins = np.where(edges[:-1] < low, low, edges[:-1])
    ends = np.where(edges[1:] > high, high, edges[1:])
    inside = begins < ends
    begins, ends, colour = begins[inside], ends[inside], cells[inside]
    if not len(colour):
        return []
    changes = np.flatnonzero(colour[1:] != colour[:-1]) + 1
    firsts = np.concatenate([[0], changes])
    lasts = np.concatenate([changes - 1, [len(colour) - 1]])
    columns = begins[firsts].tolist(), ends[lasts].tolist(), colour[firsts].tolist()
    return [Band(*one) for one in zip(*columns, strict=True)]


def on_circle(bands: list[Band]) -> tuple[Band, ...]:
    """Bands of directions around the own one, mapped to [0, 2 pi)."""
    turn = 2 * math.pi
    parts = []
    for low, high, region in bands:
        shift = -turn * math.floor(low / turn)
        low, high = low + shift, high + shift
        if high <= turn + SLACK:
            parts.append(Band(low, min(high, turn), region))
        else:
            parts += [Band(low, turn, region), Band(0.0, high - turn, region)]
    found: list[Band] = []
    for band in sorted(b for b in parts if b.high - b.low > SLACK):
        if found and found[-1].region == band.region and band.low - found[-1].high <= SLACK:
            found[-1] = found[-1]._replace(high=band.high)
        else:
            found.append(band)
    return tuple(found)


def severity(region: int) -> int:
    """Severity of a region as a colour: RECOVERY and NONE are no conflict."""
    return 0 if region in (NONE, RECOVERY) else region


def region_of(bands: tuple[Band, ...], value: float, circle: bool) -> int:
    """The region of a value; on an edge, the milder of the two."""
    near = [
        b.region
        for b in bands
        if b.low - EDGE <= value <= b.high + EDGE
        or (circle and abs(value - b.low) >= 2 * math.pi - EDGE)
        or (circle and abs(value - b.high) >= 2 * math.pi - EDGE)
    ]
    return min(near, key=severity, default=UNKNOWN)


class Directive(NamedTuple):
    """The nearest values that resolve the conflict: to the right or up, to the left or down; None:
    none on that side.
    """

    up: float | None
    down: float | None
    prefer_up: bool


def directive(bands: tuple[Band, ...], own: float, corrective: int, circle: bool) -> Directive:
    """The nearest edges of bands below the corrective region on both sides of the own value.

    Directions are searched within half a turn. Ties go to the right or up.
    """
    turn = 2 * math.pi
    free = [b for b in bands if 0 <= severity(b.region) < corrective and b.region != UNKNOWN]
    if circle:
        free = [
            b._replace(low=b.low + k * turn, high=b.high + k * turn)
            for b in free
            for k in (-1, 0, 1)
        ]
    up = min((max(b.low, own) for b in free if b.high > own + EDGE), default=math.inf)
    down = max((min(b.high, own) for b in free if b.low < own - EDGE), default=-math.inf)
    if circle and up >= own + math.pi - SLACK:
        up = math.inf
    if circle and down <= own - math.pi + SLACK:
        down = -math.inf
    prefer = math.isfinite(up) and up - own <= own - down
    wrap = turn if circle else math.inf
    return Directive(
        (up % wrap if circle else up) if math.isfinite(up) else None,
        (down % wrap if circle else down) if math.isfinite(down) else None,
        prefer,
    )


class Raw(NamedTuple):
    """Bands around the own value, not wrapped, before the history of earlier bands is applied."""

    grid: Grid
    bands: list[Band]
    recovery: Recovery
    peripheral: dict[int, tuple[str, ...]]
    safe_r: np.ndarray
    safe_l: np.ndarray
    state: np.ndarray


def manoeuvres(g: Grid, piece_s: float) -> Manoeuvres:
    """The manoeuvres of a grid; piece_s: for how long the segment after each step is checked [s]."""
    return Manoeuvres(
        g.right, g.left, g.step_s, piece_s, g.targets, g.rate_m_s, g.accel_m_s2, SAMPLE_S
    )


def raw_bands(
    p: Parameters,
    own: Aircraft,
    traffic: Traffic,
    dimension: int,
    recover: bool,
    no_descent: bool = False,
) -> Raw:
    """The bands of one dimension now; no_descent: values below the own one are excluded."""
    g = grid(p, own, dimension)
    below = 0
    if no_descent and dimension == VS:
        below = len(g.left) - 1
        g = g._replace(left=g.left[:1])
    elif no_descent and dimension == ALT:
        below = int(np.searchsorted(g.targets, g.own))
        below = min(below, len(g.targets) - 2)
        g = g._replace(targets=g.targets[below:])
    size_r = len(g.targets) or len(g.right)
    safe_r = np.ones((5, size_r), dtype=np.bool_)
    safe_l = np.ones((5, len(g.left)), dtype=np.bool_)
    n = len(traffic.ids)
    sides = sides_in(dimension, traffic.sides)
    peripheral = np.zeros((4, n), dtype=np.bool_)
    recovery, state = np.zeros(5), np.zeros(5, dtype=np.int64)
    radius, half = _recovery_size(p, own.alt_m)
    if n:
        regions = Regions(
            traffic.states, traffic.mapped, traffic.conflict, traffic.kinds, traffic.volumes,
            traffic.alerting_s, sides * p.conflict_crit, sides * p.recovery_crit,
        )  # fmt: skip
        sizes = RecoverySizes(
            radius, half, p.horizontal_nmac_m, p.vertical_nmac_m, p.ca_bands, p.ca_factor,
            p.recovery_stability_time_s,
        )  # fmt: skip
        swift(guide, n * g.values // 3)(
            manoeuvres(g, g.step_s), regions, p.lookahead_time_s, p.bands_add_time_to_maneuver,
            p.corrective_region, recover, sizes,
            Guided(safe_r, safe_l, peripheral, recovery, state),
        )  # fmt: skip
    saturated = bool(recovery[0])
    said = Recovery()
    if state[4]:
        said = Recovery(True, saturated, None, int(recovery[2]), None, None)
        if not saturated:
            said = Recovery(
                True,
                False,
                float(recovery[1]),
                int(recovery[2]),
                float(recovery[3]),
                float(recovery[4]),
            )
    recovered = bool(state[4]) and not saturated
    at_once = g.step_s == 0 and (dimension != ALT or not (g.rate_m_s and g.accel_m_s2))
    corrective = p.corrective_region
    if recover and at_once and state[corrective] == 1 and traffic.violated[corrective].any():
        # well clear is already lost: every conflict-free value regains it at once
        said, recovered = Recovery(True, False, 0.0, 0, radius, half), True
        safe_r[4], safe_l[4] = safe_r[corrective], safe_l[corrective]
    right = colours(safe_r, state, recovered)
    refused = np.full(below, NEAR, dtype=np.int64)
    if dimension == ALT:
        down = g.low + g.step * np.arange(below)
        bands = merged(
            np.concatenate([down, g.targets]), np.concatenate([refused, right]), g.low, g.high
        )
    else:
        left = np.concatenate([colours(safe_l, state, recovered), refused])[::-1]
        cells = np.concatenate([left, right])
        edges = g.own + g.step * np.arange(-len(left), len(right) + 1)
        bands = merged(edges, cells, g.low, g.high)
    lists = {
        region: tuple(traffic.ids[i] for i in range(n) if peripheral[region, i])
        for region in range(1, NEAR + 1)
    }
    return Raw(g, bands, said, lists, safe_r, safe_l, state)


def last_times(
    p: Parameters, own: Aircraft, traffic: Traffic, i: int, entry_s: float, exact: bool = False
) -> tuple[float | None, ...]:
    """Last time to manoeuvre out of conflict with intruder i, in each dimension [s]; None: too late.

    The path to a step is sampled at the steps before it, as in DAIDALUS; exact: checked continuously, as for bands.
    """
    found: list[float | None] = []
    region = p.corrective_region
    for dimension in range(4):
        g = grid(p, own, dimension)
        safe_r = np.ones(len(g.targets) or len(g.right), dtype=np.bool_)
        safe_l = np.ones(len(g.left), dtype=np.bool_)
        intruders = Intruders(
            traffic.states, traffic.kinds[region], traffic.volumes[region],
            traffic.alerting_s[region].copy(), np.zeros((len(traffic.states), 2), dtype=np.int64),
        )  # fmt: skip
        time_s = swift(last_time, g.values // 3)(
            manoeuvres(g, g.step_s if exact else 0.0), intruders, i, p.lookahead_time_s,
            p.bands_add_time_to_maneuver, entry_s, safe_r, safe_l,
        )  # fmt: skip
        found.append(None if time_s < 0 else float(time_s))
    return tuple(found)


def last_free(free: Callable[[float], bool], entry_s: float) -> float | None:
    """The last time in (0, entry_s) at which free(t) holds, by bisection to 0.5 s; None: none."""
    green_s, red_s, t_s = 0.0, entry_s, 0.0
    while red_s - green_s > 0.5:
        if free(t_s):
            green_s = t_s
        else:
            red_s = t_s
        t_s = (green_s + red_s) / 2
    return green_s if green_s > 0 else None


def out_of_range(p: Parameters, own: Aircraft, dimension: int) -> str:
    """Why no bands are possible: the own value lies outside its range; "" if it does not."""
    if dimension == HDIR:
        return ""
    x0 = own_value(own, dimension)
    low, high = value_range(p, dimension, x0)
    if low <= x0 <= high:
        return ""
    return f"own {DIMENSIONS[dimension]} {x0:g} is outside of [{low:g}, {high:g}]"


def unknown(p: Parameters, own: Aircraft, dimension: int, why: str) -> Guidance:
    """Guidance that is unknown, with the reason."""
    x0 = own_value(own, dimension)
    low, high = value_range(p, dimension, x0)
    band = Band(low, high, UNKNOWN)
    return Guidance(
        DIMENSIONS[dimension], x0, (band,), UNKNOWN, False, None, None, False, Recovery(), {}, why
    )
