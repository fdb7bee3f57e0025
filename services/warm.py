"""`python -m cratous.services.warm`: compile the kernels that the runtime uses on arrays.

Part of the set-up, so that the first mission does not wait for the compiler.
"""

from __future__ import annotations

from cratous.core.compiled import compiled
from cratous.core.polygon import orient
from cratous.core.well_clear import horizontal_violation, violation, violation_within
from cratous.services.planning import assign
from cratous.services.standing import require


def warm() -> int:
    """Compile, and run once on one state; returns how many kernels."""
    zero = 0.0
    state = (100.0, zero, -10.0, zero)
    compiled(horizontal_violation)(*state, 50.0, 10.0)
    compiled(violation)(*state, zero, zero, 50.0, 30.0, 10.0, zero)
    compiled(violation_within)(*state, zero, zero, 50.0, 30.0, 10.0, zero, 60.0)
    compiled(orient)(*state, zero, zero)
    assign.warm()
    require(allow_unproved=True)  # what is clean is remembered
    return 5


if __name__ == "__main__":
    print(f"{warm()} kernels compiled")
