"""`cratous prove`: options, output, exit codes."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from cratous.core import ledger as gate
from cratous.core.ledger import records
from cratous.core.schedule.rows import later
from cratous.proofs import ledger, recheck
from cratous.proofs.engine import prover, worker_processes
from cratous.proofs.engine.cache import Answer
from cratous.proofs.engine.outcomes import Ran
from cratous.proofs.mutation import mutate
from cratous.proofs.mutation import record as mutation_record
from cratous.proofs.phases import COMPILING, SECOND, STATEMENTS, THEOREMS, Phases, TimedCache
from cratous.proofs.running.compiling import compile_ahead
from cratous.proofs.running.readings import MACHINE, compare
from cratous.services.cli import main, prove

FEW = "*its_definition"
ONE = "geofence_straddles_is_its_definition"
FEW_USE_IT = "authority_exactly_one_gives_way"


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path / "cache"))


def _json(capsys: pytest.CaptureFixture[str], *options: str) -> tuple[int, dict]:
    code = main(["prove", "--json", *options])
    return code, json.loads(capsys.readouterr().out)


def _ledger() -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in gate.PRODUCT.records.rglob("*.json")}


def test_cold_and_warm_say_the_same(capsys: pytest.CaptureFixture[str]):
    before = _ledger()
    code, cold = _json(capsys, "--only", "geofence_orient*")
    assert code == 0
    _, warm = _json(capsys, "--only", "geofence_orient*")
    assert warm["theorems"] == cold["theorems"]
    assert cold["proved"] == 1
    assert _ledger() == before, "a part writes no ledger"


def test_all_views_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    options = ["--only", ONE, "--junit", str(tmp_path / "r" / "j.xml"), "-v"]
    options += ["--sarif", str(tmp_path / "s.json"), "--smt2", str(tmp_path / "smt2")]
    assert main(["prove", *options]) == 0
    out = capsys.readouterr().out
    assert ONE in out
    assert "the ledger is not written" in out
    assert 'failures="0"' in (tmp_path / "r" / "j.xml").read_text()
    assert json.loads((tmp_path / "s.json").read_text())["runs"][0]["results"] == []
    files = sorted((tmp_path / "smt2").iterdir())
    assert files
    assert all("(check-sat)" in file.read_text() for file in files)


def test_several_patterns_choose_what_matches_any(capsys: pytest.CaptureFixture[str]):
    code, data = _json(capsys, "--only", "geofence_orient*", "--only", "tasks_square_within*")
    assert code == 0
    assert {t["name"].split("_")[0] for t in data["theorems"]} == {"geofence", "tasks"}


def test_nothing_matches_is_bad_input(capsys: pytest.CaptureFixture[str]):
    assert main(["prove", "--only", "nothing*"]) == 2
    assert "no theorem matches" in capsys.readouterr().err
    assert main(["prove", "--only", ONE, "--check"]) == 2
    assert "exclude each other" in capsys.readouterr().err


def test_changed_proves_what_differs_from_the_ledger(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """With a ledger about two theorems only, of which one has changed since."""
    names = ["geofence_straddles_is_its_definition", "authority_exactly_one_gives_way"]
    inventory = ledger.prove_all(names)
    data = ledger.records(inventory)
    data["kernels"]["cratous.core.authority.gate.gives_way"]["key"]["source"] = "another"
    for kind in records.KINDS:
        data[kind] = {name: records.sealed(name, record) for name, record in data[kind].items()}
    records.write(records.texts(data), tmp_path)
    real = gate.read
    monkeypatch.setattr(gate, "read", lambda folder: real(tmp_path))
    changed = ledger.changed_theorems()
    assert "authority_exactly_one_gives_way" in changed
    assert "geofence_straddles_is_its_definition" not in changed
    assert set(changed) == set(prover.theorem_files()) - {"geofence_straddles_is_its_definition"}


def test_recheck_counts_theorems_and_obligations(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    pytest.importorskip("cvc5")
    written = []
    monkeypatch.setattr(recheck, "write", lambda found, _, whole: written.append((found, whole)))
    code, data = _json(capsys, "--only", ONE, "--recheck")
    assert code == 0
    second = data["recheck"]
    assert second["theorems"] == {ONE: "confirmed"}
    assert (second["confirmed"], second["no_answer"], second["contradicted"]) == (1, 0, 0)
    assert data["theorems"][0]["second_solver"] == "confirmed"
    ((found, whole),) = written
    assert set(found.theorems) == {ONE}
    assert not whole, "the verdicts on other theorems stay"
    assert main(["prove", "--check", "--only", ONE, "--recheck"]) == 2


def test_a_contradiction_of_the_second_solver_fails(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    check = recheck.Check(ONE, 1, "k", "goal: the claim", "contradicted", "QF_NRA", 0.1)
    monkeypatch.setattr(recheck, "recheck", lambda *_, **__: recheck.Recheck("cvc5 1", (check,)))
    monkeypatch.setattr(recheck, "write", lambda *_, **__: None)
    assert main(["prove", "--only", ONE, "--recheck"]) == 1
    out = capsys.readouterr().out
    assert "contradicted geofence_straddles_is_its_definition 1: goal: the claim" in out
    assert "1 contradicted" in out


@pytest.mark.long
def test_mutation_is_reported(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    result = mutate.Result("f", "kernel", "op", "core/x.py:1", "a -> b", "survived")
    asked, kept = [], []

    def run(names, tell, jobs, *, about, keys, skip):
        asked.append((names, about))
        assert not skip
        tell("cratous.core.m.f", [result])
        tell("a_theorem", [])
        return mutate.MutationReport((result,), ())

    monkeypatch.setattr(mutate, "run", run)
    monkeypatch.setattr(mutation_record, "write", lambda report, keys: kept.append(report))
    assert main(["prove", "--only", FEW_USE_IT, "--mutate"]) == 1, (
        "a survivor on a kernel fails the run"
    )
    out = capsys.readouterr().out
    assert asked == [((FEW_USE_IT,), [FEW_USE_IT])]
    assert kept == [
        mutate.MutationReport((result,), ()),
        mutate.MutationReport((), (), ("a_theorem",)),
    ], "each as it is reached"
    assert "survived" in out
    assert "a -> b" in out


def test_assumptions_are_shown_with_owner_and_reason(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
):
    monkeypatch.setenv(
        "CRATOUS_CACHE", str(tmp_path)
    )  # the theorem as its file has it is not meant
    real = prover.load_claim

    def assuming(name, folder=prover.FOLDER):
        statement, sentence = real(name, folder)

        def stated(c):
            c.assume(c.real("wind") >= 0, owner="the pilot", reason="it always blows")
            statement(c)

        return stated, sentence

    monkeypatch.setattr(prover, "load_claim", assuming)
    code = main(["prove", "--only", ONE])
    out = capsys.readouterr().out
    assert code == 0
    assert "ASSUMED by the pilot" in out
    assert "it always blows" in out
    assert "1 assumptions" in out


VERDICT = """
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import violation
assert compiled(violation)(100.0, 0.0, -10.0, 0.0, 0.0, 0.0, 50.0, 30.0, 10.0, 0.0)
"""


@pytest.mark.parametrize(
    ("arguments", "limit_s"), [(["-m", "cratous", "plan", "--help"], 0.7), (["-c", VERDICT], 2.0)]
)
def test_the_start_is_quick(arguments: list[str], limit_s: float):
    """CPU seconds of a fresh process; for the verdict with a warm compile cache."""
    spent = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True, timeout=900)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert min(spent) < limit_s, spent


@pytest.mark.long
def test_mutation_of_functions_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pattern that only functions match proves and mutates what meets them."""
    asked = []

    def run(names, tell, jobs, *, about, keys, skip):
        asked.append((names, about))
        return mutate.MutationReport((), ())

    monkeypatch.setattr(mutate, "run", run)
    monkeypatch.setattr(mutation_record, "write", lambda report, keys: None)
    assert main(["prove", "--only", "gives_way", "--mutate"]) == 0
    assert asked == [(("gives_way",), [])]
    assert main(["prove", "--only", "no_such_function", "--mutate"]) == 2


@pytest.mark.long
def test_only_what_the_record_does_not_know_is_mutated(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With --new; what is recorded of the rest still counts."""
    kernel, theorem = "cratous.core.authority.gate.gives_way", "authority_the_greater_id_gives_way"
    survivor = {"verdict": "survived", "operator": "sign", "diff": "a -> b", "note": "why"}
    counts = {v: int(v == "survived") for v in mutate.VERDICTS}
    row = {"key": "", "kind": "kernel", "counts": counts, "listed": [survivor]}
    data = {"targets": {kernel: row}, "premises": {}}
    skipped = []

    def run(names, tell, jobs, *, about, keys, skip):
        skipped.append(skip)
        return mutate.MutationReport((), (), (theorem,))

    monkeypatch.setattr(mutate, "run", run)
    monkeypatch.setattr(mutation_record, "read", lambda: data)
    monkeypatch.setattr(mutation_record, "write", lambda report, keys: None)
    monkeypatch.setattr(mutation_record, "fresh", lambda data, keys: set(data["targets"]))
    assert main(["prove", "--only", "gives_way", "--mutate", "--new"]) == 1
    assert skipped == [{kernel}]
    out = capsys.readouterr().out
    assert f"survived   {kernel}: a -> b (as recorded)" in out
    assert "no mutant was judged" in out
    assert "with what was recorded: 0 mutants in 0 functions" in out, "its key is not the code's"
    data["targets"] = {}
    assert main(["prove", "--only", "gives_way", "--mutate", "--new"]) == 0
    assert main(["prove", "--only", "gives_way", "--new"]) == 2
    assert "--new is of --recheck or --mutate" in capsys.readouterr().err


def test_a_pattern_that_names_nothing_is_told_what_names_there_are(
    capsys: pytest.CaptureFixture[str],
) -> None:
    from cratous.services.cli import main

    assert main(["prove", "--only", "wel_clear*"]) == 2
    said = capsys.readouterr().err
    assert "no theorem matches" in said
    assert "such as well_clear_" in said


def test_what_could_not_be_compared_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    ran = Ran(3, left_out=("f: the lifted term: why",))
    prove._tell_ran([SimpleNamespace(name="t", ran=ran)], verbose=False)
    out = capsys.readouterr().out
    assert "1 reading could not be compared" in out
    assert "not compared: f: the lifted term: why" in out


def test_the_time_is_told_by_part_and_the_compiler_apart() -> None:
    found = Phases({THEOREMS: 20.0, COMPILING: 5.0, STATEMENTS: 1.0})
    assert found.line(2.0).startswith("21.0 s and 5.0 s of compiling: stating")
    assert found.line(2.0).endswith("; z3 2.0 s of CPU")
    before = found.seconds[COMPILING]
    found.ended(COMPILING)
    found.ended(SECOND)
    assert found.seconds[COMPILING] >= before
    assert list(found.seconds) == [THEOREMS, COMPILING, STATEMENTS, SECOND]


def test_only_answers_that_are_found_anew_take_the_solver_s_time(tmp_path: Path) -> None:
    store = TimedCache(tmp_path)
    answer = Answer("unsat", 1, 0.25, "ALL")
    worker_processes.call(lambda: store.put("one", 1, answer))
    assert store.get("one", 1) == answer
    assert store.seconds == 0.25


def test_a_kernel_that_is_compiled_ahead_is_only_loaded_to_be_compared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path))
    key = (later.__module__, later.__qualname__)
    compile_ahead({key: frozenset()}, 1)
    made = {file.stat().st_mtime_ns for file in tmp_path.rglob("*.nbc")}
    assert made
    assert dict(compare(later).readings)[MACHINE]
    assert {file.stat().st_mtime_ns for file in tmp_path.rglob("*.nbc")} == made
