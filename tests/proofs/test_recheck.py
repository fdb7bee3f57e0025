"""The second solver: it confirms, it contradicts, and it is never told the answer."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import z3

from cratous.core import ledger as gate
from cratous.proofs import ledger, recheck, second_solver
from cratous.proofs.engine import prover
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.mutation.keys import Store
from cratous.spec.errors import BadInput

pytest.importorskip("cvc5")
gate.load_all()
QUICK = [
    "authority_exactly_one_gives_way",
    "geofence_orient_is_the_turn",
    "geofence_straddles_is_its_definition",
]


def test_cvc5_confirms_what_is_true():
    theorems = ledger.prove_theorems(QUICK)
    steps: list[tuple[int, int]] = []
    found = recheck.recheck(theorems, jobs=2, tell=lambda c, n, of: steps.append((n, of)))
    assert {name: found.verdict(name) for name in QUICK} == dict.fromkeys(QUICK, "confirmed")
    assert found.count("confirmed") == 3
    assert len(found.checks) == sum(len(t.outcomes) for t in theorems)
    assert steps[-1][0] == steps[-1][1]
    assert all(check.logic for check in found.checks)


def _text(*terms: z3.BoolRef) -> str:
    return prover.smt2(Obligation("goal", "x", terms[:-1], terms[-1]), "T.")


def test_the_expected_status_is_not_believed():
    """The export says `unsat`; cvc5 must find out by itself."""
    x, y = z3.Reals("x y")
    true = _text(x > 1, x * x > x)
    false = _text(x > 0, x * x > x)
    assert "(set-info :status unsat)" in false
    assert second_solver.solve(true, "QF_NRA") == "unsat"
    assert second_solver.solve(false, "QF_NRA") == "sat"
    assert second_solver.solve(true, "ALL") == "unsat"
    assert second_solver.solve(_text(x + y > 0), "QF_LRA") == "sat"


def test_text_that_is_no_smt_lib_is_an_error():
    with pytest.raises((ValueError, RuntimeError)):
        second_solver.solve("(assert (= x 1))(check-sat)", "ALL")


def test_a_contradiction_is_seen(monkeypatch: pytest.MonkeyPatch):
    """A proof that z3 got wrong: here its obligation is replaced by a false one."""
    (theorem,) = ledger.prove_theorems(["geofence_straddles_is_its_definition"])
    false = _text(z3.Real("x") > 0)
    monkeypatch.setattr(prover, "smt2", lambda obligation, title, seen=None: false)
    found = recheck.recheck([theorem])
    assert found.verdict(theorem.name) == "contradicted"
    assert found.count("contradicted") == 1


def test_no_answer_is_no_answer(monkeypatch: pytest.MonkeyPatch):
    """A solver that spends its CPU time is ended by the system, and nothing is concluded."""
    (theorem,) = ledger.prove_theorems(["geofence_straddles_is_its_definition"])
    monkeypatch.setattr(second_solver, "CPU_SECONDS", 0)

    def busy(text: str, logic: str, options: dict[str, str] | None = None) -> str:
        while True:
            pass

    monkeypatch.setattr(second_solver, "solve", busy)
    found = recheck.recheck([theorem])
    assert found.verdict(theorem.name) == "no answer"


def test_the_file_is_keyed_by_obligation(tmp_path: Path):
    theorems = ledger.prove_theorems(["geofence_straddles_is_its_definition"])
    found = recheck.recheck(theorems)
    file = tmp_path / "recheck.json"
    recheck.write(found, theorems, file)
    data = recheck.read(file)
    assert data["solver"] == recheck.version()
    assert data["theorems"]["geofence_straddles_is_its_definition"]["cvc5"] == "confirmed"
    assert set(data["obligations"]) == {o.key for o in theorems[0].outcomes}
    assert recheck.text(found, theorems) == file.read_text()
    assert recheck.read(tmp_path / "none.json")["obligations"] == {}
    assert json.loads(file.read_text()) == data


def test_a_part_replaces_its_own_theorems_alone(tmp_path: Path):
    names = [
        "geofence_straddles_is_its_definition",
        "geofence_orient_is_the_turn",
        "authority_exactly_one_gives_way",
    ]
    theorems = ledger.prove_theorems(names)
    whole, part = tmp_path / "whole.json", tmp_path / "part.json"
    recheck.write(recheck.recheck(theorems), theorems, whole)
    data = json.loads(whole.read_text())
    # as if one theorem had been another when the file was written
    old = json.loads(whole.read_text())
    old["theorems"][names[1]]["cvc5"] = "no answer"
    gone = {k: row for k, row in old["obligations"].items() if names[1] in row["of"][0]}
    for key, row in gone.items():
        del old["obligations"][key]
        old["obligations"][f"old {key}"] = row
    part.write_text(json.dumps(old))
    recheck.write(recheck.recheck(theorems[1:2]), theorems[1:2], part, whole=False)
    assert json.loads(part.read_text()) == data
    assert part.read_text() == whole.read_text()
    old["solver"] = "cvc5 0.0"
    part.write_text(json.dumps(old))
    with pytest.raises(BadInput, match="another solver"):
        recheck.write(recheck.recheck(theorems[1:2]), theorems[1:2], part, whole=False)


def test_without_cvc5_the_user_is_told(monkeypatch: pytest.MonkeyPatch):
    def absent(name: str) -> str:
        raise recheck.importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(recheck.importlib.metadata, "version", absent)
    with pytest.raises(BadInput, match="second solver is not installed"):
        recheck.version()


def test_a_run_that_was_stopped_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """What was asked is stored; no answer holds for its time only, and damage counts as absent."""
    (theorem,) = ledger.prove_theorems(["geofence_straddles_is_its_definition"])
    store = Store(tmp_path)
    first = recheck.recheck([theorem], store=store)
    asked = tmp_path / "asked"

    def refuse(text: str, logic: str, options: dict[str, str] | None = None) -> str:
        asked.touch()
        return "unknown"

    monkeypatch.setattr(second_solver, "solve", refuse)
    assert recheck.recheck([theorem], store=store).verdict(theorem.name) == "confirmed"
    assert not asked.exists()
    assert first.count("confirmed") == 1
    for file in tmp_path.glob("*/*"):
        file.write_text("{")
    assert recheck.recheck([theorem], store=store).verdict(theorem.name) == "no answer"
    assert asked.exists()
    asked.unlink()
    assert recheck.recheck([theorem], store=store).verdict(theorem.name) == "no answer"
    assert not asked.exists()
    monkeypatch.setattr(second_solver, "CPU_SECONDS", second_solver.CPU_SECONDS + 1)
    assert recheck.recheck([theorem], store=store).verdict(theorem.name) == "no answer"
    assert asked.exists()


def test_asked_again_the_way_that_answered_is_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (theorem,) = ledger.prove_theorems(["geofence_straddles_is_its_definition"])
    asked = tmp_path / "asked"

    def all_alone(text: str, logic: str, options: dict[str, str] | None = None) -> str:
        with asked.open("a") as file:
            file.write(f"{logic}\n")
        return "unsat" if logic == "ALL" else "unknown"

    monkeypatch.setattr(second_solver, "solve", all_alone)
    found = recheck.recheck([theorem])
    assert set(asked.read_text().split()) > {"ALL"}
    file = tmp_path / "recheck.json"
    recheck.write(found, [theorem], file)
    asked.unlink()
    record = recheck.read(file)
    assert recheck.recheck([theorem], record=record) == recheck.recheck([theorem], record=record)
    assert not asked.exists()
    again = recheck.recheck([theorem], record=record, again=True)
    assert again.verdict(theorem.name) == "confirmed"
    assert set(asked.read_text().split()) == {"ALL"}
