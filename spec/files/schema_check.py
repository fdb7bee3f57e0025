"""Fast check of data against a JSON Schema by `jsonschema-rs`; on failure, `jsonschema` explains what is wrong.

`jsonschema` takes longer to import than a small mission takes to read.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Check = Callable[[Any], bool]
"""A predicate on values."""


def fits(schema: dict[str, Any]) -> Check:
    """A check that is true for values that fit the schema (draft 2020-12), and false for others and for values that
    are not JSON.
    """
    from jsonschema_rs import Draft202012Validator

    validator = Draft202012Validator(schema)

    def check(value: Any) -> bool:
        try:
            return validator.is_valid(value)
        except ValueError:  # a date, a key that is no text
            return False

    return check
