"""FRETish: the sentence of each form, and what has none."""

from __future__ import annotations

from pathlib import Path

import pytest
from certify_tools import Run

from cratous.services.requirements.fretish import NoForm, sentence
from cratous.services.requirements.language import read
from cratous.services.requirements.specification import NotRead

HEAD = "signal req, resp, Mode, _own: bool\nsignal x, y: m\n"
FORMS = {
    "x >= 90 m and y >= 90 m": "The system shall always satisfy x >= 90.0 & y >= 90.0",
    "x > 1 km": "The system shall always satisfy x > 1000.0",
    "x < y": "The system shall always satisfy x < y",
    "req implies resp": "Whenever req the system shall immediately satisfy resp",
    "req implies eventually within 5 s resp":
        "Whenever req the system shall within 5 seconds satisfy resp",
    "(req or x <= 3 m) implies always within 90 s (not resp)":
        "Whenever req | x <= 3.0 the system shall for 90 seconds satisfy !resp",
    "req implies always within 2 min (x >= 1 m or (resp and y >= 2 m))":
        "Whenever req the system shall for 2 minutes satisfy x >= 1.0 | (resp & y >= 2.0)",
    "eventually within 1500 us resp":
        "Whenever true the system shall within 1500 microseconds satisfy resp",
    "not (x > 3 m) and not not resp": "The system shall always satisfy x <= 3.0 & resp",
    "not (x < y) implies resp": "Whenever x >= y the system shall immediately satisfy resp",
    "x >= 1e-7 m or " + "not " * 3000 + "resp": "The system shall always satisfy x >= 1e-7 | resp",
}  # fmt: skip
WITHOUT = {
    "req implies eventually from 1 s to 5 s resp": "begins later",
    "req implies eventually within 5 ns resp": "no whole number of microseconds",
    "req implies (resp and eventually within 5 s resp)": "time within",
    "once within 5 s req": "time within",
    "(once within 5 s req) implies resp": "time within",
    "req implies Mode": "no signal of the name Mode",
    "_own": "no signal of the name _own",
    " or ".join(["req"] * 3000): "more than 200 levels",
    "(" * 40 + "req" + " iff resp)" * 40: "longer than 10000 characters",
}


@pytest.mark.parametrize("formula", FORMS)
def test_the_sentence_of_a_form(formula: str) -> None:
    spec = read(f"{HEAD}requirement R: {formula}")
    made = spec.requirements[0].formula
    assert not isinstance(made, NotRead)
    assert sentence(made, spec) == FORMS[formula]


@pytest.mark.parametrize("formula", WITHOUT)
def test_what_has_no_form_says_why(formula: str) -> None:
    spec = read(f"{HEAD}requirement R: {formula}")
    made = spec.requirements[0].formula
    assert not isinstance(made, NotRead)
    with pytest.raises(NoForm, match=WITHOUT[formula]):
        sentence(made, spec)


def test_the_command_checks_requirements_and_says_them(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "own.req"
    file.write_text(HEAD + "requirement A: req implies resp\nrequirement B: once within 5 s req\n")
    assert run("check", file) == (0, f"{file}: can be read\n", "")
    code, out, err = run("check", "--fretish", file)
    assert (code, err) == (3, "")
    assert out.splitlines() == [
        f"{file}: can be read",
        "A: Whenever req the system shall immediately satisfy resp",
        "B: not in FRETish: a time within a condition or a response has no form",
    ]
    file.write_text(HEAD + "requirement A: req implies other\n")
    code, out, err = run("check", file, "--json")
    assert code == 2
    assert '"caret"' in out
