"""Records of arrays that the compiled searches read beside the instance.

Machine code takes a record as its fields one by one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cratous.core.assignment.instance import Instance

REFUTES = (
    "earliest_start", "latest_departure", "covers_step", "keeps_step", "weighted", "opened",
    "raised", "least_of", "add_least", "no_shortcut", "tail_step", "soonest_end", "room_step",
    "lacks_room", "later",
)  # fmt: skip
"""The kernels that decide in a refutation."""


class Ahead(NamedTuple):
    """Look-ahead data of the search; apart from the tables independent of the limit [ms].

    to_task [V, K + 1, n]: least time from a stop to a task's end; apart [n, n]: from one task's end to another's;
    to_task_added, apart_added: likewise of what legs cost; least, head, tail [n]: shortest duration, earliest start,
    least time after the end; able [V]: masks of the tasks that a vehicle may do; kind_of [V]: which vehicles share a
    table; leader: a vehicle of each kind.
    """

    to_task: np.ndarray
    to_task_added: np.ndarray
    apart: np.ndarray
    apart_added: np.ndarray
    least: np.ndarray
    head: np.ndarray
    tail: np.ndarray
    able: np.ndarray
    kind_of: np.ndarray
    leader: np.ndarray


class Tables(NamedTuple):
    """Latest departures for one limit, or arrays of one element.

    used: whether there are any; due [n]: latest ends for the limit; latest [kinds, K, 2**n], start
    [V, 2**n]: `tables.latest_tables`. All in ms.
    """

    used: int
    due: np.ndarray
    latest: np.ndarray
    start: np.ndarray


class Search(NamedTuple):
    """One search below a limit: the instance with the latest ends for it, and its look-ahead data.

    deals: whether tables are used; effort: steps spent on one question to `deals`.
    """

    instance: Instance
    ahead: Ahead
    tables: Tables
    deals: int
    effort: int


class Layer(NamedTuple):
    """The states of a layer: their rows, (parent, vehicle, option) [m, 3], bounds (-1: covered), and
    a hash table of them: heads, and the next state of the same hash."""

    states: np.ndarray
    origin: np.ndarray
    rank: np.ndarray
    table: np.ndarray
    chain: np.ndarray


class Times(NamedTuple):
    """When tasks start and end [n], and when vehicles are free [V + 1, the last entry is the sum of last ends]."""

    starts: np.ndarray
    ends: np.ndarray
    free: np.ndarray


class ChainArrays(NamedTuple):
    """Which tasks each vehicle does in which order: chain [V, n], length [V]; how [n]: by which option; there [n]: 1
    for tasks in chains.
    """

    chain: np.ndarray
    length: np.ndarray
    how: np.ndarray
    there: np.ndarray
