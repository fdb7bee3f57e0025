"""The ledger's gate, asked in this process again only where something that it looks at is another.

A command asks it before it flies; in one process of tests that is some hundred times the same answer.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from types import FunctionType
from typing import Any

import pytest

from cratous.core import ledger
from cratous.core.kernel import REGISTRY, Fold


def _inside(value: Any) -> Iterator[Any]:
    """What makes a function, a class or a fold: its code, what it was given, its methods, its steps."""
    if isinstance(value, FunctionType):
        yield from (value.__code__, value.__defaults__, value.__kwdefaults__)
        yield from value.__closure__ or ()
    elif isinstance(value, Fold):
        yield from vars(value).values()
    elif isinstance(value, type) and value.__module__.startswith("cratous."):
        for part in list(vars(value).values()):
            yield part
            yield from _inside(part) if isinstance(part, FunctionType) else ()


def looked_at() -> list[Any]:
    """All that a test can put in the place of something else: values of modules, and what is in them."""
    found: list[Any] = list(REGISTRY.values())
    for name, module in sorted(sys.modules.items()):
        if name.startswith(("cratous.core", "cratous.spec")):
            for key, value in list(vars(module).items()):
                found += (key, value)
                found += _inside(value)
    return found


def ask_once(patch: pytest.MonkeyPatch) -> None:
    """Each answer is kept until something is another object than it was."""
    real = ledger.check_everything
    kept: dict[Path | None, tuple[list[Any], ledger.Standing]] = {}

    def check_everything(folder: Path | None = None) -> ledger.Standing:
        ledger.load_all()  # else the first answer would be that of fewer modules
        now = looked_at()
        before, answer = kept.get(folder, ([], None))
        same = len(now) == len(before) and all(map(lambda a, b: a is b, now, before))
        if answer is None or not same:
            answer = real(folder)
            kept[folder] = looked_at(), answer
        return answer

    patch.setattr(ledger, "check_everything", check_everything)
