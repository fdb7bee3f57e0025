"""What a file of requirements says, in whichever language: signals, requirements, and why some are not read."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from cratous.services.requirements.arithmetic import Term
from cratous.services.requirements.formula import Formula
from cratous.spec.errors import BadInput


class NotRead(BadInput):
    """A requirement that is outside of the language."""

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
        """All that do not fit in its file, this one the first; none where it is the only one that is known."""
        super().__init__(what, where=where, item=item, expected=expected, got=got)

    def caret(self) -> str:
        """The line of the requirement (a window of it if it is long), and ^ below the place."""
        return self._caret

    def data(self) -> dict[str, str]:
        """As for every `BadInput`, and the caret."""
        return {**super().data(), "caret": self._caret}


@dataclass(frozen=True)
class Requirement:
    """One requirement of a file. name: its own, else its number; formula: or why it is not read.

    title, severity, source: as its author states them, empty where he does not; between: what is judged at samples in place
    of the formula, so that it holds between them too (`requirements.between`), where a signal of it has a rate.
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
        """What is judged at each sample. Raises NotRead."""
        if isinstance(self.formula, NotRead):
            raise self.formula
        return self.formula if self.between is None else self.between


@dataclass(frozen=True)
class Signal:
    """A signal. kind: bool, int or float; unit: "" where the language has none.

    message, field: the message type and the field that give it in a log, with what the message's other
    fields must be; hold_ns: how long a value counts after its sample (0: at its sample alone); made: of what it is
    calculated, None: it stands in the trace; word: it is whether the field is this word; rate: by how much it changes in a
    second at most, in its unit, 0 where nothing is said of it.
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

    timed: samples bear times, and bounds are times [ns]; else both count samples. gap_ns: samples that
    are further apart leave unknown what lies between them; 0: nothing is said of it. period_ns: of the
    samples, for the lint; 0: not told. begins_with_all: the first sample is that at which every signal has had a value.
    """

    signals: dict[str, Signal]
    requirements: tuple[Requirement, ...]
    timed: bool = False
    gap_ns: int = 0
    period_ns: int = 0
    begins_with_all: bool = False

    @property
    def notes(self) -> tuple[str, ...]:
        """What of a trace these requirements do not look at, in words."""
        if not self.timed or self.gap_ns:
            return ()
        return ("no gap is stated (trace every ... gap ...): time without samples goes unnoticed",)

    @property
    def types(self) -> dict[str, str]:
        """The kind of each signal: bool, int or float."""
        return {name: signal.kind for name, signal in self.signals.items()}


def caret_of(text: str, offset: int) -> tuple[int, int, str]:
    """(line, column) from 1 of an offset, and a window of the line with ^ below the place."""
    line = text.count("\n", 0, offset) + 1
    column = offset - (text.rfind("\n", 0, offset) + 1)
    shown = text.split("\n")[line - 1]
    window = max(0, column - 60)
    return line, column + 1, f"{shown[window : window + 90]}\n{' ' * (column - window)}^"
