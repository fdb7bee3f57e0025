"""What a statement that is run leaves of its kernels' arguments, and what it costs the solver."""

import pytest

from cratous.proofs.claim import Claim
from cratous.proofs.engine.counterexample import Watched
from cratous.proofs.engine.terms import known, leaves
from cratous.proofs.running import nudged


def two(x: float, n: int) -> bool:
    """Whatever."""
    return x > n * 0 or n > 3


def _many(state, seed: str = "seed") -> set[int]:
    """Positions of the arguments of the only use that are found to take many values."""
    claim = Watched()
    state(claim)
    (run,) = claim.runs
    asked = {(0, k): known(leaf) for k, leaf in enumerate(leaves(run.args))}
    return {k for _, k in nudged._found(state, len(claim.premises), seed, asked)}


@pytest.mark.parametrize(
    ("premise", "many"),
    [
        (lambda c, x, y, n: x < y, {0, 1}),
        (lambda c, x, y, n: c.all_of(x >= 0, x <= 1), {0, 1}),
        (lambda c, x, y, n: y * y == x, {0, 1}),
        (lambda c, x, y, n: x * (x - 1) * (x - 2) <= 0, {0, 1}),
        (lambda c, x, y, n: x * x == 1, set()),
        (lambda c, x, y, n: x == 1, {1}),
        (lambda c, x, y, n: x * (x - 1) * (x - 2) == 0, set()),
        # many values of y, two of x: it jumps where y is as great as a number that is written down
        (lambda c, x, y, n: x == c.when(y > 1, 1, 0), {1}),
        (lambda c, x, y, n: x == c.when(2 * y > 1, 1, c.when(y > 0, 2, 3)), {1}),
        (lambda c, x, y, n: n == 3, {0}),
        (lambda c, x, y, n: c.any_of(n == 1, n == -1), {0}),
        (lambda c, x, y, n: c.all_of(n >= 0, n <= 1), {0, 1}),
    ],
)
def test_what_moves_with_the_values(premise, many):
    def state(c: Claim) -> None:
        x, y, n = c.real("x"), c.real("y"), c.integer("n")
        c.premise(premise(c, x, y, n))
        c.use(two, x, n)

    assert _many(state) == many


def test_a_premise_that_comes_after_the_use_restricts_it_too():
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.use(two, x, n)
        c.premise(x * x == 1)

    assert _many(state) == set()


def test_places_are_made_of_the_seed():
    at = [nudged._Nudged(seed, 0).real("x") for seed in ("one", "other", "one")]
    assert at[0] == at[2] != at[1]
    beside = nudged._Nudged("one", 1).real("x")
    assert 0 < beside - at[0] < 2**-300


def test_calls_that_no_run_has_are_left_to_the_solver(tmp_path):
    (tmp_path / "made.py").write_text('"""A sentence."""\ndef claim(c):\n    c.real(\'x\')\n')
    claim = Watched()
    assert nudged.taken("made", claim, tmp_path) is not None
    claim.asked = True
    assert nudged.taken("made", claim, tmp_path) is None
