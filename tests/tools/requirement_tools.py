"""What the tests of requirements share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any, Protocol, TypeVar

import pytest

from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.watch import watch


class Closes(Protocol):
    """Something that is to be closed."""

    def close(self) -> Any: ...


T = TypeVar("T", bound=Closes)


def alike_at_once(
    spec: Specification, trace: Path, rows: list[str], patch: pytest.MonkeyPatch
) -> Outcome:
    """The outcome of one requirement over a trace, sample by sample; judged at once it is the same.

    rows: the header, then the samples. Judged at once the loops run as Python.
    """
    trace.write_text("\n".join(rows) + "\n")
    one_by_one = watch(spec, trace, []).outcomes
    patch.setattr("cratous.services.requirements.watch.is_worth", lambda *_: True)
    patch.setattr("cratous.core.readings.machine.compiled.machine", lambda loop: loop)
    assert [vars(one) for one in watch(spec, trace).outcomes] == [vars(one) for one in one_by_one]
    (found,) = one_by_one
    return found


def all_closed(make: Callable[..., T]) -> Iterator[Callable[..., T]]:
    """For a fixture: makes what has `close`, and closes all of it at the end."""
    with ExitStack() as stack:
        yield lambda *given, **named: stack.enter_context(closing(make(*given, **named)))


def written(folder: Path, text: str) -> Path:
    """A file of requirements."""
    file = folder / "r.req"
    file.write_text(text)
    return file
