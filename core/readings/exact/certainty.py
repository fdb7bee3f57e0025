"""When a computed difference decides the order of two real numbers, and bounds on rounding errors.

Definitions: `spec.rounding`. The float filter expands the first two kernels for each comparison; the enclosed reading
widens the result of each operation by the third; the pairs of doubles of the exact reading bound their errors by the
last three.
"""

from cratous.core.kernel import kernel


@kernel(implements="rounding.surely_positive")
def surely_above(value: float, bound: float) -> bool:
    """True iff every real number within `bound` of `value` is positive; any one unit for both."""
    return value > bound


@kernel(implements="rounding.surely_negative")
def surely_below(value: float, bound: float) -> bool:
    """True iff every real number within `bound` of `value` is negative; any one unit for both.

    A sum of doubles, rounded, is below 0 where the sum is, and nowhere else.
    """
    return value + bound < 0


@kernel(implements="rounding.outward_margin", nonnegative=("share", "least"))
def outward_margin(value: float, share: float, least: float) -> float:
    """How far an operation's result is moved outward; any one unit for value and least.

    share: part of the magnitude, 0 to 1; least: what underflow may take.
    """
    return abs(value) * share + least


@kernel(implements="rounding.stands_for")
def sum_left_out(a_left: float, b_left: float, low_rest: float, rest: float) -> float:
    """Bound on the difference between the sum of two values and the pair of doubles that represents it.

    a_left, b_left: the same of the two values; low_rest, rest: what was rounded off. Any one unit.
    """
    return a_left + b_left + (abs(low_rest) + abs(rest))


@kernel(implements="rounding.stands_for")
def factors_left_out(a_left: float, b_left: float, a_size: float, b_size: float) -> float:
    """Bound on the difference between a product and the product of the pairs of doubles that represent its factors.

    a_left, b_left: the same of the factors; a_size, b_size: magnitudes of their pairs. Any one unit for each factor.
    """
    return a_left * (b_size + b_left) + b_left * a_size


@kernel(implements="rounding.stands_for")
def product_left_out(
    of_factors: float,
    cross_a: float,
    cross_b: float,
    low: float,
    cross_rest: float,
    rest: float,
    share: float,
) -> float:
    """Bound on the difference between a product and the pair of doubles that represents it.

    of_factors: how far the product of the pairs of its factors may be off (`factors_left_out`); cross_a, cross_b,
    low: rounded products of the parts, the last not added; cross_rest, rest: what sums rounded off; share: the
    relative error of a rounded product.
    """
    of_products = share * (abs(cross_a) + abs(cross_b) + abs(low)) + abs(low)
    return of_factors + of_products + (abs(cross_rest) + abs(rest))
