"""Content of a requirements file in any language: signals, requirements, and why some are not read."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from cratous.services.requirements.arithmetic import Term
from cratous.services.requirements.formula import Formula
from cratous.spec.errors import BadInput


class NotRead(BadInput):
    """A requirement that cannot be read."""

    def __init__(
        self,
        what: str,
        where: str,
        caret: str,
        *,
        item: str = "",
        expected: str = "",
        got: str = "",
    ) -> None:
        self._caret = caret
        self.problems: tuple[NotRead, ...] = ()
        """All problems of its file, this one first; empty if this is the only one known."""
        super().__init__(what, where=where, item=item, expected=expected, got=got)

    def caret(self) -> str:
        """The line of the requirement (a window of it if it is long), and ^ below the position."""
        return self._caret

    def data(self) -> dict[str, str]:
        """As for every `BadInput`, with the caret."""
        return {**super().data(), "caret": self._caret}


@dataclass(frozen=True)
class Requirement:
    """One requirement of a file. name: its own, else its number; formula: or why it is not read.

    title, severity, source: as stated by its author, empty if not; between: formula evaluated at
    samples instead, so that the requirement holds between them too (`requirements.between_samples`), if a
    signal has a rate.
    """

    name: str
    text: str
    formula: Formula | NotRead
    title: str = ""
    severity: str = ""
    source: str = ""
    between: Formula | None = None

    @property
    def judged(self) -> Formula:
        """The formula evaluated at each sample. Raises NotRead."""
        if isinstance(self.formula, NotRead):
            raise self.formula
        return self.formula if self.between is None else self.between


@dataclass(frozen=True)
class Signal:
    """A signal. kind: bool, int or float; unit: "" if the language has none.

    message, field: the message type and field that give it in a log, with required values of other
    fields; hold_ns: how long a value is valid after its sample (0: at its sample only); made: term
    from which it is computed, None: recorded in the trace; word: the signal tells whether the field
    has this value; rate: maximum change per second, in its unit, 0 if not given.
    """

    kind: str
    unit: str = ""
    message: str = ""
    chosen: tuple[tuple[str, str], ...] = ()
    field: str = ""
    hold_ns: int = 0
    made: Term | None = None
    word: str = ""
    rate: Fraction = Fraction(0)


@dataclass(frozen=True)
class Specification:
    """The requirements of a file in order, and its signals by name.

    timed: samples have times, and bounds are times [ns]; otherwise both count samples. gap_ns:
    samples further apart leave the time between them unknown; 0: not given. period_ns: sampling
    period, for the lint; 0: not given. begins_with_all: the first sample is that at which every
    signal has had a value.
    """

    signals: dict[str, Signal]
    requirements: tuple[Requirement, ...]
    timed: bool = False
    gap_ns: int = 0
    period_ns: int = 0
    begins_with_all: bool = False

    @property
    def notes(self) -> tuple[str, ...]:
        """What these requirements do not check in a trace, in words."""
        if not self.timed or self.gap_ns:
            return ()
        return ("no gap is stated (trace every ... gap ...): time without samples goes unnoticed",)

    @property
    def types(self) -> dict[str, str]:
        """The kind of each signal: bool, int or float."""
        return {name: signal.kind for name, signal in self.signals.items()}


def caret_of(text: str, offset: int) -> tuple[int, int, str]:
    """(line, column), from 1, of an offset, and a window of the line with ^ below the position."""
    line = text.count("\n", 0, offset) + 1
    column = offset - (text.rfind("\n", 0, offset) + 1)
    shown = text.split("\n")[line - 1]
    window = max(0, column - 60)
    return line, column + 1, f"{shown[window : window + 90]}\n{' ' * (column - window)}^"
