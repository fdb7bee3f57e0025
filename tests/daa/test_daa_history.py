"""Detect and avoid over time: alerts and bands that persist, gaps, conflicts that are held."""

from __future__ import annotations

import math
from collections import deque

import pytest
from daa_scenes import head_on

from cratous.core.daa.grid import grid
from cratous.core.daa.history import BandMemory, Shown, m_of_n, resolved
from cratous.core.daa.session import Session
from cratous.core.daa.state import HDIR, Aircraft, Band
from cratous.spec.daa.parameters import MID, NEAR, NONE, RECOVERY, Parameters
from cratous.spec.daa.presets import preset


@pytest.fixture(scope="module")
def p() -> Parameters:
    return preset("do_365b").parameters


def test_m_of_n():
    assert m_of_n(deque([3, 2, 0, 0]), 2) == 2
    assert m_of_n(deque([3, 3, 0, 0]), 2) == 3
    assert m_of_n(deque([1]), 2) == 0


def test_alerts_persist_and_need_two_of_four():
    shown = Shown(2, 4)
    assert shown.update(0, 0.0, 4.0) == 0
    assert shown.update(3, 1.0, 4.0) == 0
    assert shown.update(3, 2.0, 4.0) == 3
    assert [shown.update(0, t, 4.0) for t in (3.0, 4.0, 5.0)] == [3, 3, 3]
    assert shown.update(0, 6.0, 4.0) == 0


def test_history_ends_with_a_gap(p: Parameters):
    own, other = head_on()
    far = other._replace(north_m=90000.0)
    session = Session(p)
    assert session.step(0.0, own, [far], ()).alerts[0].level == 0
    assert session.step(1.0, own, [other], ()).alerts[0].level == 0
    assert session.step(100.0, own, [other], ()).alerts[0].level == 2
    assert session.step(99.0, own, [far], ()).alerts[0].level == 0


def test_bands_need_two_of_four():
    memory = BandMemory(2, 4)
    free, red = (Band(0, 10, NONE),), (Band(0, 5, NEAR), Band(5, 10, NONE))
    assert memory.filtered(free) == free
    assert memory.filtered(red) == free
    assert memory.filtered(red) == red
    recovering = memory.filtered((Band(0, 10, RECOVERY),))
    assert recovering == (Band(0, 5, NEAR), Band(5, 10, NONE))
    assert resolved(recovering, True) == (Band(0, 5, NEAR), Band(5, 10, RECOVERY))


def test_a_band_history_begins_with_m_copies():
    memory = BandMemory(3, 4)
    free, red = (Band(0, 10, NONE),), (Band(0, 10, NEAR),)
    assert [memory.filtered(b)[0].region for b in (free, red, red, red)] == [NONE, NONE, NONE, NEAR]


def test_a_conflict_band_is_held():
    memory = BandMemory(0, 0, persistence_s=4.0)
    free, red = (Band(0, 10, NONE),), (Band(0, 5, NEAR), Band(5, 10, NONE))
    mild = (Band(0, 6, MID), Band(6, 10, NONE))
    assert memory.shown(red, False, 2.0, 0.0) == red
    assert memory.shown(free, False, 2.0, 1.0) == red
    assert memory.shown(mild, False, 2.0, 2.0) == (
        Band(0, 5, NEAR), Band(5, 6, MID), Band(6, 10, NONE)
    )  # fmt: skip
    assert memory.shown(free, True, 2.0, 3.0) == (Band(0, 5, NEAR), Band(5, 10, RECOVERY))
    assert memory.shown(free, False, 2.0, 4.0) == free
    around = BandMemory(0, 0, persistence_s=4.0, turn=2 * math.pi)
    ahead = (Band(0, 1, NEAR), Band(1, 6, NONE), Band(6, 2 * math.pi, NEAR))
    assert around.shown(ahead, False, 0.5, 0.0) == ahead
    assert around.shown((Band(0, 2 * math.pi, NONE),), False, 0.5, 1.0) == ahead


def test_before_a_slow_turn_the_true_speed_is_flown(p: Parameters):
    own = Aircraft("own", 0, 0, 2000, 0, 1.0, 0)
    g = grid(p, own, HDIR)
    assert g.right[0, 3:5] == pytest.approx([0.0, p.min_airspeed_m_s])
    assert g.right[0, 6:8] == pytest.approx([0.0, 1.0])
