"""Suite `detect-and-avoid`: alerts, bands, recovery, last times and resolutions of DAIDALUS.

A case is one instant: the configuration, the states that DAIDALUS received, and its output (`out`). Cases of one
sequence or scenario follow each other and share a history. Compared per intruder: alert level, first and last
violation per level, time to the corrective volume, last times to manoeuvre; per dimension: bands, recovery,
resolutions. A difference counts as ours unless there is evidence for another class:
- `sliver`: DAIDALUS drops bands narrower than 2^40 units in the last place (2.4e-4 relative),
  and a grid cell, cut off at the end of its range, is narrower than that here;
- `knife edge`: a relative change of all thresholds and times, including the look-ahead, by 1e-9
  changes our result;
- `last time 0`, `great circle`: behaviour of DAIDALUS, shown by computing again
  (`conform.daa_evidence`).
"""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Callable
from typing import Any

from cratous.core.daa.bands import out_of_range
from cratous.core.daa.engine import look
from cratous.core.daa.session import Instant, Session
from cratous.core.daa.state import DIMENSIONS, HDIR, Aircraft, Guidance, Sigma
from cratous.services.conform import Result, edge, failed, not_covered, passed
from cratous.services.conform.daa_evidence import Asked, explained
from cratous.services.conform.values import finite, identity, numbers
from cratous.spec.daa.parameters import REGIONS, Parameters
from cratous.spec.daa.presets import preset
from cratous.spec.errors import BadInput

PRESETS = {
    "DO_365B_no_SUM": "do_365b", "DO_365B_SUM": "do_365b_sum", "CD3D": "cd3d", "nom_a": "nom_a", "nom_b": "nom_b",
}  # fmt: skip
LABELS = (
    "ours", "sliver", "knife edge", "last time 0", "great circle", "own value out of range",
)  # fmt: skip
EDGE_SHARE = 2.4e-4
EDGE_LEAST = 1e-5
TIME_LEAST = 1e-4


def near(a: float, b: float) -> bool:
    """Equal within DAIDALUS's own tolerance for edges."""
    return abs(a - b) <= max(EDGE_SHARE * max(abs(a), abs(b)), EDGE_LEAST)


def same_time(a: float | None, b: float | None) -> bool:
    """Both none, or equal within 0.1 ms."""
    if a is None or b is None:
        return a is b
    return abs(a - b) <= TIME_LEAST


def _time(value: Any) -> float | None:
    """A time as written; "inf", "-inf" and null are None."""
    if value is None or value in ("inf", "-inf"):
        return None
    return finite(value, "time")


SIGMA = "std_sEW_sNS_sEN_sz_vEW_vNS_vEN_vz"


def _aircraft(state: dict[str, Any], alerter: int, sigma: Any = None) -> Aircraft:
    s, v = numbers(state["s"], "s", 3), numbers(state["v"], "v", 3)
    known = Sigma() if sigma is None else Sigma(*numbers(sigma, SIGMA, 8))
    return Aircraft(str(state["id"]), s[0], s[1], s[2], v[0], v[1], v[2], alerter, known)


class Suite:
    """Judges the cases of one file, in order."""

    def __init__(self) -> None:
        self.session: Session | None = None
        self.of: Any = None
        self.presets: dict[str, Parameters] = {}
        self.tally: Counter[str] = Counter()

    def parameters(self, case: dict[str, Any]) -> Parameters | None:
        """The named configuration of a vector; for a sequence, which names none, DO-365B."""
        name = str(case.get("config", "DO_365B_no_SUM")).removesuffix(".conf")
        if name not in PRESETS:
            return None
        if name not in self.presets:
            self.presets[name] = preset(PRESETS[name]).parameters
        return self.presets[name]

    def judge(self, case: dict[str, Any]) -> Result:
        """Run one case of the suite; the results of its checks."""
        name = identity(case)
        p = self.parameters(case)
        if p is None:
            return not_covered(name, f"configuration {case.get('config')}")
        out = case.get("out")
        if not isinstance(out, dict) or "own" not in out or "traffic" not in out:
            raise BadInput("no output of the anchor", item="out", expected="own, traffic, hdir ...")
        sigma = case.get(SIGMA) or [None] * (len(out["traffic"]) + 1)
        if len(sigma) != len(out["traffic"]) + 1:
            raise BadInput("not one row for each aircraft", item=SIGMA)
        own = _aircraft(out["own"], 1, sigma[0])
        others = [
            _aircraft(t["state"], int(t["alerter"]), known)
            for t, known in zip(out["traffic"], sigma[1:], strict=True)
        ]
        of = case.get("seq", case.get("scenario"))
        if of is None or of != self.of or self.session is None:
            self.session, self.of = Session(p), of
        instant = self.session.step(finite(out["time"], "time"), own, others)
        found = Differences(p, out, instant, of is not None)
        found.compare()
        self.tally += found.tally
        if found.ours:
            text = "; ".join(t for _, t in found.ours)
            return failed(name, found.ours[0][0], text, found.checks)
        if found.excused:
            text = "; ".join(t for _, t in found.excused)
            return edge(name, found.excused[0][0], text, found.checks)
        return passed(name, found.checks)

    def summary(self) -> list[str]:
        """Lines with the counts of what was compared and how it differed."""
        kinds = sorted({key.split("/")[0] for key in self.tally})
        lines = []
        for kind in kinds:
            total = self.tally[f"{kind}/compared"]
            parts = [
                f"{self.tally[f'{kind}/{label}']} {label}"
                for label in LABELS
                if self.tally[f"{kind}/{label}"]
            ]
            lines.append(f"  {kind}: {total} compared, " + (", ".join(parts) or "no difference"))
        return lines


class Differences:
    """The comparison of one instant."""

    def __init__(self, p: Parameters, out: dict[str, Any], instant: Instant, history: bool) -> None:
        self.p, self.out, self.instant, self.history = p, out, instant, history
        self.ours: list[tuple[str, str]] = []
        self.excused: list[tuple[str, str]] = []
        self.tally: Counter[str] = Counter()
        self.checks = 0

    def note(
        self, kind: str, good: bool, text: str, dimension: int | None = None, why: str = ""
    ) -> None:
        """Count one comparison and, if it differs, its class; why: a class that has been shown."""
        self.checks += 1
        self.tally[f"{kind}/compared"] += 1
        if good:
            return
        label = why or self.evidence(dimension)
        self.tally[f"{kind}/{label}"] += 1
        (self.ours if label == "ours" else self.excused).append((f"{kind}: {label}", text))

    def evidence(self, dimension: int | None) -> str:
        """Why a difference is not ours, by what is computed again here; "ours" if it is."""
        if dimension is not None:
            raw = self.instant.raw[dimension]
            if raw is not None and not len(raw.grid.targets):
                g = raw.grid
                for side, width in ((g.right, g.high - g.own), (g.left, g.own - g.low)):
                    rest = width - (len(side) - 2) * g.step
                    if len(side) > 1 and 0 < rest <= EDGE_SHARE * max(abs(g.high), abs(g.low)):
                        return "sliver"
        if self.history:
            return "ours"
        for factor in (1 - 1e-9, 1 + 1e-9):
            if self.changed(factor, dimension):
                return "knife edge"
        return "ours"

    def changed(self, factor: float, dimension: int | None) -> bool:
        """True if scaling thresholds, times and look-ahead by `factor` changes the result of this dimension."""
        alerters = tuple(
            a._replace(
                levels=tuple(
                    x._replace(
                        volume=x.volume._replace(
                            dthr_m=x.volume.dthr_m * factor,
                            zthr_m=x.volume.zthr_m * factor,
                            tthr_s=x.volume.tthr_s * factor,
                        ),
                        alerting_time_s=x.alerting_time_s * factor,
                    )
                    for x in a.levels
                )
            )
            for a in self.p.alerters
        )
        other = dataclasses.replace(
            self.p,
            alerters=alerters,
            lookahead_time_s=self.p.lookahead_time_s * factor,
            min_horizontal_recovery_m=self.p.min_horizontal_recovery_m * factor,
            min_vertical_recovery_m=self.p.min_vertical_recovery_m * factor,
        )
        seen = self.instant.seen
        if dimension is None:
            return look(other, seen.own, seen.others).levels != seen.levels
        made = Session(other).step(self.instant.time_s, seen.own, seen.others, (dimension,))
        now, then = self.instant.guidance[dimension], made.guidance[0]
        if (
            now.recovery.computed != then.recovery.computed
            or now.recovery.shrunk != then.recovery.shrunk
        ):
            return True
        regions = [b.region for b in now.bands] != [b.region for b in then.bands]
        return regions or any(
            not near(a.low, b.low) for a, b in zip(now.bands, then.bands, strict=True)
        )

    def compare(self) -> None:
        """Compare all values that the vector gives."""
        for i, theirs in enumerate(self.out["traffic"]):
            self.intruder(i, theirs)
        for dimension in range(len(DIMENSIONS)):
            self.dimension(dimension)

    def intruder(self, i: int, theirs: dict[str, Any]) -> None:
        """Compare the values of one intruder."""
        alert = self.instant.alerts[i]
        wanted = int(theirs["alert"])
        self.note("alert level", alert.level == wanted,
                  f"{alert.id}: alert level expected {wanted}, got {alert.level}")  # fmt: skip
        for k, (first, last) in enumerate(theirs["levels_in_out"]):
            span = alert.times[k] if k < len(alert.times) else None
            good = span is not None and same_time(_time(first), span.first_s)
            good = good and span is not None and same_time(_time(last), span.last_s)
            self.note("violation times", good,
                      f"{alert.id} level {k + 1}: times expected {first}..{last}, got {span}")  # fmt: skip
        self.note("time to corrective volume", same_time(_time(theirs["t2cv"]), alert.to_corrective_s),
                  f"{alert.id}: expected {theirs['t2cv']}, got {alert.to_corrective_s}")  # fmt: skip
        if "ltm" not in theirs:
            return
        ours = self.instant.last_times(self.p, i)
        for d, value in enumerate(theirs["ltm"]):
            if out_of_range(self.p, self.instant.own, d):
                # DAIDALUS reports no conflict here, so nothing can be compared
                self.tally["last time to manoeuvre/own value out of range"] += 1
                continue
            if ours is None or value == "inf":
                good = ours is None and value == "inf"
            else:
                good = same_time(_time(value), ours[d])
            got = "no conflict" if ours is None else ours[d]
            why = ""
            if not good and ours is not None and value != "inf":
                seen = self.instant.seen
                asked = Asked(self.p, seen.own, seen.traffic, i, d)
                why = explained(asked, self.out, ours[d], _time(value), alert.to_corrective_s)
            self.note("last time to manoeuvre", good,
                      f"{alert.id} {DIMENSIONS[d]}: last time expected {value}, got {got}", d, why)  # fmt: skip

    def dimension(self, dimension: int) -> None:
        """Compare the bands of one dimension and what follows from them."""
        name = DIMENSIONS[dimension]
        theirs, ours = self.out[name], self.instant.guidance[dimension]
        if ours.why or not theirs["bands"]:
            self.note("bands", bool(ours.why) and not theirs["bands"],
                      f"{name}: bands expected {theirs['bands']}, got {ours.why or ours.bands}", dimension)  # fmt: skip
            return
        good = len(ours.bands) == len(theirs["bands"]) and all(
            REGIONS[b.region] == region and near(b.low, low) and near(b.high, high)
            for b, (low, high, region) in zip(ours.bands, theirs["bands"], strict=True)
        )
        self.note(
            "bands",
            good,
            f"{name}: bands expected {theirs['bands']}, got {_shown(ours)}",
            dimension,
        )
        r, recovery = theirs["recovery"], ours.recovery
        fine = r["computed"] == recovery.computed
        if fine and recovery.computed:
            fine = r["saturated"] == recovery.saturated and r["nfactor"] == recovery.shrunk
            fine = fine and (recovery.saturated or same_time(_time(r["time"]), recovery.time_s))
        self.note("recovery", fine, f"{name}: recovery expected {r}, got {recovery}", dimension)
        if not good:
            return  # a resolution is an edge of a band
        up, down = _value(theirs["raw_up"]), _value(theirs["raw_low"])
        needed = theirs["raw_up"] is not None
        fine = (
            needed == ours.needed
            and _same_value(up, ours.up, dimension)
            and _same_value(down, ours.down, dimension)
        )
        self.note("resolution", fine,
                  f"{name}: resolutions expected {theirs['raw_up']}, {theirs['raw_low']}, got {ours.up}, {ours.down}", dimension)  # fmt: skip
        if not fine:
            return  # a resolution is held that was the nearest one earlier
        held = self.instant.held[dimension]
        up, down = _value(theirs["res_up"]), _value(theirs["res_low"])
        good = _same_value(up, held.up, dimension) and _same_value(down, held.down, dimension)
        self.note(
            "resolution shown", good and held.prefer_up == theirs["pref_up"],
            f"{name}: shown expected {theirs['res_up']}, {theirs['res_low']}, {theirs['pref_up']}, got {held}",
        )  # fmt: skip


def _value(value: Any) -> float | None:
    return None if value is None or value in ("inf", "-inf") else finite(value, "resolution")


def _same_value(a: float | None, b: float | None, dimension: int) -> bool:
    if a is None or b is None:
        return a is b
    if dimension == HDIR:
        gap = abs(a - b) % (2 * math.pi)
        return min(gap, 2 * math.pi - gap) <= max(EDGE_SHARE * abs(a), EDGE_LEAST)
    return near(a, b)


def _shown(g: Guidance) -> list[tuple[float, float, str]]:
    return [(round(b.low, 4), round(b.high, 4), REGIONS[b.region]) for b in g.bands]


def suite() -> Callable[[dict[str, Any]], Result]:
    """A judge with an empty history."""
    return Suite().judge
