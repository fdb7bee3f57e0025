"""Detect and avoid over time for one ownship: alerts, guidance and metrics, with their history.

A `Session` is given one instant after another. What is shown depends on the history as described in
`core.daa.history`, which is reset by a gap, or when time does not advance. One session per vehicle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.daa.bands import (
    Raw,
    directive,
    on_circle,
    out_of_range,
    region_of,
    severity,
    unknown,
)
from cratous.core.daa.engine import (
    Seen,
    alerter_index,
    bands_now,
    corrective_entry,
    last_times_of,
    look,
    region_level,
)
from cratous.core.daa.history import BandMemory, Shown, goes_on
from cratous.core.daa.persistence import EDGE, Held, Span, Ways
from cratous.core.daa.state import (
    DIMENSIONS,
    HDIR,
    UNKNOWN,
    Aircraft,
    Alert,
    Guidance,
    LevelTimes,
    Metrics,
)
from cratous.spec.daa.parameters import FAR, NEAR, NONE, Parameters
from cratous.spec.errors import BadInput


class Instant(NamedTuple):
    """The output at one time: alerts and metrics per intruder, guidance per dimension, the intruders in conflict per
    region, and whether the corrective region is in conflict. held: for each guidance the resolutions that are shown,
    which may be earlier ones than the nearest (persistence).
    """

    time_s: float
    own: Aircraft
    alerts: tuple[Alert, ...]
    guidance: tuple[Guidance, ...]
    metrics: tuple[Metrics, ...]
    conflict: dict[int, tuple[str, ...]]
    corrective: bool
    seen: Seen
    raw: tuple[Raw | None, ...]
    held: tuple[Held, ...] = ()

    def last_times(self, p: Parameters, i: int) -> tuple[float | None, ...] | None:
        """Last times to manoeuvre out of conflict with intruder i; None if there is no conflict."""
        return last_times_of(p, self.seen, i)


def checked(own: Aircraft, others: Sequence[Aircraft]) -> None:
    """Raise BadInput for a state that is not finite or a duplicate id."""
    known = set()
    for a in (own, *others):
        for name, value in zip(Aircraft._fields[1:7], a[1:7], strict=True):
            if not math.isfinite(value):
                raise BadInput(
                    "a state is not finite",
                    item=f"{a.id}.{name}",
                    expected="a finite number",
                    got=str(value),
                )
        for name, value in zip(a.sigma._fields, a.sigma, strict=True):
            if not math.isfinite(value) or (value < 0 and name not in ("s_en_m", "v_en_m_s")):
                raise BadInput(
                    "a standard deviation is negative or not finite",
                    item=f"{a.id}.{name}", expected="0 or more", got=str(value),
                )  # fmt: skip
        if a.id in known:
            raise BadInput("two aircraft have one id", item=a.id)
        known.add(a.id)


def metrics_of(own: Aircraft, other: Aircraft, dmod_m: float) -> Metrics:
    """Separation and closest approach; tau_mod with distance dmod_m [m]."""
    x, y, z = own.east_m - other.east_m, own.north_m - other.north_m, own.alt_m - other.alt_m
    u, v, w = own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s, own.vu_m_s - other.vu_m_s
    ss, vv, sv = x * x + y * y, u * u + v * v, x * u + y * v
    tcpa = max(0.0, -sv / vv) if vv > 0 else 0.0
    dcpa = math.hypot(x + tcpa * u, y + tcpa * v)
    tcoa = -z / w if z * w < 0 else None
    tau = (dmod_m * dmod_m - ss) / sv if sv < 0 else None
    return Metrics(
        other.id, math.sqrt(ss), abs(z), math.sqrt(vv), abs(w), tcpa, dcpa, dcpa,
        abs(z + tcpa * w), tcoa, tau,
    )  # fmt: skip


class Session:
    """The history of one ownship and its traffic under fixed parameters."""

    def __init__(self, parameters: Parameters) -> None:
        self.parameters = parameters
        self.forget()

    def forget(self) -> None:
        """Reset all history."""
        p = self.parameters
        self.time_s = -math.inf
        self.shown: dict[tuple[str, int], Shown] = {}
        self.area: dict[str, Shown] = {}
        hold = p.persistence_time_s if p.bands_persistence else 0.0
        self.bands = [
            BandMemory(p.alerting_m, p.alerting_n, hold, 2 * math.pi * (d == HDIR))
            for d in range(len(DIMENSIONS))
        ]
        # a change of exactly this amount, up to rounding, is worth making
        least = (
            p.persistence_preferred_hdir_rad,
            p.persistence_preferred_hs_m_s,
            p.persistence_preferred_vs_m_s,
            p.persistence_preferred_alt_m,
        )
        self.ways = [
            Ways(p.persistence_time_s, least[d] - EDGE, 2 * math.pi * (d == HDIR))
            for d in range(len(DIMENSIONS))
        ]

    def _terminal(
        self, own: Aircraft, others: Sequence[Aircraft], inside: Sequence[bool]
    ) -> tuple[bool, ...]:
        """Whether each active aircraft is in the terminal area, by M of N."""
        p = self.parameters
        flags = list(inside) or [False] * (len(others) + 1)
        active = [own] * len(others) if p.ownship_centric_alerting else list(others)
        where = [flags[0]] * len(others) if p.ownship_centric_alerting else flags[1:]
        found = {}
        for a, here in zip(active, where, strict=True):
            if a.id not in found:
                memory = self.area.setdefault(a.id, Shown(p.alerting_m, p.alerting_n))
                found[a.id] = memory.filtered(int(here)) > 0
        return tuple(found[a.id] for a in active)

    def _alerters(
        self, own: Aircraft, others: Sequence[Aircraft], there: Sequence[bool]
    ) -> tuple[int, ...] | None:
        """Alerter indices; the terminal area's alerter if the active aircraft is in it."""
        p = self.parameters
        if not there or not p.dta_alerter:
            return None
        return tuple(
            p.dta_alerter - 1 if here else alerter_index(p, own, o)
            for here, o in zip(there, others, strict=True)
        )

    def _alert(self, seen: Seen, i: int, now_s: float, remembers: bool) -> Alert:
        p = self.parameters
        name, a = seen.others[i].id, seen.alerters[i]
        levels = p.alerters[a].levels if a >= 0 else ()
        memory = self.shown.get((name, a))
        if memory is None or not remembers:
            memory = self.shown[name, a] = Shown(p.alerting_m, p.alerting_n)
        raw = seen.levels[i]
        held = memory.level if remembers else 0
        if raw < held <= len(levels):
            entry = seen.times[i][held - 1].first_s
            early = min(levels[held - 1].early_alerting_time_s, p.lookahead_time_s)
            if entry is not None and entry <= early:
                raw = held
        level = memory.update(raw, now_s, p.persistence_time_s) if remembers else raw
        region = levels[level - 1].region if level else NONE
        return Alert(
            name, a + 1, level, seen.levels[i], seen.times[i], corrective_entry(p, seen, i), region
        )

    def _guidance(self, seen: Seen, dimension: int, raw: Raw | None, remembers: bool) -> Guidance:
        p, circle = self.parameters, dimension == HDIR
        if raw is None:
            self.bands[dimension].last.clear()
            return unknown(p, seen.own, dimension, out_of_range(p, seen.own, dimension))
        bands = on_circle(raw.bands) if circle else tuple(raw.bands)
        if remembers:
            bands = self.bands[dimension].shown(
                bands, raw.recovery.computed, raw.grid.own, self.time_s
            )
        own = raw.grid.own
        region = region_of(bands, own, circle)
        needed = severity(region) >= p.corrective_region
        ways = directive(bands, own, p.corrective_region, circle)
        return Guidance(
            DIMENSIONS[dimension], own, bands, region, needed,
            ways.up if needed else None, ways.down if needed else None,
            needed and ways.prefer_up, raw.recovery, raw.peripheral,
        )  # fmt: skip

    def _held(self, dimension: int, g: Guidance, remembers: bool) -> Held:
        """The resolutions of a dimension that are shown."""
        new = Held(g.up, g.down, g.prefer_up)
        if not remembers or g.why:
            self.ways[dimension].forget()
            return new
        corrective = self.parameters.corrective_region
        spans = [
            Span(b.low, b.high, 0 <= severity(b.region) < corrective and b.region != UNKNOWN)
            for b in g.bands
        ]
        shrunk = g.recovery.shrunk if g.recovery.computed else -1
        return self.ways[dimension].shown(spans, g.own, new, shrunk, self.time_s)

    def step(
        self,
        time_s: float,
        own: Aircraft,
        others: Sequence[Aircraft],
        dimensions: Sequence[int] = range(4),
        inside: Sequence[bool] = (),
    ) -> Instant:
        """The next instant; all aircraft at time_s [s], velocities relative to the air.

        dimensions: for which guidance is wanted. inside: whether each aircraft, ownship first, is
        in the terminal area. Raises BadInput for states that cannot be used.
        """
        p = self.parameters
        if not math.isfinite(time_s):
            raise BadInput("the time is not finite", item="time", got=str(time_s))
        checked(own, others)
        if p.most_urgent_aircraft == own.id:
            raise BadInput("an aircraft cannot coordinate with itself", item="most_urgent_aircraft",
                           expected="the id of another", got=own.id)  # fmt: skip
        if not goes_on(time_s, self.time_s, p.hysteresis_time_s):
            self.forget()
        remembers = p.hysteresis_time_s > 0
        self.time_s = time_s
        there = self._terminal(own, others, inside) if any(inside) or self.area else ()
        held = {key: memory.level for key, memory in self.shown.items() if remembers}
        seen = look(p, own, others, self._alerters(own, others, there), held)
        alerts = tuple(self._alert(seen, i, time_s, remembers) for i in range(len(others)))
        area = any(there) and any(
            seen.traffic.conflict[r].any() for r in range(p.corrective_region + 1, NEAR + 1)
        )
        raw = tuple(bands_now(p, seen, d, area) if d in dimensions else None for d in range(4))
        guidance = tuple(self._guidance(seen, d, raw[d], remembers) for d in dimensions)
        conflict = {
            region: tuple(o.id for i, o in enumerate(others) if seen.traffic.conflict[region, i])
            for region in range(FAR, NEAR + 1)
        }
        levels = {
            a: region_level(p.alerters[a], p.corrective_region) if a >= 0 else None
            for a in set(seen.alerters)
        }
        found = (levels[a] for a in seen.alerters)
        metrics = tuple(
            metrics_of(own, o, 0.0 if f is None else f[1].volume.dthr_m)
            for o, f in zip(others, found, strict=True)
        )
        corrective = any(conflict[r] for r in range(p.corrective_region, NEAR + 1))
        ways = tuple(self._held(d, g, remembers) for d, g in zip(dimensions, guidance, strict=True))
        return Instant(
            time_s, own, alerts, guidance, metrics, conflict, corrective, seen, raw, ways
        )


__all__ = ["Instant", "LevelTimes", "Session", "metrics_of"]
