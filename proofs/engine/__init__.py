"""The trusted part: lifter, statements of theorems, solvers. Only `prover` makes a `Theorem`."""
