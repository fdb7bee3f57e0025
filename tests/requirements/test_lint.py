"""The lint of requirements: what z3 finds odd, held against traces; and the guide's example."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.cli import main
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.formula import Bounded, parts
from cratous.services.requirements.language import read
from cratous.services.requirements.lint import lint

HEAD = "signal a, b, c: bool\nsignal x, y: m\nsignal v: kn\n"


def formula(text):
    (found,) = read(f"{HEAD}requirement R: {text}").requirements
    return found.formula


def _remarks(*requirements: str, head: str = "trace every 1 s\n" + HEAD) -> dict[str, str]:
    text = "".join(f"requirement R{n}: {one}\n" for n, one in enumerate(requirements))
    return {r.name: r.kind for r in lint(read(head + text)) if r.kind != "unused"}


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("x > 3 m and x < 2 m", "unsatisfiable"),
        ("always within 2 s a and eventually from 1 s to 2 s not a", "unsatisfiable"),
        ("eventually from 1.2 s to 1.8 s a", "unsatisfiable"),  # there is no sample between
        ("historically within 3 s a and not a", "unsatisfiable"),
        ("a or not a", "valid"),
        ("always within 3 s a implies a", "valid"),
        ("(x > 3 m and x < 2 m) implies a", "valid"),
        ("always within 90000 s a", "unchecked"),
        ("a implies eventually within 3 s b", ""),
        ("a since within 2 s b", ""),
    ],
)
def test_what_is_odd(text, kind):
    assert _remarks(text) == ({"R0": kind} if kind else {})


def test_two_that_say_the_same_and_signals_that_nobody_uses():
    found = lint(read(HEAD + "requirement A: a\nrequirement B: not not a"))
    assert [(r.kind, r.name) for r in found] == [
        *(("unused", name) for name in ("b", "c", "x", "y", "v")), ("duplicate", "B"),
    ]  # fmt: skip
    assert _remarks("always within 2 s a", "not eventually within 2 s not a") == {"R1": "duplicate"}


def test_without_a_period_time_is_not_looked_into():
    assert _remarks("always within 2 s a", head=HEAD) == {"R0": "unchecked"}


formulas = st.recursive(
    st.sampled_from(["a", "b", "x >= 1 m", "x < 1 m"]),
    lambda inner: st.one_of(
        st.tuples(st.sampled_from(["and", "or"]), inner, inner).map(lambda t: f"({t[1]}) {t[0]} ({t[2]})"),
        inner.map(lambda one: f"not ({one})"),
        st.tuples(st.sampled_from(["always", "eventually", "historically", "once"]), inner).map(
            lambda t: f"{t[0]} within 1 s ({t[1]})"
        ),
        st.tuples(st.sampled_from(["until", "since"]), inner, inner).map(
            lambda t: f"({t[1]}) {t[0]} within 1 s ({t[2]})"
        ),
    ),
    max_leaves=4,
)  # fmt: skip


@given(formulas, st.lists(st.tuples(*[st.sampled_from([0.0, 1.0])] * 3), min_size=5, max_size=9))
def test_the_lint_says_of_no_formula_what_a_trace_refutes(text, rows):
    found = _remarks(text)
    evaluation = Evaluation(formula(text))
    depth = sum(isinstance(p, Bounded) for p in parts(formula(text)))
    verdicts = {}
    for n, (a, b, x) in enumerate(rows):
        verdicts.update(evaluation.sample(n * 10**9, {"a": a, "b": b, "x": x}))
    # in the middle of a trace: what reaches beyond its ends is no case of the lint
    middle = {
        v for t, v in verdicts.items() if depth * 10**9 <= t <= (len(rows) - 1 - depth) * 10**9
    }
    assert not (found.get("R0") == "unsatisfiable" and 2 in middle)
    assert not (found.get("R0") == "valid" and 0 in middle)


def test_the_guide_has_the_example_and_what_it_says_of_a_flight(
    root: Path, capsys, tmp_path
) -> None:
    example = root / "examples" / "crossing" / "requirements.req"
    blocks = (root / "docs" / "guides" / "requirements.md").read_text(encoding="utf-8").split("```")
    assert blocks[1].strip() == example.read_text(encoding="utf-8").strip()
    assert lint(read(example.read_text(encoding="utf-8"))) == []
    mission = root / "examples" / "crossing" / "mission.yaml"
    assert main(["run", str(mission), "--out", str(tmp_path), "--quiet"]) == 0
    capsys.readouterr()
    log = str(tmp_path / "crossing")
    assert main(["monitor", log, "--requirements", str(example)]) == 3
    assert capsys.readouterr().out.startswith(blocks[5].strip())
