"""Constraints between parameters of detect and avoid, whatever their source."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from cratous.spec.daa.parameters import FIXED, KEYS, URGENCIES, Parameters
from cratous.spec.errors import BadInput


def check(p: Parameters, where: str, lines: Mapping[str, str] = MappingProxyType({})) -> None:
    """Raise BadInput for values that are inconsistent. lines: the file locations of single fields."""
    names = {key.field: key for key in KEYS.values()}

    def wrong(item: str, expected: str, got: str) -> None:
        field = item if item in names else next((f for f in names if names[f].name == item), item)
        raise BadInput(
            "values do not fit together",
            where=lines.get(field, where),
            item=item,
            expected=expected,
            got=got,
        )

    for low, high in (
        ("min_hs_m_s", "max_hs_m_s"),
        ("min_vs_m_s", "max_vs_m_s"),
        ("min_alt_m", "max_alt_m"),
    ):
        if getattr(p, low) >= getattr(p, high):
            wrong(low, f"less than {high}", f"{getattr(p, low):g} and {getattr(p, high):g}")
    if p.turn_rate_rad_s and p.bank_angle_rad:
        wrong(
            "bank_angle",
            "turn_rate or bank_angle, not both",
            f"{p.turn_rate_rad_s:g} and {p.bank_angle_rad:g} rad",
        )
    if p.bank_angle_rad >= math.pi / 2:
        wrong("bank_angle", "less than 90 deg", f"{p.bank_angle_rad:g} rad")
    if p.alerting_m > p.alerting_n:
        wrong("alerting_m", "at most alerting_n", f"{p.alerting_m} of {p.alerting_n}")
    if p.dta_alerter > len(p.alerters):
        wrong("dta_alerter", f"0 to {len(p.alerters)}", str(p.dta_alerter))
    if (p.urgency_strategy == FIXED) != bool(p.most_urgent_aircraft):
        wrong(
            "most_urgent_aircraft",
            "an id with the urgency strategy fixed, and none with another",
            f"{p.most_urgent_aircraft or 'none'} with {URGENCIES[p.urgency_strategy]}",
        )
    if p.ca_bands and not 0 < p.ca_factor < 1:
        wrong("ca_factor", "above 0 and below 1 with ca_bands", f"{p.ca_factor:g}")
