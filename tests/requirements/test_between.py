"""Between samples: with a greatest rate a comparison holds only with enough to spare, and what a signal does in between
is never called held."""

from __future__ import annotations

import itertools
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
