"""Verdicts of requirements: 0 false, 1 unknown, 2 true (Kleene). Definitions: `spec.requirements.operators`."""

from cratous.core.kernel import kernel


@kernel(implements="requirements.operators.not_")
def negated(phi: int) -> int:
    """Not phi; phi: a verdict, 0, 1 or 2."""
    return 2 - phi


@kernel(implements="requirements.operators.and_")
def both(phi: int, psi: int) -> int:
    """Phi and psi; verdicts, 0, 1 or 2."""
    return min(phi, psi)


@kernel(implements="requirements.operators.or_")
def either(phi: int, psi: int) -> int:
    """Phi or psi; verdicts, 0, 1 or 2."""
    return max(phi, psi)


@kernel(implements="requirements.operators.at_least")
def margin(value: float, bound: float) -> float:
    """How far a signal lies above a bound: at 0 and above it is at least the bound. In their unit.

    value: of the signal; bound: what it is compared with, in the same unit.
    """
    return value - bound


@kernel(implements="requirements.operators.at_least")
def reaches(value: float, bound: float) -> bool:
    """True iff the signal is at least the bound.

    value: of the signal; bound: what it is compared with, in the same unit.
    """
    return margin(value, bound) >= 0
