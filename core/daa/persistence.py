"""Persistence of resolutions and the preferred direction from instant to instant, so that advice does not jump.

Definitions: `spec.daa.persistence`. The nearest resolutions come from `core.daa.bands`; the kernels here decide which
of them, or of those shown before, is shown. A held resolution is still ahead of the own value, and between it and the
nearest one no band reaches the corrective region.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.core.kernel import driver, kernel


@kernel(implements="daa.persistence.kept")
def resolution_kept(
    preferred: bool,
    shrunk_before: int,
    shrunk_now: int,
    age_s: float,
    persistence_s: float,
    beyond: float,
    least: float,
) -> bool:
    """True iff an earlier resolution, which still resolves the conflict, is kept in place of the nearest one.

    preferred: its direction is; shrunk_before, shrunk_now: how often recovery shrank the cylinder for it, and does
    now (-1: no recovery); age_s: since when the direction is shown [s]; persistence_s: how long it stays at least
    [s]; beyond: how much farther it is than the nearest one, and least: the smallest change worth making; both in the
    unit of the dimension.
    """
    if shrunk_before >= 0 and shrunk_before < shrunk_now:
        return True
    if not preferred:
        return False
    return age_s < persistence_s or beyond < least or shrunk_before < shrunk_now


@kernel(implements="daa.persistence.direction_kept")
def direction_kept(
    age_s: float,
    persistence_s: float,
    up: float,
    down: float,
    least: float,
    shrunk_preferred: int,
    shrunk_other: int,
) -> bool:
    """True iff the preferred direction is kept; there are resolutions on both sides.

    age_s, persistence_s, least: as above; up, down: how far the nearest resolutions are; shrunk_...: how often the
    cylinder was shrunk for what is shown in the preferred and in the other direction.
    """
    if age_s < persistence_s or shrunk_preferred < shrunk_other:
        return True
    if up >= down:
        return up - down < least
    return down - up < least


class Held(NamedTuple):
    """What is shown: the resolution to the right or up, the one to the left or down (None: none), and whether the
    first is preferred.
    """

    up: float | None = None
    down: float | None = None
    prefer_up: bool = False


class Span(NamedTuple):
    """A band: from low to high, and whether it is free of the corrective region."""

    low: float
    high: float
    free: bool


EDGE = 1e-7
"""Values this near to each other count as equal (rad, m/s, m)."""


@dataclass
class Ways:
    """The history of one dimension.

    least: the smallest change worth making; turn: the size of the circle for directions, else 0; since_s: when the
    direction was chosen, None if there is none.
    """

    persistence_s: float
    least: float
    turn: float = 0.0
    held: Held = field(default_factory=Held)
    shrunk_up: int = 0
    shrunk_down: int = 0
    since_s: float | None = None

    def _away(self, start: float, end: float) -> float:
        """The distance from start up to end; along the circle in [0, turn)."""
        gap = end - start
        return gap % self.turn if self.turn else gap

    def _clear(self, spans: Sequence[Span], near: float, far: float) -> bool:
        """Whether no band between two values, from the near one up to the far one, reaches the corrective region."""
        length = self._away(near, far)
        if length < -EDGE:
            return False
        shifts = (-self.turn, 0.0, self.turn) if self.turn else (0.0,)
        return all(
            s.free
            for s in spans
            for k in shifts
            if s.low + k < near + length - EDGE and s.high + k > near + EDGE
        ) and any(
            s.free and s.low + k - EDGE <= near + length <= s.high + k + EDGE
            for s in spans
            for k in shifts
        )

    @driver(checked_by=("resolution_kept",))
    def _resolution(
        self,
        spans: Sequence[Span],
        own: float,
        new: float | None,
        up: bool,
        shrunk: int,
        age_s: float,
    ) -> float | None:
        old = self.held.up if up else self.held.down
        before = self.shrunk_up if up else self.shrunk_down
        stays = False
        if new is not None and old is not None:
            near, far, start, end = (new, old, own, old) if up else (old, new, old, own)
            ahead = self._away(start, end)
            inside = ahead < self.turn / 2 if self.turn else ahead > -EDGE
            stays = (
                inside
                and resolution_kept(
                    up is self.held.prefer_up, before, shrunk, age_s, self.persistence_s,
                    self._away(near, far), self.least,
                )
                and self._clear(spans, near, far)
            )  # fmt: skip
        if not stays:
            if up:
                self.shrunk_up = shrunk
            else:
                self.shrunk_down = shrunk
        return old if stays else new

    @driver(checked_by=("direction_kept",))
    def _direction(self, own: float, new: Held, now_s: float, was_s: float | None) -> bool:
        """Whether up is preferred; updates since when."""
        if new.up is None or new.down is None:
            # without a choice there is none to keep, but an earlier one still counts; the right
            # or upper direction is the default choice
            none = new.up is None and new.down is None
            start_s = now_s if new.up is not None and self.least > 0 else None
            self.since_s = None if none else was_s if was_s is not None else start_s
            return new.up is not None
        up, down = self._away(own, new.up), self._away(new.down, own)
        nearer = up <= down + EDGE
        if was_s is None or self.least <= 0:
            self.since_s = now_s
            return nearer
        before = self.held.prefer_up
        shrunk = (self.shrunk_up, self.shrunk_down)
        mine, other = shrunk if before else shrunk[::-1]
        self.since_s = was_s
        if nearer is before or direction_kept(
            now_s - was_s, self.persistence_s, up, down, self.least, mine, other
        ):
            return before
        self.since_s = now_s
        return nearer

    def shown(
        self, spans: Sequence[Span], own: float, new: Held, shrunk: int, now_s: float
    ) -> Held:
        """What is shown now. new: the nearest resolutions; shrunk: see `resolution_kept`."""
        was_s = self.since_s
        if was_s is None or self.least <= 0 or not now_s > was_s:
            up, down, was_s = new.up, new.down, None
            self.shrunk_up = self.shrunk_down = shrunk
        else:
            age_s = now_s - was_s
            up = self._resolution(spans, own, new.up, True, shrunk, age_s)
            down = self._resolution(spans, own, new.down, False, shrunk, age_s)
        prefer = self._direction(own, new, now_s, was_s)
        self.held = Held(up, down, prefer)
        return self.held

    def forget(self) -> None:
        """Reset the history."""
        self.held, self.since_s, self.shrunk_up, self.shrunk_down = Held(), None, 0, 0


__all__ = ["Held", "Span", "Ways", "direction_kept", "resolution_kept"]
