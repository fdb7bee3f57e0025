"""Names are qualified: two functions, records or constants of one bare name keep each its meaning."""

from __future__ import annotations

import importlib
import math
import re
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest
import z3

from cratous.core.kernel import REGISTRY, names
from cratous.core.readings.exact import exact
from cratous.core.readings.machine.compiled import (
    FLAGS,
    WITHIN,
    _entry_text,
    compiled,
    load,
    machine,
)
from cratous.core.readings.machine.source_text import SourceText
from cratous.proofs.engine.lift import lift
from cratous.proofs.engine.symbolic import SymReal
from cratous.spec.errors import BadInput

PACKAGE = "names_of_two"
BOTH = """
def clamp(x: float) -> float:
    return x + TWICE[0] if x < LIMIT else LIMIT

def made(x: float) -> float:
    s = State(x, 1)
    return s.first - s.last
"""
"""Functions of either module, on its own constants and records."""
FILES = {
    "near": """
        LIMIT = 1000
        TWICE = (2, 0.5)

        class State(NamedTuple):
            first: float
            last: float

        @kernel(implements="a.b")
        def share(x: float, y: float) -> float:
            \"\"\"A share.\"\"\"
            if y == 0:
                return 0
            return x / y

        @kernel(implements="a.b")
        def violation(s: State) -> bool:
            \"\"\"A name of the product's.\"\"\"
            return s.first < s.last
    """,
    "far": """
        from names_of_two import near
        from names_of_two.near import clamp as near_clamp
        from names_of_two.near import share as part
        from names_of_two.near import violation as near_violation

        LIMIT = 2000
        TWICE = (3, 0.25)

        class State(NamedTuple):
            last: float
            first: float

        def total(x: float) -> float:
            found = 0.0
            for k in range(2):
                found += near_clamp(x) + clamp(x) + k
            return found + near.LIMIT + made(x) + 10 * near.made(x)

        @kernel(implements="a.b")
        def share(x: float, y: float) -> float:
            \"\"\"Another share.\"\"\"
            if y == 1:
                return part(x, y)
            return part(y, x) + part(x, y)

        @kernel(implements="a.b")
        def violation(s: State, t: near.State) -> bool:
            \"\"\"Both records.\"\"\"
            return near_violation(t) or s.first > t.first
    """,
}
HEAD = "from typing import NamedTuple\n\nfrom cratous.core.kernel import kernel\n"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[ModuleType, ...]]:
    """The modules near and far of a package of somebody's own."""
    folder = tmp_path / PACKAGE
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    for name, text in FILES.items():
        lines = [line.removeprefix(" " * 8) for line in text.splitlines()]
        (folder / f"{name}.py").write_text("\n".join([HEAD, *lines, BOTH]))
    monkeypatch.syspath_prepend(tmp_path)
    before = dict(REGISTRY)
    yield tuple(importlib.import_module(f"{PACKAGE}.{name}") for name in FILES)
    for name in [name for name in sys.modules if name.split(".")[0] == PACKAGE]:
        del sys.modules[name]
    REGISTRY.clear()
    REGISTRY.update(before)


def test_loops_keep_the_constants_helpers_and_records_of_each_module(package) -> None:
    near, far = package
    assert near.clamp(5000.0) + far.clamp(5000.0) == 3000
    for x in (1.0, 1500.0, 5000.0):
        assert machine(far.total)(x) == far.total(x)
        assert machine(near.clamp)(x) == near.clamp(x)
        assert machine(far.made)(x) == far.made(x) == -near.made(x)


def test_only_what_is_called_from_outside_is_kept_and_has_a_way_in(package) -> None:
    _, far = package
    made, name = _entry_text(far.total)
    flags = {one: flag for flag, one in re.findall(r"^@(.*)\ndef (\w+)", made.text, re.MULTILINE)}
    assert len(flags) > 2
    assert {one for one, flag in flags.items() if flag == FLAGS} == {name}
    assert {flag for one, flag in flags.items() if one != name} == {WITHIN}
    assert "cache=True" in FLAGS
    assert "cache=True" not in WITHIN


def test_kernels_of_sister_modules_that_divide_are_compiled(package) -> None:
    near, far = package
    x, y = np.array([3.0, 1.0, 0.0, 5.0]), np.array([2.0, 1.0, 4.0, 0.0])
    for kernel in (near.share, far.share):
        wanted = [kernel(a, b) for a, b in zip(x, y, strict=True)]
        assert compiled(kernel)(x, y).tolist() == wanted
    assert near.share(3.0, 2.0) != far.share(3.0, 2.0)


def test_records_of_one_name_keep_their_fields_in_every_reading(package) -> None:
    near, far = package
    rows = [(1, 2, 3, 4), (2, 1, 4, 3), (1, 2, 4, 3), (3, 1, 2, 1), (1, 9, 2, 1)]
    columns = [np.array(column, dtype=float) for column in zip(*rows, strict=True)]
    wanted = [far.violation(far.State(a, b), near.State(c, d)) for a, b, c, d in rows]
    assert {True, False} == set(wanted)
    assert compiled(far.violation)(*columns).tolist() == wanted
    for (a, b, c, d), verdict in zip(rows, wanted, strict=True):
        given = [Fraction(v) for v in (a, b, c, d)]
        assert exact(far.violation, far.State(*given[:2]), near.State(*given[2:])) is verdict
        terms = [SymReal(z3.RealVal(str(v))) for v in given]
        lifted = lift(far.violation, far.State(*terms[:2]), near.State(*terms[2:]))
        assert z3.is_true(z3.simplify(lifted.value.term == verdict))


def test_both_are_registered_and_only_the_exact_text_tells_them_apart(package) -> None:
    for module in ("schedule.rows", "well_clear"):
        importlib.import_module(f"cratous.core.{module}")
    assert {f"{PACKAGE}.near.share", f"{PACKAGE}.far.share"} <= set(REGISTRY)
    mine = [name for name in REGISTRY if name.endswith(".violation")]
    assert len(mine) == 3
    short = names.short(REGISTRY)
    assert short[f"{PACKAGE}.near.share"] == "near.share"
    assert short["cratous.core.schedule.rows.later"] == "later"


def test_two_values_of_one_name_are_an_error(package, monkeypatch: pytest.MonkeyPatch) -> None:
    near, far = package
    text = SourceText("njit")
    text.add(near.clamp)
    monkeypatch.setattr(near, "LIMIT", 7)
    with pytest.raises(BadInput, match=r"near.LIMIT: two values have one name.*1000, 7"):
        text.add(far.total)


def test_what_cannot_be_compiled_is_named(package, monkeypatch: pytest.MonkeyPatch) -> None:
    near, _ = package
    monkeypatch.setattr(near, "LIMIT", {"a": 1})
    with pytest.raises(BadInput, match=r"near.clamp: 'LIMIT' cannot be compiled.*got a dict"):
        SourceText("njit").add(near.clamp)
    monkeypatch.delattr(near, "LIMIT")
    with pytest.raises(BadInput, match=r"near.clamp: 'LIMIT' is not defined"):
        SourceText("njit").add(near.clamp)


def test_a_pattern_that_matches_nothing_says_what_is_near() -> None:
    known = [
        "cratous.core.authority.gate.gate_offer",
        "cratous.core.authority.gate.gate_accepts",
        "other.gate_offer",
    ]
    assert names.matching(["gate_acc*"], known, "kernel") == [
        "cratous.core.authority.gate.gate_accepts"
    ]
    assert names.matching(["gate.*"], known, "kernel") == known[1::-1]
    assert len(names.matching(["gate_offer"], known, "kernel")) == 2
    with pytest.raises(BadInput, match=r"--only: no kernel matches.*such as .*gate_accepts"):
        names.matching(["gate_off*", "gate_acepts"], known, "kernel", "--only")
    assert names.short(known) == {
        "cratous.core.authority.gate.gate_offer": "gate.gate_offer",
        "cratous.core.authority.gate.gate_accepts": "gate_accepts",
        "other.gate_offer": "other.gate_offer",
    }


def test_a_file_pattern_that_matches_nothing_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("")
    assert names.files(tmp_path, "*.py") == [tmp_path / "a.py"]
    with pytest.raises(BadInput, match=r"no file matches; expected \*.txt"):
        names.files(tmp_path, "*.txt")


def scaled(value: float, times: int, turned: bool, pair: tuple[int, int]) -> float:
    """Numbers of each type."""
    return (0.0 - value if turned else value) * times + pair[0] - pair[1]


class Kept(NamedTuple):
    """A record of written numbers."""

    value: float
    turned: bool


def calls_with_written_numbers(value: float, times: int, turned: bool) -> float:
    """As the callee's types, in every way in which a number can be written."""
    kept = Kept(4, True)
    found = scaled(4, 2, False, (0, times)) + scaled(value, times, turned, (times, -1))
    found += scaled(LIMIT, turned=True, times=3, pair=(1, 2))
    return found + scaled(kept.value, 3, kept.turned, (LIMIT, 1))


LIMIT = 7


def test_what_is_called_with_written_numbers_is_compiled_once() -> None:
    text = SourceText("njit")
    name = text.add(calls_with_written_numbers)
    module = load(text.text)
    for given in ((1.5, 3, True), (-2.0, 0, False)):
        assert getattr(module, name)(*given) == calls_with_written_numbers(*given)
    for one in (scaled, Kept):
        (made,) = [n for n in vars(module) if n.endswith(f"__{one.__name__}")]
        assert len(getattr(module, made).signatures) == 1


def side(value: float) -> float:
    """Of the negative of a number."""
    return math.copysign(1.0, -value)


def side_of_nothing() -> float:
    """A whole 0 has no sign, also where it is given for a real number."""
    return side(0)


def test_a_written_zero_stays_whole() -> None:
    text = SourceText("njit")
    name = text.add(side_of_nothing)
    assert getattr(load(text.text), name)() == side_of_nothing() == 1.0
