"""Where a text of the relations that a reason quotes stands in the mission's file, for people.

Plans, messages, logs and reports quote the text alone: they follow from the mission, not from where its file lies.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cratous.spec.errors import NoPlan
from cratous.spec.mission import Mission

QUOTED = re.compile("`([^`]+)`")


class RelationPlaces:
    """The places in one mission's file. Nothing is added where the file is gone or no text."""

    def __init__(self, mission: Mission) -> None:
        """Reads the file once."""
        self._file = mission.source
        try:
            self._lines = Path(self._file).read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            self._lines = []

    def told(self, text: str) -> str:
        """A text with `file:line` behind each quotation from the file."""
        return QUOTED.sub(self._placed, text)

    def _placed(self, quoted: re.Match[str]) -> str:
        found = (k for k, line in enumerate(self._lines, 1) if quoted[1] in line)
        line = next(found, None)
        return quoted[0] if line is None else f"{quoted[0]} at {self._file}:{line}"

    @contextmanager
    def in_reasons(self) -> Iterator[None]:
        """A NoPlan that comes from in here says the places as well."""
        try:
            yield
        except NoPlan as error:
            raise NoPlan(tuple(self.told(reason) for reason in error.reasons)) from error
