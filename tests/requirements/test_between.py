"""Between samples: with a greatest rate a comparison holds only with enough to spare, and what a signal does in between
is never called held."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.services.requirements.arithmetic import Calculated
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.formula import signals
from cratous.services.requirements.language import read
from cratous.services.requirements.specification import NotRead
from cratous.services.requirements.watch import watch

HEAD = "trace every 1 s gap 1 s\nsignal x: m rate 2 m/s\nsignal y: ft rate 60 ft/min\nsignal z: m\nsignal b: bool\n"


def verdicts(text: str, rows: list[str], tmp_path: Path, head: str = HEAD) -> list[str]:
    trace = tmp_path / "t.csv"
    trace.write_text("\n".join(["time_s,x,y,z,b", *rows]) + "\n")
    lines: list[str] = []
    watch(read(f"{head}requirement R: {text}\n"), trace, lines)
    return [line.partition(",")[2] for line in sorted(lines, key=lambda one: float(one[2:-2]))]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        # half of a second at 2 m/s is 1 m, at 60 ft/min half a foot
        ("x >= 3 m", "T?F"),
        ("x > 3 m", "T?F"),
        ("not (x < 3 m)", "T?F"),
        ("x <= 4 m", "F?T"),
        ("x < 4 m", "F?T"),
        ("x * 2 >= 6 m", "T?F"),
        ("2 * x / 2 >= 3 m", "T?F"),
        ("-x <= -3 m", "T?F"),
        ("abs(x) >= 3 m", "T?F"),
        ("x + x >= 6 m", "T?F"),
        ("x >= z", "T?F"),
        ("z <= x", "T?F"),
        ("y >= 3 ft", "T?F"),
        ("z >= 1 m", "TTT"),
        ("x < 3 m implies not b", "T?F"),
        ("x < 3 m implies b", "TTT"),
        ("x >= 3 m implies not b", "FFT"),
        ("x >= 3 m or b", "TTT"),
        ("historically within 1 s x >= 3 m", "T?F"),
    ],
)
def test_what_is_so_at_a_sample_needs_enough_to_spare(
    text: str, wanted: str, tmp_path: Path
) -> None:
    rows = ["0,5,5,3,1", "1,3.5,4.2,3,1", "2,1.6,3.3,3,1"]
    if text.startswith("y"):
        rows = ["0,5,4.3,3,1", "1,5,3.4,3,1", "2,5,2.5,3,1"]
    assert "".join(verdicts(text, rows, tmp_path)) == wanted


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(-6, 6), min_size=2, max_size=6),
    st.sampled_from(
        ["x >= 0 m", "x < 1 m", "not (x >= 1 m)", "x == 0 m", "x != 0 m", "x >= -1 m and x <= 1 m", "x * 2 > 1 m",
         "1 m - x >= 0 m", "x < 0 m implies x < -1 m"]
    ),
    st.data(),
)  # fmt: skip
def test_what_holds_at_samples_holds_at_every_instant_between(
    steps: list[int], text: str, data: st.DataObject
) -> None:
    """Any way that keeps the rate, looked at ten times as often."""
    spec = read(f"{HEAD}requirement R: {text}\n")
    (one,) = spec.requirements
    assert not isinstance(one.formula, NotRead)
    values = [Fraction(0)]
    for step in steps:  # tenths of a second: at most 0.2 m each
        values.append(values[-1] + Fraction(max(-2, min(2, step)), 10) * 10)
    fine: list[Fraction] = []
    for before, after in itertools.pairwise(values):
        middle = data.draw(st.integers(-10, 10))
        # up to half way anywhere that can be reached from both ends
        turn = (before + after) / 2 + Fraction(middle, 10) * (1 - abs(after - before) / 2)
        fine += [before + (turn - before) * k / 5 for k in range(5)]
        fine += [turn + (after - turn) * k / 5 for k in range(5)]
    fine.append(values[-1])

    def seen(formula, points):  # type: ignore[no-untyped-def]
        calculated = Calculated(set(signals(formula)), spec.signals)
        evaluation = Evaluation(formula)
        found = [
            evaluation.sample(k, calculated.row({"x": float(x), "y": 0.0, "z": 0.0, "b": 0.0}))
            for k, x in enumerate(points)
        ]
        return [verdict for got in found for _, verdict in got]

    judged, exact = seen(one.judged, values), seen(one.formula, fine)
    at_samples = seen(one.formula, values)
    for k, verdict in enumerate(judged):
        if verdict == 2:
            around = exact[max(0, 10 * k - 5) : 10 * k + 6]
            assert set(around) == {2}, (text, k)
        if verdict == 0:
            assert at_samples[k] == 0
        if at_samples[k] == 0:
            assert verdict == 0, "what is violated at a sample is violated"


STEP = 10**8
OFTEN = "trace every 100 ms gap 400 ms\nsignal x: m rate 10 m/s\nsignal y: m rate 10 m/s\nsignal b: bool\n"


def _way(rng: random.Random, count: int) -> list[int]:
    """Of a signal that keeps the rate: a metre in a step at most."""
    found = [rng.randint(-5, 5)]
    often = rng.random()
    while len(found) < count:
        step = rng.choice((-1, 0, 1)) if rng.random() < often else found[-1] - (found + found)[-2]
        found.append(max(-7, min(7, found[-1] + max(-1, min(1, step)))))
    return found


def _verdicts(spec, formula, rows):  # type: ignore[no-untyped-def]
    calculated, evaluation = Calculated(set(signals(formula)), spec.signals), Evaluation(formula)
    return {
        time: verdict
        for now, row in rows
        for time, verdict in evaluation.sample(now, calculated.row(row))
    }


@pytest.mark.parametrize(
    "text",
    [
        "always within 300 ms x >= 0 m",
        "not (eventually within 200 ms x > 2 m)",
        "eventually within 500 ms x >= 0 m",
        "always from 300 ms to 600 ms x < y",
        "historically within 300 ms x >= 0 m",
        "historically from 300 ms to 500 ms x >= y",
        "(y >= 1 m) implies (always within 300 ms x >= 0 m)",
        "(x >= 0 m) until within 600 ms (y >= 0 m)",
        "(x >= 0 m) until from 300 ms to 900 ms (y >= 0 m)",
        "(x >= 0 m) since from 200 ms to 700 ms (y < 1 m)",
        "not ((x >= 0 m) since from 200 ms to 700 ms (y >= 0 m))",
        "not ((x >= 0 m) until from 300 ms to 300 ms (y >= 0 m))",
        "always within 200 ms (eventually within 300 ms x >= y)",
    ],
)
def test_bounds_of_time_are_those_of_every_instant_between(text: str) -> None:
    """Any way that keeps the rate, of which a few samples are seen, at any distances up to the gap."""
    (one,) = (spec := read(f"{OFTEN}requirement R: {text}\n")).requirements
    rng, so = random.Random(text), 0
    for _ in range(120):
        x, y = _way(rng, 70), _way(rng, 70)
        fine = [
            (k * STEP, {"x": float(a), "y": float(b)})
            for k, (a, b) in enumerate(zip(x, y, strict=True))
        ]
        seen = [0]
        while seen[-1] < 69:
            seen.append(min(69, seen[-1] + rng.choice((1, 2, 3, 4, 4, 4))))
        at = [fine[k] for k in seen]
        exact = _verdicts(spec, one.formula, fine)
        judged, sampled = _verdicts(spec, one.judged, at), _verdicts(spec, one.formula, at)
        for before, here, after in zip(seen, seen[1:], seen[2:], strict=False):
            if sampled.get(here * STEP) == 0:
                assert judged.get(here * STEP, 0) == 0
            if judged.get(here * STEP) == 0:
                assert sampled.get(here * STEP) == 0, "violated, though it is not at any sample"
            # before the trace nothing was: what looks back from its first instants is not compared
            if judged.get(here * STEP) == 2 and here > 15:
                near = range((before + here + 1) // 2, (here + after) // 2 + 1)
                assert {exact.get(k * STEP, 2) for k in near} == {2}, (text, here, seen, x, y)
                so += 1
    assert so > 20, "enough holds to say something"


def test_a_bound_that_ends_between_samples_is_looked_at_beyond_it(tmp_path: Path) -> None:
    """At 1 s x is 5 m and at 2 s 3.4 m: at 1.9 s, nearer to the second, it may have been below 3 m."""
    rows = ["0,9,0,0,0", "1,5,0,0,1", "2,3.4,0,0,0", "3,3.4,0,0,0", "4,9,0,0,0"]
    found = verdicts("b implies (always within 0.9 s x >= 3 m)", rows, tmp_path)
    assert found[1] == "?"


def test_a_rate_is_kept_over_samples_without_a_value(tmp_path: Path) -> None:
    trace = tmp_path / "t.csv"
    trace.write_text("time_s,x,y,z,b\n0,5,0,1,1\n1,,0,1,0\n2,9.1,0,1,1\n")
    found = watch(read(f"{HEAD}requirement R: b implies x >= 0 m\n"), trace)
    assert [one.verdict for one in found.outcomes] == ["unknown"]
    assert ("faster", "x") in [(one.kind, one.signal) for one in found.findings]


def test_a_signal_that_changes_faster_than_its_rate_lets_nothing_hold(tmp_path: Path) -> None:
    trace = tmp_path / "t.csv"
    spec = read(f"{HEAD}requirement R: x >= 0 m\nrequirement Z: z >= 0 m and x >= 0 m\n")
    trace.write_text("time_s,x,y,z,b\n0,5,0,1,1\n1,7,0,1,1\n2,9.1,0,1,1\n")
    found = watch(spec, trace)
    assert [one.verdict for one in found.outcomes] == ["unknown", "unknown"]
    assert [(one.kind, one.signal, one.first_ns) for one in found.findings] == [
        ("faster", "x", 2 * 10**9)
    ]
    trace.write_text("time_s,x,y,z,b\n0,5,0,1,1\n1,7,0,1,1\n2,9,0,1,1\n")
    assert {one.verdict for one in watch(spec, trace).outcomes} == {"holds"}


def test_a_value_that_is_held_may_have_changed_meanwhile(tmp_path: Path) -> None:
    head = HEAD.replace("x: m rate", "x: m hold 2 s rate")
    # 2 s and half a second at 2 m/s are 5 m
    assert verdicts("x >= 3 m", ["0,8,0,0,1", "1,7.9,0,0,1"], tmp_path, head) == ["T", "?"]


@pytest.mark.parametrize(
    ("head", "text", "says"),
    [
        (HEAD, "x * x >= 1 m^2", r"nothing says how fast \(x \* x\) changes"),
        (HEAD, "sqrt(x * 1 m) >= 1 m", "nothing says how fast"),
        (HEAD.replace(" gap 1 s", ""), "x >= 1 m", "nothing says how far samples are apart"),
        (
            HEAD.replace("rate 2 m/s", "rate 2 m"),
            "x >= 1 m",
            "this is no rate of the signal; expected m/s, above 0",
        ),
        (HEAD.replace("rate 2 m/s", "rate 0 m/s"), "x >= 1 m", "this is no rate of the signal"),
        (HEAD.replace("b: bool", "b: bool rate 1 m/s"), "x >= 1 m", "no rate of a truth value"),
    ],
)
def test_rates_that_say_nothing_are_refused(head: str, text: str, says: str) -> None:
    with pytest.raises(NotRead, match=says):
        read(f"{head}requirement R: {text}\n")


def test_without_a_rate_nothing_is_other_than_before() -> None:
    (one,) = read(
        "trace every 1 s gap 1 s\nsignal x: m\nrequirement R: x >= 1 m and x <= 2 m\n"
    ).requirements
    assert one.between is None
    assert one.judged is one.formula
