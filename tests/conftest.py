"""Where the reference inputs lie, if they are there (the product stands without them), and what is
closed when a test ends."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from cratous.services.cli import progress

# what is told of work that takes long has tests of its own (tests/cli/test_waiting.py)
progress.PATIENCE_S = 3600.0
# a machine under load is no reason to fail; CI draws the same cases every time
settings.register_profile("default", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "default")

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of reference vectors and examples; skips where it is absent."""
    if not SHARED.is_dir():
        pytest.skip("the reference vectors (../shared) are not on this machine")
    return SHARED


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture
def opened() -> Iterator[list[Any]]:
    """Everything in here is closed at the end."""
    made: list[Any] = []
    yield made
    for one in reversed(made):
        one.close()
