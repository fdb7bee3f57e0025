"""The result of a mission's assignment search in indices: who flies which option, and when.

Vehicles and options (candidates) are numbered as in the mission; times in integer ms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cratous.spec.constraint_rows import AFTER_END, AFTER_START, Row

START = -1
"""In place of a candidate: the vehicle's start."""


class Fixed(NamedTuple):
    """A task that has already been flown: its times [ms]."""

    task_id: int
    start_ms: int
    end_ms: int


class Placed(NamedTuple):
    """One task of the result: vehicle index, candidate index, times [ms]."""

    vehicle: int
    candidate: int
    depart_ms: int
    arrive_ms: int
    start_ms: int
    end_ms: int


@dataclass(frozen=True)
class Branch:
    """One resolution of `+`: its tasks, and its rows about those that are not flown yet."""

    tasks: tuple[int, ...]
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Assignment:
    """The result of the search. status: `optimal` only with a certificate, else `feasible`; bound: the proved lower
    bound of the cost; digest: of the certificate.
    """

    branch: Branch
    placed: tuple[Placed, ...]
    cost: int
    bound: int
    status: str
    nodes: int
    digest: str

    @property
    def gap(self) -> float:
        """(cost - bound) / cost."""
        return 0.0 if self.cost <= self.bound else (self.cost - self.bound) / self.cost


def without_order(rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows under the weaker semantics `order`: plain precedence does not bind times."""
    return tuple(row for row in rows if not (row.kind in (AFTER_END, AFTER_START) and row.lo == 0))
