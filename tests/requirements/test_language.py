"""The product's language of requirements: units, times, samples that are missing, logs, and the lint."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.requirements.formula import Bounded, Reaches
from cratous.services.requirements.language import read
from cratous.services.requirements.sampling import Sampling
from cratous.services.requirements.specification import NotRead
from cratous.services.requirements.units import UNITS, dimension
from cratous.services.requirements.watch import watch
from cratous.spec.errors import BadInput

HEAD = "signal a, b, c: bool\nsignal x, y: m\nsignal v: kn\n"


def formula(text):
    (found,) = read(f"{HEAD}requirement R: {text}").requirements
    return found.formula


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("a or b and c", "a or (b and c)"),
        ("a implies b or c", "a implies (b or c)"),
        ("not a and b", "(not a) and b"),
        ("a iff b implies c", "a iff (b implies c)"),
        ("a and always within 1 s b", "a and (always from 0 ms to 1000 ms b)"),
        ("eventually within 1 min a", "true until within 60 s a"),
        ("x >= 1 km", "x >= 1000 m"),
        ("x < 10 ft", "not (x >= 3.048 m)"),
        ("1 nmi <= x", "x >= 1852 m"),
        ("x != y", "not (x == y)"),
        ("a # says nothing\n or b", "a or b"),
    ],
)
def test_what_is_written_two_ways_means_one_thing(text, same):
    assert formula(text) == formula(same)


def test_a_number_is_taken_into_the_signals_unit():
    assert formula("v >= 18.52 km/h") == Reaches("v", 10.0)
    # 0.1 m is a tenth, not three doubles multiplied
    assert formula("x >= 100e-3 m") == Reaches("x", 0.1)


def test_bounds_are_nanoseconds_and_open_only_where_they_say_so():
    found = formula("a since from 2 ms to 3 ms b")
    assert found == Bounded(Reaches("a", 1.0), Reaches("b", 1.0), 2_000_000, 3_000_000, True)


@pytest.mark.parametrize(
    ("text", "what", "column"),
    [
        ("x >= 3 s", "units that do not fit", 18),
        ("x >= v", "units that do not fit", 18),
        ("x >= 3", "units that do not fit", 18),
        ("x", "this is no such signal", 16),
        ("a >= 1 m", "this is no such signal", 16),
        ("z", "this is no such signal", 16),
        ("3 m >= 2 m", "no signal is compared", 20),
        ("always within 2 m a", "this is no time", 32),
        ("always within 0.5 ns a", "this time cannot be taken exactly", 30),
        ("always within -1 s a", "this time cannot be taken exactly", 30),
        ("a until from 3 s to 1 s b", "these bounds are empty", 24),
        ("a implies b implies c", "this cannot stand here", 28),
        ("a always b", "this cannot stand here", 18),
        ("x >= 1" + "0" * 400 + " m", "the number is too long", 21),
        ("x >= 1e999 m", "the number is too long", 21),
        ("x >= " + "9" * 300 + "e9 m", "the number is too large", 18),
        ("(" * 300 + "a" + ")" * 300, "the formula is nested too deeply", 216),
        ("a &", "this cannot stand here", 18),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(text, what, column):
    with pytest.raises(NotRead) as told:
        formula(text)
    assert told.value.what == what
    assert told.value.where == f"requirements, line 4, column {column}"
    line, caret = told.value.caret().split("\n")
    assert caret.strip() == "^"
    assert line[:10].strip() or column > 60


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("signal a: bool", "there is no requirement"),
        ("signal a: bool signal a: m requirement R: a", "a signal is declared twice"),
        ("signal a: bool requirement R: a requirement R: a", "a requirement's id is given twice"),
        ("signal a: furlong requirement R: a", "this cannot stand here"),
        ("trace every 0 s signal a: bool requirement R: a", "these are no times between samples"),
        ("trace every 2 s gap 1 s signal a: bool requirement R: a", "these are no times between samples"),
        ("trace every 1 s trace every 1 s signal a: bool requirement R: a", "the trace is described twice"),
        ("signal a: m from T[ID].x requirement R: a >= 1 m", "this chooses no message"),
        ("signal a: m from T[].x is up requirement R: a >= 1 m", "that a field is a word is true or false"),
        ("", "this cannot stand here"),
    ],
)  # fmt: skip
def test_files_that_mean_nothing(text, what):
    with pytest.raises(NotRead) as told:
        read(text)
    assert told.value.what == what


def test_a_file_beyond_its_bound():
    with pytest.raises(BadInput, match="too long"):
        read("#" * 1_000_001)


def test_every_unit_can_be_written():
    for unit in UNITS:
        if unit != "1":
            found = read(f"signal q: {unit} requirement R: q >= 2 {unit}").requirements[0].formula
            assert found == Reaches("q", 2.0)
            assert dimension(unit)


# -- samples ---------------------------------------------------------------------------------
CSV = """time_s,request,margin
0,0,12
0.5,1,8
1.0,0,-2
"""


def _watched(tmp_path: Path, text: str, csv: str):
    trace = tmp_path / "t.csv"
    trace.write_text(csv)
    return watch(read(text), trace)


def test_a_trace_with_times(tmp_path: Path) -> None:
    text = "signal request: bool\nsignal margin: m\n"
    text += "requirement A: request implies eventually within 1 s margin < 0 m\n"
    text += "requirement B severity hazardous: margin >= 0 m"
    one, other = _watched(tmp_path, text, CSV).outcomes
    assert (one.verdict, one.holds, one.undecided) == ("holds", 3, 0)
    assert (other.verdict, other.first_violated, other.decided_at) == ("violated", 10**9, 10**9)
    (margin,) = other.margins
    assert (margin.least, margin.at, margin.greatest, margin.greatest_at) == (-2, 10**9, 12, 0)
    assert other.requirement.severity == "hazardous"


def test_a_gap_leaves_unknown_what_lies_in_it(tmp_path: Path) -> None:
    text = "trace every 500 ms gap 600 ms\nsignal margin: m\nrequirement B: margin >= 0 m"
    found = _watched(tmp_path, text, "time_s,margin\n0,1\n0.5,1\n2,1\n")
    (one,) = found.outcomes
    assert (one.verdict, one.unknown, one.first_unknown) == ("unknown", 1, 1_100_000_000)
    (finding,) = found.findings
    assert (finding.kind, finding.first_ns) == ("gap", 500_000_000)
    assert "further apart" in finding.text


def test_after_a_gap_nothing_holds_also_what_looks_past_its_edges(tmp_path: Path) -> None:
    """28 s are unseen; what was just before and just after them says nothing of the middle."""
    text = """trace every 500 ms gap 600 ms
signal x: m
requirement P: once within 1 s x >= 3 m
requirement F: (once within 1 s x >= 3 m) or (eventually within 1 s x >= 3 m)"""
    rows = "".join(f"{t},5\n" for t in (0, 0.5, 29, 29.5, 30, 30.5))
    found = _watched(tmp_path, text, f"time_s,x\n{rows}")
    assert [one.verdict for one in found.outcomes] == ["unknown", "unknown"]
    assert all(one.violated == 0 for one in found.outcomes)


def test_a_sample_out_of_order_never_lets_it_hold(tmp_path: Path) -> None:
    text = "signal margin: m\nrequirement B: margin >= 0 m"
    found = _watched(tmp_path, text, "time_s,margin\n0,1\n1,1\n1,-5\n0.5,1\n2,1\n")
    (one,) = found.outcomes
    assert (one.verdict, one.unknown, one.violated) == ("unknown", 0, 0)
    assert [(f.kind, f.count) for f in found.findings] == [("order", 2)]


def test_values_are_held_as_long_as_they_say(tmp_path: Path) -> None:
    text = "signal held: m hold 1 s\nsignal bare: m\nrequirement R: held >= 0 m and bare >= 0 m"
    csv = "time_s,held,bare\n0,1,1\n1,,1\n1.5,,1\n2,nan,1\n2.5,,1\n3,1,\n4,1,1\n"
    found = _watched(tmp_path, text, csv)
    (one,) = found.outcomes
    assert (one.holds, one.unknown, one.first_unknown) == (3, 4, 1_500_000_000)
    told = {(f.kind, f.signal): (f.first_ns / 1e9, f.count) for f in found.findings}
    # a value that is no number takes the place of the one before
    assert told == {
        ("stale", "held"): (1.5, 1), ("missing", "held"): (2.0, 2), ("missing", "bare"): (3.0, 1),
    }  # fmt: skip


def test_a_number_that_is_none_ends_what_is_held(tmp_path: Path) -> None:
    text = "signal held: m hold 9 s\nsignal t: m\nrequirement R: held >= 0 m and t >= 0 m"
    found = _watched(tmp_path, text, "time_s,held,t\n0,1,1\n1,nan,1\n2,,1\n3,1,1\n4,,1\n")
    (one,) = found.outcomes
    assert (one.holds, one.unknown, one.first_unknown) == (3, 2, 10**9)
    assert [(f.kind, f.count) for f in found.findings] == [("missing", 2)]


def test_a_signal_that_never_comes_is_unknown_and_told(tmp_path: Path) -> None:
    text = "signal m: m\nrequirement R: m >= 0 m"
    found = _watched(tmp_path, text, "time_s,m\n0,\n1,\n")
    assert found.outcomes[0].verdict == "unknown"
    assert [f.text for f in found.findings] == ["m: no value ever came"]


@pytest.mark.parametrize(
    ("csv", "what"),
    [
        ("time_s,other\n0,1\n", "a signal has no column"),
        ("m\n1\n", "a signal has no column"),
        ("time_s,m\n0,one\n", "this is no number"),
        ("time_s,m\n-1,1\n", "this is no time"),
        ("time_s,m\n0.0000000001,1\n", "this is no time"),
        ("time_s,m\nnan,1\n", "this is no time"),
        ("time_s,m\n1/2,1\n", "this is no time"),
        ("time_s,m\n1e99,1\n", "this is no time"),
        ("time_s,m\n0\n", "a row is incomplete"),
        ("", "the file is empty"),
    ],
)
def test_traces_that_are_none(tmp_path: Path, csv: str, what: str) -> None:
    with pytest.raises(BadInput) as told:
        _watched(tmp_path, "signal m: m\nrequirement R: m >= 0 m", csv)
    assert told.value.what == what


def test_a_bool_is_zero_or_one(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no truth value"):
        _watched(tmp_path, "signal a: bool\nrequirement R: a", "time_s,a\n0,2\n")


times = st.lists(st.integers(0, 40), min_size=1, max_size=12)


@given(times, st.integers(1, 5), st.data())
def test_samples_rise_and_every_gap_has_an_unknown_one(rows, gap, data):
    spec = read("trace every 1 ns gap 1 ns signal x: m hold 3 ns requirement R: x >= 0 m")
    sampling = Sampling(spec, ["x"])
    sampling.gap_ns = gap
    values = [data.draw(st.sampled_from([None, 1.0, float("nan")])) for _ in rows]
    given_rows = [(t, {} if v is None else {"x": v}) for t, v in zip(rows, values, strict=True)]
    found = list(sampling.samples(given_rows))
    got = [time for time, _ in found]
    assert got == sorted(set(got))
    kept = [t for n, t in enumerate(rows) if all(t > other for other in rows[:n])]
    assert set(kept) <= set(got)
    near = all(after - before <= gap for before, after in itertools.pairwise(kept))
    assert sampling.is_whole == (len(kept) == len(rows) and near)
    for before, after in itertools.pairwise(kept):
        if after - before > gap:
            assert found[got.index(before) + 1] == (before + gap, {"x": None})
    # known where the newest that came is a number of at most three nanoseconds ago
    came = dict(zip(rows[::-1], values[::-1], strict=True))
    for time, row in found:
        if time in kept:
            news = [(t, came[t]) for t in kept if t <= time and came[t] is not None]
            newest, value = max(news, default=(time, None), key=lambda one: one[0])
            known = value == 1.0 and time - newest <= 3
            assert row["x"] == (1.0 if known else None)


def test_a_trace_may_begin_with_all_its_signals(tmp_path: Path) -> None:
    text = "trace every 1 s gap 9 s begins with all\nsignal x, y: m hold 9 s\n"
    rows = "time_s,x,y\n1,5,\n0,6,\n2,,1\n3,,\n"
    found = _watched(tmp_path, text + "requirement R: x >= 5 m and y <= 1 m", rows)
    (one,) = found.outcomes
    # the row that came out of order is none, so nothing holds; x is that of 1 s
    assert (one.holds, one.violated, one.unknown, one.verdict) == (2, 0, 0, "unknown")
    assert [(f.kind, f.count, f.first_ns) for f in found.findings] == [
        ("before", 1, 10**9), ("order", 1, 0),
    ]  # fmt: skip
    whole = rows.replace("0,6,\n", "")
    found = _watched(tmp_path, text + "requirement R: x >= 5 m and y <= 1 m", whole)
    assert found.outcomes[0].verdict == "holds"
    never = _watched(tmp_path, text + "requirement R: x >= 5 m and y <= 1 m", "time_s,x,y\n1,5,\n")
    assert never.outcomes[0].verdict == "unknown"
    assert {f.kind for f in never.findings} == {"before", "never"}
