"""The parser of the process algebra: what it accepts, and how it refuses the rest."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.spec.algebra import (
    MAX_DEPTH,
    MAX_TASK_ID,
    MAX_TIME_MS,
    AlgebraError,
    Atom,
    Op,
    Suffix,
    format_term,
    parallel_of,
    parse,
)
from cratous.spec.algebra.meaning import next_actions, runs, satisfied
from cratous.spec.errors import BadInput

VECTORS = Path(__file__).resolve().parents[3] / "shared" / "vectors" / "openuxas" / "algebra"
KNOWN = frozenset(range(1, 6))

ACCEPTED = {
    ".(p1 p2 p3)": ".(p1 p2 p3)",
    "+(p1 p2 p3)": "+(p1 p2 p3)",
    "|(p1 p2)": "|(p1 p2)",
    "p1": "p1",
    "p1 ": "p1",
    "|(p1 p2 p3)": "|(p1 p2 p3)",
    ".(p1 +(p2 p3) |(p4 p5))": ".(p1 +(p2 p3) |(p4 p5))",
    "|(p1.(p2 p3))": "|(p1 .(p2 p3))",
    "|(p1 p2 )": "|(p1 p2)",
    "|(p1  p2)": "|(p1 p2)",
    " |(p1 p2)": "|(p1 p2)",
    "| (p1 p2)": "|(p1 p2)",
    "| (p1 p2 p3)": "|(p1 p2 p3)",
    "|(p1 . (p2 p3))": "|(p1 .(p2 p3))",
    "|(p1\tp2\n)": "|(p1 p2)",
    "|(p1p2p3)": "|(p1 p2 p3)",
    "+(p1 p1)": "+(p1 p1)",
    "+(.(p1 p2) .(p1 p3))": "+(.(p1 p2) .(p1 p3))",
    "|(p01 p2)": "|(p1 p2)",
    ".(+(|(p1)))": ".(+(|(p1)))",
    "+(.(p1 p2) p3)": "+(.(p1 p2) p3)",
    "|(+(p1 p2) p3)": "|(+(p1 p2) p3)",
    ".(" * 200 + "p1" + ")" * 200: ".(" * 200 + "p1" + ")" * 200,
    "~(p1 p2)": "~(p1 p2)",
    "p1_[0-5]": "p1_[0-5]",
    "p1 _ [ 0 - 5 ]": "p1_[0-5]",
    "p1\n-\n[ 5-5]": "p1-[5-5]",
    "|(p1-[1-2]p2_[03-4])-[5-6]": "|(p1-[1-2] p2_[3-4])-[5-6]",
    "|(p1 |(p2 p3)_[1000-1500])_[100-3000]": "|(p1 |(p2 p3)_[1000-1500])_[100-3000]",
    "+(p1 |(p1 p2))": "+(p1 |(p1 p2))",
    f"p1_[0-{MAX_TIME_MS}]": f"p1_[0-{MAX_TIME_MS}]",
}

NO_PAREN = "has no operands in parentheses"
EMPTY = "has no operands; expected at least one operand"
NOT_CLOSED = "is never closed"
TOO_MANY = "closing parenthesis too many"
GOES_ON = "goes on after its end"
NO_NUMBER = "needs its number directly after the p"
NO_P = "written with a p before its number"
NOT_TERM = "neither an operator nor a task"
TIMING = "this is not a timing"
RANGE = "out of range"
TWICE = "stands twice in one branch"

REFUSED = [  # text, offset of the mistake, what the message says
    ("1", 0, NO_P),
    ("abc|(p1 p2)", 0, NOT_TERM),
    ("hello", 0, NOT_TERM),
    ("prep me", 0, NOT_TERM),
    ("|(p1 p2)xyz", 8, GOES_ON),
    ("|(p1,p2,p3)", 4, "not by commas"),
    ("|(p1 p2", 7, "the parenthesis at character 2 is never closed"),
    ("|(p1 .(p2 p3)", 13, "the parenthesis at character 2 is never closed"),
    ("|(p1 .(p2 p3", 12, "the parenthesis at character 7 is never closed"),
    ("|(p1 p2))", 8, TOO_MANY),
    ("|(p1 .(p2 p3)))", 14, TOO_MANY),
    ("p1)", 2, TOO_MANY),
    ("|p1 p2)", 1, "the operator | " + NO_PAREN),
    ("|p1 p2", 1, "the operator | " + NO_PAREN),
    ("|", 1, "the operator | " + NO_PAREN),
    ("||(p1 p2)", 1, "the operator | " + NO_PAREN),
    ("|(p1.5 p2)", 5, "the operator . " + NO_PAREN),
    ("", 0, "the text is empty"),
    (" ", 0, "the text is empty"),
    ("|()", 2, "the operator | " + EMPTY),
    ("~ ( )", 4, "the operator ~ " + EMPTY),
    ("|(p1 .())", 7, "the operator . " + EMPTY),
    (".(|() p1)", 4, "the operator | " + EMPTY),
    ("+(|() p1)", 4, "the operator | " + EMPTY),
    ("p9", 0, "unknown task p9; expected one of p1 p2 p3 p4 p5; got p9"),
    ("|(p1 p9)", 5, "unknown task p9"),
    ("|(p1 p7)", 5, "unknown task p7"),
    ("|(p p1)", 2, NO_NUMBER),
    ("|(p-1 p2)", 2, NO_NUMBER),
    ("|(p-1 p1)", 2, NO_NUMBER),
    ("|(p+1 p2)", 2, NO_NUMBER),
    ("|(p 1 p2)", 2, NO_NUMBER),
    ("|(pabc p1)", 2, NOT_TERM),
    ("|(prep p1)", 2, NOT_TERM),
    ("|(p1 p\u00e9 p2)", 5, NOT_TERM),
    ("|(p1 p\u00b2)", 5, NOT_TERM),
    ("|(P1 p2)", 2, "with a small p"),
    ("|(1 2)", 2, NO_P),
    ("|(p1 2 p3)", 5, NO_P),
    ("|(p1 p1)", 5, "task p1 " + TWICE),
    ("|(p1 p1 p2 p3)", 5, "task p1 " + TWICE),
    (".(p1 p1 p2)", 5, "task p1 " + TWICE),
    (".(+(p1 p2) +(p3 p1))", 16, "task p1 " + TWICE),
    ("+(p1 |(p2 p2))", 10, "task p2 " + TWICE),
    ("p1 . p2", 3, GOES_ON),
    ("p1.p2 ", 2, GOES_ON),
    ("p1 p2", 3, GOES_ON),
    ("p1 |", 3, GOES_ON),
    ("(p1 . p2)", 0, "an operator must stand before"),
    ("(p1 p2)", 0, "an operator must stand before"),
    ("|(p1 p2) .(p3 p4)", 9, GOES_ON),
    ("|(p1 p2) .(p3)", 9, GOES_ON),
    ("*(p1 p2)", 0, "* is not an operator"),
    ("|(p1 *(p2 p3))", 5, "* is not an operator"),
    ("|(p1 [5](p2))", 5, "[ is not an operator"),
    ("|(p99999999999999999999 p1)", 2, "task id " + RANGE),
    (f"p{MAX_TASK_ID + 1}", 0, "task id " + RANGE),
    ("p" + "9" * 5000, 0, "task id " + RANGE),
    ("p0", 0, "task id " + RANGE),
    (f"p1_[0-{MAX_TIME_MS + 1}]", 6, "time " + RANGE),
    (f"p1_[{2**63}-{2**63}]", 4, "time " + RANGE),
    ("p1_[5-3]", 4, "the timing window ends before it begins; expected [t1-t2] with t1 <= t2; got [5-3]"),
    (".(p1 p2)-[5-3]", 10, "the timing window ends before it begins"),
    ("p1_[-5-3]", 4, TIMING),
    ("p1_[5]", 5, TIMING),
    ("p1_[1 2]", 6, TIMING),
    ("p1_[1.5-2]", 5, TIMING),
    ("p1-(1-2)", 3, TIMING),
    ("p1_", 3, TIMING),
    ("p1_[1-2", 7, TIMING),
    ("p1_[1-2)", 7, TIMING),
    ("|(p1_ p2)", 6, TIMING),
    ("p1_[1-2]-[1-2]", 8, "takes only one timing"),
    ("|(p1 p2)_[1-2]_[1-2]", 14, "takes only one timing"),
    ("|(p1_[1-2]_[1-2] p2)", 10, "takes only one timing"),
    ("_[1-2]p1", 0, "a timing stands behind its term"),
    ("|(_[1-2] p1)", 2, "a timing stands behind its term"),
    (".(" * 201 + "p1" + ")" * 201, 401, "nested too deep; expected at most 200 levels; got level 201"),
    (".(" * 100_000 + "p1" + ")" * 100_000, 401, "nested too deep"),
]  # fmt: skip


@pytest.mark.parametrize("text", ACCEPTED, ids=lambda text: text[:40])
def test_accepted_with_the_obvious_meaning(text):
    assert format_term(parse(text, KNOWN)) == ACCEPTED[text]


@pytest.mark.parametrize(("text", "offset", "message"), REFUSED, ids=lambda value: repr(value)[:40])
def test_refused_by_name_and_place(text, offset, message):
    with pytest.raises(AlgebraError) as caught:
        parse(text, KNOWN)
    error = caught.value
    assert message in str(error)
    assert error.offset == offset
    assert error.expected
    assert error.got
    assert "\n" not in str(error)
    line, mark = error.caret().split("\n")
    assert mark.strip() == "^"
    if text[offset:]:
        assert line[mark.index("^")] == text[offset]


def test_line_and_column_count_from_one():
    with pytest.raises(AlgebraError) as caught:
        parse("|(p1\n  ,p2)", where="mission.yaml")
    error = caught.value
    assert (error.line, error.column) == (2, 3)
    assert str(error).startswith("mission.yaml, line 2, column 3: ")
    assert error.caret() == "  ,p2)\n  ^"
    assert error.data()["caret"] == error.caret()


def test_caret_of_a_long_line_is_a_window():
    text = "|(" + " ".join(f"p{n}" for n in range(1, 300)) + " P300 " + "p301 " * 50 + ")"
    with pytest.raises(AlgebraError) as caught:
        parse(text)
    line, mark = caught.value.caret().split("\n")
    assert len(line) < 100
    assert line[mark.index("^") :].startswith("P300")


def test_terms_carry_their_place():
    text = " .(p1 |(p2 p3)_[1-2] ) -[3-4] "
    term = parse(text)
    assert text[slice(*term.span)] == ".(p1 |(p2 p3)_[1-2] ) -[3-4]"
    assert text[slice(*term.operands[0].span)] == "p1"
    assert text[slice(*term.operands[1].span)] == "|(p2 p3)_[1-2]"
    assert text[slice(*term.operands[1].suffix.span)] == "_[1-2]"
    assert term == Op(
        ".",
        (Atom(1), Op("|", (Atom(2), Atom(3)), Suffix("absolute", 1, 2))),
        Suffix("relative", 3, 4),
    )


def test_task_ids_up_to_63_bits():
    assert parse(f"p{MAX_TASK_ID}") == Atom(MAX_TASK_ID)


def test_no_known_task_at_all():
    with pytest.raises(AlgebraError, match="unknown task p1; expected no task"):
        parse("p1", frozenset())


def test_deepest_term_can_be_used():
    text = "".join(f"~(p{n} " for n in range(1, MAX_DEPTH + 1)) + "p999" + ")" * MAX_DEPTH
    term = parse(text)
    assert parse(format_term(term)) == term
    assert next_actions(term, (1, 2)) == frozenset({3})
    order = (*range(1, MAX_DEPTH + 1), 999)
    assert next(runs(term, 1)) == order
    assert satisfied(term, {task: (place, place) for place, task in enumerate(order)})


def test_parallel_of():
    assert format_term(parallel_of([3, 1, 2])) == "|(p3 p1 p2)"
    assert format_term(parallel_of(n for n in range(1, 3000))).endswith("p2999)")
    with pytest.raises(BadInput, match="no task"):
        parallel_of([])
    with pytest.raises(BadInput, match="twice"):
        parallel_of([1, 1])


def refusal(text: str) -> AlgebraError | None:
    """How the text is refused; None if it is a term. Any other error is a failure."""
    try:
        parse(text)
    except AlgebraError as error:
        return error
    return None


@given(st.text(alphabet=".~|+()p123 _-[],P\nx\u00e9", max_size=25) | st.text(max_size=12))
def test_any_text_is_a_term_or_refused_with_a_place(text):
    error = refusal(text)
    if error is None:
        term = parse(text)
        assert parse(format_term(term)) == term
    else:
        assert 0 <= error.offset <= len(text)
        assert error.what
        assert error.expected
        assert error.caret().count("\n") == 1


# ---- recorded cases of OpenUxAS's own parser ------------------------------------------------

LATER_CHOICE = {  # two operands of + share a task: the choice is not made before they differ
    "+(.(p1 p2) .(p1 p3))": ["1 2", "1 3"],
}


def _recorded(name: str) -> list[dict]:
    if not VECTORS.is_dir():
        pytest.skip("the recorded OpenUxAS cases (shared/vectors) are not here")
    data = json.loads((VECTORS / name).read_text(encoding="utf-8"))
    return data["cases"] if isinstance(data, dict) else data


def _text(case: dict) -> str:
    if case["label"].startswith("deep nesting"):
        depth = int(case["label"].split()[-1])
        return ".(" * depth + "p1" + ")" * depth
    return case["string"]


def test_every_recorded_parser_case_is_judged_here():
    judged = set(ACCEPTED) | {text for text, _, _ in REFUSED}
    assert [c["label"] for c in _recorded("parser_cases.json") if _text(c) not in judged] == []


def test_every_recorded_service_case_is_judged_here():
    judged = set(ACCEPTED) | {text for text, _, _ in REFUSED}
    texts = [c["TaskRelationships"] for c in _recorded("service_cases.json")]
    assert [text for text in texts if text not in judged] == []


def test_same_orders_as_recorded_for_what_both_accept():
    compared = 0
    for case in _recorded("parser_cases.json"):
        text = _text(case)
        if text not in ACCEPTED or not case["accepted"] or "tree" not in case:
            continue
        term = parse(text)
        if case["tree"].endswith("..."):
            assert format_term(term).replace("p", "").startswith(case["tree"][:-4])
        elif case["tree"] != format_term(term).replace("p", ""):
            # The original drops the operands behind "operator, blank, parenthesis".
            assert " (" in text
            continue
        traces = LATER_CHOICE.get(text, sorted(set(case["traces"])))
        assert [" ".join(map(str, run)) for run in runs(term)] == traces, text
        assert next_actions(term, ()) == frozenset(case["first"]), text
        compared += 1
    assert compared >= 15
