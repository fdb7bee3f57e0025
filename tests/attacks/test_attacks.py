"""Every package of the self-test: what claims something false is refused, its near miss accepted."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from cratous.proofs.self_test import case, trial
from cratous.services.cli import main
from cratous.spec.errors import BadInput

CASES = list(case.cases())
NEAR_MISSES = [one for one in CASES if one.verdict == "accepted"]
# all that must be refused, and every fifth near miss; `cratous prove --self-test` tries them all
TRIED = [
    pytest.param(one, marks=pytest.mark.long) if one in NEAR_MISSES and k % 5 else one
    for k, one in enumerate(CASES)
]


Attempt = Callable[[case.Case], trial.Trial]


@pytest.fixture(scope="module")
def attempt(root: Path) -> Iterator[Attempt]:
    """`trial.attempt` in a small process, from which forking is cheap."""
    child = subprocess.Popen(
        [sys.executable, root / "tests" / "children" / "trial_child.py"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    assert child.stdin is not None
    assert child.stdout is not None
    to_child, from_child = child.stdin, child.stdout

    def tried(one: case.Case) -> trial.Trial:
        pickle.dump(one, to_child)
        to_child.flush()
        found: trial.Trial = pickle.load(from_child)
        return found

    yield tried
    to_child.close()
    from_child.close()
    assert child.wait(60) == 0


@pytest.mark.slow
@pytest.mark.parametrize("one", TRIED, ids=lambda one: one.id)
def test_the_prover_judges_it_as_it_must(one: case.Case, attempt: Attempt) -> None:
    assert attempt(one).wrong == "", one.because


def test_there_are_enough_of_each() -> None:
    """So that the prover wins neither by accepting nor by refusing."""
    refused = [one for one in CASES if one.verdict == "refused"]
    assert len(refused) >= 120
    assert len(CASES) - len(refused) >= 120
    assert len({one.kind for one in refused}) >= 30
    both = {one.kind for one in refused} & {one.kind for one in CASES if one not in refused}
    assert {one.kind for one in CASES} == both


def _honest() -> case.Case:
    return next(one for one in CASES if one.id == "machine_integers/fine_difference")


def _with(one: case.Case, verdict: str, says: str, old: str, new: str) -> case.Case:
    files = tuple((place, text.replace(old, new)) for place, text in one.files)
    assert files != one.files or not old
    return case.Case(one.kind, one.name, verdict, "a test", ((says,),) if says else (), files)


@pytest.mark.parametrize(
    ("verdict", "says", "old", "new", "wrong"),
    [
        ("refused", "whatever", "", "", "accepted"),
        ("accepted", "", "n - m >= 0", "n - m > 0", "refused: "),
        ("refused", "zero", "n - m >= 0", "n - m > 0", "refused for another reason (zero not in"),
        ("refused", "refuted", "n - m >= 0", "n - m > 0", ""),
        (
            "accepted",
            "",
            "from cratous.core.kernel import",
            "import os; os._exit(3)  #",
            "broken: ",
        ),
    ],
)
def test_what_is_not_as_it_must_be_is_said(
    verdict: str, says: str, old: str, new: str, wrong: str, attempt: Attempt
) -> None:
    found = attempt(_with(_honest(), verdict, says, old, new))
    assert found.wrong.startswith(wrong)
    assert bool(found.wrong) == bool(wrong)


def test_a_ledger_that_vouches_for_what_is_refused_is_said() -> None:
    found = trial.Trial(_with(_honest(), "refused", "no", "", ""), "refused", "no", True)
    assert found.wrong == "refused, yet the ledger vouches"


def test_no_case_touches_the_next(attempt: Attempt) -> None:
    """A case that changes the prover changes it for itself alone."""
    vandal = _with(
        _honest(),
        "accepted",
        "",
        "from cratous.core.kernel import kernel",
        "from cratous.core.kernel import kernel\nimport z3\nz3.Solver.check = lambda *a: z3.sat",
    )
    assert attempt(vandal).verdict != "accepted"
    assert attempt(_honest()).wrong == ""


@pytest.mark.parametrize(
    "text",
    [
        "verdict: refused\nbecause: it says no word\n== kernels.py\n",
        "verdict: maybe\nbecause: it does not know\n== kernels.py\n",
        "verdict: accepted\n== kernels.py\n",
        "verdict: accepted\nbecause: it is empty\n",
    ],
)
def test_a_file_that_is_no_case_is_bad_input(text: str, tmp_path: Path) -> None:
    file = tmp_path / "one.case"
    file.write_text(text)
    with pytest.raises(BadInput, match="no case of the self-test"):
        case.read(file)


def test_the_command_says_by_kind_what_came_of_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    good = _honest()
    monkeypatch.setattr(case, "cases", lambda: iter([good]))
    assert main(["prove", "--self-test"]) == 0
    out = capsys.readouterr().out
    assert "machine integers: 1 of 1 accepted" in out
    assert "1 of 1 cases of 1 kinds" in out
    monkeypatch.setattr(
        case, "cases", lambda: iter([good, _with(good, "refused", "whatever", "", "")])
    )
    assert main(["prove", "--self-test"]) == 1
    said = capsys.readouterr()
    assert "machine integers: 0 of 1 refused, 1 of 1 accepted" in said.out
    assert "fine_difference: accepted" in said.err
    assert main(["prove", "--self-test", "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert [row["wrong"] for row in data["cases"]] == ["", "accepted"]


def test_the_self_test_goes_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "--self-test", "--mutate"]) == 2
    assert "--self-test" in capsys.readouterr().err
