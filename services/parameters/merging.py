"""Parameters of a merge fix: those given in the mission, derived ones, and fixed ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.services.icarous.merger import LATER_MS, LOST_MS, WAITS_MS
from cratous.services.loading.schema import mission_schema
from cratous.services.mission.merging import TOLERANCE_MS, apart_ms, merging_ms, merging_of
from cratous.services.parameters.parameter import DEFAULT, DERIVED, FIXED, GIVEN, Parameter
from cratous.spec.mission import Mission


def merging_rows(mission: Mission, written: Any) -> Iterator[Parameter]:
    """The parameters of the merge fix; none if the mission has none. written: the mission file's data."""
    merging = merging_of(mission)
    if merging is None:
        return
    facts = mission_schema()["properties"]["merging"]["properties"]
    said = written["merging"] if isinstance(written, dict) else {}
    for name, value, unit in (
        ("separation_s", merging.separation_ms / 1000, "s"),
        ("coordination_m", merging.coordination_m, "m"),
        ("schedule_m", merging.schedule_m, "m"),
        ("entry_m", merging.entry_m, "m"),
    ):
        one = facts[name]
        low = one.get("minimum", one.get("exclusiveMinimum"))
        origin = GIVEN if name in said or "default" not in one else DEFAULT
        how = one["description"].partition(" [")[0]
        yield Parameter(
            f"merging.{name}", 0, value, unit, one.get("default"), low, one["maximum"], origin, how
        )
    how = f"separation_s + 2 x {TOLERANCE_MS / 1000:g} s: so far slots are apart"
    yield Parameter("slots apart", 0, apart_ms(merging) / 1000, "s", None, None, None, DERIVED, how)
    how = "coordination_m / min_speed_m_s + slots of all: so much longer ICAROUS flies it on a leg"
    for number in merging.vehicles:
        longer_s = merging_ms(mission, number) / 1000
        yield Parameter("merging", number, longer_s, "s", None, None, None, DERIVED, how)
    for name, value_ms, how in (
        ("leader lost", LOST_MS, "nothing was heard of it for so long"),
        ("stands later", LATER_MS, "each member stands so much later than the one before it"),
        ("asks anew", WAITS_MS, "a request without a slot is made anew after this"),
        ("slot tolerance", TOLERANCE_MS, "a vehicle may be so much before or after its slot"),
    ):
        yield Parameter(name, 0, value_ms / 1000, "s", None, None, None, FIXED, how)
