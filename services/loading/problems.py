"""Collects several faults of an input, so that a user can correct them together."""

from __future__ import annotations

from typing import Any

from cratous.spec.errors import BadInput

MOST = 10


class BadMission(BadInput):
    """The first fault of a mission, with all that were found (at most ten) in `problems`."""

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
        """The first fault as a dictionary, with the others under `more`."""
        return {**super().data(), "more": [problem.data() for problem in self.problems[1:]]}


def refuse(problems: list[BadInput]) -> None:
    """Raise if there is any fault; a single one is raised unchanged."""
    if len(problems) == 1:
        raise problems[0]
    if problems:
        raise BadMission(problems)
