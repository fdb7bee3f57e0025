"""The ground speed that an aircraft can hold in a steady wind in every direction.

Definition: `spec.routing.wind`. Straight into the wind the airspeed is the sum of ground speed and wind speed, with a
tailwind their difference; in every other direction it lies between.
"""

from cratous.core.kernel import kernel


@kernel(implements="routing.wind.holds", nonnegative=("ground_m_s", "least_m_s", "most_m_s"))
def holds_in_wind(
    ground_m_s: float,
    wind_north_m_s: float,
    wind_east_m_s: float,
    least_m_s: float,
    most_m_s: float,
) -> bool:
    """True iff the airspeed stays within its limits in every direction over the ground.

    ground_m_s: speed over the ground [m/s], >= 0; wind_north_m_s, wind_east_m_s: velocity of the air
    [m/s]; least_m_s, most_m_s: limits of the airspeed [m/s], >= 0.
    """
    wind = wind_north_m_s * wind_north_m_s + wind_east_m_s * wind_east_m_s
    if ground_m_s < least_m_s or ground_m_s > most_m_s:
        return False
    with_it = ground_m_s - least_m_s
    into_it = most_m_s - ground_m_s
    return wind <= with_it * with_it and wind <= into_it * into_it
