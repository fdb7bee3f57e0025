"""Several problems found in one reading, so that a user mends them in one go."""

from __future__ import annotations

from typing import Any

from cratous.spec.errors import BadInput

MOST = 10


class BadMission(BadInput):
    """The first problem of a mission, with all that were found (at most ten) in `problems`."""

    def __init__(self, problems: list[BadInput]) -> None:
        self.problems = tuple(problems[:MOST])
        first = self.problems[0]
        super().__init__(
            first.what,
            where=first.where,
            item=first.item,
            expected=first.expected,
            got=first.got,
        )

    def data(self) -> dict[str, Any]:
        """The first problem as a dictionary, and the others under `more`."""
        return {**super().data(), "more": [problem.data() for problem in self.problems[1:]]}


def refuse(problems: list[BadInput]) -> None:
    """Raise if there is any problem; a single one as it is."""
    if len(problems) == 1:
        raise problems[0]
    if problems:
        raise BadMission(problems)
