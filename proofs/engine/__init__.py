"""What must be trusted: lifter, statements of theorems, solvers. Only `prover` makes a `Theorem`."""
