"""The well-clear volumes about which theorems are stated alike: with tau_mod, tcpa and tep."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core import well_clear as kernels
from cratous.spec import well_clear


class Parts(NamedTuple):
    """Kernels: violation now and during a window, the span of violation in it, its first and last time."""

    now: Any
    during: Any
    interval: Any
    times: Any


class Meant(NamedTuple):
    """Definitions: violation in the plane now, in the plane at an instant, in space at an instant."""

    flat: Any
    flat_at: Any
    at: Any


class Volume(NamedTuple):
    """A volume: its name in theorems, its kernels in the plane and in space, its definitions."""

    name: str
    flat: Parts
    space: Parts
    meant: Meant


TAUMOD = Volume(
    "taumod",
    Parts(
        kernels.horizontal_violation, kernels.horizontal_violation_within,
        kernels.horizontal_interval_taumod, kernels.times_taumod,
    ),
    Parts(
        kernels.violation_taumod, kernels.violation_during_taumod,
        kernels.violation_interval_taumod, kernels.violation_times_taumod,
    ),
    Meant(
        well_clear.horizontal_violation, well_clear.horizontal_violation_at,
        well_clear.violation_taumod_at,
    ),
)  # fmt: skip
TCPA = Volume(
    "tcpa",
    Parts(
        kernels.horizontal_violation_tcpa, kernels.horizontal_violation_within_tcpa,
        kernels.horizontal_interval_tcpa, kernels.times_tcpa,
    ),
    Parts(
        kernels.violation_tcpa, kernels.violation_during_tcpa,
        kernels.violation_interval_tcpa, kernels.violation_times_tcpa,
    ),
    Meant(
        well_clear.horizontal_violation_tcpa, well_clear.horizontal_violation_tcpa_at,
        well_clear.violation_tcpa_at,
    ),
)  # fmt: skip
TEP = Volume(
    "tep",
    Parts(
        kernels.horizontal_violation_tep, kernels.horizontal_violation_within_tep,
        kernels.horizontal_interval_tep, kernels.times_tep,
    ),
    Parts(
        kernels.violation_tep, kernels.violation_during_tep,
        kernels.violation_interval_tep, kernels.violation_times_tep,
    ),
    Meant(
        well_clear.horizontal_violation_tep, well_clear.horizontal_violation_tep_at,
        well_clear.violation_tep_at,
    ),
)  # fmt: skip
