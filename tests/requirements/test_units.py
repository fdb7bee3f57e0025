"""Units of what is calculated: products, quotients and roots, exact where numbers are turned, and refused where they do not fit."""

from __future__ import annotations

import itertools
import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.cli import main
from cratous.services.requirements import fretish
from cratous.services.requirements.language import read
from cratous.services.requirements.specification import NotRead
from cratous.services.requirements.units import (
    UNITS,
    NoUnit,
    dimension,
    factor,
    of_text,
    product,
    root,
)
from cratous.services.requirements.watch import watch

HEAD = """trace every 1 s
signal x, y: m
signal v: m/s
signal k: kn
signal t: s
signal n: 1
signal f: ft
signal p: %
signal w: deg
signal a: m^2
signal e: J
signal c: degC
signal b: bool
"""
PLAIN = sorted(set(UNITS) - {"degC"})


@given(st.sampled_from(PLAIN), st.sampled_from(PLAIN), st.sampled_from(PLAIN))
def test_products_are_those_of_numbers(one: str, other: str, third: str) -> None:
    both = product(one, other)
    assert both == product(other, one)
    assert factor(both) == factor(one) * factor(other)
    assert factor(product(one, other, "/")) * factor(other) == factor(one)
    assert product(both, third) == product(one, product(other, third))
    assert dimension(product(both, other, "/")) == dimension(one)
    assert of_text(both) == both
    assert root(product(one, one)) == one


def test_every_unit_has_one_text() -> None:
    for one, other in itertools.product(PLAIN, PLAIN):
        made = product(one, other)
        assert made == of_text(made)
        assert dimension(made)
    for text, same in (
        ("s*m", "m*s"),
        ("m/s/s", "m/s^2"),
        ("m^2/m", "m"),
        ("1/s", "Hz"),
        ("1*m", "m"),
    ):
        assert of_text(text) == same
    for text in ("m^0", "m^99", "furlong", "m**s", "", "m^", "/m"):
        with pytest.raises(NoUnit):
            of_text(text)


def of(text: str) -> dict[str, str]:
    """The units of what a requirement calculates."""
    spec = read(f"{HEAD}requirement R: {text}\n")
    return {name: s.unit for name, s in spec.signals.items() if s.made is not None}


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("x * v >= 3 m^2/s", "m^2/s"),
        ("x * x <= a", "m^2"),
        ("x / t < v", "m/s"),
        ("x / y <= 2", "1"),
        ("v * t <= 30 ft", "m"),
        ("abs(x - y) >= 1 nmi", "m"),
        ("sqrt(x * x + y * y) >= 0.5 km", "m"),
        ("x * f <= 2 m^2", "ft*m"),
        ("p * x <= 3 m", "%*m"),
        ("x * 2 ft <= a + 1 m^2", None),
        ("sin(w) * x <= y", "m"),
        ("e / a <= 3 J/m^2", "J/m^2"),
        ("(x + 2 km) * 3 <= y", "m"),
        ("-x >= -3 m", "m"),
        ("1 / t <= 2 Hz", "Hz"),
        ("c - c <= 1 degC", "degC"),
    ],
)
def test_what_is_calculated_has_its_unit(text: str, unit: str | None) -> None:
    if unit is None:
        with pytest.raises(NotRead, match="signals of two units"):
            of(text)
        return
    assert list(of(text).values())[-1] == unit or unit in of(text).values()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x * v >= 3 m", "units that do not fit; expected length^2/time, as m^2/s; got m"),
        ("x * y >= v", "units that do not fit; expected length^2, as m^2; got m/s"),
        ("x + v >= 3 m", "units that do not fit; expected length, as m; got m/s"),
        ("x + f >= 3 m", "signals of two units; expected m; got ft"),
        ("x * x <= x * f", "signals of two units are compared; expected m^2; got ft*m"),
        ("x + 3 >= 3 m", "units that do not fit; expected length, as m; got 1"),
        ("x / y >= 3 m", "units that do not fit; expected number, as 1; got m"),
        ("sqrt(x) >= 3 m", "the root of this has no unit; expected even powers of units, as m^2; got m"),
        ("sin(x) >= 0.5", "units that do not fit; expected an angle in rad or deg; got m"),
        ("c * x >= 3 m", "a temperature in degC is counted from no absolute zero"),
        ("b * x >= 3 m", "this is no such signal; expected a signal declared as a unit"),
        ("x * y", "a number stands for a truth value"),
        ("3 m", "a number stands for a truth value"),
        ("(x > 3 m) * y > 3 m", "a truth value is calculated with"),
        ("not x * y", "a number stands for a truth value"),
        ("always within 1 s (x - y)", "a number stands for a truth value"),
        ("2 m * 3 m > 1 m^2", "no signal is compared"),
        ("x > 1 m / 0", "a number with a point that is not 0"),
        ("x >= 3 furlong", "this cannot stand here"),
        ("x >= 3 m^0", "a unit has a power from 1 to 9"),
        ("x" + " * x" * 9 + " > 1 m^9", "a unit has a power above 9"),
        ("x >= 2 m + 3 s", "units that do not fit; expected m; got s"),
    ],
)  # fmt: skip
def test_what_does_not_fit_says_what_was_expected_and_got(text: str, says: str) -> None:
    with pytest.raises(NotRead) as no:
        of(text)
    assert says in str(no.value).replace("requirements, line 14, ", ""), str(no.value)
    assert no.value.item in ("R", "")
    assert no.value.where.startswith("requirements, line 14, column ")


def test_numbers_are_calculated_and_turned_exactly(tmp_path: Path) -> None:
    spec = read(
        HEAD + "requirement AREA: x * v >= 20 ft^2/s\nrequirement TIME: (x - y) / v <= 1 min\n"
        "requirement HALF: x >= 1 km / 2 + 1 m\nrequirement OVER: x * 2 ft >= 3 m*ft\n"
        "requirement SINE: sin(w) >= 0.5\n"
    )
    trace = tmp_path / "t.csv"
    names = "time_s,x,y,v,k,t,n,f,p,w,a,e,c,b"
    rows = [
        "0,501,1,2,0,0,0,0,0,31,0,0,0,0",
        "1,1,500,1,0,0,0,0,0,29,0,0,0,0",
        "2,500,1,0,0,0,0,0,0,90,0,0,0,0",
    ]
    trace.write_text("\n".join([names, *rows]) + "\n")
    lines: list[str] = []
    watch(spec, trace, lines)
    assert lines == [
        "AREA:0,T", "TIME:0,F", "HALF:0,T", "OVER:0,T", "SINE:0,T",
        "AREA:1,F", "TIME:1,T", "HALF:1,F", "OVER:1,F", "SINE:1,F",
        "AREA:2,F", "TIME:2,?", "HALF:2,F", "OVER:2,T", "SINE:2,T",
    ]  # fmt: skip
    assert Fraction(20) * factor("ft^2/s") == Fraction(20 * 3048**2, 10**8)
    (area, *_, over, sine) = spec.requirements
    assert fretish.sentence(area.formula, spec).startswith(
        "The system shall always satisfy (x * v)"
    )
    with pytest.raises(fretish.NoForm, match="numbers with units"):
        fretish.sentence(over.formula, spec)
    assert not isinstance(sine.formula, NotRead)


def test_a_number_in_another_unit_is_another_number() -> None:
    """The same digits in two units are never taken for one signal."""
    spec = read(f"{HEAD}requirement R: x * 2 ft <= 1 m^2 and x * 2 m <= 1 m^2\n")
    made = {name: s.unit for name, s in spec.signals.items() if s.made is not None}
    assert made == {"(x * 2.0 ft)": "ft*m", "(x * 2.0 m)": "m^2"}


def test_each_requirement_that_does_not_fit_is_named_by_its_id(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "r.req"
    text = f"{HEAD}requirement ONE: x >= 3 s\nrequirement GOOD: x >= 3 m\nrequirement TWO: x * v >= y\n"
    file.write_text(text)
    assert main(["check", str(file), "--json"]) == 2
    ((*problems,),) = [one["problems"] for one in json.loads(capsys.readouterr().out)["files"]]
    assert [one["item"] for one in problems] == ["ONE", "TWO"]
    assert [one["expected"] for one in problems] == ["length, as m", "length^2/time, as m^2/s"]
    assert main(["monitor", str(file), "--requirements", str(file)]) == 2
    assert f"{file}, line 14, column 20: ONE: units that do not fit" in capsys.readouterr().err
