"""When a computed difference decides the order of two real numbers, and how far rounding reaches.

Definitions: `spec.rounding`. The float filter writes the first two kernels out for each
comparison; the enclosed reading widens the result of each operation by the third.
"""

from cratous.core.kernel import kernel


@kernel(implements="rounding.surely_positive")
def surely_above(value: float, bound: float) -> bool:
    """True iff every real number within `bound` of `value` is positive; any one unit for both."""
    return value > bound


@kernel(implements="rounding.surely_negative")
def surely_below(value: float, bound: float) -> bool:
    """True iff every real number within `bound` of `value` is negative; any one unit for both."""
    return value < -bound


@kernel(implements="rounding.outward_margin", nonnegative=("share", "least"))
def outward_margin(value: float, share: float, least: float) -> float:
    """How far an operation's result is moved outward; any one unit for value and least.

    share: part of the magnitude, 0 to 1; least: what underflow may take.
    """
    return abs(value) * share + least
