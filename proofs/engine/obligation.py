"""One statement for the solver: an obligation of a theorem."""

from __future__ import annotations

from dataclasses import dataclass

import z3


@dataclass(frozen=True)
class Obligation:
    """Something to prove: under `given`, `goal`. kind: goal, defined, base, step, use, lemma."""

    kind: str
    text: str
    given: tuple[z3.BoolRef, ...]
    goal: z3.BoolRef
