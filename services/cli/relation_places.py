"""Adds file positions to quotations of task relations in reasons.

Plans, messages, logs and reports contain only the text: they depend on the mission, not on its
file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import dropwhile
from pathlib import Path

from cratous.spec.errors import NoPlan
from cratous.spec.mission import Mission

QUOTED = re.compile("`([^`]+)`")
BEGIN = re.compile(r"[^#]*\brelations[\"']?\s*:|.*<TaskRelationships>")
"""The line on which relations begin; occurrences before it, for example in comments, do not count."""


class RelationPlaces:
    """Finds the lines of relations in one mission file. Adds nothing if the file is missing or is not text."""

    def __init__(self, mission: Mission) -> None:
        """Reads the file once."""
        self._file = mission.source
        try:
            lines = Path(self._file).read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            lines = []
        numbered = enumerate(lines, 1)
        self._lines = list(dropwhile(lambda line: not BEGIN.match(line[1]), numbered))

    def told(self, text: str) -> str:
        """A text with `file:line` after each quotation from the file."""
        return QUOTED.sub(self._placed, text)

    def _placed(self, quoted: re.Match[str]) -> str:
        found = (k for k, line in self._lines if quoted[1] in line)
        line = next(found, None)
        return quoted[0] if line is None else f"{quoted[0]} at {self._file}:{line}"

    @contextmanager
    def in_reasons(self) -> Iterator[None]:
        """Add positions to a NoPlan raised inside the block."""
        try:
            yield
        except NoPlan as error:
            raise NoPlan(tuple(self.told(reason) for reason in error.reasons)) from error
