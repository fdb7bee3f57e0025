"""Resolutions and directions that are held; published sequences are compared in test_daa."""

from __future__ import annotations

from cratous.core.daa.persistence import Held, Span, Ways

FREE_ABOVE = [Span(0.0, 10.0, False), Span(10.0, 100.0, True)]


def test_a_resolution_is_held_while_the_change_is_early_or_small() -> None:
    ways = Ways(persistence_s=4.0, least=5.0)
    both = [Span(-100.0, -10.0, True), Span(-10.0, 10.0, False), Span(10.0, 100.0, True)]
    assert ways.shown(both, 0.0, Held(10.0, -12.0, True), -1, 0.0) == Held(10.0, -12.0, True)
    # nearer on both sides now, and down nearest: the direction is new, and the change is small
    near = [Span(-100.0, -5.0, True), Span(-5.0, 7.0, False), Span(7.0, 100.0, True)]
    assert ways.shown(near, 0.0, Held(7.0, -5.0, False), -1, 1.0) == Held(10.0, -5.0, True)
    # later the change of direction is still below 5, the resolution's own is too
    assert ways.shown(near, 0.0, Held(7.0, -5.0, False), -1, 9.0) == Held(10.0, -5.0, True)
    far = [Span(-100.0, -1.0, True), Span(-1.0, 8.0, False), Span(8.0, 100.0, True)]
    assert ways.shown(far, 0.0, Held(8.0, -1.0, False), -1, 10.0) == Held(10.0, -1.0, False)


def test_what_does_not_resolve_any_more_is_given_up_at_once() -> None:
    ways = Ways(persistence_s=4.0, least=5.0)
    ways.shown(FREE_ABOVE, 0.0, Held(10.0, None, True), -1, 0.0)
    worse = [Span(0.0, 20.0, False), Span(20.0, 100.0, True)]
    assert ways.shown(worse, 0.0, Held(20.0, None, True), -1, 1.0) == Held(20.0, None, True)


def test_nothing_is_held_without_a_least_change() -> None:
    ways = Ways(persistence_s=4.0, least=0.0)
    ways.shown(FREE_ABOVE, 0.0, Held(12.0, None, True), -1, 0.0)
    assert ways.shown(FREE_ABOVE, 0.0, Held(10.0, None, True), -1, 1.0).up == 10.0


def test_directions_are_held_across_north() -> None:
    ways = Ways(persistence_s=4.0, least=0.3, turn=6.0)
    spans = [Span(0.0, 1.0, False), Span(1.0, 5.5, True), Span(5.5, 6.0, False)]
    assert ways.shown(spans, 5.8, Held(1.0, 5.5, False), -1, 0.0) == Held(1.0, 5.5, False)
    nearer = [Span(0.0, 1.0, False), Span(1.0, 5.6, True), Span(5.6, 6.0, False)]
    assert ways.shown(nearer, 5.8, Held(1.0, 5.6, False), -1, 1.0) == Held(1.0, 5.5, False)
