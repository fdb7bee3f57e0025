"""Reads the section `daa.guidance` of a mission file as `Guidance`; the schema has its bounds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from cratous.services.loading.checks import Finding, as_errors
from cratous.services.mission.guidance import USUAL, guidance_of
from cratous.spec.mission import GuidedWellClear, Mission, WellClear


def guided(volume: WellClear, data: dict[str, Any] | None) -> WellClear:
    """The volume with the guidance of the section; unchanged without a section."""
    if data is None:
        return volume
    said = {name: type(getattr(USUAL, name))(value) for name, value in data.items()}
    sizes = volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s
    return GuidedWellClear(*sizes, replace(USUAL, **said))


@as_errors
def guidance_problems(mission: Mission) -> Iterator[Finding]:
    """Problems of the guidance: an alerting_m greater than alerting_n."""
    guidance = guidance_of(mission.daa.well_clear)
    agree, looks = guidance.alerting_m, guidance.alerting_n
    if agree > looks:
        expected = f"at most alerting_n, {looks}"
        what = "no level would ever be shown"
        yield Finding("daa.guidance.alerting_m", what, expected, str(agree))
