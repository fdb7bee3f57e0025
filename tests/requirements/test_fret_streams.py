"""Definitions of FRET's variables in Lustre, `->`, `pre`, `if`: what they are at each sample, against their meaning."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from requirement_tools import alike_at_once

from cratous.services.requirements import fret, language
from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.fretish import NoForm, sentence
from cratous.services.requirements.specification import NotRead, Specification
from cratous.services.requirements.watch import Watch

INPUTS = [
    *({"variable_name": n, "idType": "Input", "dataType": "double"} for n in "xy"),
    {"variable_name": "b", "idType": "Input", "dataType": "boolean"},
]
Rows = list[dict[str, float | None]]


class Stream(NamedTuple):
    """A text, its value at a sample of some rows (None: unknown), and whether it has one at the first sample."""

    text: str
    at: Callable[[Rows, int], Any]
    begun: bool


def over(formula: str, **defined: tuple[str, str]) -> Specification:
    more = [
        {"variable_name": name, "idType": "Internal", "dataType": kind, "assignment": text}
        for name, (kind, text) in defined.items()
    ]
    row = {"reqid": "A", "semantics": {"ftInfAUExpanded": formula}}
    return fret.read(json.dumps({"requirements": [row], "variables": [*INPUTS, *more]}), "e.json")


def said(spec: Specification, rows: Rows) -> str:
    """The verdict of each sample."""
    lines: list[str] = []
    watching = Watch(spec, lines)
    for n, row in enumerate(rows):
        watching.sample(n, row)
    found = dict(line.split(":")[1].split(",") for line in lines)
    return "".join(found[str(n)] for n in range(len(rows)))


def both(a: Any, b: Any, decides: bool) -> Any:
    if decides in (a, b):
        return decides
    return None if None in (a, b) else not decides


def known(f: Callable[..., Any], *values: Any) -> Any:
    return None if None in values else f(*values)


def numbers(depth: int) -> st.SearchStrategy[Stream]:
    plain = [
        st.sampled_from("xy").map(lambda n: Stream(n, lambda r, k: r[k][n], True)),
        st.sampled_from((-1.0, 0.5, 2.0)).map(
            lambda v: Stream(f"({v})" if v < 0 else str(v), lambda r, k: v, True)
        ),
    ]
    if not depth:
        return st.one_of(plain)
    inner = numbers(depth - 1)
    return st.one_of(
        *plain,
        st.builds(
            lambda a, b: Stream(
                f"({a.text} + {b.text})",
                lambda r, k: known(lambda p, q: p + q, a.at(r, k), b.at(r, k)),
                a.begun and b.begun,
            ),
            inner,
            inner,
        ),
        *streams(inner, truths(depth - 1)),
    )


def truths(depth: int) -> st.SearchStrategy[Stream]:
    plain = [
        st.just(Stream("b", lambda r, k: known(lambda v: v == 1, r[k]["b"]), True)),
        st.just(
            Stream("(x > y)", lambda r, k: known(lambda p, q: p > q, r[k]["x"], r[k]["y"]), True)
        ),
    ]
    if not depth:
        return st.one_of(plain)
    inner = truths(depth - 1)
    number = numbers(depth - 1)
    return st.one_of(
        *plain,
        st.builds(
            lambda a, b, word: Stream(
                f"({a.text} {word} {b.text})",
                lambda r, k: both(a.at(r, k), b.at(r, k), word == "or"),
                a.begun and b.begun,
            ),
            inner,
            inner,
            st.sampled_from(("and", "or")),
        ),
        inner.map(
            lambda a: Stream(
                f"(not {a.text})", lambda r, k: known(lambda v: not v, a.at(r, k)), a.begun
            )
        ),
        st.builds(
            lambda a, b: Stream(
                f"({a.text} >= {b.text})",
                lambda r, k: known(lambda p, q: p >= q, a.at(r, k), b.at(r, k)),
                a.begun and b.begun,
            ),
            number,
            number.filter(lambda one: set("xy") & set(one.text)),
        ),
        *streams(inner, inner),
    )


def streams(inner: Any, chosen: Any) -> list[st.SearchStrategy[Stream]]:
    begun = inner.filter(lambda one: one.begun)
    return [
        st.builds(
            lambda a, b: Stream(
                f"({a.text} -> {b.text})", lambda r, k: (b if k else a).at(r, k), True
            ),
            begun,
            st.one_of(
                begun.map(
                    lambda one: Stream(f"pre {one.text}", lambda r, k: one.at(r, k - 1), False)
                ),
                inner,
            ),
        ),
        st.builds(_choice, chosen, inner, inner),
    ]


def _choice(c: Stream, a: Stream, b: Stream) -> Stream:
    def at(r: Rows, k: int) -> Any:
        chosen = c.at(r, k)
        return None if chosen is None else (a if chosen else b).at(r, k)

    return Stream(f"(if {c.text} then {a.text} else {b.text})", at, c.begun and a.begun and b.begun)


CELL = st.sampled_from((-1.0, 0.0, 1.0, 2.0))
ROWS = st.lists(
    st.fixed_dictionaries({"x": CELL, "y": CELL, "b": st.sampled_from((0.0, 1.0))}),
    min_size=1,
    max_size=5,
)


@settings(max_examples=150, deadline=None)
@given(one=numbers(3).filter(lambda one: one.begun), rows=ROWS)
def test_a_number_is_what_its_definition_says_of_each_sample(one: Stream, rows: Rows) -> None:
    spec = over("(G (n > y))", n=("double", one.text))
    wanted = "".join("T" if one.at(rows, k) > row["y"] else "F" for k, row in enumerate(rows))
    assert said(spec, rows) == wanted, one.text


@settings(max_examples=150, deadline=None)
@given(one=truths(3).filter(lambda one: one.begun), rows=ROWS)
def test_a_truth_value_is_what_its_definition_says_of_each_sample(one: Stream, rows: Rows) -> None:
    spec = over("(G t)", t=("boolean", one.text))
    assert said(spec, rows) == "".join("FT"[bool(one.at(rows, k))] for k in range(len(rows)))


HELD = "x -> if (b and not pre b) then x else pre held"


@settings(max_examples=40, deadline=None)
@given(rows=ROWS)
def test_a_number_may_look_at_itself_at_the_sample_before(rows: Rows) -> None:
    spec = over("(G (y <= held))", held=("double", HELD))
    assert sources(spec.signals, spec.signals) == {"x", "y", "b"}
    held, wanted = rows[0]["x"], ""
    for k, row in enumerate(rows):
        if k and row["b"] == 1 and rows[k - 1]["b"] == 0:
            held = row["x"]
        wanted += "FT"[row["y"] <= held]  # type: ignore[operator]
    assert said(spec, rows) == wanted


def test_what_is_unknown_stays_so_as_long_as_it_is_looked_at() -> None:
    row = {"x": 1.0, "y": 0.0, "b": 0.0}
    spec = over("(G (last >= y))", last=("double", "0.0 -> pre x"))
    assert said(spec, [row, {**row, "x": None}, row, row]) == "TT?T"
    spec = over("(G (one >= y))", one=("double", "if b or x > 0.5 then 1.0 else -1.0"))
    assert said(spec, [{**row, "b": None}, {**row, "x": 0.0, "b": None}, row]) == "T?T"
    spec = over("(G (y <= held))", held=("double", HELD))
    rows = [row, {**row, "b": None}, row, {**row, "b": 1.0}, row]
    assert said(spec, rows) == "T??TT"


def test_at_once_is_as_one_by_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = over("(G (y <= held))", held=("double", HELD))
    rows = [f"{k % 7},{k % 4},{k % 3 // 2}" for k in range(60)]
    rows = ["x,y,b", *rows[:9], "1,,1", *rows[9:]]
    assert alike_at_once(spec, tmp_path / "t.csv", rows, monkeypatch).violated


def test_it_has_no_sentence_and_none_where_samples_have_times(tmp_path: Path) -> None:
    spec = over("(G (last >= y))", last=("double", "0.0 -> pre x"))
    with pytest.raises(NoForm, match="in Lustre"):
        sentence(spec.requirements[0].formula, spec)  # type: ignore[arg-type]
    row = {"reqid": "A", "fulltext": "the a shall always satisfy x <= last"}
    last = {"variable_name": "last", "idType": "Internal", "dataType": "double"}
    data = {"requirements": [row], "variables": [{**last, "assignment": "0.0 -> pre x"}]}
    (tmp_path / "e.json").write_text(json.dumps(data))
    text = 'trace every 1 s\nsignal x: m\nfret "e.json"'
    no = language.read(text, "own.req", tmp_path).requirements[0].formula
    assert isinstance(no, NotRead)
    assert "none is the one before" in str(no)


WHY = {
    "this function is not read; got det_3x3": 4,
    "FRET itself has not read this part": 6,
    "samples are counted, so a time has no meaning": 3,
    "nothing says which signal this variable is": 1,
    "what is asked of the sample before has another formula": 1,
}


def test_published_exports(shared: Path) -> None:
    """Those that come with FRET: what is read, and why what is not."""
    found: Counter[str] = Counter()
    for file in (shared / "vectors" / "monitor" / "fret").glob("*.json"):
        for one in fret.read(file.read_text(), file.name).requirements:
            no = isinstance(one.formula, NotRead)
            found[next(why for why in WHY if why in str(one.formula)) if no else "read"] += 1
    assert found == {"read": 183, **WHY}
