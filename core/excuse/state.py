"""Input and output of excuses: tracks of other aircraft, and manoeuvres with their answers.

SI, the local frame of `core.daa.state` (east, north, up); times are seconds from now.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

WAY_OUT, UNDECIDED, NO_WAY = 1, 0, -1
FREE, OPEN, REFUSED = 1, 0, -1
ANSWERS = {WAY_OUT: "a way out", UNDECIDED: "undecided", NO_WAY: "no way out"}
SURELY = 1e-6
"""A manoeuvre is refused only if it also is with thresholds reduced by this share."""


class Other(NamedTuple):
    """Another aircraft and the volume to keep of it.

    pieces: (Q, 8), each straight: begin and end [s from now], position at its begin [m], velocity
    [m/s]; in order of time. Where no piece is, nothing is known. kind: as in `spec.daa.parameters.DETECTORS`;
    thresholds: dthr, zthr [m], tthr, tcoa, vmod [s].
    """

    id: str
    pieces: np.ndarray
    kind: int
    thresholds: tuple[float, float, float, float, float]


class Tried(NamedTuple):
    """A manoeuvre and its answer: FREE, OPEN, REFUSED.

    dimension: hdir, hs, vs or alt; value: the target [rad, m/s, m/s, m]. If it is refused: by whom,
    when its volume is first violated [s], and how far apart they are then [m].
    """

    dimension: str
    value: float
    answer: int
    by: str = ""
    at_s: float | None = None
    apart_m: float | None = None
    above_m: float | None = None


class Judgement(NamedTuple):
    """Whether a way out existed at one instant, and every manoeuvre that was examined.

    answer: the common answer of both judges, else UNDECIDED; by_bands, by_check: the answer of each; why: what could
    not be decided.
    """

    answer: int
    by_bands: int
    by_check: int
    bands: tuple[Tried, ...]
    check: tuple[Tried, ...]
    why: str = ""


def straight(state: tuple[float, ...], horizon_s: float) -> np.ndarray:
    """The straight flight from a position and a velocity, as segments."""
    return np.array([[0.0, horizon_s, *state]], dtype=np.float64)
