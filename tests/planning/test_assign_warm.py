"""What `warm` compiles of the assignment is all that a search may call."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from cratous.core.assignment.compiled import is_brief, is_moderate
from cratous.core.readings.machine.compiled import machine
from cratous.services.planning import assign_warm
from cratous.spec.assignment.search import ORDER, TIME

NAMES = ("machine_for", "machine_after", "machine_for_pass", "machine_searching")


@pytest.mark.parametrize("semantics", [TIME, ORDER])
def test_a_wide_instance_is_searched_in_machine_code_from_the_start(semantics: str) -> None:
    assert not is_brief(assign_warm.wide_instance(semantics))
    assert not is_moderate(assign_warm.wide_instance(semantics))
    assert not is_moderate(assign_warm.simple_instance(semantics))


@pytest.mark.slow
def test_whatever_may_be_compiled_of_a_search_is(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else a first large plan, or one with a time limit, would wait for the compiler."""
    wanted = set[str]()
    for file in sorted((root / "core" / "assignment").glob("*.py")):
        for call in ast.walk(ast.parse(file.read_text())):
            if isinstance(call, ast.Call) and ast.unparse(call.func) in NAMES:
                wanted.add(ast.unparse(call.args[2 if ast.unparse(call.func) == NAMES[1] else 1]))
    asked = set[str]()

    def counted(function: object) -> object:
        asked.add(getattr(function, "__name__", ""))
        return machine(function)  # type: ignore[arg-type]

    monkeypatch.setattr("cratous.core.assignment.compiled.machine", counted)
    assign_warm.warm.__wrapped__()
    assert asked >= wanted - {"function"}, wanted - asked
