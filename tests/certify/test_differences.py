"""Differences of two reports are named where they are, and none is left out."""

from __future__ import annotations

from typing import Any

import pytest

from cratous.services.certify.differences import differences, text_difference


def test_differences_are_named() -> None:
    one = {"a": {"b": 1, "c": [1, {"d": 2}]}, "environment": 1}
    assert differences(one, one) == []
    two = {"a": {"b": 2, "c": [1, {"d": True}, 3]}, "x y": []}
    assert differences(one, two) == [
        "a.b: written 1, found 2",
        "a.c[1].d: written 2, found true",
        "a.c: written 2 entries, found 3",
        "environment: written 1, found nothing",
        '["x y"]: written nothing, found []',
    ]
    assert len(differences({str(k): 1 for k in range(30)}, {})) == 30, "none is left out"


@pytest.mark.parametrize("pair", [(1, 1.0), (1, True), (0.0, -0.0), (None, 0), ("1", 1), ([], {})])
def test_what_only_python_takes_for_equal(pair: tuple[Any, Any]) -> None:
    assert len(differences(*pair)) == 1


def test_a_difference_shows_where_it_is() -> None:
    before, after = "a" * 500, "b" * 500
    (line,) = differences(before + "X\x1b[31m" + after, before + "Y" + after, "note")
    assert "aaa" + "X\\u001b[31mbbb" in line
    assert "aaaYbbb" in line
    assert len(line) < 300
    assert "\x1b" not in line, "nothing of it acts on a terminal"
    page = "\n" * 7 + "one two\n"
    shown = text_difference("page", page.replace("two", "2").encode() + b"\xff", page)
    assert shown.startswith("page, line 8: written ")
    assert "one 2" in shown
