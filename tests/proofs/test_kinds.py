"""Which classes are records of the kernel subset."""

from __future__ import annotations

import copy
import pickle
from typing import NamedTuple

import pytest

from cratous.proofs.engine.value_kinds import is_record


class Plain(NamedTuple):
    x: float
    n: int


class Behaving(NamedTuple):
    x: float

    def twice(self) -> float:
        return self.x + self.x


class Defaulted(NamedTuple):
    x: float = 0.0


class Nested(NamedTuple):
    plain: Plain
    flag: bool


class Texts(NamedTuple):
    name: str


@pytest.mark.parametrize("kind", [Plain, Nested])
def test_a_record_stays_one_when_it_has_been_copied(kind: type):
    assert is_record(kind)
    one = kind(*(Plain(1.0, 2) if kind is Nested else 1.0, True))
    copy.copy(one), copy.deepcopy(one), pickle.dumps(one)
    assert "__slotnames__" in vars(kind)  # what Python's copying writes into a class
    assert is_record(kind)


@pytest.mark.parametrize("kind", [Behaving, Defaulted, Texts, tuple, int])
def test_what_is_no_record(kind: type):
    assert not is_record(kind)
