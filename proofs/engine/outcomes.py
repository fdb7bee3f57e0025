"""Results of a theorem: for each obligation by the solver, for the whole by running it on numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Owed:
    """An obligation's kind (goal, defined, base, step, use, lemma) and text."""

    kind: str
    text: str


@dataclass(frozen=True)
class Outcome:
    """The solver's result for one obligation (proved, refuted, unknown) and its effort.

    key: structural hash of the obligation; counterexample: the values of a refutation by name; story: the same in the
    user's terms; seconds: CPU, not in the ledger; ended: which time limit ended the question, where that is why it is
    unknown.
    """

    obligation: Owed
    status: str
    rlimit: int
    logic: str
    counterexample: tuple[tuple[str, str], ...] = ()
    key: str = ""
    story: tuple[str, ...] = ()
    seconds: float = 0.0
    ended: str = ""


@dataclass(frozen=True)
class Ran:
    """The result of running a theorem on numbers.

    points: the number of points at which its premises held and every statement could be decided; doubles: the number
    of those whose values are all doubles; differences: goals that are false there, and readings of its functions that
    differ; not_run: why it could not be run; left_out: readings of its functions that could not be compared.
    """

    points: int = 0
    differences: tuple[str, ...] = ()
    not_run: str = ""
    left_out: tuple[str, ...] = ()
    doubles: int = 0


def restored(data: dict[str, Any] | None) -> Ran | None:
    """The result from its stored fields; raises KeyError, TypeError or ValueError for other data."""
    if data is None:
        return None
    texts = {key: tuple(map(str, data[key])) for key in ("differences", "left_out")}
    points, doubles = int(data["points"]), int(data["doubles"])
    return Ran(points=points, not_run=str(data["not_run"]), doubles=doubles, **texts)
