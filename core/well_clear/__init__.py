"""Well clear for users: is it lost, will it be, and from when to when.

A state is relative, ownship minus intruder: `s` position [m] and `v` velocity [m/s], each
`(x, y, z)`, in any horizontal frame, z up. Arrays of states have the shape `(..., 3)`; s and v, the
thresholds of the volume and b_s, t_s are broadcast against each other over the leading dimensions,
and results have the broadcast shape. Verdicts are exact: those of the very numbers that the doubles
are, touching included. Instants are enclosed: the true one lies between `low` and `high`.

>>> volume = Volume(dthr_m=1222.32, zthr_m=137.16, tthr_s=35.0)
>>> is_violated((3000.0, 0.0, 0.0), (-60.0, 0.0, 0.0), volume)
False
>>> is_lost_during((3000.0, 0.0, 0.0), (-60.0, 0.0, 0.0), volume, 0.0, 120.0)
True
>>> found = loss((3000.0, 0.0, 0.0), (-60.0, 0.0, 0.0), volume, 0.0, 120.0)
>>> round(found.first_s.low, 6), round(found.last_s.high, 6)
(5.64356, 70.372)
>>> loss((3000.0, 0.0, 0.0), (60.0, 0.0, 0.0), volume, 0.0, 120.0) is None
True

The kernels themselves are here as well, by name. Bad input raises `spec.errors.BadInput`, which
names the argument: not finite, a threshold below zero, a shape that does not fit, b_s after t_s.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from cratous.core.kernel import Vec2
from cratous.core.readings.enclosed import enclosed
from cratous.core.readings.exact import exact, exactly
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear.during import (
    Window,
    cylinder_during,
    dips_to_zero,
    horizontal_violation_within,
    horizontal_violation_within_tcpa,
    horizontal_violation_within_tep,
    layer_window,
    vertical_window,
    violation_during_taumod,
    violation_during_tcpa,
    violation_during_tep,
    violation_within,
    within_during,
)
from cratous.core.well_clear.interval import (
    Span,
    course_reaches,
    cylinder_interval,
    cylinder_times,
    horizontal_interval_taumod,
    horizontal_interval_tcpa,
    horizontal_interval_tep,
    or_empty,
    times_taumod,
    times_tcpa,
    times_tep,
    times_vertical,
    vertical_interval,
    violation_interval_taumod,
    violation_interval_tcpa,
    violation_interval_tep,
    violation_times_taumod,
    violation_times_tcpa,
    violation_times_tep,
)
from cratous.core.well_clear.now import (
    cylinder_conflict,
    cylinder_violation,
    horizontal_decision,
    horizontal_violation,
    horizontal_violation_tau,
    horizontal_violation_tcpa,
    horizontal_violation_tep,
    layer_violation,
    tcpa_decision,
    tep_decision,
    vertical_violation,
    vertical_violation_vmod,
    violation,
    violation_taumod,
    violation_tcpa,
    violation_tep,
)
from cratous.core.well_clear.thresholds import StandardThresholds, Thresholds
from cratous.spec.errors import BadInput

NOW: dict[str, Any] = {"tau_mod": violation_taumod, "tcpa": violation_tcpa, "tep": violation_tep}
DURING: dict[str, Any] = {
    "tau_mod": violation_during_taumod,
    "tcpa": violation_during_tcpa,
    "tep": violation_during_tep,
}
INTERVAL: dict[str, Any] = {
    "tau_mod": violation_interval_taumod,
    "tcpa": violation_interval_tcpa,
    "tep": violation_interval_tep,
}
TIMES: dict[str, Any] = {
    "tau_mod": violation_times_taumod,
    "tcpa": violation_times_tcpa,
    "tep": violation_times_tep,
}
THRESHOLDS = Thresholds._fields


@dataclass(frozen=True)
class Volume:
    """A well-clear volume: its time variable and its thresholds, each a number or an array >= 0.

    dthr_m: distance [m]; zthr_m: altitude [m]; tthr_s: on the time variable [s]; tcoa_s: on the time to co-altitude
    [s]; vmod_s: time by which the closing climb rate is multiplied [s]; model: `tau_mod` (DO-365), `tcpa`, `tep`.
    Sets are closed. Raises BadInput.

    >>> Volume(100.0, 30.0, tthr_s=-1.0)
    Traceback (most recent call last):
    ...
    cratous.spec.errors.BadInput: tthr_s: a threshold below zero; expected 0 or more; got -1.0
    """

    dthr_m: Any
    zthr_m: Any
    tthr_s: Any = 0.0
    tcoa_s: Any = 0.0
    vmod_s: Any = 0.0
    model: str = "tau_mod"

    def __post_init__(self) -> None:
        if self.model not in NOW:
            raise BadInput(
                "no such model", item="model", expected=" or ".join(NOW), got=repr(self.model)
            )
        for name in THRESHOLDS:
            values = _numbers(getattr(self, name), name)
            if np.any(values < 0):
                least = float(np.min(values))
                raise BadInput(
                    "a threshold below zero", item=name, expected="0 or more", got=str(least)
                )

    @property
    def thresholds(self) -> Thresholds:
        """The five thresholds in the kernels' order."""
        return Thresholds(*[getattr(self, name) for name in THRESHOLDS])


def cylinder(radius_m: Any, half_height_m: Any) -> Volume:
    """The closed cylinder as a volume: within radius_m and half_height_m now [m].

    >>> is_violated((1250.0, 0.0, 100.0), (10.0, 0.0, 0.0), cylinder(1250.0, 100.0))
    True
    """
    return Volume(radius_m, half_height_m, model="tep")


class Bounds(NamedTuple):
    """An enclosure: low <= the true instant <= high [s]."""

    low: float
    high: float


class Loss(NamedTuple):
    """When well clear is lost: the first and the last instant."""

    first_s: Bounds
    last_s: Bounds


class Losses(NamedTuple):
    """Losses of many states, arrays of one shape: `lost` is exact; instants are NaN where not lost."""

    lost: Any
    first_low_s: Any
    first_high_s: Any
    last_low_s: Any
    last_high_s: Any


def is_violated(s: Any, v: Any, volume: Volume) -> Any:
    """Whether well clear is lost now: a bool for one state, else an array of bool. Exact.

    >>> is_violated([[100.0, 0.0, 0.0], [5000.0, 0.0, 0.0]], (0.0, 0.0, 0.0), cylinder(500.0, 50.0))
    array([ True, False])
    """
    columns = [*_state(s, v), *volume.thresholds]
    return _verdict(NOW[volume.model], _fitting(columns))


def is_lost_during(s: Any, v: Any, volume: Volume, b_s: Any, t_s: Any) -> Any:
    """Whether well clear is lost at some instant of [b_s, t_s] of straight flight. Exact.

    A bool for one state, else an array of bool.
    """
    columns = [*_state(s, v), *volume.thresholds, *_span(b_s, t_s)]
    return _verdict(DURING[volume.model], _fitting(columns))


def loss(s: Any, v: Any, volume: Volume, b_s: float, t_s: float) -> Loss | None:
    """First and last instant of [b_s, t_s] at which well clear is lost; None if it is not.

    For one state; the verdict is exact, the instants are enclosed.

    >>> found = loss((0.0, 300.0, 0.0), (-10.0, 0.0, 0.0), cylinder(500.0, 50.0), 0.0, 60.0)
    >>> round(found.last_s.low, 9)
    40.0
    """
    found = losses(s, v, volume, b_s, t_s)
    if np.ndim(found.lost):
        raise BadInput(
            "more than one state", item="s", expected="shape (3,)", got=str(np.shape(found.lost))
        )
    if not found.lost:
        return None
    low, high, early, late = (float(value) for value in found[1:])
    return Loss(Bounds(low, high), Bounds(early, late))


def losses(s: Any, v: Any, volume: Volume, b_s: Any, t_s: Any) -> Losses:
    """The same for arrays of states: the exact verdicts and the enclosed instants.

    >>> found = losses([[0.0, 300.0, 0.0], [0.0, 600.0, 0.0]], (-10.0, 0.0, 0.0),
    ...                cylinder(500.0, 50.0), 0.0, 60.0)
    >>> found.lost, found.first_low_s
    (array([ True, False]), array([ 0., nan]))
    """
    columns = _fitting([*_state(s, v), *volume.thresholds, *_span(b_s, t_s)])
    lost = np.asarray(exactly(DURING[volume.model])(*columns))
    spread = [np.broadcast_to(column, lost.shape) for column in columns]
    parts = [np.full(lost.shape, np.nan) for _ in range(4)]
    if lost.any():
        chosen = [column[lost] for column in spread]
        begin, end = chosen[-2:]
        first, last = enclosed(TIMES[volume.model])(*chosen)
        for part, value in zip(parts, (*first, *last), strict=True):
            part[lost] = np.clip(value, begin, end)
    return Losses(lost if lost.ndim else bool(lost), *parts)


def spans_on_doubles(s: Any, v: Any, volume: Volume, b_s: Any, t_s: Any) -> Span:
    """The interval kernel on plain doubles, fast and neither exact nor enclosed: a Span of arrays.

    Where nothing is lost it is Span(1, 0). For drawing and for search whose result is checked.

    >>> spans_on_doubles((0.0, 300.0, 0.0), (-10.0, 0.0, 0.0), cylinder(500.0, 50.0), 0.0, 60.0)
    Span(first_s=array(0.), last_s=array(40.))
    """
    columns = _fitting([*_state(s, v), *volume.thresholds, *_span(b_s, t_s)])
    found: Span = compiled(INTERVAL[volume.model])(*columns)
    return found


# -- entries --------------------------------------------------------------------------------
def _numbers(value: Any, name: str) -> Any:
    """The value as doubles; BadInput if it is not numeric, or not finite."""
    try:
        found = np.asarray(value)
    except ValueError as error:
        raise BadInput("not an array", item=name, got=str(error)) from error
    if found.dtype.kind not in "fiu":
        raise BadInput("not numbers", item=name, expected="numbers", got=repr(value)[:60])
    turned = found.astype(float)
    if found.dtype.kind in "iu" and np.any(turned.astype(found.dtype) != found):
        raise BadInput("no double holds this integer", item=name, got=repr(value)[:60])
    wrong = np.argwhere(~np.isfinite(turned))
    if len(wrong):
        place = "".join(f"[{k}]" for k in wrong[0])
        raise BadInput(
            "not finite",
            item=f"{name}{place}",
            expected="a finite number",
            got=str(turned[tuple(wrong[0])]),
        )
    return turned


def _state(s: Any, v: Any) -> list[Any]:
    """The six columns of a state in the kernels' order."""
    parts = []
    for name, value in (("s", s), ("v", v)):
        found = _numbers(value, name)
        if found.ndim == 0 or found.shape[-1] != 3:
            raise BadInput(
                "not a vector in space", item=name, expected="shape (..., 3)", got=str(found.shape)
            )
        parts.append(found)
    p, w = parts
    return [p[..., 0], p[..., 1], w[..., 0], w[..., 1], p[..., 2], w[..., 2]]


def _span(b_s: Any, t_s: Any) -> list[Any]:
    begin, end = _numbers(b_s, "b_s"), _numbers(t_s, "t_s")
    try:
        wrong = np.argwhere(begin > end)
    except ValueError as error:
        raise BadInput("shapes do not fit", item="b_s, t_s", got=str(error)) from error
    if len(wrong):
        raise BadInput("ends before it begins", item="b_s", expected="b_s <= t_s")
    return [begin, end]


def _fitting(columns: list[Any]) -> list[Any]:
    """The columns as doubles, if they can be broadcast to one shape."""
    found = [np.asarray(column, dtype=float) for column in columns]
    try:
        np.broadcast_shapes(*[column.shape for column in found])
    except ValueError as error:
        raise BadInput("shapes do not fit", item="s, v, volume", got=str(error)) from error
    return found


def _verdict(kernel: Any, columns: list[Any]) -> Any:
    if any(column.ndim for column in columns):
        return exactly(kernel)(*columns)
    x, y, u, w, z, vz, *rest = (float(column) for column in columns)
    limits, span = Thresholds(*rest[:5]), rest[5:]
    return bool(exact(kernel, Vec2(x, y), Vec2(u, w), z, vz, limits, *span))


__all__ = [
    "Bounds",
    "Loss",
    "Losses",
    "Span",
    "StandardThresholds",
    "Thresholds",
    "Volume",
    "Window",
    "course_reaches",
    "cylinder",
    "cylinder_conflict",
    "cylinder_during",
    "cylinder_interval",
    "cylinder_times",
    "cylinder_violation",
    "dips_to_zero",
    "horizontal_decision",
    "horizontal_interval_taumod",
    "horizontal_interval_tcpa",
    "horizontal_interval_tep",
    "horizontal_violation",
    "horizontal_violation_tau",
    "horizontal_violation_tcpa",
    "horizontal_violation_tep",
    "horizontal_violation_within",
    "horizontal_violation_within_tcpa",
    "horizontal_violation_within_tep",
    "is_lost_during",
    "is_violated",
    "layer_violation",
    "layer_window",
    "loss",
    "losses",
    "or_empty",
    "spans_on_doubles",
    "tcpa_decision",
    "tep_decision",
    "times_taumod",
    "times_tcpa",
    "times_tep",
    "times_vertical",
    "vertical_interval",
    "vertical_violation",
    "vertical_violation_vmod",
    "vertical_window",
    "violation",
    "violation_during_taumod",
    "violation_during_tcpa",
    "violation_during_tep",
    "violation_interval_taumod",
    "violation_interval_tcpa",
    "violation_interval_tep",
    "violation_taumod",
    "violation_tcpa",
    "violation_tep",
    "violation_times_taumod",
    "violation_times_tcpa",
    "violation_times_tep",
    "violation_within",
    "within_during",
]  # fmt: skip
