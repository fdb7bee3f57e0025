"""Arbitrary values for theorems on the standard's prediction over [0, h], with the kernel and the vertical window."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.well_clear import horizontal_violation_within, vertical_window, violation_within
from cratous.core.well_clear.thresholds import StandardThresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa
from cratous.spec import well_clear


class Prediction(NamedTuple):
    """A state, thresholds and a time h; the kernel's prediction for [0, h]; the vertical window in it."""

    state: tuple[Any, Any, Any, Any]
    limits: StandardThresholds
    h: Any
    predicted: Any
    window: Any


def any_prediction(c: Claim) -> Prediction:
    """An arbitrary state, thresholds of the standard, not negative, and `h`; both parts are known through lemmas."""
    state, sizes = any_by_tcoa(c)
    h = c.real("h")
    c.opaque(
        horizontal_violation_within,
        vertical_window,
        well_clear.horizontal_violation,
        well_clear.vertical_violation_at,
    )
    limits = StandardThresholds(*sizes)
    _, zthr, _, tcoa = sizes
    predicted = c.use(violation_within, *state, limits, h)
    window = c.use(vertical_window, *state[2:], zthr, tcoa, h)
    return Prediction(state, limits, h, predicted, window)
