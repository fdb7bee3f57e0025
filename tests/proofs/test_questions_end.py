"""Every question ends: one that heeds no interrupt ends with its process, and its answer is `unknown`."""

from __future__ import annotations

import resource
import signal
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import z3

from cratous.proofs import ledger, second_solver
from cratous.proofs.engine import cpu_limit, lift, prover, solver_order, worker_processes
from cratous.proofs.engine.cache import Answer, Cache
from cratous.proofs.engine.models import Models
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.ledger.report_formats import failure_text
from cratous.spec.errors import BadInput

HEAD = '''"""The sign of a product."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.spec.rounding import outward_margin


def claim(c: Claim) -> None:
    x, y = c.reals("x y")
    c.premise(c.all_of(x > 0, y > 0))
'''
SHORT = HEAD + "    c.show(c.use(surely_above, x, 0), 'it is above')\n"
TWO = SHORT + "    c.show(c.use(surely_above, x * y, 0), 'the product is above')\n"
PATHS = (
    HEAD + "    c.show(c.use(surely_above, c.define(outward_margin, x, y, x), 0), 'the margin')\n"
)


class Deaf:
    """A solver that goes on whatever it is told."""

    def set(self, name: str, value: Any) -> None:
        """It takes any budget."""

    def add(self, *terms: z3.BoolRef) -> None:
        """It takes any question."""

    def statistics(self) -> list[tuple[str, int]]:
        """It counts nothing."""
        return []

    def check(self) -> z3.CheckSatResult:
        """It never answers."""
        while True:
            time.process_time()


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """What waits for minutes waits for a second."""
    monkeypatch.setattr(solver_order, "GUARD_S", 0.2)
    monkeypatch.setattr(solver_order, "GUARD_RATE", 10**12)
    monkeypatch.setattr(cpu_limit, "GRACE_S", 0.2)
    monkeypatch.setattr(lift, "PRUNE_CPU_S", 0.2)


def _proved(tmp_path: Path, **texts: str) -> list[prover.Theorem]:
    for name, text in texts.items():
        (tmp_path / f"{name}.py").write_text(text)
    return ledger.prove_theorems(sorted(texts), folder=tmp_path, jobs=2, machine=False)


def test_a_question_that_heeds_no_interrupt_ends_with_its_process() -> None:
    with pytest.raises(worker_processes.Ended, match="CPU time was used up") as ended:
        worker_processes.call(partial(solver_order.check, Deaf(), z3.Context(), 1))  # type: ignore[arg-type]
    assert ended.value.out_of_time


def test_one_that_is_asked_apart_is_unknown() -> None:
    def ask() -> tuple[str, str]:
        solver_order.ask_apart()
        x, plain = z3.Real("x"), z3.Solver()
        plain.add(x > 0, x < 0)
        hung = solver_order.check(Deaf(), z3.Context(), 1)  # type: ignore[arg-type]
        return hung.result, solver_order.check(plain, z3.main_ctx(), 10**6).result

    assert worker_processes.call(ask) == ("unknown", "unsat")


def test_a_model_is_had_of_what_was_asked_apart() -> None:
    def ask() -> int:
        solver_order.ask_apart()
        x, solver = z3.Int("x"), z3.Solver()
        solver.add(x > 6, x < 8)
        assert solver_order.check(solver, z3.main_ctx(), 10**6).result == "sat"
        return int(solver.model()[x].as_long())

    assert worker_processes.call(ask) == 7


def test_interrupts_come_until_one_is_heeded() -> None:
    heard = threading.Semaphore(0)

    class Slow(Deaf):
        def check(self) -> z3.CheckSatResult:
            for _ in range(2):
                while not heard.acquire(blocking=False):
                    time.process_time()
            return z3.unknown

    class Context:
        def interrupt(self) -> None:
            heard.release()

    assert solver_order.check(Slow(), Context(), 1).result == "unknown"  # type: ignore[arg-type]


def test_what_may_not_be_killed_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    with cpu_limit.ends_within(0):
        begun = time.process_time()
        while time.process_time() < begun + 2:
            pass


def test_the_theorem_of_such_a_question_is_not_proved_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its other obligations are proved, and so are the other theorems."""
    real = prover._solvers

    def ways(terms: list[Any], *rest: Any) -> Iterator[tuple[str, Any, int]]:
        if "x*y" in str(terms).replace(" ", ""):
            yield "ALL", Deaf(), 1
        else:
            yield from real(terms, *rest)

    monkeypatch.setattr(prover, "_solvers", ways)
    other, hung = _proved(tmp_path, a_sign=SHORT, of_a_product=TWO)
    assert other.proved
    assert not hung.proved
    said = {o.obligation.text: o.status for o in hung.outcomes if o.obligation.kind == "goal"}
    assert said == {"it is above": "proved", "the product is above": "unknown"}
    assert "unknown: goal: the product is above" in failure_text(hung)
    assert "it heeded no interrupt, which is no proof" in failure_text(hung)


def test_a_theorem_whose_paths_are_not_found_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lift.z3, "Solver", Deaf)
    monkeypatch.setattr(lift, "_MODELS", Models())
    with pytest.raises(BadInput, match="its paths take too long to find") as refused:
        _proved(tmp_path, of_a_margin=PATHS)
    assert refused.value.where.endswith("of_a_margin.py")


def _limited(function: Any, seconds: int) -> Any:
    """What the function gives in a process that was started with `ulimit -t`."""

    def limited() -> Any:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        return function()

    return worker_processes.call(limited)


def test_a_limit_of_ones_own_is_named_and_not_taken_for_the_provers() -> None:
    def ask() -> solver_order.Said:
        solver_order.ask_apart()
        return solver_order.check(Deaf(), z3.Context(), 1)  # type: ignore[arg-type]

    own = worker_processes.call(ask)
    assert "the prover's own limit of CPU time" in own.ended
    assert "ulimit" not in own.ended
    code = -signal.SIGKILL
    said = _limited(partial(cpu_limit.what_ended, code, 300.0), 20)
    assert "ulimit -t 20" in said
    assert "the prover's own" not in said
    # of a question that has no limit of its own
    assert "ulimit -t 20" in _limited(partial(cpu_limit.what_ended, code), 20)
    # killed, and nothing limits CPU time: by whom is not known
    assert cpu_limit.what_ended(code, 300.0) == (
        "its process ended before it answered (exit code -9)"
    )


def test_an_interrupted_question_says_so() -> None:
    class Slow(Deaf):
        heard = threading.Event()

        def check(self) -> z3.CheckSatResult:
            while not self.heard.is_set():
                time.process_time()
            return z3.unknown

    class Context:
        def interrupt(self) -> None:
            Slow.heard.set()

    said = solver_order.check(Slow(), Context(), 1)  # type: ignore[arg-type]
    assert said.ended.startswith("interrupted after")


def test_what_a_limit_ended_is_kept_nowhere(tmp_path: Path) -> None:
    kept = Cache(tmp_path)
    kept.put("q", 1, Answer("unknown", 1, 0.1, "ALL", "ended by a limit"))
    assert kept.get("q", 1) is None
    kept.put("q", 1, Answer("unknown", 1, 0.1, "ALL"))
    assert kept.get("q", 1) is not None


def test_a_killed_question_is_asked_anew_with_more_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first run is limited, and its cache does not speak for the second."""
    real = prover._solvers

    def ways(terms: list[Any], *rest: Any) -> Iterator[tuple[str, Any, int]]:
        hung = "x*y" in str(terms).replace(" ", "")
        yield from [("ALL", Deaf(), 1)] if hung else real(terms, *rest)

    folder, answers = tmp_path / "theorems", Cache(tmp_path / "answers")
    folder.mkdir()
    (folder / "of_a_product.py").write_text(TWO)

    def proved() -> prover.Theorem:
        (one,) = ledger.prove_theorems(
            ["of_a_product"], folder=folder, jobs=1, cache=answers, machine=False
        )
        return one

    with monkeypatch.context() as patch:
        patch.setattr(prover, "_solvers", ways)
        hung = proved()
    assert not hung.proved
    assert "the prover's own limit of CPU time" in failure_text(hung)
    assert proved().proved


def test_a_theorem_of_which_a_question_was_ended_is_not_recalled(tmp_path: Path) -> None:
    (one,) = _proved(tmp_path, a_sign=SHORT)
    ended = prover.replace(one, ended=("ended by a limit",), _key=prover._KEY)
    assert ended.proved
    Recall(tmp_path / "kept").put([ended])
    assert not (tmp_path / "kept").exists()


def test_the_second_solver_tells_its_limit_from_another(monkeypatch: pytest.MonkeyPatch) -> None:
    def spin(text: str, *way: Any) -> str:
        while True:
            time.process_time()

    monkeypatch.setattr(second_solver, "solve", spin)
    monkeypatch.setattr(second_solver, "CPU_SECONDS", 2)

    def ask() -> tuple[str, float]:
        asker = second_solver.Asker()
        try:
            return asker.ask("", ("ALL", {}))
        finally:
            asker.end()

    assert ask() == ("unknown", 2.0)
    with pytest.raises(second_solver.Stopped, match="ulimit -t 1"):
        _limited(ask, 1)
