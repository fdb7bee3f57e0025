"""Contracts of pure functions that are no kernels, for the bug finder CrossHair.

`make crosshair` runs each on symbolic arguments for some seconds. The asserts that stand first are
what may be assumed, the later ones what must hold. No answer is no proof: these functions decide
nothing that a kernel does not decide again. `tests/proofs/test_crosshair.py` runs them on plain values.
"""

from __future__ import annotations

import math
from fractions import Fraction

from cratous.bridge.text_protocol.messages import Direction
from cratous.bridge.text_protocol.parser import StreamParser
from cratous.core.assignment.earliest_times import next_wait_ms
from cratous.core.assignment.earliest_times import reference_ms as planned_reference_ms
from cratous.core.schedule.rows import row_holds
from cratous.proofs.engine.counterexample import number_text
from cratous.services.conform.values import finite
from cratous.services.mission.frames import compass
from cratous.services.mission.times import margin_ms, reference_ms
from cratous.spec.algebra import _number, _refuse_blank_or_deep
from cratous.spec.algebra.errors import Refusal, clip
from cratous.spec.constraint_rows import Row
from cratous.spec.errors import BadInput


def clipped_text_is_short_and_printable(text: str) -> None:
    """What an error quotes fits on a line."""
    assert len(text) < 50
    shown = clip(text)
    assert len(shown) <= 30
    assert shown.isprintable()


def a_compass_heading_is_below_360(heading_rad: float) -> None:
    """A heading in degrees is in [0, 360), as the wire wants it."""
    assert math.isfinite(heading_rad)
    degrees = compass(heading_rad)
    assert 0 <= degrees < 360


def a_wait_is_flown_in_whole_laps(wait_ms: int, lap_ms: int, lap_max_ms: int) -> None:
    """The wait is long enough, and some number of equal laps takes exactly so long."""
    assert 0 < lap_ms <= lap_max_ms
    assert 0 < wait_ms < 10**6
    assert lap_max_ms < 10**4
    found = next_wait_ms(wait_ms, lap_ms, lap_max_ms)
    assert found is not None
    laps = -(-found // lap_max_ms)
    assert found >= wait_ms
    assert laps * lap_ms <= found <= laps * lap_max_ms


def a_margin_is_negative_exactly_where_the_row_does_not_hold(
    kind: int, start: int, length: int, other: int, lo: int, width: int
) -> None:
    """What is displayed agrees with the kernel's verdict."""
    assert 1 <= kind <= 6
    assert 0 <= start < 10**9
    assert 0 <= length < 10**9
    assert 0 <= other < 10**9
    assert 0 <= lo < 10**9
    assert 0 <= width < 10**9
    row = Row(kind, 1, (2,) if kind < 5 else (), lo, lo + width, "")
    times = {1: (start, start + length), 2: (other, other + 5)}
    ref = reference_ms(row, times)
    holds = row_holds(row.kind, start, start + length, ref, row.lo, row.hi)
    assert (margin_ms(row, times) >= 0) == holds


def plan_and_flight_refer_to_the_same_instant(kind: int, one: int, two: int, length: int) -> None:
    """Both ways to the reference of a row agree."""
    assert 1 <= kind <= 4
    assert 0 <= one < 10**6
    assert 0 <= two < 10**6
    assert 0 <= length < 10**6
    row = Row(kind, 1, (2, 3), 0, 9, "")
    starts, ends = {2: one, 3: two}, {2: one + length, 3: two + 1}
    times = {task: (starts[task], ends[task]) for task in (2, 3)}
    assert planned_reference_ms(row, starts, ends) == reference_ms(row, times)


def a_number_of_the_algebra_is_in_range_or_refused(digits: str) -> None:
    """Numbers are read as written, or refused as such."""
    assert 0 < len(digits) < 30
    assert all("0" <= c <= "9" for c in digits)
    try:
        value = _number(digits, 0, "time", 0, 86_400_000)
    except Refusal:
        assert int(digits) > 86_400_000
    else:
        assert value == int(digits) <= 86_400_000


def blank_and_deep_texts_are_refused_as_such(text: str) -> None:
    """Only the one kind of error, at a place inside the text."""
    assert len(text) < 12
    offset = -1
    try:
        _refuse_blank_or_deep(text)
    except Refusal as refusal:
        offset = refusal.offset
        refused = True
    else:
        refused = False
    assert refused == (not text.strip())
    assert not refused or 0 <= offset <= len(text)


def the_parser_survives_any_bytes(data: bytes, cut: int) -> None:
    """No input makes it raise, and where it is cut makes no difference."""
    assert len(data) < 24
    assert 0 <= cut <= len(data)
    whole, pieces = StreamParser(Direction.UP), StreamParser(Direction.UP)
    records = whole.feed(data)
    assert pieces.feed(data[:cut]) + pieces.feed(data[cut:]) == records


def a_decimal_is_the_number_or_shows_the_fraction(top: int, bottom: int) -> None:
    """What a counterexample prints is exact."""
    assert 0 < bottom < 1000
    assert -1000 < top < 1000
    text = number_text(Fraction(top, bottom))
    exactly = text.split("exactly ")[-1].rstrip(")")
    above, _, below = exactly.partition("/")
    whole, _, digits = above.partition(".")
    scale = 10 ** len(digits) * int(below or "1")
    assert int(whole + digits) * bottom == top * scale


def a_vector_value_is_a_finite_double_or_refused(value: int) -> None:
    """An integer of a file is taken only if a double holds it."""
    assert -(2**70) < value < 2**70
    try:
        assert int(finite(value, "x")) == value
    except BadInput:
        assert int(float(value)) != value
