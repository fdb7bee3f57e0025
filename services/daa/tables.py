"""Alerts, bands and metrics as CSV rows, and whole results as JSON."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import Any

from cratous.core.daa.engine import region_level, thresholds
from cratous.core.daa.session import Instant
from cratous.core.daa.zones import contours, hazard_zone
from cratous.services.daa.explain import region_text
from cratous.spec.daa.parameters import Parameters
from cratous.spec.files.printable import cell

ALERTS = (
    "time_s", "id", "alerter", "level", "level_without_history", "region", "first_s", "last_s",
    "to_corrective_s",
)  # fmt: skip
BANDS = (
    "time_s",
    "dimension",
    "own",
    "low",
    "high",
    "region",
    "up",
    "down",
    "preferred",
    "recovery",
)


def alert_rows(instant: Instant) -> list[dict[str, Any]]:
    """One row per intruder."""
    rows = []
    for a in instant.alerts:
        times = a.times[a.level - 1] if a.level else None
        values = (
            instant.time_s, a.id, a.alerter, a.level, a.raw, region_text(a.region),
            times and times.first_s, times and times.last_s, a.to_corrective_s,
        )  # fmt: skip
        rows.append(dict(zip(ALERTS, values, strict=True)))
    return rows


def band_rows(instant: Instant) -> list[dict[str, Any]]:
    """One row per band."""
    rows = []
    for g, held in zip(instant.guidance, instant.held, strict=True):
        r = g.recovery
        recovery = "saturated" if r.saturated else (f"{r.time_s:g}" if r.time_s is not None else "")
        way = (
            ""
            if not g.needed or (held.up is None and held.down is None)
            else ("up" if held.prefer_up else "down")
        )
        for b in g.bands:
            values = (
                instant.time_s, g.dimension, g.own, b.low, b.high, region_text(b.region), held.up,
                held.down, way, recovery,
            )  # fmt: skip
            rows.append(dict(zip(BANDS, values, strict=True)))
    return rows


def metric_rows(instant: Instant) -> list[dict[str, Any]]:
    """One row per intruder."""
    return [{"time_s": instant.time_s, **m._asdict()} for m in instant.metrics]


def zone_rows(p: Parameters, instant: Instant, sweep: bool) -> list[dict[str, Any]]:
    """Hazard zone and contours of each intruder for the corrective region, as polygons."""
    rows = []
    for i, other in enumerate(instant.seen.others):
        a = instant.seen.alerters[i]
        found = region_level(p.alerters[a], p.corrective_region) if a >= 0 else None
        if found is None:
            continue
        level = found[1]
        volume = thresholds(level.volume, instant.own.alt_m)
        zone = hazard_zone(instant.own, other, volume, level.alerting_time_s if sweep else 0.0)
        shapes = [("hazard zone", zone), *(("contour", c) for c in contours(p, instant.seen, i))]
        rows += [
            {"time_s": instant.time_s, "id": other.id, "what": what, "points_m": list(c.points)}
            for what, c in shapes
        ]
    return rows


ROWS = {"alerts": alert_rows, "bands": band_rows, "metrics": metric_rows}


def as_csv(rows: Iterable[dict[str, Any]]) -> str:
    """Rows as CSV with a header line; None is an empty field, doubles keep every digit."""
    out = io.StringIO()
    writer: csv.DictWriter[str] | None = None
    for row in rows:
        if writer is None:
            writer = csv.DictWriter(out, list(row), lineterminator="\n")
            writer.writeheader()
        writer.writerow({k: repr(v) if isinstance(v, float) else cell(v) for k, v in row.items()})
    return out.getvalue()


def as_data(instant: Instant) -> dict[str, Any]:
    """A result as plain data for JSON, in SI; None where there is no value."""
    together = instant.seen.coordination
    return {
        "time_s": instant.time_s,
        "ownship": instant.own.id,
        "alerts": [
            {
                **a._asdict(),
                "region": region_text(a.region),
                "times": [t._asdict() for t in a.times],
            }
            for a in instant.alerts
        ],
        "guidance": [
            {
                **g._asdict(),
                "bands": [[b.low, b.high, region_text(b.region)] for b in g.bands],
                "region": region_text(g.region),
                "recovery": g.recovery._asdict(),
                "peripheral": {region_text(k): list(v) for k, v in g.peripheral.items()},
                "shown": held._asdict(),
            }
            for g, held in zip(instant.guidance, instant.held, strict=True)
        ],
        "metrics": [m._asdict() for m in instant.metrics],
        "conflict": {region_text(k): list(v) for k, v in instant.conflict.items()},
        "in_corrective_conflict": instant.corrective,
        "coordination": together and together._asdict(),
    }
