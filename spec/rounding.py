"""Assumptions about arithmetic on doubles, and the meaning of an error bound.

The model of one operation (IEEE 754, binary64, round to nearest): its result is `rounded` from the real result of the
operation on its operands, sums without an underflow term; and rounding `keeps_order`. Results that overflow are
outside the model: the filter decides nothing there.
"""


def rounded(result: float, real: float, unit: float, tiny: float) -> bool:
    """`result` is `real`, rounded: relative error at most unit, plus tiny if it underflows."""
    return abs(result - real) <= unit * abs(result) + tiny


def keeps_order(less: float, more: float, less_rounded: float, more_rounded: float) -> bool:
    """Rounding preserves the order of two numbers."""
    return less > more or less_rounded <= more_rounded


def near(value: float, real: float, size: float, bound: float) -> bool:
    """A computed value is within a bound of a real one, and its magnitude is at most `size`."""
    return abs(value - real) <= bound and abs(value) <= size


def stands_for(high: float, low: float, real: float, left_out: float) -> bool:
    """A pair of doubles represents a real number that is within `left_out` of their sum."""
    return abs(real - (high + low)) <= left_out


def surely_positive(real: float, value: float, bound: float) -> bool:
    """The real number is positive if it lies within `bound` of `value`. FOR ALL real numbers."""
    return not stands_for(value, 0, real, bound) or real > 0


def surely_negative(real: float, value: float, bound: float) -> bool:
    """The real number is negative if it lies within `bound` of `value`. FOR ALL real numbers."""
    return not stands_for(value, 0, real, bound) or real < 0


def outward_margin(value: float, share: float, least: float) -> float:
    """A share of the magnitude, plus a constant for underflow."""
    if value < 0:
        return least - share * value
    return least + share * value


def between(low: float, real: float, high: float) -> bool:
    """The interval [low, high] contains the number."""
    return low <= real and real <= high
