"""`spec.records.replace` makes the record that `dataclasses.replace` makes, or hands on to it."""

import dataclasses
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import pytest

from cratous.spec.records import replace


@dataclass(frozen=True)
class Plain:
    one: int
    two: tuple[int, ...] = ()


class Measured(Plain):
    @cached_property
    def twice(self) -> int:
        return 2 * self.one


@dataclass(frozen=True)
class Whole:
    one: int

    def __post_init__(self) -> None:
        if self.one < 0:
            raise ValueError("below 0")


@dataclass(frozen=True, slots=True)
class Slotted:
    one: int


@dataclass
class Counting:
    one: int
    made: list[int] = field(default_factory=list, init=False)


def test_a_plain_record_is_copied() -> None:
    before = Plain(1, (2,))
    after = replace(before, one=3)
    assert (after, before) == (Plain(3, (2,)), Plain(1, (2,)))
    assert after.two is before.two
    assert hash(after) == hash(Plain(3, (2,)))
    with pytest.raises(dataclasses.FrozenInstanceError):
        after.one = 4  # type: ignore[misc]


def test_what_a_record_has_remembered_is_not_of_the_copy() -> None:
    before = Measured(1)
    assert before.twice == 2
    assert replace(before, one=3).twice == 6


def test_a_record_that_does_more_at_building_is_built() -> None:
    with pytest.raises(ValueError, match="below 0"):
        replace(Whole(1), one=-1)
    assert replace(Slotted(1), one=2) == Slotted(2)
    before = Counting(1)
    before.made.append(5)
    assert replace(before, one=2).made == []


@pytest.mark.parametrize("record", [Plain(1), Slotted(1), Whole(1)])
def test_another_name_is_an_error(record: Any) -> None:
    with pytest.raises(TypeError, match="three"):
        replace(record, three=3)
