"""How far the flown way may be off the predicted one, from speed, turn and turn rate.

A predicted turn is made of pieces with one heading each, the mean. The vehicle's heading is, at any instant of
a piece, between those at its two ends, but where between is the autopilot's: one that turns at the
beginning of each of its steps is ahead by up to a step. So a piece of T s in which the heading turns by r adds at most
v T r / 2 to the distance, and a turn by theta at most v T theta / 2: it grows with the heading turned,
and stays as it is on the straight way after the turn. Where the speed changes in the turn the radius v^2 / (g tan
bank) does too, which adds the difference of the radii for each radian. A prediction that is made anew in the turn
owes only what is still to be turned, so one that was kept clear by this margin remains so.

No theorem says so: it is argued as above, of an autopilot that turns at the full rate from the first step on, as that of
`cratous run` does, and flown at random in tests. One that has to roll first, as in `cratous sim`, is up to 2 m
farther off (22 m/s, a turn by 30 degrees); a command that is late and wind are not in it. A turn by 180 degrees, to
rounding, may be flown to the other side than is predicted.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import PIECE_S, Ability, Motion, smallest_turn


class Off(NamedTuple):
    """How far off a place may be: beside, and in altitude [m]."""

    wide_m: float
    high_m: float


class Drift(NamedTuple):
    """turn_rad: of the whole turn; turn_rate_rad_s: how fast it is flown; m_per_rad: by how much the flown way may be
    off for each radian that is turned [m]; rise_m_per_m: how far off in height for each metre; here: how far the vehicle
    may be from where it is taken to be now."""

    turn_rad: float
    turn_rate_rad_s: float
    m_per_rad: float
    rise_m_per_m: float
    here: Off = Off(0.0, 0.0)

    def aside_m(self, at_s: float) -> float:
        """How far aside of the predicted way the vehicle may be until at_s [s from the start of the turn]."""
        turned_m = self.m_per_rad * min(self.turn_rad, self.turn_rate_rad_s * at_s)
        return turned_m + self.here.wide_m

    def rise_m(self, at_s: float) -> float:
        """How far above or below it, likewise."""
        turned_m = self.m_per_rad * min(self.turn_rad, self.turn_rate_rad_s * at_s)
        return turned_m * self.rise_m_per_m + self.here.high_m


NONE = Drift(0.0, 0.0, 0.0, 0.0)
"""Flown as it is predicted."""


def drift_of(
    now: Motion,
    ability: Ability,
    heading_rad: float,
    speed_m_s: float,
    climb_m_s: float,
    here: Off = NONE.here,
) -> Drift:
    """The drift of a turn to a heading [rad] with a change of speed [m/s] and a climb [m/s], as `fly_to`
    predicts it. here: how far the vehicle may be from where it is taken to be."""
    slow, fast = sorted((now.speed_m_s, speed_m_s))
    radius_m = now.speed_m_s / ability.turn_rate_rad_s
    wider_m = radius_m * abs((speed_m_s / now.speed_m_s) ** 2 - 1)
    return Drift(
        abs(smallest_turn(now.heading_rad, heading_rad)),
        ability.turn_rate_rad_s,
        fast * max(PIECE_S, ability.step_s) / 2 + wider_m,
        abs(climb_m_s) / slow if climb_m_s else 0.0,
        here,
    )
