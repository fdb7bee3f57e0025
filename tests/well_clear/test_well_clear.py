"""Well clear for users: exact verdicts, enclosed instants, arrays, refusals, and the bad example."""

from __future__ import annotations

import doctest
import random
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from cratous.core import well_clear
from cratous.core.kernel import Vec2
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import (
    Volume,
    cylinder,
    horizontal_violation_tau,
    is_lost_during,
    is_violated,
    loss,
    losses,
    spans_on_doubles,
)
from cratous.proofs.claim import Claim
from cratous.proofs.engine import prover
from cratous.spec import well_clear as meaning
from cratous.spec.errors import BadInput

MODELS = {"tau_mod": "taumod", "tcpa": "tcpa", "tep": "tep"}
VOLUME = Volume(1222.32, 137.16, 35.0)
AHEAD, CLOSING = (3000.0, 0.0, 0.0), (-60.0, 0.0, 0.0)


def test_the_examples_of_the_module_hold():
    result = doctest.testmod(well_clear)
    assert result.attempted > 10
    assert result.failed == 0


def _cases(count: int, seed: int) -> list[tuple[tuple, tuple, tuple, float, float]]:
    """States, thresholds and spans of small integers, so that many lie on an edge."""
    rng = random.Random(seed)

    def some(low: int, high: int) -> float:
        return float(rng.randint(low, high))

    made = []
    for _ in range(count):
        s, v = (some(-6, 6), some(-6, 6), some(-4, 4)), (some(-2, 2), some(-2, 2), some(-1, 1))
        limits = (some(0, 5), some(0, 3), some(0, 4), some(0, 3), some(0, 2))
        begin = some(0, 4)
        made.append((s, v, limits, begin, begin + some(0, 8)))
    return made


@pytest.mark.parametrize("model", MODELS)
def test_verdicts_and_instants_are_those_of_the_definition(model: str):
    cases, lost_some = _cases(400, 3), 0
    defined = getattr(meaning, f"violation_{MODELS[model]}_at")
    for s, v, limits, begin, end in cases:
        volume = Volume(*limits, model=model)
        state = (meaning.Plane(*map(Fraction, s[:2])), meaning.Plane(*map(Fraction, v[:2])))
        up, rate, sizes = Fraction(s[2]), Fraction(v[2]), meaning.Thresholds(*map(Fraction, limits))
        found = loss(s, v, volume, begin, end)
        lost_some += found is not None
        assert is_lost_during(s, v, volume, begin, end) == (found is not None)
        assert is_violated(s, v, volume) == defined(*state, up, rate, sizes, Fraction(0))
        for k in range(9):
            t = Fraction(begin) + (Fraction(end) - Fraction(begin)) * k / 8
            inside = found is not None and found.first_s.high <= t <= found.last_s.low
            outside = found is None or t < found.first_s.low or t > found.last_s.high
            if inside or outside:
                assert defined(*state, up, rate, sizes, t) == inside
    assert 20 < lost_some < 380


@pytest.mark.parametrize("model", MODELS)
def test_arrays_are_the_states_one_by_one(model: str):
    cases = _cases(60, 5)
    s, v = (np.array([case[k] for case in cases]) for k in (0, 1))
    columns = np.array([case[2] for case in cases]).T
    begin, end = (np.array([case[k] for case in cases]) for k in (3, 4))
    volume = Volume(*columns, model=model)
    found, now = losses(s, v, volume, begin, end), is_violated(s, v, volume)
    during = is_lost_during(s, v, volume, begin, end)
    assert found.lost.tolist() == during.tolist()
    for k, (p, w, limits, b, t) in enumerate(cases):
        alone = Volume(*limits, model=model)
        assert bool(now[k]) == is_violated(p, w, alone)
        one = loss(p, w, alone, b, t)
        assert bool(found.lost[k]) == (one is not None)
        bounds = [found[j][k] for j in range(1, 5)]
        if one is None:
            assert np.isnan(bounds).all()
        else:
            assert bounds == [*one.first_s, *one.last_s]


def test_shapes_are_broadcast_over_the_leading_dimensions():
    s = np.zeros((4, 1, 3)) + np.arange(4.0)[:, None, None] * 1000
    found = losses(s, CLOSING, Volume(1222.32, 4000.0), np.zeros(5), 60.0)
    assert found.lost.shape == found.last_high_s.shape == (4, 5)
    assert is_violated(s, CLOSING, cylinder(np.ones(5), 1.0)).shape == (4, 5)
    empty = losses(np.empty((0, 3)), CLOSING, VOLUME, 0.0, 1.0)
    assert empty.lost.shape == (0,)
    spans = spans_on_doubles(s, CLOSING, VOLUME, 0.0, np.full(5, 60.0))
    assert spans.first_s.shape == (4, 5)


@pytest.mark.parametrize("s", [(1250.0, 0.0, 100.0), (350.0, 1200.0, -100.0)])
def test_touching_counts_and_the_least_further_away_does_not(s: tuple[float, float, float]):
    away = (s[0], s[1], 0.0)
    volume = cylinder(1250.0, 100.0)
    found = loss(s, away, volume, 0.0, 60.0)
    assert found is not None
    assert found.first_s == (0.0, 0.0)
    assert found.last_s.high < 1e-12
    for k in (0, 2):
        off = list(s)
        off[k] = float(np.nextafter(s[k], np.copysign(np.inf, s[k])))
        assert loss(off, away, volume, 0.0, 60.0) is None


def test_enclosures_are_narrow_and_stay_so_where_speeds_are_tiny():
    found = loss(AHEAD, CLOSING, VOLUME, 0.0, 120.0)
    assert found is not None
    for low, high in found:
        assert 0 < high - low < 1e-10
    for speed in (1e-160, 5e-324):
        still = loss((0.0, 0.0, 0.0), (speed, 0.0, speed), VOLUME, 0.0, 60.0)
        assert still is not None
        assert still.first_s.low == 0.0
        assert still.last_s.high == 60.0


def test_spans_on_doubles_are_the_kernels():
    rng = np.random.default_rng(2)
    s, v = rng.normal(size=(500, 3)) * [1500, 1500, 80], rng.normal(size=(500, 3)) * [30, 30, 3]
    volume = Volume(150.0, 30.0, 15.0, 20.0, 5.0)
    spans = spans_on_doubles(s, v, volume, 0.0, 60.0)
    kernel = well_clear.violation_interval_taumod
    limits = well_clear.Thresholds(150.0, 30.0, 15.0, 20.0, 5.0)
    span = (0.0, 60.0)
    wanted = [
        kernel(
            Vec2(*p[:2].tolist()), Vec2(*w[:2].tolist()), float(p[2]), float(w[2]), limits, *span
        )
        for p, w in zip(s, v, strict=True)
    ]
    assert list(zip(*(part.tolist() for part in spans), strict=True)) == wanted
    with pytest.raises(BadInput, match="out does not fit"):
        compiled(kernel)(*np.zeros((6, 2)), *limits, *span, out=(np.empty(2),))


@pytest.mark.parametrize(
    ("call", "wanted"),
    [
        (lambda: is_violated((np.nan, 0, 0), CLOSING, VOLUME), r"s\[0\]: not finite"),
        (lambda: is_violated(AHEAD, [[0, 0, 0], [0, np.inf, 0]], VOLUME), r"v\[1\]\[1\]: not fin"),
        (lambda: is_violated((1.0, 2.0), CLOSING, VOLUME), r"s: not a vector in space.*\(2,\)"),
        (lambda: is_violated(1.0, CLOSING, VOLUME), "s: not a vector in space"),
        (lambda: is_violated("near", CLOSING, VOLUME), "s: not numbers"),
        (lambda: is_violated([[1, 2, 3], [1, 2]], CLOSING, VOLUME), "s: not an array"),
        (lambda: is_violated((2**53 + 1, 0, 0), CLOSING, VOLUME), "no double holds"),
        (lambda: is_violated(np.ones((2, 3)), np.ones((4, 3)), VOLUME), "shapes do not fit"),
        (lambda: Volume(-1.0, 10.0), "dthr_m: a threshold below zero"),
        (lambda: Volume(1.0, [3.0, -2.0]), "zthr_m: a threshold below zero.*got -2.0"),
        (lambda: Volume(1.0, 1.0, tcoa_s=np.nan), "tcoa_s: not finite"),
        (lambda: Volume(1.0, 1.0, vmod_s=True), "vmod_s: not numbers"),
        (lambda: Volume(1.0, 1.0, model="tau"), "model: no such model; expected tau_mod or tcpa"),
        (lambda: loss(AHEAD, CLOSING, VOLUME, 2.0, 1.0), "b_s: ends before it begins"),
        (lambda: loss(AHEAD, CLOSING, VOLUME, 0.0, np.inf), "t_s: not finite"),
        (lambda: loss(AHEAD, CLOSING, VOLUME, [0.0] * 2, [1.0] * 3), "b_s, t_s: shapes do not"),
        (lambda: loss([AHEAD] * 2, CLOSING, VOLUME, 0.0, 1.0), "more than one state"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_by_name(call, wanted: str):
    with pytest.raises(BadInput, match=wanted):
        call()


# -- plain tau ------------------------------------------------------------------------------
def test_plain_tau_is_refuted_with_a_witness_where_the_others_are_proved():
    def convex(c: Claim) -> None:
        s, v = c.vector("s"), c.vector("v")
        dthr, tthr, early, middle, late = c.reals("dthr tthr early middle late")
        for premise in (dthr >= 0, tthr >= 0, early <= middle, middle <= late, v.y == 0):
            c.premise(premise)
        lost = [
            c.use(horizontal_violation_tau, Vec2(s.x + t * v.x, s.y), v, dthr, tthr)
            for t in (early, middle, late)
        ]
        c.show(c.implies(c.all_of(lost[0], lost[2]), lost[1]))

    claim = Claim()
    convex(claim)
    theorem = prover.prove("tau_is_convex", claim, "As the others are.")
    (outcome,) = theorem.outcomes
    assert not theorem.proved
    assert outcome.status == "refuted"
    value = {name: Fraction(text) for name, text in outcome.counterexample if "?" not in text}
    if len(value) == len(outcome.counterexample):  # a rational witness: run it
        at = [value.get(name, Fraction(0)) for name in ("s.x", "s.y", "v.x")]
        verdicts = [
            horizontal_violation_tau(
                Vec2(at[0] + value[t] * at[2], at[1]), Vec2(at[2], 0), value["dthr"], value["tthr"]
            )
            for t in ("early", "middle", "late")
        ]
        assert verdicts == [True, False, True]


def test_the_witness_of_the_report_is_one():
    s, v = Vec2(600, 140), Vec2(-20, 0)
    seen = [horizontal_violation_tau(Vec2(s.x + t * v.x, s.y), v, 150, 16) for t in (20, 27, 28)]
    assert seen == [True, False, True]


def test_the_guide_runs(root: Path):
    text = (root / "docs" / "guides" / "well-clear.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^```python\n(.*?)\n```", text, re.M | re.S)
    assert example.count("assert ") >= 6
    exec(compile(example, "docs/guides/well-clear.md", "exec"), {})
