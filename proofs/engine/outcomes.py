"""What came of a theorem: of each obligation by the solver, of the whole by running it on numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Owed:
    """What was owed: its kind (goal, defined, base, step, use, lemma) and its text."""

    kind: str
    text: str


@dataclass(frozen=True)
class Outcome:
    """What the solver said of one obligation: proved, refuted, unknown; the effort it took.

    key: structural hash of the obligation; counterexample: the values of a refutation by name;
    story: the same in the user's terms; seconds: CPU, not in the ledger; ended: which limit of time ended
    the question, where that is why it is unknown.
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
    """A theorem that was run.

    points: numbers for its values at which its premises held and all was decided; doubles: those of them
    that CPython's doubles are, every one; differences: what was
    to be shown and is false there, and readings of its functions that differ; not_run: why it could not
    be run itself; left_out: readings of its functions that could not be compared.
    """

    points: int = 0
    differences: tuple[str, ...] = ()
    not_run: str = ""
    left_out: tuple[str, ...] = ()
    doubles: int = 0


def restored(data: dict[str, Any] | None) -> Ran | None:
    """The same from its fields as they were kept; KeyError, TypeError or ValueError for other data."""
    if data is None:
        return None
    texts = {key: tuple(map(str, data[key])) for key in ("differences", "left_out")}
    points, doubles = int(data["points"]), int(data["doubles"])
    return Ran(points=points, not_run=str(data["not_run"]), doubles=doubles, **texts)
