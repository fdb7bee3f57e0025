"""How far the flown path may deviate from the predicted one, from speed, turn angle and turn rate.

A predicted turn consists of segments with one heading each, the mean. At any instant of a segment the vehicle's
heading is between those at its two ends, but where between depends on the autopilot: one that turns at the beginning
of each of its steps is ahead by up to a step. So a segment of T s in which the heading turns by r adds at most v T r
/ 2 to the deviation, and a turn by theta at most v T theta / 2: it grows with the heading turned, and stays constant
on the straight path after the turn. If the speed changes in the turn, so does the radius v^2 / (g tan bank), which
adds the difference of the radii for each radian. A prediction made anew during the turn has only the rest of the turn
as its deviation, so one that was kept clear by this margin remains so.

No theorem states this: it is argued as above for an autopilot that turns at the full rate from the first step on, as
that of `cratous run` does, and flown at random in tests. One that has to roll first, as in `cratous sim`, deviates by
up to 2 m more (22 m/s, a turn by 30 degrees); delayed commands and wind are not included. A turn by 180 degrees, to
rounding, may be flown to the other side than predicted.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import PIECE_S, Ability, Motion, smallest_turn


class Off(NamedTuple):
    """Bounds on the deviation of a position: horizontally, and in altitude [m]."""

    wide_m: float
    high_m: float


class Drift(NamedTuple):
    """turn_rad: angle of the whole turn; turn_rate_rad_s: its rate; m_per_rad: deviation of the flown path for each
    radian turned [m]; rise_m_per_m: vertical deviation for each metre; here: present deviation of the vehicle from
    its assumed position.
    """

    turn_rad: float
    turn_rate_rad_s: float
    m_per_rad: float
    rise_m_per_m: float
    here: Off = Off(0.0, 0.0)

    def aside_m(self, at_s: float) -> float:
        """The lateral deviation from the predicted path up to at_s [s from the start of the turn]."""
        turned_m = self.m_per_rad * min(self.turn_rad, self.turn_rate_rad_s * at_s)
        return turned_m + self.here.wide_m

    def rise_m(self, at_s: float) -> float:
        """The vertical deviation up to at_s [s from the start of the turn]."""
        turned_m = self.m_per_rad * min(self.turn_rad, self.turn_rate_rad_s * at_s)
        return turned_m * self.rise_m_per_m + self.here.high_m


NONE = Drift(0.0, 0.0, 0.0, 0.0)
"""No deviation from the prediction."""


def drift_of(
    now: Motion,
    ability: Ability,
    heading_rad: float,
    speed_m_s: float,
    climb_m_s: float,
    here: Off = NONE.here,
) -> Drift:
    """The drift of a turn to a heading [rad] with a change of speed [m/s] and a climb [m/s], as `fly_to` predicts it.
    here: present deviation of the vehicle from its assumed position.
    """
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
