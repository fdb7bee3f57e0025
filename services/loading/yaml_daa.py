"""The detect-and-avoid parameters of a mission file, with the sections that change what ICAROUS knows and flies."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

from cratous.services.loading.yaml_guidance import guided
from cratous.spec.mission import (
    CombinedDaa,
    Daa,
    FailureDaa,
    LinkLoss,
    LinkLossDaa,
    MergingDaa,
    OrderedDaa,
    OrderedSensedDaa,
    Resolution,
    SensedDaa,
    WellClear,
)
from cratous.spec.mission.merging import Merging
from cratous.spec.mission.on_failure import OnFailure
from cratous.spec.mission.sensing import Sensing

DEFAULT_WELL_CLEAR = WellClear(dthr_m=150.0, zthr_m=30.0, tthr_s=15.0, tcoa_s=0.0)


class Sections(NamedTuple):
    """The sections of a mission file; None: not there."""

    sensing: Sensing | None
    link_loss: LinkLoss | None
    merging: Merging | None
    on_failure: OnFailure | None


def daa_of(data: dict[str, Any], sections: Sections) -> Daa:
    """The parameters. A mission with at most one of the sections keeps the record that it has always had in logs."""
    volume = {name: float(value) for name, value in data.get("well_clear", {}).items()}
    kept: dict[str, Any] = {"close_starts": bool(data.get("close_starts", False))}
    kept |= {name: float(data[name]) for name in ("lookahead_s", "buffer") if name in data}
    volume_kept = guided(replace(DEFAULT_WELL_CLEAR, **volume), data.get("guidance"))
    first = Resolution(data.get("resolution", Resolution.HEADING))
    sensing, link_loss, merging, on_failure = sections
    if sum(one is not None for one in sections) > 1:
        return CombinedDaa(volume_kept, **kept, resolution=first, **sections._asdict())
    if link_loss is not None:
        return LinkLossDaa(volume_kept, **kept, resolution=first, link_loss=link_loss)
    if merging is not None:
        return MergingDaa(volume_kept, **kept, resolution=first, merging=merging)
    if on_failure is not None:
        return FailureDaa(volume_kept, **kept, resolution=first, on_failure=on_failure)
    if first is Resolution.HEADING:  # the default: keeps the established name
        if sensing is None:
            return Daa(volume_kept, **kept)
        return SensedDaa(volume_kept, **kept, sensing=sensing)
    if sensing is None:
        return OrderedDaa(volume_kept, **kept, resolution=first)
    return OrderedSensedDaa(volume_kept, **kept, sensing=sensing, resolution=first)
