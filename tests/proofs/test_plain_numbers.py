"""A theorem that computes with doubles is refused; one that computes exactly is not."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.proofs.engine import plain_numbers, prover
from cratous.proofs.engine.lift import REPLACED
from cratous.spec.errors import BadInput

HEAD = '''"""A sentence."""
from fractions import Fraction
from math import sqrt

from cratous.core.well_clear import vertical_violation

TENTH = 0.1


def off(x, n):
    """True of doubles alone."""
    return x / n * n != x


def rooted(x):
    return sqrt(x) * sqrt(x) != x


def power(x):
    return x**-1 * x != 1


def thirds():
    three = 3
    return (1 - three) / three * three != 1 - three


def one():
    return 1


def by_one(n):
    return one() / n * n != one()


def inner(x):
    return off(x, 49)


def constant(x):
    return TENTH + x > Fraction(3, 10)


def added(x, y):
    return x + y > Fraction(3, 10)


def rounded(x):
    return float(x) + 1 > x


def in_place(x):
    x = x / 49
    return x != Fraction(1, 49)


def deeper(x):
    return sum([sqrt(y) * sqrt(y) for y in (x, x + 1)]) != 2 * x + 1


def by_default(x, k=TENTH):
    return x + k > Fraction(3, 10)


def enclosing():
    k = TENTH

    def added(x):
        return x + k > Fraction(3, 10)

    return added


def helped():
    return inner(1)


def half(x):
    return x / 2


def claim(c):
    a, b, d = c.reals("a b d")
    c.use(vertical_violation, a, b, d, d)
    c.show({shown})
'''

INEXACT = {
    "c.define(off, 1, 49)": "`x / n`",
    "c.define(inner, 1)": "`x / n`",
    "c.define(in_place, 1)": "`x / 49`",
    "c.define(deeper, 2)": "`sqrt(y)`",
    "c.define(by_default, Fraction(1, 5))": "`x + k`",
    "c.define(enclosing(), Fraction(1, 5))": "`x + k`",
    "TENTH + TENTH + TENTH > Fraction(3, 10)": "`TENTH + TENTH`",
    "c.define(rooted, 2)": "`sqrt(x)`",
    "c.define(rooted, Fraction(2))": "`sqrt(x)`",
    "c.define(power, 49)": "`x ** (-1)`",
    "c.define(thirds)": "`(1 - three) / three`",
    "c.define(by_one, 49)": "`one() / n`",
    "c.define(constant, Fraction(1, 5))": "`TENTH + x`",
    "c.define(added, TENTH, Fraction(1, 5))": "`x + y`",
    "c.define(rounded, 2**53)": "`float(x)`",
    "1 / 49 * 49 != 1": "`1 / 49`",
    "off(1, 49)": "`x / n`",
    "helped()": "`x / n`",
    "c.define(half, 4) == 2": "`x / 2`",
}
EXACT = [
    "Fraction(TENTH) > Fraction(1, 10)",
    "TENTH > Fraction(1, 10)",
    "c.define(half, Fraction(4)) == 2",
    "c.negation(c.define(off, Fraction(1), 49))",
    "c.negation(c.define(inner, Fraction(1)))",
    "c.define(half, a) * 2 == a",
    "1 + 1 == 2",
]


def stated(folder: Path, shown: str) -> prover.Theorem:
    (folder / "numbers.py").write_text(HEAD.replace("{shown}", shown))
    return prover.prove_file("numbers", folder=folder)


@pytest.mark.parametrize("shown", INEXACT)
def test_a_double_is_refused(shown: str, tmp_path: Path):
    """Each of these would be shown, and most of them are false of numbers."""
    with pytest.raises(BadInput) as caught:
        stated(tmp_path, shown)
    assert "numbers.py" in caught.value.where
    assert INEXACT[shown] in caught.value.what
    assert "computed in doubles" in caught.value.what
    assert "fractions.Fraction" in caught.value.expected


@pytest.mark.parametrize("shown", EXACT)
def test_what_is_exact_is_proved(shown: str, tmp_path: Path):
    assert stated(tmp_path, shown).proved


def test_a_function_without_a_source_is_refused(tmp_path: Path):
    with pytest.raises(BadInput, match="'eval' of Python"):
        stated(tmp_path, 'c.define(eval("lambda x: x / 49 * 49 != x"), 1)')


def test_nothing_is_left_in_the_place_of_the_functions(tmp_path: Path):
    with pytest.raises(BadInput):
        stated(tmp_path, "c.define(off, 1, 49)")
    assert not REPLACED


def test_functions_and_their_defaults_are_the_same_when_watched():
    def scaled(x, by=3, *, and_more=1):
        return x * by + and_more

    watched = plain_numbers.watching(scaled)
    assert watched is not scaled
    assert watched(2) == scaled(2) == 7
    assert watched(2, 4, and_more=2) == 10
    with pytest.raises(plain_numbers.Inexact, match=r"`x \* by` is computed in doubles"):
        watched(2.0)
