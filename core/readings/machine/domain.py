"""What a kernel's checked readings refuse beside non-numbers: values below 0 where the kernel declares them
meaningless (`kernel(nonnegative=...)`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from cratous.core.kernel import entry_of
from cratous.spec.errors import BadInput


def nonnegative(function: Callable[..., Any]) -> tuple[str, ...]:
    """The arguments of a kernel that must not be below 0."""
    entry = entry_of(function)
    return entry.nonnegative if entry is not None else ()


def refuse_negative(where: str, names: tuple[str, ...], columns: Iterable[tuple[str, Any]]) -> None:
    """Raise BadInput for the first number below 0 in one of these columns.

    columns: label and value or array; where: the kernel's name. The name of a record means each of its
    numbers, whose labels are `record.field`.
    """
    if not names:
        return
    for label, value in columns:
        if label.split(".")[0] not in names:
            continue
        array = np.asarray(value)
        # infinite values are refused separately
        wrong = np.flatnonzero((array < 0) & (array > -math.inf))
        if wrong.size:
            item = f"{label}[{wrong[0]}]" if array.ndim else label
            got = str(array.reshape(-1)[wrong[0]])
            raise BadInput("is below 0", where=where, item=item, expected="0 or more", got=got)
