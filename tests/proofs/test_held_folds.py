"""What flies of a fold, of the root and of Python's own functions is what the files say."""

from __future__ import annotations

import builtins
import linecache
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY, Fold
from cratous.core.kernel.sources import is_root, reached, text_of
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.meant_folds import other_parts
from cratous.core.ledger.meant_names import replaced
from cratous.core.ledger.module_trees import Tree

gate.load_all()
FOLDS = [entry.function for entry in REGISTRY.values() if isinstance(entry.function, Fold)]


class Odd(int):
    """A number that looks like another."""


@contextmanager
def _given(fold: Fold[Any], part: str, value: Any) -> Iterator[None]:
    """A frozen fold with another part, as an object's own setter gives it."""
    before = getattr(fold, part)
    object.__setattr__(fold, part, value)
    try:
        yield
    finally:
        object.__setattr__(fold, part, before)


def test_every_fold_is_what_its_file_says() -> None:
    assert len(FOLDS) > 20
    assert [list(other_parts(fold)) for fold in FOLDS] == [[]] * len(FOLDS)


@pytest.mark.parametrize("part", ["step", "finish", "start", "name"])
def test_a_fold_that_was_given_another_part_is_told(part: str) -> None:
    fold = next(one for one in FOLDS if one.finish is not None and type(one.start) is int)
    other = next(one for one in FOLDS if one.step is not fold.step and one.finish != fold.finish)
    value = Odd(int(fold.start)) if part == "start" else getattr(other, part)
    with _given(fold, part, value):
        assert list(other_parts(fold))
    assert not list(other_parts(fold))


def test_a_fold_with_another_step_does_not_fly() -> None:
    fold, other = FOLDS[0], FOLDS[1]
    assert fold.step is not other.step
    with _given(fold, "step", other.step):
        told = {problem.what for problem in gate.check().problems}
    said = [what for what in told if "the fold that runs is not its file's" in what]
    assert len(said) == 1
    assert "its step is not" in said[0]


def test_folds_are_called_as_their_class_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Fold, "__call__", lambda self, items, *context: 0)
    assert replaced([Fold], {}) == ["cratous.core.kernel.Fold.__call__"]


def _rooted() -> Any:
    kernels = (e.function for e in REGISTRY.values() if not isinstance(e.function, Fold))
    return next(f for f in kernels if "sqrt" in f.__code__.co_names)


class _Named:
    """Called as another function is, and named so."""

    def __init__(self, old: Callable[..., Any]) -> None:
        self.old, self.__name__ = old, old.__name__

    def __call__(self, *given: Any) -> Any:
        return self.old(*given)


INSTEAD: dict[str, Callable[[Callable[..., Any]], Any]] = {
    "function": lambda old: lambda *given: old(*given),
    "partial": partial,
    "object": _Named,
    "class": lambda old: type(old.__name__, (), {"__new__": lambda cls, *given: old(*given)}),
}


@pytest.mark.parametrize("how", INSTEAD)
def test_another_root_is_told(monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    kernel, old = _rooted(), math.sqrt
    assert is_root(old)
    root = INSTEAD[how](old)
    monkeypatch.setattr(math, "sqrt", root)
    monkeypatch.setitem(kernel.__globals__, "sqrt", root)
    assert not is_root(math.sqrt)
    assert f"{kernel.__module__}.sqrt" in replaced(reached(kernel).values(), {})


@pytest.mark.parametrize("how", INSTEAD)
def test_another_builtin_is_told(monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    kernels = [e.function for e in REGISTRY.values() if not isinstance(e.function, Fold)]
    kernel = next(f for f in kernels if "min" in f.__code__.co_names)
    assert replaced(reached(kernel).values(), {}) == []
    monkeypatch.setattr(builtins, "min", INSTEAD[how](builtins.min))
    assert "builtins.min" in replaced(reached(kernel).values(), {})


def test_imports_in_a_circle_mean_the_same_in_any_order(tmp_path: Path) -> None:
    folder = tmp_path / "pkg"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "a.py").write_text("from pkg.b import f\n\n\ndef f():\n    pass\n")
    (folder / "b.py").write_text("from pkg.a import f\n")
    (folder / "c.py").write_text("from pkg.b import f\n")
    asked = []
    for first in ("c", "a", "b"):
        tree = Tree({"pkg": folder}, {"pkg": ("",)})
        tree.meant(f"pkg.{first}", ("f",))
        asked.append([tree.meant(f"pkg.{one}", ("f",)) for one in "abc"])
    assert asked[0] == asked[1] == asked[2]
    assert all(asked[0])


def test_lines_that_python_keeps_are_not_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = _rooted()
    file, before = kernel.__code__.co_filename, text_of(kernel)
    lines = ["# nothing\n"] * 500
    monkeypatch.setitem(linecache.cache, file, (len("".join(lines)), None, lines, file))
    assert text_of(kernel) == before


def _package(folder: Path, text: str) -> dict[str, Path]:
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "kernels.py").write_text(text)
    return {"pkg": folder}


def test_names_are_taken_over_where_nothing_has_changed(tmp_path: Path) -> None:
    """What a tree knows of names is used again only if each file and each name is there as it was."""
    own = _package(tmp_path / "pkg", "from other.things import one\n\n\ndef two():\n    one()\n")
    known = Tree(own, {"pkg": ("",)})
    wanted = known.edges(("pkg.kernels", 1))
    again = Tree(own, {"pkg": ("",)})
    assert again.take_over(known)
    assert again.edges(("pkg.kernels", 1)) == wanted
    # what it imports has come to be of the tree
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "things.py").write_text("def one():\n    pass\n")
    more = Tree({**own, "other": tmp_path / "other"}, {"pkg": ("",), "other": ("",)})
    assert not more.take_over(known)
    assert more.edges(("pkg.kernels", 1)) != wanted
    # a module that was looked for, and a file that says something else
    (tmp_path / "pkg" / "kernels.py").write_text("def two():\n    pass\n")
    assert not Tree(own, {"pkg": ("",)}).take_over(known)


def test_keys_are_the_same_whatever_was_asked_before() -> None:
    first = Keys()
    assert first.shared == Keys().shared
