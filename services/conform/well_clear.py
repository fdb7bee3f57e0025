"""Suite `well-clear`: violation now, and violation times over an interval, for four volumes.

A case gives the relative state `s`, `v` (three numbers each, ownship minus intruder, metres and
metres per second), the thresholds, and the truth: `x_exact_h` and `x_exact_v`, decided on the
rationals that the doubles represent. Compared are the exact readings of the horizontal, the
vertical and the combined kernel, and the combined one with the roles swapped; a wrong one fails.

If the case also gives another system's result over [B, T] (`conflict`, `tin`, `tout`), it is
compared with the exact detection and the enclosed instants. DAIDALUS, the source of these vectors,
treats numbers as equal within 16348 units in the last place, and a squared horizontal or a vertical
speed below 1e-13 as zero. A difference that is fully explained by this is a *knife edge*: reported
and counted separately, with its reason, never as passed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.well_clear import (
    Loss,
    Volume,
    cylinder,
    cylinder_conflict,
    horizontal_violation,
    horizontal_violation_tcpa,
    horizontal_violation_tep,
    is_violated,
    loss,
    vertical_violation,
)
from cratous.services.conform import Result, edge, failed, not_covered, passed
from cratous.services.conform.values import identity, not_negative, number, truth, vector

DETECTORS: dict[str, tuple[str, Any]] = {
    "WCV_TAUMOD": ("tau_mod", horizontal_violation),
    "WCV_TCPA": ("tcpa", horizontal_violation_tcpa),
    "WCV_TEP": ("tep", horizontal_violation_tep),
}
CYLINDER = "CDCylinder"
SHARE = 16348 * 2.0**-52
"""Relative difference within which DAIDALUS treats numbers as equal."""
STILL = 1e-13
"""Squared horizontal or vertical speed below which DAIDALUS assumes zero [m2/s2, m/s]."""
State = tuple[tuple[float, ...], tuple[float, ...]]


def judge(case: dict[str, Any]) -> Result:
    """Run one case of the suite; the results of its checks."""
    name = identity(case)
    detector = case.get("det", "WCV_TAUMOD")
    if detector != CYLINDER and detector not in DETECTORS:
        return not_covered(name, f"detector {detector}")
    if "x_exact_h" not in case and "x_exact_v" not in case:
        return not_covered(name, "no exact verdict given")
    s, v = vector(case, "s", 3), vector(case, "v", 3)
    horizontal, vertical = truth(case, "x_exact_h"), truth(case, "x_exact_v")
    if detector == CYLINDER:
        volume = cylinder(not_negative(case, "D"), not_negative(case, "Z"))
        rows = _cylinder(s, volume, horizontal, vertical)
    else:
        dthr, zthr, tthr, tcoa = (not_negative(case, key) for key in ("D", "Z", "TTHR", "TCOA"))
        model, kernel = DETECTORS[detector]
        volume = Volume(dthr, zthr, tthr, tcoa, model=model)
        rows = _point(s, v, volume, kernel, horizontal, vertical)
    wrong = [(what, wanted, got) for what, wanted, got in rows if bool(got) is not wanted]
    kind = case.get("kind", "")
    if wrong:
        what, wanted, got = wrong[0]
        text = f"{what}: expected {_word(wanted)}, got {_word(bool(got))}; {_told(s, v, volume)}"
        return failed(name, f"{what} {_word(wanted)} missed ({kind})", text, len(rows))
    if "conflict" not in case:
        return passed(name, len(rows))
    return _over_span(case, name, (s, v), volume, len(rows))


def _point(
    s: tuple[float, ...],
    v: tuple[float, ...],
    volume: Volume,
    kernel: Any,
    horizontal: bool,
    vertical: bool,
) -> list[tuple[str, bool, bool]]:
    dthr, zthr, tthr, tcoa, _ = volume.thresholds
    back = (tuple(-x for x in s), tuple(-x for x in v))
    both = horizontal and vertical
    flat = exact(kernel, Vec2(*s[:2]), Vec2(*v[:2]), dthr, tthr)
    return [
        ("horizontal", horizontal, flat),
        ("vertical", vertical, exact(vertical_violation, s[2], v[2], zthr, tcoa)),
        ("combined", both, is_violated(s, v, volume)),
        ("combined, seen from the intruder", both, is_violated(*back, volume)),
    ]


def _cylinder(
    s: tuple[float, ...], volume: Volume, horizontal: bool, vertical: bool
) -> list[tuple[str, bool, bool]]:
    """The vectors' cylinder is open: each part is checked where the other one holds."""
    radius, half = volume.dthr_m, volume.zthr_m
    here, origin = Vec2(*s[:2]), Vec2(0.0, 0.0)
    rows = [
        ("combined", horizontal and vertical, exact(cylinder_conflict, here, s[2], radius, half))
    ]
    back = Vec2(-s[0], -s[1])
    seen = exact(cylinder_conflict, back, -s[2], radius, half)
    rows.append(("combined, seen from the intruder", horizontal and vertical, seen))
    if half > 0:
        rows.append(("horizontal", horizontal, exact(cylinder_conflict, here, 0.0, radius, half)))
    if radius > 0:
        rows.append(("vertical", vertical, exact(cylinder_conflict, origin, s[2], radius, half)))
    return rows


def _over_span(
    case: dict[str, Any], name: str, state: State, volume: Volume, checks: int
) -> Result:
    begin, end = number(case, "B"), number(case, "T")
    ours, theirs = loss(*state, volume, begin, end), truth(case, "conflict")
    difference = ""
    if (ours is not None) != theirs:
        difference = "detection"
    elif ours is not None:
        first, last = number(case, "tin"), number(case, "tout")
        outside = [
            word
            for word, time, bounds in (("entry", first, ours.first_s), ("exit", last, ours.last_s))
            if not bounds.low <= time <= bounds.high
        ]
        difference = " and ".join(outside)
    if not difference:
        return passed(name, checks + 1)
    text = f"over [{begin:g}, {end:g}] s ours is {_span(ours)}, the vector says "
    text += f"{[case.get('tin'), case.get('tout')] if theirs else 'clear'}; "
    text += _told(*state, volume)
    reason = _excuse(case, state, volume, theirs, begin, end)
    if reason:
        return edge(name, f"{difference}: {reason}", text, checks + 1)
    return failed(name, f"{difference} over [B, T] ({case.get('kind', '')})", text, checks + 1)


def _excuse(
    case: dict[str, Any], state: State, volume: Volume, theirs: bool, begin: float, end: float
) -> str:
    """Why DAIDALUS's own tolerance explains the difference; empty if it does not.

    Volumes are monotone in their thresholds: thresholds slightly smaller and slightly larger give
    losses on both sides of anything that such a tolerance can cause.
    """
    inner = loss(*state, _scaled(volume, 1 - SHARE), begin, end)
    outer = loss(*state, _scaled(volume, 1 + SHARE), begin, end)
    if not theirs and inner is None:
        return "within 16348 units in the last place of a threshold"
    if theirs and outer is not None:
        first, last = number(case, "tin"), number(case, "tout")
        latest = inner.first_s.high if inner else outer.last_s.high
        earliest = inner.last_s.low if inner else outer.first_s.low
        if outer.first_s.low <= first <= latest and earliest <= last <= outer.last_s.high:
            return "within 16348 units in the last place of a threshold"
    v = state[1]
    if 0 < v[0] * v[0] + v[1] * v[1] < STILL:
        return "a squared horizontal speed below 1e-13 is taken for zero"
    if 0 < abs(v[2]) < STILL:
        return "a vertical speed below 1e-13 m/s is taken for zero"
    return ""


def _scaled(volume: Volume, factor: float) -> Volume:
    return replace(
        volume,
        dthr_m=volume.dthr_m * factor,
        zthr_m=volume.zthr_m * factor,
        tthr_s=volume.tthr_s * factor,
        tcoa_s=volume.tcoa_s * factor,
    )


def _span(found: Loss | None) -> str:
    if found is None:
        return "clear"
    (a, b), (c, d) = found
    return f"[{a!r} to {b!r}, {c!r} to {d!r}]"


def _told(s: tuple[float, ...], v: tuple[float, ...], volume: Volume) -> str:
    dthr, zthr, tthr, tcoa, _ = volume.thresholds
    return (
        f"s = {s} m, v = {v} m/s, DTHR {dthr} m, ZTHR {zthr} m, TTHR {tthr} s, TCOA {tcoa} s, "
        f"{volume.model}"
    )


def _word(violated: bool) -> str:
    return "violated" if violated else "clear"
