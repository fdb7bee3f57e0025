"""Whether data fit a JSON Schema: at once by `jsonschema-rs`; where they do not, `jsonschema` says in words what is wrong.

`jsonschema` takes longer to import than a small mission takes to read.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Check = Callable[[Any], bool]
"""Whether a value is right."""


def fits(schema: dict[str, Any]) -> Check:
    """A check that says yes of values that fit the schema (draft 2020-12), and no of others and of what is no JSON."""
    from jsonschema_rs import Draft202012Validator

    validator = Draft202012Validator(schema)

    def check(value: Any) -> bool:
        try:
            return validator.is_valid(value)
        except ValueError:  # a date, a key that is no text
            return False

    return check
