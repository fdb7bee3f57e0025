"""Every message and attribute of every service has a test that shows its effect."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from cratous.services.uxas.published_messages import SERVES
from cratous.services.uxas.registry import KINDS


@pytest.fixture(scope="module")
def table(root: Path) -> Any:
    spec = importlib.util.spec_from_file_location(
        "services_table", root / "docs/tools/services_table.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_row_of_the_registry_has_a_test(table: Any) -> None:
    assert table.untested() == []


def test_every_mark_names_a_row(table: Any) -> None:
    assert table.strays() == []


def test_every_service_is_in_the_table() -> None:
    assert set(SERVES) == {*KINDS, "Task services"}


def test_marks_are_read_from_the_syntax_alone(table: Any, tmp_path: Path) -> None:
    (tmp_path / "test_some.py").write_text(
        'import pytest\nraise SystemExit\nA, B = "S", "M"\n'
        '@pytest.mark.shows(A, "x", B)\ndef test_one():\n    pass\n'
        "@pytest.mark.slow\ndef test_two():\n    pass\n"
    )
    assert table.marks(tmp_path) == {
        ("S", "x"): ["test_some: test_one"],
        ("S", "M"): ["test_some: test_one"],
    }
