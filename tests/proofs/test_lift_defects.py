"""The lifter broken on purpose, in one way at a time: each defect must be noticed.

By the comparison of lifted terms with running functions, or by a check of what the lifter owes.
"""

import pytest
import z3
from lift_checks import CHECKS, PROBES, length
from lifted import differences

from cratous.core.kernel import named
from cratous.proofs.engine import claim as claim_module
from cratous.proofs.engine import lift as lifter
from cratous.proofs.engine import symbolic
from cratous.proofs.engine.claim import Claim, Stub
from cratous.proofs.engine.lift import lift
from cratous.proofs.engine.symbolic import Path, SymBool, SymInt, SymMask, SymNumber


def _nothing(*args, **more):
    return None


def _old_decider(context, queue, pruned):
    """Repeated conditions took part in a replay's script: whole paths were lost."""

    def decide(path, condition):
        index = len(path.taken)
        if index < len(path.script):
            choice = path.script[index]
        elif condition.get_id() in {c.get_id() for c in path.conditions}:
            return True
        else:
            yes = lifter._feasible([*context, *path.conditions, condition])
            no = lifter._feasible([*context, *path.conditions, z3.Not(condition)])
            choice = yes or not no
            if yes and no:
                queue.append([*path.taken, False])
        path.taken.append(choice)
        path.conditions.append(condition if choice else z3.Not(condition))
        return choice

    return decide


def _inverted(self):
    return not TRUTH(self)


def _rotated(branches):
    values = [v for _, v in branches]
    return JOIN([(c, v) for (c, _), v in zip(branches, values[1:] + values[:1], strict=True)])


def _without_calls(callee):
    return lambda *args: lift(callee, *args).value


def _one_result(self, *args):
    if not self.results:
        self.results[""] = claim_module._fresh(f"{self.name}#0", self.result)
        self.calls.append(args)
    return self.results[""]


def _new_result(self, *args):
    self.calls.append(args)
    return claim_module._fresh(f"{self.name}#{len(self.calls)}", self.result)


def _short_name(self, name, function):
    STUB(self, function.__name__, function)


def _owe_all_but(kind):
    def owe(self, other, text, goal):
        if other != kind:
            OWE(self, other, text, goal)

    return owe


def _rootless(value):
    before = symbolic.PATHS[-1].roots
    symbolic.PATHS[-1].roots = []
    made = ROOT(value)
    symbolic.PATHS[-1].roots = before
    return made


def _root_known_too_well(value):
    made = ROOT(value)
    symbolic.PATHS[-1].roots.append(made.term * made.term == symbolic._raw(value))
    return made


def _mixes(term):
    return z3.ToReal(term) if z3.is_int(term) else term


def _unequal(self, other):
    return NotImplemented if symbolic._pair(self, other) is None else EQUAL(self, other)


def _wrong_remainder(self, other):
    return symbolic.wrap(z3.If(self.term >= 0, self.term % other, -((-self.term) % other)))


def _hasty(conditions):
    """Takes `unknown` for infeasible, with next to no budget."""
    return len(conditions) < 2


TRUTH, JOIN, OWE, EQUAL = SymBool.__bool__, lifter.join, Claim._owe, SymNumber.__eq__
ROOT, STUB, EXTREME = symbolic.root, Stub.__init__, lifter._extreme
DECIDER, DIVIDE = lifter._decider, symbolic._divide

DEFECTS = {
    "decisions the wrong way round": [(SymBool, "__bool__", _inverted)],
    "a path dropped": [(lifter, "_decider", lambda c, q, p: DECIDER(c, [], p))],
    "paths lost where a condition repeats": [(lifter, "_decider", _old_decider)],
    "results joined in the wrong order": [(lifter, "join", _rotated)],
    "pruning what was not decided": [(lifter, "_feasible", _hasty)],
    "abs without its case": [(SymNumber, "__abs__", lambda self: self)],
    "min and max exchanged": [
        (lifter, "_extreme", lambda which: EXTREME(max if which is min else min))
    ],
    "<= taken for <": [(SymNumber, "__le__", SymNumber.__lt__)],
    "> taken for >=": [(SymNumber, "__gt__", SymNumber.__ge__)],
    "!= of truth values taken for ==": [(SymBool, "__ne__", SymBool.__eq__)],
    "a literal minus a value, turned": [(SymNumber, "__rsub__", SymNumber.__sub__)],
    "a quotient upside down": [(symbolic, "_divide", lambda a, b: DIVIDE(b, a))],
    "& taken for |": [(SymMask, "__and__", SymMask.__or__)],
    "a shift that keeps the sign": [
        (SymMask, "__rshift__", lambda self, other: SymMask(self.term >> self._with(other)))
    ],
    "a remainder that rounds to zero": [(SymInt, "__mod__", _wrong_remainder)],
    "no side conditions": [(Path, "require", _nothing)],
    "a callee's side conditions lost": [(lifter, "_calling", _without_calls)],
    "definedness not owed": [(Claim, "_owe", _owe_all_but("defined"))],
    "64 bits not owed": [(symbolic, "INT64", 2**200)],
    "a root of which nothing is known": [(lifter, "root", _rootless)],
    "a root of which too much is known": [(lifter, "root", _root_known_too_well)],
    "integers mixed with reals": [(symbolic, "as_real", _mixes)],
    "unequal because of another kind": [(SymNumber, "__eq__", _unequal)],
    "a stub that ignores its arguments": [(Stub, "__call__", _one_result)],
    "a stub that forgets": [(Stub, "__call__", _new_result)],
    "a stub named by half its name": [(Stub, "__init__", _short_name)],
    "a lemma for nothing": [(Claim, "_owe", _owe_all_but("lemma"))],
    "an induction without base": [(Claim, "_owe", _owe_all_but("base"))],
    "an induction without step": [(Claim, "_owe", _owe_all_but("step"))],
    "an induction without use": [(Claim, "_owe", _owe_all_but("use"))],
    "an induction over chosen accumulators": [(claim_module, "arbitrary", _nothing)],
}


def _noticed():
    """Comparisons and checks that notice something; a crash of the lifter is noticed as well."""
    found = []
    for function in [*PROBES, length, named("vertical_violation").function]:
        try:
            wrong = differences(function, 400)
        except Exception as error:
            wrong = [error]
        if wrong:
            found.append(function.__name__)
    for name, check in CHECKS.items():
        try:
            good = check()
        except Exception:
            good = False
        if not good:
            found.append(name)
    return found


def test_nothing_is_noticed_in_the_lifter_as_it_is():
    assert _noticed() == []


@pytest.mark.parametrize("name", DEFECTS)
def test_a_defect_of_the_lifter_is_noticed(name, monkeypatch):
    for owner, attribute, value in DEFECTS[name]:
        monkeypatch.setattr(owner, attribute, value)
    assert _noticed()
