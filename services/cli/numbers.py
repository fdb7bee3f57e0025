"""Numbers as options take them: NaN, which click takes for one, also of any range, is none."""

from __future__ import annotations

import math
from typing import Any

import click
from click.types import FloatParamType


class AnyNumber(FloatParamType):
    """A number."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        number = super().convert(value, param, ctx)
        if math.isnan(number):
            self.fail(f"{value!r} is not a number.", param, ctx)
        return number


class Number(AnyNumber, click.FloatRange):
    """A number in a range."""
