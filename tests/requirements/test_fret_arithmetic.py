"""Arithmetic in FRET's requirements: calculated from the signals of each sample, and refused where its meaning is not clear."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from requirement_tools import alike_at_once

from cratous.services.requirements import fret, fret_definitions, language
from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.fretish import sentence
from cratous.services.requirements.lint import lint
from cratous.services.requirements.specification import NotRead, Specification
from cratous.services.requirements.watch import Watch, watch
from cratous.spec.errors import BadInput

VARIABLES = [
    *({"variable_name": n, "idType": "Input", "dataType": "double"} for n in "xyz"),
    *({"variable_name": n, "idType": "Input", "dataType": "integer"} for n in "ij"),
    {"variable_name": "b", "idType": "Input", "dataType": "boolean"},
    {"variable_name": "HALF", "idType": "Internal", "dataType": "double", "assignment": "0.5"},
]
SAME = {
    "(G (x + y * z >= 3.0))": lambda r, _: r["x"] + r["y"] * r["z"] >= 3,
    "(G ((x + y) * z >= 3.0))": lambda r, _: (r["x"] + r["y"]) * r["z"] >= 3,
    "(G (x - y - z < 0.0))": lambda r, _: r["x"] - r["y"] - r["z"] < 0,
    "(G (x = HALF * (y + -z)))": lambda r, _: r["x"] == 0.5 * (r["y"] - r["z"]),
    "(G (absReal(x - y) <= 1.0))": lambda r, _: abs(r["x"] - r["y"]) <= 1,
    "(G (absReal(preReal(1.0, x) - x) <= 1.0))": lambda r, p: abs((p or {"x": 1.0})["x"] - r["x"]) <= 1,
    "(G (preReal(y, x + z) > 0.0))": lambda r, p: (p["x"] + p["z"] if p else r["y"]) > 0,
    "(G (preReal(0.0, preReal(2.0, x)) <= x | b))": None,
    "(G (preBool(FALSE, x > y) -> b))": lambda r, p: not (p and p["x"] > p["y"]) or r["b"] == 1,
    "(G (preBool(TRUE, (b & x > y))))": lambda r, p: not p or (p["b"] == 1 and p["x"] > p["y"]),
    "(G (preBool(b, x > y)))": lambda r, p: p["x"] > p["y"] if p else r["b"] == 1,
    "(G (sin(x) * cos(0.5) >= y))": lambda r, _: math.sin(r["x"]) * math.cos(0.5) >= r["y"],
    "(G (sqrt(absReal(x)) < y))": lambda r, _: math.sqrt(abs(r["x"])) < r["y"],
    "(G (i + 2 * j - absInt(-i) != 3))": lambda r, _: r["i"] + 2 * r["j"] - abs(r["i"]) != 3,
}  # fmt: skip
NUMBERS = st.sampled_from((-2.0, -1.0, 0.0, 1.0, 2.0, 3.0))
ROW = st.fixed_dictionaries(dict.fromkeys("xyzij", NUMBERS) | {"b": st.sampled_from((0.0, 1.0))})


def export(**said: Any) -> str:
    return json.dumps({"requirements": [{"reqid": "A", **said}], "variables": VARIABLES})


def of(formula: str) -> Specification:
    return fret.read(export(semantics={"ftInfAUExpanded": formula}), "e.json")


def bad(spec: Specification, rows: list[dict[str, Any]]) -> list[bool | None]:
    """Whether each sample is violated, None for one that is unknown."""
    lines: list[str] = []
    watching = Watch(spec, lines)
    for n, row in enumerate(rows):
        watching.sample(n, row)
    return [{"F": True, "T": False, "?": None}[line[-1]] for line in lines]


@settings(max_examples=30, deadline=None)
@given(rows=st.lists(ROW, min_size=1, max_size=4))
def test_it_is_calculated_at_each_sample(rows: list[dict[str, float]]) -> None:
    for text, asked in SAME.items():
        if asked is not None:
            before = [None, *rows[:-1]]
            wanted = [not asked(row, last) for row, last in zip(rows, before, strict=True)]
            assert bad(of(text), rows) == wanted, text
    older = [0.0, *[2.0, *(row["x"] for row in rows)]][: len(rows)]
    text = "(G (preReal(0.0, preReal(2.0, x)) <= x | b))"
    wanted = [not (o <= r["x"] or r["b"] == 1) for o, r in zip(older, rows, strict=True)]
    assert bad(of(text), rows) == wanted


def test_what_is_not_known_and_a_quotient_by_zero_are_unknown() -> None:
    row = {"x": 1.0, "y": 2.0}
    spec = of("(G (x / y >= 0.5))")
    rows = [row, {**row, "y": 0.0}, {**row, "x": None}, {**row, "x": math.inf}, row]
    assert bad(spec, rows) == [False, None, None, None, False]
    assert bad(of("(G (sqrt(x) >= 0.0))"), [row, {"x": -1.0}, row]) == [False, None, False]
    assert bad(of("(G (x * y <= 3.0))"), [{"x": 1e300, "y": 1e300}]) == [None]
    rows = [{"x": 5.0}, {"x": None}, {"x": 5.0}, {"x": 5.0}]
    assert bad(of("(G (preReal(0.0, x) + x >= 10.0))"), rows) == [True, None, None, False]


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        ("(G (i / j > 1))", "quotient of whole numbers"),
        ("(G (x > 1/2))", "quotient of whole numbers"),
        ("(G (x > 1.0/0.0))", "not 0"),
        ("(G (x + b > 1.0))", "a truth value is calculated with"),
        ("(G ((x > y) + 1.0 > 1.0))", "a truth value is calculated with"),
        ("(G (x + y))", "a number stands for a truth value"),
        ("(G (b & x - y))", "a number stands for a truth value"),
        ("(G (3.0))", "a number stands for a truth value"),
        ("(G (absReal(x, y) > 1.0))", "of so many arguments"),
        ("(G (preReal(0.0, 1.0) > x))", "never changes"),
        ("(G (preBool(FALSE, x) | b))", "a number stands for a truth value|no truth value"),
        ("(G (atan(x) > 0.0))", "this function is not read; got atan"),
        ("(G (sin(x, y) > 0.0))", "of so many arguments"),
        ("(G (" + "+".join(["x"] * 3000) + " > 1.0))", "too long"),
        ("(G (x > " + "*".join(["9999.5"] * 300) + "))", "what is calculated is too long"),
    ],
)
def test_what_has_no_clear_meaning_is_refused(formula: str, why: str) -> None:
    no = of(formula).requirements[0].formula
    assert isinstance(no, NotRead)
    assert any(one in str(no) for one in why.split("|")), str(no)


def test_a_sentence_says_the_same_and_is_said_again() -> None:
    text = "the a shall always satisfy absReal(x - y) <= 1.0 + z"
    spec = fret.read(export(fulltext=text), "e.json")
    assert sentence(spec.requirements[0].formula, spec) == (  # type: ignore[arg-type]
        "The system shall always satisfy (1.0 + z) >= absReal((x - y))"
    )
    again = fret.read(export(fulltext=sentence(spec.requirements[0].formula, spec)), "e.json")  # type: ignore[arg-type]
    assert again.requirements[0].formula == spec.requirements[0].formula


HEAD = "trace every 1 s\nsignal x, y: m\nsignal v: kn\nsignal n: 1\n"


def test_units_of_a_file_of_requirements(tmp_path: Path) -> None:
    asked = "the a shall always satisfy {}"
    spec = language.read(
        f'{HEAD}requirement A: fretish "{asked.format("absReal(x - y) / 2.0 >= n * x + 1.0")}"'
    )
    assert sources(spec.signals, spec.signals) == {"x", "y", "v", "n"}
    made = {name: s.unit for name, s in spec.signals.items() if s.made is not None}
    assert made == {"(absReal((x - y)) / 2.0)": "m", "((n * x) + 1.0)": "m"}
    assert {one.name for one in lint(spec)} == {"v"}
    with pytest.raises(BadInput, match=r"a signal declared as a unit: n, v, x, y; got z"):
        language.read(
            f'{HEAD}requirement A: fretish "{asked.format("x + y > 1.0")}"\nrequirement B: z > 1 m'
        )
    trace = tmp_path / "t.csv"
    trace.write_text("time_s,x,y,n\n0,4,0,0.25\n1,4,1,0.25\n")
    (one,) = watch(spec, trace).outcomes
    assert (one.holds, one.violated, one.first_violated) == (1, 1, 10**9)
    (margin,) = one.margins
    assert (margin.least, margin.unit) == (-0.5, "m")
    for said, why in (
        ("sin(v) > 0.5", "an angle in rad"), ("sqrt(x) > 1.0", "root of this has no unit; expected even powers of units, as m\\^2; got m"),
        ("x + v > 1.0", "do not fit; expected length, as m; got kn"), ("x * y > v", "expected length\\^2, as m\\^2; got kn"),
        ("preReal(0.0, x) > 1.0", "none is the one before"), ("x / y > n * v", "expected number, as 1; got kn"),
    ):  # fmt: skip
        with pytest.raises(NotRead, match=why):
            language.read(f'{HEAD}requirement A: fretish "{asked.format(said)}"')


def test_a_long_trace_is_judged_the_same_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = of("(G (absReal(preReal(0.0, x) - x) <= y / 2.0))")
    rows = [f"{k % 7},{k % 4}" for k in range(60)]
    rows = ["x,y", *rows[:9], ",1", *rows[9:]]
    assert alike_at_once(spec, tmp_path / "t.csv", rows, monkeypatch).unknown == 2


def defined(name: str, text: str, kind: str = "boolean") -> dict[str, str]:
    return {"variable_name": name, "idType": "Internal", "dataType": kind, "assignment": text}


def over(formula: str, *more: dict[str, str]) -> Specification:
    row = {"reqid": "A", "semantics": {"ftInfAUExpanded": formula}}
    return fret.read(
        json.dumps({"requirements": [row], "variables": [*VARIABLES, *more]}), "e.json"
    )


@settings(max_examples=25, deadline=None)
@given(rows=st.lists(ROW, min_size=1, max_size=3))
def test_variables_that_are_defined_by_a_formula(rows: list[dict[str, float]]) -> None:
    more = [
        defined("high", "fast and not (x <= 1.0) or same"), defined("fast", "sum > 2.0"), defined("also", "b"),
        defined("sum", "x + HALF * y", "double"), defined("same", "b xor b"), defined("z2", "z", "double"),
    ]  # fmt: skip
    for formula, asked in {
        "(G (high -> (z2 > 0.0)))": lambda r: (
            not (r["x"] + r["y"] / 2 > 2 and r["x"] > 1) or r["z"] > 0
        ),
        "(G (fast = also))": lambda r: (r["x"] + r["y"] / 2 > 2) == (r["b"] == 1),
        "(G (sum - 1.0 < x))": lambda r: r["x"] + r["y"] / 2 - 1 < r["x"],
    }.items():
        assert bad(over(formula, *more), rows) == [not asked(row) for row in rows], formula


@pytest.mark.parametrize(
    ("texts", "why"),
    [
        (("m1", "not m0"), "defined by itself"),
        (("pre b",), "`pre` has no value at the first sample"),
        (("b -> pre pre b",), "`pre` has no value at the first sample"),
        (("pre b -> b",), "`pre` has no value at the first sample"),
        (("if pre b then b else b",), "`pre` has no value at the first sample"),
        (("b -> x",), "stand for one another|no truth value"),
        (("if x then b else b",), "no truth value"),
        (("if b then b",), "outside"),
        (("b -> pre m0",), "defined by itself"),
        (("x + y",), "a number stands for a truth value"),
        (("nowhere and b",), "nothing says which signal"),
        ((*(f"m{k} and m{k}" for k in range(1, 40)), "b"), "too long"),
        (("m1", "m2", "x + y"), "not read: a number stands for a truth value"),
    ],
)
def test_definitions_that_are_not_read(texts: tuple[str, ...], why: str) -> None:
    no = (
        over("(G m0)", *(defined(f"m{k}", text) for k, text in enumerate(texts)))
        .requirements[0]
        .formula
    )
    assert isinstance(no, NotRead)
    assert any(one in str(no) for one in why.split("|")), str(no)
    assert str(no).count("defined by") <= 1


def test_a_definition_is_looked_into_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many others have to be told before it."""
    asked: list[str] = []
    real = fret_definitions.tree_of
    monkeypatch.setattr(
        fret_definitions,
        "tree_of",
        lambda p, text, *more, **said: asked.append(text) or real(p, text, *more, **said),
    )
    texts = [*(f"not m{k}" for k in range(1, 30)), "b"]
    spec = over("(G m0)", *(defined(f"m{k}", text) for k, text in enumerate(texts)))
    assert not isinstance(spec.requirements[0].formula, NotRead)
    assert len(asked) == len(texts)


def test_a_definition_counts_in_a_file_with_units_and_of_two_none_does(tmp_path: Path) -> None:
    row = {"reqid": "A", "fulltext": "the a shall always satisfy near"}
    near = defined("near", "absReal(x - far) <= 10.0")
    for more, why in (([], ""), ([defined("near", "x > 1.0")], "in two ways")):
        data = {"requirements": [row], "variables": [near, *more]}
        (tmp_path / "e.json").write_text(json.dumps(data))
        text = f'{HEAD}fret "e.json" with far is y'
        (one,) = language.read(text, "own.req", tmp_path).requirements
        assert isinstance(one.formula, NotRead) == bool(why)
        assert why in str(one.formula)
