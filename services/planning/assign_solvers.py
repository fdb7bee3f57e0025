"""Checks by z3, and cvc5 in addition: whether a schedule is valid, whether it can be improved, which
constraints conflict.

z3's effort is counted (`rlimit`), not timed, so an answer does not depend on the machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import z3

from cratous.services.planning.assign_meaning import (
    Named,
    choice,
    constraints,
    costs_less,
    end,
    flights,
    meaning,
    past,
    place,
    start,
    windows,
)
from cratous.services.planning.assign_problem import Part, check, parts
from cratous.services.planning.assign_replay import branch_of
from cratous.spec.assignment.search import AssignmentProblem, Step

EFFORT = 60_000_000
"""z3's resource limit for one query, about 15 s."""
SECOND_MS = 60_000


class _Terms:
    """Formulas as z3's terms (`assign_logic.Logic`)."""

    number = staticmethod(z3.Int)
    truth = staticmethod(z3.Bool)
    each = staticmethod(z3.And)
    some = staticmethod(z3.Or)
    follows = staticmethod(z3.Implies)
    differ = staticmethod(z3.Distinct)

    def one(self, formulas: Sequence[Any]) -> Any:
        return z3.PbEq([(f, 1) for f in formulas], 1) if formulas else z3.BoolVal(False)

    def few(self, formulas: Sequence[Any]) -> Any:
        return z3.AtMost(*formulas, 1)

    def laps(self, name: str, _wait: Any, _lap_ms: int) -> Any:
        return z3.Int(name)


_Z3 = _Terms()


def schedule_holds(problem: AssignmentProblem, steps: Sequence[Step]) -> tuple[bool, str]:
    """Whether z3 finds the schedule valid by the problem's own constraints; else the words of the first
    violated one.
    """
    branch = branch_of(problem, steps)
    times: list[Any] = []
    for number, step in enumerate(steps):
        begin, stop = step.start_ms, step.end_ms
        times += [start(_Z3, step.task_id) == begin, end(_Z3, step.task_id) == stop]
        times.append(place(_Z3, step.task_id) == number)
        v = problem.vehicles.index(step.vehicle_id)
        for k in branch.choices:
            one = problem.choices[k]
            if (one.task_id, one.option_id) == (step.task_id, step.option_id):
                if step.vehicle_id not in one.vehicles:
                    return False, "what the vehicles can fly"
                times.append(choice(_Z3, k, v))
    gone = [task for task, _, _ in problem.done]
    times += past(_Z3, problem)
    said = meaning(_Z3, branch.term, problem.semantics, gone)
    for text, formula in (*said, *windows(_Z3, problem, branch)):
        if _ask([*times, z3.Not(formula)]) != z3.unsat:
            return False, text
    # choices that are not taken are flown by no vehicle and can be omitted
    taken = {(step.task_id, step.option_id) for step in steps}
    few = [k for k in branch.choices if _name(problem, k) in taken]
    if _ask([*times, *flights(_Z3, problem, replace(branch, choices=tuple(few)))]) != z3.sat:
        return False, "what the vehicles can fly"
    return True, ""


def _name(problem: AssignmentProblem, k: int) -> tuple[int, int]:
    return problem.choices[k].task_id, problem.choices[k].option_id


def _ask(formulas: Sequence[Any], effort: int = EFFORT) -> Any:
    solver = z3.SolverFor("QF_LIA")
    solver.set("rlimit", effort)
    solver.set("random_seed", 1)
    solver.add(*formulas)
    return solver.check()


def none_below(problem: AssignmentProblem, limit: int) -> tuple[bool, str]:
    """Whether z3 and cvc5 both prove that nothing costs less than the limit, and their answers."""
    said, gone = [], [task for task, _, _ in problem.done]
    for number, branch in enumerate(parts(problem)[0]):
        formulas = [
            *[f for _, f in meaning(_Z3, branch.term, problem.semantics, gone)],
            *[f for _, f in windows(_Z3, problem, branch)],
            *flights(_Z3, problem, branch),
            *costs_less(_Z3, problem, branch, limit),
        ]
        one = str(_ask(formulas))
        two = _cvc5(formulas) if one == "unsat" else "not asked"
        said.append(f"branch {number + 1}: z3 {one}, cvc5 {two}")
        if (one, two) != ("unsat", "unsat"):
            return False, "; ".join(said)
    return True, "; ".join(said)


def _cvc5(formulas: Sequence[Any]) -> str:
    """cvc5's answer on the SMT-LIB text: sat, unsat or unknown; or `not installed`."""
    try:
        import cvc5
    except ImportError:
        return "not installed"
    writer = z3.Solver()
    for formula in formulas:
        # cardinality constraints are specific to z3: sums of ones and zeros are equivalent
        writer.add(_plain(formula))
    solver = cvc5.Solver()
    solver.setOption("tlimit-per", str(SECOND_MS))
    solver.setLogic("QF_LIA")
    parser = cvc5.InputParser(solver)
    text = writer.to_smt2().replace("(check-sat)", "")
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, text, "assignment")
    manager = parser.getSymbolManager()
    while True:
        command = parser.nextCommand()
        if command.isNull():
            break
        command.invoke(solver, manager)
    result = solver.checkSat()
    return "unsat" if result.isUnsat() else "sat" if result.isSat() else "unknown"


def _plain(formula: Any) -> Any:
    kind = formula.decl().kind() if z3.is_app(formula) else None
    if kind not in (z3.Z3_OP_PB_EQ, z3.Z3_OP_PB_AT_MOST):
        return formula
    count = sum([z3.If(part, 1, 0) for part in formula.children()], z3.IntVal(0))
    return count == 1 if kind == z3.Z3_OP_PB_EQ else count <= 1


def why_infeasible(problem: AssignmentProblem) -> tuple[tuple[str, ...], bool]:
    """A minimal set of conflicting constraints, in words, and whether that is certain.

    Empty and certain: a plan exists. Minimal: without any one of them there is one. The flights (travel,
    durations, eligibility) are fixed.
    """
    check(problem)
    named, branches = constraints(_Z3, problem)
    answer, core = _clash(problem, named, branches)
    if answer != z3.unsat:
        return (), bool(answer == z3.sat)
    keep, sure = [n for n in named if n.text in core], True
    for one in list(keep):
        if one not in keep:
            continue
        trial = [n for n in keep if n is not one]
        answer, core = _clash(problem, trial, branches)
        if answer == z3.unsat:
            keep = [n for n in trial if n.text in core]
        elif answer == z3.unknown:
            sure = False
    if not keep:
        return ("no vehicles can fly all tasks, whatever the times",), sure
    return tuple(n.text for n in keep), sure


def _clash(
    problem: AssignmentProblem, named: Sequence[Named], branches: Sequence[Part]
) -> tuple[Any, set[str]]:
    """z3's answer whether there is a plan, and the words of the conflicting constraints if there is none."""
    core: set[str] = set()
    for number, branch in enumerate(branches):
        solver = z3.SolverFor("QF_LIA")
        solver.set("rlimit", EFFORT)
        solver.set("unsat_core", True)
        solver.add(*flights(_Z3, problem, branch))
        for k, one in enumerate(named):
            for b, formula in one.formulas:
                if b == number:
                    solver.assert_and_track(formula, f"n{k}_{len(solver.assertions())}")
        answer = solver.check()
        if answer != z3.unsat:
            return answer, set()
        core |= {named[int(str(name)[1:].split("_")[0])].text for name in solver.unsat_core()}
    return z3.unsat, core
