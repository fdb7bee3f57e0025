"""The readings of a kernel that programs use: machine code for arrays, and exact on rationals."""

from cratous.core.readings.exact import exact
from cratous.core.readings.machine.compiled import compiled

__all__ = ["compiled", "exact"]
