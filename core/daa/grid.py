"""The grid of one dimension: the manoeuvres that bands examine, as trajectories, or target altitudes.

Definitions: `spec.daa.meaning`. Which of them are safe is decided by the kernels of `core.daa.steps` and
`core.daa.climb`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cratous.core.daa.state import ALT, HDIR, HS, VS, Aircraft
from cratous.spec.daa.parameters import G_M_S2, Parameters

SLACK = 1e-9
"""A grid step this near to the limit [steps] counts as the limit."""


class Grid(NamedTuple):
    """The grid of one dimension: trajectories to both sides, or target altitudes."""

    own: float
    low: float
    high: float
    step: float
    step_s: float
    right: np.ndarray
    left: np.ndarray
    targets: np.ndarray
    rate_m_s: float
    accel_m_s2: float

    @property
    def values(self) -> int:
        """The number of grid values."""
        return len(self.right) + len(self.left) + len(self.targets)


EMPTY = np.zeros(0)


def value_range(p: Parameters, dimension: int, own: float) -> tuple[float, float]:
    """The range of values that bands cover."""
    if dimension == HDIR:
        return own - p.left_hdir_rad, own + p.right_hdir_rad
    low, high, below, above = {
        HS: (p.min_hs_m_s, p.max_hs_m_s, p.below_relative_hs_m_s, p.above_relative_hs_m_s),
        VS: (p.min_vs_m_s, p.max_vs_m_s, p.below_relative_vs_m_s, p.above_relative_vs_m_s),
        ALT: (p.min_alt_m, p.max_alt_m, p.below_relative_alt_m, p.above_relative_alt_m),
    }[dimension]
    if below == 0 and above == 0:
        return low, high
    # a negative distance means: up to the limit
    least = low if below < 0 else max(low, own - below)
    most = high if above < 0 else min(high, own + above)
    return least, most


def own_value(own: Aircraft, dimension: int) -> float:
    """The present value in a dimension."""
    if dimension == HDIR:
        return math.atan2(own.ve_m_s, own.vn_m_s) % (2 * math.pi)
    if dimension == HS:
        return math.hypot(own.ve_m_s, own.vn_m_s)
    return own.vu_m_s if dimension == VS else own.alt_m


def turn_rate(p: Parameters, speed_m_s: float) -> float:
    """Turn rate [rad/s] at a speed: as given, or of a coordinated turn at the bank angle."""
    if p.bank_angle_rad:
        return G_M_S2 * math.tan(p.bank_angle_rad) / speed_m_s
    return p.turn_rate_rad_s


def _count(width: float, step: float) -> int:
    return max(0, math.ceil(width / step - SLACK))


def grid(p: Parameters, own: Aircraft, dimension: int) -> Grid:
    """The trajectories of one dimension, or its target altitudes."""
    x0 = own_value(own, dimension)
    low, high = value_range(p, dimension, x0)
    # then: how the ownship moves before the manoeuvre, also where that is slower than a turn; and from
    # the step to the next one
    now = np.array([[*own[1:7], own.ve_m_s, own.vn_m_s, *own[4:7]]], dtype=np.float64)
    if dimension == ALT:
        step = p.step_alt_m
        count = math.floor((high - low) / step + SLACK) + 1
        targets = low + step * np.arange(count + 1)
        rate, accel = p.vertical_rate_m_s, p.vertical_accel_m_s2
        return Grid(x0, low, high, step, 0.0, now, now, targets, rate, accel)
    step, rate = {
        HDIR: (p.step_hdir_rad, 0.0),
        HS: (p.step_hs_m_s, p.horizontal_accel_m_s2),
        VS: (p.step_vs_m_s, p.vertical_accel_m_s2),
    }[dimension]
    speed = math.hypot(own.ve_m_s, own.vn_m_s)
    if dimension == HDIR:
        speed = max(speed, p.step_hs_m_s, p.min_airspeed_m_s)
        rate = turn_rate(p, speed)
        if p.hdir_bands_below_min_as == 1 and own_value(own, HS) < p.min_airspeed_m_s:
            rate = 0.0
    step_s = step / rate if rate else 0.0
    sides = []
    for sign, width in ((1.0, high - x0), (-1.0, x0 - low)):
        count = _count(width, step)
        if dimension == HDIR and count * step > math.pi * (1 + SLACK):
            count -= 1
        k = np.arange(count + 2)
        t = k * step_s
        path = np.repeat(now, count + 2, axis=0)
        if dimension == HDIR:
            angle = x0 + sign * step * k
            path[:, 3], path[:, 4] = speed * np.sin(angle), speed * np.cos(angle)
            if rate:
                omega = sign * rate
                path[:, 0] += (path[0, 4] - path[:, 4]) / omega
                path[:, 1] += (path[:, 3] - path[0, 3]) / omega
            path[:, 2] += own.vu_m_s * t
        elif dimension == HS:
            ux, uy = (own.ve_m_s / x0, own.vn_m_s / x0) if x0 > 0 else (0.0, 1.0)
            way = x0 * t + sign * rate * t * t / 2
            path[:, 0] += ux * way
            path[:, 1] += uy * way
            path[:, 2] += own.vu_m_s * t
            path[:, 3], path[:, 4] = ux * (x0 + sign * step * k), uy * (x0 + sign * step * k)
        else:
            path[:, 0] += own.ve_m_s * t
            path[:, 1] += own.vn_m_s * t
            path[:, 2] += own.vu_m_s * t + sign * rate * t * t / 2
            path[:, 5] += sign * step * k
        if step_s:
            path[:-1, 8:11] = np.diff(path[:, :3], axis=0) / step_s
        sides.append(path[:-1])
    return Grid(x0, low, high, step, step_s, sides[0], sides[1], EMPTY, 0.0, 0.0)


def sides_in(dimension: int, sides: np.ndarray) -> np.ndarray:
    """The columns of sides (n, 2) that matter in a dimension: the horizontal ones for directions and speeds, the
    vertical ones for vertical speeds, none for altitudes.
    """
    return sides * np.array([dimension in (HDIR, HS), dimension == VS])
